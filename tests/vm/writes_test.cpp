// What the opcode table says of variables and faults against what commands do: each one is executed on random
// variables, and what it has changed, read and faulted with must have been foretold.
#include "vm/verify/writes.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/vm/code.hpp"
#include "vm/exec/machine.hpp"
#include "vm/isa/effects.hpp"

namespace ipos::vm {
namespace {

using tests::code_of;
using tests::I;

VerifiedImage verified(const std::vector<uint32_t>& code) {
  const Verification result = verify(code, Limits{1024, 16384, 3, 32}, {});
  EXPECT_TRUE(result.image.has_value());
  return *result.image;
}

// Commands of a row that does not leave the machine, on random variables.
class Rows {
 public:
  int32_t below(int32_t limit) { return static_cast<int32_t>(random_() % static_cast<uint32_t>(limit)); }

  template <class Try>
  void each(Try attempt) {
    for (const OpcodeInfo& row : opcode_table()) {
      if (row.flow == Flow::System || row.flow == Flow::SystemCall) continue;
      for (int round = 0; round < 200; ++round) {
        Instruction command{row.opcode, {}};
        for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n)
          command.operands[n] = operand(row.operands[n].kind);
        const std::vector<uint32_t> code = code_of({command, I(Opcode::End)});
        const VerifiedImage image = verified(code);
        Machine machine(image, {});
        machine.start();
        for (int32_t& value : machine.variables()) value = below(1030) - 3;
        attempt(row, command, machine);
      }
    }
  }

 private:
  int32_t operand(OperandKind kind) {
    switch (kind) {
      case OperandKind::Variable: return 100 + below(500);
      case OperandKind::Bit: return below(32);
      case OperandKind::Count: return 1 + below(300);
      case OperandKind::Label: return 0;
      default: return below(3) == 0 ? 0 : below(5000) - 2500;
    }
  }
  std::mt19937 random_{7};
};

TEST(Writes, WhatChangesWasForetold) {
  uint32_t changed = 0;
  Rows().each([&](const OpcodeInfo& row, const Instruction& command, Machine& machine) {
    const std::vector<int32_t> before(machine.variables().begin(), machine.variables().end());
    machine.run(1, 1);
    const std::span<const int32_t> after = machine.variables();
    for (uint32_t n = 0; n < before.size(); ++n) {
      if (after[n] == before[n]) continue;
      ++changed;
      EXPECT_TRUE(named_target(command).has(n) || coding(row.opcode).writes == Writes::Indexed) << row.text;
      EXPECT_TRUE(may_write(machine.program(), n, n)) << row.text << " wrote H" << n;
      EXPECT_TRUE(may_write(machine.program(), 0, n)) << row.text;
      EXPECT_TRUE(may_write(machine.program(), n, 1023)) << row.text;
    }
  });
  EXPECT_GT(changed, 5000U);
}

// Other values of the variables it does not read change nothing of what it does.
TEST(Writes, WhatIsReadWasForetold) {
  Rows rows;
  rows.each([&](const OpcodeInfo& row, const Instruction& command, Machine& machine) {
    if (coding(row.opcode).reads == Reads::Indexed) return;  // of any variable
    std::vector<bool> named(1024);
    each_named(command, [&](VariableRange range) {
      for (uint32_t n = range.first; n < range.end(); ++n) named[n] = true;
    });
    Machine other = machine;
    for (uint32_t n = 0; n < named.size(); ++n)
      if (!named[n]) other.variables()[n] = rows.below(1030);
    const Machine before = machine;
    machine.run(1, 1);
    other.run(1, 1);
    EXPECT_EQ(machine.task(1).pc, other.task(1).pc) << row.text;
    EXPECT_EQ(machine.fault().number, other.fault().number) << row.text;
    const std::span<const int32_t> was = before.variables(), is = machine.variables(),
                                   too = other.variables();
    for (uint32_t n = 0; n < named.size(); ++n)
      if (is[n] != was[n] && is[n] != too[n]) ADD_FAILURE() << row.text << " H" << n;
  });
}

TEST(Writes, FaultsWereForetold) {
  uint32_t faults = 0;
  Rows().each([&](const OpcodeInfo& row, const Instruction& command, Machine& machine) {
    machine.run(1, 1);
    const bool faulted = machine.fault().number != 0;
    faults += faulted ? 1 : 0;
    EXPECT_TRUE(!faulted || can_fault(command)) << row.text;
    EXPECT_TRUE(faulted || !always_faults(command)) << row.text;
  });
  EXPECT_GT(faults, 100U);
}

TEST(Writes, OthersAreExcluded) {
  const std::vector<uint32_t> code = code_of(
      {I(Opcode::Nop), I(Opcode::SetHH, 400, 500), I(Opcode::Copy, 410, 600, 5),
       I(Opcode::JmpEqHK, 700, 1, 0), I(Opcode::WaitH, 701), I(Opcode::GetSys, 702, 1), I(Opcode::End)});
  const VerifiedImage image = verified(code);
  EXPECT_TRUE(may_write(image, 400, 400));
  EXPECT_FALSE(may_write(image, 401, 409));
  EXPECT_TRUE(may_write(image, 414, 414));
  EXPECT_FALSE(may_write(image, 415, 1023)) << "what is only read, and what the host writes";
  EXPECT_FALSE(may_write(image, 0, 399));
  const std::vector<uint32_t> anywhere = code_of({I(Opcode::SetiStore, 1, 2), I(Opcode::End)});
  EXPECT_TRUE(may_write(verified(anywhere), 900, 900));
  // The machine notes the value a variable interrupt has seen.
  const std::vector<uint32_t> noted = code_of({I(Opcode::VarInt, 10, 0), I(Opcode::End)});
  EXPECT_TRUE(may_write(verified(noted), 16, 16));
}

}  // namespace
}  // namespace ipos::vm
