// The receiver, one character at a time.
#include "runtime/bus/movilink/serial_receiver.hpp"

#include <algorithm>

namespace ipos::runtime {
namespace {

std::optional<SerialError> error_of(const Character& character) {
  if (character.framing_error) return SerialError::Frame;
  if (character.parity_error) return SerialError::Parity;
  return std::nullopt;
}

bool is_start(uint8_t byte) { return byte == kRequestStart || byte == kResponseStart; }

}  // namespace

void SerialReceiver::begin(const Character& character) {
  bytes_ = {};
  bytes_.push(character.data);
  start_ = character.start;
  skip_ = false;
}

Reception SerialReceiver::end(tl::expected<SerialTelegram, SerialError> telegram, bool skip) {
  skip_ = skip;
  Reception reception{std::move(telegram), bytes_, start_, quiet_since_.value_or(0)};
  bytes_ = {};
  return reception;
}

void SerialReceiver::occupied(Time end) {
  quiet_since_ = std::max(quiet_since_.value_or(end), end);
  bytes_ = {};
  skip_ = false;
}

std::optional<Reception> SerialReceiver::give_up() {
  if (!receiving()) return std::nullopt;
  return end(tl::unexpected(SerialError::Gap), true);
}

std::optional<Reception> SerialReceiver::take(const Character& character) {
  const bool paused = !quiet_since_ || character.start - *quiet_since_ >= kStartPause;
  std::optional<Reception> voided;
  if (receiving() && character.start - *quiet_since_ > kCharacterGap) voided = give_up();
  const bool skipping = skip_;
  quiet_since_ = character.end;
  if (!receiving()) {
    const auto error = error_of(character);
    begin(character);
    if (paused && !error && is_start(character.data)) return voided;
    // What follows an error without a pause belongs to the same bad telegram and is not reported again.
    const bool silent = voided || (skipping && !paused);
    const SerialError reason = error                      ? *error
                               : is_start(character.data) ? SerialError::Pause
                                                          : SerialError::Start;
    Reception reception = end(tl::unexpected(reason), true);
    return silent ? voided : reception;
  }
  bytes_.push(character.data);
  if (const auto error = error_of(character)) return end(tl::unexpected(*error), true);
  if (bytes_.size < 3) return std::nullopt;
  const auto format = telegram_format(bytes_.data[2]);
  if (!format) return end(tl::unexpected(SerialError::Type), true);
  if (bytes_.size < telegram_length(*format)) return std::nullopt;
  auto telegram = decode_serial(bytes_.span());
  const bool bad = !telegram;
  return end(std::move(telegram), bad);
}

}  // namespace ipos::runtime
