// The electrical side: currents, output frequency, DC link, energy and the slow quantities heat sink
// temperature and utilizations. All models are ours and simple on purpose, docs/inside/motion.md.
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime/motion/fine_speed.hpp"
#include "runtime/motion/machine_data.hpp"
#include "runtime/part/part.hpp"

namespace ipos::runtime {

// What the power section does in one millisecond.
enum class Supply : uint8_t { Off, Magnetizing, Driving, DirectCurrent };

class PowerSection {
 public:
  explicit PowerSection(const MachineData& machine);  // within_limits

  // Greatest torque within a current limit (P303), 1/1000 % of the rated torque.
  int64_t torque_limit(int32_t current_limit) {
    if (current_limit != limit_for_) find_torque_limit(current_limit);
    return torque_limit_;
  }

  // The motor drives or brakes with the greatest torque: the output current is at its limit.
  bool gives_all() const {
    const int64_t torque = currents_.torque < 0 ? -currents_.torque : currents_.torque;
    return torque != 0 && torque >= torque_limit_;
  }

  // What is left of the rated flux, 1/1000: the motor needs less magnetizing current, and more active current for a torque.
  void set_flux(int32_t flux);

  // Torque of an active current, both in 1/1000 %.
  int64_t torque_of(int32_t active_current) const {
    return int64_t{std::clamp(active_current, -kTopCurrent, kTopCurrent)} * 100'000 / active_;
  }

  struct Load {
    Supply supply;
    int32_t speed;  // 1/1000 rpm
    int64_t torque;
    int32_t current_limit;   // bounds the magnetizing current, too
    int32_t direct_current;  // of Supply::DirectCurrent
  };
  [[gnu::always_inline]] void step(const Load& load) {
    const bool driving = load.supply == Supply::Driving;
    const int64_t torque = driving ? load.torque : 0;
    const Currents currents{load.supply, torque, load.current_limit, load.direct_current};
    if (!(currents == currents_)) find_currents(currents);
    const Speed speed{load.speed, torque, driving};
    if (!(speed == speed_)) {
      speed_ = speed;
      mechanical_ = torque * speed.mrpm / machine_.rated_speed;
    }
    step_power();
    unit_.follow(unit_target_);
    motor_.follow(motor_target_);
    heat_sink_.follow(heat_sink_target_);
  }

  // --- steps in a row of a motor that drives, with the limits of the last one (Axis::Following) ---
  bool drives(int32_t current_limit, int32_t direct_current) const {
    return currents_.supply == Supply::Driving && currents_.current_limit == current_limit &&
           currents_.direct_current == direct_current;
  }
  int64_t torque() const { return currents_.torque; }
  // A step in its parts: the currents of its torque, where that is another one;
  void give(int64_t torque) {
    find_currents({currents_.supply, torque, currents_.current_limit, currents_.direct_current});
  }
  // what it draws at this speed;
  [[gnu::always_inline]] void draw_at(int32_t speed) {
    mechanical_ = currents_.torque * speed / machine_.rated_speed;
    step_power();
  }
  // what so many steps warm between which nothing was given; and the speed of the last one.
  void warm(Ticks steps);
  void show_speed(int32_t speed) { speed_ = {speed, currents_.torque, true}; }
  // The most of each in so many steps, whatever is given.
  int32_t heat_sink_within(Ticks steps) const { return temperature(heat_sink_.within(steps, kTopHeat)); }
  int32_t motor_utilization_within(Ticks steps) const {
    return static_cast<int32_t>(motor_.within(steps, kTopUtilization));
  }

  // Without mains nothing holds the DC link, and nothing is drawn from them. When they come back, the link is charged in
  // kChargeMs from empty.
  void set_mains(bool on);
  void empty();  // the DC link: as after a long time without mains

  // What so many steps with the last load do while the DC link stays as it is: energy and the slow
  // quantities. At most bound() of them.
  void advance(Ticks steps);
  Ticks bound() const { return kMostAtOnce; }

  int32_t output_current() const { return output_current_; }             // 1/1000 % IN
  int32_t active_current() const { return active_current_; }             // signed as the torque
  int32_t frequency() const;                                             // mHz, signed as the field turns
  int32_t dc_link() const { return dc_link_; }                           // mV
  int32_t heat_sink() const { return temperature(heat_sink_.whole()); }  // °C
  int32_t utilization() const { return unit_.whole(); }                  // 1/1000 %
  int32_t motor_utilization() const { return motor_.whole(); }
  int64_t energy() const { return energy_; }  // Ws drawn since the start; braking gives nothing back

  // The most of each while the load stays as it is, and what is drawn of energy at most in a step.
  int32_t heat_sink_ahead() const {
    return temperature(std::max<int64_t>(heat_sink_.whole(), heat_sink_target_));
  }
  int32_t motor_utilization_ahead() const {
    return static_cast<int32_t>(std::max<int64_t>(motor_.whole(), motor_target_));
  }
  int64_t energy_ahead() const { return drawn() / kPerWs + 1; }
  bool operator==(const PowerSection&) const = default;

 private:
  // Follows a target with a time constant, in steps of 2^-24.
  class Lag {
   public:
    explicit Lag(int32_t time_ms);
    void follow(int64_t target) {
      const int64_t distance = (target << 24) - value_;
      const int64_t change = static_cast<int64_t>(divided(magnitude(distance)));
      value_ += distance < 0 ? -change : change;
    }
    int32_t whole() const { return static_cast<int32_t>(value_ >> 24); }
    // The most of it in so many steps towards targets up to `top`: none goes further than the first one towards that would.
    int64_t within(Ticks steps, int64_t top) const {
      const int64_t way = (top << 24) - value_;
      if (way <= 0) return whole();
      return (value_ + static_cast<int64_t>(std::min(Wide{magnitude(way)}, Wide{divided(magnitude(way))} * steps))) >> 24;
    }

