// Instances of functions: which root needs which function, and where the temporaries of each stand.
#pragma once

#include <map>
#include <vector>

#include "compiler/codegen/code.hpp"

namespace ipos::compiler {

// Something that runs by itself: main (opcode End), a task, an interrupt routine.
struct Root {
  size_t function = 0;
  vm::Opcode opcode = vm::Opcode::End;
  int32_t keyword = 0;  // which interrupt; VARINT: number of the call in the program
  uint32_t first = 0;   // its temporaries, counted over all roots
  uint32_t count = 0;
};

// A function as one root, or all of them, has it.
struct Instance {
  size_t function = 0;
  size_t root = 0;     // kShared: no temporaries anywhere below, so one copy serves all
  uint32_t first = 0;  // its first temporary within the root's
};

class Instances {
 public:
  static constexpr size_t kShared = SIZE_MAX;

  Instances(const std::vector<FunctionCode>& functions, size_t main);

  const std::vector<Root>& roots() const { return roots_; }
  // Main first, then in source order.
  const std::vector<Instance>& all() const { return instances_; }
  uint32_t temporaries() const;

  // Index of the instance a command of `from` refers to.
  size_t target(const Instance& from, const Reference& reference) const;

  // The commands that call their own function again, directly or not, while a temporary is held.
  const std::vector<const Command*>& lost_temporaries() const { return lost_; }

 private:
  void find_copied();
  void reach(size_t main);
  size_t root_of(const Reference& reference);
  void add(size_t function, size_t root);
  void find_lost();
  void place_temporaries();

  const std::vector<FunctionCode>& functions_;
  std::vector<bool> copied_;  // needs an instance for each root
  std::vector<Root> roots_;
  std::vector<Instance> instances_;
  std::map<std::pair<size_t, size_t>, size_t> index_;  // (function, root) to instance
  std::vector<const Command*> lost_;
};

}  // namespace ipos::compiler
