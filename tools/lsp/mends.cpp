// One function for each kind of message, chosen by its code. Each looks whether the text is what it can mend.
#include "tools/lsp/mends.hpp"

#include <fmt/format.h>

#include <vector>

namespace ipos::tools::lsp {
namespace {

constexpr std::string_view kBlanksOfALine = " \t";

struct ToldPlace {
  std::string_view text;
  const Json& diagnostic;
  Encoding encoding;
  uint32_t begin, end;  // of the message

  std::string_view message() const { return diagnostic["message"].get_ref<const std::string&>(); }
  std::string_view there() const { return text.substr(begin, end - begin); }
  uint32_t offset(const Json& position) const { return offset_of(text, position, encoding); }
};

size_t behind_blanks(std::string_view text, size_t at) {
  return std::min(text.find_first_not_of(kBlanksOfALine, at), text.size());
}

// What stands in quotes, the n-th.
std::string quoted(std::string_view text, size_t n) {
  size_t at = 0;
  for (;; --n) {
    const size_t begin = text.find('\'', at);
    const size_t end = begin == std::string_view::npos ? begin : text.find('\'', begin + 1);
    if (end == std::string_view::npos) return {};
    if (n == 0) return std::string(text.substr(begin + 1, end - begin - 1));
    at = end + 1;
  }
}

std::string without_margins(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(kSpace) - begin + 1));
}

// A directive has its line to itself.
bool alone_on_its_lines(std::string_view text, size_t begin, size_t end) {
  const size_t before = begin == 0 ? std::string_view::npos : text.find_last_not_of(kBlanksOfALine, begin - 1);
  const size_t after = text.find_first_not_of(" \t\r", end);
  return (before == std::string_view::npos || text[before] == '\n') &&
         (after == std::string_view::npos || text[after] == '\n');
}

