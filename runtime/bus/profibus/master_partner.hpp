// Whom a master asks in its turn: a slave of DP, or the FMS connections of a station. One request a token.
#pragma once

#include <optional>

#include "runtime/bus/profibus/fdl_frame.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::profibus {

class MasterPartner {
 public:
  // The next request; nothing: it is not its turn.
  virtual std::optional<FdlFrame> request(runtime::Time now) = 0;
  // Exactly one of these follows, after all repetitions.
  virtual void answered(runtime::Time now, const FdlFrame& answer) = 0;
  virtual void unanswered() = 0;
  // What came instead of an answer; the request is repeated, or unanswered() follows.
  virtual void garbled() {}

 protected:
  ~MasterPartner() = default;
};

}  // namespace ipos::profibus
