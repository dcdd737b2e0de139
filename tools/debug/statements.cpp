// A scan of the text without comments, strings and directives. What ends a statement or opens one stands in front of the next.
#include "tools/debug/statements.hpp"

#include <cctype>
#include <string>

namespace ipos::tools::debug {
namespace {

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  std::vector<bool> lines() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\n') {
        new_line();
      } else if (std::isspace(static_cast<unsigned char>(c)) != 0) {
        ++at_;
      } else if (c == '#' && !seen_) {
        skip_directive();
      } else if (text_.substr(at_, 2) == "//") {
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
      } else if (text_.substr(at_, 2) == "/*") {
        skip_comment();
      } else {
        token(c);
      }
    }
    return starts_;
  }

 private:
  void new_line() {
    ++at_;
    seen_ = false;
    starts_.push_back(false);
  }

  void skip_directive() {
    for (; at_ < text_.size() && text_[at_] != '\n'; ++at_)
      if (text_[at_] == '\\' && (text_.substr(at_, 2) == "\\\n" || text_.substr(at_, 3) == "\\\r\n")) {
        at_ += text_[at_ + 1] == '\n' ? 1 : 2;
        starts_.push_back(false);
      }
  }

  void skip_comment() {
    for (at_ += 2; at_ < text_.size() && text_.substr(at_, 2) != "*/"; ++at_)
      if (text_[at_] == '\n') {
        starts_.push_back(false);
        seen_ = false;
      }
    at_ += 2;
  }

  void token(char c) {
    if (!seen_) starts_.back() = open_.empty() && begins_;
    seen_ = true;
    if (is_name(c)) {
      word_.clear();
      while (at_ < text_.size() && is_name(text_[at_])) word_ += text_[at_++];
      begins_ = word_ == "else" || word_ == "do";
      return;
    }
    ++at_;
    if (c == '"' || c == '\'') {
      while (at_ < text_.size() && text_[at_] != c && text_[at_] != '\n') at_ += text_[at_] == '\\' ? 2U : 1U;
      if (at_ < text_.size() && text_[at_] == c) ++at_;
    }
    begins_ = c == ';' || c == '{' || c == '}' || (c == ':' && asked_ == 0);
    if (c == '(') open_.push_back(word_ == "if" || word_ == "for" || word_ == "while" || word_ == "switch");
    if (c == ')' && !open_.empty()) {
      begins_ = open_.back();
      open_.pop_back();
    }
    if (c == '?') ++asked_;
    if (c == ':' && asked_ > 0) --asked_;
    if (c == ';') asked_ = 0;
    word_.clear();
  }

  std::string_view text_;
  size_t at_ = 0;
  bool seen_ = false;        // a word of this line
  bool begins_ = true;       // what comes next begins a statement
  int asked_ = 0;            // '?' without their ':'
  std::string word_;         // in front of a bracket
  std::vector<bool> open_;   // round brackets; whether each is the head of a statement
  std::vector<bool> starts_{false, false};  // of line 0, which there is not, and of line 1
};

}  // namespace

std::vector<bool> statement_lines(std::string_view text) { return Scan(text).lines(); }

}  // namespace ipos::tools::debug