// "A = 1, B, C = -3" as lines of #define; without a value the one behind the last. Empty: something else.
std::string defines(std::string_view list, bool counts) {
  std::string out;
  int64_t next = 0;
  while (!without_margins(list).empty()) {
    const size_t comma = std::min(list.find(','), list.size());
    const std::string_view one = list.substr(0, comma);
    list.remove_prefix(std::min(comma + 1, list.size()));
    const size_t sign = one.find('=');
    const std::string name = without_margins(one.substr(0, sign));
    std::string value = sign == std::string_view::npos ? "" : without_margins(one.substr(sign + 1));
    if (name.empty() || name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
      return {};
    if (value.empty() && !counts) return {};
    if (value.empty()) value = fmt::format("{}", next);
    if (value.find_first_of("(){};\"'\n") != std::string::npos) return {};
    if (counts) {
      char* last = nullptr;
      next = std::strtoll(value.c_str(), &last, 0) + 1;
      if (*last != '\0') return {};
    }
    out += (out.empty() ? "#define " : "\n#define ") + name + " " + value;
  }
  return out;
}

// const long MAX = 5, MIN = 1;
std::optional<Mend> constants(const ToldPlace& at) {
  const size_t end = at.text.find(';', at.begin);
  if (end == std::string_view::npos || !alone_on_its_lines(at.text, at.begin, end + 1)) return std::nullopt;
  const std::string_view list = at.text.substr(at.begin, end - at.begin);
  const size_t sign = list.find('=');
  if (sign == std::string_view::npos) return std::nullopt;
  // The name is the last word before the first '='.
  const size_t name_end = list.find_last_not_of(kBlanksOfALine, sign - 1);
  const size_t before = list.find_last_of(kBlanksOfALine, name_end);
  if (name_end == std::string_view::npos || before == std::string_view::npos) return std::nullopt;
  std::string text = defines(list.substr(before + 1), false);
  if (text.empty()) return std::nullopt;
  return Mend{at.begin, static_cast<uint32_t>(end) + 1, std::move(text)};
}

// enum State { IDLE, RUN = 5 };
std::optional<Mend> enumeration(const ToldPlace& at) {
  const size_t open = at.text.find('{', at.begin);
  const size_t close = at.text.find('}', at.begin);
  if (open == std::string_view::npos || close == std::string_view::npos || open > close) return std::nullopt;
  const size_t end = at.text.find_first_not_of(" \t\r\n", close + 1);
  if (end == std::string_view::npos || at.text[end] != ';' || !alone_on_its_lines(at.text, at.begin, end + 1)) return std::nullopt;
  std::string text = defines(at.text.substr(open + 1, close - open - 1), true);
  if (text.empty()) return std::nullopt;
  return Mend{at.begin, static_cast<uint32_t>(end) + 1, std::move(text)};
}

// Behind `= NUMBER` from there on, and the number; nothing when something else stands there.
std::optional<std::pair<uint32_t, std::string>> behind_assignment(std::string_view text, size_t at) {
  const size_t sign = behind_blanks(text, at);
  if (sign >= text.size() || text[sign] != '=' || text.substr(sign, 2) == "==") return std::nullopt;
  const size_t number = behind_blanks(text, sign + 1);
  const size_t end = std::min(text.find_first_not_of("0123456789", number), text.size());
  const size_t semicolon = behind_blanks(text, end);
  if (end == number || semicolon >= text.size() || text[semicolon] != ';') return std::nullopt;
  return std::pair(static_cast<uint32_t>(end), std::string(text.substr(number, end - number)));
}

// a.3 = 1 and _BitSet(a.3); the message stands at ".3".
std::optional<Mend> bit(const ToldPlace& at) {
  const std::string what = quoted(at.message(), 0);
  std::string text = quoted(at.message(), 1);
  if (what.size() > at.end || at.text.substr(at.end - what.size(), what.size()) != what) return std::nullopt;
  auto begin = at.end - static_cast<uint32_t>(what.size());
  if (const auto assigned = behind_assignment(at.text, at.end)) return Mend{begin, assigned->first, std::move(text)};
  const std::string call = text.substr(0, text.find('(') + 1);
  const size_t close = behind_blanks(at.text, at.end);
  if (begin < call.size() || at.text.substr(begin - call.size(), call.size()) != call || close >= at.text.size() ||
      at.text[close] != ')')
    return std::nullopt;
  return Mend{begin - static_cast<uint32_t>(call.size()), static_cast<uint32_t>(close) + 1, std::move(text)};
}

// "..., write 0xFF": the form of another language as one of this one.
std::optional<Mend> foreign(const ToldPlace& at) {
  constexpr std::string_view kWrite = "write ";
  if (at.message().starts_with("'const'")) return constants(at);
  if (at.message().starts_with("'enum'")) return enumeration(at);
  const size_t advice = at.message().find(kWrite);
  if (advice == std::string_view::npos) return std::nullopt;
  const std::string_view text = at.message().substr(advice + kWrite.size());
  if (text.starts_with("'_Bit")) return bit(at);
  if (text.find_first_of("' \n") != std::string_view::npos || at.there().find('#') == std::string_view::npos) return std::nullopt;
  return Mend{at.begin, at.end, std::string(text)};
}

// DO01 = 1: the headers have an order for it.
std::optional<Mend> output(const ToldPlace& at) {
  const std::string set = "SET_" + std::string(at.there());
  const std::string clear = "CLEAR_" + std::string(at.there());
  const auto assigned = behind_assignment(at.text, at.end);
  const bool known = at.message().find("'" + set + "'") != std::string_view::npos &&
                     at.message().find("'" + clear + "'") != std::string_view::npos;
  if (!assigned || !known || (assigned->second != "0" && assigned->second != "1")) return std::nullopt;
  return Mend{at.begin, assigned->first, assigned->second == "1" ? set : clear};
}

// if (a); b; else c: the ';' that a note points at.
std::optional<Mend> stray_semicolon(const ToldPlace& at) {
  if (!at.diagnostic.contains("relatedInformation")) return std::nullopt;
  for (const Json& note : at.diagnostic["relatedInformation"]) {
    if (!note["message"].get_ref<const std::string&>().starts_with("this ';' is all")) continue;
    const uint32_t begin = at.offset(note["location"]["range"]["start"]);
    if (begin < at.text.size() && at.text[begin] == ';') return Mend{begin, begin + 1, ""};
  }
  return std::nullopt;
}

// "numof( d ) is its number"
std::optional<Mend> number_of(const ToldPlace& at) {
  const size_t begin = at.message().find("numof( ");
  const size_t end = begin == std::string_view::npos ? begin : at.message().find(" )", begin);
  if (end == std::string_view::npos) return std::nullopt;
  const size_t name = begin + std::string_view("numof( ").size();
  return Mend{at.begin, at.end, fmt::format("numof({})", at.message().substr(name, end - name))};
}

// StatusWord & 19
std::optional<Mend> mask(const ToldPlace& at) {
  const std::string bit(at.there());
  if (bit.empty() || bit.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;  // a macro
  return Mend{at.begin, at.end, fmt::format("(1 << {})", bit)};
}

struct Row {
  std::string_view code;
  std::optional<Mend> (*mend)(const ToldPlace& at);
};
constexpr Row kRows[] = {{"E0152", stray_semicolon}, {"E0181", foreign}, {"E0209", output},
                         {"W0256", number_of},       {"W0259", number_of}, {"W0293", mask}};

}  // namespace

std::optional<Mend> mend_of(std::string_view text, const Json& diagnostic, Encoding encoding) {
  for (const Row& row : kRows)
    if (diagnostic["code"] == row.code)
      return row.mend({text, diagnostic, encoding, offset_of(text, diagnostic["range"]["start"], encoding),
                       offset_of(text, diagnostic["range"]["end"], encoding)});
  return std::nullopt;
}

}  // namespace ipos::tools::lsp
