// What a name is, in Markdown: for hovers and for the list of completions.
#include <fmt/format.h>

#include <algorithm>

#include "stdlib/language_tables.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/system_variables.hpp"
#include "stdlib/unit_names.hpp"
#include "stdlib/units.hpp"
#include "tools/lsp/features.hpp"

namespace ipos::tools::lsp {
namespace {

using compiler::IndexedSymbol;
using compiler::SymbolKind;

std::string code(const std::string& text) { return "```ipos\n" + text + "\n```\n"; }

std::string numbers(uint32_t first, uint32_t count) {
  return count > 1 ? fmt::format("H{}..H{}", first, first + count - 1) : fmt::format("H{}", first);
}

std::string system_variable(uint32_t number) {
  const stdlib::SystemVariable* row = stdlib::find_system_variable(static_cast<uint16_t>(number));
  if (row == nullptr) return {};
  return fmt::format("System variable H{} {} ({}{}): {}\n\nSource: {}\n", row->number, row->compiler_name,
                     row->access == stdlib::VariableAccess::R ? "read only" : "read and write",
                     row->units == stdlib::VariableUnits::B
                           ? fmt::format(", {} only", stdlib::unit_names(stdlib::Trait::NewVariables))
                           : "", row->meaning,
                     row->source);
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

// Who reads and writes the variables; known once the program compiles.
std::string accesses(const Program& program, uint32_t number) {
  for (const compiler::checked::MapEntry& row : program.compiled.map) {
    if (row.range == "temporaries" || number < row.number || number >= row.number + row.count) continue;
    std::string out;
    if (!row.readers.empty()) out += fmt::format("read in {}", joined(row.readers));
    if (!row.writers.empty())
      out += fmt::format("{}written in {}", out.empty() ? "" : ", ", joined(row.writers));
    if (!row.takers.empty())
      out += fmt::format("{}number taken in {}", out.empty() ? "" : ", ", joined(row.takers));
    return out.empty() ? out : out + "\n";
  }
  return {};
}

std::string variable(const Program& program, const IndexedSymbol& symbol, std::optional<uint32_t> number) {
  const uint32_t first = number.value_or(symbol.number.value_or(0));
  std::string out;
  switch (symbol.kind) {
    case SymbolKind::RawVariable: out = code(symbol.name); break;
    case SymbolKind::Alias: out = code(fmt::format("#declare {} // {}", symbol.name, symbol.type)); break;
    default: {
      const size_t bracket = symbol.type.find('[');
      const std::string type = symbol.type.substr(0, bracket);
      const std::string array = bracket == std::string::npos ? "" : symbol.type.substr(bracket);
      out = code(fmt::format("{}{} {}{}", symbol.initial ? "initial " : "", type, symbol.name, array));
    }
  }
  if (symbol.kind != SymbolKind::RawVariable)
    out += fmt::format("{}, {}\n", numbers(first, symbol.count),
                       symbol.kind == SymbolKind::Alias ? "another name of it"
                       : symbol.initial                 ? "kept at power-off"
                                                        : "global");
  if (const std::string system = system_variable(first); !system.empty()) out += "\n" + system;
  if (const std::string access = accesses(program, first); !access.empty()) out += "\n" + access;
  return out;
}

std::string structure(const Program& program, const IndexedSymbol& symbol) {
  std::string members;
  std::optional<uint32_t> last;
  for (const IndexedSymbol& member : program.index.symbols) {
    if (member.kind != SymbolKind::Member || member.container != symbol.name) continue;
    if (last && last == member.number)
      members += fmt::format("  // or {}", member.name);
    else
      members += fmt::format("\n    {} {};", member.type, member.name);
    last = member.number;
  }
  std::string out = code(fmt::format("typedef struct {{{}\n}} {};", members, symbol.name));
  const stdlib::Structure* standard = stdlib::find_structure(symbol.name);
  if (standard != nullptr) out += fmt::format("Standard structure. Source: {}\n", standard->source);
  return out + fmt::format("{} variables\n", symbol.count);
}

// A parameter of the unit the program is for, and what its value counts in.
std::string parameter(const Program& program, uint32_t index) {
  const stdlib::ParameterTable& table = stdlib::parameter_table(*program.compiled.unit);
  const stdlib::Parameter* row = table.find(static_cast<uint16_t>(index));
  if (row == nullptr)
    return fmt::format("Index {}: {}\n", index, stdlib::index_name(table, static_cast<uint16_t>(index)));
  return describe_parameter(*row);
}

}  // namespace

std::string describe_parameter(const stdlib::Parameter& parameter) {
  std::string out = fmt::format("**{}{} {}**, index {}\n\n", parameter.number.empty() ? "" : "P",
                                parameter.number, parameter.name, parameter.index);
  const std::string_view quantity = stdlib::quantity_name(parameter.quantity);
  if (!quantity.empty())
    out += fmt::format("- {}, transferred in units of quantity {} with conversion {}{}\n", quantity,
                       parameter.quantity, parameter.conversion,
                       parameter.display.empty() ? "" : fmt::format(", shown in {}", parameter.display));
  else if (!parameter.display.empty())
    out += fmt::format("- shown in {}\n", parameter.display);
  if (!parameter.writable) {
    out += "- read only\n";
  } else {
    out += fmt::format("- factory setting {}{}\n",
                       stdlib::parameter_text(parameter, static_cast<int32_t>(parameter.default_value)),
                       parameter.needs_inhibit ? ", written under controller inhibit only" : "");
    if (!parameter.ranges.empty()) out += fmt::format("- {}\n", stdlib::parameter_range(parameter));
    for (const stdlib::ValueRange& range : parameter.ranges)
      out += fmt::format("- {} to {} in steps of {}\n", range.minimum, range.maximum, range.step);
  }
  for (const stdlib::ValueText& value : parameter.texts)
    out += fmt::format("- {} = {}\n", value.value, value.text);
  return out;
}

std::string comment_of(const IndexedSymbol& symbol) {
  if (!symbol.definition) return {};
  const std::string& text = symbol.definition->file->text;
  const auto strip = [](std::string_view line) {
    while (!line.empty() &&
           (line.front() == ' ' || line.front() == '\t' || line.front() == '/' || line.front() == '*'))
      line.remove_prefix(1);
    while (!line.empty() && (line.back() == ' ' || line.back() == '\t' || line.back() == '\r' ||
                             line.back() == '/' || line.back() == '*'))
      line.remove_suffix(1);
    return std::string(line);
  };
  const auto line_at = [&](size_t begin) {
    return std::string_view(text).substr(begin, std::min(text.find('\n', begin), text.size()) - begin);
  };
  const std::string_view rest = line_at(symbol.definition->end);
  const size_t behind = std::min(rest.find("//"), rest.find("/*"));
  if (behind != std::string_view::npos) return strip(rest.substr(behind));
  std::string above;
  size_t begin = text.rfind('\n', symbol.definition->begin) + 1;
  while (begin > 0) {
    const size_t start = begin < 2 ? 0 : text.rfind('\n', begin - 2) + 1;
    const std::string_view line = line_at(start);
    const size_t first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos || line.substr(first, 2) != "//") break;
    above = strip(line) + (above.empty() ? "" : "\n") + above;
    begin = start;
  }
  return above;
}

std::string describe_system_function(std::string_view name) {
  const stdlib::SystemFunction* row = stdlib::find_system_function(name);
  if (row == nullptr) return {};
  std::string arguments(row->arguments);
  for (size_t at = arguments.find(' '); at != std::string::npos; at = arguments.find(' ', at + 2))
    arguments.replace(at, 1, ", ");
  return code(fmt::format("{}({})", row->name, arguments)) +
         fmt::format("System function: {}\n\nCommand {}. Source: {}\n", row->meaning, row->mnemonic,
                     row->source.empty() ? "on no manual page read" : row->source);
}

std::string describe(const Program& program, const IndexedSymbol& symbol, std::optional<uint32_t> number) {
  std::string out;
  switch (symbol.kind) {
    case SymbolKind::Macro: {
      out = code(fmt::format("#define {} {}", symbol.name, symbol.type));
      uint32_t raw = 0;
      if (symbol.type.starts_with('H') && symbol.type.size() < 6 &&
          std::sscanf(symbol.type.c_str(), "H%u", &raw) == 1)
        if (const std::string system = system_variable(raw); !system.empty()) return out + system;
      break;
    }
    case SymbolKind::Variable:
    case SymbolKind::Alias:
    case SymbolKind::RawVariable: out = variable(program, symbol, number); break;
    case SymbolKind::Function: out = code(symbol.name + "()"); break;
    case SymbolKind::Structure: out = structure(program, symbol); break;
    case SymbolKind::Member:
      out = code(fmt::format("{} {}.{}", symbol.type, symbol.container, symbol.name));
      if (number)
        out += numbers(*number, symbol.count) + "\n";
      else
        out += fmt::format("variable {} of {}\n", symbol.number.value_or(0), symbol.container);
      break;
    case SymbolKind::SystemFunction: return describe_system_function(symbol.name);
    case SymbolKind::Parameter: return parameter(program, symbol.number.value_or(0));
  }
  if (const std::string comment = comment_of(symbol); !comment.empty()) out += "\n" + comment + "\n";
  return out;
}

}  // namespace ipos::tools::lsp
