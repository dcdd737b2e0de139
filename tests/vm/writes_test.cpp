// What is said of a program's writes against what its commands do: each command that goes on to the next is
// executed on random variables, and what has changed must have been foretold.
#include "vm/verify/writes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/vm/code.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::vm {
namespace {

using tests::code_of;
using tests::I;

constexpr Limits kLimits{1024, 16384, 3, 32};

VerifiedImage verified(const std::vector<uint32_t>& code) {
  const Verification result = verify(code, kLimits, {});
  EXPECT_TRUE(result.image.has_value());
  return *result.image;
}

TEST(Writes, WhatChangesWasForetold) {
  std::mt19937 random(7);
  const auto below = [&](int32_t limit) {
    return static_cast<int32_t>(random() % static_cast<uint32_t>(limit));
  };
  uint32_t changed = 0;
  for (const OpcodeInfo& row : opcode_table()) {
    if (row.flow != Flow::Next) continue;
    for (int round = 0; round < 200; ++round) {
      Instruction command{row.opcode, {}};
      for (int n = 0; n < row.operand_count; ++n) {
        int32_t& operand = command.operands[static_cast<size_t>(n)];
        switch (row.operands[static_cast<size_t>(n)].kind) {
          case OperandKind::Variable: operand = 100 + below(500); break;
          case OperandKind::Bit: operand = below(32); break;
          case OperandKind::Count: operand = 1 + below(300); break;
          default: operand = below(5000) - 2500;
        }
      }
      const std::vector<uint32_t> code = code_of({command, I(Opcode::End)});
      const VerifiedImage image = verified(code);
      Machine machine(image, {});
      machine.start();
      for (int32_t& value : machine.variables()) value = below(1024);
      const std::vector<int32_t> before(machine.variables().begin(), machine.variables().end());
      machine.run(1, 1);
      for (uint32_t n = 0; n < before.size(); ++n) {
        if (machine.variables()[n] == before[n]) continue;
        ++changed;
        EXPECT_TRUE(may_write(image, n, n)) << row.text << " wrote H" << n;
        EXPECT_TRUE(may_write(image, 0, n)) << row.text;
        EXPECT_TRUE(may_write(image, n, 1023)) << row.text;
      }
    }
  }
  EXPECT_GT(changed, 5000U);
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
