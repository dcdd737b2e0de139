// What the telegrams of the lines of a plant carried last, as signals LINE.IDENTIFIER.WORD: of CAN with the identifier in
// hexadecimal ("sbus.013.PO2", "sbus.214.value", "can.185.PI1"), of RS-485 and PROFIBUS with the address of the unit
// ("line1.1.PO2", "dp.8.answer_value"). A line begins to keep its frames when the first of its signals is read; before
// that they are 0, and nobody looks at its frames for them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/signals/find.hpp"
#include "runtime/station/plant_parts.hpp"

namespace ipos::signals {

// Of the identifiers and addresses that units, nodes and variable telegrams of the plant have by now. The plant must outlive them.
std::vector<Signal> telegram_signals(const runtime::PlantParts& plant);

// By name: also of identifiers and addresses that nobody in the plant has yet, with everything that such telegrams may
// carry.
std::optional<Signal> find_telegram_signal(const runtime::PlantParts& plant, std::string_view name);

// One telegram of a line, as somebody has kept it: of PROFIBUS the octets of its frame, of RS-485 the bytes of the telegram.
struct HeardTelegram {
  uint32_t id = 0;  // CAN
  bool extended = false;
  std::span<const uint8_t> bytes;
};
// A value that it carries, with the signal that has it from telegram to telegram.
struct TelegramValue {
  Signal signal;
  int64_t value = 0;
};
// What it says, also where nobody in the plant has its identifier: then its bytes. Nothing of one without content.
std::vector<TelegramValue> values_of_telegram(const runtime::PlantParts& plant, const runtime::Bus& bus,
                                              const HeardTelegram& telegram);

// With a pattern that has a part for the identifier: "sbus.*.PO1", "sbus.013.*".
std::vector<Signal> match_telegram_signals(const runtime::PlantParts& plant, std::string_view pattern);

}  // namespace ipos::signals
