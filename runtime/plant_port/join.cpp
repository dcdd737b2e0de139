// Each class of bus has an overload of `carry`.
#include "runtime/plant_port/join.hpp"

#include <utility>

#include "runtime/os_port/can_bridge.hpp"
#include "runtime/os_port/profibus_bridge.hpp"
#include "runtime/os_port/returning_port.hpp"
#include "runtime/os_port/serial_bridge.hpp"
#include "runtime/station/can_bus.hpp"
#include "runtime/station/profibus_bus.hpp"
#include "runtime/station/serial_bus.hpp"

namespace ipos::runtime {
namespace {

using Joined = tl::expected<JoinedPort, PortError>;

// Where a bridge stands among the events of a plant.
struct Place {
  EventQueue& queue;
  uint32_t source;
};

// The port, the clock it lives by, and what happens without it.
struct Wanted {
  std::string port;
  RealClock& clock;
  PortLoss loss;
};

template <typename Bridge, typename Open, typename Line>
Joined bridge(Open open, const Wanted& wanted, const Place& place, Line& line) {
  auto port = wanted.loss == PortLoss::Ends ? open() : open_returning(open, wanted.clock);
  if (!port) return tl::unexpected(port.error());
  auto joined = std::make_unique<Bridge>(place.queue, place.source, line, **port);
  return JoinedPort{std::move(*port), std::move(joined)};
}

OpenSerialPort opening(const Wanted& wanted, const SerialSettings& settings) {
  return [name = wanted.port, settings, &clock = wanted.clock] {
    return open_serial_port(name, settings, clock);
  };
}

Joined carry(CanBus& bus, const Wanted& wanted, const Place& place) {
  const OpenCanPort open = [name = wanted.port, baud = bus.baud(), &clock = wanted.clock] {
    return open_can_port(name, baud, clock);
  };
  return bridge<CanBridge>(open, wanted, place, bus.line());
}

Joined carry(SerialBus& bus, const Wanted& wanted, const Place& place) {
  return bridge<SerialBridge>(opening(wanted, {bus.baud(), true}), wanted, place, bus.line());
}

Joined carry(ProfibusBus& bus, const Wanted& wanted, const Place& place) {
  return bridge<ProfibusBridge>(opening(wanted, {bus.baud(), true, false}), wanted, place, bus.line());
}

}  // namespace

Joined join_port(Plant& plant, Bus& bus, const std::string& port, RealClock& clock, PortLoss loss) {
  const Place place{plant.queue(), plant.next_source()};
  const Wanted wanted{port, clock, loss};
  return visit(bus, [&](auto& line) { return carry(line, wanted, place); });
}

}  // namespace ipos::runtime
