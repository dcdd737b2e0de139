// Forms of values in the plant file.
#include "runtime/plant_file/plant_reader.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/plant_file/state_names.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/plain_text.hpp"

namespace ipos::runtime {

void PlantReader::known_keys(const toml::table& table, std::string_view what,
                             const std::vector<std::string_view>& keys) {
  for (const auto& [key, value] : table) {
    if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
    error(place_of(key.source()),
          fmt::format("unknown key '{}' in {}; known are {}", key.str(), what, fmt::join(keys, ", ")));
  }
}

const toml::table* PlantReader::subtable(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) error(place_of(*node), fmt::format("write [station.{}]", key));
  return node->as_table();
}

std::string PlantReader::text(const toml::table& table, std::string_view key, std::string_view what,
                              bool required) {
  std::string one = lines(table, key, what, required);
  if (!stdlib::is_plain(one)) error(place_of(*table.get(key)), fmt::format("{} is one line", key));
  return one;
}

std::string PlantReader::lines(const toml::table& table, std::string_view key, std::string_view what,
                               bool required) {
  const toml::node* node = table.get(key);
  if (node == nullptr) {
    if (required) error(place_of(table), fmt::format("{} needs {} = \"...\"", what, key));
    return {};
  }
  const auto* value = node->as_string();
  if (value == nullptr)
    error(place_of(*node), fmt::format("{} must be a text in quotes", key));
  else if (value->get().empty())
    error(place_of(*node), fmt::format("{} must not be empty", key));
  return value == nullptr ? std::string() : value->get();
}

bool PlantReader::number(const toml::node& node, std::string_view what, int32_t& out) {
  const auto* value = node.as_integer();
  if (value == nullptr) {
    error(place_of(node), fmt::format("{} must be a whole number", what));
    return false;
  }
  if (value->get() < INT32_MIN || value->get() > UINT32_MAX) {
    error(place_of(node), fmt::format("{} = {} does not fit into 32 bits", what, value->get()));
    return false;
  }
  out = static_cast<int32_t>(static_cast<uint32_t>(value->get()));
  return true;
}

namespace {

// In units of the last of so many decimals; nothing where more are needed, or where it is no number.
std::optional<double> in_units(const toml::node& node, int decimals) {
  const auto value = node.value<double>();
  if (!value || !std::isfinite(*value)) return std::nullopt;
  double units = *value;
  for (; decimals > 0; --decimals) units *= 10;
  const double whole = std::round(units);
  return std::abs(units - whole) <= 1e-9 * std::max(1.0, std::abs(units)) ? std::optional(whole) : std::nullopt;
}

uint8_t decimals_of(const toml::node& node) {
  if (!node.is_floating_point()) return 0;
  for (uint8_t n = 0; n <= kMostDecimals; ++n)
    if (in_units(node, n)) return n;
  return 0;
}

}  // namespace

uint8_t PlantReader::expected_decimals(const toml::table& table, std::initializer_list<std::string_view> keys) {
  uint8_t most = 0;
  for (const std::string_view key : keys) {
    const toml::node* node = table.get(key);
    if (node == nullptr) continue;
    most = std::max(most, decimals_of(*node));
    if (const toml::array* list = node->as_array())
      for (const toml::node& one : *list) most = std::max(most, decimals_of(one));
  }
  return most;
}

bool PlantReader::expected_number(const toml::node& node, std::string_view what, const Signal& of, int64_t& out) {
  if (node.is_floating_point() && of.kind != SignalKind::Any) {
    error(place_of(node), fmt::format("{} must be a whole number; decimals are for signal = \"...\"", what));
    return false;
  }
  if (!node.is_floating_point() && of.decimals == 0) {
    int32_t whole = 0;
    if (!number(node, what, whole)) return false;
    out = whole;
    return true;
  }
  if (!node.is_number()) {
    error(place_of(node), fmt::format("{} must be a number", what));
    return false;
  }
  const auto units = in_units(node, of.decimals);
  if (!units || std::abs(*units) > 9e15) {
    error(place_of(node), fmt::format("{} has more than {} decimals, or is too large", what, kMostDecimals));
    return false;
  }
  out = static_cast<int64_t>(*units);
  return true;
}

