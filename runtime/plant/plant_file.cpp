// Reads the plant file with toml++. Each table has a list of the keys it knows; others are errors.
#define TOML_EXCEPTIONS 0
#include "runtime/plant/plant_file.hpp"

#include "runtime/plant/serial_plan.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <set>

namespace ipos::runtime {
namespace {

// The first byte beyond ASCII outside of texts and comments, where TOML allows none; the parser must not see
// it (toml++ 3.3 has undefined behaviour there). Nothing when there is none.
std::optional<FilePlace> stray_character(std::string_view text) {
  FilePlace place{1, 0};
  std::string_view quote;  // of the text we are in
  bool comment = false;
  for (size_t at = 0; at < text.size(); ++at) {
    ++place.column;
    const char c = text[at];
    if (c == '\n') {
      place = {place.line + 1, 0};
      comment = false;
      if (quote.size() == 1) quote = {};  // such a text ends with its line; the parser reports it
    } else if (comment) {
      continue;
    } else if (!quote.empty()) {
      if (c == '\\' && quote[0] == '"' && at + 1 < text.size() && text[at + 1] != '\n') {
        ++at, ++place.column;
      } else if (text.substr(at).starts_with(quote)) {
        at += quote.size() - 1;
        place.column += static_cast<uint32_t>(quote.size() - 1);
        quote = {};
      }
    } else if (c == '"' || c == '\'') {
      const std::string_view rest = text.substr(at);
      quote = rest.substr(0, rest.starts_with("\"\"\"") || rest.starts_with("'''") ? 3 : 1);
      at += quote.size() - 1;
      place.column += static_cast<uint32_t>(quote.size() - 1);
    } else if (c == '#') {
      comment = true;
    } else if (static_cast<unsigned char>(c) >= 0x80 && !(at < 3 && text.starts_with("\xEF\xBB\xBF"))) {
      return place;
    }
  }
  return std::nullopt;
}

FilePlace place_of(const toml::source_region& region) { return {region.begin.line, region.begin.column}; }

// Reads one plant file; collects all errors.
class Reader {
 public:
  PlantFileResult read(std::string_view text) {
    if (const auto place = stray_character(text)) {
      error(*place, "this character may only stand in a text or a comment");
      return std::move(result_);
    }
    const toml::parse_result parsed = toml::parse(text);
    if (!parsed) {
      result_.errors.push_back(
          {place_of(parsed.error().source()), fmt::format("{}", parsed.error().description())});
      return std::move(result_);
    }
    const toml::table& root = parsed.table();
    known_keys(root, "the plant", {"bus", "station", "expect"});
    for_each_table(root, "bus", [this](const toml::table& table) { bus(table); });
    for_each_table(root, "station", [this](const toml::table& table) { station(table); });
    for_each_table(root, "expect", [this](const toml::table& table) { expectation(table); });
    cross_check();
    std::stable_sort(result_.errors.begin(), result_.errors.end(), [](const auto& a, const auto& b) {
      return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
    });
    return std::move(result_);
  }

 private:
  void error(FilePlace place, std::string text) { result_.errors.push_back({place, std::move(text)}); }

  void known_keys(const toml::table& table, std::string_view what,
                  std::initializer_list<std::string_view> keys) {
    for (const auto& [key, value] : table) {
      if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
      error(place_of(key.source()),
            fmt::format("unknown key '{}' in {}; known are {}", key.str(), what, fmt::join(keys, ", ")));
    }
  }

  template <typename Action>
  void for_each_table(const toml::table& root, std::string_view key, Action action) {
    const toml::node* node = root.get(key);
    if (node == nullptr) return;
    const toml::array* tables = node->as_array();
    if (tables == nullptr)
      return error(place_of(node->source()), fmt::format("write [[{}]], one for each", key));
    for (const toml::node& entry : *tables) {
      if (const toml::table* table = entry.as_table())
        action(*table);
      else
        error(place_of(entry.source()), fmt::format("write [[{}]], one for each", key));
    }
  }

  // A text value, or the default; `required` makes absence an error.
  std::string text(const toml::table& table, std::string_view key, std::string_view what, bool required) {
    const toml::node* node = table.get(key);
    if (node == nullptr) {
      if (required) error(place_of(table.source()), fmt::format("{} needs {} = \"...\"", what, key));
      return {};
    }
    if (const auto* value = node->as_string()) return value->get();
    error(place_of(node->source()), fmt::format("{} must be a text in quotes", key));
    return {};
  }

