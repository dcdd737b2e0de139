// Each form is recognised whole, by what no valid program has; what is not whole is left to the parser.
#include "compiler/parse/foreign_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>

#include "compiler/preprocess/word_filter.hpp"
#include "stdlib/spelling.hpp"

namespace ipos::compiler {
namespace {

using stdlib::equal_but_for_case;

constexpr int kHighestBit = 31;

bool is_any(std::string_view word, std::initializer_list<std::string_view> of) {
  return std::any_of(of.begin(), of.end(), [&](std::string_view each) { return equal_but_for_case(word, each); });
}

bool is_type(TokenKind kind) {
  switch (kind) {
    case TokenKind::Long:
#define FOREIGN_TYPE(kind, spelling) case TokenKind::kind:
#define FOREIGN_QUALIFIER(kind, spelling)
#define KEYWORD(kind, spelling)
#include "compiler/preprocess/tokens.def"
      return true;
    default: return false;
  }
}

bool opens_declarations(std::string_view word) {
  return is_any(word, {"VAR", "VAR_GLOBAL", "VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT", "VAR_TEMP"});
}

bool is_plc_type(std::string_view word) {
  return is_any(word, {"INT", "DINT", "SINT", "LINT", "UINT", "UDINT", "USINT", "BOOL", "BYTE", "WORD", "DWORD", "REAL", "LREAL", "TIME"}) ||
         is_any(word, {"int8_t", "int16_t", "int32_t", "uint8_t", "uint16_t", "uint32_t"});
}

bool opens_function(std::string_view word) {
  return is_any(word, {"FUNCTION", "FUNCTION_BLOCK", "PROGRAM", "ORGANIZATION_BLOCK"});
}

constexpr WordFilter kNames = [] {
  WordFilter words;
  for (const std::string_view word : {"VAR", "VAR_GLOBAL", "VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT", "VAR_TEMP", "FUNCTION", "FUNCTION_BLOCK",
                                      "PROGRAM", "ORGANIZATION_BLOCK", "INT", "DINT", "SINT", "LINT", "UINT", "UDINT", "USINT", "BOOL", "BYTE",
                                      "WORD", "DWORD", "REAL", "LREAL", "TIME", "int8_t", "int16_t", "uint8_t", "uint16_t"})
    words.add(word);
  return words;
}();

// 5s, 100ms: digits and a unit of time.
bool is_time(std::string_view number) {
  return (number.back() == 's' || number.back() == 'S') && number.find_first_of("xXbB") == std::string_view::npos;
}

// Each form has one of these tokens. Most programs have none.
bool may_be_of_form(const Token& token, TokenKind next) {
  switch (token.kind) {
    case TokenKind::LeftParen: return next == TokenKind::Star;
    case TokenKind::Dot: return next == TokenKind::Dot;
    case TokenKind::Hash:
    case TokenKind::Enum:
    case TokenKind::Const: return true;
    case TokenKind::Number: return token.text[0] == '.' || is_time(token.text);
    case TokenKind::Name:
      return kNames.may_have(token.text) &&
             (opens_declarations(token.text) || is_plc_type(token.text) || opens_function(token.text));
    default: return false;
  }
}

// "FF_FF" of base 16; nothing where a digit is not of the base.
std::optional<uint32_t> value_of(std::string_view digits, int base) {
  std::string plain(digits);
  std::erase(plain, '_');
  char* end = nullptr;
  const unsigned long long value = std::strtoull(plain.c_str(), &end, base);
  if (plain.empty() || *end != '\0' || value > UINT32_MAX) return std::nullopt;
  return static_cast<uint32_t>(value);
}

// "1m30s", "1.5s", "100ms" in milliseconds.
std::optional<uint32_t> milliseconds_of(std::string_view text) {
  std::string plain(text);
  std::erase(plain, '_');
  double sum = 0;
  const char* at = plain.c_str();
  while (*at != '\0') {
    char* end = nullptr;
    const double number = std::strtod(at, &end);
    if (end == at) return std::nullopt;
    const char* unit_end = end;
    while (std::isalpha(static_cast<unsigned char>(*unit_end)) != 0) ++unit_end;
    const std::string_view unit(end, static_cast<size_t>(unit_end - end));
    constexpr std::pair<std::string_view, double> kUnits[] = {{"ms", 1}, {"s", 1e3}, {"m", 6e4}, {"h", 3.6e6}, {"d", 8.64e7}};
    const auto* const row =
        std::find_if(std::begin(kUnits), std::end(kUnits), [&](const auto& each) { return equal_but_for_case(each.first, unit); });
    if (row == std::end(kUnits)) return std::nullopt;
    sum += number * row->second;
    at = unit_end;
  }
  if (!(sum >= 0) || sum > INT32_MAX) return std::nullopt;
  return static_cast<uint32_t>(std::lround(sum));
}

class Forms {
 public:
  Forms(std::span<const Token> tokens, std::deque<std::string>& texts, Diagnostics& diagnostics)
      : tokens_(tokens), texts_(texts), diagnostics_(diagnostics) {}