std::optional<bool> PlantReader::flag(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  if (const auto* value = node->as_boolean()) return value->get();
  error(place_of(*node), fmt::format("{} is true or false", key), AllowedValues{{"true", "false"}});
  return std::nullopt;
}

uint32_t PlantReader::count(const toml::table& table, std::string_view key, uint32_t limit,
                            uint32_t otherwise, uint32_t least) {
  const toml::node* node = table.get(key);
  int32_t value = 0;
  if (node == nullptr || !number(*node, key, value)) return otherwise;
  if (value >= 0 && static_cast<uint32_t>(value) >= least && static_cast<uint32_t>(value) <= limit)
    return static_cast<uint32_t>(value);
  error(place_of(*node), fmt::format("{} is {} to {}", key, least, limit), AllowedValues{{}, least, limit});
  return otherwise;
}

int64_t PlantReader::duration(const toml::table& table, std::string_view key, std::string_view what,
                              bool required) {
  if (table.get(key) == nullptr) return text(table, key, what, required), 0;
  return std::max<int64_t>(duration(table, key, 0), 0);
}

int64_t PlantReader::duration(const toml::table& table, std::string_view key, int64_t otherwise) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return otherwise;
  const std::string written = text(table, key, "", false);
  const int64_t time = parse_duration(written);
  if (time < 0 && !written.empty())
    error(place_of(*node), fmt::format("'{}' is no time; write for example 500ms or 1.5s", written));
  return time;
}

std::string PlantReader::station(const toml::table& table, std::string_view what, bool gateway_too) {
  std::string name = text(table, "station", what, true);
  const toml::node* node = table.get("station");
  if (node == nullptr) return name;
  if (gateway_too && gateway_names.contains(name))
    station_uses.emplace_back(name, place_of(*node));
  else
    use_station(name, place_of(*node));
  return name;
}

void PlantReader::use_station(const std::string& name, FilePlace place) {
  station_uses.emplace_back(name, place);
  if (gateway_names.contains(name))
    error(place,
          fmt::format(
              "'{}' is a gateway: it has no program, drive, inputs or parameters of its own, only signals",
              name));
}

std::string PlantReader::station_name(const toml::table& table, std::string_view key) {
  std::string name = text(table, key, "", false);
  if (const toml::node* node = table.get(key)) station_uses.emplace_back(name, place_of(*node));
  return name;
}

BusUse PlantReader::bus_use(const toml::table& table, std::string_view key, BusKind kind) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return {};
  BusUse use{text(table, key, "", false), place_of(*node)};
  if (node->is_string()) bus_uses.emplace_back(use, kind);
  return use;
}

std::string PlantReader::bus_name(const toml::table& table, std::string_view key, std::string_view what,
                                  bool required) {
  std::string name = text(table, key, what, required);
  if (const toml::node* node = table.get(key))
    bus_uses.emplace_back(BusUse{name, place_of(*node)}, BusKind::Can);
  return name;
}

std::optional<bool> PlantReader::off_or_on(const toml::table& table, std::string_view key, std::string_view what) {
  const std::string word = text(table, key, what, true);
  if (word == "off" || word == "on") return word == "on";
  if (!word.empty())
    error(place_of(*table.get(key)), fmt::format("unknown {} '{}'; known are off, on", key, word), AllowedValues{{"\"off\"", "\"on\""}});
  return std::nullopt;
}

void PlantReader::unique(std::set<std::string>& names, const std::string& name, std::string_view what,
                         FilePlace place) {
  if (!name.empty() && !names.insert(name).second)
    error(place, fmt::format("there are two of {} '{}'", what, name));
}

