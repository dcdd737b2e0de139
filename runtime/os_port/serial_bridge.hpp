// Joins a simulated RS-485 line to a real serial port: a station on the line that passes on to the port what
// the simulated stations send, and sends on the line what comes from the port, each byte at its time of
// arrival. Nothing goes back where it came from.
#pragma once

#include <deque>
#include <string>

#include "runtime/bus/movilink/serial_telegram.hpp"
#include "runtime/bus/rs485/line.hpp"
#include "runtime/os_port/byte_bridge.hpp"

namespace ipos::runtime {

// When a byte from outside begins on the line. An adapter that passes bytes on late and in groups makes gaps
// that were not on the wire; so the first byte of a telegram waits as long as the adapter may be late, and
// the others follow without a gap where they are there by then (ours). Without latency every byte keeps its
// time.
class ArrivalPace {
 public:
  ArrivalPace(Time latency, Time character) : latency_(latency), character_(character) {}

  Time begin(const ByteArrival& byte);

 private:
  bool continues(Time at) const;

  Time latency_;
  Time character_;
  SerialBytes telegram_;  // under way; empty between telegrams
  Time last_at_ = 0;
};

class SerialBridge final : public ByteBridge, private SerialNode, private EventTarget {
 public:
  // Attaches itself to the line, under the port's name. `source` orders its events. Line and port must
  // outlive it. Bytes are put up with that are as late as the port's latency or `slack`, the larger of them.
  SerialBridge(EventQueue& queue, uint32_t source, Rs485Line& line, BytePort& port, Time slack = 0);
  ~SerialBridge() override { queue_.cancel_all(*this); }
  SerialBridge(const SerialBridge&) = delete;
  SerialBridge& operator=(const SerialBridge&) = delete;

  std::string_view goods() const override { return "bytes"; }
  size_t waiting() const override { return arrivals_.size(); }
  uint64_t bad_bytes() const { return bad_bytes_; }        // from the port, with parity or framing error
  uint64_t echoed_bytes() const { return echoed_bytes_; }  // from the port, left out

 private:
  struct Echo {
    uint8_t value;
    Time until;
    size_t ends;  // length of the telegram that ends here; 0 within it
  };

  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void on_character(Time now, const Character& character) override;
  void on_sent(Time now) override;

  bool has_room() const override;
  void arrive(const ByteArrival& byte) override;
  std::string crowded() const override;
  bool is_echo(const ByteArrival& byte);
  void forget_echo(Time now);
  void begin_first();
  void pass_on(Time now, std::span<const Character> characters);

  EventQueue& queue_;
  uint32_t source_;
  Rs485Line& line_;
  NodeId node_;
  Time character_;
  ArrivalPace pace_;
  std::deque<ByteArrival> arrivals_;  // `at` is virtual; the first one is on the line or waits for its time
  std::deque<Character> passed_on_;   // before they have ended on the line
  std::deque<Echo> echo_;             // what an adapter that hears itself will give back
  uint64_t bad_bytes_ = 0;
  uint64_t echoed_bytes_ = 0;
  size_t echoed_in_a_row_ = 0;  // so many of the last bytes
};

}  // namespace ipos::runtime
