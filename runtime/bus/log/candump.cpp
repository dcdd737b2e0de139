// Reads and writes candump log lines; the reader says where a line is wrong.
#include "runtime/bus/log/candump.hpp"

#include <fmt/format.h>

#include <charconv>
#include <ostream>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/can/line.hpp"
#include "runtime/bus/log/characters.hpp"

namespace ipos::runtime {
namespace {

// Walks over one line; each parsing step is false, with the message set, at the first wrong character.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  bool read(LogEntry& entry) {
    return expect('(') && time(entry.time) && expect(')') && blanks() && name(entry.bus) && blanks() &&
           identifier(entry.frame) && content(entry.frame) && direction();
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
    while (is_blank(peek())) ++at_;
  }
  bool expect(char wanted) {
    if (peek() != wanted) return fail(fmt::format("'{}' expected", wanted));
    ++at_;
    return true;
  }
  bool blanks() {
    if (!is_blank(peek())) return fail("blank expected");
    skip_blanks();
    return true;
  }
  bool number(int64_t limit, int64_t& value, size_t& digits) {
    const char* first = text_.data() + at_;
    if (peek() < '0' || peek() > '9') return fail("digit expected");
    const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
    if (error != std::errc{} || value > limit) return fail("number too large");
    digits = static_cast<size_t>(end - first);
    at_ += digits;
    return true;
  }
  bool time(Time& out) {
    constexpr int64_t kLatestSecond = 9'000'000'000;     // fits into nanoseconds of 64 bits
    constexpr size_t kLeastDigits = 6, kMostDigits = 9;  // 9: candump -N
    int64_t seconds = 0;
    int64_t part = 0;
    size_t digits = 0;
    if (!number(kLatestSecond, seconds, digits) || !expect('.')) return false;
    const size_t fraction = at_;
    if (!number(999'999'999, part, digits)) return false;
    if (digits < kLeastDigits || digits > kMostDigits) {
      at_ = fraction;
      return fail("six digits of microseconds, or up to nine, expected");
    }
    for (; digits < kMostDigits; ++digits) part *= 10;
    out = seconds * kSecond + part - kCandumpEpoch;
    return true;
  }
  bool name(std::string& out) {
    const size_t begin = at_;
    while (at_ < text_.size() && !is_blank(peek())) ++at_;
    if (at_ == begin) return fail("interface name expected");
    out = text_.substr(begin, at_ - begin);
    return true;
  }
  bool identifier(Frame& frame) {
    const size_t begin = at_;
    while (hex_digit(peek()) >= 0 && at_ - begin < 9) {
      frame.id = frame.id << 4 | static_cast<uint32_t>(hex_digit(peek()));
      ++at_;
    }
    const size_t digits = at_ - begin;
    frame.extended = digits == 8;
    if ((digits != 3 && digits != 8) || !is_valid(frame)) {
      at_ = begin;
      return fail("identifier of 3 (up to 7FF) or 8 (up to 1FFFFFFF) hexadecimal digits expected");
    }
    if (!expect('#')) return false;
    return peek() == '#' ? fail("CAN FD frames are not supported") : true;
  }
  bool content(Frame& frame) {
    if (peek() == 'R' || peek() == 'r') {
      ++at_;
      frame.remote = true;
      if (peek() < '0' || peek() > '8') return true;
      frame.length = static_cast<uint8_t>(peek() - '0');
      ++at_;
      return raw_dlc(frame);
    }
    // Bytes may have points between them, as cansend takes them.
    while (hex_digit(peek()) >= 0 || (peek() == '.' && frame.length != 0)) {
      if (peek() == '.') ++at_;
      if (frame.length == frame.data.size()) return fail("more than 8 data bytes");
      const int high = hex_digit(peek());
      if (high < 0) return fail("hexadecimal data byte expected");
      ++at_;
      const int low = hex_digit(peek());
      if (low < 0) return fail("second hexadecimal digit of a data byte expected");
      ++at_;
      frame.data[frame.length++] = static_cast<uint8_t>(high << 4 | low);
    }
    return raw_dlc(frame);
  }
  // "_E": a DLC from 9 to 15, with which a frame has eight bytes, too.
  bool raw_dlc(const Frame& frame) {
    if (peek() != '_') return true;
    ++at_;
    if (frame.length != frame.data.size() || hex_digit(peek()) <= static_cast<int>(frame.data.size()))
      return fail("a DLC from 9 to F behind eight bytes expected");
    ++at_;
    return true;
  }
  bool direction() {  // newer candump adds R or T
    if (at_ < text_.size() && !is_blank(peek())) return fail("end of data expected");
    skip_blanks();
    if (peek() == 'R' || peek() == 'T') ++at_;
    skip_blanks();
    return at_ == text_.size() ? true : fail("end of line expected");
  }

  std::string_view text_;
  size_t at_ = 0;
  std::string message_;
};

std::string line_head(Time time, std::string_view bus) {
  const Time stamp = time + kCandumpEpoch;
  return fmt::format("({:010d}.{:06d}) {} ", stamp / kSecond, stamp % kSecond / kMicrosecond, bus);
}

}  // namespace

std::string candump_line(Time time, std::string_view bus, const Frame& frame) {
  std::string line = line_head(time, bus);
  line += id_text(frame.id, frame.extended) + '#';
  if (frame.remote)
    line += frame.length == 0 ? std::string("R") : fmt::format("R{}", frame.length);
  else
    for (size_t i = 0; i < frame.length; ++i) line += fmt::format("{:02X}", frame.data[i]);
  return line;
}

std::string candump_line(const CanLine& line, const ErrorRecord& error) {
  constexpr uint32_t kErrorFlag = 0x2000'0000, kAcknowledge = 0x20, kProtocol = 0x08, kBusError = 0x80;
  return fmt::format("{}{:08X}#{:016X}", line_head(error.end, line.name()),
                     kErrorFlag | (error.unacknowledged ? kAcknowledge : kProtocol | kBusError), 0);
}

void CandumpLog::on_error_frame(const CanLine& line, const ErrorRecord& record) {
  out_ << candump_line(line, record) << '\n';
}

void CandumpLog::on_frame(const CanLine& line, const FrameRecord& record) {
  out_ << candump_line(record.end, line.name(), record.frame) << '\n';
}

tl::expected<LogEntry, LogError> parse_candump_line(std::string_view text, size_t line) {
  LogEntry entry{};
  LineReader reader(text);
  if (!reader.read(entry)) return tl::unexpected(LogError{line, reader.column(), reader.message()});
  return entry;
}

tl::expected<std::vector<LogEntry>, LogError> parse_candump(std::string_view text) {
  std::vector<LogEntry> entries;
  for (size_t line = 1; !text.empty(); ++line) {
    const size_t end = text.find('\n');
    const std::string_view row = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (row.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    auto entry = parse_candump_line(row, line);
    if (!entry) return tl::unexpected(entry.error());
    entries.push_back(std::move(*entry));
  }
  return entries;
}

}  // namespace ipos::runtime