  std::vector<Token> run() {
    out_.reserve(tokens_.size());
    bool directive = false;
    while (at_ < tokens_.size()) {
      const TokenKind now = kind(0);
      if (now == TokenKind::Pragma || now == TokenKind::Declare) directive = true;
      if (now == TokenKind::DirectiveEnd) directive = false;
      if (now == TokenKind::LeftBrace) ++depth_;
      if (now == TokenKind::RightBrace) --depth_;
      if (directive || !begins_form(now) ||
          !(comment() || range() || time() || based_number() || bit() || constants_of_enum() || constant() || declarations() ||
            declaration() || foreign_type() || function() || known_name()))
        out_.push_back(tokens_[at_++]);
    }
    return std::move(out_);
  }

 private:
  // Of the tokens from here on.
  TokenKind kind(size_t distance) const {
    return at_ + distance < tokens_.size() ? tokens_[at_ + distance].kind : TokenKind::End;
  }
  std::string_view text(size_t distance) const { return tokens_[at_ + distance].text; }
  bool touches(size_t distance) const { return !tokens_[at_ + distance].spaced && !tokens_[at_ + distance].line_start; }

  void report(size_t count, std::string_view what, std::string advice) {
    diagnostics_.report(Diag::ForeignWord, {tokens_[at_].span.begin, tokens_[at_ + count - 1].span.end},
                        {std::string(what), std::move(advice)});
  }
  // What every form below begins with; most tokens of a program are something else.
  static bool begins_form(TokenKind kind) {
    return kind == TokenKind::Name || kind == TokenKind::Number || kind == TokenKind::Enum || kind == TokenKind::Const ||
           kind == TokenKind::Static || kind == TokenKind::LeftParen || kind == TokenKind::Dot;
  }

  // In place of the token at the distance.
  void put(size_t distance, TokenKind as, std::string words) {
    Token made = tokens_[at_ + distance];
    made.kind = as;
    made.text = texts_.emplace_back(std::move(words));
    out_.push_back(made);
  }

  // (* text *): no expression has a '*' before a ')'.
  bool comment() {
    if (kind(0) != TokenKind::LeftParen || kind(1) != TokenKind::Star || !touches(1)) return false;
    constexpr size_t kLongest = 500;
    for (size_t n = 1; n < kLongest && kind(n) != TokenKind::End; ++n)
      if (kind(n) == TokenKind::Star && kind(n + 1) == TokenKind::RightParen && touches(n + 1)) {
        report(2, "(*", "comments are '/* ... */' or '// ...'");
        at_ += n + 2;
        return true;
      }
    return false;
  }

  // case 1 ... 3:
  bool range() {
    if (kind(0) != TokenKind::Dot || kind(1) != TokenKind::Dot || out_.size() < 2 || out_.back().kind != TokenKind::Number ||
        out_[out_.size() - 2].kind != TokenKind::Case)
      return false;
    const size_t last = kind(2) == TokenKind::Dot ? 3 : 2;
    if (kind(last) != TokenKind::Number || kind(last + 1) != TokenKind::Colon) return false;
    report(last, "...", fmt::format("each value has a case of its own: write 'case {}: ... case {}:'", out_.back().text, text(last)));
    at_ += last + 1;
    return true;
  }

  // 5s, 100ms.
  bool time() {
    if (kind(0) != TokenKind::Number || !is_time(text(0))) return false;
    const std::optional<uint32_t> number = milliseconds_of(text(0));
    if (!number) return false;
    report(1, text(0), fmt::format("times are numbers of milliseconds: write {}", *number));
    put(0, TokenKind::Number, fmt::format("{}", *number));
    ++at_;
    return true;
  }

