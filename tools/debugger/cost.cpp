// Counters of two stops and their difference.
#include "tools/debugger/cost.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::tools::debug {

Cost::Spent Cost::spent(const Debugger& debugger) {
  Spent all{debugger.position().time, {}};
  for (const TaskRef task : debugger.tasks(true)) {
    const vm::Machine& machine = *debugger.machine(task.station);
    uint64_t commands = 0;
    for (int context = 1; context <= vm::kContexts; ++context)
      if (machine.context(context).task == task.task) commands += machine.context(context).commands;
    all.tasks.emplace_back(task, commands);
  }
  return all;
}

void Cost::begin(const Debugger& debugger) {
  has_run_ = false;
  before_ = now_ = spent(debugger);
}

void Cost::stopped(const Debugger& debugger) {
  has_run_ = true;
  before_ = std::exchange(now_, spent(debugger));
}

// A start of the task begins to count anew, and so does a way back.
uint64_t Cost::since(TaskRef task, uint64_t now) const {
  const auto from = std::find_if(before_.tasks.begin(), before_.tasks.end(), [&](const auto& one) { return one.first == task; });
  return from == before_.tasks.end() || from->second > now ? now : now - from->second;
}

uint64_t Cost::commands() const {
  if (now_.time < before_.time) return 0;
  uint64_t all = 0;
  for (const auto& [task, commands] : now_.tasks) all += since(task, commands);
  return all;
}

std::string Cost::text(const Debugger& debugger) const {
  if (!has_run_) return "nothing has run since the session began\n";
  if (now_.time < before_.time) return "time went back to this stop\n";
  std::string text = fmt::format("{:.3f} ms since the stop before\n", static_cast<double>(now_.time - before_.time) / 1e6);
  for (const auto& [task, commands] : now_.tasks)
    if (const uint64_t own = since(task, commands); own != 0)
      text += fmt::format("  {}: {} commands\n", debugger.task_name(task), own);
  return text;
}

Json Cost::save() const { return {{"ran", has_run_}, {"before", before_}, {"now", now_}}; }

void Cost::load(const Json& state) {
  has_run_ = state["ran"];
  before_ = state["before"].get<Spent>();
  now_ = state["now"].get<Spent>();
}

}  // namespace ipos::tools::debug
