// Looks at the telegrams of an SBus and says what is against the rules of the manuals: an identifier with two
// senders, two masters at a time, addresses nobody or two units have, PO-sync outside of its window.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "runtime/bus/can/node.hpp"
#include "runtime/bus/movilink/profile.hpp"

namespace ipos::runtime {

class SbusCheckClient {
 public:
  virtual void on_sbus_finding(Time now, std::string text) = 0;

 protected:
  ~SbusCheckClient() = default;
};

// Observes one line; each finding is told once.
class SbusCheck final : public CanObserver {
 public:
  // `units_outside`: the line has a port, so an address that no station here has may be that of a unit there.
  explicit SbusCheck(SbusCheckClient& client, bool units_outside = false);

  // All units of the line, before the first frame.
  void add_slave(Time now, const CanLine& line, NodeId node, const SlaveSettings& settings);

  void on_frame(const CanLine& line, const FrameRecord& record) override;
  void on_line_event(const CanLine&, const LineEvent&) override {}

 private:
  struct Slave {
    NodeId node;
    SlaveSettings settings;
  };
  struct Exchange {  // a request that waits for its answer
    NodeId master;
    uint32_t answer;
    Time until;
  };

  struct Identifier {
    NodeId sender;  // the first one, or kNoNode; without a value of its own, so that all are copied in one piece
    bool watched;   // its telegrams mean something to the checks
  };

  static const std::vector<Identifier>& unheard();
  void check_telegram(const CanLine& line, const FrameRecord& record);
  void tell_second_sender(const CanLine& line, const FrameRecord& record, NodeId first);
  void check_address(const CanLine& line, const FrameRecord& record, const SbusIdentifier& identifier);
  // `answer`: of the request that the telegram is.
  void check_masters(const CanLine& line, const FrameRecord& record, std::optional<uint32_t> answer);
  void check_window(const CanLine& line, const FrameRecord& record, uint8_t address);  // of synchronous process data
  void tell(Time now, std::string text);

  SbusCheckClient& client_;
  bool units_outside_;
  std::vector<Slave> slaves_;
  std::vector<uint32_t> sync_ids_;  // of the slaves, each once
  std::vector<Identifier> identifiers_;  // of all standard identifiers
  std::set<std::pair<uint32_t, NodeId>> told_;  // identifier and second sender
  std::set<std::pair<NodeId, NodeId>> told_masters_;
  std::vector<Exchange> open_;
  std::map<uint32_t, Time> syncs_;  // start of the last telegram, by identifier
};

}  // namespace ipos::runtime
