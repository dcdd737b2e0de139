// [station.machine] of the plant file: what the motor of a station drives, in the user's unit of travel. The page draws
// it, and a conveyor carries parts that light barriers see. Position 0 is where the count of the unit (H511) is 0.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plant_file/signal.hpp"
#include "runtime/plant_file/toml_text.hpp"

namespace ipos::runtime {

enum class MachineKind : uint8_t {
#define MACHINE_KIND(kind, ...) kind,
#include "runtime/plant_file/machine_kinds.def"
};

struct MachineKindInfo {
  MachineKind kind;
  std::string_view word;
  std::string_view unit;
  double per_turn;
};
std::span<const MachineKindInfo> machine_kinds();
const MachineKindInfo& info(MachineKind kind);

inline constexpr int32_t kShaftTurn = 4096;  // increments (IPOSplus p. 22)

// All in the unit of the machine.
struct DrivenMachine {
  MachineKind kind = MachineKind::Axis;
  std::string unit;
  double per_turn = 1;  // of the motor shaft; negative: it goes backwards when the motor turns clockwise
  struct Travel {
    double from;
    double to;
  };
  std::optional<Travel> travel;
  // Of a conveyor: the fronts of parts that lie on it at first, the length of each, and how far the belt moves from one
  // more part at its beginning to the next; 0: none come.
  std::vector<double> parts;
  double part_length = 0;
  double feed = 0;
  FilePlace place;

  bool carries() const { return !parts.empty() || feed != 0; }
};

// A light barrier over a conveyor: an input that tells whether a part is at this place.
struct LightBarrier {
  Signal input;
  std::string belt;  // a station that drives a conveyor
  double at = 0;     // in the unit of its machine
  bool active_high = true;  // level while a part is there
  FilePlace place;
};

}  // namespace ipos::runtime
