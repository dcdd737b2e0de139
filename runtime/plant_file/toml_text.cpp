// A scanner that knows texts and comments of TOML, open brackets, and where a value stands. It is right up to the
// first mistake of a text; after that the parser reads no further than the end of a word.
#include "runtime/plant_file/toml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "stdlib/plain_text.hpp"

namespace ipos::runtime {
namespace {

bool is_one_of(char c, std::string_view some) { return some.find(c) != std::string_view::npos; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }

// Of a key without quotes.
bool is_key_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) || c == '_' || c == '-';
}

// Of what begins like a number the parser looks at all characters up to one of these before it knows what it is.
size_t end_of_word(std::string_view text, size_t at) {
  return std::min(text.find_first_of(" \t\n\v\f\r],}#", at), text.size());
}

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {
    if (text.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  std::optional<TomlMistake> find() {
    while (at_ < text_.size() && !mistake_) {
      const char c = text_[at_];
      if (c == '\n')
        end_line();
      else if (is_one_of(c, " \t\r"))
        step(1);
      else if (c == '#')
        step(text_.substr(at_).find_first_of('\n'));
      else if (is_beyond_ascii(c))
        mistake("this character may only stand in a text or a comment");
      else if (is_one_of(c, "\"'"))
        take_quoted();
      else if (is_value_next() && (is_digit(c) || is_one_of(c, "+-")))
        take_number();
      else
        take_mark(c);
    }
    return mistake_;
  }
  const std::vector<size_t>& folded_letters() const { return letters_; }

 private:
  char innermost() const { return open_.empty() ? '\0' : open_.back(); }
  bool is_value_next() const { return before_ == '=' || (innermost() == '[' && is_one_of(before_, "[,")); }

  // Columns are those of the parser: a character beyond ASCII is one, whatever bytes it has.
  void step(size_t bytes) {
    for (const size_t end = at_ + std::min(bytes, text_.size() - at_); at_ < end; ++at_)
      place_.column += (static_cast<unsigned char>(text_[at_]) & 0xC0) != 0x80;
  }
  void end_line() {
    ++at_;
    place_ = {place_.line + 1, 1};
    if (innermost() == '[') return;  // a list goes on
    if (innermost() == kHeader) open_.clear();
    dots_ = 0;
    before_ = '\n';
  }
  void mistake(std::string_view text) { mistake_ = TomlMistake{place_, text}; }

  void take_quoted() {
    if (!is_one_of(before_, "\n=[{,.")) return mistake("a text in quotes cannot begin here");
    before_ = text_[at_];
    const std::string_view rest = text_.substr(at_);
    const std::string_view quote =
        rest.substr(0, rest.starts_with("\"\"\"") || rest.starts_with("'''") ? 3 : 1);
    step(quote.size());
    while (at_ < text_.size()) {
      if (text_[at_] == '\n') {
        if (quote.size() == 1) return;  // such a text ends with its line; the parser reports it
        ++at_;
        place_ = {place_.line + 1, 1};
      } else if (text_[at_] == '\\' && quote[0] == '"') {
        take_escape(quote.size() == 3);
        if (mistake_) return;
      } else if (text_.substr(at_).starts_with(quote)) {
        step(quote.size());
        // Up to two quotes in front of the closing ones belong to such a text.
        for (int more = 0; more < 2 && quote.size() == 3 && text_.substr(at_).starts_with(quote[0]); ++more)
          step(1);
        return;
      } else {
        step(1);
      }
    }
  }

  // \ and the character after it; in a text of several lines a \ at the end of one takes all blanks after it along.
  void take_escape(bool several_lines) {
    step(1);
    if (at_ < text_.size() && !is_beyond_ascii(text_[at_]) && !is_one_of(text_[at_], " \t\r\n"))
      return step(1);
    bool folded = false;
    while (several_lines && at_ < text_.size() && is_one_of(text_[at_], " \t\r\n")) {
      const bool line_ends = text_[at_] == '\n';
      step(1);
      if (line_ends) place_ = {place_.line + 1, 1};
      folded = folded || line_ends;
    }
    if (at_ == text_.size() || !is_beyond_ascii(text_[at_])) return;
    if (!folded || stdlib::utf8_length(text_.substr(at_)) == 0)
      return mistake("this character cannot follow a \\");
    letters_.push_back(at_);
  }

  // Dates and times are no values here: no key takes one, and the parser's ways with wrong ones are many. So there is
  // no colon, and one sign at most beside that at the begin, of the exponent.
  void take_number() {
    const FilePlace begin = place_;
    const size_t first = at_;
    int signs = 0;
    for (const size_t end = end_of_word(text_, at_); at_ < end; step(1)) {
      const char c = text_[at_];
      if (is_beyond_ascii(c)) return mistake("this character may only stand in a text or a comment");
      if (is_one_of(c, "\"'")) return mistake("a text in quotes cannot begin here");
      const bool inner_sign = is_one_of(c, "+-") && at_ != first;
      signs += inner_sign;
      if (c == ':' || signs > 1 || (inner_sign && !is_one_of(text_[at_ - 1], "eE"))) {
        place_ = begin;
        return mistake(kWhatAValueIs);
      }
    }
    before_ = '0';
  }

  void take_mark(char c) {
    if (c == '}' && is_one_of(before_, "[,")) return mistake("a value is missing in front of this }");
    const bool header = c == '[' && before_ == '\n' && open_.empty();
    if (header) {
      size_t name = at_ + (text_.substr(at_).starts_with("[[") ? 2 : 1);
      while (name < text_.size() && is_one_of(text_[name], " \t")) ++name;
      if (name < text_.size() && !is_key_character(text_[name]) && !is_one_of(text_[name], "\"']")) {
        step(name - at_);
        return mistake("a key begins with a letter, a digit, _, - or a quote");
      }
    }
    if (c == '[' || c == '{') open_ += header || innermost() == kHeader ? kHeader : c;
    if ((c == ']' || c == '}') && !open_.empty()) open_.pop_back();
    if (c == '.' && ++dots_ == kMostParts) return mistake("a key has 16 parts at most");
    if (c != '.' && !is_key_character(c) && !is_one_of(c, " \t")) dots_ = 0;
    before_ = c;
    step(1);
  }

  static constexpr char kHeader = 'h';  // an open [ of a table's name
  // Of a key with dots. Each is a table in a table, and the parser takes stack for each of them in turn: with its own
  // limit of 256 values in values some 4000 tables, a tenth of what a thread of 1 MiB holds.
  static constexpr int kMostParts = 16;

  std::string_view text_;
  size_t at_ = 0;
  FilePlace place_{1, 1};
  char before_ = '\n';  // the last character of what is neither blank nor comment; '0' of a number
  int dots_ = 0;        // in the key that is being read
  std::string open_;    // brackets: [ of lists, {, and kHeader
  std::optional<TomlMistake> mistake_;
  std::vector<size_t> letters_;
};

}  // namespace

std::optional<TomlMistake> toml_mistake(std::string_view text) { return Scanner(text).find(); }

std::string toml_for_parser(std::string_view text) {
  Scanner scanner(text);
  scanner.find();
  std::string out;
  size_t done = 0;
  for (const size_t at : scanner.folded_letters()) {
    const size_t length = stdlib::utf8_length(text.substr(at));
    uint32_t code = static_cast<unsigned char>(text[at]) & (0x7FU >> length);
    for (size_t n = 1; n < length; ++n) code = code << 6U | (static_cast<unsigned char>(text[at + n]) & 0x3FU);
    out += text.substr(done, at - done);
    out += fmt::format("\\U{:08X}", code);
    done = at + length;
  }
  return out.append(text.substr(done));
}

}  // namespace ipos::runtime
