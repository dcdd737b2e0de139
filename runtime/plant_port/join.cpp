// A kind of bus that real ports can carry has an overload of `carry`.
#include "runtime/plant_port/join.hpp"

#include <fmt/format.h>

#include <utility>

#include "runtime/os_port/can_bridge.hpp"
#include "runtime/os_port/profibus_bridge.hpp"
#include "runtime/os_port/serial_bridge.hpp"
#include "runtime/plant/can_bus.hpp"
#include "runtime/plant/profibus_bus.hpp"
#include "runtime/plant/serial_bus.hpp"

namespace ipos::runtime {
namespace {

using Joined = tl::expected<JoinedPort, PortError>;

// Where a bridge stands among the events of a plant.
struct Place {
  EventQueue& queue;
  uint32_t source;
};

template <typename Bridge, typename OpenedPort, typename Line>
Joined bridge(OpenedPort port, const Place& place, Line& line) {
  if (!port) return tl::unexpected(port.error());
  auto joined = std::make_unique<Bridge>(place.queue, place.source, line, **port);
  return JoinedPort{std::move(*port), std::move(joined)};
}

Joined carry(CanBus& bus, const std::string& port, const Place& place, RealClock& clock) {
  return bridge<CanBridge>(open_can_port(port, bus.baud(), clock), place, bus.line());
}

Joined carry(SerialBus& bus, const std::string& port, const Place& place, RealClock& clock) {
  return bridge<SerialBridge>(open_serial_port(port, {bus.baud(), true}, clock), place, bus.line());
}

Joined carry(ProfibusBus& bus, const std::string& port, const Place& place, RealClock& clock) {
  return bridge<ProfibusBridge>(open_serial_port(port, {bus.baud(), true, false}, clock), place, bus.line());
}

}  // namespace

Joined join_port(Plant& plant, Bus& bus, const std::string& port, RealClock& clock) {
  const Place place{plant.queue(), plant.next_source()};
  if (auto* can = dynamic_cast<CanBus*>(&bus)) return carry(*can, port, place, clock);
  if (auto* serial = dynamic_cast<SerialBus*>(&bus)) return carry(*serial, port, place, clock);
  if (auto* profibus = dynamic_cast<ProfibusBus*>(&bus)) return carry(*profibus, port, place, clock);
  return tl::unexpected(
      port_error(PortFault::BadName, port, fmt::format("no real port carries {}", info(bus.kind()).name)));
}

}  // namespace ipos::runtime
