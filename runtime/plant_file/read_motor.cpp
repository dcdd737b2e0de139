// [station.motor] and its neighbours: the nameplate, the unit's rating, the brake, the load, and whether the control is ideal.
// Numbers with a unit are texts; a number of [station.load] is % of the rotor's inertia or of the rated torque.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "runtime/motion/motor.hpp"
#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

constexpr std::string_view kOrNumber = "a number, in %, or ", kOrText = ", or a text with its unit";

// A unit as it is written, and what it is of the base unit.
struct UnitName {
  std::string_view name;
  double factor;
};
struct Quantity {
  std::array<UnitName, 3> units;  // as many as have a name
  double least, most;  // in the first unit
  std::string_view example;
};
constexpr Quantity kPower{{{{"kW", 1e3}, {"W", 1}}}, 0.01, 1'000, "1.5 kW"};
constexpr Quantity kVoltage{{{{"V", 1}}}, 50, 1'000, "400 V"};
constexpr Quantity kFrequency{{{{"Hz", 1}}}, 10, 400, "50 Hz"};
constexpr Quantity kCurrent{{{{"A", 1}}}, 0.05, 2'000, "3.6 A"};
constexpr Quantity kSpeed{{{{"rpm", 1}, {"1/min", 1}}}, 50, 10'000, "1400 rpm"};
constexpr Quantity kInertia{{{{"kgm2", 1}, {"kgcm2", 1e-4}, {"kg cm2", 1e-4}}}, 1e-7, 1e5, "0.002 kgm2"};
constexpr Quantity kTorque{{{{"Nm", 1}}}, -1e5, 1e5, "5 Nm"};
constexpr Quantity kFriction{{{{"Nm", 1}}}, 0, 1e5, "0.5 Nm"};
constexpr Quantity kStiffness{{{{"Nm/rad", 1}}}, 1e-3, 1e8, "200 Nm/rad"};
constexpr Quantity kDamping{{{{"Nms/rad", 1}}}, 0, 1e5, "0.02 Nms/rad"};
constexpr Quantity kTime{{{{"ms", 1}, {"s", 1e3}}}, 0, 60'000, "100 ms"};
constexpr Quantity kNoise{{{{"%", 1}}}, 0, 10, "0.2 %"};
constexpr Quantity kAngle{{{{"deg", std::numbers::pi / 180}, {"rad", 1}}}, 0, 3'600, "1 deg"};

// A value in % between two ends, kept in parts of `parts` to the percent.
void read_percentage(PlantReader& reader, const toml::table& table, std::string_view key, int32_t least,
                     int32_t most, int32_t parts, int32_t& out, std::string_view or_text = {}) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return;
  const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value) return reader.error(place_of(*node), fmt::format("{} must be a number, in %{}", key, or_text));
  if (!(*value >= least && *value <= most))
    return reader.error(place_of(*node), fmt::format("{} is {} to {} %", key, least, most),
                        AllowedValues{{}, least, most, "%"});
  out = static_cast<int32_t>(std::lround(*value * parts));
}

std::optional<double> parse_quantity(std::string_view text, const Quantity& quantity) {
  for (const UnitName& unit : quantity.units) {
    if (unit.name.empty() || !text.ends_with(unit.name)) continue;
    std::string_view digits = text.substr(0, text.size() - unit.name.size());
    while (digits.ends_with(' ')) digits.remove_suffix(1);
    size_t used = 0;
    const bool plain = !digits.empty() && digits.find_first_not_of("0123456789.eE+-") == std::string_view::npos;
    if (!plain) continue;
    try {
      const double value = std::stod(std::string(digits), &used);
      if (used == digits.size() && std::isfinite(value)) return value * unit.factor;
    } catch (const std::exception&) {
    }
  }
  return std::nullopt;
}

// In base units. Nothing with an error, or when it is not there. `or_number`: what the key takes beside a text.
std::optional<double> read_quantity(PlantReader& reader, const toml::table& table, std::string_view key,
                                    const Quantity& quantity, std::string_view or_number = {}) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  const auto value = node->is_string() ? parse_quantity(node->value_or(std::string()), quantity) : std::nullopt;
  const UnitName& first = quantity.units.front();
  if (!value)
    reader.error(place_of(*node),
                 fmt::format("{} must be {}a text with its unit, such as \"{}\"{}", key, or_number, quantity.example,
                             node->is_string() ? fmt::format(", not '{}'", node->value_or(std::string())) : ""));
  else if (!(*value >= quantity.least * first.factor && *value <= quantity.most * first.factor))
    reader.error(place_of(*node), fmt::format("{} is {:g} to {:g} {}", key, quantity.least, quantity.most, first.name));
  else
    return value;
  return std::nullopt;
}

// A word of a short list by its place in it.
std::optional<size_t> read_word(PlantReader& reader, const toml::table& table, std::string_view key,
                                const std::vector<std::string_view>& words) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  const std::string word = reader.text(table, key, "", true);
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<size_t>(found - words.begin());
  AllowedValues allowed;
  for (const std::string_view one : words) allowed.each.emplace_back(fmt::format("\"{}\"", one));
  if (!word.empty())
    reader.error(place_of(*node), fmt::format("unknown {} '{}'; known are {}", key, word, fmt::join(words, ", ")),
                 std::move(allowed));
  return std::nullopt;
}

void read_nameplate(PlantReader& reader, const toml::table& table, MachineData& machine) {
  reader.known_keys(table, "[station.motor]",
                    {"type", "power", "voltage", "frequency", "current", "speed", "cos_phi", "inertia"});
  Nameplate plate;
  std::vector<std::string_view> names;
  for (const MotorType& type : motor_types()) names.push_back(type.name);
  const auto type = read_word(reader, table, "type", names);
  if (type) plate = motor_types()[*type].plate;
  const size_t errors = reader.result.errors.size();
  const auto take = [&](std::string_view key, const Quantity& quantity, double& out) {
    if (const auto value = read_quantity(reader, table, key, quantity)) out = *value;
  };
  take("power", kPower, plate.power);
  take("voltage", kVoltage, plate.voltage);
  take("frequency", kFrequency, plate.frequency);
  take("current", kCurrent, plate.current);
  take("speed", kSpeed, plate.speed);
  take("inertia", kInertia, plate.inertia);
  if (const toml::node* node = table.get("cos_phi")) {
    plate.cos_phi = node->is_number() ? node->value_or(0.0) : 0;
    if (!(plate.cos_phi >= 0.1 && plate.cos_phi < 1))
      reader.error(place_of(*node), "cos_phi must be a number, 0.1 to 0.99");
  }
  if (table.contains("type") && !type) return;
  if (!table.contains("type"))
    for (const std::string_view key : {"power", "current", "speed", "cos_phi", "inertia"})
      if (!table.contains(key))
        reader.error(place_of(table), fmt::format("[station.motor] needs {} = ..., or type = \"...\"", key));
  if (reader.result.errors.size() != errors) return;
  const auto place = [&](std::string_view key) { return place_of(table.contains(key) ? *table.get(key) : table); };
  if (plate.speed > 60 * plate.frequency || plate.synchronous() - plate.speed < 0.5)
    return reader.error(place("speed"), fmt::format("speed is below the synchronous speed, {:g} rpm: that of an asynchronous motor at its rated torque",
                                                    plate.synchronous()));
  if (plate.speed < 0.6 * plate.synchronous())
    return reader.error(place("speed"), fmt::format("speed {:g} rpm is no rated speed with {:g} Hz", plate.speed, plate.frequency));
  if (plate.efficiency() >= 1)
    return reader.error(place("power"), "power is more than voltage, current and cos_phi bring to the motor");
  fit_motor(machine, plate);
}

// Inertia as a share of the rotor's, or in kgm², which is kept exactly.
void read_inertia(PlantReader& reader, const toml::table& table, MachineData& machine) {
  const toml::node* node = table.get("inertia");
  if (node == nullptr) return;
  const double rotor = machine.run_up_us == 0 ? machine.rotor_run_up_ms * 1e3
                                              : machine.run_up_us * 100.0 / (100 + machine.inertia);  // run-up, us
  if (!node->is_string()) {
    read_percentage(reader, table, "inertia", 0, 100'000, 1, machine.inertia, kOrText);
    if (machine.run_up_us != 0) machine.run_up_us = static_cast<int32_t>(std::lround(rotor * (100 + machine.inertia) / 100));
    return;
  }
  const auto value = read_quantity(reader, table, "inertia", kInertia, kOrNumber);
  if (!value) return;
  const double more = *value / (rotor_inertia(machine) * rotor / (machine.rotor_run_up_ms * 1e3));
  const double run_up = rotor * (1 + more);
  if (run_up > 2e9) return reader.error(place_of(*node), "inertia is too much for this motor");
  machine.inertia = static_cast<int32_t>(std::min(std::lround(more * 100), 100'000L));
  machine.run_up_us = static_cast<int32_t>(std::lround(run_up));
}

// As a share of the rated torque, or in Nm.
void read_torque(PlantReader& reader, const toml::table& table, std::string_view key, const Quantity& quantity,
                 int32_t least, const MachineData& machine, int32_t& out) {
  const toml::node* node = table.get(key);
  if (node == nullptr || !node->is_string())
    return read_percentage(reader, table, key, least, 1'000, 1'000, out, kOrText);
  const auto value = read_quantity(reader, table, key, quantity, kOrNumber);
  if (!value) return;
  const double share = *value / rated_torque(machine) * 100'000;
  if (std::abs(share) > kTopTorque / 4)
    return reader.error(place_of(*node), fmt::format("{} is at most ten times the rated torque, {:.3g} Nm", key, rated_torque(machine)));
  out = static_cast<int32_t>(std::lround(share));
}

void read_second(PlantReader& reader, const toml::table& load, MachineData& machine) {
  const toml::table* table = reader.subtable(load, "second");
  if (table == nullptr) return;
  reader.known_keys(*table, "[station.load.second]", {"inertia", "stiffness", "damping", "backlash"});
  for (const std::string_view key : {"inertia", "stiffness"})
    if (!table->contains(key)) reader.error(place_of(*table), fmt::format("[station.load.second] needs {} = ...", key));
  const auto take = [&](std::string_view key, const Quantity& quantity, double& out) {
    if (const auto value = read_quantity(reader, *table, key, quantity)) out = *value;
  };
  take("inertia", kInertia, machine.second_inertia);
  take("stiffness", kStiffness, machine.stiffness);
  take("damping", kDamping, machine.damping);
  take("backlash", kAngle, machine.backlash);
}

void read_load(PlantReader& reader, const toml::table& station, StationConfig& config) {
  const toml::table* table = reader.subtable(station, "load");
  if (table == nullptr) return;
  reader.known_keys(*table, "[station.load]",
                    {"inertia", "friction", "torque", "torque_by", "per_turn", "brake", "braking_resistor", "driven", "second"});
  MachineData& machine = config.machine;
  read_inertia(reader, *table, machine);
  read_torque(reader, *table, "friction", kFriction, 0, machine, machine.friction);
  read_torque(reader, *table, "torque", kTorque, -1'000, machine, machine.load_torque);
  if (const auto shape = read_word(reader, *table, "torque_by", {"constant", "speed", "position"}))
    machine.load_shape = static_cast<LoadShape>(*shape);
  if (const toml::node* node = table->get("per_turn")) {
    const double turns = node->is_number() ? node->value_or(0.0) : 0;
    if (!(std::abs(turns) >= 0.001 && std::abs(turns) <= 1'000))
      reader.error(place_of(*node), "per_turn must be a number, 0.001 to 1000: turns of what is driven in a turn of the motor");
    else if (machine.load_shape != LoadShape::ByPosition)
      reader.error(place_of(*node), "per_turn needs torque_by = \"position\"");
    else
      machine.load_turns = static_cast<int32_t>(std::lround(turns * 1'000));
  }
  machine.brake = reader.flag(*table, "brake").value_or(machine.brake);
  machine.driven = reader.flag(*table, "driven").value_or(machine.driven);
  machine.braking_resistor = reader.flag(*table, "braking_resistor").value_or(machine.braking_resistor);
  read_second(reader, *table, machine);
  if (machine.driven && (is_detailed([&] { MachineData m = machine; m.driven = false; return m; }()) || config.options.real_control))
    reader.error(place_of(*table->get("driven")),
                 "driven = true goes without control = \"real\", torque_by, brake times and a second mass: the shaft is somebody else's");
}

// The seed is the station's name, so that each has its own (ours).
void read_noise(PlantReader& reader, const toml::table& station, StationConfig& config) {
  const auto noise = read_quantity(reader, station, "noise", kNoise);
  if (!noise) return;
  config.machine.noise = static_cast<int32_t>(std::lround(*noise * 1'000));
  for (const char letter : config.name)
    config.machine.noise_seed = (config.machine.noise_seed ^ static_cast<uint8_t>(letter)) * 16'777'619U;
}

void read_brake(PlantReader& reader, const toml::table& station, MachineData& machine) {
  const toml::table* table = reader.subtable(station, "brake");
  if (table == nullptr) return;
  reader.known_keys(*table, "[station.brake]", {"release", "apply"});
  const auto take = [&](std::string_view key, int32_t& ms) {
    if (const auto time = read_quantity(reader, *table, key, kTime)) ms = static_cast<int32_t>(std::lround(*time));
  };
  take("release", machine.brake_release_ms);
  take("apply", machine.brake_apply_ms);
}

}  // namespace

void read_motor(PlantReader& reader, const toml::table& station, StationConfig& config) {
  MachineData& machine = config.machine;
  if (const toml::table* motor = reader.subtable(station, "motor")) {
    config.options.own_motor = true;
    read_nameplate(reader, *motor, machine);
  }
  if (const toml::table* rating = reader.subtable(station, "unit_rating")) {
    reader.known_keys(*rating, "[station.unit_rating]", {"power", "current", "type_code", "series", "size", "service_code"});
    config.options.type_code = static_cast<int32_t>(reader.count(*rating, "type_code", INT32_MAX, 0));
    const auto power = read_quantity(reader, *rating, "power", kPower);
    const auto current = read_quantity(reader, *rating, "current", kCurrent);
    if (power || current) fit_unit(machine, power, current);
  }
  if (const auto control = read_word(reader, station, "control", {"ideal", "real"}))
    config.options.real_control = config.machine.real = *control == 1;
  read_noise(reader, station, config);
  read_brake(reader, station, machine);
  read_load(reader, station, config);
}

}  // namespace ipos::runtime
