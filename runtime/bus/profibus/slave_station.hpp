// A slave on a line: finds the rate, answers after min Tsdr, keeps the watchdog, and shows it all on the LEDs.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/bus/profibus/baud_search.hpp"
#include "runtime/bus/profibus/card.hpp"
#include "runtime/bus/profibus/dp_slave.hpp"
#include "runtime/bus/profibus/line.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::profibus {

class SlaveStation final : public Node, private runtime::EventTarget {
 public:
  // Ours: the manual says only that the phase is short, and how fast a slave answers is between min and max
  // Tsdr.
  static constexpr Time kInitialisation = runtime::kSecond;

  SlaveStation(runtime::EventQueue& queue, uint32_t source, Line& line, std::string name,
               const OptionType& option, CardSwitches switches, SlaveUnit& unit,
               SlaveObserver* observer = nullptr);
  ~SlaveStation() { queue_.cancel_all(*this); }
  SlaveStation(const SlaveStation&) = delete;
  SlaveStation& operator=(const SlaveStation&) = delete;

  DpSlave& slave() { return slave_; }
  const DpSlave& slave() const { return slave_; }
  LatchedSwitches& switches() { return switches_; }
  const LatchedSwitches& switches() const { return switches_; }
  NodeId node() const { return node_; }
  const BaudSearch& rate() const { return rate_; }

  void power_off();
  // Mains off and on; with the 24 V kept the card goes on with its old switches.
  void power_on(bool supply_was_kept);
  // Bit times from the end of a request to the answer, where min Tsdr is not longer.
  void set_reaction(Bits bits) { reaction_ = bits; }
  // Also what the card sees of itself and of FMS.
  void set_hardware_fault(HardwareFault fault) { hardware_ = fault; }
  CardState card_state(Time now) const;

  void on_reception(Time now, const Reception& reception) override;
  void on_sent(Time) override {}
  void on_fault(Time now, OctetFaultKind kind, bool on) override;

 private:
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void search_rate();
  void watch();

  runtime::EventQueue& queue_;
  uint32_t source_;
  Line& line_;
  const OptionType& option_;
  SlaveObserver* observer_;
  LatchedSwitches switches_;
  DpSlave slave_;
  NodeId node_;
  BaudSearch rate_;
  Bits reaction_ = 0;
  Time powered_at_ = 0;
  HardwareFault hardware_ = HardwareFault::None;
  runtime::EventId watchdog_ = runtime::kNoEvent;
  Time watchdog_at_ = 0;
};

}  // namespace ipos::profibus
