// Counts the commands that the stations of a plant execute. The run stays what it is, it takes longer.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "runtime/plant/plant.hpp"
#include "tools/coverage/coverage.hpp"
#include "tools/coverage/fold.hpp"

namespace ipos::tools::coverage {

class Collector final : private runtime::CommandRunner {
 public:
  // Before the plant runs; it must outlive the plant's last event, not the other way round. Stations without
  // a program, and those whose image has no line table, are left out. A station has room for one such runner:
  // with this one it cannot be debugged.
  explicit Collector(runtime::Plant& plant);
  Collector(const Collector&) = delete;
  Collector& operator=(const Collector&) = delete;

  // Of all that was executed so far, by every station.
  Coverage coverage() const;
  // No station has a program that knows its source.
  bool empty() const { return tallies_.empty(); }

 private:
  struct Tally {
    vm::Image image;
    std::vector<uint32_t> next;  // of each command the one after it
    std::vector<bool> calls;     // what it jumps to is a function
    std::vector<CommandCount> counts;
    std::array<bool, vm::kContexts> called{};  // the last command of the context was a call
  };

  bool run(runtime::Station& station, vm::Machine& machine, vm::TickSteps& steps) override;

  std::map<const runtime::Station*, Tally> tallies_;
};

}  // namespace ipos::tools::coverage
