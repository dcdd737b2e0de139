// A toy among the kinds of bus, as small as one can be: a telegram of three octets goes round from station to station
// until it has come to its address, and one telegram goes round at a time. Everything that a kind of bus needs is in
// this folder; the test counts what else has to be touched (docs/inside/architecture.md).
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/station/bus.hpp"

namespace ipos::runtime {

// Addresses are the numbers of stations in the ring, from 0.
struct RingTelegram {
  uint8_t from = 0;
  uint8_t to = 0;
  uint8_t value = 0;
};

class RingNode {
 public:
  virtual void on_telegram(Time now, const RingTelegram& telegram) = 0;

 protected:
  ~RingNode() = default;
};

class RingBus final : public Bus, private EventTarget {
 public:
  static std::optional<std::string> refuse(const std::string& text);

  explicit RingBus(BusPlace place);
  ~RingBus() override;

  AnyBus self() override { return this; }
  LineLoad load(Time now) const override;
  std::vector<std::string> node_names() const override { return names_; }
  std::vector<std::string> findings(const PlantFile& file) const override;
  void attach_hand() override;
  std::optional<std::string> send(const std::string& text) override;
  std::vector<FaultRule> fault_rules() const override;
  FaultConfig make_fault(const WantedFault& wanted) const override;
  bool plant(const FaultConfig& config) override;

  NodeId attach(std::string name, RingNode& node);
  void send(NodeId from, uint8_t to, uint8_t value);
  Time hop() const { return 30 * kSecond / baud(); }  // three octets with start and stop bit

  // What has come to an address so far.
  struct Arrived {
    RingTelegram last;
    uint64_t count = 0;
  };
  const Arrived& arrived(uint8_t to) { return arrived_[to]; }

 private:
  class Hand;

  void watch() override {}
  void on_event(Time now, uint32_t node, uint64_t) override;  // the telegram has come to a node
  void begin();
  void end(Time now, std::string meaning);

  BusPlace place_;
  std::vector<std::string> names_;
  std::vector<RingNode*> nodes_;
  std::deque<RingTelegram> waiting_;  // the first is under way
  std::map<uint8_t, Arrived> arrived_;
  LoadMeter meter_;
  uint64_t ended_ = 0;
  std::optional<FaultConfig> cut_;
  std::unique_ptr<Hand> hand_;
};

}  // namespace ipos::runtime
