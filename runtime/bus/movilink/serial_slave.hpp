// The slave side of one unit on one RS-485 interface (1053 1610 p. 17-34): answers requests to its address
// and to 254, takes those to its group and to 255 in silence, and leaves everything else alone, with a
// reason.
#pragma once

#include "runtime/bus/movilink/handshake.hpp"
#include "runtime/bus/movilink/ignored.hpp"
#include "runtime/bus/movilink/master_slave.hpp"
#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/rs485/node.hpp"

namespace ipos::runtime {

class SerialSlaveObserver {
 public:
  // A telegram that was not received, or not for this unit (SerialError::Address).
  virtual void on_rejected(Time now, const Reception& reception, SerialError error) = 0;
  // A request to this unit that had no effect; `code` is set for a refused group write.
  virtual void on_ignored(Time now, const SerialTelegram& request, Ignored reason, ReturnCode code) = 0;

 protected:
  ~SerialSlaveObserver() = default;
};

struct SerialSlaveSettings {
  uint8_t address = 0;              // P810
  uint8_t group = kNoGroupAddress;  // P811
  bool master_here = false;         // P750: slave setpoints go out here, so no other master is answered
  bool follows_master = false;      // P100 = MASTER-RS-485: the group telegrams are the master's setpoint
};

// Both ours. The pause before SD2 is at least 3.44 ms, the master waits 50 ms for it.
struct SerialSlaveTiming {
  Time response_delay = 4 * kMillisecond;
  Time processing = 2 * kMillisecond;  // of a service in a cyclic telegram
};

class SerialSlave final : private EventTarget {
 public:
  // `drive` hears the setpoints of a master, and when they stop; only with follows_master.
  SerialSlave(EventQueue& queue, uint32_t source, SerialSender& sender, SerialSlaveSettings settings,
              SerialSlaveTiming timing, ParameterServer& parameters, ProcessDataServer& process_data,
              MasterSlaveDrive& drive, SerialSlaveObserver* observer = nullptr);
  ~SerialSlave() { queue_.cancel_all(*this); }
  SerialSlave(const SerialSlave&) = delete;
  SerialSlave& operator=(const SerialSlave&) = delete;

  void configure(SerialSlaveSettings settings) { settings_ = settings; }
  const SerialSlaveSettings& settings() const { return settings_; }
  const SerialStatistics& statistics() const { return statistics_; }

  void on_character(Time now, const Character& character);
  // The unit has missed cyclic requests (P812): an error of the interfaces they came through (ours).
  void count_timeout() {
    if (heard_cyclic_) statistics_.count(SerialError::Timeout);
  }
  void on_sent(Time now);  // this station has sent something: not heard, but the line was busy

 private:
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void take_request(Time now, const Reception& reception);
  void take_setpoint(Time now, const ProcessWords& words);
  void send_answer(Time now);
  void take_parameter(Time now, const SerialTelegram& request, bool answered);
  bool is_for_me(uint8_t address) const;
  void reject(Time now, const Reception& reception, SerialError error);
  void ignore(Time now, const SerialTelegram& request, Ignored reason, ReturnCode code = {});

  EventQueue& queue_;
  uint32_t source_;
  SerialSender& sender_;
  SerialSlaveSettings settings_;
  SerialSlaveTiming timing_;
  ParameterServer& parameters_;
  ProcessDataServer& process_data_;
  MasterSlaveDrive& drive_;
  SerialSlaveObserver* observer_;
  SerialReceiver receiver_;
  SerialStatistics statistics_;
  CyclicChannel cyclic_;
  Time own_end_ = 0;        // of what this station sent last: its echo is no news
  SerialTelegram request_;  // that waits for its answer
  ParameterTelegram acyclic_answer_;
  bool heard_cyclic_ = false;
  EventId answer_ = kNoEvent;
  EventId link_timeout_ = kNoEvent;
};

}  // namespace ipos::runtime
