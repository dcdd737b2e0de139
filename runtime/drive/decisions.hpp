// What a drive decides before it moves: who controls it, where its setpoint comes from, what it watches. That
// follows from its settings and its situation alone, and both seldom change; so it is decided once and holds
// for as long as the situation, compared as a whole, is the same (Drive::decided). Nobody has to tell of a
// change, and nothing that was decided can be out of date.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

#include "runtime/drive/control.hpp"
#include "runtime/drive/fault_state.hpp"
#include "runtime/drive/link_watch.hpp"
#include "runtime/drive/outputs.hpp"
#include "runtime/drive/process_data.hpp"
#include "runtime/drive/setpoint.hpp"
#include "runtime/drive/setpoint_memory.hpp"
#include "runtime/drive/terminals.hpp"

namespace ipos::runtime {

// All that decisions depend on. No padding, so that equal situations have equal bytes.
struct Situation {
  AnalogInputs analog;
  uint32_t settings = 0;   // ParameterStore::changes()
  uint32_t ipos_word = 0;  // H484
  uint16_t inputs = 0;     // levels as in H483
  DriveWords shown_po{};   // of the last telegram of any bus
  std::array<DriveWords, kPoSources> po{};
  std::array<bool, kPoSources> heard{};  // process data have come
  FaultState faults;
  bool second_set = false;
  bool three_wire_cw = false, three_wire_ccw = false;
  bool positioning = false;
  Command halt = Command::Enable;  // _AxisStop
  bool starting_up = false;
  bool factory_setting = false;
  bool mains = true;          // there are some
  bool mains_stop = false;    // the response of P521 acts
  bool link_is_low = false;   // the DC link is too low for the power section: 24 V operation
  bool unused = false;        // fills the last word
  bool output_stage = false;
  bool reversing = false;  // the ramp's output is CCW: decides which down ramp a stop takes

  friend bool operator==(const Situation& a, const Situation& b) {
    return std::memcmp(&a, &b, sizeof(Situation)) == 0;
  }
};
static_assert(std::has_unique_object_representations_v<Situation>);

// The situation of a drive and a count of its changes. change() and set() are the only writers.
class WatchedSituation {
 public:
  const Situation& operator*() const { return now_; }
  const Situation* operator->() const { return &now_; }
  Situation& change() {
    ++changes_;
    return now_;
  }
  template <typename Value>
  void set(Value Situation::*member, const Value& value) {
    if (!(now_.*member == value)) change().*member = value;
  }
  uint32_t changes() const { return changes_; }
  bool changed() const { return changes_ != looked_at_; }  // since looked()
  void looked() { looked_at_ = changes_; }

 private:
  Situation now_;
  uint32_t changes_ = 1;
  uint32_t looked_at_ = 0;
};

struct Decisions {
  Terminals terminals;
  Verdict controls;              // of all sources, without what the setpoint adds (Drive::verdict)
  bool enabled_locally = false;  // terminals and program enable, whatever a bus and faults say
  bool waiting = false;          // display t
  bool can_position = false;
  bool can_synchronize = false;
  bool ready = false;
  uint32_t output_flags = 0;   // of the outputs, those that follow from the situation
  uint32_t overload_flag = 0;  // that of the motor in charge
  uint16_t reserved_control_bits = 0;
  std::optional<int32_t> bus_position;

  // Monitoring.
  std::array<LinkWatch::Rules, kPoLinks> links{};
  bool reset = false;  // an input or H484 orders it
  bool external_fault = false;
  bool temperature_sensor = false;
  bool both_limit_switches = false;
  bool parameter_switch = false;
  bool mains_gone = false;  // as an input with MAINS ON says

  // The setpoint: what goes into the parts with a memory, and into the choice, whose places for their results
  // are still empty.
  bool setpoint_held = false;
  int32_t ai1_speed = 0;
  MotorPotentiometer::Order motor_pot;
  bool motor_pot_falls_back = false;
  std::optional<PiController::Order> pi;
  bool pi_resets = false;
  SetpointInputs setpoint;
};

}  // namespace ipos::runtime
