// The levels of a factor are listed, or steps between two ends.
#include "tools/campaign/read_vary.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unordered_set>

#include "runtime/plant/trace_hash.hpp"
#include "stdlib/parameters.hpp"
#include "tools/cli/json_text.hpp"

namespace ipos::tools::campaign {
namespace {

constexpr std::string_view kWhat = "a [[vary]]";
constexpr uint32_t kMostLevels = 1'000'000;  // ours

// A number with what is behind it: "0.5 s".
struct Amount {
  double number = 0;
  std::string unit;   // with the blank in front
  bool is_text = false;
  bool is_whole = false;
};

std::optional<Amount> amount_of(const toml::node& node) {
  if (const auto* whole = node.as_integer()) return Amount{static_cast<double>(whole->get()), "", false, true};
  if (const auto* number = node.as_floating_point()) return Amount{number->get(), "", false, false};
  const auto* text = node.as_string();
  if (text == nullptr) return std::nullopt;
  const std::string& written = text->get();
  Amount amount;
  amount.is_text = true;
  const auto [end, status] = std::from_chars(written.data(), written.data() + written.size(), amount.number);
  if (status != std::errc()) return std::nullopt;
  amount.unit = std::string(end, static_cast<size_t>(written.data() + written.size() - end));
  return amount;
}

// With at most so many digits behind the point, and none that say nothing.
std::string number_text(double number, int decimals) {
  std::string text = fmt::format("{:.{}f}", number, decimals);
  if (text.find('.') != std::string::npos) {
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::unique_ptr<toml::node> node_of(const Amount& like, double number, int decimals) {
  const std::string text = number_text(number, decimals);
  if (like.is_text) return std::make_unique<toml::value<std::string>>(text + like.unit);
  if (text.find('.') == std::string::npos)
    return std::make_unique<toml::value<int64_t>>(static_cast<int64_t>(std::llround(number)));
  return std::make_unique<toml::value<double>>(std::stod(text));
}

// What the factor changes; false with an error.
bool read_target(PlantReader& reader, const toml::table& table, FactorOutline& outline, Factor& factor) {
  std::string_view found;
  for (const std::string_view key : {"parameter", "variable", "input", "analog", "load", "key"})
    if (const toml::node* node = table.get(key)) {
      if (!found.empty())
        return reader.error(place_of(*node), fmt::format("{} has either {} or {}", kWhat, found, key)), false;
      found = key;
    }
  if (found.empty())
    return reader.error(place_of(table),
                        fmt::format("{} needs one of parameter, variable, input, analog, load, key = \"...\"", kWhat)),
           false;
  const std::string name = reader.text(table, found, kWhat, true);
  if (found == "key") {
    if (const toml::node* node = table.get("station"))
      reader.error(place_of(*node), "key names the station itself: key = \"station.NAME.unit\"");
    factor.key = outline.name = name;
    return !name.empty();
  }
  factor.station = reader.station(table, kWhat);
  const auto& stations = reader.result.plant.stations;
  if (std::none_of(stations.begin(), stations.end(), [&](const auto& one) { return one.name == factor.station; })) {
    if (!factor.station.empty())
      reader.error(place_of(*table.get("station")), fmt::format("there is no station '{}'", factor.station));
    return false;
  }
  outline.name = factor.station + "." + name;
  if (found == "load") {
    factor.key = fmt::format("station.\"{}\".load.{}", factor.station, name);
    return !name.empty();
  }
  if (found == "parameter") {
    factor.target = Target::Parameter;
    factor.key = name;
    const stdlib::UnitType* unit = reader.unit_of(factor.station);
    if (unit == nullptr) return false;
    const stdlib::ParameterTable& table_of_unit = stdlib::parameter_table(*unit);
    const stdlib::Parameter* row = table_of_unit.find(name);
    // The plant may call it by another of its names.
    for (const auto& one : stations)
      for (const runtime::ParameterSetting& setting : one.parameters)
        if (one.name == factor.station && row != nullptr && table_of_unit.find(setting.parameter) == row) factor.key = setting.parameter;
    if (row != nullptr) return true;
    return reader.error(place_of(*table.get("parameter")), fmt::format("{} has no parameter {}", unit->name, name)), false;
  }
  factor.target = Target::Stimulus;
  factor.signal_key = found;
  factor.signal.station = factor.station;
  return reader.signal(table, kWhat, {found}, factor.signal);
}

// The value as the plant takes it; false with an error.
bool take(PlantReader& reader, const Factor& factor, const toml::node& node, Setting& setting) {
  setting.toml = toml_of(node);
  int32_t number = 0;
  setting.line = factor.signal.line;
  if (factor.target == Target::Parameter) {
    if (!reader.parameter_value(node, reader.unit_of(factor.station), factor.key, number)) return false;
  } else if (factor.target == Target::Stimulus && factor.signal_key == "analog") {
    const auto analog = runtime::parse_analog(factor.signal.name, node.value_or(std::string()));
    if (!analog)
      return reader.error(place_of(node), fmt::format("{} needs {}", factor.signal.name, runtime::kAnalogForms)), false;
    number = analog->value;
    setting.line = analog->line;
  } else if (factor.target == Target::Stimulus && node.is_boolean() && factor.signal_key == "input") {
    number = node.as_boolean()->get() ? 1 : 0;
  } else if (factor.target == Target::Stimulus) {
    if (!reader.number(node, factor.signal_key, number)) return false;
    if (factor.signal_key == "input" && number != 0 && number != 1)
      return reader.error(place_of(node), fmt::format("{} is 0 or 1", factor.signal.name)), false;
  }
  setting.number = number;
  return true;
}

// Steps from one end to the other, both included. A step may not be one that the value can have: it is rounded as far as it
// must be.
void read_steps(PlantReader& reader, const toml::table& table, FactorOutline& outline, Factor& factor) {
  for (const char* key : {"from", "to"})
    if (!table.contains(key)) return reader.error(place_of(table), fmt::format("{} needs values = [...], or from, to, steps", kWhat));
  const toml::node& first = *table.get("from");
  const auto from = amount_of(first);
  const auto to = amount_of(*table.get("to"));
  if (!from || !to) return reader.error(place_of(first), "from and to are numbers, or texts that begin with one");
  if (from->unit != to->unit || from->is_text != to->is_text)
    return reader.error(place_of(*table.get("to")), "from and to are of one unit");
  const uint32_t steps = reader.count(table, "steps", kMostLevels, 0, 2);
  if (steps < 2) {
    if (!table.contains("steps")) reader.error(place_of(table), fmt::format("{} with from and to needs steps = N", kWhat));
    return;
  }
  const bool whole = factor.target == Target::Stimulus && factor.signal_key != "analog";
  for (uint32_t n = 0; n < steps; ++n) {
    const double number = from->number + (to->number - from->number) * n / (steps - 1);
    Setting setting;
    PlantReader trial;
    std::unique_ptr<toml::node> node;
    for (int decimals = whole ? 0 : 9; decimals >= 0; --decimals) {
      trial = PlantReader();
      trial.result.plant.stations = reader.result.plant.stations;
      node = node_of(*from, number, decimals);
      if (take(trial, factor, *node, setting)) break;
    }
    for (runtime::PlantError& error : trial.result.errors) return reader.error(place_of(first), std::move(error.text));
    add_level(outline, factor, std::move(setting), *node, place_of(first));
  }
}

void read_values(PlantReader& reader, const toml::table& table, FactorOutline& outline, Factor& factor) {
  const toml::node* node = table.get("values");
  for (const char* key : {"from", "to", "steps"})
    if (node != nullptr && table.contains(key))
      reader.error(place_of(*table.get(key)), "either values, or from, to and steps");
  if (node == nullptr) return read_steps(reader, table, outline, factor);
  const toml::array* values = node->as_array();
  if (values == nullptr) return reader.error(place_of(*node), "values is a list: [...]");
  for (const toml::node& value : *values) {
    Setting setting;
    if (!value.is_value() || value.is_date() || value.is_time() || value.is_date_time())
      reader.error(place_of(value), std::string(runtime::kWhatAValueIs));
    else if (take(reader, factor, value, setting))
      add_level(outline, factor, std::move(setting), value, place_of(value));
  }
}

}  // namespace

std::string toml_of(const toml::node& node) {
  if (const auto* text = node.as_string()) return json_text(nlohmann::json(text->get()));  // the same in both, and on one line
  std::ostringstream out;
  node.visit([&](const auto& value) { out << value; });
  return out.str();
}

void add_level(FactorOutline& outline, Factor& factor, Setting setting, const toml::node& written, FilePlace place) {
  Level level;
  level.text = level.json = toml_of(written);
  if (const auto* text = written.as_string()) {
    level.text = text->get();
    level.json = json_text(nlohmann::json(text->get()));
  } else if (const auto* whole = written.as_integer()) {
    level.json = std::to_string(whole->get());
  } else if (const auto* number = written.as_floating_point()) {
    level.json = json_text(nlohmann::json(number->get()));
  }
  runtime::NumberHash identity;
  identity.add_text(setting.toml);
  level.identity = identity.value();
  outline.levels.push_back(std::move(level));
  factor.settings.push_back(std::move(setting));
  factor.places.push_back(place);
}

void check_levels(PlantReader& reader, const FactorOutline& outline, const Factor& factor, FilePlace place) {
  if (outline.levels.empty() && reader.result.errors.empty()) reader.error(place, fmt::format("'{}' has no value", outline.name));
  std::unordered_set<std::string> known;
  for (size_t n = 0; n < outline.levels.size(); ++n)
    if (!known.insert(outline.levels[n].json).second)
      return reader.error(factor.places[n], fmt::format("'{}' has the value {} twice", outline.name, outline.levels[n].text));
}

void read_vary(PlantReader& reader, const toml::table& table, Campaign& campaign) {
  reader.known_keys(table, "[[vary]]", {"station", "parameter", "variable", "input", "analog", "load", "key", "values", "from",
                                        "to", "steps", "name"});
  FactorOutline outline;
  Factor factor;
  if (!read_target(reader, table, outline, factor)) return;
  if (table.contains("name")) outline.name = reader.text(table, "name", kWhat, true);
  read_values(reader, table, outline, factor);
  check_levels(reader, outline, factor, place_of(table));
  campaign.factors.push_back(std::move(factor));
  campaign.outline.factors.push_back(std::move(outline));
}

}  // namespace ipos::tools::campaign
