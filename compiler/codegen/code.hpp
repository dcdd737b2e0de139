// Commands of one function before they have addresses: jumps go to labels, calls to functions, and
// intermediate results stand in numbered temporaries of the function.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/sema/call_graph.hpp"
#include "compiler/sema/observers.hpp"
#include "compiler/source/source.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::compiler {

// A variable operand kTemporary + n stands for temporary n of the function.
inline constexpr int32_t kTemporary = 1 << 16;
inline bool is_temporary(int32_t variable) { return variable >= kTemporary; }

struct Command {
  vm::Instruction instruction;
  Span span;
  int label = -1;                      // where it jumps to
  std::optional<Reference> reference;  // function it calls, starts or names
  uint32_t held = 0;                   // temporaries whose values are needed after a call
};

struct GenerateOptions {
  bool atomic = false;      // variables that others see get their values once, computed aside; else a warning says which do not
  bool as_written = false;  // -O0: none of the forms that take fewer commands than what stands in the source
  size_t most_held = 6;     // numbers that one loop keeps in temporaries
};

// An assignment whose intermediate results somebody sees.
struct SeenSteps {
  int32_t variable;
  Span span;
  Observer observer;
};

struct FunctionCode {
  std::vector<Command> commands;
  std::vector<size_t> labels;  // command each label stands at
  uint32_t temporaries = 0;
  bool holds_numbers = false;  // loops of it keep numbers in temporaries
  std::vector<SeenSteps> seen_steps;
};

}  // namespace ipos::compiler
