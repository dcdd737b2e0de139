// Looks at an RS-485 line for what its stations do against the rules (1053 1610 p. 17-22): more than one
// master, too short a pause after a broadcast or after a request that was broken off. It also counts the
// telegrams.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/rs485/line.hpp"

namespace ipos::runtime {

class LineCheck final : public SerialObserver {
 public:
  using Report = std::function<void(Time now, std::string text)>;
  explicit LineCheck(Report report) : report_(std::move(report)) {}

  uint64_t telegrams() const { return telegrams_; }

  void on_character(const Rs485Line& line, NodeId sender, const Character& character) override;
  void on_serial_event(const Rs485Line& line, const SerialEvent& event) override;

 private:
  void take(const Rs485Line& line, NodeId sender, const Reception& reception);
  void check_masters(const Rs485Line& line, NodeId one, NodeId other, Time now);
  void check_pauses(const Rs485Line& line, const Reception& reception);

  Report report_;
  SerialReceiver receiver_;
  uint64_t telegrams_ = 0;
  std::optional<NodeId> master_;
  std::optional<SerialEvent> collision_;  // the last one, until a single station is heard
  std::optional<Time> broadcast_end_;
  std::set<std::pair<NodeId, OctetFaultKind>> told_;  // planted faults, each once
  std::optional<Time> broken_off_;  // end of a request that was not completed
};

}  // namespace ipos::runtime
