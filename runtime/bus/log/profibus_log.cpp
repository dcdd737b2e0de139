// One line a frame, and back.
#include "runtime/bus/log/profibus_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <ostream>

#include "runtime/bus/log/serial_log.hpp"
#include "runtime/bus/profibus/frame_text.hpp"

namespace ipos::runtime {
namespace {

constexpr std::string_view kVoidFrame = "void frame: ";

std::string_view next_word(std::string_view& text) {
  constexpr std::string_view kBlank = " \t\r";
  text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlank));
  text.remove_prefix(word.size());
  return word;
}

// "0.003455"
std::optional<Time> log_time(std::string_view word) {
  const size_t point = word.find('.');
  int64_t seconds = 0, micros = 0;
  const auto number = [](std::string_view digits, int64_t& out) {
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), out);
    return !digits.starts_with('-') && status == std::errc() && end == digits.data() + digits.size() &&
           out < 9'000'000'000;
  };
  if (point == std::string_view::npos || word.size() != point + 7 ||
      !number(word.substr(0, point), seconds) || !number(word.substr(point + 1), micros))
    return std::nullopt;
  return seconds * kSecond + micros * kMicrosecond;
}

}  // namespace

std::string reception_text(const profibus::Reception& reception) {
  if (reception.frame) return profibus::describe(*reception.frame);
  return std::string(kVoidFrame) + std::string(profibus::frame_error_text(reception.frame.error()));
}

void ProfibusLog::on_frame(const profibus::Line& line, profibus::NodeId,
                           const profibus::Reception& reception) {
  out_ << serial_time_text(reception.start) << ' ' << serial_time_text(reception.end) << ' ' << line.name()
       << ' ' << profibus::hex_text(reception.octets) << " | " << reception_text(reception) << '\n';
}

profibus::Reception reception_of(profibus::Octets octets, Time start, Time end,
                                 std::optional<profibus::FrameError> error) {
  auto frame = profibus::decode(octets);
  if (error) frame = tl::unexpected(*error);
  return {std::move(frame), std::move(octets), start, end};
}

std::optional<ProfibusEntry> parse_profibus_line(std::string_view text) {
  const size_t bar = text.find('|');
  const bool logged = text.substr(0, bar).find('.') != std::string_view::npos;
  std::string line;
  Time start = 0, end = 0;
  if (logged) {
    const auto from = log_time(next_word(text)), to = log_time(next_word(text));
    if (!from || !to) return std::nullopt;
    start = *from;
    end = *to;
    line = next_word(text);
  }
  profibus::Octets octets;
  std::string_view word = next_word(text);
  for (; !word.empty() && word != "|"; word = next_word(text)) {
    uint8_t octet = 0;
    const auto [last, status] = std::from_chars(word.data(), word.data() + word.size(), octet, 16);
    if (status != std::errc() || last != word.data() + word.size() || word.size() != 2) return std::nullopt;
    octets.push_back(octet);
  }
  std::optional<profibus::FrameError> error;
  if (const size_t at = text.find(kVoidFrame); logged && at != std::string_view::npos) {
    std::string_view reason = text.substr(at + kVoidFrame.size());
    reason = reason.substr(0, reason.find_last_not_of(" \t\r") + 1);
    error = profibus::frame_error(reason);
    if (!error) return std::nullopt;
  }
  // MOVILINK begins with 02 or 1D; in its log a void telegram may begin with anything, and be a frame by chance.
  constexpr std::string_view kVoidTelegram = "void: ";
  if (logged && text.substr(std::min(text.find_first_not_of(" \t"), text.size())).starts_with(kVoidTelegram))
    return std::nullopt;
  const bool begins_a_frame = !octets.empty() && profibus::frame_size(octets).has_value();
  if (!error && (!begins_a_frame || (logged && !profibus::decode(octets)))) return std::nullopt;
  return ProfibusEntry{std::move(line), reception_of(std::move(octets), start, end, error)};
}

}  // namespace ipos::runtime
