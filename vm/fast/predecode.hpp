// Makes the predecoded form of a verified program. Its memory is the caller's, 10 bytes for each code word: a
// program of 200 words takes 2 KiB, 2048 words 20 KiB. It does not change afterwards and knows nothing of any
// machine, so all machines with the same program can share one.
#pragma once

#include <span>

#include "vm/fast/slot.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::vm::fast {

// Every operation of the engine; Leave is 0.
enum class Operation : uint16_t {
#define SPECIAL(name) name,
#define PLAIN(name) name,
#define FUSED(name, ...) name,
#define FUSED_CALL(name, ...) name,
#define FUSED_RET(name, ...) name,
#define FILL(name, ...) name,
#include "vm/fast/operations.def"
  kCount
};

const char* operation_name(Operation operation);

// The commands an operation is made of; none for Leave and the switches.
std::span<const Opcode> commands_of(Operation operation);

class Predecoded {
 public:
  static constexpr size_t slots_needed(size_t words) { return words + (words + 3) / 4; }

  // `memory` has slots_needed(words of the program) slots, and it and the program's code stay where they are.
  Predecoded(const VerifiedImage& program, std::span<Slot> memory);

  const VerifiedImage& program() const { return program_; }
  const Slot* slots() const { return slots_.data(); }
  const void* base() const { return base_; }  // handler_base()

  // Commands that follow each other from here on until one that always leads elsewhere, itself included.
  uint32_t line(uint32_t address) const { return lines()[address]; }
  const uint16_t* lines() const { return slots_[program_.code().size()].lines.data(); }  // by address

  // The operation that begins at a command, and how many commands it has as long as nothing jumps.
  Operation operation(uint32_t address) const;
  uint32_t commands(uint32_t address) const;

 private:
  uint16_t& line_at(uint32_t address) { return slots_[program_.code().size()].lines.data()[address]; }
  void fill();
  void choose();
  void set_routes(uint32_t address, uint32_t words, uint32_t target);

  VerifiedImage program_;
  std::span<Slot> slots_;
  const void* base_;
};

}  // namespace ipos::vm::fast
