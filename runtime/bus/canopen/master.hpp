// A model master: brings the nodes of a line up (parameters and PDO mapping over SDO, NMT start), sends SYNC and
// process data, guards the nodes or listens to their heartbeat, and keeps what they say.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/canopen/mapping.hpp"
#include "runtime/bus/canopen/nmt.hpp"
#include "runtime/bus/canopen/pdo.hpp"
#include "runtime/bus/canopen/place.hpp"
#include "runtime/bus/canopen/sdo_client.hpp"
#include "runtime/bus/canopen/unit.hpp"

namespace ipos::runtime::canopen {

struct SdoWrite {
  Address address;
  uint32_t value = 0;
  uint8_t bytes = 4;
  friend bool operator==(const SdoWrite&, const SdoWrite&) = default;
};

// One PDO of a node as the master wants it. An empty mapping switches it off.
struct PdoPlan {
  uint8_t number = 0;  // 0..3
  bool transmit = false;
  uint8_t type = 1;
  uint16_t inhibit = 0;  // of a transmit PDO, 100 us
  uint16_t event = 0;    // of a transmit PDO, ms
  Mapping mapping;
};

// The writes of a remapping, in the order that a node asks for: off, settings, mapping, on.
std::vector<SdoWrite> remapping(const PdoPlan& plan, uint8_t node);

struct NodePlan {
  uint8_t node = 1;
  std::vector<PdoPlan> pdos;     // others than the node has by itself
  std::vector<SdoWrite> writes;  // before it is started, ahead of the PDOs
  uint16_t guard_time = 0;       // ms, with life_factor; 0: no guarding
  uint8_t life_factor = 0;
  uint16_t heartbeat = 0;  // ms, produced by the node; 0: none
  Words output{};          // what it is sent
};

struct MasterSettings {
  uint8_t node = 127;      // its own number, for heartbeats
  uint16_t heartbeat = 0;  // ms, produced by the master and awaited by the nodes for twice as long; 0: none
  Time sync_cycle = 0;     // 0: no SYNC
  Time sdo_timeout = 500 * kMillisecond;
  std::vector<NodePlan> nodes;
};

// What happens to the nodes, in words.
class MasterObserver {
 public:
  virtual void on_node(Time now, bool wrong, std::string text) = 0;

 protected:
  ~MasterObserver() = default;
};

class Master final : public CanNode, private Timer::Owner {
 public:
  enum class Phase : uint8_t {
    Silent,       // no boot-up yet
    Configuring,  // its writes are under way
    Running,      // operational
    Refused,      // a write failed; it is not started
    Lost          // it did not answer in time; boot-up starts again
  };
  struct Event {  // an EMCY of a node
    Time time;
    uint16_t code;
    uint8_t error_register;
    std::array<uint8_t, 5> more;
  };
  struct NodeReport {
    Phase phase = Phase::Silent;
    std::optional<uint8_t> state;  // as it last said
    Address refused;               // the object of a failed write, and the abort code
    uint32_t abort = 0;
    Words input{};
    uint64_t pdos = 0;  // received
    uint32_t boot_ups = 0;
    uint32_t losses = 0;
    std::vector<Event> emergencies;
  };

  Master(EventQueue& queue, uint32_t source, MasterSettings settings, MasterObserver* observer = nullptr);
  ~Master() = default;
  Master(const Master&) = delete;
  Master& operator=(const Master&) = delete;

  void start(Time now, FrameSender& sender);  // resets the communication of all nodes
  void command(NmtCommand command, uint8_t node);
  void set_output(size_t node, const Words& words) { settings_.nodes[node].output = words; }

  const MasterSettings& settings() const { return settings_; }
  const NodeReport& report(size_t node) const { return links_[node].report; }
  uint64_t syncs() const { return syncs_; }

  void on_frame(Time now, const Frame& frame) override;
  void on_sent(Time, const Frame&, uint64_t) override {}
  bool minds_repeats() const override { return false; }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  void on_bus_off(Time) override { sender_->recover(); }

 private:
  struct Link {  // to one node
    NodeReport report;
    SdoClient client;
    std::vector<SdoWrite> writes;
    size_t next = 0;
    std::array<PdoLayout, objects::kPdos> receive, transmit;  // as the node has them in the end
    std::optional<uint8_t> toggle;                          // of the next guarding answer
    std::optional<Timer> sdo_timer, guard_timer, life_timer;
  };

  void on_timer(Time now, uint32_t kind) override;
  void cycle(Time now);
  void take(Time now, size_t node, Connection connection, const Frame& frame);
  void boot(Time now, size_t node);
  void write_next(Time now, size_t node);
  void take_answer(Time now, size_t node, const Frame& frame);
  void take_life(Time now, size_t node, uint8_t byte);
  void watch(Time now, size_t node);
  void send_sdo(Time now, size_t node, const SdoBytes& bytes);
  void send_outputs(size_t node);
  void lose(Time now, size_t node, std::string_view why);
  void tell(Time now, size_t node, bool wrong, std::string_view text);

  EventQueue& queue_;
  uint32_t source_;
  MasterSettings settings_;
  MasterObserver* observer_;
  FrameSender* sender_ = nullptr;
  std::deque<Link> links_;  // timers do not move
  std::optional<Timer> sync_timer_, heartbeat_timer_;
  uint64_t syncs_ = 0;
};

}  // namespace ipos::runtime::canopen
