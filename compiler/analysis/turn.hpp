// One turn of the endless loop of a task: its commands and those of the functions that it calls, from the head of the loop until it
// is there again. Tells what comes before what in a turn, and which branches decide whether a command is reached in it.
#pragma once

#include <map>
#include <vector>

#include "compiler/analysis/graph.hpp"

namespace ipos::compiler::analysis {

class Turn {
 public:
  Turn(const Graph& graph, const Root& task);

  // The task has exactly one endless loop in its own function, which begins at one place.
  bool is_found() const { return head_ != kNone; }
  // It goes round for ever, but not so: in several loops, in one with several beginnings, or in a function that it calls.
  bool is_unclear() const { return is_unclear_; }
  uint8_t task() const { return task_; }
  size_t head() const { return head_; }
  const std::vector<size_t>& commands() const { return commands_; }  // in rising order
  bool has(size_t command) const { return !next_[command].empty(); }

  // Where a command goes on in the turn, into and out of functions; kNone is the end of the turn.
  const std::vector<size_t>& next(size_t command) const { return next_[command]; }

  using Set = std::vector<bool>;  // of all commands of the program
  // That come after it in the same turn, no further than a wall; walls that are reached are among them.
  Set after(size_t command, const std::vector<size_t>& walls) const;
  // That the turn may reach without having passed a wall.
  Set before(const std::vector<size_t>& walls) const;
  // From which the turn may end without passing a wall, walls not among them.
  Set to_the_end(const std::vector<size_t>& walls) const;
  // The turn may end behind it without passing a wall.
  bool lasts(size_t command, const std::vector<size_t>& walls) const;

  // The branches that decide whether the turn comes by, those that decide that among them, and so on.
  std::vector<size_t> deciders(size_t command);

 private:
  // A function, or the loop itself: commands that end together.
  struct Part {
    std::vector<size_t> commands;
    std::vector<bool> has;
    std::vector<size_t> callers;
    std::map<size_t, std::vector<size_t>> next, back;
    std::vector<size_t> last;  // that the end of the part may follow
  };

  std::vector<std::vector<size_t>> endless_parts(size_t entry) const;
  void add_function(size_t entry);
  void connect(Part& part, bool is_loop) const;
  const std::vector<size_t>& deciders_in_functions(size_t command);

  const Graph& graph_;
  uint8_t task_;
  size_t head_ = kNone;
  bool is_unclear_ = false;
  std::vector<size_t> commands_;
  std::vector<std::vector<size_t>> next_, back_;
  std::vector<size_t> ends_;  // that the end of the turn may follow
  std::map<size_t, Part> parts_;  // by entry; the loop by kNone
  std::map<size_t, std::vector<size_t>> known_;
};

}  // namespace ipos::compiler::analysis
