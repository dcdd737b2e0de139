// All ports of the plant file in a row.
#include "tools/serve/plant_ports.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/plant_file/outer_port.hpp"
#include "tools/cli/failure.hpp"

namespace ipos::tools::serve {

namespace {

// A program that opens its pseudo-terminal for each telegram must not fill the journal (ours).
constexpr uint64_t kMostTold = 100;

}  // namespace

bool PlantPorts::has_ports(const runtime::PlantFile& plant) {
  return std::any_of(plant.buses.begin(), plant.buses.end(),
                     runtime::has_outer_port);
}

void PlantPorts::join(runtime::Plant& plant, const std::string& file) {
  for (const runtime::BusConfig& bus : plant.file().buses) {
    if (!runtime::has_outer_port(bus)) continue;
    auto joined =
        runtime::join_port(plant, *plant.find_bus(bus.name), bus.port, clock_, runtime::PortLoss::GoesOn);
    if (!joined)
      throw Failure(kIoError, fmt::format("{}:{}:{}: error: {}", file, bus.port_place.line,
                                          bus.port_place.column, joined.error().text));
    std::string absence(joined->port->absence());
    joined_.push_back({bus.name, std::move(*joined), std::move(absence), 0, std::nullopt});
  }
}

// They come back (runtime/os_port/returning_port.hpp), so no bridge tells that its port has gone for good.
bool PlantPorts::joined(const std::string& bus) const {
  return std::any_of(joined_.begin(), joined_.end(), [&](const Joined& one) { return one.bus == bus; });
}

void PlantPorts::flush() {
  for (const Joined& joined : joined_) joined.port.bridge->flush();
}

void PlantPorts::collect(WallClock::time_point clock, runtime::Time at) {
  const auto since = std::chrono::duration_cast<std::chrono::nanoseconds>(WallClock::now() - clock).count();
  const runtime::Time epoch = clock_.now() - since - at;
  for (const Joined& joined : joined_) joined.port.bridge->collect(epoch);
}

std::vector<std::string> PlantPorts::take_notes() {
  std::vector<std::string> notes;
  for (const Joined& joined : joined_)
    for (std::string& note : joined.port.bridge->take_notes()) notes.push_back(std::move(note));
  return notes;
}

std::vector<Ports::Change> PlantPorts::take_changes(runtime::Time now) {
  std::vector<Change> changes;
  for (Joined& joined : joined_) {
    const std::string_view absence = joined.port.port->absence();
    if (absence == joined.absence) continue;
    const bool again = joined.since.has_value();
    joined.absence = absence;
    joined.since = now;
    const std::string name = fmt::format("{}: port {}", joined.bus, joined.port.port->name());
    std::string text;
    if (++joined.changes <= kMostTold)
      text = absence.empty() ? fmt::format("{} is there{}", name, again ? " again" : "")
                             : fmt::format("{} is away: {}", name, absence);
    if (joined.changes == kMostTold) text += "; further changes of this port are not told";
    changes.push_back({absence.empty(), std::move(text)});
  }
  return changes;
}

Json PlantPorts::states() const {
  Json states = Json::array();
  for (const Joined& joined : joined_) {
    states.push_back({{"bus", joined.bus},
                      {"name", joined.port.port->name()},
                      {"there", joined.absence.empty()},
                      {"text", joined.absence}});
    states.back()["since_us"] = joined.since ? Json(*joined.since / runtime::kMicrosecond) : Json(nullptr);
  }
  return states;
}

}  // namespace ipos::tools::serve
