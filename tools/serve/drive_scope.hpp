// The tab Scope of a real drive: parameters and variables, asked for one after the other as fast as the bus answers. A
// channel keeps its value until the next answer.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tools/parameters/parameter_access.hpp"
#include "tools/serve/host/scope.hpp"

namespace ipos::tools::serve {

class DriveScope final : private ScopeSource {
 public:
  // `now`: time since the start, in whole milliseconds.
  DriveScope(Router& router, Copies& copies, ParameterAccess& access, std::string station, std::function<runtime::Time()> now);

  // Somebody looks, has looked a short while ago, or waits for the trigger.
  bool wanted();
  // Asks the drive for one channel, and records up to now.
  void sample();

 private:
  // False where the drive does not answer: then it is tried again at the next turn in which somebody looks.
  bool begin();
  std::vector<signals::Signal> find_channels(const std::string& name) override;
  runtime::Time now() const override { return now_(); }
  void watch_for(const std::string& kind, const Arguments& settings) override;
  void stop(const std::string& why) override;

  Router& router_;
  ParameterAccess& access_;
  std::string station_;
  std::function<runtime::Time()> now_;
  std::map<uint16_t, int64_t> last_;             // the last answers, by index
  std::map<std::string, uint16_t> index_names_;  // of channels and trigger, by signal
  Scope scope_;
  size_t next_ = 0;               // of the channels
  runtime::Time recorded_ = 0;    // up to here
  runtime::Time looked_ = 0;      // when somebody did last
  bool was_wanted_ = false;
};

}  // namespace ipos::tools::serve
