// One telegram of RS-485 in words.
#include "runtime/bus/movilink/describe_serial.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/movilink/telegram_words.hpp"

namespace ipos::runtime {
namespace {

std::string partner(const TelegramNames& names, uint8_t address) {
  switch (address_kind(address)) {
    case AddressKind::Group: return fmt::format("group {}", address);
    case AddressKind::Broadcast: return "all units";
    case AddressKind::Universal: return "any one unit (254)";
    default: break;
  }
  const UnitNames* unit = names.unit_at(address);
  return unit == nullptr ? fmt::format("address {}", address) : unit->name;
}

// The unit addressed, of a group any member.
const UnitNames* explaining_unit(const TelegramNames& names, uint8_t address) {
  if (address_kind(address) != AddressKind::Group) return names.unit_at(address);
  const auto member = std::find_if(names.units.begin(), names.units.end(), [address](const UnitNames& unit) {
    return unit.settings.group == address;
  });
  return member == names.units.end() ? nullptr : &*member;
}

}  // namespace

std::string describe(const TelegramNames& names, const SerialTelegram& telegram) {
  const TelegramFormat format = telegram.format;
  const UnitNames* unit = explaining_unit(names, telegram.address);
  std::string text = format_text(format);
  if (format.parameter) {
    text += ", " + parameter_words(unit, telegram.parameter, !telegram.response);
    if (telegram.parameter.synchronous()) text += ", handshake 1";
  }
  if (format.words > 0)
    text += ", " + process_words_text(unit, telegram.response ? "PI" : "PO", telegram.response,
                                      std::span(telegram.words).first(format.words));
  return fmt::format("{} {} {}", text, telegram.response ? "<-" : "->", partner(names, telegram.address));
}

std::string describe(const TelegramNames& names, const Reception& reception) {
  if (reception.telegram) return describe(names, *reception.telegram);
  return fmt::format("void, {}: {:02X}", serial_error_text(reception.telegram.error()),
                     fmt::join(reception.bytes.span(), " "));
}

}  // namespace ipos::runtime
