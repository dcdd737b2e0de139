// Reference travels, types P903 = 0..7 (1053 1610 p. 83 has the range; what each type does is common
// knowledge and ours, docs/inside/positioning.md):
//
//   0 zero pulse CCW of the start     4 CCW limit switch
//   1 CCW end of the reference cam    5 where the axis is
//   2 CW end of the reference cam     6 reference cam flush with the CW limit switch
//   3 CW limit switch                 7 reference cam flush with the CCW limit switch
//
// Search runs with P901, from the switch on P902 counts.
#pragma once

#include <cstdint>
#include <optional>

namespace ipos::runtime {

struct ReferenceInputs {
  bool cam = false;  // levels; a limit switch is true where it is reached
  bool limit_cw = false;
  bool limit_ccw = false;
  bool has_cam = false;  // an input has the function
  bool has_limits = false;
  int32_t position = 0;
  int way = 0;                           // in which the axis moves
  std::optional<int32_t> zero_pulse_cw;  // passed in the last millisecond, by the way it was passed
  std::optional<int32_t> zero_pulse_ccw;
};

class ReferenceTravel {
 public:
  enum class Outcome : uint8_t {
    Moving,         // order() says how
    Found,          // found() is the reference point
    CamMissing,     // F39
    LimitsMissing,  // F27
  };
  struct Order {
    int way = 0;
    bool fast = false;
    bool operator==(const Order&) const = default;
  };

  // Begins, also again after an interruption.
  void start(int type, bool zero_pulse);
  void end() { active_ = false; }
  bool active() const { return active_; }
  bool moves() const;  // its type does
  int type() const { return type_; }
  bool zero_pulse() const { return zero_pulse_; }

  // One millisecond.
  Outcome tick(const ReferenceInputs& inputs);
  Order order() const { return order_; }
  int32_t found() const { return found_; }
  bool operator==(const ReferenceTravel&) const = default;

 private:
  enum class Step : uint8_t { Search, Leave, ZeroPulse };

  Outcome search(const ReferenceInputs& in);
  Outcome leave(const ReferenceInputs& in);
  Outcome find_zero_pulse(const ReferenceInputs& in);
  Outcome reach(int32_t position);
  bool on_switch(const ReferenceInputs& in) const;

  bool active_ = false;
  bool zero_pulse_ = false;
  int type_ = 0;
  Step step_ = Step::Search;
  bool turned_ = false;  // at a limit switch, to search the other way
  bool seen_ = false;    // the switch, on the way to its end
  Order order_;
  int32_t found_ = 0;
};

}  // namespace ipos::runtime
