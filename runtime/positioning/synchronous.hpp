// Synchronous operation of a slave with the DRS card: a counter of how far the slave is behind its master, and the
// speed that works it off. What the manuals print of it is in docs/inside/synchronous.md; the rest is ours. A
// SynchronousOperation is a plain value, a copy of it is a snapshot.
#pragma once

#include <cstdint>
#include <type_traits>

#include "runtime/positioning/fixed_point.hpp"

namespace ipos::runtime {

struct SynchronousSettings {
#define SYNCHRONOUS_SETTING(member, number, value) int32_t member = value;
#include "runtime/positioning/synchronous.def"

  bool operator==(const SynchronousSettings&) const = default;
};

struct SynchronousInputs {
  bool following = false;  // enabled, magnetized, brake open: the axis turns as it is told
  int32_t speed = 0;       // of the motor, 1/1000 rpm
  int32_t master = 0;      // counts of the motor encoders
  int32_t slave = 0;
  bool free_run = false;
  bool zero_point = false;      // DRS SET ZERO PT.
  bool start = true;            // DRS SLAVE START; true where no input has the function
  bool teach_in = false;        // DRS TEACH IN
  bool master_stopped = false;  // DRS MAST.STOPPED
  bool limit_cw = false;  // a limit switch is reached
  bool limit_ccw = false;
  uint8_t offset = 0;           // 1 to 3: that of P225, P226, P227
  bool operator==(const SynchronousInputs&) const = default;
};

struct SynchronousOrder {
  bool controls = true;  // false: it runs free
  bool stands = false;   // the slave has to stop, and keeps its place
  int32_t speed = 0;     // 1/1000 rpm
  bool operator==(const SynchronousOrder&) const = default;
};

class SynchronousOperation {
 public:
  enum class State : uint8_t { Stopped, FreeRunning, CatchingUp, Synchronous };

  // A millisecond, before the axis moves.
  SynchronousOrder tick(const SynchronousSettings& settings, const SynchronousInputs& inputs);

  State state() const { return state_; }
  // How far the slave is behind, in increments of the encoder that is compared with the master's (P230).
  int64_t difference() const { return whole(difference_); }
  // For the outputs.
  bool prewarning() const { return prewarning_; }
  bool lag_error() const { return lag_error_; }  // until the slave is started anew
  bool in_position() const { return in_position_; }
  bool operator==(const SynchronousOperation&) const = default;

 private:
  // The counter is kept in parts of an increment of which all gears are whole numbers.
  struct Scale {
    explicit Scale(const SynchronousSettings& settings);
    Wide master, slave;  // parts of an increment of each
    Wide increment;      // of the encoder that is compared
    int64_t motor, encoder;  // increments of the slave's motor, and of that encoder, for the same way
    Rate motor_rate(Wide of_encoder) const;  // in the unit of the argument
  };

  void count(const SynchronousInputs& inputs, const Scale& scale);
  void take_edges(const SynchronousSettings& settings, const SynchronousInputs& inputs, const Scale& scale);
  void take_offset(const SynchronousSettings& settings, const SynchronousInputs& inputs, const Scale& scale);
  bool runs_free(const SynchronousSettings& settings, const SynchronousInputs& inputs, const Scale& scale);
  void end_free_run(const SynchronousSettings& settings, const Scale& scale);
  bool stands(const SynchronousSettings& settings, const SynchronousInputs& inputs) const;
  void watch(const SynchronousSettings& settings);
  Rate precontrol(const SynchronousSettings& settings, const Scale& scale);
  Rate correction(const SynchronousSettings& settings, const Scale& scale) const;
  int32_t lead(const SynchronousSettings& settings, const Scale& scale);

  State state_ = State::Stopped;
  bool begun_ = false;  // the counts below are known
  int32_t master_ = 0;
  int32_t slave_ = 0;
  int64_t step_ = 0;   // of the master in the last millisecond
  Wide increment_ = 1; // of the scale in which the counter is
  Wide counter_ = 0;   // without the temporary offset
  Fine difference_ = 0;
  Rate precontrol_ = 0;
  Rate speed_ = 0;  // last ordered

  bool zero_point_ = false;  // levels of the last millisecond
  bool free_input_ = false;
  bool teach_in_ = false;
  uint8_t offset_ = 0;
  int32_t offset_ms_ = 0;   // that it has been there
  bool free_ended_ = false;  // by its limit; the input must come anew
  Wide free_from_ = 0;      // the counter when it began
  int32_t near_ms_ = 0;     // within P510
  int32_t far_ms_ = 0;      // beyond P512
  bool prewarning_ = false;
  bool lag_error_ = false;
  bool in_position_ = false;
};

static_assert(std::is_trivially_copyable_v<SynchronousOperation>, "a copy is a snapshot");

}  // namespace ipos::runtime
