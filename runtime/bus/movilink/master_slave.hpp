// Master/slave operation over RS-485 (P750, P751, P811; MDX60B/61B p. 29-30, 1053 1610 p. 72, 80): the master
// sends control word and setpoint to its group over and over; a slave (serial_slave.hpp) takes them and
// watches the connection.
#pragma once

#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/bus/movilink/serial_requester.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

// The drive in master/slave operation. Words: control word 1, speed or current setpoint, IPOS PO data.
class MasterSlaveDrive {
 public:
  virtual ProcessWords setpoint_to_send(Time now) = 0;  // master
  virtual void setpoint_received(Time now, const ProcessWords& words) = 0;
  virtual void link_lost(Time now) = 0;  // F43 and emergency stop

 protected:
  ~MasterSlaveDrive() = default;
};

inline constexpr Time kLinkTimeout = 500 * kMillisecond;           // fixed (MDX60B/61B p. 30)
inline constexpr Time kSetpointCycle = 20 * kMillisecond;          // ours: no manual names one for RS-485
inline constexpr TelegramFormat kSetpointFormat{false, 3, false};  // 3PD cyclic

// The master's sender: a cyclic telegram of three words to the group, in turn with other requests of the
// unit.
class SetpointSender final : private EventTarget, private RequesterClient {
 public:
  SetpointSender(EventQueue& queue, uint32_t source, SerialRequester& requester, MasterSlaveDrive& drive)
      : queue_(queue), source_(source), requester_(requester), drive_(drive) {}
  ~SetpointSender() { queue_.cancel_all(*this); }
  SetpointSender(const SetpointSender&) = delete;
  SetpointSender& operator=(const SetpointSender&) = delete;

  void start(Time now, uint8_t group);
  void stop();
  bool running() const { return timer_ != kNoEvent; }

 private:
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void on_request_done(Time now, RequestEnd end, const SerialTelegram* response) override;

  EventQueue& queue_;
  uint32_t source_;
  SerialRequester& requester_;
  MasterSlaveDrive& drive_;
  uint8_t group_ = kNoGroupAddress;
  EventId timer_ = kNoEvent;
  bool waiting_ = false;  // the last telegram is not out yet
};

}  // namespace ipos::runtime
