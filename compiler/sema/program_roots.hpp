// What runs by itself: main, the tasks and the interrupt routines, and the functions that each of them runs.
#pragma once

#include <optional>
#include <vector>

#include "compiler/sema/call_graph.hpp"

namespace ipos::compiler {

struct ProgramRoot {
  size_t function = 0;
  vm::Opcode start = vm::Opcode::End;  // main: End; Task2, Task (task 3), SetInt, VarInt
  int32_t keyword = 0;                 // of SetInt: which interrupt
  Span place;                          // where it is started or installed first

  bool is_interrupt() const { return start == vm::Opcode::SetInt || start == vm::Opcode::VarInt; }
  // 1 to 3; nothing for variable interrupts, whose structure tells.
  std::optional<int> task() const {
    switch (start) {
      case vm::Opcode::Task2: return 2;
      case vm::Opcode::Task: return 3;
      case vm::Opcode::VarInt: return std::nullopt;
      default: return 1;
    }
  }
};

struct ProgramRoots {
  explicit ProgramRoots(const Context& context);

  const CallGraph& graph;
  std::vector<bool> alive;             // functions that main reaches in any way
  std::vector<ProgramRoot> roots;      // main first
  std::vector<std::vector<size_t>> of;  // roots that run a function, in rising order

  // "main", "task 2 'Second'", "the interrupt routine 'Tick'"
  static std::string name(const ProgramRoot& root, const checked::Program& program);
};

}  // namespace ipos::compiler
