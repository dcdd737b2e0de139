// ipos explain: what a code means: of a message, a verifier rule, a return code or a fault of the drive.
// Messages have a page in docs/diagnostics, the others a line in their tables.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>
#include <vector>

#include "compiler/diag/diag.hpp"
#include "stdlib/return_codes.hpp"
#include "tools/failure.hpp"
#include "tools/pages.hpp"
#include "tools/verbs.hpp"
#include "vm/exec/machine.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tools {
namespace {

struct FaultRow {
  uint8_t number;
  const char* meaning;
};
// The faults that programs cause; texts ours.
constexpr FaultRow kFaults[] = {
    {vm::kFaultIllop,
     "IPOS ILLOP: a command cannot be carried out, for example division by zero, *p without such a "
     "variable, or a command this version does not simulate (docs/limits.md)"},
    {vm::kFaultIndexOverflow, "IPOS index overflow: functions call each other deeper than the unit allows"},
};

// A page for the terminal: no marks of Markdown, programs indented.
std::string plain_text(std::string_view page) {
  std::string out;
  bool program = false;
  std::istringstream lines{std::string(page)};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      program = !program;
    } else if (program) {
      out += "    " + line + "\n";
    } else if (!line.starts_with("<!--")) {
      if (line.starts_with("# ")) line.erase(0, 2);
      std::erase(line, '`');
      out += line + "\n";
    }
  }
  return out;
}

std::string message_page(const compiler::DiagInfo& row) {
  for (const stdlib::EmbeddedFile& page : pages::embedded_files()) {
    if (page.name.substr(0, page.name.find('.')) != row.code) continue;
    std::string text = plain_text(page.text);
    if (row.severity == compiler::Severity::Warning)
      text += fmt::format("\nSwitched off by -Wno-{0}, made an error by -Werror={0}.\n", row.flag);
    return text;
  }
  throw Failure(kInternal, fmt::format("{} has no page", row.code));
}

template <typename Number>
bool parse(std::string_view text, int base, Number& value) {
  const auto end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value, base);
  return result.ec == std::errc{} && result.ptr == end;
}

// `8/0/10` as the manuals print it, hexadecimal, or the number in Result: 0x08000010 or 134217744.
std::optional<stdlib::ReturnCode> return_code(std::string_view text) {
  uint32_t packed = 0;
  if (text.starts_with("0X")) {
    if (!parse(text.substr(2), 16, packed)) return std::nullopt;
    return stdlib::ReturnCode::unpack(packed);
  }
  if (parse(text, 10, packed)) return stdlib::ReturnCode::unpack(packed);
  stdlib::ReturnCode code;
  const size_t first = text.find('/');
  const size_t second = text.find('/', first + 1);
  if (first == std::string_view::npos || second == std::string_view::npos) return std::nullopt;
  if (!parse(text.substr(0, first), 16, code.error_class) ||
      !parse(text.substr(first + 1, second - first - 1), 16, code.code) ||
      !parse(text.substr(second + 1), 16, code.additional))
    return std::nullopt;
  return code;
}

std::string explain_return_code(stdlib::ReturnCode code) {
  const std::string_view class_meaning = stdlib::return_class_meaning(code.error_class);
  if (class_meaning.empty())
    throw Failure(kBadInput,
                  fmt::format("no return code has the error class {}; classes are 1 to 8", code.error_class));
  const std::string_view meaning = stdlib::return_code_meaning(code);
  return fmt::format(
      "{:X}/{:X}/{:X}: return code of the parameter channel, 0x{:08X} in Result\n  class {}: {}\n  {}\n",
      code.error_class, code.code, code.additional, code.packed(), code.error_class, class_meaning,
      meaning.empty() ? "this code is in no manual" : meaning);
}

std::string explain(std::string code) {
  const std::string typed = code;
  std::transform(code.begin(), code.end(), code.begin(), [](unsigned char c) { return std::toupper(c); });
  for (const compiler::DiagInfo& row : compiler::diagnostic_table())
    if (row.code == code) return message_page(row);
  for (const vm::RuleInfo& row : vm::rule_table())
    if (row.code == code) return fmt::format("{}: rule of the verifier\n  {}\n", row.code, row.meaning);
  for (const FaultRow& row : kFaults)
    if (code == fmt::format("F{}", row.number))
      return fmt::format("F{}: fault of the drive\n  {}\n", row.number, row.meaning);
  if (const auto number = return_code(code)) return explain_return_code(*number);
  throw Failure(kBadInput,
                fmt::format("there is no code '{}'; codes look like E0101, W0201 (messages), V03 (verifier), "
                            "F10 (faults), 8/0/10 or 0x08000010 (return codes)",
                            typed));
}

}  // namespace

void add_explain(CLI::App& app, int& exit_code) {
  auto code = std::make_shared<std::string>();
  CLI::App* verb =
      app.add_subcommand("explain", "what a code means: message, verifier rule, return code, fault");
  verb->add_option("CODE", *code, "for example E0203, V03, 8/0/10, 0x08000010, F10")->required();
  verb->footer("Example:\n  ipos explain E0203");
  verb->callback([code, &exit_code] {
    fmt::print("{}", explain(*code));
    exit_code = kGood;
  });
}

}  // namespace ipos::tools
