// The operations of the fast engine (vm/fast/operations.def): each row of the table is found in a program that has its
// commands, and does what they do, as machine code does. The reference interpreter is the expected value.
#include <gtest/gtest.h>

#include <random>

#include "tests/engines/sequence.hpp"

namespace ipos::tests {
namespace {

using vm::Instruction;
using vm::Opcode;
using vm::fast::Operation;
using vm::fast::Predecoded;

// Three variables are few enough that by chance each way comes up in which the commands of a row meet.
TEST(Rows, OfTheTableAreFoundAndDoWhatTheirCommandsDo) {
  std::mt19937 random(17);
  const auto below = [&](int32_t limit) {
    return static_cast<int32_t>(random() % static_cast<uint32_t>(limit));
  };
  size_t found = 0;
  for (uint16_t n = 0; n < static_cast<uint16_t>(Operation::kCount); ++n) {
    const auto wanted = static_cast<Operation>(n);
    const std::span<const Opcode> opcodes = vm::fast::commands_of(wanted);
    if (opcodes.empty()) continue;
    int32_t end = 0;
    for (const Opcode opcode : opcodes) end += vm::info(opcode).words;
    int hits = 0;
    for (int tries = 0; tries < 30'000 && hits == 0; ++tries) {
      std::vector<Instruction> commands;
      for (const Opcode opcode : opcodes) {
        Instruction command{opcode, {}};
        const vm::OpcodeInfo& row = vm::info(opcode);
        for (size_t k = 0; k < static_cast<size_t>(row.operand_count); ++k) switch (row.operands[k].kind) {
            case vm::OperandKind::Variable: command.operands[k] = 10 + below(3); break;
            case vm::OperandKind::Bit: command.operands[k] = below(32); break;
            case vm::OperandKind::Count: command.operands[k] = 1 + below(4); break;
            case vm::OperandKind::Label: command.operands[k] = below(2) == 0 ? 0 : end; break;
            default: command.operands[k] = below(8) == 0 ? 0 : below(40) - 8; break;
          }
        commands.push_back(command);
      }
      for (const Opcode behind : {Opcode::Nop, Opcode::Nop, Opcode::End}) commands.push_back({behind, {}});
      const Sequence sequence(commands);
      ASSERT_TRUE(sequence.good());
      if (sequence.predecoded().operation(0) != wanted) continue;
      ++hits;
      SCOPED_TRACE(vm::fast::operation_name(wanted));
      EXPECT_EQ(sequence.predecoded().commands(0), opcodes.size());
      {
        std::vector<int32_t> variables(kRowLimits.variables);
        for (int32_t& value : variables) value = below(100) - 20;
        ASSERT_NO_FATAL_FAILURE(sequence.expect_equal(variables, static_cast<uint32_t>(opcodes.size()) + 3));
      }
    }
    EXPECT_GT(hits, 0) << vm::fast::operation_name(wanted) << " is never taken";
    found += hits > 0 ? 1 : 0;
  }
  EXPECT_GT(found, 200U);
}

// All bits of a variable stay but the one that is meant, whatever they are.
TEST(Rows, BitsAreMovedAlone) {
  for (const int32_t to : {0, 1, 7, 30, 31})
    for (const int32_t from : {0, 1, 7, 30, 31}) {
      const Sequence sequence({{Opcode::BitMove, {1, to, 2, from}},
                               {Opcode::BitMoveNeg, {3, to, 2, from}},
                               {Opcode::BitSet, {4, to, 0, 0}},
                               {Opcode::BitClear, {5, to, 0, 0}},
                               {Opcode::End, {}}});
      ASSERT_TRUE(sequence.good());
      for (const int32_t target : {0, -1, 0x12345678})
        for (const int32_t source : {0, -1, 0x12345678})
          ASSERT_NO_FATAL_FAILURE(sequence.expect_equal({0, target, source, target, target, target}, 1));
    }
}

// A chain of comparisons of H1 with constants, each of which leads to a case of its own. Three of them and more are a
// switch: a dense one as far as the constants count up by one, else a sparse one.
TEST(Switches, AreChainsOfAtLeastThreeComparisons) {
  constexpr int32_t kMost = INT32_MAX;
  const std::vector<int32_t> chains[] = {{5},
                                         {5, 6},
                                         {5, 6, 7},
                                         {5, 6, 7, 8, 9},
                                         {5, 7, 8},
                                         {5, 6, 8},
                                         {5, 6, 7, 20},
                                         {5, 6, 20, 21, 22},
                                         {20, 5, 6, 7},
                                         {7, 6, 5},
                                         {5, 5, 5},
                                         {0, 1, 2, 3},
                                         {-2, -1, 0, 1},
                                         {kMost - 1, kMost, INT32_MIN, INT32_MIN + 1},
                                         {100, -100, 3, 0, kMost}};
  for (const std::vector<int32_t>& chain : chains)
    for (const bool set_first : {false, true}) {
      // Of the chain from each comparison on: how many count up, how many there are.
      const auto straight = [&](size_t from) {
        uint32_t count = 1;
        while (from + count < chain.size() &&
               static_cast<uint32_t>(chain[from + count]) == static_cast<uint32_t>(chain[from]) + count)
          ++count;
        return count;
      };
      const uint32_t head = set_first ? 1 : 0;
      const auto first_case = static_cast<int32_t>(head + 3 * chain.size() + 3);
      std::vector<Instruction> commands;
      if (set_first) commands.push_back({Opcode::SetHH, {1, 2, 0, 0}});
      for (size_t n = 0; n < chain.size(); ++n)
        commands.push_back({Opcode::JmpEqHK, {1, chain[n], first_case + 3 * static_cast<int32_t>(n), 0}});
      commands.push_back({Opcode::SetHK, {3, -1, 0, 0}});
      commands.push_back({Opcode::End, {}});
      for (size_t n = 0; n < chain.size(); ++n) {
        commands.push_back({Opcode::SetHK, {3, static_cast<int32_t>(n), 0, 0}});
        commands.push_back({Opcode::End, {}});
      }
      const Sequence sequence(commands);
      ASSERT_TRUE(sequence.good());
      const Predecoded& made = sequence.predecoded();
      for (size_t n = 0; n < chain.size(); ++n) {
        const auto at = static_cast<uint32_t>(head + 3 * n);
        const auto rest = static_cast<uint32_t>(chain.size() - n);
        const bool is_switch = rest >= 3, dense = straight(n) >= 3;
        const std::string name = vm::fast::operation_name(made.operation(at));
        EXPECT_EQ(name.find("Switch") != std::string::npos, is_switch) << chain.size() << " " << n;
        if (!is_switch) continue;
        EXPECT_EQ(name, dense ? "SwitchDense" : "SwitchSparse") << chain[0] << " " << n;
        EXPECT_EQ(made.commands(at), dense ? straight(n) : rest) << chain[0] << " " << n;
      }
      if (set_first && chain.size() >= 3) {
        const bool dense = straight(0) >= 3;
        EXPECT_STREQ(vm::fast::operation_name(made.operation(0)),
                     dense ? "SetSwitchDense" : "SetSwitchSparse");
        EXPECT_EQ(made.commands(0), 1 + (dense ? straight(0) : chain.size()));
      }
      std::vector<int32_t> values{0, 1, 4, 10, kMost, INT32_MIN, -1};
      for (const int32_t constant : chain)
        for (const uint32_t near : {UINT32_MAX, 0U, 1U})
          values.push_back(static_cast<int32_t>(static_cast<uint32_t>(constant) + near));
      for (const int32_t value : values)
        ASSERT_NO_FATAL_FAILURE(
            sequence.expect_equal({0, value, value, 0}, static_cast<uint32_t>(chain.size()) + 4))
            << value;
    }
}

// Comparisons of another variable, and SETs of one, do not belong to the chain.
TEST(Switches, AreOfOneVariable) {
  const auto name = [](std::vector<Instruction> commands, uint32_t at) {
    commands.push_back({Opcode::End, {}});
    const Sequence sequence(commands);
    return std::string(vm::fast::operation_name(sequence.predecoded().operation(at)));
  };
  const auto test = [](int32_t variable, int32_t constant) {
    return Instruction{Opcode::JmpEqHK, {variable, constant, 0, 0}};
  };
  EXPECT_EQ(name({test(1, 5), test(1, 6), test(2, 7)}, 0).find("Switch"), std::string::npos);
  EXPECT_EQ(name({test(2, 5), test(1, 6), test(1, 7)}, 0).find("Switch"), std::string::npos);
  EXPECT_EQ(name({test(2, 5), test(1, 6), test(1, 7), test(1, 8)}, 3), "SwitchDense");
  EXPECT_EQ(name({test(1, 5), {Opcode::Nop, {}}, test(1, 6), test(1, 7)}, 0).find("Switch"),
            std::string::npos);
  EXPECT_EQ(name({{Opcode::SetHH, {2, 1, 0, 0}}, test(1, 6), test(1, 7), test(1, 8)}, 0).find("Switch"),
            std::string::npos);
  EXPECT_EQ(name({{Opcode::SetHH, {1, 2, 0, 0}}, test(1, 6), test(1, 7)}, 0).find("Switch"),
            std::string::npos);
}

// A switch counts as one operation: what stands in front of it joins its first command only where a result stays in a
// register then, and else the fewest operations are taken, the plain ones first.
TEST(Switches, AreOneOperationBehindOthers) {
  for (const int32_t last : {7, 17}) {
    const auto name = [&](std::vector<Instruction> commands, uint32_t at) {
      for (const int32_t constant : {5, 6, last}) commands.push_back({Opcode::JmpEqHK, {1, constant, 0, 0}});
      commands.push_back({Opcode::End, {}});
      return std::string(vm::fast::operation_name(Sequence(commands).predecoded().operation(at)));
    };
    const std::string kind = last == 7 ? "Dense" : "Sparse";
    const Instruction other_sum{Opcode::AddHK, {3, 1, 0, 0}};
    const Instruction set{Opcode::SetHH, {1, 2, 0, 0}}, sum_to_set{Opcode::AddHK, {2, 1, 0, 0}};
    EXPECT_EQ(name({{Opcode::SetHK, {3, 0, 0, 0}}}, 0), "SetHK");
    EXPECT_EQ(name({{Opcode::SetHK, {3, 0, 0, 0}}}, 2), "Switch" + kind);
    EXPECT_EQ(name({other_sum, set}, 0), "AddHK");
    EXPECT_EQ(name({other_sum, set}, 2), "SetSwitch" + kind);
    EXPECT_EQ(name({sum_to_set, set}, 0), "AddHK_to_SetHH");
  }
}

// A line is what follows until a command that leads elsewhere, itself included; branches do not end it.
TEST(Rows, LinesEndWhereACommandLeadsElsewhere) {
  struct Row {
    Instruction last;
    bool ends;
  };
  for (const Row& row : {Row{{Opcode::Jmp, {0, 0, 0, 0}}, true},
                         {{Opcode::Call, {0, 0, 0, 0}}, true},
                         {{Opcode::Ret, {}}, true},
                         {{Opcode::End, {}}, true},
                         {{Opcode::WaitK, {5, 0, 0, 0}}, true},
                         {{Opcode::ScomOn, {}}, true},
                         {{Opcode::JmpEqHH, {1, 2, 0, 0}}, false},
                         {{Opcode::JmpLtHK, {1, 2, 0, 0}}, false},
                         {{Opcode::Nop, {}}, false},
                         {{Opcode::DivHH, {1, 2, 0, 0}}, false}}) {
    const Sequence sequence(
        {{Opcode::Nop, {}}, {Opcode::AddHK, {1, 2, 0, 0}}, row.last, {Opcode::Nop, {}}, {Opcode::End, {}}});
    const auto words = static_cast<uint32_t>(vm::info(row.last.opcode).words);
    const Predecoded& made = sequence.predecoded();
    const uint32_t behind = row.ends ? 0 : 2;
    EXPECT_EQ(made.line(3), 1 + behind) << vm::info(row.last.opcode).text;
    EXPECT_EQ(made.line(1), 2 + behind) << vm::info(row.last.opcode).text;
    EXPECT_EQ(made.line(0), 3 + behind) << vm::info(row.last.opcode).text;
    EXPECT_EQ(made.line(3 + words), 2U);
    EXPECT_EQ(made.line(4 + words), 1U);
    EXPECT_EQ(made.line(2), 0U) << "no command begins here";
  }
}

}  // namespace
}  // namespace ipos::tests
