// Planning checks of the RS-485 side of a plant (1053 1610 p. 5-8, 14-15; MDX60B/61B p. 8-19, 29-30): what
// cannot be wired is an error of the plant file, what will hardly work as meant is told when the plant
// starts: settings of stations, and a cable that disturbs telegrams.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plant_file/plant_file.hpp"

namespace ipos::runtime {

// RS-485 interfaces of a unit type: X13 and the XT or TERMINAL socket.
struct SerialInterfaces {
  bool x13 = false;
  bool xt = false;
  bool xt_needs_uss21a = false;  // MOVIDRIVE A: by that option only
  bool xt_has_s13 = false;       // MOVIDRIVE B: rate by DIP switch S13
};
SerialInterfaces serial_interfaces(const stdlib::UnitType& unit);

// Rate of a station at its two interfaces.
inline constexpr uint32_t kX13Baud = 9'600;
inline constexpr uint32_t kS13Baud = 9'600, kFactoryXtBaud = 57'600;  // S13 on and off (MDX60B/61B chapter 4.1.1)
uint32_t xt_baud(const StationConfig& station);

// How long a line of the plant may be, in mm.
uint32_t serial_length_limit(const PlantFile& plant, const BusConfig& bus);

// What of its cable disturbs telegrams, on RS-485 and RS-232 alike.
struct SerialCableFinding {
  enum class Rule : uint8_t { TooLong, Terminated };
  Rule rule;
  std::string text;
};
std::vector<SerialCableFinding> serial_cable_findings(const PlantFile& plant, const BusConfig& bus);

std::vector<PlantError> check_serial_plan(const PlantFile& plant);

// Value of a parameter ("810") of station n at power-on.
using ParameterOf = std::function<int32_t(size_t station, std::string_view number)>;

struct PlanFinding {
  std::string station;  // empty: the plant
  std::string text;
  bool against_rule = true;  // false: worth knowing
};
std::vector<PlanFinding> serial_findings(const PlantFile& plant, const ParameterOf& parameter);

// P750 with a setpoint over RS-485, and P100 = MASTER-RS-485 (1053 1610 p. 72, 80).
bool sends_setpoints(int32_t p750);

}  // namespace ipos::runtime