  // A 32-bit value; hexadecimal numbers may use all 32 bits.
  bool number(const toml::node& node, std::string_view what, int32_t& out) {
    const auto* value = node.as_integer();
    if (value == nullptr) {
      error(place_of(node.source()), fmt::format("{} must be a whole number", what));
      return false;
    }
    if (value->get() < INT32_MIN || value->get() > UINT32_MAX) {
      error(place_of(node.source()), fmt::format("{} = {} does not fit into 32 bits", what, value->get()));
      return false;
    }
    out = static_cast<int32_t>(static_cast<uint32_t>(value->get()));
    return true;
  }

  void unique(std::set<std::string>& names, const std::string& name, std::string_view what, FilePlace place) {
    if (!name.empty() && !names.insert(name).second)
      error(place, fmt::format("there are two of {} '{}'", what, name));
  }

  struct KindName {
    std::string_view name;
    BusKind kind;
    uint32_t baud;  // factory setting
  };
  static constexpr KindName kKinds[] = {{"can", BusKind::Can, 500'000},
                                        {"rs485", BusKind::Rs485, 9'600},
                                        {"rs232", BusKind::Rs232, 9'600},
                                        {"profibus", BusKind::Profibus, 0}};

  void bus(const toml::table& table) {
    known_keys(table, "[[bus]]", {"name", "kind", "baud", "port", "length", "shielded", "terminated"});
    BusConfig config;
    config.place = place_of(table.source());
    config.name = text(table, "name", "a [[bus]]", true);
    unique(bus_names_, config.name, "bus", config.place);
    const std::string kind = text(table, "kind", "a [[bus]]", true);
    const auto row =
        std::find_if(std::begin(kKinds), std::end(kKinds), [&](const KindName& k) { return k.name == kind; });
    if (row != std::end(kKinds)) {
      config.kind = row->kind;
      config.baud = row->baud;
    } else if (!kind.empty()) {
      error(place_of(table.get("kind")->source()),
            fmt::format("'{}' is no kind of bus; known are can, rs485, rs232, profibus", kind));
    }
    if (config.kind == BusKind::Profibus)
      error(place_of(table.get("kind")->source()),
            fmt::format("buses of kind '{}' are not simulated yet", kind));
    baud(table, config);
    wiring(table, config);
    config.port = text(table, "port", "", false);
    if (const toml::node* port = table.get("port")) {
      config.port_place = place_of(port->source());
      if (config.port.empty() && port->is_string()) error(config.port_place, "port must not be empty");
      unique(port_names_, config.port, "port", config.port_place);
    }
    result_.plant.buses.push_back(std::move(config));
  }

  // 1053 1610 p. 8: the rates of the SBus and of RS-232; 57.6 kbaud MDX60B/61B p. 14.
  void baud(const toml::table& table, BusConfig& config) {
    const toml::node* node = table.get("baud");
    int32_t value = 0;
    if (node == nullptr || !number(*node, "baud", value)) return;
    config.baud = static_cast<uint32_t>(value);
    const auto is_one_of = [value](std::initializer_list<int32_t> rates) {
      return std::find(rates.begin(), rates.end(), value) != rates.end();
    };
    if (config.kind == BusKind::Can && !is_one_of({125'000, 250'000, 500'000, 1'000'000}))
      error(place_of(node->source()),
            fmt::format("the SBus has 125000, 250000, 500000 or 1000000 baud, not {}", value));
    if (config.kind == BusKind::Rs485 && !is_one_of({9'600, 57'600}))
      error(place_of(node->source()), fmt::format("RS-485 has 9600 or 57600 baud, not {}", value));
    if (config.kind == BusKind::Rs232 && !is_one_of({9'600}))
      error(place_of(node->source()), fmt::format("RS-232 has 9600 baud, not {}", value));
  }

  void wiring(const toml::table& table, BusConfig& config) {
    config.shielded = flag(table, "shielded", nullptr);
    config.terminated = flag(table, "terminated", nullptr);
    const toml::node* length = table.get("length");
    if (length == nullptr) return;
    const auto metres = length->value<double>();
    constexpr double kLongest = 1e6;
    if (!metres || !(*metres > 0) || *metres > kLongest)
      return error(place_of(length->source()), "length is the length of the line in metres");
    config.length_mm = static_cast<uint32_t>(*metres * 1000 + 0.5);
  }

  void station(const toml::table& table) {
    known_keys(table, "[[station]]",
               {"name", "unit", "firmware", "program", "sbus", "rs485", "rs485_xt", "keypad", "uss21a", "s13",
                "parameters", "inputs", "analog", "load", "hex"});
    StationConfig config;
    config.place = place_of(table.source());
    config.name = text(table, "name", "a [[station]]", true);
    unique(station_names_, config.name, "station", config.place);
    const std::string unit = text(table, "unit", "a [[station]]", true);
    config.unit = stdlib::find_unit(unit);
    if (config.unit == nullptr && !unit.empty()) {
      std::vector<std::string_view> names;
      for (const stdlib::UnitType& type : stdlib::unit_types()) names.push_back(type.name);
      error(place_of(table.get("unit")->source()),
            fmt::format("'{}' is no unit type; known are {}", unit, fmt::join(names, ", ")));
    }
    firmware(table, config.options.firmware);
    config.program = text(table, "program", "", false);
    if (const toml::node* program = table.get("program")) {
      config.program_place = place_of(program->source());
      if (config.unit != nullptr && config.unit->tasks == 0)
        error(config.program_place, fmt::format("unit type {} runs no program", config.unit->name));
    }
    config.sbus = bus_use(table, "sbus", BusKind::Can).bus;
    config.serial = serial(table);
    parameters(table, config);
    inputs(table, config);
    analog(table, config);
    load(table, config.machine);
    hex(table, config);
    result_.plant.stations.push_back(std::move(config));
  }

  // The bus a key names; it must be of this kind (a serial key takes both serial kinds).
  BusUse bus_use(const toml::table& table, std::string_view key, BusKind kind) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return {};
    BusUse use{text(table, key, "", false), place_of(node->source())};
    if (node->is_string()) bus_uses_.push_back({use, kind});
    return use;
  }

  // A switch; absent is false. `place` is set where it stands.
  bool flag(const toml::table& table, std::string_view key, FilePlace* place) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return false;
    if (place != nullptr) *place = place_of(node->source());
    if (const auto* value = node->as_boolean()) return value->get();
    error(place_of(node->source()), fmt::format("{} is true or false", key));
    return false;
  }

  SerialConfig serial(const toml::table& table) {
    SerialConfig config;
    config.x13 = bus_use(table, "rs485", BusKind::Rs485);
    config.xt = bus_use(table, "rs485_xt", BusKind::Rs485);
    config.keypad = flag(table, "keypad", &config.keypad_place);
    config.uss21a = flag(table, "uss21a", &config.uss21a_place);
    config.s13 = flag(table, "s13", &config.s13_place);
    return config;
  }

  // The two digits behind the point, as the MOVITRAC 07 manual writes versions: 15 for .15.
  void firmware(const toml::table& table, uint8_t& version) {
    const toml::node* node = table.get("firmware");
    int32_t value = 0;
    if (node == nullptr || !number(*node, "firmware", value)) return;
    if (value < 10 || value > 99)
      return error(place_of(node->source()), "firmware is a version of two digits, 10..99");
    version = static_cast<uint8_t>(value);
  }

  const toml::table* subtable(const toml::table& table, std::string_view key) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return nullptr;
    if (!node->is_table()) error(place_of(node->source()), fmt::format("write [station.{}]", key));
    return node->as_table();
  }

  void parameters(const toml::table& table, StationConfig& config) {
    const toml::table* settings = subtable(table, "parameters");
    if (settings == nullptr) return;
    for (const auto& [key, value] : *settings) {
      ParameterSetting setting;
      setting.parameter = key.str();
      setting.place = place_of(key.source());
      if (number(value, setting.parameter, setting.value)) config.parameters.push_back(std::move(setting));
    }
    // TOML tables are sorted by key; the order of the file is the order of writing.
    std::stable_sort(config.parameters.begin(), config.parameters.end(), [](const auto& a, const auto& b) {
      return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
    });
  }

  void inputs(const toml::table& table, StationConfig& config) {
    const toml::table* settings = subtable(table, "inputs");
    if (settings == nullptr) return;
    for (const auto& [key, value] : *settings) {
      const int input = parse_input(key.str());
      int32_t level = 0;
      if (input < 0)
        error(place_of(key.source()),
              fmt::format("'{}' is no input; inputs are DI00..DI07 and DI10..DI17", key.str()));
      else if (value.is_boolean())
        level = value.as_boolean()->get() ? 1 : 0;
      else if (!number(value, key.str(), level))
        continue;
      if (level != 0 && level != 1) error(place_of(value.source()), fmt::format("{} is 0 or 1", key.str()));
      if (input >= 0)
        config.inputs.push_back({static_cast<uint8_t>(input), level == 1, place_of(key.source())});
    }
  }

  // Signals held from the start, as text with unit. What an input is wired for, voltage or current, the unit
  // says.
  void analog(const toml::table& table, StationConfig& config) {
    const toml::table* settings = subtable(table, "analog");
    if (settings == nullptr) return;
    struct Kind {
      std::string_view key;
      std::string_view unit;
      double factor;
      double minimum;
      double maximum;
      int32_t& value;
    };
    AnalogInputs& a = config.analog;
    const Kind kinds[] = {
        {"AI1", "V", 1e3, -10, 10, a.ai1.millivolt},   {"AI1", "mA", 1e3, 0, 20, a.ai1.microampere},
        {"AI2", "V", 1e3, -10, 10, a.ai2.millivolt},   {"AI2", "mA", 1e3, 0, 20, a.ai2.microampere},
        {"frequency", "kHz", 1e3, 0, 65, a.frequency}, {"potentiometer", "%", 10, 0, 100, a.potentiometer}};
    for (const auto& [key, value] : *settings) {
      const auto known = [&](const Kind& kind) { return kind.key == key.str(); };
      if (std::none_of(std::begin(kinds), std::end(kinds), known)) {
        error(
            place_of(key.source()),
            fmt::format("'{}' is no analog input; known are AI1, AI2, frequency, potentiometer", key.str()));
        continue;
      }
      const std::string signal = value.value_or(std::string());
      const bool read = std::any_of(std::begin(kinds), std::end(kinds), [&](const Kind& kind) {
        return known(kind) &&
               parse_signal(signal, kind.unit, kind.factor, kind.minimum, kind.maximum, kind.value);
      });
      if (!read)
        error(place_of(value.source()),
              fmt::format(
                  "{} needs a text such as \"5 V\" (-10..10), \"12 mA\" (0..20), for frequency \"5 kHz\" "
                  "(0..65), for potentiometer \"50 %\" (0..100)",
                  key.str()));
    }
  }

  static bool parse_signal(std::string_view text, std::string_view unit, double factor, double minimum,
                           double maximum, int32_t& out) {
    if (!text.ends_with(unit)) return false;
    text.remove_suffix(unit.size());
    while (text.ends_with(' ')) text.remove_suffix(1);
    double value = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc() || end != text.data() + text.size() || !(value >= minimum && value <= maximum))
      return false;
    out = static_cast<int32_t>(std::lround(value * factor));
    return true;
  }

  void load(const toml::table& table, MachineData& machine) {
    const toml::table* settings = subtable(table, "load");
    if (settings == nullptr) return;
    known_keys(*settings, "[station.load]", {"inertia", "friction", "torque", "brake", "braking_resistor"});
    percentage(*settings, "inertia", 0, 100'000, 1, machine.inertia);
    percentage(*settings, "friction", 0, 1'000, 1'000, machine.friction);
    percentage(*settings, "torque", -1'000, 1'000, 1'000, machine.load_torque);
    flag(*settings, "brake", machine.brake);
    flag(*settings, "braking_resistor", machine.braking_resistor);
  }

  // A value in % between two ends, kept in parts of `parts` to the percent.
  void percentage(const toml::table& table, std::string_view key, int32_t least, int32_t most, int32_t parts,
                  int32_t& out) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
    if (!value) return error(place_of(node->source()), fmt::format("{} must be a number, in %", key));
    if (!(*value >= least && *value <= most))
      return error(place_of(node->source()), fmt::format("{} is {} to {} %", key, least, most));
    out = static_cast<int32_t>(std::lround(*value * parts));
  }

  void flag(const toml::table& table, std::string_view key, bool& out) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    if (node->is_boolean())
      out = node->as_boolean()->get();
    else
      error(place_of(node->source()), fmt::format("{} is true or false", key));
  }

  void hex(const toml::table& table, StationConfig& config) {
    const toml::node* node = table.get("hex");
    if (node == nullptr) return;
    const toml::array* names = node->as_array();
    if (names == nullptr) return error(place_of(node->source()), "hex must be a list of variable names");
    for (const toml::node& name : *names) {
      if (const auto* value = name.as_string())
        config.hex.push_back(value->get());
      else
        error(place_of(name.source()), "hex must be a list of variable names");
    }
  }

  void expectation(const toml::table& table) {
    known_keys(table, "[[expect]]", {"station", "at", "variable", "equals"});
    Expectation expected;
    expected.place = place_of(table.source());
    expected.station = text(table, "station", "an [[expect]]", true);
    expected.variable = text(table, "variable", "an [[expect]]", true);
    const std::string at = text(table, "at", "an [[expect]]", true);
    expected.at = parse_duration(at);
    if (expected.at < 0 && !at.empty())
      error(place_of(table.get("at")->source()),
            fmt::format("'{}' is no time; write for example 500ms or 1.5s", at));
    if (const toml::node* equals = table.get("equals"))
      number(*equals, "equals", expected.equals);
    else
      error(expected.place, "an [[expect]] needs equals = ...");
    if (const toml::node* station = table.get("station"))
      station_uses_.push_back({expected.station, place_of(station->source())});
    result_.plant.expectations.push_back(std::move(expected));
  }

  void cross_check() {
    for (const auto& [use, kind] : bus_uses_) {
      const auto& buses = result_.plant.buses;
      const auto bus =
          std::find_if(buses.begin(), buses.end(), [&](const BusConfig& b) { return b.name == use.bus; });
      if (bus == buses.end())
        error(use.place, fmt::format("there is no bus '{}'", use.bus));
      else if (is_serial(bus->kind) != is_serial(kind))
        error(use.place,
              fmt::format("bus '{}' is {} serial line", use.bus, is_serial(bus->kind) ? "a" : "no"));
    }
    for (PlantError& problem : check_serial_plan(result_.plant)) result_.errors.push_back(std::move(problem));
    for (const auto& [name, place] : station_uses_)
      if (!station_names_.contains(name)) error(place, fmt::format("there is no station '{}'", name));
    if (result_.plant.stations.empty() && result_.errors.empty())
      error({1, 1}, "the plant has no [[station]]");
  }

  PlantFileResult result_;
  std::set<std::string> bus_names_;
  std::set<std::string> station_names_;
  std::set<std::string> port_names_;
  std::vector<std::pair<BusUse, BusKind>> bus_uses_;
  std::vector<std::pair<std::string, FilePlace>> station_uses_;
};

}  // namespace

PlantFileResult read_plant_file(std::string_view text) { return Reader().read(text); }

int64_t parse_duration(std::string_view text) {
  struct Unit {
    std::string_view name;
    int64_t ns;
  };
  static constexpr Unit kUnits[] = {{"us", 1'000},
                                    {"ms", 1'000'000},
                                    {"min", 60'000'000'000},
                                    {"s", 1'000'000'000},
                                    {"h", 3'600'000'000'000}};
  for (const Unit& unit : kUnits) {
    if (!text.ends_with(unit.name)) continue;
    const std::string_view number = text.substr(0, text.size() - unit.name.size());
    double value = 0;
    const auto [end, status] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (status != std::errc() || end != number.data() + number.size() || !(value >= 0) || value > 1e9)
      return -1;
    const double ns = value * static_cast<double>(unit.ns);
    return ns > 9e18 ? -1 : static_cast<int64_t>(ns + 0.5);
  }
  return -1;
}

int parse_input(std::string_view name) {
  if (name.size() != 4 || !name.starts_with("DI") || (name[2] != '0' && name[2] != '1')) return -1;
  const int digit = name[3] - '0';
  return digit < 0 || digit > 7 ? -1 : (name[2] - '0') * 8 + digit;
}

}  // namespace ipos::runtime
