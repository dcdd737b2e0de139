// Messages of the compiler have a page each; rules of the verifier and findings of the planner have a row.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "compiler/diag/diag.hpp"
#include "runtime/bus_plan/plan.hpp"
#include "tools/explain/entries.hpp"
#include "tools/explain/pages.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tools::explain {
namespace {

std::string_view page_of(std::string_view code) {
  for (const stdlib::EmbeddedFile& page : pages::embedded_files())
    if (page.name.substr(0, page.name.find('.')) == code) return page.text;
  return {};
}

// Of "# E0172: address operator".
std::string title_of(std::string_view page) {
  const std::string first = plain_text(page.substr(0, page.find('\n')));
  return first.substr(std::min(first.find(": ") + 2, first.size()), first.find('\n') - first.find(": ") - 2);
}

std::string message_text(const compiler::DiagInfo& row) {
  std::string text = plain_text(page_of(row.code));
  if (row.severity == compiler::Severity::Warning)
    text += fmt::format("\nSwitched off by -Wno-{0}, made an error by -Werror={0}.\n", row.flag);
  return text;
}

}  // namespace

std::string plain_text(std::string_view page) {
  std::string out;
  bool program = false;
  std::istringstream lines{std::string(page)};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      program = !program;
    } else if (program) {
      out += "    " + line + "\n";
    } else if (!line.starts_with("<!--") && !line.starts_with("[Try it](")) {
      if (line.starts_with("# ")) line.erase(0, 2);
      std::erase(line, '`');
      out += line + "\n";
    }
  }
  return out;
}

void add_messages(Entries& entries) {
  for (const compiler::DiagInfo& row : compiler::diagnostic_table())
    entries.push_back(
        {{std::string(row.code)}, title_of(page_of(row.code)), [&row] { return message_text(row); }});
  for (const vm::RuleInfo& row : vm::rule_table())
    entries.push_back({{std::string(row.code)}, std::string(row.meaning), [&row] {
                         return fmt::format("{}: rule of the verifier\n  {}\n", row.code, row.meaning);
                       }});
  for (const runtime::FindingType& row : runtime::finding_types())
    entries.push_back({{std::string(row.code)}, std::string(row.meaning), [&row] {
                         const bool error = row.weight == runtime::FindingWeight::Error;
                         return fmt::format("{}: finding of ipos bus plan, {}\n  {}\n", row.code,
                                            error ? "against a rule: the exit code is 1" : "a hint",
                                            row.meaning);
                       }});
}

}  // namespace ipos::tools::explain
