// Writes and reads slcan lines; digits may be of either case on input.
#include "runtime/os_port/slcan_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime {
namespace {

// Exactly `digits` hexadecimal digits, taken off the front.
std::optional<uint32_t> take_hex(std::string_view& text, size_t digits) {
  if (text.size() < digits) return std::nullopt;
  uint32_t value = 0;
  for (const char c : text.substr(0, digits)) {
    const bool letter = (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
    if (!letter && (c < '0' || c > '9')) return std::nullopt;
    value = value << 4 | static_cast<uint32_t>(letter ? (c | 0x20) - 'a' + 10 : c - '0');
  }
  text.remove_prefix(digits);
  return value;
}

}  // namespace

std::optional<char> slcan_rate_digit(uint32_t baud) {
  const auto rate = std::find(kSlcanRates.begin(), kSlcanRates.end(), baud);
  if (rate == kSlcanRates.end()) return std::nullopt;
  return static_cast<char>('0' + (rate - kSlcanRates.begin()));
}

std::string slcan_text(const Frame& frame, std::optional<uint16_t> stamp) {
  std::string text;
  const char letter = frame.remote ? 'r' : 't';
  if (frame.extended)
    text = fmt::format("{}{:08X}{}", static_cast<char>(letter - 'a' + 'A'), frame.id, frame.length);
  else
    text = fmt::format("{}{:03X}{}", letter, frame.id, frame.length);
  for (size_t n = 0; !frame.remote && n < frame.length; ++n) text += fmt::format("{:02X}", frame.data[n]);
  if (stamp) text += fmt::format("{:04X}", *stamp);
  text += kSlcanOk;
  return text;
}

size_t slcan_lines(std::string_view text) {
  return static_cast<size_t>(std::count(text.begin(), text.end(), kSlcanOk));
}

std::optional<SlcanFrame> parse_slcan(std::string_view line) {
  if (line.empty() || !is_slcan_frame_letter(line[0])) return std::nullopt;
  SlcanFrame result;
  Frame& frame = result.frame;
  frame.extended = line[0] == 'T' || line[0] == 'R';
  frame.remote = line[0] == 'r' || line[0] == 'R';
  line.remove_prefix(1);
  const auto id = take_hex(line, frame.extended ? 8 : 3);
  const auto length = take_hex(line, 1);
  if (!id || !length || *length > 8) return std::nullopt;
  frame.id = *id;
  frame.length = static_cast<uint8_t>(*length);
  if (!is_valid(frame)) return std::nullopt;
  for (size_t n = 0; !frame.remote && n < frame.length; ++n) {
    const auto byte = take_hex(line, 2);
    if (!byte) return std::nullopt;
    frame.data[n] = static_cast<uint8_t>(*byte);
  }
  if (line.empty()) return result;
  const auto stamp = take_hex(line, 4);
  if (!stamp || *stamp >= kSlcanStampPeriod || !line.empty()) return std::nullopt;
  result.stamp = static_cast<uint16_t>(*stamp);
  return result;
}

std::optional<SlcanFrame> parse_adapter_slcan(std::string_view line) {
  constexpr size_t kLongStamp = 8;
  std::string plain(line);
  if (line.starts_with('x')) plain[0] = 'T';
  if (auto frame = parse_slcan(plain)) return frame;
  if (plain.size() <= kLongStamp) return std::nullopt;
  std::string_view stamp = std::string_view(plain).substr(plain.size() - kLongStamp);
  if (!take_hex(stamp, kLongStamp)) return std::nullopt;
  const auto frame = parse_slcan(std::string_view(plain).substr(0, plain.size() - kLongStamp));
  return frame && !frame->stamp ? frame : std::nullopt;
}

std::optional<SlcanLines::Kind> SlcanLines::push(char c) {
  if (c == kSlcanError) {
    clear();
    return Kind::Error;
  }
  if (c == '\n') return std::nullopt;
  if (c != kSlcanOk) {
    if (pending_.size() < kLimit)
      pending_ += c;
    else
      too_long_ = true;
    return std::nullopt;
  }
  const bool too_long = too_long_;
  complete_.swap(pending_);
  clear();
  return too_long ? Kind::TooLong : Kind::Line;
}

void SlcanLines::clear() {
  pending_.clear();
  too_long_ = false;
}

}  // namespace ipos::runtime
