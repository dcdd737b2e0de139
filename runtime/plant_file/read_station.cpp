// [[station]] of the plant file with its subtables.
#include <algorithm>
#include <cmath>

#include "runtime/clock/own_milliseconds.hpp"
#include "runtime/plant_file/plant_reader.hpp"
#include "stdlib/plain_text.hpp"
#include "stdlib/unit_names.hpp"

namespace ipos::runtime {
namespace {

constexpr std::string_view kGatewayUnit = "gateway";  // no unit with a drive: a kind of station of its own

// A switch of the unit; absent is false. `place` is set where it stands.
bool fitted(PlantReader& reader, const toml::table& table, std::string_view key, FilePlace& place) {
  if (const toml::node* node = table.get(key)) place = place_of(*node);
  return reader.flag(table, key).value_or(false);
}

SerialConfig read_serial(PlantReader& reader, const toml::table& table) {
  SerialConfig config;
  config.x13 = reader.bus_use(table, "rs485", BusKind::Rs485);
  config.xt = reader.bus_use(table, "rs485_xt", BusKind::Rs485);
  config.keypad = fitted(reader, table, "keypad", config.keypad_place);
  config.uss21a = fitted(reader, table, "uss21a", config.uss21a_place);
  config.s13 = fitted(reader, table, "s13", config.s13_place);
  return config;
}

// The two digits after the point, as the MOVITRAC 07 manual writes versions: 15 for .15.
void read_firmware(PlantReader& reader, const toml::table& table, uint8_t& version) {
  const toml::node* node = table.get("firmware");
  int32_t value = 0;
  if (node == nullptr || !reader.number(*node, "firmware", value)) return;
  constexpr int32_t kLeast = 10, kMost = 99;
  if (value < kLeast || value > kMost)
    return reader.error(place_of(*node), "firmware is a version of two digits, 10..99",
                        AllowedValues{{}, kLeast, kMost});
  version = static_cast<uint8_t>(value);
}

void read_start_up(PlantReader& reader, const toml::table& table, uint32_t& ms) {
  const int64_t time = reader.duration(table, "start_up", 0);
  if (time > 60 * kSecond) return reader.error(place_of(*table.get("start_up")), "start_up is at most 60s");
  ms = static_cast<uint32_t>(std::max<int64_t>(time, 0) / kMillisecond);
}

void read_clock(PlantReader& reader, const toml::table& table, int32_t& ppm) {
  const toml::node* node = table.get("clock_ppm");
  if (node == nullptr || !reader.number(*node, "clock_ppm", ppm)) return;
  constexpr auto kMost = static_cast<int32_t>(OwnMilliseconds::kMostPpm);
  if (ppm < -kMost || ppm > kMost)
    reader.error(place_of(*node), fmt::format("clock_ppm is {}..{}", -kMost, kMost), AllowedValues{{}, -kMost, kMost});
}

// Whether the unit is switched on with its mains, or by its 24 V supply alone (MOVITRAC 31 PROFIBUS, 3.1).
void read_mains(PlantReader& reader, const toml::table& table, bool& mains) {
  if (table.contains("mains")) mains = reader.off_or_on(table, "mains", "a [[station]]").value_or(true);
}

// MOVITRAC 07 comes as standard unit, a slave only, and as LOGODrive with IPOS (its manual, chapter 2).
void read_logodrive(PlantReader& reader, const toml::table& table, StationConfig& config) {
  const toml::node* node = table.get("logodrive");
  if (node == nullptr) return;
  config.options.logodrive = reader.flag(table, "logodrive").value_or(true);
  if (config.unit != nullptr && !config.unit->has(stdlib::Trait::Logodrive))
    reader.error(place_of(*node),
                 fmt::format("logodrive is of {}; unit {} has no such variants",
                             stdlib::unit_names(stdlib::Trait::Logodrive), config.unit->name));
}

void read_memory(PlantReader& reader, const toml::table& table, StationConfig& config) {
  config.nvram = reader.text(table, "nvram", "", false);
  const toml::node* nvram = table.get("nvram");
  if (nvram == nullptr) return;
  config.nvram_place = place_of(*nvram);
  if (!config.nvram.empty() && !reader.nvram_files.insert(config.nvram).second)
    reader.error(config.nvram_place, fmt::format("two stations keep their memory in '{}'", config.nvram));
}

void read_parameters(PlantReader& reader, const toml::table& table, StationConfig& config) {
  const toml::table* settings = reader.subtable(table, "parameters");
  if (settings == nullptr) return;
  for (const auto& [key, value] : *settings) {
    ParameterSetting setting;
    setting.parameter = key.str();
    setting.place = place_of(key.source());
    if (reader.parameter_value(value, config.unit, setting.parameter, setting.value))
      config.parameters.push_back(std::move(setting));
  }
  // TOML tables are sorted by key; the order of the file is the order of writing.
  std::stable_sort(config.parameters.begin(), config.parameters.end(), [](const auto& a, const auto& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
}

void read_inputs(PlantReader& reader, const toml::table& table, StationConfig& config) {
  const toml::table* settings = reader.subtable(table, "inputs");
  if (settings == nullptr) return;
  for (const auto& [key, value] : *settings) {
    const int input = parse_input(key.str());
    int32_t level = 0;
    if (input < 0)
      reader.error(place_of(key.source()),
                   fmt::format("'{}' is no input; inputs are DI00..DI07 and DI10..DI17", key.str()));
    else if (value.is_boolean())
      level = value.as_boolean()->get() ? 1 : 0;
    else if (!reader.number(value, key.str(), level))
      continue;
    if (level != 0 && level != 1)
      reader.error(place_of(value.source()), fmt::format("{} is 0 or 1", key.str()),
                   AllowedValues{{"0", "1", "true", "false"}});
    if (input >= 0)
      config.inputs.push_back({static_cast<uint8_t>(input), level == 1, place_of(key.source())});
  }
}

// Signals held from the start, as text with unit. What an input is wired for, voltage or current, the unit
// says.
void read_analog(PlantReader& reader, const toml::table& table, StationConfig& config) {
  const toml::table* settings = reader.subtable(table, "analog");
  if (settings == nullptr) return;
  for (const auto& [key, value] : *settings) {
    const std::string signal = value.value_or(std::string());
    if (parse_analog_input(key.str()) < 0)
      reader.error(
          place_of(key.source()),
          fmt::format("'{}' is no analog input; known are AI1, AI2, frequency, potentiometer", key.str()));
    else if (const auto setting = parse_analog(key.str(), signal))
      analog_value(config.analog, setting->line) = setting->value;
    else
      reader.error(place_of(value.source()), fmt::format("{} needs {}", key.str(), kAnalogForms));
  }
}

void read_hex(PlantReader& reader, const toml::table& table, StationConfig& config) {
  const toml::node* node = table.get("hex");
  if (node == nullptr) return;
  const toml::array* names = node->as_array();
  if (names == nullptr) return reader.error(place_of(node->source()), "hex must be a list of variable names");
  for (const toml::node& name : *names) {
    const auto* value = name.as_string();
    if (value != nullptr && stdlib::is_plain(value->get()) && !value->get().empty())
      config.hex.push_back(value->get());
    else
      reader.error(place_of(name.source()), "hex must be a list of variable names");
  }
}

// Each line has a switch of its own. A unit on one line alone needs no other key than the plain one.
void read_terminators(PlantReader& reader, const toml::table& table, StationConfig& config) {
  const std::optional<bool> plain = config.terminator = reader.flag(table, "terminator");
  config.terminator2 = reader.flag(table, "terminator2");
  config.profibus.terminator = reader.flag(table, "profibus_terminator");
  if (config.terminator2 && config.sbus2.empty())
    reader.error(place_of(*table.get("terminator2")), "terminator2 is switch R of SBus 2: it needs sbus2");
  if (config.profibus.terminator && !table.contains("profibus"))
    reader.error(place_of(*table.get("profibus_terminator")),
                 "profibus_terminator is the one of the fieldbus card: it needs profibus");
  if (!plain || !config.sbus.empty()) return;
  std::optional<bool>& only = config.sbus2.empty() ? config.profibus.terminator : config.terminator2;
  if (!only) only = plain;
}

void read_station(PlantReader& reader, const toml::table& table) {
  if (table["unit"].value_or(std::string()) == kGatewayUnit) return read_gateway(reader, table);
  reader.known_keys(table, "[[station]]",
                    {"name",
                     "unit",
                     "firmware",
                     "logodrive",
                     "start_up",
                     "clock_ppm",
                     "mains",
                     "program",
                     "sbus",
                     "sbus2",
                     "device",
                     "terminator",
                     "branch",
                     "rs485",
                     "rs485_xt",
                     "keypad",
                     "uss21a",
                     "s13",
                     "option",
                     "profibus",
                     "profibus_address",
                     "fms_switch",
                     "cards",
                     "nvram",
                     "parameters",
                     "inputs",
                     "analog",
                     "motor",
                     "unit_rating",
                     "control",
                     "noise",
                     "brake",
                     "load",
                     "machine",
                     "encoders",
                     "hex",
                     "terminator2",
                     "profibus_terminator"});
  StationConfig config;
  config.place = place_of(table.source());
  config.name = reader.text(table, "name", "a [[station]]", true);
  reader.new_station(config.name, config.place);
  const std::string unit = reader.text(table, "unit", "a [[station]]", true);
  config.unit = stdlib::find_unit_or_plate(unit);
  if (config.unit == nullptr && !unit.empty()) {
    reader.error(place_of(table.get("unit")->source()),
                 fmt::format("{}, {}", stdlib::no_unit_text(unit), kGatewayUnit));
  }
  read_firmware(reader, table, config.options.firmware);
  read_start_up(reader, table, config.options.start_up_ms);
  read_clock(reader, table, config.options.clock_ppm);
  read_mains(reader, table, config.options.mains);
  read_logodrive(reader, table, config);
  read_cards(reader, table, config);
  config.program = reader.text(table, "program", "", false);
  if (const toml::node* program = table.get("program")) {
    config.program_place = place_of(program->source());
    if (config.unit != nullptr && !config.unit->runs_programs())
      reader.error(config.program_place, fmt::format("unit type {} runs no program", config.unit->name));
    if (!config.options.logodrive)
      reader.error(config.program_place,
                   "a standard MOVITRAC 07 (logodrive = false) is a slave only and runs no program");
  }
  config.sbus = reader.bus_name(table, "sbus", "", false);
  config.sbus2 = reader.bus_name(table, "sbus2", "", false);
  if (!config.sbus2.empty() && config.unit != nullptr && !config.unit->has(stdlib::Trait::Sbus2))
    reader.error(place_of(*table.get("sbus2")), fmt::format("unit {} has no SBus 2", config.unit->name));
  config.device = reader.text(table, "device", "", false);
  read_terminators(reader, table, config);
  config.branch = reader.flag(table, "branch").value_or(false);
  config.serial = read_serial(reader, table);
  read_profibus_card(reader, table, config);
  read_memory(reader, table, config);
  read_parameters(reader, table, config);
  read_inputs(reader, table, config);
  read_analog(reader, table, config);
  read_motor(reader, table, config);
  read_machine(reader, table, config);
  read_encoders(reader, table, config);
  read_hex(reader, table, config);
  reader.result.plant.stations.push_back(std::move(config));
}

}  // namespace

void read_stations(PlantReader& reader, const toml::table& root) {
  reader.for_each_table(root, "station", [&](const toml::table& table) { read_station(reader, table); });
}

}  // namespace ipos::runtime
