// Collects and formats watch windows.
#include "tools/watch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::tools {
namespace {

// One row a variable: an array is shown as name[0], name[1], ...
void add_symbol(const runtime::Station& station, const vm::Symbol& symbol, std::vector<WatchRow>& rows) {
  const auto& hex = station.config().hex;
  const bool in_hex = std::find(hex.begin(), hex.end(), symbol.name) != hex.end();
  for (uint32_t n = 0; n < symbol.count; ++n) {
    const uint32_t index = symbol.variable + n;
    const std::string name = symbol.count == 1 ? symbol.name : fmt::format("{}[{}]", symbol.name, n);
    rows.push_back({name, index, station.variable(index), in_hex});
  }
}

}  // namespace

std::vector<WatchRow> watch_rows(const runtime::Station& station, const std::vector<std::string>& names) {
  std::vector<WatchRow> rows;
  if (station.image() == nullptr) return rows;
  const auto& symbols = station.image()->symbols;
  if (names.empty()) {
    for (const vm::Symbol& symbol : symbols) add_symbol(station, symbol, rows);
    return rows;
  }
  for (const std::string& name : names) {
    const size_t before = rows.size();
    for (const vm::Symbol& symbol : symbols)
      if (symbol.name == name || symbol.name.starts_with(name + ".")) add_symbol(station, symbol, rows);
    if (rows.size() != before) continue;
    if (const auto number = station.find_variable(name))
      rows.push_back({name, *number, station.variable(*number), false});
  }
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
