// Which octets are what.
#include "runtime/bus/words/dp_words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/movilink/parameter_telegram.hpp"
#include "runtime/bus/movilink/telegram_words.hpp"
#include "runtime/bus/profibus/dp_service.hpp"
#include "runtime/bus/profibus/fieldbus_parameters.hpp"
#include "runtime/bus/profibus/frame_text.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kChannelOctets = 8;
constexpr size_t kDriveWords = 3;  // of each drive behind a gateway

// The address in the frame that is the slave's.
uint8_t slave_of(const profibus::FdlFrame& frame) { return frame.is_request() ? frame.destination : frame.source; }

// Digits of BCD as the number that the list means (MOVITRAC 31 PROFIBUS, 4.2.1).
ParameterTelegram without_bcd(const UnitNames& unit, ParameterTelegram telegram) {
  if (telegram.failed() || telegram.index < unit.first_index || unit.unit == nullptr) return telegram;
  const auto own = static_cast<uint16_t>(telegram.index - unit.first_index);
  const stdlib::Parameter* parameter = stdlib::parameter_table(*unit.unit).find(own);
  if (parameter != nullptr && parameter->bcd)
    if (const auto value = profibus::from_bcd(telegram.data)) telegram.data = static_cast<uint32_t>(*value);
  return telegram;
}

// Of a gateway, byte 1 of the channel picks the drive.
std::string channel_text(const DpSlaveNames& slave, std::span<const uint8_t> octets, bool request) {
  ParameterBytes bytes{};
  std::copy_n(octets.begin(), bytes.size(), bytes.begin());
  ParameterTelegram telegram = decode_parameter(bytes);
  if (telegram.service_code() == 0 && !telegram.failed()) return std::string(service_text(Service::None));
  const UnitNames* unit = slave.drives.empty() ? nullptr : &slave.drives.front();
  std::string of;
  if (slave.gateway) {
    const auto picked = std::find_if(slave.drives.begin(), slave.drives.end(), [&](const UnitNames& drive) {
      return drive.settings.address == telegram.subindex;
    });
    unit = picked == slave.drives.end() ? nullptr : &*picked;
    of = unit != nullptr ? fmt::format(" of {}", unit->name) : fmt::format(" of address {}", telegram.subindex);
    telegram.subindex = 0;
  }
  if (unit != nullptr && slave.own_numbers) telegram = without_bcd(*unit, telegram);
  return parameter_words(unit, telegram, request) + of;
}

std::vector<uint16_t> words_of(std::span<const uint8_t> octets) {
  std::vector<uint16_t> words;
  for (size_t n = 0; n + 1 < octets.size(); n += 2) words.push_back(static_cast<uint16_t>(octets[n] << 8 | octets[n + 1]));
  return words;
}

}  // namespace

const DpSlaveNames* DpLineWords::slave(uint8_t address) const {
  const auto found = std::find_if(slaves_.begin(), slaves_.end(),
                                  [address](const DpSlaveNames& one) { return one.address == address; });
  return found == slaves_.end() ? nullptr : &*found;
}

// A configuration that the card refuses is not taken.
void DpLineWords::listen(const profibus::FdlFrame& frame) {
  if (!frame.is_request() || !frame.dsap || profibus::dp_service(*frame.dsap) != profibus::DpService::ChkCfg) return;
  const DpSlaveNames* known = slave(frame.destination);
  if (known == nullptr) return;
  if (const auto* configuration = profibus::find_configuration(frame.data, known->accepts))
    heard_[frame.destination] = configuration;
}

const profibus::Configuration* DpLineWords::configuration_of(const DpSlaveNames& slave) const {
  const auto heard = heard_.find(slave.address);
  return heard == heard_.end() ? slave.configuration : heard->second;
}

bool DpLineWords::is_known_exchange(const profibus::FdlFrame& frame) const {
  return is_data_exchange(frame) && slave(slave_of(frame)) != nullptr;
}

std::string DpLineWords::data_text(const profibus::FdlFrame& frame) const {
  const DpSlaveNames* of = is_data_exchange(frame) ? slave(slave_of(frame)) : nullptr;
  const profibus::Configuration* configuration = of == nullptr ? nullptr : configuration_of(*of);
  if (configuration == nullptr || configuration->octets != frame.data.size()) return {};
  const bool request = frame.is_request();
  const std::string what = request ? "PO" : "PI";
  std::span<const uint8_t> octets = frame.data;
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (configuration->parameter_channel) {
    add(channel_text(*of, octets.first(kChannelOctets), request));
    octets = octets.subspan(kChannelOctets);
  }
  const std::vector<uint16_t> words = words_of(octets);
  if (!of->gateway) {
    add(process_words_text(of->drives.empty() ? nullptr : &of->drives.front(), what, !request, words));
  } else {
    for (size_t n = 0; n * kDriveWords < words.size(); ++n) {
      const UnitNames* drive = n < of->drives.size() ? &of->drives[n] : nullptr;
      const bool has_words = drive != nullptr && drive->unit != nullptr;
      add(process_words_text(has_words ? drive : nullptr, fmt::format("{} {}", drive != nullptr ? drive->name : "drive", what),
                             !request, std::span(words).subspan(n * kDriveWords).first(kDriveWords)));
    }
  }
  return fmt::format("{} {} {}", text, request ? "->" : "<-", of->name);
}

std::string DpLineWords::describe(const profibus::Reception& reception) {
  if (!reception.frame)
    return fmt::format("void, {}: {}", profibus::frame_error_text(reception.frame.error()),
                       profibus::hex_text(reception.octets));
  listen(*reception.frame);
  return profibus::describe(*reception.frame, data_text(*reception.frame));
}

}  // namespace ipos::runtime
