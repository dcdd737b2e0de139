// The commands of an image as a graph: where each leads, which functions there are, and who begins where.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vm/image/image.hpp"
#include "vm/isa/blocks.hpp"

namespace ipos::compiler::analysis {

inline constexpr size_t kNone = SIZE_MAX;

struct Command {
  vm::Instruction code;
  uint32_t address = 0;
  size_t next = kNone;   // that follows it; none where the flow never goes there
  size_t label = kNone;  // that a jump, branch or call leads to
  size_t started = kNone;  // where the task or interrupt routine begins that it starts
  bool calls = false;    // the label is a function
  bool ends = false;     // the function returns here, or the task ends
};

// A task or interrupt routine: code that runs beside the others.
struct Root {
  enum class How : uint8_t { Task, Interrupt };
  size_t entry = 0;
  uint8_t task = 1;  // whose commands a millisecond it uses; of a variable interrupt the slower one, task 2
  How how = How::Task;
  bool operator==(const Root&) const = default;
};

// Of the blocks of variables that a command begins, the rows that hold for it.
std::vector<const vm::BlockInfo*> blocks_of(const vm::Instruction& code);

// Of the source that the command at the address comes from; 0: the image does not know it.
uint32_t line_of(const vm::Image& image, uint32_t address);
// "lSpeed", "aPos[3]", or "H420" where the program has no name for it.
std::string variable_name(const vm::Image& image, uint32_t variable);

struct Graph {
  explicit Graph(const vm::Image& image);

  // Where a command goes on in its own function.
  std::vector<size_t> successors(size_t command) const;
  // Of the function that begins there, calls left aside; in no order.
  std::vector<size_t> function_at(size_t entry) const;
  // The same with all functions that it calls.
  std::vector<size_t> reached_from(size_t entry) const;

  // What a command starts beside its own task.
  std::optional<Root> started_by(size_t command) const;

  std::vector<Command> commands;
  std::vector<Root> roots;      // task 1 first
  std::vector<size_t> entries;  // of functions and roots, each once
};

}  // namespace ipos::compiler::analysis
