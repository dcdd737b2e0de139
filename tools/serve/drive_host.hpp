// The process of `ipos serve --device` that has the line to a real drive: watch, scope, parameters and manual operation over
// the parameter channel and process data. It only reads unless the command line allows more and the client has
// confirmed it.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/links/bus_link.hpp"
#include "tools/links/live_values.hpp"
#include "tools/parameters/parameter_access.hpp"
#include "tools/serve/channel.hpp"
#include "tools/serve/drive_bus.hpp"
#include "tools/serve/drive_scope.hpp"
#include "tools/serve/host/copies.hpp"
#include "tools/serve/host/parameter_tab.hpp"
#include "tools/serve/host/router.hpp"
#include "tools/serve/host/watch_tab.hpp"
#include "tools/serve/manual_operation.hpp"

namespace ipos::tools::serve {

class DriveHost final : private ParameterSource, private WatchSource {
 public:
  struct Options {
    uint8_t address = 0;
    std::string unit;  // empty: the unit is asked
    bool may_write = false;
    std::string version;
  };
  DriveHost(std::unique_ptr<BusLink> link, Options options, Mailbox& mailbox);
  ~DriveHost();

  // Until nobody listens any more.
  void run();
  Router& router() { return router_; }

 private:
  void add_commands();
  void must_write(const Router::Call& call) const;  // a Mistake says why not
  void must_stand() const;                        // the same, while the drive is moved
  // Before every question to the drive: takes what has come, does at once what must not wait, and moves or stops the drive.
  void attend();
  bool overtakes(const Message& message);
  void keep(Message message);
  Json manual() const;
  void tell_manual();
  Json describe() const;
  // For the tab Parameters.
  std::shared_ptr<ParameterAccess> unit(const Arguments& arguments, const char* key) override;
  std::string station(const Arguments&) const override { return name(); }
  bool answers_at_once() const override { return false; }
  bool others_wait() const override { return !waiting_.empty(); }
  void check_reading() const override { must_stand(); }
  void check_writing(const Router::Call& call) const override;
  void write(const Json& order) override;
  Json write_file(const Json& order) override;
  // For the tab Watch.
  std::vector<signals::Signal> find(const std::string& asked) override;
  Json row(const signals::Signal& signal) const override;
  Json value(const signals::Signal& signal) override;
  Json set(const Router::Call& call) override;
  size_t most() const override { return 100; }
  int64_t us() const override;
  Json jog(const Router::Call& call);
  std::string name() const;
  Json time() const;

  Mailbox& mailbox_;
  SteadyClock clock_;
  Copies copies_;  // none
  Router router_;
  Options options_;
  BusLink& link_;
  std::unique_ptr<ParameterAccess> access_;
  WallClock::time_point begin_ = WallClock::now();
  std::map<std::string, Target> targets_;                // of watched names
  std::deque<Message> waiting_;                         // messages that are not carried out yet
  WallClock::time_point arrived_{};                    // of the message that is carried out
  bool writes_ = false;                                // an order that writes for long is under way
  DriveScope scope_;
  DriveBus bus_;
  ParameterTab parameters_;
  WatchTab watch_;
  ManualOperation manual_;
  std::string told_;                   // of manual operation, to all
  WallClock::time_point next_time_{};  // event
};

}  // namespace ipos::tools::serve
