// SBus identifiers of the MOVILINK profile: bits 0-2 function, 3-8 address, 9 parameter data, 10 always 0
// (1053 1610 p. 37). The sync telegram lies outside this scheme: any identifier, factory setting 0 (p. 38).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace ipos::runtime {

inline constexpr uint8_t kSbusAddresses = 64;  // P813 and P814: 0..63 (1053 1610 p. 41)

enum class Telegram : uint8_t {
#define TELEGRAM(name, function, parameter, grouped, from_master, known, text) name,
#include "stdlib/sbus_telegrams.def"
};

enum class TelegramKnown : uint8_t { Always, Synchronous, Channel2 };

struct TelegramType {
  Telegram telegram;
  uint8_t function;
  bool parameter;
  bool grouped;
  bool from_master;
  TelegramKnown known;
  std::string_view text;
};

inline constexpr TelegramType kTelegrams[] = {
#define TELEGRAM(name, function, parameter, grouped, from_master, known, text) \
  {Telegram::name, function, parameter, grouped, from_master, TelegramKnown::known, text},
#include "stdlib/sbus_telegrams.def"
};

constexpr const TelegramType& telegram_type(Telegram telegram) {
  return kTelegrams[static_cast<size_t>(telegram)];
}

// `address` is P813 of the unit the request is meant for, also in its answers; of group telegrams P814.
// 0..63.
constexpr uint32_t sbus_identifier(Telegram telegram, uint8_t address) {
  const TelegramType& type = telegram_type(telegram);
  return (type.parameter ? 512U : 0U) + 8U * (address % kSbusAddresses) + type.function;
}

struct SbusIdentifier {
  Telegram telegram;
  uint8_t address;

  friend bool operator==(const SbusIdentifier&, const SbusIdentifier&) = default;
};

// What an 11-bit identifier means to the profile; nothing for an identifier it does not use.
constexpr std::optional<SbusIdentifier> classify_identifier(uint32_t id) {
  if (id >= 1024) return std::nullopt;
  for (const TelegramType& type : kTelegrams)
    if (type.function == id % 8 && type.parameter == (id >= 512))
      return SbusIdentifier{type.telegram, static_cast<uint8_t>(id / 8 % kSbusAddresses)};
  return std::nullopt;
}

}  // namespace ipos::runtime
