// The ports of a plant that is served with a world outside: what has come over them goes onto the lines between two
// milliseconds, and what the lines have carried goes out. Such a plant runs a millisecond behind the clock, so that what
// comes within a millisecond is there before it is run. It goes on while a port is away, and takes it again.
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
  // A port that has come or gone.
  struct Change {
    bool there;
    std::string text;  // for the journal; empty: it was told often enough
  };

  static bool has_ports(const runtime::PlantFile& plant);

  // Opens them before the first event; a Failure names one that cannot be had. `file`: of the plant.
  void join(runtime::Plant& plant, const std::string& file);
  // Closes them. The plant must still be there.
  void leave() { joined_.clear(); }
  bool joined() const { return !joined_.empty(); }
  bool joined(const std::string& bus) const;

  // Sends on what the lines have carried.
  void flush();
  // Takes what has come. The plant was at `at` when the clock was at `clock`.
  void collect(WallClock::time_point clock, runtime::Time at);

  // What the ports had to say since the last time, and which of them have come or gone by now.
  std::vector<std::string> take_notes();
  std::vector<Change> take_changes(runtime::Time now);
  // Of each port: its line, its name, whether it is there, since when, and why not.
  Json states() const;

 private:
  struct Joined {
    std::string bus;
    runtime::JoinedPort port;
    std::string absence;  // as told last
    uint64_t changes = 0;
    std::optional<runtime::Time> since;  // nothing: it has been so from the start
  };

  runtime::SystemClock clock_;
  std::vector<Joined> joined_;
};

}  // namespace ipos::tools::serve
