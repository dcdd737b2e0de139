// What each kind of bus gives to the signals of telegrams (telegrams.hpp): the signals of what is there, and those
// of an identifier or address that is named. One source NAME_telegrams.cpp a kind.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/signals/find.hpp"
#include "runtime/signals/telegrams.hpp"
#include "runtime/station/can_bus.hpp"
#include "runtime/station/plant_parts.hpp"
#include "runtime/station/profibus_bus.hpp"
#include "runtime/station/serial_bus.hpp"

namespace ipos::signals {

class TelegramLine {
 public:
  TelegramLine() = default;
  TelegramLine(const TelegramLine&) = delete;
  TelegramLine& operator=(const TelegramLine&) = delete;
  virtual ~TelegramLine() = default;

  virtual const runtime::Bus& bus() const = 0;
  // Of the identifiers and addresses of the plant by now; each name once.
  virtual std::vector<Signal> listed() const = 0;
  // An identifier or address as names write it: "013" of "13"; nothing where the text is none.
  virtual std::optional<std::string> identity(std::string_view text) const = 0;
  // Everything that telegrams with it may carry.
  virtual std::vector<Signal> all_of(std::string_view identity) const = 0;
  // What one telegram of it says.
  virtual std::vector<TelegramValue> values_of(const HeardTelegram&) const { return {}; }
};

// One for each class of bus. Both must outlive it.
#define BUS_CLASS(Class) \
  std::unique_ptr<TelegramLine> telegrams_of(const runtime::PlantParts& plant, runtime::Class& bus);
#include "runtime/plant_file/bus_kinds.def"

// --- fields, from telegram_fields.def

enum class TelegramMessage : uint8_t {
  Parameter,
  Nmt,
  Emergency,
  Sdo,
  ErrorControl,
  SlaveDiag,
  GlobalControl,
  Bytes
};

struct TelegramField {
  TelegramMessage message;
  std::string_view name;
  uint8_t byte, bytes;
  bool intel, is_signed;
  uint32_t mask;
  uint8_t bits;
  std::string_view meaning;
};

std::span<const TelegramField> telegram_fields();
// Bytes after the end count as 0.
int64_t number_in(std::span<const uint8_t> data, const TelegramField& field);

// "sbus.013.PO2"; the caller sets `read`.
Signal telegram_signal(const runtime::Bus& bus, std::string_view identity, std::string_view word,
                            std::string meaning, size_t bits);

inline constexpr size_t kTelegramWordBits = 16;

}  // namespace ipos::signals
