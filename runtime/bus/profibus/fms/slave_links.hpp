// The connections of a slave on its access points (MOVITRAC 31 PROFIBUS, 4.3.2): octets of a master in, octets of the answer out,
// over the services of the server. A service that takes its time is answered when the master asks again without data. All
// connections are open ones: the first who opens one has it until it ends.
#pragma once

#include <map>
#include <optional>
#include <span>

#include "runtime/bus/profibus/fms/messages.hpp"
#include "runtime/bus/profibus/fms/server.hpp"

namespace ipos::profibus::fms {

struct Partner {
  uint8_t address = 0;
  uint8_t point = 0;
  friend bool operator==(const Partner&, const Partner&) = default;
};

struct LinkAnswer {
  enum class Event : uint8_t { None, Opened, Ended };
  bool refused = false;  // RS: the connection is another partner's
  Octets data;           // none: a short acknowledgement
  Event event = Event::None;
};

class SlaveLinks {
 public:
  explicit SlaveLinks(Server& server) : server_(server) {}

  void power_on() { links_.clear(); }
  // What came on an access point that has a connection.
  LinkAnswer take(Time now, uint8_t lsap, Partner from, std::span<const uint8_t> data);

 private:
  struct Link {
    Partner partner;
    uint8_t invoke = 0;
    Request request;  // under way
  };

  Octets answer(Time now, const Connection& connection, Link& link, std::span<const uint8_t> data);
  Octets initiate(Time now, const Connection& connection, const Link& link, const Message& message);
  Octets request(Time now, const Connection& connection, Link& link, const Pdu& pdu);
  Octets waiting(Time now, const Connection& connection, const Link& link);
  Octets end(const Connection& connection, Reason reason);

  Server& server_;
  std::map<uint8_t, Link> links_;  // by CREF
};

}  // namespace ipos::profibus::fms
