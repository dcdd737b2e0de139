// Collects the members of the lines.
#include "runtime/bus_plan/roster.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus_plan/names.hpp"
#include "runtime/plant_file/line_names.hpp"

namespace ipos::runtime {

const Member* LineRoster::slave_at(uint8_t address) const {
  for (const Member& member : members)
    if (member.port != nullptr && member.port->settings().slave.address == address) return &member;
  return nullptr;
}

bool LineRoster::has_group(uint8_t group) const {
  return std::any_of(members.begin(), members.end(), [group](const Member& member) {
    return member.port != nullptr && member.port->settings().slave.group == group;
  });
}

const ControlSettings* movilink_of(const Member& member) {
  if (member.control == nullptr) return nullptr;
  return visit(
      *member.control, [](MovilinkControl& control) { return &control.control().settings(); },
      [](Gateway& gateway) { return &gateway.settings(); },
      [](CanopenControl&) -> const ControlSettings* { return nullptr; },
      [](ProfibusControl&) -> const ControlSettings* { return nullptr; },
      [](FmsControl&) -> const ControlSettings* { return nullptr; });
}

const canopen::MasterSettings* canopen_of(const Member& member) {
  const auto* const control = as<CanopenControl>(member.control);
  return control == nullptr ? nullptr : &control->settings();
}

std::vector<LineRoster> line_rosters(const Plant& plant) {
  std::vector<LineRoster> rosters;
  for (CanBus* bus : plant.all<CanBus>()) {
    LineRoster roster{&bus->line(), &bus->config(), {}};
    for (const auto& station : plant.stations())
      for (const int number : {1, 2}) {
        const SbusPort* port = station->sbus(number);
        const CanopenPort* canopen = station->canopen(number);
        if ((port == nullptr || &port->line() != roster.line) &&
            (canopen == nullptr || &canopen->line() != roster.line))
          continue;
        const StationConfig& config = station->config();
        roster.members.push_back(
            {config.name, station.get(), port, canopen, number, nullptr, config.place.line});
      }
    for (const auto& control : plant.controls()) {
      const std::vector<std::string> lines = line_names(control->config());
      if (std::find(lines.begin(), lines.end(), bus->name()) != lines.end())
        roster.members.push_back(
            {control->name(), nullptr, nullptr, nullptr, 1, control.get(), control->config().place.line});
    }
    std::stable_sort(roster.members.begin(), roster.members.end(),
                     [](const Member& a, const Member& b) { return a.place < b.place; });
    rosters.push_back(std::move(roster));
  }
  return rosters;
}

std::string telegram_name(Telegram telegram, uint8_t address) {
  const TelegramType& type = telegram_type(telegram);
  return fmt::format("{} {} {}", type.text, type.grouped ? "of group" : "of address", address);
}

std::string structure_name(const Station& station, uint32_t variable) {
  std::string name = variable_name(station.image(), variable);
  const size_t dot = name.find('.');
  return dot == std::string::npos ? name : name.substr(0, dot);
}

}  // namespace ipos::runtime
