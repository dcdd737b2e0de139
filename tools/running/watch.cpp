// Collects and formats watch windows.
#include "tools/running/watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "compiler/diag/places.hpp"
#include "runtime/signals/find.hpp"
#include "runtime/signals/variables.hpp"

namespace ipos::tools {
namespace {

void add(const runtime::Station& station, const std::vector<signals::NamedVariable>& variables,
         std::vector<WatchRow>& rows) {
  const auto& hex = station.config().hex;
  const auto in_hex = [&hex](const std::string& name) {
    return !name.empty() && std::find(hex.begin(), hex.end(), name) != hex.end();
  };
  for (const signals::NamedVariable& row : variables)
    rows.push_back(
        {compiler::printable(row.name), row.number, static_cast<double>(station.variable(row.number)),
         in_hex(row.symbol) || in_hex(row.name), ""});
}

WatchRow row_of(const signals::Signal& signal, const std::string& name) {
  const int64_t sample = signal.read();
  return {name, std::nullopt, static_cast<double>(sample) * signal.factor, false, signal.words(sample)};
}

// Analog outputs that are set otherwise than from the factory: AO1 by P640..P642, AO2 by P643..P645 (1053 1610 p. 79).
void add_analog_outputs(const runtime::Station& station, std::vector<WatchRow>& rows) {
  const stdlib::ParameterTable& table = stdlib::parameter_table(*station.config().unit);
  const std::pair<const char*, std::array<const char*, 3>> outputs[] = {{"AO1", {"640", "641", "642"}},
                                                                        {"AO2", {"643", "644", "645"}}};
  for (const auto& [name, numbers] : outputs)
    if (std::any_of(numbers.begin(), numbers.end(), [&](const char* number) {
          const stdlib::Parameter* row = table.find(number);
          return row != nullptr && station.read(row->index) != row->default_value;
        }))
      for (const signals::Signal& signal : signals::find_station_signals(station, name)) rows.push_back(row_of(signal, name));
}

}  // namespace

std::vector<WatchRow> watch_rows(const runtime::Station& station, const std::vector<std::string>& names) {
  std::vector<WatchRow> rows;
  if (names.empty()) {
    for (const vm::Symbol& symbol : station.symbols()) add(station, signals::elements_of(symbol), rows);
    add_analog_outputs(station, rows);
  }
  for (std::string name : names) {
    // "u.H200" is of the station u only.
    if (const std::string own = station.config().name + "."; name.starts_with(own)) name.erase(0, own.size());
    for (const signals::Signal& signal : signals::is_pattern(name) ? signals::match_station_signals(station, name)
                                                                   : signals::find_station_signals(station, name)) {
      const std::string own(signal.own_name());
      if (signal.is_variable() && signal.bits == 0)
        add(station, signals::named_variables(station.symbols(), *station.config().unit, own), rows);
      else
        rows.push_back(row_of(signal, own));
    }
  }
  return rows;
}

std::vector<WatchRow> watch_rows(const runtime::Plant& plant, const std::vector<std::string>& names) {
  std::vector<WatchRow> rows;
  for (const std::string& name : names) {
    if (name.find('.') == std::string::npos) continue;
    const auto found = signals::find_signals(plant, name);
    if (!found) continue;
    for (const signals::Signal& signal : *found)
      if (std::none_of(plant.stations().begin(), plant.stations().end(),
                       [&](const auto& station) { return station->config().name == signal.station; }))
        rows.push_back(row_of(signal, signal.name));
  }
  return rows;
}

std::string watch_window(const std::vector<WatchRow>& rows) {
  size_t width = 0;
  for (const WatchRow& row : rows) width = std::max(width, row.name.size());
  std::string text;
  for (const WatchRow& row : rows) {
    const std::string value = !row.index ? row.text
                              : row.hex  ? fmt::format("{:08X} h", static_cast<uint32_t>(static_cast<int32_t>(row.value)))
                                         : fmt::format("{:.0f}", row.value);
    const std::string number = row.index ? fmt::format("H{}", *row.index) : "";
    text += fmt::format("{:<4} {:<{}}  {}\n", number, row.name, width, value);
  }
  return text;
}

}  // namespace ipos::tools
