// What a drive shows: faults, parameters of the units, return codes of the parameter channel.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>

#include "stdlib/faults.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/return_codes.hpp"
#include "stdlib/unsimulated.hpp"
#include "tools/explain/entries.hpp"

namespace ipos::tools::explain {
namespace {

template <typename Number>
bool parse(std::string_view text, int base, Number& value) {
  const auto end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value, base);
  return result.ec == std::errc{} && result.ptr == end;
}

// `8/0/10` as the manuals print it, hexadecimal, or the number in Result: 0x08000010 or 134217744.
std::optional<stdlib::ReturnCode> parse_return_code(std::string_view text) {
  uint32_t packed = 0;
  if (text.starts_with("0x") || text.starts_with("0X")) {
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

std::string return_code_text(stdlib::ReturnCode code) {
  const std::string_view class_meaning = stdlib::return_class_meaning(code.error_class);
  if (class_meaning.empty()) return {};
  const std::string_view meaning = stdlib::return_code_meaning(code);
  return fmt::format(
      "{:X}/{:X}/{:X}: return code of the parameter channel, 0x{:08X} in Result\n  class {}: {}\n  {}\n",
      code.error_class, code.code, code.additional, code.packed(), code.error_class, class_meaning,
      meaning.empty() ? "this code is in no manual" : meaning);
}

// The response in the words of P830, whose codes all responses have.
std::string response_text(stdlib::FaultResponse response) {
  const stdlib::Parameter* p830 = stdlib::parameter_table(stdlib::usual_unit()).find("P830");
  return stdlib::parameter_text(*p830, static_cast<int32_t>(response));
}

// Meaning and response on one unit.
std::string fault_on(const stdlib::UnitType& unit, const stdlib::FaultRow& row) {
  std::string text = stdlib::meaning_on(unit, row) + "\n  response: ";
  if (const auto* parameter = stdlib::response_parameter(stdlib::parameter_table(unit), row))
    return text + fmt::format("P{}, factory setting {}", parameter->number,
                              stdlib::parameter_text(*parameter, static_cast<int32_t>(parameter->default_value)));
  text += response_text(stdlib::fixed_response(unit, row));
  return row.parameter == stdlib::kByCommand ? text + ", another one by _FaultReaction" : text;
}

// What the units say of the fault; those that say the same stand together.
std::string fault_text(const stdlib::FaultRow& row) {
  std::vector<std::pair<std::string, std::string>> groups;  // titles, text
  for (const stdlib::UnitType& unit : stdlib::unit_types()) {
    const std::string text = fault_on(unit, row);
    const auto same =
        std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return group.second == text; });
    if (same == groups.end())
      groups.emplace_back(unit.title, text);
    else
      same->first += fmt::format(", {}", unit.title);
  }
  std::string out = fmt::format("F{:02}: fault of the drive, {}\n", row.number, row.name);
  constexpr std::string_view kReset = "  reset: an input with the function RESET, control word bit 6, P840, or auto reset P841; if the "
                           "cause is still there, the fault comes back\n";
  for (const auto& [titles, text] : groups)
    out += groups.size() == 1 ? fmt::format("  {}\n", text) : fmt::format("  {}: {}\n", titles, text);
  out += kReset;
  return out;
}

// `name` is a number as P130 or an index. Units with the same row stand together.
std::string parameter_text(std::string_view name) {
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
    if (const std::string_view nothing = stdlib::unshown(unit, *row); !nothing.empty())
      text += fmt::format("\n  not simulated: {}", nothing);
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

// In one line, in the words of MOVIDRIVE B.
std::string meaning_of(const stdlib::FaultRow& row) {
  return stdlib::meaning_on(stdlib::unit_with(stdlib::Trait::NewVariables), row);
}

}  // namespace

std::string list_faults() {
  std::string text;
  for (const stdlib::FaultRow& row : stdlib::fault_table())
    text += fmt::format("F{:02}  {}: {}\n", row.number, row.name, meaning_of(row));
  return text;
}

std::string parameter_of_index(std::string_view number) {
  constexpr uint16_t kFirstIndex = 1000;  // below are numbers, which need their P
  uint16_t index = 0;
  return parse(number, 10, index) && index >= kFirstIndex ? parameter_text(number) : std::string();
}

std::string return_code(std::string_view number) {
  const std::optional<stdlib::ReturnCode> code = parse_return_code(number);
  return code ? return_code_text(*code) : std::string();
}

void add_drive(Entries& entries) {
  for (const stdlib::FaultRow& row : stdlib::fault_table())
    entries.push_back({{fmt::format("F{:02}", row.number), fmt::format("F{}", row.number),
                        fmt::format("F{:03}", row.number)},
                       fmt::format("{}: {}", row.name, meaning_of(row)),
                       [&row] { return fault_text(row); }});
  std::set<std::string> known;
  for (const stdlib::UnitType& unit : stdlib::unit_types())
    for (const stdlib::Parameter& row : stdlib::parameter_table(unit).rows()) {
      const std::string name =
          row.number.empty() ? fmt::format("{}", row.index) : fmt::format("P{}", row.number);
      if (known.insert(name).second)
        entries.push_back({{name}, std::string(row.name), [name] { return parameter_text(name); }});
    }
  for (const stdlib::ReturnCodeRow& row : stdlib::return_code_table()) {
    const stdlib::ReturnCode code = row.code;
    entries.push_back({{fmt::format("{:X}/{:X}/{:X}", code.error_class, code.code, code.additional)},
                       std::string(row.meaning),
                       [code] { return return_code_text(code); }});
  }
}

}  // namespace ipos::tools::explain
