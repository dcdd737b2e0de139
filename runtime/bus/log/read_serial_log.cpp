// Reads lines of the serial log and bare telegrams; says where a line is wrong.
#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "runtime/bus/log/characters.hpp"
#include "runtime/bus/log/serial_log.hpp"

namespace ipos::runtime {
namespace {

std::optional<SerialError> error_of(std::string_view text) {
  for (size_t n = 0; n < kSerialErrors; ++n)
    if (serial_error_text(static_cast<SerialError>(n)) == text) return static_cast<SerialError>(n);
  return std::nullopt;
}

// Walks over one line; each step is false, with the message set, at the first wrong character.
class SerialLineReader {
 public:
  explicit SerialLineReader(std::string_view text) : text_(text) { skip_blanks(); }

  bool read(SerialEntry& entry) {
    const bool logged = text_.substr(at_, text_.find_first_of(kBlanks, at_) - at_).find('.') != text_.npos;
    if (logged) {
      entry.time = 0;
      if (!time(*entry.time) || !time(entry.reception.end) || !name(entry.line)) return false;
      entry.reception.start = *entry.time;
    }
    if (!bytes(entry.reception.bytes)) return false;
    if (!logged && entry.reception.bytes.size == 0) return fail("bytes of a telegram expected");
    entry.reception.telegram = decode_serial(entry.reception.bytes.span());
    // The log knows what the bytes do not show: pauses, parity, stop bits.
    constexpr std::string_view kVoid = "| void: ";
    const std::string_view meaning = text_.substr(at_);
    if (meaning.starts_with(kVoid))
      if (const auto error =
              error_of(meaning.substr(kVoid.size(), meaning.find_last_not_of(kBlanks) + 1 - kVoid.size())))
        entry.reception.telegram = tl::unexpected(*error);
    return true;
  }
  size_t column() const { return at_ + 1; }
  const std::string& message() const { return message_; }

 private:
  bool fail(std::string message) {
    message_ = std::move(message);
    return false;
  }
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip_blanks() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  }

  // "0.003455": seconds and six digits of microseconds.
  bool time(Time& out) {
    constexpr int64_t kLatestSecond = 9'000'000'000;  // fits into nanoseconds of 64 bits
    int64_t seconds = 0;
    int64_t micros = 0;
    const char* end = text_.data() + text_.size();
    if (!is_digit(peek())) return fail("time in seconds expected");
    const auto [point, error] = std::from_chars(text_.data() + at_, end, seconds);
    if (error != std::errc{} || seconds > kLatestSecond) return fail("time in seconds expected");
    at_ = static_cast<size_t>(point - text_.data());
    if (peek() != '.') return fail("'.' expected");
    ++at_;
    if (!is_digit(peek())) return fail("six digits of microseconds expected");
    const auto [stop, wrong] = std::from_chars(text_.data() + at_, end, micros);
    if (wrong != std::errc{} || stop - (text_.data() + at_) != 6)
      return fail("six digits of microseconds expected");
    at_ = static_cast<size_t>(stop - text_.data());
    if (!is_blank(peek())) return fail("blank expected");
    skip_blanks();
    out = seconds * kSecond + micros * kMicrosecond;
    return true;
  }
  bool name(std::string& out) {
    const size_t end = std::min(text_.find_first_of(kBlanks, at_), text_.size());
    if (end == at_) return fail("name of the line expected");
    out = text_.substr(at_, end - at_);
    at_ = end;
    skip_blanks();
    return true;
  }
  // Two digits a byte, with or without blanks between them; up to the end or '|'.
  bool bytes(SerialBytes& out) {
    for (; at_ < text_.size() && peek() != '|'; skip_blanks()) {
      const int high = hex_digit(peek());
      if (high < 0) return fail("hexadecimal byte expected");
      if (out.size == SerialBytes::kLongest)
        return fail(fmt::format("more than {} bytes, the longest telegram", SerialBytes::kLongest));
      ++at_;
      const int low = hex_digit(peek());
      if (low < 0) return fail("second hexadecimal digit of a byte expected");
      ++at_;
      out.push(static_cast<uint8_t>(high << 4 | low));
    }
    return true;
  }

  std::string_view text_;
  size_t at_ = 0;
  std::string message_;
};

}  // namespace

bool is_serial_line(std::string_view text) {
  const size_t first = text.find_first_not_of(kBlanks);
  return first != std::string_view::npos && hex_digit(text[first]) >= 0;
}

tl::expected<SerialEntry, LogError> parse_serial_line(std::string_view text, size_t line) {
  SerialEntry entry;
  SerialLineReader reader(text);
  if (!reader.read(entry)) return tl::unexpected(LogError{line, reader.column(), reader.message()});
  return entry;
}

}  // namespace ipos::runtime
