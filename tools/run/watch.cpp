// Collects and formats watch windows.
#include "tools/run/watch.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/diag/places.hpp"
#include "runtime/signals/station_signals.hpp"
#include "runtime/signals/variable_names.hpp"

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
        {compiler::printable(row.name), row.number, station.variable(row.number),
         in_hex(row.symbol) || in_hex(row.name), ""});
}

void add_signals(const runtime::Station& station, const std::string& name, std::vector<WatchRow>& rows) {
  const auto found = signals::is_pattern(name) ? signals::match_station_signals(station, name)
                                               : signals::find_station_signals(station, name);
  for (const signals::Signal& signal : found) {
    const std::string own = signal.name.substr(signal.station.size() + 1);
    if (signal.group == signals::Group::Variable && signal.bits == 0) {
      add(station, signals::named_variables(station.symbols(), *station.config().unit, own), rows);
      continue;
    }
    const int64_t value = signal.read();
    rows.push_back({own, std::nullopt, value, false,
                    signal.text(value) + (signal.unit.empty() ? "" : " " + signal.unit)});
  }
}

}  // namespace

std::vector<WatchRow> watch_rows(const runtime::Station& station, const std::vector<std::string>& names) {
  std::vector<WatchRow> rows;
  if (names.empty())
    for (const vm::Symbol& symbol : station.symbols()) add(station, signals::elements_of(symbol), rows);
  for (std::string name : names) {
    // "u.H200" is of the station u only.
    if (const std::string own = station.config().name + "."; name.starts_with(own)) name.erase(0, own.size());
    const size_t before = rows.size();
    add(station, signals::named_variables(station.symbols(), *station.config().unit, name), rows);
    if (rows.size() == before) add_signals(station, name, rows);
  }
  return rows;
}

std::string watch_window(const std::vector<WatchRow>& rows) {
  size_t width = 0;
  for (const WatchRow& row : rows) width = std::max(width, row.name.size());
  std::string text;
  for (const WatchRow& row : rows) {
    const std::string value = !row.index ? row.text
                              : row.hex  ? fmt::format("{:08X} h", static_cast<uint32_t>(row.value))
                                         : fmt::format("{}", row.value);
    const std::string number = row.index ? fmt::format("H{}", *row.index) : "";
    text += fmt::format("{:<4} {:<{}}  {}\n", number, row.name, width, value);
  }
  return text;
}

}  // namespace ipos::tools
