// One telegram in words.
#include "runtime/bus/movilink/describe.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/bus/movilink/telegram_words.hpp"

namespace ipos::runtime {
namespace {

std::string bytes_text(const Frame& frame) {
  if (frame.remote) return "remote frame";
  std::string text;
  for (size_t i = 0; i < frame.length; ++i) text += fmt::format("{}{:02X}", i == 0 ? "" : " ", frame.data[i]);
  return text.empty() ? "no data" : text;
}

// Who is meant: "unit1", or "address 5" where nobody is known.
std::string partner(const TelegramNames& names, const SbusIdentifier& identifier) {
  if (telegram_type(identifier.telegram).grouped) return fmt::format("group {}", identifier.address);
  const UnitNames* unit = names.unit_at(identifier.address);
  return unit == nullptr ? fmt::format("address {}", identifier.address) : unit->name;
}

const char* arrow(const SbusIdentifier& identifier) {
  return telegram_type(identifier.telegram).from_master ? "->" : "<-";
}

// The unit whose lists explain a telegram: the one addressed, of a group any member.
const UnitNames* explaining_unit(const TelegramNames& names, const SbusIdentifier& identifier) {
  if (!telegram_type(identifier.telegram).grouped) return names.unit_at(identifier.address);
  const auto member = std::find_if(names.units.begin(), names.units.end(), [&](const UnitNames& unit) {
    return unit.settings.group == identifier.address;
  });
  return member == names.units.end() ? nullptr : &*member;
}

std::string parameter_text(const TelegramNames& names, const SbusIdentifier& identifier, const Frame& frame) {
  if (frame.length != 8) return fmt::format("{} bytes in place of 8: {}", frame.length, bytes_text(frame));
  const ParameterTelegram telegram = decode_parameter(frame.data);
  const bool request = telegram_type(identifier.telegram).from_master;
  std::string text = parameter_words(explaining_unit(names, identifier), telegram, request);
  if (telegram.synchronous()) text += request ? ", answer after sync" : ", after sync";
  return text;
}

std::string process_text(const TelegramNames& names, const SbusIdentifier& identifier, const Frame& frame) {
  const auto words = process_words(frame);
  if (!words) return fmt::format("{} bytes in place of 6: {}", frame.length, bytes_text(frame));
  const bool input = !telegram_type(identifier.telegram).from_master;
  const char* what = input ? "PI" : identifier.telegram == Telegram::ProcessOutputSync ? "PO-sync" : "PO";
  return process_words_text(explaining_unit(names, identifier), what, input, *words);
}

Description object_text(const ObjectNames& object, const Frame& frame) {
  const auto pair = frame_variables(frame, object.format);
  if (!pair)
    return {true, fmt::format("{} object of {} with {} bytes in place of {}: {}", id_text(frame.id),
                              object.station, frame.length, object.format.length, bytes_text(frame))};
  std::string text = id_text(frame.id);
  const std::array<int32_t, 2> values = {pair->low, pair->high};
  for (size_t n = 0; n < object.format.variables(); ++n)
    text += fmt::format("{} {} = {} ({:08X}h)", n == 0 ? "" : ",", object.variables[n], values[n],
                        static_cast<uint32_t>(values[n]));
  if (object.format.length == 0) text += " object without data";
  return {true, fmt::format("{} {} {}", text, object.sent ? "<-" : "->", object.station)};
}

bool is_sync(const TelegramNames& names, const Frame& frame) {
  return std::any_of(names.units.begin(), names.units.end(), [&](const UnitNames& unit) {
    return unit.settings.synchronous && unit.settings.sync_id == frame.id;
  });
}

}  // namespace

std::string UnitNames::variable(uint32_t number) const {
  for (const VariableName& row : variables)
    if (row.number == number) return row.name;
  return fmt::format("H{}", number);
}

const UnitNames* TelegramNames::unit_at(uint8_t address) const {
  const auto found = std::find_if(units.begin(), units.end(),
                                  [&](const UnitNames& unit) { return unit.settings.address == address; });
  return found == units.end() ? nullptr : &*found;
}

const ObjectNames* TelegramNames::object(uint32_t id) const {
  const ObjectNames* best = nullptr;
  for (const ObjectNames& row : objects)
    if (row.id == id && (best == nullptr || (row.sent && !best->sent))) best = &row;
  return best;
}

bool concerns(const TelegramNames& names, const Frame& frame) {
  if (!is_plain(frame)) return false;
  if (names.object(frame.id) != nullptr) return true;
  const auto identifier = classify_identifier(frame.id);
  return identifier && explaining_unit(names, *identifier) != nullptr;
}

Description describe(const TelegramNames& names, const Frame& frame) {
  if (!is_plain(frame))
    return {false, fmt::format("{} {}", id_text(frame.id, frame.extended), bytes_text(frame))};
  if (const ObjectNames* object = names.object(frame.id)) return object_text(*object, frame);
  const auto identifier = classify_identifier(frame.id);
  // An identifier of the profile may be the sync telegram's, too, where nobody has the address (300 is
  // that of PI of 37).
  if (is_sync(names, frame) && (!identifier || explaining_unit(names, *identifier) == nullptr))
    return {true, id_text(frame.id) + " sync telegram"};
  if (!identifier) return {false, fmt::format("{} {}", id_text(frame.id), bytes_text(frame))};
  const std::string what = telegram_type(identifier->telegram).parameter
                               ? parameter_text(names, *identifier, frame)
                               : process_text(names, *identifier, frame);
  return {true, fmt::format("{} {} {} {}", id_text(frame.id), what, arrow(*identifier),
                            partner(names, *identifier))};
}

}  // namespace ipos::runtime
