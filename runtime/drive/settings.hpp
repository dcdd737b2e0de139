// What the parameters say, in the form the control reads every millisecond: read once after each change
// instead of searched for. Values are coded as in the parameter channel (speeds in 1/1000 rpm, times in ms).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/drive/parameters.hpp"

namespace ipos::runtime {

// Sbus2: its words count as those of the SBus (P100 and P101 name no other), its silence is its own.
enum class PoSource : uint8_t { Rs485, Fieldbus, Sbus, Sbus2 };
inline constexpr size_t kPoSources = 3;  // with words of their own
inline constexpr size_t kPoLinks = 4;    // that are monitored

inline constexpr int32_t kAbsent = INT32_MIN;

// Parameters that exist twice, for motors 1 and 2 (parameter switchover).
struct ParameterSet {
  bool operator==(const ParameterSet&) const = default;
#define SET_SETTING(member, first, second, absent) int32_t member = absent;
#include "runtime/drive/settings.def"
};

struct Settings {
  bool operator==(const Settings&) const = default;
#define SETTING(member, number, absent) int32_t member = absent;
#include "runtime/drive/settings.def"
  std::array<ParameterSet, 2> sets;
  // The bus the setpoint and the control word come from; nothing when it is none (P100, P101).
  std::optional<PoSource> setpoint_bus;
  std::optional<PoSource> control_bus;
  // Assignments of PO1..PO3 and PI1..PI3, P870..P875.
  std::array<uint8_t, 3> po{};
  std::array<uint8_t, 3> pi{};
  // Functions of the inputs, by bit of InputLevel H483: bit 1 DI01 .. bit 5 DI05, bit 8 DI10 .. bit 15 DI17.
  std::array<uint8_t, 16> inputs{};
  // Functions of the outputs: bit 1 DO01, bit 2 DO02, bit 8 DO10 .. bit 15 DO17. DB00 is the brake.
  std::array<uint8_t, 16> outputs{};
};

// P700: the modes with M-CONTROL.
constexpr bool is_torque_control(int32_t operating_mode) {
  return operating_mode == 12 || operating_mode == 17;
}

// P700: the modes with SYNC., in parameter set 1 only (DRS11B manual p. 30).
constexpr bool is_synchronous(int32_t operating_mode) {
  return operating_mode == 8 || operating_mode == 14 || operating_mode == 19;
}

// P700: CFC and SERVO, of which P205 and P304 are.
constexpr bool is_field_oriented(int32_t operating_mode) { return operating_mode >= 11 && operating_mode <= 20; }

// P700: from 5 on the modes have an encoder; those of MOVITRAC (21, 22) go by a V/f characteristic. P701 has the first five.
constexpr bool has_encoder(int32_t operating_mode) { return operating_mode >= 5 && operating_mode <= 20; }
constexpr bool is_hoist(int32_t operating_mode) { return operating_mode == 2 || operating_mode == 7; }
constexpr bool has_dc_braking(int32_t operating_mode) { return operating_mode == 3 || operating_mode == 22; }
constexpr bool has_flying_start(int32_t operating_mode) { return operating_mode == 4; }

// What a master sends to its slaves as setpoint (P750).
enum class SlaveSetpoint : uint8_t { Speed, Torque, LoadShare };
constexpr SlaveSetpoint slave_setpoint(int32_t p750) {
  return p750 <= 3 ? SlaveSetpoint::Speed : p750 <= 6 ? SlaveSetpoint::Torque : SlaveSetpoint::LoadShare;
}

class SettingsReader {
 public:
  explicit SettingsReader(const ParameterStore& parameters);
  Settings read(const ParameterStore& parameters) const;

 private:
  struct Cell {
    int32_t Settings::*member;
    size_t slot;  // of the parameter
  };
  struct SetCell {
    int32_t ParameterSet::*member;
    std::array<size_t, 2> slots;
  };
  stdlib::Traits traits_;
  std::vector<Cell> cells_;
  std::vector<SetCell> set_cells_;
};

}  // namespace ipos::runtime