  // What is declared as a variable, or as a type behind a '}', somewhere in the program.
  bool declared(std::string_view name) const {
    for (size_t n = 1; n < tokens_.size(); ++n)
      if (tokens_[n].text == name && (tokens_[n - 1].kind == TokenKind::Long || tokens_[n - 1].kind == TokenKind::Comma ||
                                      tokens_[n - 1].kind == TokenKind::RightBrace))
        return true;
    return false;
  }
  bool at_begin() const {
    return out_.empty() || out_.back().kind == TokenKind::Semicolon || out_.back().kind == TokenKind::RightBrace ||
           out_.back().kind == TokenKind::LeftBrace;
  }

  // a : DINT := 5;
  bool declaration() {
    if (depth_ != 0 || kind(0) != TokenKind::Name || kind(1) != TokenKind::Colon || !at_begin() ||
        (!is_type(kind(2)) && !(kind(2) == TokenKind::Name && is_plc_type(text(2)))))
      return false;
    size_t last = 3;
    while (kind(last) != TokenKind::Semicolon && kind(last) != TokenKind::LeftBrace && kind(last) != TokenKind::End) ++last;
    if (kind(last) != TokenKind::Semicolon) return false;
    report(3, fmt::format("{} : {}", text(0), text(2)), fmt::format("write 'long {};'", text(0)));
    put(0, TokenKind::Long, "long");
    out_.push_back(tokens_[at_]);
    at_ += last;
    return true;
  }

  // INT x;
  bool foreign_type() {
    if (kind(0) != TokenKind::Name || kind(1) != TokenKind::Name || !at_begin() || !is_plc_type(text(0)) || declared(text(0))) return false;
    if (kind(2) != TokenKind::Semicolon && kind(2) != TokenKind::Comma && kind(2) != TokenKind::Assign && kind(2) != TokenKind::LeftBracket)
      return false;
    diagnostics_.report(Diag::ForeignType, tokens_[at_].span, {std::string(text(0))});
    put(0, TokenKind::Long, "long");
    ++at_;
    return true;
  }

  // FUNCTION_BLOCK name
  bool function() {
    if (depth_ != 0 || kind(0) != TokenKind::Name || kind(1) != TokenKind::Name || !opens_function(text(0)) || !at_begin() || declared(text(0)))
      return false;
    report(1, text(0), fmt::format("write '{}() {{ ... }}'", text(1)));
    at_ += 2;
    if (kind(0) == TokenKind::Semicolon) ++at_;
    return true;
  }

  // 16#FF, 2#1010, T#1s.
  bool based_number() {
    const TokenKind value = kind(2);
    if ((kind(0) != TokenKind::Number && kind(0) != TokenKind::Name) || kind(1) != TokenKind::Hash || !touches(1) ||
        (value != TokenKind::Number && value != TokenKind::Name) || !touches(2))
      return false;
    const std::string whole = fmt::format("{}#{}", text(0), text(2));
    std::optional<uint32_t> number;
    if (is_any(text(0), {"T", "TIME", "LT", "LTIME"})) {
      number = milliseconds_of(text(2));
      if (number) report(3, whole, fmt::format("times are numbers of milliseconds: write {}", *number));
    } else if (is_any(text(0), {"2", "8", "16"})) {
      const int base = std::atoi(std::string(text(0)).c_str());
      number = value_of(text(2), base);
      if (number) report(3, whole, "write " + (base == 8 ? fmt::format("{}", *number) : fmt::format("0{}{}", base == 2 ? 'b' : 'x', text(2))));
    }
    if (!number) return false;
    put(0, TokenKind::Number, fmt::format("{}", *number));
    at_ += 3;
    return true;
  }

  // Where the object that ends with the last token begins: H481, a[2], x.y.
  size_t object_begin() const {
    size_t n = out_.size() - 1;
    while (true) {
      for (int level = 0; n > 0; --n) {  // behind its index, to its name
        if (out_[n].kind == TokenKind::RightBracket) ++level;
        if (out_[n].kind == TokenKind::LeftBracket) --level;
        if (level == 0 && out_[n].kind != TokenKind::LeftBracket) break;
      }
      if (n < 2 || out_[n - 1].kind != TokenKind::Dot) return n;
      n -= 2;
    }
  }

