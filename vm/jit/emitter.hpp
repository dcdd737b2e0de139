// Makes machine code of a program, command by command: the order of the code, the budget, jumps, calls and
// exits. What it says in instructions is the processor's part, a class of its own for each: x86_64/ and
// aarch64/. H variables that loops use most have a register each as long as machine code runs; the others are
// where they always are.
#pragma once

#include <asmjit/core.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vm/context/context.hpp"
#include "vm/jit/counted.hpp"

namespace ipos::vm::jit {

// What enters machine code and what comes back from it. The code's first byte is void enter(Frame*).
struct Frame {
  TaskContext* context;
  int32_t* h;
  const uint8_t* target;  // of the entry
  uint64_t free_calls;    // how many more CALLs may nest
  int32_t number;         // in: less the credit of the entry; out: commands left
  uint32_t pc;            // out
  const void* code;       // the caller's
};

// Where calls return to stands on a stack in a block of this size whose address is a multiple of it. It grows
// down and begins so far above the block's start that as many calls fit below as may still nest: a CALL has
// to look only whether the low bits of the stack's address are 0. Where calls of the context return to,
// code stands instead that looks for it there. Above are fields of the processor's part.
inline constexpr int32_t kBlock = 1024;
inline constexpr int32_t kReturnsEnd = (kMaxCallDepth + 2) * 8;

// The calls that machine code has nested are on that stack; this appends them to those of the context.
using Unwind = void (*)(Frame* frame, const uint64_t* top);

struct Entry {
  uint32_t offset = 0;  // 0: none
  uint16_t credit = 0;
};
struct ReturnSite {
  uint32_t offset;
  uint32_t at;  // word address after the CALL
};
struct Emitted {
  std::vector<Entry> entries;       // by word address
  std::vector<ReturnSite> returns;  // in rising order of offset
};

// Fills `code`, which is made for this processor. False when asmjit reports an error, as when the code is
// longer than the processor's jumps reach; `out` is valid otherwise only.
bool emit(const Program& program, asmjit::CodeHolder& code, Unwind unwind, Emitted& out);

class Emitter {
 public:
  virtual ~Emitter() = default;
  bool run(Emitted& out);

 protected:
  // A run of variables that are all in memory.
  struct Range {
    uint32_t first, count;
  };
  // The code for an index outside of the range that is expected.
  struct Slow {
    asmjit::Label label, back;
    uint32_t command;
  };

  Emitter(const Program& program, asmjit::BaseAssembler& assembler, Unwind unwind, size_t registers);

  // ---- The processor's part. frame.cpp: the way in; the way out, from leave_, with the word address in a
  // register; the code at returned_.
  virtual void enter() = 0;
  virtual void leave() = 0;
  virtual void returns_to_context() = 0;

  // control.cpp: the number of flow.hpp, jumps and calls.
  virtual void correct(int32_t by) = 0;
  virtual void correct_with_result(int32_t by) = 0;  // the same; the flags stay as they are
  // Takes the charge from the number; exits when that is negative then.
  virtual void check(int32_t charge, const asmjit::Label& exit) = 0;
  virtual void leave_at(uint32_t at) = 0;
  virtual void jump_to(const asmjit::Label& to) = 0;
  virtual void jump_if(const Instruction& branch, const asmjit::Label& to) = 0;
  // Whether that looks at the flags when they tell of the variable it tests.
  virtual bool tests_flags(const Instruction& branch) const = 0;
  // To the address in a table of `count`, by the variable's value less `first`; or to `other`.
  virtual void jump_by_table(int32_t variable, int32_t first, uint32_t count, const asmjit::Label& table,
                             const asmjit::Label& other) = 0;
  virtual void check_calls(const asmjit::Label& exit) = 0;  // exits when no more may nest
  virtual void call_to(const asmjit::Label& to) = 0;        // ends where it returns to
  virtual void return_from(uint32_t at) = 0;

  // templates.cpp: commands that work on variables.
  virtual void data(uint32_t n) = 0;
  // Two in one; false where there is no way that is better.
  virtual bool fused(const Instruction& first, const Instruction& second) = 0;
  // SETI by the subroutine; exits when the index leads to none.
  virtual void slow_access(const Slow& slow) = 0;
  // The subroutines load_any_ and store_any_: a variable by its number, in memory or in a register.
  virtual void any_variable(bool stores) = 0;
  virtual void set(int32_t to, int32_t from) = 0;

  // ---- For it.
  asmjit::Label exit(uint32_t n, int32_t credit);
  Range range_for(uint32_t n) const;
  int pin_of(int32_t variable) const { return pin_of_[static_cast<size_t>(variable)]; }  // -1: in memory
  const std::vector<uint16_t>& pinned() const { return pinned_; }
  // For each word address the way from the table to the code of a return to it.
  void table_of_returns(const asmjit::Label& table, const asmjit::Label& none);
  // After an access: where the code for any other index comes back to.
  void finish_access(const Slow& slow);
  // COPY, as one SET after the other.
  void copy(const Instruction& command);

  const Program& program_;
  const Unwind unwind_;
  const asmjit::Label leave_, load_any_, store_any_, returned_;
  int32_t flags_of_ = -1;  // the processor's flags tell of this variable
  bool in_range_ = false;  // what is being made is executed with indexes in range_for() only

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
  // A loop once more, for indexes that need no check.
  struct Unchecked {
    asmjit::Label label;
    CountedLoop loop;
  };
  // Where the cases of a switch begin.
  struct Table {
    asmjit::Label label;
    std::vector<asmjit::Label> cases;
  };

  void choose_ranges();
  uint32_t command(uint32_t n);
  void begin(uint32_t n);
  void leave_checks_out(uint32_t first);
  uint32_t next(uint32_t n);
  void jump(uint32_t n);
  void branch(const Command& command, uint32_t n, const asmjit::Label& to);
  void call(uint32_t n);
  void ret(const Command& command);
  uint32_t end_of_short_line(uint32_t first) const;
  void repeat(uint32_t jump, uint32_t last);
  struct Known {
    int32_t variable, value;
  };
  // The way through commands whose tests are decided while the code is made.
  struct Decided {
    uint32_t end;                // the first that is not
    uint32_t commands;           // in front of it
    std::vector<uint32_t> sets;  // those of them that do something
  };
  std::optional<Known> known_at(uint32_t n) const;
  std::optional<Decided> decide(const std::optional<Known>& known, uint32_t to) const;
  void jump_decided(uint32_t jump, const Command& from, const Decided& decided);
  uint32_t cases(uint32_t n) const;
  void jump_to_case(uint32_t n, uint32_t count);
  asmjit::Label label_of(uint32_t n);
  void slow_paths();
  void unchecked_loops();
  void exit_paths();
  void tables();

  asmjit::BaseAssembler& a_;
  Emitted out_;
  std::vector<uint16_t> pinned_;
  std::vector<int8_t> pin_of_;  // by variable
  std::vector<Range> ranges_;
  std::vector<asmjit::Label> labels_;
  std::vector<Exit> exits_;
  std::vector<Detour> detours_;
  std::vector<Slow> slow_;
  std::vector<Unchecked> unchecked_;
  std::vector<Table> tables_;
};

}  // namespace ipos::vm::jit
