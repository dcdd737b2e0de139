// One SBus connection of a MOVIDRIVE B whose protocol is CANopen (P880, P890 = 1): a node with the address P886 or
// P896, whose process data and parameters are those of the unit.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/canopen/node.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/scom/variable_objects.hpp"
#include "runtime/station/sbus_port.hpp"
#include "runtime/station/unit_server.hpp"
#include "runtime/unit/door.hpp"

namespace ipos::runtime {

class CanopenPort final : public StationPort,
                          private CanNode,
                          private canopen::Unit,
                          private canopen::NodeObserver {
 public:
  // As SbusPort: it attaches to the line, or takes the place `node` of a port that went with a power-off.
  CanopenPort(EventQueue& queue, uint32_t source, CanLine& line, std::optional<NodeId> node, int sbus,
              std::string_view station, const SbusSettings& settings, Door& door, Journal& journal);

  void power_off() override;
  // What goes out on change may go out now: where the tick was more than counting, and where the node follows a word that
  // counts.
  Time tick(Time now) override {
    const uint32_t executed = door_.executed();
    const uint16_t counting = door_.counting_words();
    if (std::exchange(seen_, executed) != executed || node_->follows(counting)) node_->unit_changed(now);
    const OwnMilliseconds& own = door_.milliseconds();
    const int64_t due = objects_.tick(own.number(now), door_.variables_in_turn());
    if (node_->follows(counting)) return now + own.length();
    return due == INT64_MAX ? kNever : own.begin_of(due, now);
  }
  bool has_waiting_frames() const override { return line_.has_waiting(node()); }

  NodeId node() const { return sender_.node(); }
  CanLine& line() const { return line_; }
  const SbusSettings& settings() const { return settings_; }
  const VariableObjects& objects() const { return objects_; }
  const canopen::Node* canopen() const { return node_ ? &*node_ : nullptr; }  // null: power is off

 private:
  void on_frame(Time now, const Frame& frame) override;
  void receive(Time now, const Frame& frame);
  void on_sent(Time now, const Frame& frame, uint64_t tag) override;
  bool minds_repeats() const override { return false; }
  void on_not_sent(Time now, const Frame& frame, uint64_t tag, NotSent reason) override;
  void on_bus_off(Time) override { sender_.recover(); }

  void take_output(Time now, const canopen::Words& words, uint16_t written) override;
  canopen::Words input(Time now, uint16_t which) override;
  canopen::UnitStatus status(Time now) override;
  void synchronize(Time now) override { server_.synchronize(now); }
  void state_changed(Time now, canopen::State state) override;
  void reset_node(Time now) override;
  void partner_lost(Time now) override;
  void partner_back(Time now) override;
  void on_ignored(Time now, const Frame& frame, canopen::IgnoredMessage reason) override;
  // The next tick comes in its turn.
  void follow_again(Time) override { door_.touch(); }
  void note(Time now, Weight weight, std::string text);

  uint32_t seen_ = UINT32_MAX;  // Door::executed() of the last tick
  Door& door_;
  LinePort sender_;
  VariableObjects objects_;
  CanLine& line_;
  int sbus_;
  std::string_view station_;
  SbusSettings settings_;
  Journal& journal_;
  UnitServer server_;
  canopen::Words output_{};  // as the master last sent them
  bool exchanges_ = false;  // outputs have come since the node is operational
  std::optional<canopen::Node> node_;
};

}  // namespace ipos::runtime
