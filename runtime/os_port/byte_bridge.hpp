// What the bridges to serial ports have in common: octets come from the port as long as there is room for them, and the
// port's messages go with the bridge's own.
#pragma once

#include <string>
#include <vector>

#include "runtime/os_port/bridge.hpp"
#include "runtime/os_port/serial_port.hpp"

namespace ipos::runtime {

class ByteBridge : public Bridge {
 public:
  PortNeeds needs() const final;
  bool collect(Time epoch) final;
  bool flush() final;

  const BytePort& port() const final { return port_; }
  const BridgeCounts& counts() const final { return counts_; }
  std::vector<std::string> take_notes() final;
  std::vector<std::string> repeats() const final;

 protected:
  // The port must outlive the bridge.
  explicit ByteBridge(BytePort& port) : port_(port) {}

  BytePort& port() { return port_; }
  PortNotes& notes() { return notes_; }
  BridgeCounts& counts() { return counts_; }

 private:
  virtual bool has_room() const = 0;
  // `at` is virtual time.
  virtual void arrive(const ByteArrival& byte) = 0;
  // What the user is told while there is no room, after the port's name.
  virtual std::string crowded() const = 0;

  bool gone(const PortError& error);

  BytePort& port_;
  BridgeCounts counts_;
  PortNotes notes_;
};

}  // namespace ipos::runtime
