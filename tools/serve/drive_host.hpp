// The process of `ipos serve --device` that has the line to a real drive: watch, scope, parameters and manual operation over
// the parameter channel and process data. It only reads unless the command line allows more and the client has
// confirmed it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/serve/desk.hpp"
#include "tools/serve/drive_bus.hpp"
#include "tools/serve/drive_scope.hpp"
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

 private:
  struct Jog {
    uint16_t client = 0;
    std::array<uint16_t, 3> words{};
    WallClock::time_point ends{};
    WallClock::time_point next{};
    std::vector<std::pair<uint16_t, int32_t>> before;  // control and setpoint source, to be given back
  };

  void add_commands();
  void must_write(const Desk::Call& call) const;  // a Mistake says why not
  Json describe() const;
  Json watch(const Desk::Call& call);
  void publish_watch(Client& client, Subscription& subscription);
  void publish_parameters(Client& client, Subscription& subscription);
  Json jog(const Desk::Call& call);
  void take_control(Jog& jog);
  void end_jog();
  void send_words(const std::array<uint16_t, 3>& words);
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
  std::optional<Jog> jog_;
  DriveScope scope_;
  DriveBus bus_;
  WallClock::time_point next_time_{};  // event
};

}  // namespace ipos::tools::serve
