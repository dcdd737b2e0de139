// The checks of a running SBus.
#include "runtime/bus/movilink/sbus_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/can/line.hpp"
#include "runtime/bus/movilink/sbus_control.hpp"
#include "runtime/bus/movilink/sbus_master.hpp"

namespace ipos::runtime {
namespace {

// The identifier that answers a request, or nothing for one that is not answered at once.
constexpr std::optional<uint32_t> answer_of(const SbusIdentifier& request) {
  switch (request.telegram) {
    case Telegram::ProcessOutput: return sbus_identifier(Telegram::ProcessInput, request.address);
    case Telegram::ParameterRequest: return sbus_identifier(Telegram::ParameterResponse, request.address);
    case Telegram::ParameterRequest2: return sbus_identifier(Telegram::ParameterResponse2, request.address);
    default: return std::nullopt;
  }
}

// What an identifier means, and what answers it: of each looked up once, as a check looks at every frame of a line.
struct Meaning {
  std::optional<SbusIdentifier> telegram;
  std::optional<uint32_t> answer;
};
constexpr auto kMeanings = [] {
  std::array<Meaning, 1024> meanings{};
  for (uint32_t id = 0; id < meanings.size(); ++id) {
    meanings[id].telegram = classify_identifier(id);
    if (meanings[id].telegram) meanings[id].answer = answer_of(*meanings[id].telegram);
  }
  return meanings;
}();

}  // namespace

SbusCheck::SbusCheck(SbusCheckClient& client, bool units_outside)
    : client_(client), units_outside_(units_outside), identifiers_(unheard()) {}

// Nobody has sent anything. Made once, as campaigns make many lines.
const std::vector<SbusCheck::Identifier>& SbusCheck::unheard() {
  static const std::vector<Identifier> identifiers = [] {
    std::vector<Identifier> made(kStandardIdLimit, Identifier{kNoNode, false});
    for (const TelegramType& type : kTelegrams)
      for (uint8_t address = 0; address < kSbusAddresses; ++address)
        made[sbus_identifier(type.telegram, address)].watched = true;
    return made;
  }();
  return identifiers;
}

void SbusCheck::tell(Time now, std::string text) { client_.on_sbus_finding(now, std::move(text)); }

void SbusCheck::add_slave(Time now, const CanLine& line, NodeId node, const SlaveSettings& settings) {
  for (const Slave& slave : slaves_)
    if (slave.settings.address == settings.address)
      tell(now, fmt::format(
                    "{}: {} and {} both have SBus address {}: both answer to it, and their answers collide",
                    line.name(), line.node_name(slave.node), line.node_name(node), settings.address));
  slaves_.push_back({node, settings});
  if (settings.synchronous &&
      std::find(sync_ids_.begin(), sync_ids_.end(), settings.sync_id) == sync_ids_.end())
    sync_ids_.push_back(settings.sync_id);
  if (settings.synchronous && settings.sync_id < identifiers_.size())
    identifiers_[settings.sync_id].watched = true;
}

void SbusCheck::on_frame(const CanLine& line, const FrameRecord& record) {
  if (!is_plain(record.frame)) return;
  const Identifier& known = identifiers_[record.frame.id];
  if (known.sender != record.sender || known.watched) check_telegram(line, record);
}

void SbusCheck::check_telegram(const CanLine& line, const FrameRecord& record) {
  Identifier& known = identifiers_[record.frame.id];
  if (known.sender == kNoNode) known.sender = record.sender;
  if (known.sender != record.sender) tell_second_sender(line, record, known.sender);
  if (!known.watched) return;
  if (const Meaning* const meaning = record.frame.id < kMeanings.size() ? &kMeanings[record.frame.id] : nullptr;
      meaning != nullptr && meaning->telegram) {
    if (!slaves_.empty() && !units_outside_) check_address(line, record, *meaning->telegram);
    check_masters(line, record, meaning->answer);
    if (meaning->telegram->telegram == Telegram::ProcessOutputSync) check_window(line, record, meaning->telegram->address);
  }
  for (const uint32_t id : sync_ids_)
    if (id == record.frame.id) syncs_[id] = record.start;
}

void SbusCheck::tell_second_sender(const CanLine& line, const FrameRecord& record, NodeId first) {
  if (!told_.emplace(record.frame.id, record.sender).second) return;
  tell(record.end, fmt::format("{}: identifier {} is sent by {} and by {}; an identifier may have one sender",
                               line.name(), id_words(record.frame.id), line.node_name(first),
                               line.node_name(record.sender)));
}

void SbusCheck::check_address(const CanLine& line, const FrameRecord& record,
                              const SbusIdentifier& identifier) {
  const TelegramType& type = telegram_type(identifier.telegram);
  if (!type.from_master) return;
  const auto meant = [&](const Slave& slave) {
    return (type.grouped ? slave.settings.group : slave.settings.address) == identifier.address;
  };
  if (std::any_of(slaves_.begin(), slaves_.end(), meant)) return;
  if (!told_.emplace(record.frame.id, kNoNode).second) return;
  std::string present;
  for (const Slave& slave : slaves_)
    present +=
        fmt::format("{}{} ({})", present.empty() ? "" : ", ",
                    type.grouped ? slave.settings.group : slave.settings.address, line.node_name(slave.node));
  tell(record.end,
       fmt::format("{}: {} calls {}address {}, which no station has; there are {}", line.name(),
                   line.node_name(record.sender), type.grouped ? "group " : "", identifier.address, present));
}

// MOVLNK needs the line for itself from its request to the answer (1053 1610 p. 47).
void SbusCheck::check_masters(const CanLine& line, const FrameRecord& record,
                              std::optional<uint32_t> answer) {
  std::erase_if(open_,
                [&](const Exchange& e) { return e.until < record.end || e.answer == record.frame.id; });
  if (!answer) return;
  for (const Exchange& exchange : open_) {
    if (exchange.master == record.sender) continue;
    const auto pair = std::minmax(exchange.master, record.sender);
    if (told_masters_.emplace(pair).second)
      tell(record.end,
           fmt::format("{}: {} and {} are masters at the same time; only one may be active in the network",
                       line.name(), line.node_name(exchange.master), line.node_name(record.sender)));
  }
  const Time until = record.end + kSbusReplyTimeout;
  const auto asks_again = [&](const Exchange& e) { return e.master == record.sender && e.answer == *answer; };
  if (const auto open = std::find_if(open_.begin(), open_.end(), asks_again); open != open_.end())
    open->until = until;
  else
    open_.push_back({record.sender, *answer, until});
}

void SbusCheck::check_window(const CanLine& line, const FrameRecord& record, uint8_t address) {
  for (const Slave& slave : slaves_) {
    if (slave.settings.address != address) continue;
    const auto sync = syncs_.find(slave.settings.sync_id);
    if (sync == syncs_.end()) continue;
    const Time at = record.start - sync->second;
    if (at >= kSyncWindowBegin && at <= kSyncWindowEnd) continue;
    if (told_.emplace(record.frame.id, kNoNode).second)
      tell(record.end,
           fmt::format("{}: synchronous PO telegram {} of {} starts {:.3f} ms after the sync telegram; it "
                       "belongs between 1.5 and 4.5 ms",
                       line.name(), id_words(record.frame.id), line.node_name(record.sender),
                       static_cast<double>(at) / 1e6));
  }
}

}  // namespace ipos::runtime
