// The ports of a plant that is served with a world outside: what has come over them goes onto the lines between two
// milliseconds, and what the lines have carried goes out. Such a plant runs a millisecond behind the clock, so that what
// comes within a millisecond is there before it is run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/os_port/system_clock.hpp"
#include "runtime/plant_port/join.hpp"
#include "tools/serve/desk.hpp"

namespace ipos::tools::serve {

class PlantPorts {
 public:
  static bool has_ports(const runtime::PlantFile& plant);

  // Opens them before the first event; a Failure names one that cannot be had. `file`: of the plant.
  void join(runtime::Plant& plant, const std::string& file);
  bool joined() const { return !joined_.empty(); }

  // Sends on what the lines have carried. What went wrong since the last time, in words; `gone` when a port has.
  std::vector<std::string> flush(bool& gone);
  // Takes what has come. The plant was at `at` when the clock was at `clock`.
  void collect(WallClock::time_point clock, runtime::Time at);

 private:
  runtime::SystemClock clock_;
  std::vector<runtime::JoinedPort> joined_;
  bool gone_ = false;
};

}  // namespace ipos::tools::serve
