// Snapshots of the whole process: a forked copy that sleeps until somebody wants to go back to its moment.
// What is under way then is given to it as bytes; the process that gives it ends, and a copy of the snapshot
// goes on in its place with the same files and terminal. The pages of a copy are shared until one writes
// them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/debug/position.hpp"

namespace ipos::tools::debug {

class Snapshots {
 public:
  Snapshots();
  ~Snapshots();
  Snapshots(const Snapshots&) = delete;
  Snapshots& operator=(const Snapshots&) = delete;

  // A snapshot of now. Nothing is returned to whom it takes; bytes are, at a later time, to the one that goes
  // on from here.
  std::optional<std::string> take(const Position& now);

  // The last one at or before a position, or strictly before it.
  const Position* before(const Position& position, bool strictly) const;
  // The last one at or before a time.
  const Position* before(runtime::Time time) const;
  // Goes on from that one; returns only if it is gone.
  void go_on_from(const Position& snapshot, const std::string& bytes);

  size_t count() const { return held_.size(); }
  void clear();
  // Memory of all snapshots: their share of all pages, and what each has for itself, in KiB.
  struct Memory {
    size_t shared_out = 0;
    size_t own = 0;
  };
  Memory memory() const;

 private:
  struct Held {
    Position position;
    int line;  // to write to, and to be answered on
    int process;
  };
  void drop(size_t n);
  void thin_out();

  std::vector<Held> held_;  // in rising order
  size_t most_;             // that are kept
  size_t taken_ = 0;
};

// Runs `body` in a process whose snapshots may take its place. wait() returns what the last of them returns; -1 when
// it ended without that.
class ReplaceableProcess {
 public:
  explicit ReplaceableProcess(const std::function<int()>& body);
  ReplaceableProcess(const ReplaceableProcess&) = delete;
  ReplaceableProcess& operator=(const ReplaceableProcess&) = delete;
  ~ReplaceableProcess();

  bool started() const { return pipe_ >= 0; }  // else there is no room for another process
  int wait();

 private:
  int pipe_ = -1;  // what it returns comes here
};

// The same while the caller waits; in the caller's own process where there is no room for another.
int run_replaceable(const std::function<int()>& body);

}  // namespace ipos::tools::debug
