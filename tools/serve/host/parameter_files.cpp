// Readers of both kinds of files, differences, and the lines for a plant.
#include "tools/serve/host/parameter_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "runtime/plant_file/plant_file.hpp"
#include "stdlib/parameters.hpp"
#include "tools/serve/host/parameter_rows.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::StationConfig;
using stdlib::Parameter;

// As in read_settings(): what is written and kept by the unit.
bool is_kept(const Parameter& parameter) { return parameter.writable && parameter.nonvolatile; }

const StationConfig& station_in(const runtime::PlantFile& plant, const std::string& name, const stdlib::UnitType& unit) {
  const StationConfig* only = nullptr;
  std::string names;
  for (const StationConfig& station : plant.stations) {
    if (station.name == name && station.unit == &unit) return station;
    if (station.unit != &unit) continue;
    names += (names.empty() ? "" : ", ") + station.name;
    only = &station;
  }
  if (only == nullptr) throw Mistake(fmt::format("the plant file has no station of unit {}", unit.name));
  if (names != only->name) throw Mistake(fmt::format("the plant file has no station '{}', but {}", name, names));
  return *only;
}

}  // namespace

ParameterSet settings_in(const std::string& text, const std::string& station, const stdlib::UnitType& unit) {
  if (is_parameter_set(text)) {
    auto set = read_parameter_set("the file", text);
    if (!set) throw Mistake(fmt::format("{}", fmt::join(set.error(), "\n")));
    if (set->unit != &unit) throw Mistake(fmt::format("the file is of unit {}, not {}", set->unit->name, unit.name));
    return std::move(*set);
  }
  const runtime::PlantFileResult file = runtime::read_plant_file(text);
  if (file.plant.stations.empty()) {
    const std::string why = file.errors.empty() ? "" : fmt::format(" ({}:{}: {})", file.errors.front().place.line,
                                                                   file.errors.front().place.column, file.errors.front().text);
    throw Mistake("this is neither a file of ipos param nor a plant file" + why);
  }
  const StationConfig& config = station_in(file.plant, station, unit);
  const stdlib::ParameterTable& table = stdlib::parameter_table(unit);
  std::map<uint16_t, int32_t> values;
  for (const runtime::ParameterSetting& setting : config.parameters)
    if (const Parameter* parameter = table.find(setting.parameter)) values[parameter->index] = setting.value;
  ParameterSet set;
  set.unit = &unit;
  for (const Parameter* parameter : table.by_index()) {
    if (!is_kept(*parameter)) continue;
    const auto given = values.find(parameter->index);
    set.rows.push_back({parameter, given == values.end() ? factory_setting(*parameter) : given->second, {}});
  }
  return set;
}

Json compare(const ParameterSet& one, const ParameterSet& other) {
  std::map<uint16_t, std::pair<const SetRow*, const SetRow*>> pairs;
  for (const SetRow& row : one.rows) pairs[row.parameter->index].first = &row;
  for (const SetRow& row : other.rows) pairs[row.parameter->index].second = &row;
  Json rows = Json::array();
  ParameterSet differing;
  differing.unit = other.unit;
  const auto text = [](const SetRow* row) {
    return row == nullptr ? Json(nullptr) : Json(stdlib::parameter_text(*row->parameter, row->value));
  };
  for (const auto& [index, sides] : pairs) {
    const auto [a, b] = sides;
    if (a != nullptr && b != nullptr && a->value == b->value) continue;
    const Parameter& parameter = *(a != nullptr ? a : b)->parameter;
    if (b != nullptr) differing.rows.push_back(*b);
    rows.push_back({{"number", number_of(parameter)},
                    {"index", index},
                    {"name", parameter.name},
                    {"text", text(a)},
                    {"with", text(b)}});
  }
  return {{"rows", std::move(rows)}, {"file", to_text(differing)}};
}

std::string plant_lines(const ParameterSet& settings) {
  std::vector<SetRow> rows;
  std::copy_if(settings.rows.begin(), settings.rows.end(), std::back_inserter(rows), [](const SetRow& row) {
    return is_kept(*row.parameter) && row.value != factory_setting(*row.parameter);
  });
  // By P number; what has none comes behind.
  std::stable_sort(rows.begin(), rows.end(), [](const SetRow& a, const SetRow& b) {
    return std::pair(a.parameter->number.empty(), a.parameter->number) <
           std::pair(b.parameter->number.empty(), b.parameter->number);
  });
  std::string text = "[station.parameters]\n";
  for (const SetRow& row : rows) {
    const Parameter& parameter = *row.parameter;
    const std::string number = number_of(parameter);
    // In words where they mean the same value again; else the number that is transferred.
    const std::string words = stdlib::parameter_text(parameter, row.value);
    const auto read = stdlib::parse_parameter_text(parameter, words);
    const bool plain = words.find_first_of("\"\\") == std::string::npos;
    const std::string value = read && *read == row.value && plain
                                  ? fmt::format("\"{}\"", words)
                                  : fmt::format("{}", parameter.number_of(row.value));
    text += fmt::format("{} = {}  # {}, factory setting {}\n", number.empty() ? fmt::format("{}", parameter.index) : number,
                        value, parameter.name, stdlib::parameter_text(parameter, factory_setting(parameter)));
  }
  return text;
}

}  // namespace ipos::tools::serve
