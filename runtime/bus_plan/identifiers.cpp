// Collects the uses of identifiers from settings, MOVLNK partners and object definitions.
#include "runtime/bus_plan/identifiers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "runtime/bus_plan/canopen_messages.hpp"

namespace ipos::runtime {
namespace {

// All MOVILINK identifiers of a member, as slave and as master.
std::vector<IdentifierUse> movilink_uses(const Member& member) {
  std::vector<IdentifierUse> uses;
  const auto add = [&](std::vector<IdentifierUse> more) {
    uses.insert(uses.end(), more.begin(), more.end());
  };
  if (member.port != nullptr) {
    const SlaveSettings& settings = member.port->settings().slave;
    add(slave_identifiers(settings));
    for (const MovilinkCommand::Partner& partner : member.port->partners())
      add(master_identifiers(partner.address, settings));
    if (member.port->group_master().active())
      for (IdentifierUse& use : uses)
        if (use.telegram == Telegram::GroupProcessOutput && use.address == settings.group)
          use.transmits = true;
  }
  if (const auto* settings = movilink_of(member))
    for (const ControlTarget& target : settings->targets)
      for (const IdentifierUse& use : master_identifiers(target.address + (target.group ? 100 : 0), {})) {
        const bool sent = target.group        ? use.telegram == Telegram::GroupProcessOutput
                          : target.every == 0 ? use.telegram == Telegram::ProcessOutputSync
                                              : use.telegram == Telegram::ProcessOutput;
        if (sent || use.telegram == Telegram::ProcessInput) uses.push_back(use);
      }
  return uses;
}

class Collector {
 public:
  void add(uint32_t id, PlannedUse use) {
    std::vector<PlannedUse>& uses = entries_[id];
    for (const PlannedUse& known : uses)
      if (known.station == use.station && known.what == use.what && known.transmits == use.transmits) return;
    uses.push_back(std::move(use));
  }
  std::vector<PlannedIdentifier> take() {
    std::vector<PlannedIdentifier> list;
    for (auto& [id, uses] : entries_) list.push_back({id, std::move(uses)});
    return list;
  }

 private:
  std::map<uint32_t, std::vector<PlannedUse>> entries_;
};

// What a node sends and takes by its dictionary, as far as the trial has come.
void add_canopen(const Member& member, Collector& collector) {
  if (member.canopen == nullptr || member.canopen->canopen() == nullptr) return;
  for (const CanopenMessage& message : canopen_messages(*member.canopen->canopen()))
    collector.add(message.id, {member.name, message.what, message.transmits, true});
}

void add_sync(const Member& member, Collector& collector) {
  if (member.port != nullptr && member.port->settings().slave.synchronous)
    collector.add(member.port->settings().slave.sync_id, {member.name, "sync telegram", false, true});
  if (const auto* settings = canopen_of(member); settings != nullptr && settings->sync_cycle > 0)
    collector.add(canopen::identifier(canopen::Connection::Sync), {member.name, "SYNC", true, true});
  if (const auto* settings = movilink_of(member); settings != nullptr && settings->sync_id)
    collector.add(*settings->sync_id, {member.name, "sync telegram", true, true});
}

void add_objects(const Member& member, Collector& collector) {
  if (member.station == nullptr) return;
  for (const ObjectDefinition& definition : objects_of(member).definitions())
    if (definition.accepted)
      collector.add(
          static_cast<uint32_t>(definition.object),
          {member.name, fmt::format("object {}", structure_name(*member.station, definition.variable)),
           definition.kind != ObjectKind::Receive, false});
}

}  // namespace

std::vector<PlannedIdentifier> planned_identifiers(const LineRoster& roster) {
  Collector collector;
  for (const Member& member : roster.members) {
    for (const IdentifierUse& use : movilink_uses(member))
      collector.add(use.id, {member.name, telegram_name(use.telegram, use.address), use.transmits, true});
    add_canopen(member, collector);
    add_sync(member, collector);
    add_objects(member, collector);
  }
  return collector.take();
}

std::vector<ClosedIdentifiers> closed_identifiers(const LineRoster& roster) {
  std::vector<ClosedIdentifiers> closed;
  for (const Member& member : roster.members) {
    if (member.port == nullptr || member.station->config().unit->tasks == 0) continue;
    std::set<uint32_t> own;
    for (const IdentifierUse& use : movilink_uses(member)) own.insert(use.id);
    std::set<uint32_t> transmit = own;
    for (const Member& other : roster.members)
      for (const IdentifierUse& use : movilink_uses(other))
        if (use.transmits) transmit.insert(use.id);
    closed.push_back({member.name, {transmit.begin(), transmit.end()}, {own.begin(), own.end()}});
  }
  return closed;
}

}  // namespace ipos::runtime
