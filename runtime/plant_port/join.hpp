// Joins a line of a plant to a real port. The plant does not know ports, and a port does not know plants: what brings
// them together stands above both.
#pragma once

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "runtime/os_port/bridge.hpp"
#include "runtime/os_port/port_error.hpp"
#include "runtime/plant/plant.hpp"
#include "runtime/station/bus.hpp"

namespace ipos::runtime {

// An open port, and the bridge from it to a line.
struct JoinedPort {
  std::unique_ptr<Port> port;
  std::unique_ptr<Bridge> bridge;
};

// What becomes of a run whose port goes away: it ends, or goes on without it until the port is there again.
enum class PortLoss : uint8_t { Ends, GoesOn };

// Opens the port ("can0", "/dev/ttyUSB0", "pty:name") at the rate of the bus, before the first event of the plant runs.
// The error says why the port cannot be had.
tl::expected<JoinedPort, PortError> join_port(Plant& plant, Bus& bus, const std::string& port,
                                              RealClock& clock, PortLoss loss = PortLoss::Ends);

}  // namespace ipos::runtime
