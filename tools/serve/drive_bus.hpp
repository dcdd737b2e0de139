// The tab Bus of a real drive: what our own questions put on the bus, and what others say there. It listens to the line
// between the port and the master that asks (tools/links/bus_link.hpp).
#pragma once

#include <functional>
#include <string>

#include "tools/links/bus_link.hpp"
#include "tools/parameters/parameter_access.hpp"
#include "tools/serve/host/bus_traffic.hpp"

namespace ipos::tools::serve {

class DriveBus final : private BusSource {
 public:
  struct Drive {
    ParameterAccess& access;
    std::string name;
    uint8_t address;
  };
  // `now`: since the start of the server. `must_write`: a Mistake says why this client may not.
  DriveBus(Router& router, Copies& copies, BusLink& link, const Drive& drive, std::function<runtime::Time()> now,
           std::function<void(const Router::Call&)> must_write);

  Json describe() const;  // the line, as in the reply to `plant`
  const std::string& line() const;
  void publish(Client& client, Subscription& subscription) const;  // of the topic `plant`
  // Once a turn of the loop; `waits`: hears what comes while nothing is asked.
  void turn(bool waits);

 private:
  runtime::Time line_now() const override { return link_.now(); }
  runtime::Time shown(runtime::Time of_line) const override { return now_() - (link_.now() - of_line); }
  bool is_ours(const std::string&, const std::string& node) const override {
    return node == BusLink::kNode || node == kPageNode;
  }
  void send(const Router::Call& call) override;
  // What the process data words mean; a drive that was silent is asked again.
  void ask_names();
  runtime::LineLoad load() const;

  Router& router_;
  BusLink& link_;
  Drive drive_;
  std::function<runtime::Time()> now_;
  std::function<void(const Router::Call&)> must_write_;
  runtime::TelegramNames names_;  // of the drive
  bool known_ = false;            // all of them
  BusTraffic traffic_;
  runtime::Time next_second_ = runtime::kSecond;
};

}  // namespace ipos::tools::serve
