// The FMS side of the combislave at service level: typed requests over a connection, answers, Abort and Reject
// (MOVITRAC 31 PROFIBUS, 4.1 and 4.3). What they look like on the line is slave_links.hpp.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>

#include "runtime/bus/profibus/fms/service.hpp"

namespace ipos::profibus::fms {

struct Identity {
  std::string_view vendor = "SEW-Eurodrive GmbH & Co";
  std::string_view model = "MOVITRAC";
  std::string_view revision =
      "821000010";  // 821XXYYZZ, the system software of the inverter; these digits are ours
};

class Server {
 public:
  // Ours: what one service of the inverter takes; the card's own objects answer at once.
  static constexpr Time kProcessing = 10 * runtime::kMillisecond;

  Server(ObjectList& objects, bool offered) : objects_(objects), offered_(offered) {}

  // A master opens connection `cref`. On an open connection this ends it: both sides start again.
  Response initiate(Time now, uint8_t cref, uint8_t master, const MasterEntry& entry);
  void abort(uint8_t cref) { open_.erase(cref); }
  void power_on() { open_.clear(); }

  // What comes at once; nothing: response() has it later.
  std::optional<Response> request(Time now, uint8_t cref, const Request& request);
  // The answer of the confirmed service under way, when it is done. Given once.
  std::optional<Response> response(Time now, uint8_t cref);

  // A watched connection on which nothing came for its time is closed; the slave aborts it. True then.
  bool expire(Time now, uint8_t cref);

  bool is_open(uint8_t cref) const { return open_.count(cref) != 0; }
  // Something came on a connection: its control interval begins anew.
  void heard(Time now, uint8_t cref);
  bool connected(Time now) const;  // a watched connection counts for its time
  bool busy() const;  // a service is under way: the green LED flickers
  Identity identity() const { return {}; }

 private:
  struct Pending {
    Response response;
    Time ready;
  };
  struct Open {
    uint8_t master;
    Time heard;
    std::optional<Pending> pending;
  };

  Pending carry_out(Time now, const Request& request);
  static bool is_over(Time now, uint8_t cref, const Open& open);

  ObjectList& objects_;
  bool offered_;
  std::map<uint8_t, Open> open_;
};

}  // namespace ipos::profibus::fms
