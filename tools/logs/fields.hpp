// The fields of a line of ASC and TRC, one after the other, with the column of each for messages.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "runtime/bus/can/frame.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::tools {

struct FieldError {
  size_t column;  // from 1
  std::string message;
};

class Fields {
 public:
  explicit Fields(std::string_view row) : row_(row) {}

  // The next one, empty at the end.
  std::string_view next() {
    begin_ = row_.find_first_not_of(" \t\r", at_);
    if (begin_ == std::string_view::npos) begin_ = row_.size();
    at_ = row_.find_first_of(" \t\r", begin_);
    if (at_ == std::string_view::npos) at_ = row_.size();
    return row_.substr(begin_, at_ - begin_);
  }
  std::string_view peek() const { return Fields(*this).next(); }
  // About the field given last.
  tl::unexpected<FieldError> wrong(std::string message) const {
    return tl::unexpected(FieldError{begin_ + 1, std::move(message)});
  }

 private:
  std::string_view row_;
  size_t begin_ = 0, at_ = 0;
};

// All of the text is the number, or nothing.
template <typename T>
std::optional<T> whole(std::string_view text, int base = 10) {
  T value{};
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (text.empty() || status != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// No log lasts longer, and with this no time of a log overflows (ours).
inline constexpr runtime::Time kLongestLog = 2'000'000'000 * runtime::kSecond;

// "12.000345" of a unit with so many decimals to the nanosecond (9: seconds, 6: milliseconds), exactly.
inline std::optional<runtime::Time> decimal_time(std::string_view text, size_t decimals) {
  const size_t point = text.find('.');
  const auto units = whole<int64_t>(text.substr(0, point));
  int64_t scale = 1;
  for (size_t n = 0; n < decimals; ++n) scale *= 10;
  if (!units || *units < 0 || *units > kLongestLog / scale - 1) return std::nullopt;
  if (point == std::string_view::npos) return *units * scale;
  const std::string_view fraction = text.substr(point + 1);
  const auto digits = whole<int64_t>(fraction);
  if (!digits || *digits < 0 || fraction.size() > decimals) return std::nullopt;
  for (size_t n = 0; n < fraction.size(); ++n) scale /= 10;
  int64_t unit = 1;
  for (size_t n = 0; n < decimals; ++n) unit *= 10;
  return *units * unit + *digits * scale;
}

// A classic frame may have a DLC up to 15, and has eight bytes then (ISO 11898-1).
inline constexpr uint8_t kLargestDlc = 15;
constexpr uint8_t classic_length(uint8_t dlc) { return dlc > 8 ? 8 : dlc; }

// The bytes of a data frame; nothing on success.
inline std::optional<FieldError> read_bytes(Fields& fields, int base, runtime::Frame& frame) {
  for (uint8_t n = 0; n < frame.length; ++n) {
    const auto byte = whole<uint8_t>(fields.next(), base);
    if (!byte)
      return fields
          .wrong("data byte " + std::to_string(n + 1) + " of " + std::to_string(frame.length) + " expected")
          .value();
    frame.data[n] = *byte;
  }
  return std::nullopt;
}

}  // namespace ipos::tools
