// The process of `ipos serve --device` that has the line to a real drive: watch, scope, parameters and manual operation over
// the parameter channel and process data. It only reads unless the command line allows more and the client has
// confirmed it.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/serve/desk.hpp"
#include "tools/serve/drive_bus.hpp"
#include "tools/serve/drive_scope.hpp"
#include "tools/serve/manual_operation.hpp"
#include "tools/unit/bus_link.hpp"
#include "tools/unit/live_values.hpp"
#include "tools/unit/parameter_access.hpp"

namespace ipos::tools::serve {

class DriveHost {
 public:
  struct Options {
    uint8_t address = 0;
    std::string unit;  // empty: the unit is asked
    bool may_write = false;
    std::string version;
  };
  DriveHost(std::unique_ptr<BusLink> link, Options options, Post& post);
  ~DriveHost();

  // Until nobody listens any more.
  void run();
  Desk& desk() { return desk_; }

 private:
  void add_commands();
  void must_write(const Desk::Call& call) const;  // a Mistake says why not
  void must_stand() const;                        // the same, while the drive is moved
  // Before every question to the drive: takes what has come, does at once what must not wait, and moves or stops the drive.
  void attend();
  bool overtakes(const Letter& letter);
  void keep(Letter letter);
  Json manual() const;
  void tell_manual();
  Json describe() const;
  Json watch(const Desk::Call& call);
  void publish_watch(Client& client, Subscription& subscription);
  void publish_parameters(Client& client, Subscription& subscription);
  Json jog(const Desk::Call& call);
  int64_t us() const;
  std::string name() const;
  Json time() const;

  Post& post_;
  Desk desk_;
  Options options_;
  BusLink& link_;
  std::unique_ptr<ParameterAccess> access_;
  WallClock::time_point begin_ = WallClock::now();
  std::map<uint16_t, std::vector<LiveItem>> watched_;  // by client
  std::deque<Letter> waiting_;                         // letters that are not carried out yet
  WallClock::time_point arrived_{};                    // of the message that is carried out
  bool writes_ = false;                                // an order that writes for long is under way
  DriveScope scope_;
  DriveBus bus_;
  ManualOperation manual_;
  std::string told_;                   // of manual operation, to all
  WallClock::time_point next_time_{};  // event
};

}  // namespace ipos::tools::serve
