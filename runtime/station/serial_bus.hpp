// An RS-485 line of a plant, or RS-232: with it the checks of who talks when.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "runtime/bus/movilink/line_check.hpp"
#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/rs485/line.hpp"
#include "runtime/station/bus.hpp"
#include "runtime/station/last_telegrams.hpp"

namespace ipos::runtime {

class SerialBus final : public Bus, private SerialObserver {
 public:
  static std::optional<std::string> refuse(const std::string& text);

  explicit SerialBus(BusPlace place);
  ~SerialBus() override;

  Rs485Line& line() { return line_; }
  // Kept from the first call on.
  const LastTelegrams& last_telegrams() {
    if (!last_telegrams_) last_telegrams_ = std::make_unique<LastTelegrams>(line_);
    return *last_telegrams_;
  }

  AnyBus self() override { return this; }
  LineLoad load(Time now) const override;
  std::vector<std::string> node_names() const override { return node_names_of(line_); }
  std::vector<std::string> findings(const PlantFile& file) const override;
  Time told_until(Time now) const override {
    return is_observed() && receiver_.receiving() ? receiver_.start() : now;
  }
  void finish() override;
  void attach_hand() override;
  std::optional<std::string> send(const std::string& text) override;
  std::vector<FaultRule> fault_rules() const override;
  FaultConfig make_fault(const WantedFault& wanted) const override;
  bool plant(const FaultConfig& config) override;
  bool repair(const FaultConfig& config) override;

 private:
  class Hand;

  OctetLine wires() const { return octet_line_of(kind()); }

  void watch() override { line_.add_observer(*this); }
  void on_character(const Rs485Line& line, NodeId sender, const Character& character) override;
  void on_serial_event(const Rs485Line& line, const SerialEvent& event) override;
  void tell_reception(const std::optional<Reception>& reception);

  EventQueue& queue_;
  Rs485Line line_;
  LineCheck check_;
  SerialReceiver receiver_;  // for the observers
  std::unique_ptr<Hand> hand_;
  std::unique_ptr<LastTelegrams> last_telegrams_;
};

}  // namespace ipos::runtime
