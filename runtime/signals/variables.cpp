// Symbols of an image are longs and arrays of longs with their whole path as name; wholes are found by its
// beginning.
#include "runtime/signals/variables.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "runtime/signals/collector.hpp"
#include "stdlib/index_areas.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

std::optional<uint32_t> whole_number(std::string_view text) {
  uint32_t number = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (status != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// "name[3]": an element of the symbol.
std::optional<uint32_t> element_of(const vm::Symbol& symbol, std::string_view name) {
  if (!name.starts_with(symbol.name)) return std::nullopt;
  name.remove_prefix(symbol.name.size());
  if (name.size() < 3 || name.front() != '[' || name.back() != ']') return std::nullopt;
  const auto element = whole_number(name.substr(1, name.size() - 2));
  return element && *element < symbol.count ? element : std::nullopt;
}

bool is_part_of(const std::string& symbol, std::string_view name) {
  return symbol.size() > name.size() && symbol.starts_with(name) &&
         (symbol[name.size()] == '.' || symbol[name.size()] == '[');
}

}  // namespace

std::vector<NamedVariable> elements_of(const vm::Symbol& symbol) {
  if (symbol.count == 1) return {{symbol.name, symbol.name, symbol.variable}};
  std::vector<NamedVariable> all;
  for (uint32_t n = 0; n < symbol.count; ++n)
    all.push_back({fmt::format("{}[{}]", symbol.name, n), symbol.name, symbol.variable + n});
  return all;
}

std::vector<NamedVariable> named_variables(std::span<const vm::Symbol> symbols, const stdlib::UnitType& unit,
                                           std::string_view name) {
  std::vector<NamedVariable> found;
  for (const vm::Symbol& symbol : symbols) {
    if (const auto element = element_of(symbol, name)) {
      found.push_back({std::string(name), symbol.name, symbol.variable + *element});
    } else if (symbol.name == name || is_part_of(symbol.name, name)) {
      const std::vector<NamedVariable> all = elements_of(symbol);
      found.insert(found.end(), all.begin(), all.end());
    }
  }
  if (!found.empty()) return found;
  const bool raw = name.starts_with('H');
  std::optional<uint32_t> number;
  if (raw)
    number = whole_number(name.substr(1));
  else if (const auto* row = stdlib::find_system_variable(name))
    number = row->number;
  if (number && *number < unit.variables)
    found.push_back({raw ? fmt::format("H{}", *number) : std::string(name), "", *number});
  return found;
}

std::optional<uint32_t> find_variable(const Station& station, std::string_view name) {
  const auto named = named_variables(station.symbols(), *station.config().unit, name);
  return named.empty() ? std::nullopt : std::optional(named.front().number);
}

Signal& Collector::add_variable(Group group, std::string_view name, uint32_t number, std::string_view meaning) {
  Signal& signal = add(group, name, meaning,
                       [&station = owner_.station, number] { return station.variable(number); });
  signal.number = number;
  if (signal.is_variable()) signal.put = write_variable;
  return signal;
}

void add_symbols(Collector& out) {
  for (const vm::Symbol& symbol : out.station().symbols())
    for (const NamedVariable& element : elements_of(symbol))
      out.add_variable(Group::Variable, element.name, element.number,
                       fmt::format("H{}", element.number));
}

void add_system_variables(Collector& out) {
  const stdlib::UnitType& unit = *out.station().config().unit;
  for (const stdlib::SystemVariable& row : stdlib::system_variables()) {
    const bool known = row.units == stdlib::VariableUnits::A || unit.has(stdlib::Trait::NewVariables);
    if (known && row.number < unit.variables && !row.compiler_name.empty())
      out.add_variable(Group::SystemVariable, row.compiler_name, row.number, row.meaning);
  }
}

// Variables are parameters 11000 + n (IPOSplus p. 28), so both go the same way.
Refusal write_variable(Station& station, uint32_t number, int32_t value) {
  return write_parameter(station, stdlib::kFirstVariables + number, value);
}

}  // namespace ipos::signals
