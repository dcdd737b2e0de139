// The places of a program at which its endless loops keep something: a variable, one bit of it that commands set and clear by
// itself, or an order to the unit; who writes there, what a command takes from where, and what of that comes from outside.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "compiler/analysis/graph.hpp"
#include "compiler/analysis/turn.hpp"
#include "compiler/analysis/values.hpp"

namespace ipos::compiler::analysis {

struct Write {
  size_t turn = 0;     // of Places::turns
  size_t command = 0;
  bool strong = true;  // it writes there in any case; false: maybe to another variable of an array
};

struct Place {
  uint32_t variable = 0;
  int bit = -1;           // -1: all of it
  size_t order = kNone;   // the command that orders something; the variable means nothing then
  std::vector<Write> writes;
};

// What a command takes: of a variable these bits, or an answer of the unit.
struct Read {
  uint32_t variable = 0;
  uint32_t mask = UINT32_MAX;
  bool operator<(const Read& other) const { return variable != other.variable ? variable < other.variable : mask < other.mask; }
};

class Places {
 public:
  Places(const vm::Image& image, uint32_t variables);

  // Of the variable, those that these bits are kept in.
  std::vector<size_t> of(uint32_t variable, uint32_t mask) const;
  std::vector<Read> read_by(size_t command) const;
  // Nobody in the program's loops decides it, or somebody else does so, too.
  bool comes_from_outside(uint32_t variable) const;
  // The program's loops write it, and the unit or a telegram does so, too.
  bool goes_on_by_itself(uint32_t variable) const;
  // "lSpeed", "bit 3 of H481", "the order".
  std::string name(const Place& place) const;

  const vm::Image& image;
  Graph graph;
  Values values;
  std::vector<std::unique_ptr<Turn>> turns;  // of the tasks that have one
  std::vector<Place> all;
  std::vector<size_t> task_orders;           // commands within loops that start or stop a task
  std::vector<uint8_t> unclear_tasks;        // that go round for ever in another way than one loop of their own

  static constexpr uint32_t kAnswers = 0x10000;  // the answer of the unit to the command of this number and more

 private:
  void collect_writes();
  bool is_shared_with_the_unit(uint32_t variable) const;

  uint32_t variables_;
  std::map<uint32_t, std::vector<size_t>> by_variable_;
  std::map<uint32_t, std::vector<size_t>> roots_;  // that write a variable, in whatever part of theirs
};

}  // namespace ipos::compiler::analysis
