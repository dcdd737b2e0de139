// Follows the programs of a plant command by command, and the waits of their tasks millisecond by millisecond. The run stays
// what it is, it takes longer.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "runtime/plant/plant.hpp"
#include "tools/profile/profile.hpp"

namespace ipos::tools::profile {

class Profiler final : private runtime::CommandRunner {
 public:
  // Before the plant runs; every millisecond has to be executed in its turn (Pace::InTurn), or waits are not seen. It must
  // outlive the plant's last event. A station has room for one such runner: with this one neither the debugger nor coverage.
  explicit Profiler(runtime::Plant& plant);
  Profiler(const Profiler&) = delete;
  Profiler& operator=(const Profiler&) = delete;

  // Of all that was executed so far, the stations in their order; tasks that never ran are left out.
  std::vector<Task> tasks() const;

 private:
  struct Place {
    size_t function = 0;
    Line line;
  };
  struct Frame {
    size_t function = 0;
    size_t parent = SIZE_MAX;
    uint64_t calls = 0;
    std::map<uint32_t, Cost> costs;  // by the address of the command
  };
  // A context is in this frame, as deep as it was seen last.
  struct Stand {
    size_t frame = SIZE_MAX;
    int depth = 0;
  };
  struct Tally {
    const runtime::Station* station;
    std::vector<Place> places;  // of each code word
    std::vector<std::string> functions;
    std::array<std::vector<Frame>, vm::kTasks> frames;
    std::array<Stand, vm::kContexts> stands{};

    size_t entered(int task, size_t parent, size_t function);
    Frame& frame_of(const vm::TaskContext& context, int number);
  };

  bool run(runtime::Station& station, vm::Machine& machine, vm::TickSteps& steps) override;

  std::vector<Tally> tallies_;
  std::map<const runtime::Station*, size_t> numbers_;
};

}  // namespace ipos::tools::profile