  // E1.0, I1.0, A4.0, Q4.0 of a PLC.
  static std::string_view plc_signal(std::string_view object) {
    if (object.size() < 2 || object.find_first_not_of("0123456789", 1) != std::string_view::npos) return {};
    switch (object[0]) {
      case 'E':
      case 'I': return "inputs are 'DI00', 'DI01' and so on of '#include <io.h>', or of <iob.h> for MOVIDRIVE B";
      case 'A':
      case 'Q': return "outputs are set by 'SET_DO01;', 'CLEAR_DO01;' and so on of '#include <io.h>', or of <iob.h> for MOVIDRIVE B";
      default: return {};
    }
  }

  // a.3, H481.1: the scanner has `.3` as a number.
  bool bit() {
    if (kind(0) != TokenKind::Number || text(0)[0] != '.' || !touches(0) || out_.empty() ||
        (out_.back().kind != TokenKind::Name && out_.back().kind != TokenKind::RightBracket))
      return false;
    const std::optional<uint32_t> number = value_of(text(0).substr(1), 10);
    if (!number || *number > kHighestBit) return false;
    const size_t begin = object_begin();
    std::string object;
    for (size_t n = begin; n < out_.size(); ++n) object += out_[n].text;
    const bool is_argument = begin >= 2 && out_[begin - 1].kind == TokenKind::LeftParen && out_[begin - 2].text.starts_with("_Bit");
    const bool is_set = kind(1) == TokenKind::Assign && kind(2) == TokenKind::Number && kind(3) == TokenKind::Semicolon;
    std::string advice = fmt::format("bit {} of it is '{} & 0x{:X}'", *number, object, 1U << *number);
    if (is_argument) advice = fmt::format("write '{}({}, {})'", out_[begin - 2].text, object, *number);
    if (is_set) advice = fmt::format("write '{}({}, {})'", text(2) == "0" ? "_BitClear" : "_BitSet", object, *number);
    if (const std::string_view plc = plc_signal(object); !plc.empty() && !declared(object)) advice = plc;
    report(1, object + std::string(text(0)), std::move(advice));
    if (is_argument) {
      put(0, TokenKind::Comma, ",");
      put(0, TokenKind::Number, fmt::format("{}", *number));
    }
    ++at_;
    return true;
  }

  // enum [tag] { A, B = 5 } [variables];   enum tag variable;
  bool constants_of_enum() {
    if (kind(0) != TokenKind::Enum) return false;
    const bool tagged = kind(1) == TokenKind::Name;
    size_t n = tagged ? 2 : 1;
    if (tagged && kind(n) == TokenKind::Name) {  // a variable of such a type
      put(0, TokenKind::Long, "long");
      at_ += 2;
      return true;
    }
    if (kind(n) != TokenKind::LeftBrace) return false;
    int64_t next = 0;
    std::vector<std::pair<std::string_view, std::string>> found;
    do {
      ++n;
      if (kind(n) == TokenKind::RightBrace && !found.empty()) break;  // { A, B, }
      if (kind(n) != TokenKind::Name) return false;
      const std::string_view name = text(n++);
      if (kind(n) == TokenKind::Assign) {
        const bool negative = kind(n + 1) == TokenKind::Minus;
        n += negative ? 2 : 1;
        if (kind(n) != TokenKind::Number) return false;
        const std::optional<uint32_t> value = value_of(text(n++), 0);
        if (!value) return false;
        next = negative ? -int64_t{*value} : int64_t{*value};
      }
      found.emplace_back(name, fmt::format("{}", next++));
    } while (kind(n) == TokenKind::Comma);
    if (kind(n) != TokenKind::RightBrace) return false;
    const bool is_typedef = !out_.empty() && out_.back().kind == TokenKind::Typedef && kind(n + 1) == TokenKind::Name;
    report(1, "enum", defines(found));
    for (const auto& [name, value] : found) constants_[name] = value;
    if (is_typedef) {
      out_.pop_back();
      types_.emplace_back(text(n + 1));
      ++n;
    }
    at_ += n;  // at the brace or the name of the type
    const bool ends = is_typedef || kind(1) == TokenKind::Semicolon;
    if (!ends) put(0, TokenKind::Long, "long");
    at_ += ends && kind(1) == TokenKind::Semicolon ? 2 : 1;
    return true;
  }

  static std::string defines(const std::vector<std::pair<std::string_view, std::string>>& found) {
    std::string advice = "write ";
    constexpr size_t kShown = 2;
    for (size_t i = 0; i < std::min(found.size(), kShown); ++i)
      advice += fmt::format("{}'#define {} {}'", i == 0 ? "" : " and ", found[i].first, found[i].second);
    return advice + (found.size() > kShown ? " and so on" : "");
  }

