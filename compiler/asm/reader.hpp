// A cursor over one line of assembler text. Its read functions take what they are asked for, or leave the
// cursor where it was and say no.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ipos::compiler {

// Letters of ASCII; assembler text is read without regard to case.
constexpr char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

class LineReader {
 public:
  // `line` starts at byte `offset` of the file.
  LineReader(std::string_view line, size_t offset) : line_(line), offset_(offset) {}

  size_t at() const { return at_; }
  void go(size_t at) { at_ = at; }
  size_t file_offset() const { return offset_ + at_; }
  void skip_space();
  bool done();  // only white space is left
  std::string_view rest() const { return line_.substr(at_); }

  // A run of letters, digits and _.
  std::string_view word();
  // These characters, without regard to case; a space in `text` stands for any white space.
  bool text(std::string_view text);
  // The same, as a whole word or words.
  bool whole(std::string_view text);
  // An unsigned decimal number; larger ones become UINT64_MAX.
  std::optional<uint64_t> decimal();
  // A constant in any notation; outside [-2^31, 2^32) it is clamped to one of the numbers beside that range.
  std::optional<int64_t> constant();
  // H number or the name of a system variable.
  std::optional<uint64_t> variable();
  // A bare or quoted name.
  std::optional<std::string> name();

 private:
  std::string_view line_;
  size_t offset_;
  size_t at_ = 0;
};

}  // namespace ipos::compiler
