// Braces, and names of parameters in texts.
#include "stdlib/unit_text.hpp"

#include <algorithm>
#include <cctype>

#include "stdlib/parameters.hpp"

namespace ipos::stdlib {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

bool fits(const UnitType& unit, std::string_view part) {
  const std::vector<std::string> named = named_parameters(part);
  return std::all_of(named.begin(), named.end(), [&](const std::string& one) { return has_named(unit, one); });
}

std::string_view choose(const UnitType& unit, std::string_view alternatives) {
  while (true) {
    const size_t end = alternatives.find('|');
    const std::string_view part = alternatives.substr(0, end);
    if (fits(unit, part)) return part;
    if (end == std::string_view::npos) return {};
    alternatives.remove_prefix(end + 1);
  }
}

}  // namespace

std::string unit_text(const UnitType& unit, std::string_view text) {
  std::string out;
  while (true) {
    const size_t open = text.find('{');
    const size_t close = text.find('}', open);
    out += text.substr(0, open);
    if (close == std::string_view::npos) return out;
    out += choose(unit, text.substr(open + 1, close - open - 1));
    text.remove_prefix(close + 1);
  }
}

std::vector<std::string> named_parameters(std::string_view text) {
  constexpr size_t kLength = 4;
  std::vector<std::string> named;
  for (size_t at = 0; at + kLength <= text.size(); ++at) {
    const std::string_view name = text.substr(at, kLength);
    const bool alone = (at == 0 || !is_word(text[at - 1])) &&
                       (at + kLength == text.size() || !is_word(text[at + kLength]));
    if (alone && name[0] == 'P' && is_digit(name[1]) && is_digit(name[2]) && (is_digit(name[3]) || name[3] == 'x'))
      named.emplace_back(name);
  }
  return named;
}

bool has_named(const UnitType& unit, std::string_view parameter) {
  const ParameterTable& table = parameter_table(unit);
  if (parameter.back() != 'x') return table.find(parameter) != nullptr;
  const std::string_view tens = parameter.substr(1, 2);
  return std::any_of(table.rows().begin(), table.rows().end(),
                     [&](const Parameter& row) { return row.number.starts_with(tens); });
}

}  // namespace ipos::stdlib