bool PlantReader::signal(const toml::table& table, std::string_view what,
                         std::initializer_list<std::string_view> kinds, Signal& out) {
  std::string_view found;
  for (const std::string_view kind : kinds) {
    if (table.get(kind) == nullptr) continue;
    if (!found.empty()) {
      error(place_of(*table.get(kind)), fmt::format("{} has either {} or {}", what, found, kind));
      return false;
    }
    found = kind;
  }
  if (found.empty()) {
    error(place_of(table), fmt::format("{} needs one of {} = \"...\"", what, fmt::join(kinds, ", ")));
    return false;
  }
  out.name = text(table, found, what, true);
  if (out.name.empty()) return false;
  int bit = 0;
  if (found == "variable") {
    out.kind = SignalKind::Variable;
  } else if (found == "parameter") {
    out.kind = SignalKind::Parameter;
  } else if (found == "signal") {
    out.kind = SignalKind::Any;
  } else if (found == "input") {
    out.kind = SignalKind::Input;
    bit = parse_input(out.name);
  } else if (found == "output") {
    out.kind = SignalKind::Output;
    bit = parse_output(out.name);
  } else if (found == "state") {
    out.kind = SignalKind::State;
    bit = find_state(out.name);
  } else if (found == "mains") {  // its value is off or on: the caller reads it
    out.kind = SignalKind::Switch;
    out.name = "mains";
  } else if (found == "switch") {
    out.kind = SignalKind::Switch;
    if (find_switch(out.name) == nullptr) {
      std::vector<std::string_view> words;
      for (const StationSwitchType& type : station_switches()) words.push_back(type.word);
      error(place_of(*table.get(found)), fmt::format("'{}' is no switch; known are {}", out.name, fmt::join(words, ", ")));
      return false;
    }
  } else {
    out.kind = SignalKind::Input;
    bit = parse_analog_input(out.name);
  }
  if (bit < 0 && out.kind == SignalKind::State) {
    error(place_of(*table.get(found)),
          fmt::format("'{}' is no state; known are {}", out.name, state_names()));
    return false;
  }
  if (bit < 0) {
    error(place_of(*table.get(found)), fmt::format("'{}' is no {}", out.name, found));
    return false;
  }
  out.line = static_cast<uint8_t>(bit);
  return true;
}

// A whole number is the transferred value, so 2 and 2.0 would not be the same.
bool PlantReader::refuse_decimal(const toml::value<double>& node, const stdlib::UnitType* unit,
                                 std::string_view parameter) {
  const std::string written = fmt::format("{}", node.get());
  const stdlib::Parameter* row = unit == nullptr ? nullptr : stdlib::parameter_table(*unit).find(parameter);
  const auto value = row == nullptr ? tl::expected<int32_t, std::string>(tl::unexpected(std::string()))
                                    : stdlib::parse_parameter_text(*row, written);
  error(place_of(node), fmt::format("{} must be a text as it is shown, \"{}\", or the whole number that is "
                                    "transferred{}",
                                    parameter, written, value ? fmt::format(", {}", *value) : ""));
  return false;
}

bool PlantReader::parameter_value(const toml::node& node, const stdlib::UnitType* unit,
                                  std::string_view parameter, int32_t& out) {
  const auto* words = node.as_string();
  if (const auto* decimal = node.as_floating_point()) return refuse_decimal(*decimal, unit, parameter);
  if (words == nullptr) return number(node, parameter, out);
  if (unit == nullptr) return false;  // reported already
  const stdlib::Parameter* row = stdlib::parameter_table(*unit).find(parameter);
  if (row == nullptr) return true;  // the station refuses it by its name
  const auto value = stdlib::parse_parameter_text(*row, words->get());
  if (value)
    out = *value;
  else
    error(place_of(node),
          fmt::format("{} {} = \"{}\": {}", parameter, row->name, words->get(), value.error()));
  return value.has_value();
}

const stdlib::UnitType* PlantReader::unit_of(std::string_view station) const {
  for (const StationConfig& config : result.plant.stations)
    if (config.name == station) return config.unit;
  return nullptr;
}

}  // namespace ipos::runtime
