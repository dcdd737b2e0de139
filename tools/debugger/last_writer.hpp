// Who changed a value last: a search backward as with a watchpoint on it alone, and the way forth to where the plant stood.
// Another process may go on behind each of both runs, so what is under way is plain data that goes with the session.
#pragma once

#include <optional>
#include <string>

#include "tools/debugger/debugger.hpp"

namespace ipos::tools::debug {

class LastWriter {
 public:
  // What to run for it. The break- and watchpoints of the user are put aside until the answer.
  Order ask(Debugger& debugger, TaskRef current, const ValuePlace& place);
  bool asks() const { return !state_.is_null(); }
  // Where the plant stood: go there with Debugger::return_to() when behind a run there is no answer yet.
  Position from() const { return state_["from"].get<Position>(); }
  // Behind a run: "lWrong: 0 -> 1 by FILL task 1, main at FILL.IPC:8 (1497.000 ms, 1198 commands)".
  std::optional<std::string> answer(Debugger& debugger, const Stop& stop);

  Json save() const { return state_; }
  void load(const Json& state) { state_ = state; }

 private:
  static std::string change_text(const Debugger& debugger, const Stop& stop);

  Json state_ = nullptr;  // null: nothing is asked
};

}  // namespace ipos::tools::debug
