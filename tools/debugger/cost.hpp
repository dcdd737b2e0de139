// What a run from one stop to the next has cost: its time, and the commands of each task. Plain data that goes with the
// session when another process goes on.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/debugger/debugger.hpp"

namespace ipos::tools::debug {

class Cost {
 public:
  // The session begins, or the plant is as at power-on.
  void begin(const Debugger& debugger);
  void stopped(const Debugger& debugger);

  runtime::Time time() const { return now_.time - before_.time; }
  // Of all tasks. A task that was started meanwhile begins to count anew; after a way back nothing is counted.
  uint64_t commands() const;
  // "5.000 ms since the stop before", then a line for each task that executed commands.
  std::string text(const Debugger& debugger) const;

  Json save() const;
  void load(const Json& state);

 private:
  // Commands that each task has executed at a stop, with its interrupt routines.
  struct Spent {
    runtime::Time time = 0;
    std::vector<std::pair<TaskRef, uint64_t>> tasks;
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Spent, time, tasks)
  };
  static Spent spent(const Debugger& debugger);
  uint64_t since(TaskRef task, uint64_t now) const;

  bool has_run_ = false;
  Spent before_, now_;
};

}  // namespace ipos::tools::debug
