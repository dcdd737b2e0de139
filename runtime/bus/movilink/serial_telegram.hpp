// Telegrams of MOVILINK on RS-485: SD, ADR, TYP, PDU, BCC (1053 1610 p. 18-25). TYP is the Format of MOVLNK.
// In the PDU the parameter channel comes first, then the process data words, each high byte first.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <tl/expected.hpp>

#include "runtime/bus/movilink/format.hpp"
#include "runtime/bus/movilink/parameter_telegram.hpp"
#include "runtime/bus/movilink/process_data.hpp"

namespace ipos::runtime {

inline constexpr uint8_t kRequestStart = 0x02;   // SD1, master to inverter
inline constexpr uint8_t kResponseStart = 0x1D;  // SD2, inverter to master

enum class SerialError : uint8_t {
#define SERIAL_ERROR(name, text) name,
#include "runtime/bus/movilink/serial_errors.def"
};
inline constexpr size_t kSerialErrors = static_cast<size_t>(SerialError::Timeout) + 1;
std::string_view serial_error_text(SerialError error);

// Meaning of ADR (1053 1610 p. 20-22).
enum class AddressKind : uint8_t { Single, NoGroup, Group, Local, Universal, Broadcast, None };

inline constexpr uint8_t kNoGroupAddress = 100;  // factory setting of P811: in no group
inline constexpr uint8_t kLocalAddress = 253;    // the own unit, by MOVLNK only
inline constexpr uint8_t kUniversalAddress = 254;
inline constexpr uint8_t kBroadcastAddress = 255;

constexpr AddressKind address_kind(uint8_t address) {
  if (address < kNoGroupAddress) return AddressKind::Single;
  if (address == kNoGroupAddress) return AddressKind::NoGroup;
  if (address < 200) return AddressKind::Group;
  if (address == kLocalAddress) return AddressKind::Local;
  if (address == kUniversalAddress) return AddressKind::Universal;
  return address == kBroadcastAddress ? AddressKind::Broadcast : AddressKind::None;
}

// Whether a request to this address is answered by somebody.
constexpr bool is_answered(uint8_t address) {
  const AddressKind kind = address_kind(address);
  return kind == AddressKind::Single || kind == AddressKind::Universal;
}

struct SerialTelegram {
  bool response = false;
  uint8_t address = 0;  // of the slave, in both directions
  TelegramFormat format;
  ParameterTelegram parameter;  // where the format has one
  ProcessWords words{};         // as many as the format has

  friend bool operator==(const SerialTelegram&, const SerialTelegram&) = default;
};

// Bytes of a telegram, or of what came of one.
struct SerialBytes {
  static constexpr size_t kLongest = 18;
  std::array<uint8_t, kLongest> data{};
  uint8_t size = 0;

  void push(uint8_t byte) { data[size++] = byte; }
  std::span<const uint8_t> span() const { return {data.data(), size}; }
};

constexpr uint8_t pdu_length(TelegramFormat format) {
  return static_cast<uint8_t>((format.parameter ? 8 : 0) + 2 * format.words);
}
constexpr uint8_t telegram_length(TelegramFormat format) {
  return static_cast<uint8_t>(pdu_length(format) + 4);
}

// Exclusive-or of all bytes.
uint8_t block_check(std::span<const uint8_t> bytes);

SerialBytes encode(const SerialTelegram& telegram);

// A complete telegram and nothing else; the errors are Start, Type, Gap (wrong length) and BlockCheck.
tl::expected<SerialTelegram, SerialError> decode_serial(std::span<const uint8_t> bytes);

// "PARAM + 3PD cyclic"
std::string format_text(TelegramFormat format);

// "request to 1, 3PD cyclic, PO 0006 3A98 01F4"
std::string describe(const SerialTelegram& telegram);

}  // namespace ipos::runtime
