// A serial line of the real world for RS-485: a device, or a pseudo-terminal to which other programs attach.
// Bytes with their times in, bytes out; what they mean is the line's business.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "runtime/os_port/port.hpp"

namespace ipos::runtime {

// MOVILINK on RS-485: 9600 or 57600 baud, 8 data bits, even parity, 1 stop bit (1053 1610 p. 18). Other protocols take
// any rate that the device has.
struct SerialSettings {
  uint32_t baud = 9600;
  bool even_parity = true;
  bool movilink = true;
};

struct ByteArrival {
  Time at = 0;  // host time at which the byte was complete; never decreases
  uint8_t value = 0;
  bool bad = false;  // parity or framing error, or a break
};

// Not SerialPort: that is the interface of a simulated station (runtime/plant).
class BytePort : public Port {
 public:
  // Queues all bytes or, when there is no room, none: then they are lost, counted and told.
  virtual void send(std::span<const uint8_t> bytes) = 0;

  // Fills `into` with what has arrived, in order; the number of bytes, 0 when there is none now. An error is
  // for good. Bytes read in one go are dated back from the moment of reading by one character time each
  // (ours).
  virtual tl::expected<size_t, PortError> receive(std::span<ByteArrival> into) = 0;

  // False: parity is neither sent nor checked; only the block check protects the data then.
  virtual bool has_parity() const = 0;

  // True: each byte takes its time on the wire once it is handed over, so bytes may be handed over early.
  // False: they are at the other end at once.
  virtual bool paces() const = 0;

  // By how much bytes may come late and in groups: what the user says of the adapter.
  virtual Time latency() const = 0;
};

inline constexpr size_t kSerialPortQueue = 4096;  // bytes waiting to be sent (ours)

using SerialPortResult = tl::expected<std::unique_ptr<BytePort>, PortError>;

// `/dev/ttyUSB0`: a device; `pty:/path/line1`: a pseudo-terminal linked at that path; `/dev/ttyUSB0@16ms`:
// one behind an adapter that passes bytes on up to 16 ms late. The clock must outlive the port.
SerialPortResult open_serial_port(std::string_view name, const SerialSettings& settings, RealClock& clock);

}  // namespace ipos::runtime