    // Several steps towards one target: its distance gets less and never turns its sign.
    struct Way {
      int64_t end;
      bool falls;
      uint64_t distance;
    };
    Way begin(int64_t target) const {
      const int64_t end = target << 24, distance = end - value_;
      return {end, distance < 0, magnitude(distance)};
    }
    // How far it went: 0 when it is there, as far as the division has digits.
    uint64_t step(Way& way) const {
      const uint64_t change = divided(way.distance);
      way.distance -= change;
      return change;
    }
    void finish(const Way& way) {
      value_ = way.falls ? way.end + static_cast<int64_t>(way.distance)
                         : way.end - static_cast<int64_t>(way.distance);
    }
    bool operator==(const Lag&) const = default;

   private:
    // Of distances below 2^48 (targets below 2^24) the product has the whole part of distance / time exactly:
    // the reciprocal is too large by less than 2^-shift, so the product by less than 2^(48 - shift) = 2^-w <
    // 1 / time, where w is the number of digits of the time. It is kept so that at least 63 digits go away,
    // of which the distance brings one along.
    __extension__ using Wide = unsigned __int128;
    static uint64_t magnitude(int64_t distance) {
      return static_cast<uint64_t>(distance < 0 ? -distance : distance);
    }
    uint64_t divided(uint64_t distance) const {
      return static_cast<uint64_t>(Wide{distance << 1} * reciprocal_ >> 64) >> shift_;
    }

    int64_t value_ = 0;
    uint64_t reciprocal_;  // of the time constant, in units of 2^-(63 + shift_)
    int shift_;
  };

  // What torque and limits make of the currents, found again when one of them changes.
  struct Currents {
    Supply supply = Supply::Off;
    int64_t torque = 0;
    int32_t current_limit = 0;
    int32_t direct_current = 0;
    bool operator==(const Currents&) const = default;
  };
  struct Speed {
    int64_t mrpm = 0;
    int64_t torque = 0;
    bool driving = false;
    bool operator==(const Speed&) const = default;
  };

  void find_torque_limit(int32_t current_limit);
  void find_currents(const Currents& currents);
  // Mechanical power in 1/1000 % of the rated power; losses are added, what comes back charges the DC link.
  void step_power() {
    // What is taken from a link that the mains hold leaves it as it is.
    if (power() < -kStandby || charge_ != least_charge_) change_charge();
    draw(1);
  }
  void change_charge() {
    const int64_t change = std::clamp<int64_t>(power() + kStandby, -kMostPower, kMostPower) * charge_per_power_;
    const int64_t charge = std::clamp(charge_ - change, least_charge_, most_charge_);
    if (charge == charge_) return;
    charge_ = charge;
    find_dc_link();
  }
  void find_dc_link();
  void charge_on();
  void draw(uint32_t steps) {
    energy_rest_ += drawn() * int64_t{steps};
    if (energy_rest_ < kPerWs) return;
    energy_ += energy_rest_ / kPerWs;
    energy_rest_ %= kPerWs;
  }
  int64_t power() const { return mechanical_ + losses_; }
  // In one step, of kPerWs for a Ws.
  int64_t drawn() const { return std::clamp<int64_t>(power(), 0, kMostPower) * mains_power_; }
  int32_t temperature(int64_t rise) const { return static_cast<int32_t>(machine_.ambient + rise / 1'000); }

  static constexpr Ticks kMostAtOnce = 60'000;
  static constexpr int64_t kMostPower = 100'000'000;  // 1/1000 % of the rated power
  static constexpr int64_t kStandby = 1'000;          // always taken from the DC link
  static constexpr int64_t kChargeMs = 100;           // from empty; ours
  // The unit's rated power lifts the square of the DC link voltage by 10000 V² a millisecond: about 200 µF a kilowatt.
  static constexpr int64_t kChargePerPower = 100'000;  // mV² per 1/1000 %
  static constexpr int64_t kPerWs = int64_t{100'000} * 1'000;
  static constexpr int64_t kTopUtilization = 10'000'000;  // 1/1000 %
  static constexpr int64_t kTopHeat = 1'000'000;          // 1/1000 K

  struct Figures {  // of the machine
    int32_t rated_speed, rated_slip, pole_pairs, rated_power, ambient, heat_sink_rise, rated_active, rated_magnetizing;
    bool operator==(const Figures&) const = default;
  };
  Figures machine_;
  int32_t flux_ = 1'000;
  int32_t active_;       // at rated torque and this flux
  int32_t magnetizing_;  // at this flux
  int64_t charge_per_power_;
  int64_t continuous_heat_;  // 100 % of unit and motor utilization; the square of the current in 1/1000 %
  int64_t rated_heat_;
  int32_t limit_for_ = 0;
  int64_t torque_limit_ = 0;
  Currents currents_;
  Speed speed_;
  int64_t losses_ = 0;      // 1/1000 % of the rated power
  int64_t mechanical_ = 0;  // the same
  int64_t unit_target_ = 0, motor_target_ = 0, heat_sink_target_ = 0;
  int32_t output_current_ = 0;
  int32_t active_current_ = 0;
  int64_t idle_charge_;  // square of the DC link voltage in mV², at mains
  int64_t least_charge_;  // what the mains hold it at: that, 0 without them, in between while they charge it
  int64_t mains_power_;   // the rated power in W while it comes from the mains, else 0
  int64_t charge_;       // now
  int64_t most_charge_;  // where the chopper holds it
  int32_t dc_link_;
  int64_t energy_ = 0;
  int64_t energy_rest_ = 0;
  Lag unit_, motor_, heat_sink_;
};

}  // namespace ipos::runtime
