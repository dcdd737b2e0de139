// The checks, line by line and station by station.
#include "runtime/plant_file/serial_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/movilink/serial_telegram.hpp"
#include "stdlib/control_sources.hpp"

namespace ipos::runtime {
namespace {

using stdlib::Trait;

constexpr uint32_t kStationLimit = 32;  // electrical loads on a line (1053 1610 p. 8)
constexpr uint32_t kUss21aLoads = 2;    // at most 16 of them (p. 7, 15)

// Cable of RS-485 (1053 1610 p. 14-15; MDX60B/61B p. 15 prints 40 pF/m without a comparison sign).
constexpr uint32_t kLeastImpedance = 100;  // ohm at 1 MHz
constexpr uint32_t kMostImpedance = 150;
constexpr uint32_t kCapacitance = 40;  // pF/m at 1 kHz, at most

struct LengthLimit {
  uint32_t mm;
  const char* of;
};
constexpr LengthLimit kRs485Length{200'000, "RS-485 line"};
constexpr LengthLimit kRs232Length{5'000, "RS-232 line"};
constexpr LengthLimit kXtLength{3'000, "line at XT of MOVIDRIVE B"};
constexpr LengthLimit kShieldedXtLength{5'000, "shielded line at XT of MOVIDRIVE B"};

std::string metres(uint32_t mm) {
  return mm % 1000 == 0 ? fmt::format("{}", mm / 1000) : fmt::format("{}.{:03}", mm / 1000, mm % 1000);
}

// What stands on one line.
struct LineStations {
  std::vector<size_t> all;
  uint32_t loads = 0;
  bool point_to_point = false;  // XT of MOVIDRIVE B
};

LineStations stations_of(const PlantFile& plant, const std::string& bus) {
  LineStations found;
  for (size_t n = 0; n < plant.stations.size(); ++n) {
    const StationConfig& station = plant.stations[n];
    const bool x13 = station.serial.x13.bus == bus;
    const bool xt = station.serial.xt.bus == bus;
    if (!x13 && !xt) continue;
    found.all.push_back(n);
    found.loads += xt && station.serial.uss21a ? kUss21aLoads : 1;
    if (xt && station.unit != nullptr && serial_interfaces(*station.unit).xt_has_s13)
      found.point_to_point = true;
  }
  return found;
}

LengthLimit length_limit(const BusConfig& bus, const LineStations& stations) {
  if (stations.point_to_point) return bus.shielded ? kShieldedXtLength : kXtLength;
  return bus.kind == BusKind::Rs232 ? kRs232Length : kRs485Length;
}

bool may_be_master(const StationConfig& station) {
  const auto sends = [](const ParameterSetting& setting) {
    return (setting.parameter == "P750" || setting.parameter == "8592") && sends_setpoints(setting.value);
  };
  return !station.program.empty() || std::any_of(station.parameters.begin(), station.parameters.end(), sends);
}

class Checker {
 public:
  explicit Checker(const PlantFile& plant) : plant_(plant) {}

  std::vector<PlantError> run() {
    for (const StationConfig& station : plant_.stations)
      if (station.unit != nullptr) check(station);
    for (const BusConfig& bus : plant_.buses)
      if (is_serial(bus.kind)) check(bus);
    return std::move(errors_);
  }

 private:
  void error(FilePlace place, std::string text) { errors_.push_back({place, std::move(text)}); }

  void check(const StationConfig& station) {
    const SerialConfig& serial = station.serial;
    const SerialInterfaces has = serial_interfaces(*station.unit);
    const bool xt = !serial.xt.bus.empty();
    if (!serial.x13.bus.empty() && !has.x13)
      error(serial.x13.place, fmt::format("unit {} has no RS-485 terminals{}", station.unit->name,
                                          has.xt ? "; it has rs485_xt" : ""));
    if (xt && !has.xt)
      error(serial.xt.place, fmt::format("unit {} has no XT or TERMINAL socket", station.unit->name));
    if (!serial.x13.bus.empty() && serial.x13.bus == serial.xt.bus)
      error(serial.xt.place, "both interfaces of the unit are on the same line");
    if (serial.keypad && !has.xt)
      error(serial.keypad_place, fmt::format("unit {} has no socket for a keypad", station.unit->name));
    if (serial.keypad && (xt || serial.uss21a))
      error(serial.keypad_place, "the keypad takes the socket: it excludes rs485_xt and uss21a");
    if (serial.uss21a && !has.xt_needs_uss21a)
      error(serial.uss21a_place, fmt::format("unit {} takes no USS21A", station.unit->name));
    if (xt && has.xt_needs_uss21a && !serial.uss21a)
      error(serial.xt.place, "RS-485 at the TERMINAL socket needs uss21a = true");
    if (serial.s13_place.line != 0 && !has.xt_has_s13)
      error(serial.s13_place, fmt::format("unit {} has no DIP switch S13", station.unit->name));
  }

  void check(const BusConfig& bus) {
    const LineStations stations = stations_of(plant_, bus.name);
    const bool master = std::any_of(stations.all.begin(), stations.all.end(),
                                    [&](size_t n) { return may_be_master(plant_.stations[n]); });
    const uint32_t slaves = static_cast<uint32_t>(stations.all.size()) - (master ? 1 : 0);
    if (stations.loads > kStationLimit || slaves > kStationLimit - 1)
      error(bus.place,
            fmt::format("'{}' has {} stations that count as {}; a line takes 32: one master and 31 "
                        "slaves, and a unit with USS21A counts twice",
                        bus.name, stations.all.size(), stations.loads));
    const bool one_to_one = bus.kind == BusKind::Rs232 || stations.point_to_point;
    if (one_to_one && (stations.all.size() > 2 || slaves > 1))
      error(bus.place, fmt::format("'{}' connects one master and one slave, not {} stations", bus.name,
                                   stations.all.size()));
    if (bus.kind == BusKind::Rs485) check_cable(bus);
  }

  void check_cable(const BusConfig& bus) {
    if (bus.impedance != 0 && (bus.impedance < kLeastImpedance || bus.impedance > kMostImpedance))
      error(bus.place, fmt::format("'{}': cable of {} ohm; a RS-485 line needs {} to {} ohm", bus.name,
                                   bus.impedance, kLeastImpedance, kMostImpedance));
    if (bus.capacitance > kCapacitance)
      error(bus.place, fmt::format("'{}': cable of {} pF/m; a RS-485 line may have {} pF/m", bus.name,
                                   bus.capacitance, kCapacitance));
  }

  const PlantFile& plant_;
  std::vector<PlantError> errors_;
};

class Finder {
 public:
  Finder(const PlantFile& plant, const ParameterOf& parameter) : plant_(plant), parameter_(parameter) {}

  std::vector<PlanFinding> run() {
    for (size_t n = 0; n < plant_.stations.size(); ++n) check(n);
    for (const BusConfig& bus : plant_.buses)
      if (is_serial(bus.kind)) check(bus, stations_of(plant_, bus.name).all);
    return std::move(findings_);
  }

 private:
  const std::string& name(size_t n) const { return plant_.stations[n].name; }
  bool sends(size_t n) const { return sends_setpoints(parameter_(n, "750")); }
  bool follows(size_t n) const { return stdlib::follows_rs485_master(parameter_(n, "100")); }

  void check(size_t n) {
    const SerialConfig& serial = plant_.stations[n].serial;
    if (serial.keypad && !serial.x13.bus.empty() && parameter_(n, "812") != 0)
      findings_.push_back(
          {name(n),
           "the keypad sends requests all the time, so P812 does not monitor the other RS-485 "
           "interface",
           false});
    const int32_t source = parameter_(n, "100");
    const int32_t setpoint = parameter_(n, "750");
    const bool is_part = sends_setpoints(setpoint) || stdlib::follows_rs485_master(source);
    if ((stdlib::follows_sbus_master(source) || stdlib::follows_rs485_master(source)) && setpoint != 0)
      findings_.push_back({name(n), "a slave of a master/slave connection (P100) must have P750 = 0"});
    if (is_part && serial.x13.bus.empty())
      findings_.push_back({name(n), "master/slave operation over RS-485 needs X13 (key rs485)"});
    if (is_part && parameter_(n, "811") <= kNoGroupAddress)
      findings_.push_back({name(n), "master/slave operation needs a group address P811 above 100"});
  }

  void check(const BusConfig& bus, const std::vector<size_t>& stations) {
    for (size_t i = 0; i < stations.size(); ++i)
      for (size_t k = i + 1; k < stations.size(); ++k) check_pair(bus, stations[i], stations[k]);
  }

  void check_pair(const BusConfig& bus, size_t a, size_t b) {
    if (parameter_(a, "810") == parameter_(b, "810"))
      findings_.push_back({"", fmt::format("{}: {} and {} both have address P810 = {}; their answers collide",
                                           bus.name, name(a), name(b), parameter_(a, "810"))});
    if (sends(a) && sends(b))
      findings_.push_back(
          {"", fmt::format("{}: {} and {} are both masters (P750)", bus.name, name(a), name(b))});
    if (((sends(a) && follows(b)) || (follows(a) && sends(b))) &&
        parameter_(a, "811") != parameter_(b, "811"))
      findings_.push_back(
          {"", fmt::format("{}: {} and {} have different group addresses P811, so the slave does not follow",
                           bus.name, name(a), name(b))});
  }

  const PlantFile& plant_;
  const ParameterOf& parameter_;
  std::vector<PlanFinding> findings_;
};

}  // namespace

SerialInterfaces serial_interfaces(const stdlib::UnitType& unit) {
  return {unit.has(Trait::SerialX13), unit.has(Trait::SerialXt), unit.has(Trait::SerialXtByOption),
          unit.has(Trait::SerialXtSwitch)};
}

uint32_t xt_baud(const StationConfig& station) {
  return serial_interfaces(*station.unit).xt_has_s13 && !station.serial.s13 ? kFactoryXtBaud : kS13Baud;
}

bool sends_setpoints(int32_t p750) {
  switch (p750) {
    case 1:
    case 3:
    case 4:
    case 6:
    case 7:
    case 9: return true;
    default: return false;
  }
}

uint32_t serial_length_limit(const PlantFile& plant, const BusConfig& bus) {
  return length_limit(bus, stations_of(plant, bus.name)).mm;
}

std::vector<SerialCableFinding> serial_cable_findings(const PlantFile& plant, const BusConfig& bus) {
  std::vector<SerialCableFinding> found;
  const LengthLimit limit = length_limit(bus, stations_of(plant, bus.name));
  if (bus.length_mm > limit.mm)
    found.push_back({SerialCableFinding::Rule::TooLong, fmt::format("{} m of cable, a {} may have {} m",
                                                                    metres(bus.length_mm), limit.of, metres(limit.mm))});
  if (bus.terminated)
    found.push_back({SerialCableFinding::Rule::Terminated, "the units have terminating resistors; connect no others"});
  return found;
}

std::vector<PlantError> check_serial_plan(const PlantFile& plant) { return Checker(plant).run(); }

std::vector<PlanFinding> serial_findings(const PlantFile& plant, const ParameterOf& parameter) {
  return Finder(plant, parameter).run();
}

}  // namespace ipos::runtime
