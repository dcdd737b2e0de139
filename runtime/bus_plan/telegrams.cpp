// Rhythms of the telegrams, and the analysis over all of them.
#include "runtime/bus_plan/telegrams.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/bus/movilink/master_slave.hpp"
#include "runtime/bus_plan/canopen_messages.hpp"

namespace ipos::runtime {
namespace {

constexpr Time kInputWait = kMillisecond;         // PI within one millisecond (1053 1610 p. 39)
constexpr Time kResponseWait = 2 * kMillisecond;  // of a parameter request, ours (SlaveTiming)
constexpr uint8_t kProcessBytes = 6;
constexpr uint8_t kParameterBytes = 8;

class Traffic {
 public:
  Traffic(const LineRoster& roster, const SeenTelegrams& seen, const PlanOptions& options)
      : roster_(roster), seen_(seen), options_(options) {
    for (const Member& member : roster.members) {
      if (const auto* settings = canopen_of(member)) add_master(member, *settings);
      if (const auto* settings = movilink_of(member)) add_control(member, *settings);
      if (member.canopen != nullptr && member.canopen->canopen() != nullptr) add_node(member);
      if (member.port != nullptr) {
        add_partners(member);
        add_group_master(member);
      }
      if (member.station != nullptr) add_objects(member);
    }
    std::stable_sort(telegrams_.begin(), telegrams_.end(),
                     [](const auto& a, const auto& b) { return a.id < b.id; });
  }
  std::vector<PlannedTelegram> take() { return std::move(telegrams_); }

 private:
  PlannedTelegram& add(uint32_t id, std::string sender, std::string what, uint8_t bytes, Rhythm rhythm,
                       Time period) {
    telegrams_.push_back({id, std::move(sender), std::move(what), bytes, rhythm, period, 0, ~0U, {}});
    return telegrams_.back();
  }

  // Shortest distance the trial showed, else the assumed one.
  Time acyclic_period(uint32_t id) const {
    const auto found = seen_.find(id);
    return found == seen_.end() || found->second.closest == kNever ? options_.acyclic : found->second.closest;
  }

  // The answer of a slave; nothing when nobody has the address.
  void add_answer(const PlannedTelegram& request, Telegram answer, uint8_t address, uint8_t bytes, Time wait,
                  Rhythm rhythm) {
    const Member* slave = roster_.slave_at(address);
    if (slave == nullptr) return;
    const uint32_t asked = request.id;
    PlannedTelegram& telegram = add(sbus_identifier(answer, address), slave->name,
                                    telegram_name(answer, address), bytes, rhythm, request.period);
    telegram.wait = wait;
    telegram.request = asked;
  }

  // SYNC, and to each node the PDOs that it takes, once a cycle; guarding and heartbeats.
  void add_master(const Member& member, const canopen::MasterSettings& settings) {
    if (settings.sync_cycle > 0)
      add(canopen::identifier(canopen::Connection::Sync), member.name, "SYNC", 0, Rhythm::Cyclic,
          settings.sync_cycle);
    if (settings.heartbeat > 0)
      add(canopen::identifier(canopen::Connection::ErrorControl, settings.node), member.name, "heartbeat", 1,
          Rhythm::Cyclic, settings.heartbeat * kMillisecond);
    for (const Member& other : roster_.members)
      if (other.canopen != nullptr && other.canopen->canopen() != nullptr && settings.sync_cycle > 0)
        for (const CanopenMessage& message : canopen_messages(*other.canopen->canopen()))
          if (message.what.starts_with("RPDO") && plans(settings, other.canopen->settings().canopen_address))
            add(message.id, member.name, fmt::format("{} of {}", message.what, other.name), message.bytes,
                Rhythm::Cyclic, settings.sync_cycle);
  }

  static bool plans(const canopen::MasterSettings& settings, uint8_t node) {
    return std::any_of(settings.nodes.begin(), settings.nodes.end(),
                       [node](const canopen::NodePlan& plan) { return plan.node == node; });
  }

  // As far as somebody sends it in this plant.
  Time sync_period(uint32_t sync) const {
    for (const Member& member : roster_.members)
      if (const auto* settings = canopen_of(member); settings != nullptr && settings->sync_cycle > 0 &&
                                                     sync == canopen::identifier(canopen::Connection::Sync))
        return settings->sync_cycle;
    return acyclic_period(sync);
  }

  void add_control(const Member& member, const ControlSettings& settings) {
    if (settings.sync_id)
      add(*settings.sync_id, member.name, "sync telegram", 0, Rhythm::Cyclic, settings.cycle);
    for (const ControlTarget& target : settings.targets) {
      const Telegram telegram = target.group        ? Telegram::GroupProcessOutput
                                : target.every == 0 ? Telegram::ProcessOutputSync
                                                    : Telegram::ProcessOutput;
      const Time period = target.every == 0 ? settings.cycle : target.every;
      PlannedTelegram request =
          add(sbus_identifier(telegram, target.address), member.name, telegram_name(telegram, target.address),
              kProcessBytes, Rhythm::Cyclic, period);
      // The answer to PO-sync follows the sync telegram.
      if (target.every == 0) request.id = *settings.sync_id;
      if (!target.group)
        add_answer(request, Telegram::ProcessInput, target.address, kProcessBytes, kInputWait,
                   Rhythm::Answer);
    }
  }

