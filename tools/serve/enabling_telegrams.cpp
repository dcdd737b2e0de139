// Words out of bytes as the units read them, and two questions.
#include "tools/serve/enabling_telegrams.hpp"

#include <fmt/format.h>

#include <vector>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/movilink/identifiers.hpp"
#include "runtime/bus/movilink/serial_telegram.hpp"
#include "tools/serve/bus_ear.hpp"
#include "tools/unit/own_monitoring.hpp"

namespace ipos::tools::serve {
namespace {

using stdlib::Service;

std::vector<uint16_t> words_of(const std::vector<uint8_t>& bytes, bool low_byte_first) {
  std::vector<uint16_t> words;
  for (size_t n = 0; n + 1 < bytes.size(); n += 2)
    words.push_back(
        static_cast<uint16_t>(low_byte_first ? bytes[n] | bytes[n + 1] << 8 : bytes[n] << 8 | bytes[n + 1]));
  return words;
}

}  // namespace

std::optional<EnablingTelegram> enabling_on_can(const Arguments& arguments, bool canopen) {
  const auto id = static_cast<uint32_t>(arguments.whole("identifier", 0, runtime::kExtendedIdLimit - 1));
  if (arguments.flag("extended", false) || arguments.flag("remote", false)) return std::nullopt;
  const std::vector<uint8_t> bytes = bytes_of(arguments.text("data", ""), 8);
  // 200h, 300h, 400h and 500h with the node (CiA 301, 7.3.3).
  constexpr uint32_t kFirstRpdo = 0x200, kBeyondRpdo = 0x580, kNodes = 0x80;
  if (canopen && id >= kFirstRpdo && id < kBeyondRpdo && (id / kNodes) % 2 == 0 &&
      could_enable(words_of(bytes, true)))
    return EnablingTelegram{static_cast<uint8_t>(id % kNodes)};
  const auto identifier = runtime::classify_identifier(id);
  if (!identifier) return std::nullopt;
  const runtime::TelegramType& type = runtime::telegram_type(identifier->telegram);
  if (type.parameter || !type.from_master || !could_enable(words_of(bytes, false))) return std::nullopt;
  if (type.grouped || canopen) return EnablingTelegram{};
  return EnablingTelegram{identifier->address};
}

std::optional<EnablingTelegram> enabling_on_serial(const Arguments& arguments) {
  const auto telegram =
      runtime::decode_serial(bytes_of(arguments.text("data", ""), runtime::SerialBytes::kLongest));
  if (!telegram || telegram->response) return std::nullopt;
  if (!could_enable(std::span(telegram->words).first(telegram->format.words))) return std::nullopt;
  EnablingTelegram enabling{std::nullopt, !telegram->format.acyclic};
  if (runtime::address_kind(telegram->address) == runtime::AddressKind::Single)
    enabling.address = telegram->address;
  return enabling;
}

void refuse_unmonitored(BusLink& link, const EnablingTelegram& telegram) {
  if (!telegram.monitored)
    throw Mistake(
        "this telegram could enable a drive, and no drive monitors acyclic telegrams, so nothing but a "
        "person would end "
        "the movement: send it cyclic (TYP 00h to 05h), to a unit that monitors them (P812)");
  if (!telegram.address)
    throw Mistake(
        "this telegram could enable several drives, and they cannot be asked whether they monitor their "
        "process data: "
        "send it to single units");
  const MonitoringIndices own = monitoring_indices(link.serial_line() != nullptr);
  const AccessReply timeout = link.execute(*telegram.address, Service::Read, own.timeout, 0);
  if (!timeout)
    throw Mistake(fmt::format(
        "this telegram could enable unit {}, which does not tell whether it monitors its process data ({})",
        *telegram.address, own.names));
  const AccessReply response = link.execute(*telegram.address, Service::Read, own.response, 0);
  const bool goes_on = response && lets_go_on(*response);
  if (!is_off(*timeout) && !goes_on) return;
  throw Mistake(fmt::format(
      "this telegram could enable unit {}, and the unit does not monitor its process data ({}), so nothing "
      "but a person "
      "would end the movement. Switch the monitoring on first: {}",
      *telegram.address, is_off(*timeout) ? own.names + " is off" : own.response_name + " lets it go on",
      is_off(*timeout) ? own.names + " = 0.5 s, as a parameter on the page or by 'ipos param set'"
                       : own.response_name + " = RAPID STOP/FAULT"));
}

void refuse_outside(const EnablingTelegram& telegram, const std::function<bool(uint8_t)>& simulated) {
  if (telegram.address && simulated(*telegram.address)) return;
  throw Mistake(
      "this telegram could enable a drive outside of the plant, and the plant cannot ask it whether it "
      "monitors its process "
      "data (P812, P815, P883): 'ipos serve --device' can, and so can the Drive of ipos.movilink");
}

}  // namespace ipos::tools::serve
