// Back to the last change, and forth again.
#include "tools/debugger/last_writer.hpp"

#include <fmt/format.h>

namespace ipos::tools::debug {

Order LastWriter::ask(Debugger& debugger, TaskRef current, const ValuePlace& place) {
  state_ = {{"name", place.name},
            {"value", value_text(place)},
            {"from", debugger.position()},
            {"breakpoints", debugger.breakpoints()},
            {"watchpoints", debugger.watchpoints()}};
  debugger.breakpoints().clear();
  debugger.watchpoints() = {{0, place.station, place, "", true, 0}};
  return debugger.order_for(Motion::Continue, current, true);
}

std::optional<std::string> LastWriter::answer(Debugger& debugger, const Stop& stop) {
  if (!state_.contains("found")) {
    state_["found"] = stop.reason == Reason::Data ? change_text(debugger, stop)
                                                  : fmt::format("nobody has changed {} = {} so far", state_["name"].get<std::string>(),
                                                                state_["value"].get<std::string>());
    return std::nullopt;
  }
  debugger.breakpoints() = state_["breakpoints"].get<std::vector<Breakpoint>>();
  debugger.watchpoints() = state_["watchpoints"].get<std::vector<Watchpoint>>();
  const auto found = state_["found"].get<std::string>();
  state_ = nullptr;
  return found;
}

// At the stop in front of it.
std::string LastWriter::change_text(const Debugger& debugger, const Stop& stop) {
  const Position& at = debugger.position();
  std::string by = "no command: a telegram, the unit, a stimulus or 'set'";
  if (stop.task.task != 0) {
    by = debugger.task_name(stop.task);
    const std::vector<Frame> frames = debugger.frames(stop.task);
    if (!frames.empty())
      by += fmt::format(", {} at {}", frames.front().function,
                        frames.front().place.line == 0 ? fmt::format("word {}", frames.front().address) : frames.front().place.text());
  }
  return fmt::format("{} by {} ({:.3f} ms, {} commands)", stop.text, by, static_cast<double>(at.time) / 1e6, at.commands);
}

}  // namespace ipos::tools::debug
