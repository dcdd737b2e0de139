// Identifiers and what stands in apostrophes.
#include "runtime/fmi/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace ipos::fmi {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

// "y[2]" or "y[1][0]": the letters before the indices, whose brackets must hold numbers.
bool has_indices(std::string_view text) {
  const size_t open = text.find('[');
  if (open == std::string_view::npos || text.back() != ']' || text.find('[', open + 1) != std::string_view::npos) return false;
  const std::string_view within = text.substr(open + 1, text.size() - open - 2);
  return !within.empty() && std::all_of(within.begin(), within.end(), is_digit);
}

bool is_identifier(std::string_view text) {
  if (text.empty() || !is_letter(text.front())) return false;
  if (has_indices(text)) text = text.substr(0, text.find('['));
  return std::all_of(text.begin(), text.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

std::string quoted(std::string_view text) {
  constexpr std::string_view kAllowed = "!#$%&()*+,-./:;<>=?@[]^|~ ";
  std::string out = "'";
  for (const char c : text) {
    if (is_letter(c) || is_digit(c) || kAllowed.find(c) != std::string_view::npos)
      out += c;
    else
      out += fmt::format("{{{:02X}}}", static_cast<unsigned char>(c));
  }
  return out + "'";
}

// The parts between dots, what is no identifier joined to the part before.
std::vector<std::string_view> parts_of(std::string_view name) {
  std::vector<std::string_view> parts;
  for (size_t at = 0; at <= name.size();) {
    const size_t dot = std::min(name.find('.', at), name.size());
    const std::string_view part = name.substr(at, dot - at);
    if (!is_identifier(part) && !parts.empty())
      parts.back() = name.substr(static_cast<size_t>(parts.back().data() - name.data()),
                                 dot - static_cast<size_t>(parts.back().data() - name.data()));
    else
      parts.push_back(part);
    at = dot + 1;
  }
  return parts;
}

std::string joined(std::string_view name) {
  std::string out;
  for (const std::string_view part : parts_of(name)) {
    if (!out.empty()) out += '.';
    out += is_identifier(part) ? std::string(part) : quoted(part);
  }
  return out;
}

}  // namespace

std::string structured_name(std::string_view owner, std::string_view signal) {
  const std::string_view rest = owner.empty() || !signal.starts_with(owner) ? signal : signal.substr(owner.size() + 1);
  const std::string name = rest.empty() ? std::string() : joined(rest);
  return owner.empty() ? name : joined(owner) + "." + name;
}

}  // namespace ipos::fmi
