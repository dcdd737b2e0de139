// A CAN line of a plant: with it the checks of what the manuals forbid on an SBus.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/movilink/sbus_check.hpp"
#include "runtime/station/bus.hpp"
#include "runtime/station/last_frames.hpp"

namespace ipos::runtime {

class CanBus final : public Bus, private CanObserver, private SbusCheckClient {
 public:
  static std::optional<std::string> refuse(const std::string& text);

  explicit CanBus(BusPlace place);
  ~CanBus() override;

  CanLine& line() { return line_; }
  SbusCheck& check() { return check_; }
  // Kept from the first call on.
  const LastFrames& last_frames() {
    if (!last_frames_) last_frames_ = std::make_unique<LastFrames>(line_);
    return *last_frames_;
  }

  AnyBus self() override { return this; }
  LineLoad load(Time now) const override { return line_.load(now); }
  std::vector<std::string> node_names() const override { return node_names_of(line_); }
  std::vector<std::string> findings(const PlantFile& file) const override;
  void attach_hand() override;
  std::optional<std::string> send(const std::string& text) override;
  std::vector<FaultRule> fault_rules() const override;
  FaultConfig make_fault(const WantedFault& wanted) const override;
  bool plant(const FaultConfig& config) override;
  bool repair(const FaultConfig& config) override;

 private:
  class Hand;
  class Reports;

  NodeId find_node(const std::string& station) const;
  void watch() override { line_.add_observer(static_cast<CanObserver&>(*this)); }
  void on_frame(const CanLine& line, const FrameRecord& record) override;
  void on_line_event(const CanLine& line, const LineEvent& event) override;
  void on_sbus_finding(Time now, std::string text) override { place_.warn(now, std::move(text)); }

  BusPlace place_;
  CanLine line_;
  std::unique_ptr<Reports> reports_;
  SbusCheck check_;
  std::unique_ptr<Hand> hand_;
  std::unique_ptr<LastFrames> last_frames_;
};

}  // namespace ipos::runtime
