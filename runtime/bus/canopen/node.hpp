// A CANopen node on a CAN line (CiA 301; chapter 5.4 of 11264926): network management, SDO, PDO, SYNC, EMCY,
// guarding and heartbeat before one unit.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "runtime/bus/can/node.hpp"
#include "runtime/bus/canopen/emergency.hpp"
#include "runtime/bus/canopen/error_control.hpp"
#include "runtime/bus/canopen/nmt.hpp"
#include "runtime/bus/canopen/object_access.hpp"
#include "runtime/bus/canopen/object_dictionary.hpp"
#include "runtime/bus/canopen/pdo.hpp"
#include "runtime/bus/canopen/place.hpp"
#include "runtime/bus/canopen/sdo_server.hpp"
#include "runtime/bus/canopen/unit.hpp"

namespace ipos::runtime::canopen {

enum class IgnoredMessage : uint8_t {
#define IGNORED_MESSAGE(name, text) name,
#include "runtime/bus/canopen/ignored.def"
};
std::string_view ignored_text(IgnoredMessage reason);

class NodeObserver {
 public:
  virtual void on_ignored(Time now, const Frame& frame, IgnoredMessage reason) = 0;

 protected:
  ~NodeObserver() = default;
};

// Both ours: the manual prints no times of SDO. The first is that of a MOVILINK parameter telegram.
struct NodeTiming {
  Time sdo_delay = 2 * kMillisecond;
  Time sdo_timeout = kSecond;  // the server gives up a segmented transfer
};

class Node final : private EventTarget,
                   private Timer::Owner,
                   private ObjectAccess::Listener,
                   private ErrorControl::Listener {
 public:
  // `number` is 1..127 (P886, P896).
  Node(const Place& place, uint8_t number, const stdlib::UnitType& type, NodeTiming timing,
       ParameterServer& parameters, Unit& unit, NodeObserver* observer = nullptr);
  ~Node() { place_.queue.cancel_all(*this); }
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  // Power-on: tells the line that it is there, and is pre-operational.
  void start(Time now);

  // True when the frame was for this node.
  bool on_frame(Time now, const Frame& frame);

  // Process input data or the status of the unit may be others than at the last call.
  void unit_changed(Time now);

  // It sends on change, and one of these words matters to it, PI1 in bit 0.
  bool follows(uint16_t words) const {
    return words != 0 && std::any_of(transmit_.begin(), transmit_.end(),
                                     [words](const TransmitPdo& pdo) { return pdo.follows(words); });
  }

  State state() const { return state_; }
  const ObjectDictionary& dictionary() const { return dictionary_; }

 private:
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void on_timer(Time now, uint32_t kind) override;
  void on_written(Time now, Address address, Rule rule) override;
  void on_partner(Time now, bool lost) override;
  bool take_remote(Time now, const Frame& frame);
  bool take_pdo(Time now, const Frame& frame);
  void note_length(Time now, size_t pdo, bool too_short);
  void take_nmt(Time now, const Frame& frame);
  void take_sync(Time now, const Frame& frame);
  void take_sdo(Time now, const Frame& frame);
  void reset_communication(Time now);
  void enter(Time now, State state);
  void listen();
  void ignore(Time now, const Frame& frame, IgnoredMessage reason);
  void send_sdo(const SdoBytes& bytes);

  Place place_;
  NodeTiming timing_;
  Unit& unit_;
  NodeObserver* observer_;
  State state_ = State::BootUp;
  ObjectDictionary dictionary_;
  uint32_t sync_id_ = 0;  // as the dictionary says
  ObjectAccess access_;
  SdoServer server_;
  Timer sdo_timeout_;
  std::array<ReceivePdo, objects::kPdos> receive_;
  std::array<bool, objects::kPdos> too_short_{};  // its last PDO was
  std::array<TransmitPdo, objects::kPdos> transmit_;
  Emergency emergency_;
  ErrorControl error_control_;
};

}  // namespace ipos::runtime::canopen
