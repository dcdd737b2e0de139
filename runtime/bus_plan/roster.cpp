// Collects the members of the lines.
#include "runtime/bus_plan/roster.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus_plan/names.hpp"

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

std::vector<LineRoster> line_rosters(const Plant& plant) {
  std::vector<LineRoster> rosters;
  for (size_t n = 0; n < plant.lines().size(); ++n) {
    const auto& buses = plant.file().buses;
    const auto found = std::find_if(buses.begin(), buses.end(), [&](const BusConfig& bus) {
      return bus.name == plant.lines()[n]->name();
    });
    LineRoster roster{plant.lines()[n], &*found, {}};
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
    for (const PlantControl& control : plant.controls())
      if (control.line == roster.line)
        roster.members.push_back(
            {control.config->name, nullptr, nullptr, nullptr, 1, &control, control.config->place.line});
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
