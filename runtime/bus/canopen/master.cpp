// The model master: one list of writes a node, then start, then cycles.
#include "runtime/bus/canopen/master.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "runtime/bus/canopen/abort.hpp"
#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/canopen/pdo.hpp"
#include "runtime/bus/canopen/words.hpp"

namespace ipos::runtime::canopen {
namespace {

// Kind of a timer: what it is for, and the number of the node behind it.
enum MasterTimer : uint32_t { kSyncTimer, kHeartbeatTimer, kSdoTimer, kGuardTimer, kLifeTimer };
constexpr uint32_t kKinds = 5;
constexpr uint32_t kind_of(MasterTimer kind, size_t node) {
  return static_cast<uint32_t>(node) * kKinds + kind;
}

constexpr Connection kReceive[] = {Connection::ReceivePdo1, Connection::ReceivePdo2, Connection::ReceivePdo3,
                                   Connection::ReceivePdo4};
constexpr Connection kTransmit[] = {Connection::TransmitPdo1, Connection::TransmitPdo2,
                                    Connection::TransmitPdo3, Connection::TransmitPdo4};

// Tags of frames: of those with one tag only the latest still waits, so that a line that is dead for a while does not
// fill the queue. The rest, after kOfNodes, belongs to the nodes.
enum Tag : uint64_t { kCommands, kSyncs, kHeartbeats, kOfNodes };
enum NodeTag : uint64_t { kOutput1, kOutput4 = kOutput1 + 3, kGuardings, kRequests, kNodeTags };
constexpr uint64_t tag_of(size_t node, uint64_t tag) { return kOfNodes + node * kNodeTags + tag; }

constexpr uint16_t index_of(uint16_t first, uint8_t number) { return static_cast<uint16_t>(first + number); }

}  // namespace

std::vector<SdoWrite> remapping(const PdoPlan& plan, uint8_t node) {
  const uint16_t pdo = index_of(plan.transmit ? objects::kTransmitPdo : objects::kReceivePdo, plan.number);
  const uint16_t map =
      index_of(plan.transmit ? objects::kTransmitMapping : objects::kReceiveMapping, plan.number);
  const uint32_t id = identifier(plan.transmit ? kTransmit[plan.number] : kReceive[plan.number], node);
  std::vector<SdoWrite> writes = {{{pdo, objects::kCobId}, objects::kOff | id, 4}};
  if (plan.mapping.empty()) return writes;
  writes.push_back({{pdo, objects::kType}, plan.type, 1});
  if (plan.transmit) {
    writes.push_back({{pdo, objects::kInhibitTime}, plan.inhibit, 2});
    writes.push_back({{pdo, objects::kEventTimer}, plan.event, 2});
  }
  writes.push_back({{map, 0}, 0, 1});
  for (size_t n = 0; n < plan.mapping.size(); ++n)
    writes.push_back({{map, static_cast<uint8_t>(n + 1)}, mapping_entry(plan.mapping[n]), 4});
  writes.push_back({{map, 0}, static_cast<uint32_t>(plan.mapping.size()), 1});
  writes.push_back({{pdo, objects::kCobId}, id, 4});
  return writes;
}

Master::Master(EventQueue& queue, uint32_t source, MasterSettings settings, MasterObserver* observer)
    : queue_(queue), source_(source), settings_(std::move(settings)), observer_(observer) {
  for (const NodePlan& plan : settings_.nodes) {
    Link& link = links_.emplace_back();
    const ObjectDictionary defaults(plan.node);
    for (uint8_t n = 0; n < objects::kPdos; ++n) {
      const auto is_on = [&](uint16_t first) {
        return (defaults.value(index_of(first, n), objects::kCobId) & objects::kOff) == 0;
      };
      if (is_on(objects::kReceivePdo))
        link.receive[n] = PdoLayout(mapping_of(defaults, index_of(objects::kReceiveMapping, n)));
      if (is_on(objects::kTransmitPdo))
        link.transmit[n] = PdoLayout(mapping_of(defaults, index_of(objects::kTransmitMapping, n)));
    }
    link.writes = plan.writes;
    for (const PdoPlan& pdo : plan.pdos) {
      (pdo.transmit ? link.transmit : link.receive)[pdo.number] = PdoLayout(pdo.mapping);
      const std::vector<SdoWrite> writes = remapping(pdo, plan.node);
      link.writes.insert(link.writes.end(), writes.begin(), writes.end());
    }
    if (plan.guard_time != 0) {
      link.writes.push_back({{objects::kGuardTime, 0}, plan.guard_time, 2});
      link.writes.push_back({{objects::kLifeFactor, 0}, plan.life_factor, 1});
    } else if (plan.heartbeat != 0) {
      link.writes.push_back({{objects::kProducerHeartbeat, 0}, plan.heartbeat, 2});
    }
    if (settings_.heartbeat != 0)
      link.writes.push_back(
          {{objects::kConsumerHeartbeat, 1}, uint32_t{settings_.node} << 16 | 2U * settings_.heartbeat, 4});
  }
}

void Master::start(Time now, FrameSender& sender) {
  sender_ = &sender;
  const Place place{queue_, source_, sender, 0};
  Timer::Owner& owner = *this;
  for (size_t n = 0; n < links_.size(); ++n) {
    links_[n].sdo_timer.emplace(place, owner, kind_of(kSdoTimer, n));
    links_[n].guard_timer.emplace(place, owner, kind_of(kGuardTimer, n));
    links_[n].life_timer.emplace(place, owner, kind_of(kLifeTimer, n));
  }
  sync_timer_.emplace(place, owner, kSyncTimer);
  heartbeat_timer_.emplace(place, owner, kHeartbeatTimer);
  command(NmtCommand::ResetCommunication, 0);
  if (settings_.sync_cycle > 0) sync_timer_->start(now + settings_.sync_cycle);
  if (settings_.heartbeat > 0) on_timer(now, kHeartbeatTimer);
}

void Master::command(NmtCommand command, uint8_t node) {
  assert(sender_ != nullptr);  // after start()
  sender_->send(nmt_frame(command, node), kCommands);
}

void Master::on_timer(Time now, uint32_t kind) {
  const size_t node = kind / kKinds;
  switch (static_cast<MasterTimer>(kind % kKinds)) {
    case kSyncTimer: return cycle(now);
    case kHeartbeatTimer:
      sender_->send_latest({identifier(Connection::ErrorControl, settings_.node),
                            1,
                            {static_cast<uint8_t>(State::Operational)}},
                           kHeartbeats);
      heartbeat_timer_->start(now + Time{settings_.heartbeat} * kMillisecond);
      return;
    case kSdoTimer:
      sender_->send_latest(
          {identifier(Connection::SdoRequest, settings_.nodes[node].node), 8, links_[node].client.expire()},
          tag_of(node, kRequests));
      return lose(now, node, "does not answer over SDO: it is not started before its next boot-up");
    case kGuardTimer: {
      const NodePlan& plan = settings_.nodes[node];
      Frame request{identifier(Connection::ErrorControl, plan.node), 1};
      request.remote = true;
      sender_->send_latest(request, tag_of(node, kGuardings));
      links_[node].guard_timer->start(now + Time{plan.guard_time} * kMillisecond);
      return;
    }
    case kLifeTimer:
      links_[node].toggle.reset();
      return lose(now, node, "is missed: no sign of life within its time");
  }
}

void Master::lose(Time now, size_t node, std::string_view why) {
  links_[node].report.phase = Phase::Lost;
  ++links_[node].report.losses;
  tell(now, node, true, why);
}

void Master::tell(Time now, size_t node, bool wrong, std::string_view text) {
  if (observer_ != nullptr)
    observer_->on_node(now, wrong, fmt::format("CANopen: node {} {}", settings_.nodes[node].node, text));
}

void Master::cycle(Time now) {
  ++syncs_;
  sender_->send_latest({identifier(Connection::Sync), 0}, kSyncs);
  for (size_t n = 0; n < links_.size(); ++n)
    if (links_[n].report.phase == Phase::Running) send_outputs(n);
  sync_timer_->start(now + settings_.sync_cycle);
}

void Master::send_outputs(size_t node) {
  const NodePlan& plan = settings_.nodes[node];
  for (uint8_t n = 0; n < objects::kPdos; ++n)
    if (const PdoLayout& layout = links_[node].receive[n]; layout.bytes() != 0)
      sender_->send_latest({identifier(kReceive[n], plan.node), layout.bytes(), layout.pack(plan.output)},
                           tag_of(node, kOutput1 + n));
}

void Master::on_frame(Time now, const Frame& frame) {
  if (sender_ == nullptr || !is_plain(frame)) return;
  const auto addressed = connection_of(frame.id);
  if (!addressed) return;
  for (size_t n = 0; n < links_.size(); ++n)
    if (settings_.nodes[n].node == addressed->node) take(now, n, addressed->connection, frame);
}

void Master::take(Time now, size_t node, Connection connection, const Frame& frame) {
  Link& link = links_[node];
  if (connection == Connection::ErrorControl && frame.length == 1) return take_life(now, node, frame.data[0]);
  if (connection == Connection::SdoResponse && frame.length == 8) return take_answer(now, node, frame);
  if (connection == Connection::Emergency && frame.length == 8) {
    const auto& data = frame.data;
    link.report.emergencies.push_back({now,
                                       static_cast<uint16_t>(data[0] | data[1] << 8),
                                       data[2],
                                       {data[3], data[4], data[5], data[6], data[7]}});
    return tell(now, node, data[0] != 0 || data[1] != 0, "sends " + emergency_text(frame));
  }
  const auto* const pdo = std::find(std::begin(kTransmit), std::end(kTransmit), connection);
  if (pdo == std::end(kTransmit)) return;
  const PdoLayout& layout = link.transmit[static_cast<size_t>(pdo - std::begin(kTransmit))];
  if (layout.bytes() == 0 || frame.length < layout.bytes()) return;
  layout.unpack(frame.data, link.report.input);
  ++link.report.pdos;
}

void Master::take_life(Time now, size_t node, uint8_t byte) {
  Link& link = links_[node];
  const NodePlan& plan = settings_.nodes[node];
  const auto state = static_cast<uint8_t>(byte & 0x7F);
  link.report.state = state;
  if (byte == static_cast<uint8_t>(State::BootUp)) return boot(now, node);
  const auto toggle = static_cast<uint8_t>(byte & 0x80);
  if (plan.guard_time != 0) {
    if (link.toggle && *link.toggle != toggle) return;  // the answer before, once more: not a sign of life
    link.toggle = static_cast<uint8_t>(toggle ^ 0x80);
  }
  watch(now, node);
  // It is there again, and has not been off.
  if (link.report.phase == Phase::Lost && state == static_cast<uint8_t>(State::Operational)) {
    link.report.phase = Phase::Running;
    tell(now, node, false, "is there again");
  }
}

// From now on it must be heard again within its time.
void Master::watch(Time now, size_t node) {
  const NodePlan& plan = settings_.nodes[node];
  const Time guarded = Time{plan.guard_time} * plan.life_factor * kMillisecond;
  const Time limit = plan.guard_time != 0 ? guarded : 2 * Time{plan.heartbeat} * kMillisecond;
  if (limit > 0) links_[node].life_timer->start(now + limit);
}

void Master::boot(Time now, size_t node) {
  Link& link = links_[node];
  ++link.report.boot_ups;
  tell(now, node, false, "boots up");
  link.report.phase = Phase::Configuring;
  link.next = 0;
  link.toggle.reset();
  link.guard_timer->stop();
  link.life_timer->stop();
  write_next(now, node);
}

void Master::write_next(Time now, size_t node) {
  Link& link = links_[node];
  if (link.next < link.writes.size()) {
    const SdoWrite& write = link.writes[link.next];
    std::array<uint8_t, 4> data{};
    for (size_t n = 0; n < data.size(); ++n) data[n] = static_cast<uint8_t>(write.value >> 8 * n);
    return send_sdo(now, node, link.client.write(write.address, std::span(data).first(write.bytes)));
  }
  link.report.phase = Phase::Running;
  tell(now, node, false, "is configured and started");
  command(NmtCommand::Start, settings_.nodes[node].node);
  if (settings_.nodes[node].guard_time != 0) on_timer(now, kind_of(kGuardTimer, node));
  watch(now, node);
}

void Master::send_sdo(Time now, size_t node, const SdoBytes& bytes) {
  sender_->send_latest({identifier(Connection::SdoRequest, settings_.nodes[node].node), 8, bytes},
                       tag_of(node, kRequests));
  links_[node].sdo_timer->start(now + settings_.sdo_timeout);
}

void Master::take_answer(Time now, size_t node, const Frame& frame) {
  Link& link = links_[node];
  if (!link.client.is_busy()) return;
  const auto request = link.client.take(frame.data);
  if (request) send_sdo(now, node, *request);
  if (link.client.is_busy()) return;
  link.sdo_timer->stop();
  if (!link.client.result()) {
    link.report.phase = Phase::Refused;
    link.report.refused = link.client.address();
    link.report.abort = link.client.result().error();
    const Address at = link.report.refused;
    return tell(now, node, true,
                fmt::format("refuses to write {:04X}h:{} {}: {} ({:08X}h); it is not started", at.index,
                            at.sub, entry_name(at), abort_text(link.report.abort), link.report.abort));
  }
  ++link.next;
  write_next(now, node);
}

}  // namespace ipos::runtime::canopen
