// How a node and its partners know of each other that they live (page 54 of 11264926): the boot-up message,
// guarding or the heartbeat it produces, and the heartbeat of one other node that it listens for.
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/bus/canopen/nmt.hpp"
#include "runtime/bus/canopen/object_dictionary.hpp"
#include "runtime/bus/canopen/place.hpp"

namespace ipos::runtime::canopen {

class ErrorControl final : private Timer::Owner {
 public:
  class Listener {
   public:
    virtual void on_partner(Time now, bool lost) = 0;

   protected:
    ~Listener() = default;
  };

  // `state` is that of the node.
  ErrorControl(const Place& place, const ObjectDictionary& dictionary, const State& state,
               Listener& listener);

  void boot_up(Time now);    // tells of itself; what was set before is forgotten
  void configure(Time now);  // its entries have changed

  // A guarding request. False when it stays unanswered: the node produces heartbeats.
  bool on_remote(Time now);

  std::optional<uint8_t> partner() const { return partner_; }  // whose heartbeat is awaited
  void on_heartbeat(Time now);                                 // of the partner

 private:
  void on_timer(Time now, uint32_t kind) override;
  void send(uint8_t byte);
  void miss(Time now, uint32_t kind, bool lost);

  Place place_;
  const ObjectDictionary& dictionary_;
  const State& state_;
  Listener& listener_;
  uint8_t toggle_ = 0;
  Time period_ = 0;     // of the heartbeat it produces
  Time life_time_ = 0;  // of guarding
  std::optional<uint8_t> partner_;
  Time partner_time_ = 0;
  uint32_t missed_ = 0;  // a bit each for guarding and the heartbeat of the partner
  Timer produce_;
  Timer guard_;
  Timer consume_;
};

}  // namespace ipos::runtime::canopen
