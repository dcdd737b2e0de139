// What can be wrong with addresses and identifiers (1053 1610 p. 38, 41, 50, 51).
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus_plan/checks.hpp"
#include "stdlib/control_sources.hpp"
#include "stdlib/unsimulated.hpp"

namespace ipos::runtime {
namespace {

constexpr int32_t kSetpointSbus = stdlib::code(stdlib::SetpointSource::Sbus);
constexpr int32_t kControlSbus = stdlib::code(stdlib::ControlSource::Sbus);

class ProfileCheck {
 public:
  ProfileCheck(const LineRoster& roster, const LinePlan& plan, std::vector<Finding>& findings)
      : roster_(roster), plan_(plan), findings_(findings) {}

  void run() {
    addresses();
    for (const PlannedIdentifier& identifier : plan_.identifiers) {
      senders(identifier);
      sync(identifier);
    }
    partners();
    masters();
    for (const Member& member : roster_.members)
      if (member.station != nullptr) {
        master_slave(member);
        unsimulated(member);
      }
  }

 private:
  void find(FindingKind kind, std::string text) { findings_.push_back({kind, plan_.name, std::move(text)}); }

  void addresses() {
    for (size_t b = 0; b < roster_.members.size(); ++b)
      for (size_t a = 0; a < b; ++a) {
        const Member& first = roster_.members[a];
        const Member& second = roster_.members[b];
        if (first.canopen != nullptr && second.canopen != nullptr) nodes(first, second);
        if (first.port == nullptr || second.port == nullptr) continue;
        const uint8_t address = first.port->settings().slave.address;
        if (address == second.port->settings().slave.address)
          find(FindingKind::DoubleAddress,
               fmt::format("{} and {} both have SBus address {}", first.name, second.name, address));
      }
  }

  void nodes(const Member& first, const Member& second) {
    const uint8_t node = first.canopen->settings().canopen_address;
    if (node == second.canopen->settings().canopen_address)
      find(FindingKind::DoubleAddress,
           fmt::format("{} and {} both have CANopen address {}", first.name, second.name, node));
  }

  void senders(const PlannedIdentifier& identifier) {
    std::vector<const PlannedUse*> sending;
    for (const PlannedUse& use : identifier.uses)
      if (use.transmits) sending.push_back(&use);
    for (size_t n = 1; n < sending.size(); ++n)
      find(FindingKind::DoubleIdentifier,
           fmt::format("identifier {} is sent by {} ({}) and by {} ({})", id_words(identifier.id),
                       sending[0]->station, sending[0]->what, sending[n]->station, sending[n]->what));
  }

  void sync(const PlannedIdentifier& identifier) {
    const PlannedUse* sync = nullptr;
    const PlannedUse* profile = nullptr;
    const PlannedUse* object = nullptr;
    for (const PlannedUse& use : identifier.uses) {
      const bool is_sync = use.movilink && use.what == "sync telegram";
      const PlannedUse*& place = is_sync ? sync : use.movilink ? profile : object;
      if (place == nullptr) place = &use;
    }
    if (sync == nullptr) return;
    if (profile != nullptr)
      find(FindingKind::SyncIdentifier,
           fmt::format("sync identifier {} of {} is {} of {}", id_words(identifier.id), sync->station,
                       profile->what, profile->station));
    if (object != nullptr)
      find(FindingKind::SyncObject,
           fmt::format("{} of {} has the sync identifier {} of {}, which takes it as sync "
                       "telegram",
                       object->what, object->station, id_words(identifier.id), sync->station));
  }

  std::string present(bool groups) const {
    std::string list;
    for (const Member& member : roster_.members)
      if (member.port != nullptr)
        list +=
            fmt::format("{}{} ({})", list.empty() ? "" : ", ",
                        groups ? member.port->settings().slave.group : member.port->settings().slave.address,
                        member.name);
    return list.empty() ? "none" : list;
  }

  void called(const std::string& caller, uint8_t address, bool group, bool process_data) {
    const Member* slave = roster_.slave_at(address);
    const bool is_there = group ? roster_.has_group(address) : slave != nullptr;
    if (!is_there && !roster_.config->port.empty()) return;  // it may be a unit behind the port
    if (group ? !roster_.has_group(address) : slave == nullptr)
      find(FindingKind::NobodyThere, fmt::format("{} calls {} {}, which no station has; there are {}", caller,
                                                 group ? "group" : "address", address, present(group)));
    else if (process_data && !group)
      follows(*slave);
  }

  void called_node(const std::string& caller, uint8_t node) {
    const bool there =
        std::any_of(roster_.members.begin(), roster_.members.end(), [node](const Member& member) {
          return member.canopen != nullptr && member.canopen->settings().canopen_address == node;
        });
    if (!there && roster_.config->port.empty())
      find(FindingKind::NobodyThere, fmt::format("{} calls node {}, which no station is", caller, node));
  }

  void partners() {
    for (const Member& member : roster_.members) {
      if (member.port != nullptr)
        for (const MovilinkCommand::Partner& partner : member.port->partners()) {
          const bool group = partner.address >= kGroupAddressBase;
          called(member.name, static_cast<uint8_t>(partner.address - (group ? kGroupAddressBase : 0)), group,
                 partner.process_data);
        }
      if (const auto* settings = canopen_of(member))
        for (const canopen::NodePlan& plan : settings->nodes) called_node(member.name, plan.node);
      if (const auto* settings = movilink_of(member))
        for (const ControlTarget& target : settings->targets)
          called(member.name, target.address, target.group, true);
    }
  }

