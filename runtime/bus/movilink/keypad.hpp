// A keypad (DBG11A, DBG60B) at the XT or TERMINAL socket: it sends requests all the time and so keeps the
// RS-485 monitoring of its unit alive (1053 1610 p. 27, MDX60B/61B p. 19). Cyclic requests without a service
// to address 254, ten a second (ours: the manuals print neither).
#pragma once

#include "runtime/bus/movilink/serial_requester.hpp"
#include "runtime/bus/rs485/line.hpp"

namespace ipos::runtime {

inline constexpr Time kKeypadCycle = 100 * kMillisecond;

class Keypad final : private SerialNode, private EventTarget, private RequesterClient {
 public:
  Keypad(EventQueue& queue, uint32_t source, Rs485Line& line)
      : queue_(queue),
        source_(source),
        port_(line, line.attach("keypad", line.baud(), *this)),
        requester_(queue, source, port_) {
    queue_.schedule(queue_.now(), source_, *this, 0);
  }

  // The unit feeds it.
  void set_powered(bool powered) { powered_ = powered; }

 private:
  void on_character(Time now, const Character& character) override {
    requester_.on_character(now, character);
  }
  void on_sent(Time now) override { requester_.on_sent(now); }
  void on_request_done(Time, RequestEnd, const SerialTelegram*) override {}
  void on_event(Time now, uint32_t, uint64_t) override {
    SerialTelegram request;
    request.address = kUniversalAddress;
    request.format = {true, 0, false};
    request.parameter = parameter_request(Service::None, 0, 0, 0);
    if (powered_ && !requester_.busy()) requester_.start(now, request, *this);
    queue_.schedule(now + kKeypadCycle, source_, *this, 0);
  }

  EventQueue& queue_;
  uint32_t source_;
  SerialLinePort port_;
  SerialRequester requester_;
  bool powered_ = true;
};

}  // namespace ipos::runtime