  // Answers and emergencies are planned as far as the trial showed them. Where no control sends SYNC, its distance
  // is the assumed one.
  void add_node(const Member& member) {
    const canopen::Node& node = *member.canopen->canopen();
    const uint32_t sync = node.dictionary().value(canopen::objects::kSyncId) & canopen::objects::kIdMask;
    for (const CanopenMessage& message : canopen_messages(node)) {
      if (!message.transmits || (message.asked && !seen_.contains(message.id))) continue;
      const bool cyclic = message.syncs != 0 || message.period != 0;
      const Time period = message.syncs != 0    ? message.syncs * sync_period(sync)
                          : message.period != 0 ? message.period
                                                : acyclic_period(message.id);
      PlannedTelegram& telegram = add(message.id, member.name, message.what, message.bytes,
                                      cyclic ? Rhythm::Cyclic : Rhythm::Acyclic, period);
      if (message.syncs != 0) telegram.request = sync;
    }
  }

  void add_partners(const Member& member) {
    for (const MovilinkCommand::Partner& partner : member.port->partners()) {
      const bool group = partner.address >= kGroupAddressBase;
      const auto address = static_cast<uint8_t>(partner.address - (group ? kGroupAddressBase : 0));
      if (partner.parameter)
        add_request(member, group ? Telegram::GroupParameterRequest : Telegram::ParameterRequest,
                    Telegram::ParameterResponse, address, kParameterBytes, kResponseWait);
      if (partner.process_data)
        add_request(member, group ? Telegram::GroupProcessOutput : Telegram::ProcessOutput,
                    Telegram::ProcessInput, address, kProcessBytes, kInputWait);
    }
  }

  void add_request(const Member& member, Telegram telegram, Telegram answer, uint8_t address, uint8_t bytes,
                   Time wait) {
    const uint32_t id = sbus_identifier(telegram, address);
    const PlannedTelegram request =
        add(id, member.name, telegram_name(telegram, address), bytes, Rhythm::Acyclic, acyclic_period(id));
    if (!telegram_type(telegram).grouped) add_answer(request, answer, address, bytes, wait, Rhythm::Acyclic);
  }

  void add_group_master(const Member& member) {
    if (!member.port->group_master().active()) return;
    const uint8_t group = member.port->settings().slave.group;
    add(sbus_identifier(Telegram::GroupProcessOutput, group), member.name,
        telegram_name(Telegram::GroupProcessOutput, group), kProcessBytes, Rhythm::Cyclic, kMillisecond);
  }

  void add_objects(const Member& member) {
    for (const ObjectDefinition& definition : objects_of(member).definitions()) {
      if (!definition.accepted || definition.kind == ObjectKind::Receive) continue;
      const auto id = static_cast<uint32_t>(definition.object);
      const bool cyclic = definition.kind == ObjectKind::TransmitCyclic;
      add(id, member.name, fmt::format("object {}", structure_name(*member.station, definition.variable)),
          definition.format->length, cyclic ? Rhythm::Cyclic : Rhythm::Acyclic,
          cyclic ? definition.cycle * kMillisecond : acyclic_period(id));
    }
  }

  const LineRoster& roster_;
  const SeenTelegrams& seen_;
  const PlanOptions& options_;
  std::vector<PlannedTelegram> telegrams_;
};

}  // namespace

std::vector<PlannedTelegram> planned_telegrams(const LineRoster& roster, const SeenTelegrams& seen,
                                               const PlanOptions& options) {
  return Traffic(roster, seen, options).take();
}

void analyse(std::vector<PlannedTelegram>& telegrams, Time bit_time) {
  constexpr int kRounds = 100;
  std::vector<PeriodicFrame> frames;
  for (const PlannedTelegram& telegram : telegrams)
    // A frame takes part from the next bit boundary on.
    frames.push_back(
        {telegram.id, worst_case_bits(telegram.bytes, false) * bit_time, telegram.period, bit_time});
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<ResponseTime> results = response_times(frames, bit_time);
    bool changed = false;
    for (size_t n = 0; n < telegrams.size(); ++n) {
      telegrams[n].response = results[n];
      if (telegrams[n].request == ~0U) continue;
      Time jitter = bit_time + telegrams[n].wait;
      for (size_t r = 0; r < telegrams.size(); ++r)
        if (telegrams[r].id == telegrams[n].request && results[r].bounded) jitter += results[r].worst;
      changed |= frames[n].jitter != jitter;
      frames[n].jitter = jitter;
    }
    if (!changed) break;
    if (round + 1 == kRounds)  // jitters grow without end
      for (PlannedTelegram& telegram : telegrams) telegram.response.bounded = false;
  }
  for (PlannedTelegram& telegram : telegrams)
    for (const PlannedTelegram& request : telegrams)
      if (request.id == telegram.request && !request.response.bounded) telegram.response.bounded = false;
}

uint64_t worst_load(const std::vector<PlannedTelegram>& telegrams) {
  uint64_t micro = 0;  // millionths of a bit per second
  for (const PlannedTelegram& telegram : telegrams)
    micro += uint64_t{worst_case_bits(telegram.bytes, false)} * 1'000'000 * kSecond /
             static_cast<uint64_t>(telegram.period);
  return micro / 1'000'000;
}

}  // namespace ipos::runtime
