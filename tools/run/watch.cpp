// Collects and formats watch windows.
#include "tools/run/watch.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/plant/variable_names.hpp"

namespace ipos::tools {
namespace {

void add(const runtime::Station& station, const std::vector<runtime::NamedVariable>& variables,
         std::vector<WatchRow>& rows) {
  const auto& hex = station.config().hex;
  const auto in_hex = [&hex](const std::string& name) {
    return !name.empty() && std::find(hex.begin(), hex.end(), name) != hex.end();
  };
  for (const runtime::NamedVariable& row : variables)
    rows.push_back(
        {row.name, row.number, station.variable(row.number), in_hex(row.symbol) || in_hex(row.name)});
}

}  // namespace

std::vector<WatchRow> watch_rows(const runtime::Station& station, const std::vector<std::string>& names) {
  std::vector<WatchRow> rows;
  if (station.image() == nullptr) return rows;
  const auto& symbols = station.image()->symbols;
  if (names.empty())
    for (const vm::Symbol& symbol : symbols) add(station, runtime::elements_of(symbol), rows);
  for (const std::string& name : names)
    add(station, runtime::named_variables(symbols, *station.config().unit, name), rows);
  return rows;
}

std::string watch_window(const std::vector<WatchRow>& rows) {
  size_t width = 0;
  for (const WatchRow& row : rows) width = std::max(width, row.name.size());
  std::string text;
  for (const WatchRow& row : rows) {
    const std::string value =
        row.hex ? fmt::format("{:08X} h", static_cast<uint32_t>(row.value)) : fmt::format("{}", row.value);
    text += fmt::format("{:<4} {:<{}}  {}\n", fmt::format("H{}", row.index), row.name, width, value);
  }
  return text;
}

}  // namespace ipos::tools
