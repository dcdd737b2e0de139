// Symbols and allocation map from the scope and the record of accesses.
#include "compiler/sema/map.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/sema/variable_use.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::compiler {
namespace {

// A symbol a long or array of longs; structures come apart into their members.
void add_symbols(const std::string& name, const Type& type, uint32_t number, std::vector<vm::Symbol>& out) {
  if (type.structure == nullptr) {
    out.push_back({name, static_cast<uint16_t>(number), static_cast<uint16_t>(type.size())});
    return;
  }
  for (uint32_t n = 0; n < std::max<uint32_t>(type.count, 1); ++n) {
    const std::string element = type.count != 0 ? fmt::format("{}[{}]", name, n) : name;
    for (const StructMember& member : type.structure->members)
      add_symbols(element + "." + member.names.front(), member.type,
                  number + n * type.structure->size + member.offset, out);
  }
}

using AccessList = std::vector<AccessPlace> Access::*;

// Of the functions that have an access of a kind to variables in a row.
std::vector<std::string> names(const Context& context, uint32_t number, uint32_t count, AccessList list) {
  std::vector<size_t> functions;
  for (uint32_t n = number; n < number + count; ++n)
    if (const auto found = context.accesses.find(n); found != context.accesses.end())
      for (const AccessPlace& place : found->second.*list) functions.push_back(place.function);
  std::sort(functions.begin(), functions.end());
  functions.erase(std::unique(functions.begin(), functions.end()), functions.end());
  std::vector<std::string> out;
  for (const size_t function : functions)
    if (function < context.program.functions.size()) out.push_back(context.program.functions[function].name);
  return out;
}

checked::MapEntry make_entry(const Context& context, std::string name, std::string type, uint32_t number,
                             uint32_t count, std::string range) {
  return {std::move(name),
          std::move(type),
          number,
          count,
          std::move(range),
          names(context, number, count, &Access::readers),
          names(context, number, count, &Access::writers),
          names(context, number, count, &Access::takers)};
}

checked::MapEntry entry_of(const Context& context, const Variable& variable) {
  const char* range = variable.storage == Storage::Alias     ? "alias"
                      : variable.storage == Storage::Initial ? "initials"
                                                             : "globals";
  return make_entry(context, variable.name, type_text(variable.type), variable.number, variable.type.size(), range);
}

checked::MapEntry entry_of(const Context& context, uint32_t number) {
  const auto* row = stdlib::find_system_variable(static_cast<uint16_t>(number));
  if (row != nullptr) return make_entry(context, std::string(row->compiler_name), "long", number, 1, "system");
  return make_entry(context, fmt::format("H{}", number), "long", number, 1, "raw");
}

bool reached_by_number(const Context& context, uint32_t number) {
  for (uint32_t back = 1; back < kReachOfNumber && back <= number; ++back) {
    const auto found = context.accesses.find(number - back);
    if (found != context.accesses.end() && !found->second.takers.empty()) return true;
  }
  return false;
}

bool unused(const Context& context, const Variable& variable) {
  if (reached_by_number(context, variable.number)) return false;
  for (uint32_t n = variable.number; n < variable.number + variable.type.size(); ++n)
    if (context.accesses.contains(n)) return false;
  return true;
}

}  // namespace

void describe_variables(Context& context) {
  checked::Program& program = context.program;
  struct Row {
    uint32_t number;
    const Variable* variable;  // null: known by its number alone
  };
  std::vector<Row> rows;
  for (const Variable& variable : context.scope.variables()) {
    add_symbols(variable.name, variable.type, variable.number, program.symbols);
    if (variable.storage != Storage::Alias && unused(context, variable))
      context.diagnostics.report(Diag::UnusedVariable, variable.span, {variable.name});
    rows.push_back({variable.number, &variable});
  }
  for (const auto& [number, span] : context.raw_names) rows.push_back({number, nullptr});
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.number < b.number; });
  program.map.reserve(rows.size());
  for (const auto& [number, variable] : rows)
    program.map.push_back(variable != nullptr ? entry_of(context, *variable) : entry_of(context, number));
  std::sort(program.symbols.begin(), program.symbols.end(), [](const vm::Symbol& a, const vm::Symbol& b) {
    return a.variable != b.variable ? a.variable < b.variable : a.name < b.name;
  });
}

std::string map_text(const std::vector<checked::MapEntry>& map) {
  const auto list = [](const std::vector<std::string>& functions) {
    std::string out;
    for (const std::string& name : functions) out += (out.empty() ? "" : ",") + name;
    return out.empty() ? std::string("-") : out;
  };
  std::string out = fmt::format("{:12} {:24} {:14} {:12} {:20} {:20} {}\n", "number", "name", "type", "range",
                                "read by", "written by", "number taken by");
  for (const checked::MapEntry& row : map) {
    const std::string number = row.count == 1
                                   ? fmt::format("H{}", row.number)
                                   : fmt::format("H{}..H{}", row.number, row.number + row.count - 1);
    out += fmt::format("{:12} {:24} {:14} {:12} {:20} {:20} {}\n", number, row.name, row.type, row.range,
                       list(row.readers), list(row.writers), list(row.takers));
  }
  return out;
}

}  // namespace ipos::compiler
