// Machines with the same program, one with the reference interpreter alone, one with the fast engine, one
// with machine code besides where the build has it, that get the same orders. After each order their whole
// states must be equal.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "vm/sched/scheduler.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tests {

struct PairRun {
  std::string difference;  // empty: none
  uint64_t commands = 0;   // executed by each of them
  uint64_t orders = 0;
  bool native = false;  // one of them had machine code
};

// Random orders: budgets of 1 and more for all tasks, ticks, events, resumed waits, variables written from
// outside, tasks started and stopped. The host answers at random.
PairRun run_pair(const vm::VerifiedImage& program, uint64_t seed, uint32_t orders);

// Two machines through the same ticks and orders, the second with fast engine, machine code and skipping what
// is idle. Returns the difference; adds the ticks it has skipped, and all.
std::string run_idle_pair(const vm::VerifiedImage& program, uint64_t seed, uint32_t orders, uint64_t& skipped,
                          uint64_t& all);

// The same code behind commands that install interrupts, whose routines begin at random commands of it.
// Nothing for a program that does not fit then.
std::vector<uint32_t> with_interrupts(const std::vector<uint32_t>& code, const vm::Limits& limits,
                                      uint64_t seed);

// The code of commands whose labels are numbers of commands.
std::vector<uint32_t> assembled(std::vector<vm::Instruction> commands);

// A program for a MOVIDRIVE B made of the command sequences of the fast engine's table, with few variables
// and many jumps.
std::vector<uint32_t> sequence_soup(uint64_t seed);

// Loops over tables that begin, end and step near where variables in registers and the last variable are.
std::vector<uint32_t> table_loops(uint64_t seed, const vm::Limits& limits);

// A loop around a switch whose cases set the next case, at random.
std::vector<uint32_t> state_machine(uint64_t seed);

// The same as `ticks` of run_tick, as far as they are idle ones (Machine::idle_ticks): no more than `most`,
// and 0 when the next one is not. Adds the commands to `executed`.
inline uint64_t skip_idle(vm::Machine& machine, const vm::Rates& rates, uint64_t most, uint64_t& executed) {
  vm::Idle idle;
  const uint64_t ticks = std::min(most, machine.idle_ticks(rates.commands, idle));
  if (ticks != 0) executed += machine.skip_ticks(rates.commands, idle, ticks);
  return ticks;
}

}  // namespace ipos::tests
