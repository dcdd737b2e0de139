// Codec of the RS-485 telegrams, and their text.
#include "runtime/bus/movilink/serial_telegram.hpp"

#include <fmt/format.h>

namespace ipos::runtime {

std::string_view serial_error_text(SerialError error) {
  static constexpr std::string_view kTexts[] = {
#define SERIAL_ERROR(name, text) text,
#include "runtime/bus/movilink/serial_errors.def"
  };
  return kTexts[static_cast<size_t>(error)];
}

uint8_t block_check(std::span<const uint8_t> bytes) {
  uint8_t check = 0;
  for (const uint8_t byte : bytes) check ^= byte;
  return check;
}

SerialBytes encode(const SerialTelegram& telegram) {
  SerialBytes bytes;
  bytes.push(telegram.response ? kResponseStart : kRequestStart);
  bytes.push(telegram.address);
  bytes.push(format_code(telegram.format));
  if (telegram.format.parameter)
    for (const uint8_t byte : encode(telegram.parameter)) bytes.push(byte);
  for (size_t n = 0; n < telegram.format.words; ++n) {
    bytes.push(static_cast<uint8_t>(telegram.words[n] >> 8));
    bytes.push(static_cast<uint8_t>(telegram.words[n] & 0xFF));
  }
  bytes.push(block_check(bytes.span()));
  return bytes;
}

tl::expected<SerialTelegram, SerialError> decode_serial(std::span<const uint8_t> bytes) {
  if (bytes.size() < 3) return tl::unexpected(SerialError::Gap);
  if (bytes[0] != kRequestStart && bytes[0] != kResponseStart) return tl::unexpected(SerialError::Start);
  const auto format = telegram_format(bytes[2]);
  if (!format) return tl::unexpected(SerialError::Type);
  if (bytes.size() != telegram_length(*format)) return tl::unexpected(SerialError::Gap);
  if (block_check(bytes) != 0) return tl::unexpected(SerialError::BlockCheck);
  SerialTelegram telegram{bytes[0] == kResponseStart, bytes[1], *format, {}, {}};
  size_t at = 3;
  if (format->parameter) {
    ParameterBytes channel{};
    for (uint8_t& byte : channel) byte = bytes[at++];
    telegram.parameter = decode_parameter(channel);
  }
  for (size_t n = 0; n < format->words; ++n, at += 2)
    telegram.words[n] = static_cast<uint16_t>(bytes[at] << 8 | bytes[at + 1]);
  return telegram;
}

std::string format_text(TelegramFormat format) {
  std::string text = format.parameter ? "PARAM" : "";
  if (format.words > 0) text += fmt::format("{}{}PD", format.parameter ? " + " : "", format.words);
  return text + (format.acyclic ? " acyclic" : " cyclic");
}

std::string describe(const SerialTelegram& telegram) {
  const TelegramFormat format = telegram.format;
  std::string text =
      fmt::format("{} {}, ", telegram.response ? "response of" : "request to", telegram.address);
  text += format_text(format);
  if (format.parameter) {
    const ParameterTelegram& channel = telegram.parameter;
    const auto service = service_from_code(channel.service_code());
    text += fmt::format(", {} {}{}: ", service ? service_text(*service) : "unknown service", channel.index,
                        channel.synchronous() ? " (handshake 1)" : "");
    text += telegram.response && channel.failed()
                ? describe(channel.return_code())
                : fmt::format("{:08X} ({})", channel.data, static_cast<int32_t>(channel.data));
  }
  if (format.words > 0) text += telegram.response ? ", PI" : ", PO";
  for (size_t n = 0; n < format.words; ++n) text += fmt::format(" {:04X}", telegram.words[n]);
  return text;
}

}  // namespace ipos::runtime
