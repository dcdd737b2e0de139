// A PROFIBUS line of a plant.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "runtime/bus/profibus/line.hpp"
#include "runtime/station/bus.hpp"
#include "runtime/station/fms_operator.hpp"
#include "runtime/station/last_dp_frames.hpp"

namespace ipos::runtime {

class ProfibusBus final : public Bus, private profibus::LineObserver {
 public:
  static std::optional<std::string> refuse(const std::string& text);

  explicit ProfibusBus(BusPlace place);
  ~ProfibusBus() override;

  profibus::Line& line() { return line_; }
  // Kept from the first call on.
  const LastDpTraffic& last_frames() {
    if (!last_frames_) last_frames_ = std::make_unique<LastDpTraffic>(line_);
    return *last_frames_;
  }
  uint32_t source() const { return place_.source; }  // of its events
  // Made with the first call, with the first address that `taken` has not.
  FmsOperator& fms_operator(const std::set<uint8_t>& taken);

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

  void watch() override { watched_ = true; }
  void on_frame(const profibus::Line& line, NodeId sender, const profibus::Reception& reception) override;
  void on_line_event(const profibus::Line& line, const profibus::LineEvent& event) override;

  BusPlace place_;
  profibus::Line line_;
  std::unique_ptr<Hand> hand_;
  std::unique_ptr<FmsOperator> fms_operator_;
  std::unique_ptr<LastDpTraffic> last_frames_;
  bool watched_ = false;         // frames are to be told; it observes for the journal anyway
  std::vector<uint64_t> facts_;  // of the last frame, for tracers
  // Each is told once.
  std::set<std::tuple<profibus::LineEventKind, NodeId, std::optional<OctetFaultKind>>> told_;
};

}  // namespace ipos::runtime