  // const long MAX = 5, MIN = -5;
  bool constant() {
    size_t n = 0;
    bool is_const = false;
    for (; kind(n) == TokenKind::Const || kind(n) == TokenKind::Static; ++n) is_const |= kind(n) == TokenKind::Const;
    if (!is_const || !is_type(kind(n))) return false;
    while (is_type(kind(n))) ++n;
    std::vector<std::pair<std::string_view, std::string>> found;
    do {
      if (!found.empty()) ++n;  // the comma
      if (kind(n) != TokenKind::Name || kind(n + 1) != TokenKind::Assign) return false;
      const bool negative = kind(n + 2) == TokenKind::Minus;
      const size_t value = n + (negative ? 3 : 2);
      if (kind(value) != TokenKind::Number) return false;
      found.emplace_back(text(n), fmt::format("{}{}", negative ? "-" : "", text(value)));
      n = value + 1;
    } while (kind(n) == TokenKind::Comma);
    if (kind(n) != TokenKind::Semicolon) return false;
    report(1, "const", defines(found));
    for (const auto& [name, value] : found) constants_[name] = value;
    at_ += n + 1;
    return true;
  }

  // VAR a, b : INT := 5; END_VAR outside of functions.
  bool declarations() {
    if (kind(0) != TokenKind::Name || depth_ != 0 || !opens_declarations(text(0))) return false;
    size_t n = 1;
    if (kind(n) == TokenKind::Name && is_any(text(n), {"CONSTANT", "RETAIN", "PERSISTENT"})) ++n;
    if (kind(n) != TokenKind::Name || (kind(n + 1) != TokenKind::Colon && kind(n + 1) != TokenKind::Comma)) return false;
    size_t last = n;
    while (kind(last) != TokenKind::End && !(kind(last) == TokenKind::Name && is_any(text(last), {"END_VAR"}))) ++last;
    if (kind(last) == TokenKind::End) return false;
    report(1, text(0), fmt::format("variables are declared outside of functions: 'long {};'", text(n)));
    while (n < last) {
      put(n, TokenKind::Long, "long");
      for (; n < last && (kind(n) == TokenKind::Name || kind(n) == TokenKind::Comma); ++n) out_.push_back(tokens_[at_ + n]);
      while (n < last && kind(n) != TokenKind::Semicolon) ++n;  // its type and first value
      if (n == last) --n;
      put(n, TokenKind::Semicolon, ";");
      ++n;
    }
    at_ += last + 1;
    if (kind(0) == TokenKind::Semicolon) ++at_;
    return true;
  }

  // A constant, or a type that is one of constants.
  bool known_name() {
    if (kind(0) != TokenKind::Name || (types_.empty() && constants_.empty())) return false;
    if (!out_.empty() && (out_.back().kind == TokenKind::Dot || out_.back().kind == TokenKind::Arrow)) return false;
    if (std::find(types_.begin(), types_.end(), text(0)) != types_.end() && kind(1) == TokenKind::Name) {
      put(0, TokenKind::Long, "long");
      ++at_;
      return true;
    }
    const auto known = constants_.find(text(0));
    if (known == constants_.end()) return false;
    std::string_view value = known->second;
    if (value.starts_with('-')) {
      put(0, TokenKind::Minus, "-");
      value.remove_prefix(1);
    }
    put(0, TokenKind::Number, std::string(value));
    ++at_;
    return true;
  }

  std::span<const Token> tokens_;
  std::deque<std::string>& texts_;
  Diagnostics& diagnostics_;
  std::vector<Token> out_;
  std::map<std::string_view, std::string> constants_;  // by name, as they are written
  std::vector<std::string_view> types_;                // of enums
  size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::span<const Token> without_foreign_forms(std::span<const Token> tokens, ForeignForms& changed, Diagnostics& diagnostics) {
  bool found = false;
  for (size_t n = 0; n < tokens.size() && !found; ++n)
    found = may_be_of_form(tokens[n], n + 1 < tokens.size() ? tokens[n + 1].kind : TokenKind::End);
  if (!found) return tokens;
  changed.tokens = Forms(tokens, changed.texts, diagnostics).run();
  return changed.tokens;
}

}  // namespace ipos::compiler
