// Makes x86-64 code of a program, command by command. H variables that loops use most have a register each as
// long as machine code runs; the others are where they always are.
//
// Registers: r15 the variables, r14d the number of flow.hpp, eax and ecx for the moment, the others for
// variables. CALL and RET are the processor's own: the stack pointer counts the calls, see frame.cpp.
#pragma once

#include <asmjit/x86.h>

#include <array>
#include <optional>
#include <vector>

#include "vm/exec/context.hpp"
#include "vm/jit/flow.hpp"

namespace ipos::vm::jit {

namespace x86 = asmjit::x86;

// What enters machine code and what comes back from it.
struct Frame {
  TaskContext* context;
  int32_t* h;
  const uint8_t* target;  // of the entry
  uint64_t free_calls;    // how many more CALLs may nest
  int32_t number;         // in: less the credit of the entry; out: commands left
  uint32_t pc;            // out
  const void* code;       // the caller's
};

// The calls that machine code has nested are on its stack; this appends them to those of the context.
using Unwind = void (*)(Frame* frame, const uint64_t* top);

// The stack of machine code stands in a block of this size, see frame.cpp.
inline constexpr int32_t kBlock = 1024;

struct Entry {
  uint32_t offset = 0;  // 0: none
  uint16_t credit = 0;
};
struct ReturnSite {
  uint32_t offset;
  uint32_t at;  // word address behind the CALL
};

class Emitter {
 public:
  Emitter(const Program& program, asmjit::CodeHolder& code, Unwind unwind);

  // False when asmjit reports an error. What follows is valid then only.
  bool run();

  std::vector<Entry> entries;       // by word address
  std::vector<ReturnSite> returns;  // in rising order of offset

 private:
  struct Exit {
    asmjit::Label label;
    uint32_t at;
    int32_t credit;  // of where it leaves, to get the commands left
  };
  // A jump out of a loop with a correction.
  struct Detour {
    asmjit::Label label, target;
    int32_t by;
  };
  // The code for an index that is none of a variable in memory.
  struct Slow {
    asmjit::Label label, back;
    uint32_t command;
  };
  // Where the cases of a switch begin.
  struct Table {
    asmjit::Label label;
    std::vector<asmjit::Label> cases;
  };
  struct Range {
    uint32_t first, count;
  };

  // frame.cpp
  void enter();
  void leave();
  void returns_to_context();
  void move_pins(bool store);
  void block_base(x86::Gp to);

  // emitter.cpp
  void choose_ranges();
  uint32_t command(uint32_t n);
  void begin(uint32_t n);
  void correct(int32_t by);
  asmjit::Label exit(uint32_t n, int32_t credit);
  void jump(uint32_t n);
  void branch(const Command& command, uint32_t n);
  void call(uint32_t n);
  void ret(const Command& command);
  uint32_t end_of_short_line(uint32_t first) const;
  void repeat(uint32_t first, uint32_t last, int32_t credit);
  uint32_t cases(uint32_t n) const;
  void jump_to_case(uint32_t n, uint32_t count);
  asmjit::Label label_of(uint32_t n);
  void slow_paths();
  void exit_paths();
  void tables();

  // templates.cpp
  bool fused(const Instruction& first, const Instruction& second);
  void data(uint32_t n);
  void alu(asmjit::InstId id, int32_t to, const Instruction& command, bool constant);
  void multiply(int32_t to, const Instruction& command, bool constant);
  void multiply_constant(x86::Gp to, int32_t from, int32_t factor);
  void shift(asmjit::InstId id, int32_t to, const Instruction& command, bool constant);
  void set(int32_t to, int32_t from);
  void divide(uint32_t n, bool quotient);
  void divide_constant(const Instruction& command, bool quotient);
  void move_bit(const Instruction& command, bool inverted);
  void load(uint32_t n);
  void store(uint32_t n);
  x86::Gp checked_index(uint32_t n, int32_t variable, const asmjit::Label& slow);
  Range range_for(uint32_t n) const;
  void compare(const Instruction& command, bool constant);

  std::optional<x86::Gp> pin(int32_t variable) const;
  x86::Mem memory(int32_t variable) const;
  x86::Mem indexed(x86::Gp number) const { return x86::dword_ptr(h_, number.r64(), 2); }
  asmjit::Operand place(int32_t variable) const;

  const Program& program_;
  x86::Assembler a_;
  Unwind unwind_;
  std::vector<uint16_t> pinned_;
  std::vector<int8_t> pin_of_;  // by variable; -1: in memory
  std::vector<Range> ranges_;   // of variables that are all in memory
  std::vector<asmjit::Label> labels_;
  std::vector<Exit> exits_;
  std::vector<Detour> detours_;
  std::vector<Slow> slow_;
  std::vector<Table> tables_;
  int32_t flags_of_ = -1;  // the processor's flags tell of this variable
  asmjit::Label leave_, store_pins_, load_pins_, returned_;

  const x86::Gp h_ = x86::r15;
  const x86::Gp number_ = x86::r14d;
};

// Registers for variables, the one first that is least in the way.
inline constexpr std::array<x86::Gp, 11> kPins = {x86::ebx,  x86::ebp,  x86::esi,  x86::edi,
                                                  x86::r8d,  x86::r9d,  x86::r10d, x86::r11d,
                                                  x86::r12d, x86::r13d, x86::edx};

}  // namespace ipos::vm::jit
