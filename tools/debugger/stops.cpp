// What there is to stop for, and how tasks look to the user.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "tools/debugger/debugger.hpp"

namespace ipos::tools::debug {

using runtime::Station;

bool hits_hold(const runtime::Plant& plant, uint32_t station, const std::string& condition, uint64_t hits) {
  if (condition.empty()) return true;
  const bool bare = std::isdigit(static_cast<unsigned char>(condition[0])) != 0;
  const bool each = condition[0] == '%';
  return evaluate(plant, station,
                  (bare ? "hits >= " : "hits ") + condition + (each ? " == 0" : ""),
                  static_cast<int32_t>(hits)) != 0;
}

// A condition that makes no sense holds, so that its user sees it.
bool Debugger::holds(Breakpoint& breakpoint, bool backward) {
  try {
    if (!breakpoint.condition.empty() && evaluate(*plant_, breakpoint.station, breakpoint.condition) == 0)
      return false;
    if (backward) return breakpoint.log.empty();
    ++breakpoint.hits;
    return hits_hold(*plant_, breakpoint.station, breakpoint.hit_condition, breakpoint.hits);
  } catch (const ValueError& error) {
    front_end_.output(fmt::format("breakpoint {}: {}\n", breakpoint.id, error.what()));
    return true;
  }
}

std::optional<Stop> Debugger::stop_at_breakpoint(TaskRef task, const vm::Machine& machine, bool backward) {
  const uint32_t pc = machine.context(machine.active_context(task.task)).pc;
  std::optional<Stop> stop;
  for (Breakpoint& breakpoint : breakpoints_) {
    if (!breakpoint.enabled || breakpoint.address != pc || breakpoint.station != task.station ||
        !holds(breakpoint, backward))
      continue;
    if (!breakpoint.log.empty()) {
      front_end_.output(with_values(task.station, breakpoint.log) + "\n");
      continue;
    }
    if (!stop) stop = Stop{Reason::Breakpoint, task, {}, {}};
    stop->ids.push_back(breakpoint.id);
  }
  return stop;
}

std::string Debugger::with_values(uint32_t station, const std::string& text) const {
  std::string out;
  for (size_t at = 0; at < text.size(); ++at) {
    const size_t end = text[at] == '{' ? text.find('}', at) : std::string::npos;
    if (end == std::string::npos) {
      out += text[at];
      continue;
    }
    try {
      out += fmt::format("{}", evaluate(*plant_, station, text.substr(at + 1, end - at - 1)));
    } catch (const ValueError& error) {
      out += fmt::format("<{}>", error.what());
    }
    at = end;
  }
  return out;
}

std::optional<Stop> Debugger::data_changed(bool backward) {
  std::optional<Stop> stop;
  for (size_t n = 0; n < watchpoints_.size(); ++n) {
    Watchpoint& watchpoint = watchpoints_[n];
    const int32_t value = read_value(watchpoint.place);
    if (value == watched_[n]) continue;
    const int32_t before = std::exchange(watched_[n], value);
    bool counts = watchpoint.enabled;
    try {
      counts = counts && (watchpoint.condition.empty() ||
                          evaluate(*plant_, watchpoint.station, watchpoint.condition) != 0);
    } catch (const ValueError& error) {
      front_end_.output(fmt::format("watchpoint {}: {}\n", watchpoint.id, error.what()));
    }
    if (!counts) continue;
    if (!backward) ++watchpoint.hits;
    try {
      if (!backward && !hits_hold(*plant_, watchpoint.station, watchpoint.hit_condition, watchpoint.hits)) continue;
    } catch (const ValueError& error) {
      front_end_.output(fmt::format("watchpoint {}: {}\n", watchpoint.id, error.what()));
    }
    if (!stop) stop = Stop{Reason::Data, {}, {}, {}};
    stop->ids.push_back(watchpoint.id);
    stop->text += fmt::format("{}{}: {} -> {}", stop->text.empty() ? "" : ", ", watchpoint.place.name,
                              value_text(watchpoint.place, before),
                              value_text(watchpoint.place, value));
  }
  return stop;
}

// Whether the task the order is about stands where a step of that kind ends. Interrupt routines that break in
// are stepped over.
std::optional<Stop> Debugger::step_ends(TaskRef task, const vm::Machine& machine) const {
  const Order& order = goal_.order;
  if (task != order.task) return std::nullopt;
  const int active = machine.active_context(task.task);
  const vm::TaskContext& context = machine.context(active);
  const bool over =
      machine.context(order.context == 0 ? active : order.context).state == vm::TaskState::Stopped;
  const bool same = active == order.context || over;
  const uint32_t depth = over ? 0 : context.depth;
  const bool line = codes_[task.station]->starts_line(context.pc);
  bool ends = false;
  switch (order.motion) {
    case Motion::Continue:
    case Motion::ToTime: break;
    case Motion::Instruction: ends = true; break;
    case Motion::InstructionOver: ends = same && depth <= order.depth; break;
    case Motion::Into: ends = same && line; break;
    case Motion::Over: ends = same && line && depth <= order.depth; break;
    case Motion::Out: ends = same && (over || depth < order.depth); break;
    case Motion::ToAddress: ends = context.pc == order.address; break;
  }
  return ends ? std::optional(Stop{Reason::Step, task, {}, {}}) : std::nullopt;
}

std::optional<Stop> Debugger::task_ended() const {
  const TaskRef task = goal_.order.task;
  if (task.task == 0 || goal_.order.motion == Motion::Continue || goal_.order.motion == Motion::ToTime)
    return std::nullopt;
  if (machine(task.station)->task(task.task).state != vm::TaskState::Stopped) return std::nullopt;
  return Stop{Reason::TaskEnded, task, {}, task_name(task) + " has ended"};
}

std::vector<TaskRef> Debugger::tasks(bool all) const {
  std::vector<TaskRef> running;
  std::vector<TaskRef> stopped;
  for (uint32_t station = 0; station < plant_->stations().size(); ++station) {
    if (machine(station) == nullptr || !codes_[station]) continue;
    for (int task = 1; task <= vm::kTasks; ++task)
      (machine(station)->task(task).state == vm::TaskState::Stopped && machine(station)->fault().task != task
           ? stopped
           : running)
          .push_back({station, task});
  }
  if (all) running.insert(running.end(), stopped.begin(), stopped.end());
  return running;
}

std::string Debugger::task_name(TaskRef task) const {
  return fmt::format("{} task {}", plant_->stations()[task.station]->config().name, task.task);
}

std::string Debugger::task_state(TaskRef task) const {
  const vm::Machine& of_task = *machine(task.station);
  const int active = of_task.active_context(task.task);
  const vm::TaskContext& context = of_task.context(active);
  std::string state = context.state == vm::TaskState::Stopped ? "stopped"
                      : context.state == vm::TaskState::Ready ? "ready"
                      : context.wait_ms != 0                  ? fmt::format("waits {} ms", context.wait_ms)
                                                              : "waits for the end of its command";
  if (active != task.task) state += fmt::format(", in {}", vm::context_name(active));
  return state;
}

std::vector<Frame> Debugger::frames(TaskRef task) const {
  std::vector<Frame> frames;
  const vm::Machine* of_task = machine(task.station);
  if (of_task == nullptr || !codes_[task.station]) return frames;
  const CodeMap& code = *codes_[task.station];
  const auto add = [&](int number, uint32_t address, uint32_t at) {
    frames.push_back({number, address, std::string(code.function(at)), code.place(at)});
  };
  // What executes first, then what it has broken into by falling rank; the task itself has the lowest.
  std::vector<int> contexts;
  for (int number = 1; number <= vm::kContexts; ++number)
    if (of_task->context(number).task == task.task &&
        (of_task->context(number).state != vm::TaskState::Stopped || of_task->fault().context == number))
      contexts.push_back(number);
  std::stable_sort(contexts.begin(), contexts.end(),
                   [&](int a, int b) { return of_task->context(a).rank > of_task->context(b).rank; });
  for (const int number : contexts) {
    const vm::TaskContext& context = of_task->context(number);
    add(number, context.pc, context.pc);
    for (uint32_t n = context.depth; n-- > 0;)  // the call is in front of where it returns to
      add(number, context.calls[n], context.calls[n] - 1U);
    if (number > vm::kTasks && !frames.empty())
      frames.back().function += fmt::format(" ({})", vm::context_name(number));
  }
  return frames;
}

}  // namespace ipos::tools::debug
