// Words out of bytes as the units read them.
#include "tools/serve/host/enabling_telegrams.hpp"

#include <fmt/format.h>

#include <vector>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/movilink/identifiers.hpp"
#include "runtime/bus/movilink/serial_telegram.hpp"
#include "runtime/bus/profibus/fdl_frame.hpp"
#include "tools/parameters/own_monitoring.hpp"
#include "tools/serve/host/line_monitor.hpp"

namespace ipos::tools::serve {
namespace {

std::vector<uint16_t> words_of(const std::vector<uint8_t>& bytes, bool low_byte_first) {
  std::vector<uint16_t> words;
  for (size_t n = 0; n + 1 < bytes.size(); n += 2)
    words.push_back(
        static_cast<uint16_t>(low_byte_first ? bytes[n] | bytes[n + 1] << 8 : bytes[n] << 8 | bytes[n + 1]));
  return words;
}

constexpr const char* kAcyclic =
    "no drive monitors acyclic telegrams, so nothing but a person would end the movement: send it cyclic "
    "(TYP 00h to "
    "05h), to a unit that monitors them (P812)";
constexpr const char* kSeveral =
    "it goes to several drives, or to whoever hears it, and they cannot be asked whether they monitor their "
    "process "
    "data: send it to single units";
constexpr const char* kOtherProfile =
    "with --canopen only CANopen nodes can be asked whether they monitor their process data, without it only "
    "units of "
    "the SBus";

}  // namespace

std::optional<EnablingTelegram> enabling_on_can(const Arguments& arguments, bool canopen) {
  const auto id = static_cast<uint32_t>(arguments.whole("identifier", 0, runtime::kExtendedIdLimit - 1));
  if (arguments.flag("extended", false) || arguments.flag("remote", false)) return std::nullopt;
  const std::vector<uint8_t> bytes = bytes_of(arguments.text("data", ""), 8);
  const auto identifier = runtime::classify_identifier(id);
  // 200h, 300h, 400h and 500h with the node (CiA 301, 7.3.3). Telegrams of the SBus are what the line speaks.
  constexpr uint32_t kFirstRpdo = 0x200, kBeyondRpdo = 0x580, kNodes = 0x80;
  if ((canopen || !identifier) && id >= kFirstRpdo && id < kBeyondRpdo && (id / kNodes) % 2 == 0 &&
      could_enable(words_of(bytes, true)))
    return EnablingTelegram{static_cast<uint8_t>(id % kNodes), canopen ? nullptr : kOtherProfile};
  if (!identifier) return std::nullopt;
  const runtime::TelegramType& type = runtime::telegram_type(identifier->telegram);
  if (type.parameter || !type.from_master || !could_enable(words_of(bytes, false))) return std::nullopt;
  return EnablingTelegram{identifier->address, type.grouped ? kSeveral : canopen ? kOtherProfile : nullptr};
}

std::optional<EnablingTelegram> enabling_on_serial(const Arguments& arguments) {
  const auto telegram =
      runtime::decode_serial(bytes_of(arguments.text("data", ""), runtime::SerialBytes::kLongest));
  if (!telegram || telegram->response) return std::nullopt;
  if (!could_enable(std::span(telegram->words).first(telegram->format.words))) return std::nullopt;
  const bool single = runtime::address_kind(telegram->address) == runtime::AddressKind::Single;
  return EnablingTelegram{telegram->address, telegram->format.acyclic ? kAcyclic
                                             : single                 ? nullptr
                                                                      : kSeveral};
}

// Data without access points are the output data of a slave (EN 50170 volume 2).
std::optional<EnablingTelegram> enabling_on_profibus(const std::vector<uint8_t>& octets) {
  const auto frame = profibus::decode(octets);
  if (!frame || !frame->is_request() || frame->dsap || !could_enable(words_of(frame->data, false)))
    return std::nullopt;
  return EnablingTelegram{frame->destination,
                          frame->destination == profibus::kBroadcast ? kSeveral : nullptr};
}

void refuse_outside(const EnablingTelegram& telegram, const std::function<bool(uint8_t)>& simulated) {
  if (telegram.unasked == nullptr && simulated(telegram.address)) return;
  throw Mistake(
      "this telegram could enable a drive outside of the plant, and the plant cannot ask it whether it "
      "monitors its process "
      "data (P812, P815, P883): 'ipos serve --device' can, and so can the Drive of ipos.movilink");
}

}  // namespace ipos::tools::serve
