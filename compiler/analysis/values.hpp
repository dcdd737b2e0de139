// Which values the variables of a program can have at each command: an interval each, from the constants in the code.
// What another task, an interrupt routine, the unit or a telegram can write may have any value.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "compiler/analysis/graph.hpp"

namespace ipos::compiler::analysis {

struct Interval {
  int64_t least = INT32_MIN;
  int64_t most = INT32_MAX;

  bool is_any() const { return least == INT32_MIN && most == INT32_MAX; }
  bool is_empty() const { return least > most; }
  bool operator==(const Interval&) const = default;
};

// Of either.
inline Interval joined(const Interval& a, const Interval& b) {
  if (a.is_empty()) return b;
  if (b.is_empty()) return a;
  return {std::min(a.least, b.least), std::max(a.most, b.most)};
}

// Variables that are written, `first` to `last`.
struct Span {
  int64_t first = 0;
  int64_t last = -1;
  bool has(int64_t variable) const { return variable >= first && variable <= last; }
};

// The unit reads or writes it.
bool is_system_variable(uint32_t variable);

class Values {
 public:
  // `variables`: how many the unit has.
  Values(const Graph& graph, uint32_t variables);

  // Before the command, in whichever task runs it; empty where it is never reached.
  Interval at(size_t command, uint32_t variable) const;
  // What the command can write by itself; not what a function does that it calls.
  std::vector<Span> written_by(size_t command) const;
  // Somebody beside the tasks that run this command can write the variable.
  bool is_shared(size_t command, uint32_t variable) const;

 private:
  // A variable that was set to another one, or grows with it in a loop: copy == factor * of + one of `more`.
  struct Copy {
    size_t copy, of;
    int64_t factor;
    Interval more;
    int widened = 0;  // times
    bool operator==(const Copy&) const = default;

    Interval bounds(const Interval& of_value) const;
  };
  struct State {
    std::vector<Interval> values;  // of the tracked variables; none: nobody comes here
    std::vector<Copy> copies;
  };

  struct Task {
    std::vector<bool> reached;  // of all commands
    std::vector<bool> shared;   // of all variables: others write it
    std::unordered_map<size_t, State> states;  // before the commands that others lead to
  };

  size_t slot(uint32_t variable) const;
  bool is_shared_in(const Task& task, uint32_t variable) const;
  Interval read(const Task& task, const State& state, uint32_t variable) const;
  std::vector<Span> writes(const Task& task, const State& state, size_t command) const;
  void execute(const Task& task, State& state, size_t command) const;
  void set(State& state, size_t slot, const Interval& value) const;
  void refine(const Task& task, State& state, const vm::Instruction& branch, bool jumps) const;
  void narrow(State& state, size_t slot, const Interval& value) const;
  // growth.cpp
  static void tighten(State& state);
  std::vector<Copy> growing_together(const Task& task, const State& before, const State& after) const;
  static bool holds(Copy& copy, const State& state, bool may_grow);
  Interval widened(const Interval& old, const Interval& now) const;
  void analyse(Task& task, size_t entry) const;
  State before(const Task& task, size_t command) const;
  bool share(const std::vector<Span>& spans, std::vector<bool>& shared) const;

  const Graph& graph_;
  uint32_t variables_;
  std::vector<bool> leads_;                           // commands that have a state of their own
  std::unordered_map<uint32_t, size_t> slots_;        // tracked: named by a command
  std::vector<uint32_t> tracked_;
  std::vector<size_t> compared_, growing_;            // slots of variables that end loops, and of those that constants are added to
  std::vector<int64_t> thresholds_;                   // where intervals stop to grow
  std::unordered_map<size_t, std::vector<size_t>> returns_;  // of a function's entry the commands that end it
  std::unordered_map<size_t, std::vector<size_t>> behind_;   // and the commands that its calls go on with
  std::vector<Task> tasks_;
};

}  // namespace ipos::compiler::analysis
