// The setpoint cascade: from the source P100 chooses to the speed the ramp is told (MOVITRAC 07 chapter 6.4;
// 1053 1610 p. 72). Pure functions; speeds in 1/1000 rpm, positive is CW.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "runtime/drive/settings.hpp"
#include "stdlib/control_sources.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::runtime {

// What hangs on the analog terminals. An input is wired for voltage or for current; the other is 0.
struct AnalogInputs {
  struct Signal {
    int32_t millivolt = 0;
    int32_t microampere = 0;
    bool operator==(const Signal&) const = default;
  };
  Signal ai1;
  Signal ai2;
  int32_t frequency = 0;      // Hz, frequency input of MOVITRAC 07
  int32_t potentiometer = 0;  // 1/1000 of full travel, built-in potentiometer of MOVITRAC 07
  bool operator==(const AnalogInputs&) const = default;
};

using stdlib::SetpointSource;

// Why a setpoint differs from what one expects; shown with --why.
enum class SetpointNote : uint8_t {
#define SETPOINT_NOTE(name, text) name,
#include "runtime/drive/setpoint_notes.def"
};
std::string setpoint_note_text(SetpointNote note, const stdlib::UnitType& unit);

struct SetpointInputs {
  bool unipolar_is_amount = false;
  bool fixed_plus_potentiometer = true;  // firmware from .13, LOGODrive .12 (MOVITRAC 07 table 3)
  bool torque_control = false;           // P700: the setpoint is a current
  bool slave_free_run = false;           // input function: the local source instead of the master's
  int fixed = 0;                         // 0 none, 1..3: n11..n13 or n21..n23
  bool other_set = false;                // fixed setpoint switchover
  bool ccw = false;                      // direction terminal; only where the sign does not decide
  int32_t ai1_speed = 0;                 // ai1_speed() after its filter
  AnalogInputs analog;
  int32_t motor_pot = 0;
  bool motor_pot_ccw = false;
  std::optional<int32_t> bus_speed;      // of the bus of P100; nothing: no PO word has SPEED
  std::optional<int32_t> bus_current;    // of the bus of P100; nothing: no PO word has CURRENT
  int32_t sent_speed = 0;                // in the last telegram of any bus
  bool bus_accepted = false;             // P876, and the bus of P100 has sent
  bool po_enabled = true;                // P876
  std::optional<int32_t> maximum_speed;  // PO word MAX. SPEED
  std::optional<int32_t> pi_output;      // PI controller on: its output in 1/1000 %
};

struct Setpoint {
  int32_t speed = 0;      // what the ramp is told
  int32_t requested = 0;  // before the limits
  SetpointNote note = SetpointNote::None;
  int32_t current = 0;  // of a torque control, in place of a speed: 1/1000 % of IN
  bool operator==(const Setpoint&) const = default;
};

// `set` is the active one of settings.sets, `other` the other.
Setpoint select_setpoint(const Settings& settings, const ParameterSet& set, const ParameterSet& other,
                         const SetpointInputs& inputs);

// Voltage or current of AI1 as a speed, by P110 to P114.
int32_t ai1_speed(const Settings& settings, const ParameterSet& set, const AnalogInputs& analog);

// Actual value of the PI controller in 1/1000 %: AI1 by P253 and P254, without the offset P255.
int32_t pi_actual_value(const Settings& settings, const AnalogInputs& analog);

// The built-in potentiometer as a speed, by P122.
int32_t potentiometer_speed(const Settings& settings, const ParameterSet& set, int32_t position);

// Magnitude between P301 and P302, sign kept; 0 counts as CW.
int32_t limit_setpoint(const ParameterSet& set, int32_t speed, int32_t maximum);

// Out of the skip window P740, P741 (ours): below its middle to the lower edge, from there to the upper one,
// unless that is beyond a limit; with both edges beyond one, to the lower, as the maximum holds always.
int32_t leave_skip_window(const ParameterSet& set, int32_t speed, int32_t maximum);

// True while the sign of the setpoint is the direction of rotation.
bool sign_decides(const Settings& settings, bool slave_free_run);

}  // namespace ipos::runtime
