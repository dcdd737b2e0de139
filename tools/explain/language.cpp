// The words of the language: system functions with their row of docs/reference/stdlib.md, structures with what their
// members hold, system variables, constants of the headers, and the commands a program becomes.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "stdlib/header_names.hpp"
#include "stdlib/language_tables.hpp"
#include "stdlib/system_variables.hpp"
#include "stdlib/unit_names.hpp"
#include "tools/explain/entries.hpp"
#include "tools/explain/pages.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::tools::explain {
namespace {

// The cells of a row of a Markdown table; `\|` is a stroke in a cell.
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  std::string cell;
  for (size_t n = 1; n < line.size(); ++n) {
    if (line[n] == '\\' && n + 1 < line.size() && line[n + 1] == '|') {
      cell += line[++n];
    } else if (line[n] == '|') {
      const size_t begin = cell.find_first_not_of(' ');
      cells.push_back(
          begin == std::string::npos ? "" : cell.substr(begin, cell.find_last_not_of(' ') - begin + 1));
      cell.clear();
    } else {
      cell += line[n];
    }
  }
  return cells;
}

// What the page of the standard library says about a function, a line a column: "  blocks: no".
std::string row_of_page(std::string_view function) {
  const auto page = std::find_if(pages::embedded_files().begin(), pages::embedded_files().end(),
                                 [](const stdlib::EmbeddedFile& file) { return file.name == "stdlib.md"; });
  if (page == pages::embedded_files().end()) return {};
  std::vector<std::string> heads;
  std::istringstream lines{std::string(page->text)};
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("|")) {
      heads.clear();
      continue;
    }
    const std::vector<std::string> cells = cells_of(line);
    if (heads.empty()) heads = cells;
    if (heads[0] != "function" || cells[0].find(fmt::format("`{}(", function)) == std::string::npos) continue;
    std::string text = fmt::format("  written: {}", plain_text(cells[0]));
    for (size_t n = 1; n < std::min(cells.size(), heads.size()); ++n)
      if (!cells[n].empty() && cells[n] != "-")
        text += fmt::format("  {}: {}", heads[n], plain_text(cells[n]));
    return text;
  }
  return {};
}

std::string source_line(std::string_view source) {
  return source.empty() ? std::string("  source: no manual read prints it\n")
                        : fmt::format("  source: {}\n", source);
}

std::string function_text(const stdlib::SystemFunction& row) {
  return fmt::format("{}: system function, {}\n{}  command: {}\n", row.name, row.meaning,
                     row_of_page(row.name), row.mnemonic) +
         source_line(row.source);
}

// "number of a variable", "ML_BT_S0 = 1, ML_BT_S1 = 2".
std::string member_text(const stdlib::MemberUse& use) {
  if (use.holds_number()) return "number of a variable, as numof() gives it";
  std::map<std::string_view, std::string_view> seen;
  std::string text;
  for (const std::string_view beginning : use.constants())
    for (const stdlib::HeaderName& name : stdlib::header_names())
      if (name.name.starts_with(beginning) && seen.emplace(name.name, name.text).second)
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name.name, name.text);
  return text;
}

std::string structure_text(const stdlib::Structure& row) {
  std::string text = fmt::format("{}: structure of {} variables\n", row.name, row.members.size());
  for (const std::vector<std::string_view>& member : row.members) {
    const stdlib::MemberUse* use = stdlib::find_member_use(row.name, member.front());
    const std::string name = fmt::format("{}", fmt::join(member, ", also "));
    text += use == nullptr ? fmt::format("  {}\n", name) : fmt::format("  {}: {}\n", name, member_text(*use));
  }
  return text + source_line(row.source);
}

std::string variable_text(const stdlib::SystemVariable& row) {
  return fmt::format("H{} {}: system variable, in assembler text {}\n  {}\n  {}{}\n", row.number,
                     row.compiler_name, row.assembler_name, row.meaning,
                     row.access == stdlib::VariableAccess::R ? "only the drive writes it"
                                                             : "drive and program write it",
                     row.units == stdlib::VariableUnits::B
                         ? fmt::format("; on {} only", stdlib::unit_names(stdlib::Trait::NewVariables))
                         : "") +
         (row.use == stdlib::VariableUse::Nothing ? "  not simulated: it is a variable like others\n" : "") +
         source_line(row.source);
}

// "SCOM {scom} {v}" with words for the operands.
std::string form_text(std::string_view text) {
  static const std::map<std::string_view, std::string_view> kOperands = {
      {"v", "VARIABLE"}, {"k", "CONSTANT"}, {"b", "BIT"}, {"n", "COUNT"}, {"m", "LABEL"}};
  std::string form;
  while (!text.empty()) {
    const size_t open = text.find('{');
    form += text.substr(0, open);
    if (open == std::string_view::npos) break;
    const size_t close = text.find('}', open);
    const std::string_view operand = text.substr(open + 1, close - open - 1);
    const auto known = kOperands.find(operand);
    form += known == kOperands.end() ? "KEYWORD" : known->second;
    text.remove_prefix(close + 1);
  }
  return form;
}

void add_commands(Entries& entries) {
  std::map<std::string, std::string> forms;  // of each mnemonic
  std::map<std::string, std::string> meanings;
  for (const vm::OpcodeInfo& row : vm::opcode_table()) {
    const std::string name(row.mnemonic());
    forms[name] += fmt::format("  {}: {}\n", form_text(row.text), row.meaning);
    meanings.emplace(name, row.meaning);
  }
  for (const auto& [name, text] : forms)
    entries.push_back({{name}, meanings[name], [name = name, text = text] {
                         return fmt::format("{}: command of the drive, in assembler text\n{}", name, text);
                       }});
}

void add_constants(Entries& entries) {
  std::map<std::string_view, std::vector<const stdlib::HeaderName*>> rows;
  for (const stdlib::HeaderName& name : stdlib::header_names())
    if (!name.text.empty() && stdlib::find_system_variable(name.name) == nullptr)
      rows[name.name].push_back(&name);
  for (const auto& [name, same] : rows) {
    std::vector<std::string_view> headers;
    for (const stdlib::HeaderName* one : same) headers.push_back(one->header);
    const std::string text =
        fmt::format("{}: name of {}\n  {}\n", name, fmt::join(headers, " and "), same[0]->text);
    entries.push_back(
        {{std::string(name)}, fmt::format("stands for {}", same[0]->text), [text] { return text; }});
  }
}

}  // namespace

void add_language(Entries& entries) {
  for (const stdlib::SystemFunction& row : stdlib::system_functions())
    entries.push_back(
        {{std::string(row.name)}, std::string(row.meaning), [&row] { return function_text(row); }});
  for (const stdlib::Structure& row : stdlib::structures()) {
    std::vector<std::string_view> members;
    for (const auto& names : row.members) members.push_back(names.front());
    entries.push_back({{std::string(row.name)},
                       fmt::format("structure of {}", fmt::join(members, ", ")),
                       [&row] { return structure_text(row); }});
  }
  for (const stdlib::SystemVariable& row : stdlib::system_variables())
    entries.push_back(
        {{fmt::format("H{}", row.number), std::string(row.compiler_name), std::string(row.assembler_name)},
         fmt::format("{}: {}", row.compiler_name, row.meaning),
         [&row] { return variable_text(row); }});
  add_commands(entries);
  add_constants(entries);
}

}  // namespace ipos::tools::explain
