// The values of the drive with a name of their own: a display value, which the drive keeps up to date in its parameter; a
// variable; or what only the simulation knows.
#include <algorithm>
#include <iterator>

#include "runtime/drive/indices.hpp"
#include "runtime/signals/collector.hpp"
#include "runtime/signals/drive_values.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

struct DriveValue {
  std::string_view name;
  std::string_view meaning;
  std::string_view parameter;  // number
  int variable = -1;           // of units that position
  int64_t (*read)(const Station&) = nullptr;
  std::string_view unit{};
  double factor = 1;
  int decimals = 0;
  size_t bits = 0;
  int64_t (*decided)(const Drive&) = nullptr;  // Signal::decided
  Signal::Put put = nullptr;                    // of what acts on the shaft from outside
  bool (*can_put)(const Drive&) = nullptr;
  uint32_t number = 0;
};

template <int32_t (Drive::*value)() const>
int64_t of_drive(const Drive& drive) {
  return (drive.*value)();
}

template <int64_t (*value)(const Drive&)>
int64_t of_station(const Station& station) {
  return value(station.drive().state());
}

template <int32_t (Drive::*value)() const>
constexpr DriveValue decided_value(DriveValue row) {
  row.read = of_station<of_drive<value>>;
  row.decided = of_drive<value>;
  return row;
}

Refusal put_load_torque(Station& station, uint32_t, int32_t torque) {
  station.drive().state().set_load_torque(torque);
  return std::nullopt;
}
Refusal put_shaft_speed(Station& station, uint32_t, int32_t speed) {
  station.drive().state().set_shaft_speed(speed);
  return std::nullopt;
}

// Beyond all indices of parameters.
constexpr uint32_t kFirstWritten = 0x10000;

constexpr DriveValue written(uint32_t number, DriveValue row, Signal::Put put, bool (*can_put)(const Drive&)) {
  row.number = kFirstWritten + number;
  row.put = put;
  row.can_put = can_put;
  return row;
}
constexpr DriveValue kShaftSpeed = written(
    1, decided_value<&Drive::speed>({"shaft_speed", "of the motor as simulated", "", -1, nullptr, "rpm", 0.001, 3}),
    put_shaft_speed, [](const Drive& drive) { return drive.is_driven(); });
constexpr DriveValue kLoadTorque = written(
    0, {"load_torque", "of what the motor drives, positive pulls counter-clockwise", "", -1,
     of_station<[](const Drive& drive) -> int64_t { return drive.load_torque(); }>, "Nm", 1e-4, 4},
    put_load_torque, [](const Drive& drive) { return !drive.is_driven(); });

int64_t status_of(const Drive& drive) { return drive.status_word_1(); }
int64_t fault_of(const Drive& drive) { return drive.fault(); }

// H478 and H479 are the program's values for both outputs (IPOS OUTPUT).
template <size_t output, bool current>
constexpr DriveValue analog_output(std::string_view name) {
  DriveValue row{name, "analog output", output == 0 ? "640" : "643"};
  row.read = [](const Station& station) -> int64_t {
    const int32_t ipos = station.config().unit->runs_programs() ? station.variable(static_cast<uint32_t>(478 + output)) : 0;
    const AnalogLevel level = station.powered() ? station.drive().state().analog_output(output, ipos) : AnalogLevel{};
    return current ? level.microampere : level.millivolt;
  };
  row.unit = current ? "mA" : "V";
  row.factor = 0.001;
  row.decimals = 3;
  return row;
}

constexpr DriveValue kDriveValues[] = {
    {.name = "speed", .meaning = "P000", .parameter = "000", .decided = of_drive<&Drive::shown_speed>},
    {"frequency", "P002", "002"},
    {"position", "P003", "003"},
    {"current", "P004", "004"},
    {"active_current", "P005", "005"},
    {"motor_utilization", "P006", "006"},
    {"dc_link", "P008", "008"},
    {"temperature", "P014", "014"},
    decided_value<&Drive::axis_setpoint>(
        {"setpoint", "speed the ramp orders", "", -1, nullptr, "rpm", 0.001, 3}),
    kShaftSpeed,
    {"shaft_angle", "turned since the start", "", -1,
     of_station<[](const Drive& drive) { return drive.shaft_angle(); }>, "rad", 1e-6, 6},
    kLoadTorque,
    {"torque", "of the motor as simulated", "", -1,
     [](const Station& station) -> int64_t { return station.powered() ? station.drive().state().axis().torque : 0; },
     "%Mn", 0.001, 3},
    analog_output<0, false>("AO1"),
    analog_output<0, true>("AO1_current"),
    analog_output<1, false>("AO2"),
    analog_output<1, true>("AO2_current"),
    {"position_setpoint", "H491", "", 491, nullptr, "inc"},
    {"position_target", "H492", "", 492, nullptr, "inc"},
    {"lag", "H495", "", 495, nullptr, "inc"},
    {"status", "status word 1", "", -1, of_station<status_of>, "", 1, 0, kWordBits, status_of},
    {"fault", "fault number; 0 is none", "", -1, of_station<fault_of>, "", 1, 0, 0, fault_of},
};

bool has(const stdlib::UnitType& unit, const DriveValue& row) {
  if (row.read != nullptr) return row.parameter.empty() || find_parameter(unit, row.parameter) != nullptr;
  if (row.variable >= 0)
    return unit.has(stdlib::Trait::Positioning);
  return find_parameter(unit, row.parameter) != nullptr;
}

}  // namespace

bool is_drive_value(std::string_view name) {
  return std::any_of(std::begin(kDriveValues), std::end(kDriveValues),
                     [name](const DriveValue& row) { return row.name == name; });
}

bool has_drive_value(const stdlib::UnitType& unit, std::string_view name) {
  return std::any_of(std::begin(kDriveValues), std::end(kDriveValues),
                     [&](const DriveValue& row) { return row.name == name && has(unit, row); });
}

std::vector<std::string> drive_value_names(const Station& station) {
  std::vector<std::string> names;
  for (const DriveValue& row : kDriveValues)
    if (has(*station.config().unit, row)) names.emplace_back(row.name);
  return names;
}

void add_drive_values(Collector& out) {
  const Station& station = out.station();
  for (const DriveValue& row : kDriveValues) {
    if (!has(*station.config().unit, row)) continue;
    if (row.read == nullptr && row.variable < 0) {
      const stdlib::Parameter& parameter = *find_parameter(*station.config().unit, row.parameter);
      Signal& signal = out.add_parameter(parameter, Group::Drive, row.name);
      if (parameter.index == index::kSpeed) signal.decided = row.decided;
      continue;
    }
    Signal& signal = row.read != nullptr
                              ? out.add(Group::Drive, row.name, row.meaning,
                                        [&station, read = row.read] { return read(station); })
                              : out.add_variable(Group::Drive, row.name,
                                                 static_cast<uint32_t>(row.variable), row.meaning);
    signal.unit = row.unit;
    signal.factor = row.factor;
    signal.decimals = row.decimals;
    signal.bits = row.bits;
    signal.decided = row.decided;
    signal.is_status = row.name == "status";
    if (row.put == nullptr) continue;
    signal.number = row.number;
    if (!row.can_put(station.drive().state())) continue;
    signal.put = row.put;
    signal.limits = {INT32_MIN, INT32_MAX};
  }
}

}  // namespace ipos::signals
