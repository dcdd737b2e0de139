// Snapshots of the whole process: a forked copy that sleeps until somebody wants to go back to its moment.
// What is under way then is given to it as bytes, with the lines to all other snapshots; the process that gives it ends,
// and a copy of the snapshot goes on in its place with the same files and terminal. The pages of a copy are shared until
// one writes them.
#pragma once

#include <vector>

#include "tools/debugger/snapshots.hpp"

namespace ipos::tools {

class ForkedSnapshots final : public debug::Snapshots {
 public:
  using Position = debug::Position;

  ForkedSnapshots();
  ~ForkedSnapshots() override;
  ForkedSnapshots(const ForkedSnapshots&) = delete;
  ForkedSnapshots& operator=(const ForkedSnapshots&) = delete;

  std::optional<std::string> take(const Position& now) override;
  const Position* before(const Position& position, bool strictly) const override;
  const Position* before(runtime::Time time) const override;
  void go_on_from(const Position& snapshot, const std::string& bytes) override;
  void drop_after(const Position& position) override;
  size_t count() const override { return held_.size(); }
  void clear() override { drop_all(); }
  Memory memory() const override;

 private:
  struct Held {
    Position position;
    int line;  // to write to, and to be answered on
    int process;
  };
  // What a copy is woken with: what is under way, and all snapshots but itself.
  struct Orders {
    std::string bytes;
    std::vector<Held> others;
  };
  static bool send(int line, const std::string& bytes, const std::vector<Held>& others);
  static std::optional<Orders> receive(int line);

  void hold(const Held& held);
  void drop(size_t n);
  void drop_all();
  void thin_out();

  std::vector<Held> held_;  // in rising order
  size_t most_;             // that are kept
  size_t taken_ = 0;
};

}  // namespace ipos::tools
