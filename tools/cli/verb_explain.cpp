// ipos explain: what a code means: of a message, a verifier rule, a return code, a fault or a parameter of
// the drive. Messages have a page in docs/reference/diagnostics, the others a row in their tables.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>
#include <vector>

#include "compiler/diag/diag.hpp"
#include "stdlib/faults.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/return_codes.hpp"
#include "stdlib/unsimulated.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/pages.hpp"
#include "tools/cli/verbs.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tools {
namespace {

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

// The response in the words of P830, whose codes all responses have.
std::string response_text(stdlib::FaultResponse response) {
  const stdlib::Parameter* p830 = stdlib::parameter_table(*stdlib::find_unit("md60a")).find("P830");
  return stdlib::parameter_text(*p830, static_cast<int32_t>(response));
}

std::string explain_fault(const stdlib::FaultRow& row) {
  std::string text = fmt::format("F{:02}: fault of the drive, {}\n  {}\n", row.number, row.name, row.meaning);
  if (row.parameter.empty()) return text + fmt::format("  response: {}\n", response_text(row.response));
  return text +
         fmt::format("  response: P{}, factory setting {}; RAPID STOP/ERROR on a MOVITRAC 07 without it\n",
                     row.parameter, response_text(row.response));
}

std::string list_faults() {
  std::string text;
  for (const stdlib::FaultRow& row : stdlib::fault_table())
    text += fmt::format("F{:02}  {}: {}\n", row.number, row.name, row.meaning);
  return text;
}

// `name` is a number as P130 or an index. Units with the same row stand together.
std::string explain_parameter(std::string_view name) {
  struct Row {
    std::string label, units, text;
  };
  std::vector<Row> rows;
  for (const stdlib::UnitType& unit : stdlib::unit_types()) {
    const stdlib::Parameter* row = stdlib::parameter_table(unit).find(name);
    if (row == nullptr) continue;
    const std::string label =
        row->number.empty() ? fmt::format("index {}", row->index) : fmt::format("P{}", row->number);
    std::string text = fmt::format("{}, ", row->name);
    text += row->index == 0 ? "at the keypad only" : fmt::format("index {}", row->index);
    if (row->index != 0 && !row->writable) text += ", read only";
    if (row->needs_inhibit) text += ", written under controller inhibit only";
    if (row->writable) {
      text += fmt::format("\n  factory setting {}",
                          stdlib::parameter_text(*row, static_cast<int32_t>(row->default_value)));
      for (const stdlib::ValueRange& range : row->ranges)
        text += fmt::format("\n  {} .. {} in steps of {}",
                            stdlib::parameter_text(*row, static_cast<int32_t>(range.minimum)),
                            stdlib::parameter_text(*row, static_cast<int32_t>(range.maximum)),
                            stdlib::parameter_text(*row, static_cast<int32_t>(range.step)));
      for (const stdlib::ValueText& value : row->texts)
        text += fmt::format("\n  {} = {}", value.value, value.text);
      for (const stdlib::Unsimulated& one : stdlib::unsimulated(unit, row->index))
        text += fmt::format("\n  not simulated{}: {}",
                            one.values.empty() ? "" : fmt::format(" ({})", one.row->values), one.row->text);
    }
    const auto same = std::find_if(rows.begin(), rows.end(),
                                   [&](const Row& one) { return one.label == label && one.text == text; });
    if (same == rows.end())
      rows.push_back({label, std::string(unit.title), text});
    else
      same->units += fmt::format(", {}", unit.title);
  }
  std::string out;
  for (const Row& row : rows) out += fmt::format("{} of {}: {}\n", row.label, row.units, row.text);
  return out;
}

std::string explain(std::string code) {
  const std::string typed = code;
  std::transform(code.begin(), code.end(), code.begin(), [](unsigned char c) { return std::toupper(c); });
  for (const compiler::DiagInfo& row : compiler::diagnostic_table())
    if (row.code == code) return message_page(row);
  for (const vm::RuleInfo& row : vm::rule_table())
    if (row.code == code) return fmt::format("{}: rule of the verifier\n  {}\n", row.code, row.meaning);
  if (code == "F") return list_faults();
  if (uint8_t number = 0; code.starts_with('F') && parse(std::string_view(code).substr(1), 10, number))
    if (const stdlib::FaultRow* row = stdlib::find_fault(number)) return explain_fault(*row);
  constexpr uint16_t kFirstIndex = 1000;  // below are numbers, which need their P
  uint16_t index = 0;
  if (code.starts_with('P') || (parse(std::string_view(code), 10, index) && index >= kFirstIndex))
    if (std::string text = explain_parameter(code); !text.empty()) return text;
  if (const auto number = return_code(code)) return explain_return_code(*number);
  throw Failure(
      kBadInput,
      fmt::format(
          "there is no code '{}'; codes look like E0101, W0201 (messages), V03 (verifier), "
          "F10 (faults; F lists them), P130 or 8470 (parameters), 8/0/10 or 0x08000010 (return codes)",
          typed));
}

}  // namespace

void add_explain(cli::Verb& app) {
  auto code = std::make_shared<std::string>();
  cli::Verb& verb =
      app.verb("explain", "what a code means: message, verifier rule, return code, fault, parameter");
  verb.option("CODE", *code,
              "for example E0203, V03, 8/0/10, 0x08000010, F10, P130, 8470; F lists all faults")
      .required();
  verb.footer("Example:\n  ipos explain E0203");
  verb.runs([code] {
    fmt::print("{}", explain(*code));
    return kGood;
  });
}

}  // namespace ipos::tools