  // MOVLNK needs the line for itself; master controls alone may be several.
  void masters() {
    std::vector<std::string> calling, all;
    for (const Member& member : roster_.members) {
      const bool calls = member.port != nullptr && !member.port->partners().empty();
      if (calls) calling.push_back(member.name);
      const ControlSettings* const settings = movilink_of(member);
      if (calls || (settings != nullptr && !settings->targets.empty()))
        all.push_back(member.name);
    }
    if (!calling.empty() && all.size() > 1)
      find(FindingKind::SeveralMasters,
           fmt::format("{} {} MOVLNK, but {} are masters on this line", fmt::join(calling, ", "),
                       calling.size() == 1 ? "uses" : "use", fmt::join(all, ", ")));
  }

  static bool has_current_word(const UnitInterface& drive) {
    constexpr auto kCurrent = static_cast<int32_t>(PoAssignment::Current);
    return drive.value("870") == kCurrent || drive.value("871") == kCurrent || drive.value("872") == kCurrent;
  }

  // Each setting that keeps process data from acting (p. 41), once a station.
  void follows(const Member& member) {
    if (!told_.insert(member.name).second) return;
    const UnitInterface& drive = member.station->drive();
    const auto setting = [&](std::string_view number, bool good, std::string_view wanted) {
      const stdlib::Parameter* row = stdlib::parameter_table(drive.unit()).find(number);
      if (good || row == nullptr) return;
      find(FindingKind::ProcessData,
           fmt::format("{} does not follow process data: P{} {} is {}, not {}", member.name, number,
                       row->name, stdlib::parameter_text(*row, drive.value(number)), wanted));
    };
    setting("100", drive.value("100") == kSetpointSbus, "SBus");
    setting("101", drive.value("101") == kControlSbus, "SBus");
    setting("876", drive.value("876") != 0, "ON");
    const auto word = [&](bool good, std::string_view missing, std::string_view so) {
      if (!good)
        find(FindingKind::ProcessData,
             fmt::format("no PO word of {} is {} (P870..P872): {}", member.name, missing, so));
    };
    word(drive.value("101") != kControlSbus || drive.has_control_word(), "a control word",
         "it is enabled as if the bus had sent it");
    const bool bus_setpoint = drive.value("100") == kSetpointSbus;
    if (is_torque_control(drive.value("700")))
      word(!bus_setpoint || has_current_word(drive), "a current", "its torque counts as 0");
    else
      word(!bus_setpoint || drive.has_speed_word(), "a speed", "its setpoint counts as 0");
  }

  void unsimulated(const Member& member) {
    const UnitInterface& drive = member.station->drive();
    for (const stdlib::Unsimulated& one : stdlib::unsimulated(drive.unit())) {
      if (one.row->scope != stdlib::UnsimulatedScope::Bus) continue;
      if (const int32_t value = drive.parameters().value(one.parameter->index); one.applies(value))
        find(FindingKind::NotSimulated, fmt::format("{}: {}", member.name, one.text(value)));
    }
  }

  bool is_group_master(const Member& member) const {
    return member.port != nullptr && member.sbus == 1 &&
           sends_over_sbus(member.station->drive().value("750"));
  }

  void master_slave(const Member& member) {
    if (member.sbus != 1 || member.port == nullptr) return;
    const uint8_t group = member.port->settings().slave.group;
    if (is_group_master(member)) {
      if (!member.port->group_master().active())
        find(FindingKind::MasterSlave,
             fmt::format("{} is a master (P750), but master/slave operation needs 500 or 1000 kbaud, not {}",
                         member.name, roster_.config->baud / 1000));
      const auto follows_it = [&](const Member& other) {
        return &other != &member && other.port != nullptr && other.port->settings().slave.group == group &&
               other.station->drive().follows_sbus_master();
      };
      if (std::none_of(roster_.members.begin(), roster_.members.end(), follows_it))
        find(FindingKind::MasterSlave,
             fmt::format("{} is a master (P750), but no slave with P100 = MASTER-SBus has its group {}",
                         member.name, group));
    }
    if (!member.station->drive().follows_sbus_master()) return;
    const auto leads = [&](const Member& other) {
      return &other != &member && is_group_master(other) && other.port->settings().slave.group == group;
    };
    const auto master = std::find_if(roster_.members.begin(), roster_.members.end(), leads);
    if (master != roster_.members.end())
      same_kind(*master, member);
    else
      find(FindingKind::MasterSlave,
           fmt::format("{} follows a master (P100 = MASTER-SBus), but no master (P750) has its group {}",
                       member.name, group));
  }

  // Nothing in the telegram says whether its setpoint is a speed or a current.
  void same_kind(const Member& master, const Member& slave) {
    const bool speed = slave_setpoint(master.station->drive().value("750")) == SlaveSetpoint::Speed;
    const bool torque_control = is_torque_control(slave.station->drive().value("700"));
    if (speed == torque_control)
      find(FindingKind::MasterSlave,
           fmt::format("{} sends a {} (P750), which {} takes for a {} (P700)", master.name,
                       speed ? "speed" : "torque", slave.name, speed ? "torque" : "speed"));
  }

  const LineRoster& roster_;
  const LinePlan& plan_;
  std::vector<Finding>& findings_;
  std::set<std::string> told_;
};

}  // namespace

void check_profile(const LineRoster& roster, const LinePlan& plan, std::vector<Finding>& findings) {
  ProfileCheck(roster, plan, findings).run();
}

}  // namespace ipos::runtime
