// The identifiers one unit uses for MOVILINK on SBus, as slave and as master of others (1053 1610 p. 38,
// 51-53; IPOSplus p. 233; MOVITRAC 07 chapter 4.1 has no synchronous telegrams).
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/bus/movilink/identifiers.hpp"

namespace ipos::runtime {

struct SlaveSettings {
  uint8_t address = 0;          // P813 or P881
  uint8_t group = 0;            // P814 or P882
  uint16_t sync_id = 0;         // P817 or P885
  bool second_channel = false;  // P889, MOVIDRIVE B
  bool synchronous = true;      // sync telegram and PO-sync; not on MOVITRAC 07
  bool group_output = true;     // takes group PO; not while it sends them itself (p. 50)
};

constexpr bool has_telegram(const SlaveSettings& settings, Telegram telegram) {
  switch (telegram_type(telegram).known) {
    case TelegramKnown::Synchronous: return settings.synchronous;
    case TelegramKnown::Channel2: return settings.second_channel;
    default: return true;
  }
}

struct IdentifierUse {
  uint32_t id;
  Telegram telegram;
  uint8_t address;  // group address of group telegrams
  bool transmits;

  friend bool operator==(const IdentifierUse&, const IdentifierUse&) = default;
};

// Of the unit's own address and group, in rising order of the identifiers. The sync telegram is not among
// them.
std::vector<IdentifierUse> slave_identifiers(const SlaveSettings& settings);

// Of a unit that calls others with MOVLNK: `address` is 0..63, or a group address + 100. `settings` are those
// of the master and decide which telegrams it knows; the second channel is not used by MOVLNK (ours).
std::vector<IdentifierUse> master_identifiers(int32_t address, const SlaveSettings& settings);

}  // namespace ipos::runtime
