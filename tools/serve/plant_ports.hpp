// The ports of a plant that is served with a world outside. Such a plant runs a millisecond behind the clock, so that what
// comes within a millisecond is there before it is run. It goes on while a port is away, and takes it again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/os_port/system_clock.hpp"
#include "runtime/plant_port/join.hpp"
#include "tools/serve/host/outside.hpp"

namespace ipos::tools::serve {

class PlantPorts final : public Ports {
 public:
  static bool has_ports(const runtime::PlantFile& plant);

  void join(runtime::Plant& plant, const std::string& file) override;
  void leave() override { joined_.clear(); }
  bool joined() const override { return !joined_.empty(); }
  bool joined(const std::string& bus) const override;
  void flush() override;
  void collect(WallClock::time_point clock, runtime::Time at) override;
  std::vector<std::string> take_notes() override;
  std::vector<Change> take_changes(runtime::Time now) override;
  Json states() const override;

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
