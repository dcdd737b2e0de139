// The electrical side: currents, output frequency, DC link, energy and the slow quantities heat sink
// temperature and utilizations. All models are ours and simple on purpose, docs/motion.md.
#pragma once

#include <cstdint>

#include "runtime/motion/fine_speed.hpp"
#include "runtime/motion/machine_data.hpp"

namespace ipos::runtime {

// What the power section does in one millisecond.
enum class Supply : uint8_t { Off, Magnetizing, Driving, DirectCurrent };

class PowerSection {
 public:
  explicit PowerSection(const MachineData& machine);  // within_limits

  // Greatest torque within a current limit (P303), 1/1000 % of the rated torque.
  int64_t torque_limit(int32_t current_limit) const;

  struct Load {
    Supply supply;
    FineSpeed speed;
    int64_t torque;
    int32_t current_limit;   // bounds the magnetizing current, too
    int32_t direct_current;  // of Supply::DirectCurrent
  };
  void step(const Load& load);
  // What so many steps with Supply::Off and a DC link at rest do: the slow quantities fall.
  void cool(uint64_t steps);

  int32_t output_current() const { return output_current_; }  // 1/1000 % IN
  int32_t active_current() const { return active_current_; }  // signed as the torque
  int32_t frequency() const { return frequency_; }            // mHz, signed as the field turns
  int32_t dc_link() const;                                    // mV
  int32_t heat_sink() const;                                  // °C
  int32_t utilization() const { return unit_.whole(); }       // 1/1000 %
  int32_t motor_utilization() const { return motor_.whole(); }
  int64_t energy() const { return energy_; }  // Ws drawn since the start; braking gives nothing back

 private:
  // Follows a target with a time constant, in steps of 2^-24.
  class Lag {
   public:
    explicit Lag(int32_t time_ms) : time_ms_(time_ms) {}
    void follow(int64_t target) { value_ += ((target << 24) - value_) / time_ms_; }
    void fall(uint64_t steps);
    int32_t whole() const { return static_cast<int32_t>(value_ >> 24); }

   private:
    int64_t value_ = 0;
    int32_t time_ms_;
  };

  void step_power(int64_t mechanical);

  MachineData machine_;
  int32_t output_current_ = 0;
  int32_t active_current_ = 0;
  int32_t frequency_ = 0;
  int64_t idle_charge_;  // square of the DC link voltage in mV², at mains
  int64_t charge_;       // now
  int64_t most_charge_;  // where the chopper holds it
  int64_t energy_ = 0;
  int64_t energy_rest_ = 0;
  Lag unit_, motor_, heat_sink_;
};

}  // namespace ipos::runtime
