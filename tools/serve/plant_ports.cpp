// All ports of the plant file in a row.
#include "tools/serve/plant_ports.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/failure.hpp"

namespace ipos::tools::serve {

bool PlantPorts::has_ports(const runtime::PlantFile& plant) {
  return std::any_of(plant.buses.begin(), plant.buses.end(),
                     [](const auto& bus) { return !bus.port.empty(); });
}

void PlantPorts::join(runtime::Plant& plant, const std::string& file) {
  for (const runtime::BusConfig& bus : plant.file().buses) {
    if (bus.port.empty()) continue;
    auto joined = runtime::join_port(plant, *plant.find_bus(bus.name), bus.port, clock_);
    if (!joined)
      throw Failure(kIoError, fmt::format("{}:{}:{}: error: {}", file, bus.port_place.line,
                                          bus.port_place.column, joined.error().text));
    joined_.push_back(std::move(*joined));
  }
}

std::vector<std::string> PlantPorts::flush(bool& gone) {
  std::vector<std::string> notes;
  for (const runtime::JoinedPort& port : joined_) {
    gone_ = !port.bridge->flush() || gone_;
    for (std::string& note : port.bridge->take_notes()) notes.push_back(std::move(note));
  }
  gone = gone_;
  return notes;
}

void PlantPorts::collect(WallClock::time_point clock, runtime::Time at) {
  const auto since = std::chrono::duration_cast<std::chrono::nanoseconds>(WallClock::now() - clock).count();
  const runtime::Time epoch = clock_.now() - since - at;
  for (const runtime::JoinedPort& port : joined_) gone_ = !port.bridge->collect(epoch) || gone_;
}

}  // namespace ipos::tools::serve
