// The words behind an index area: which of them are kept, whose words they are, and where a program ends.
#include "runtime/nv_memory/kept/index_windows.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/vm/code.hpp"

namespace ipos::runtime {
namespace {

using tests::code_of;
using tests::I;
using vm::Opcode;

struct Saves final : NonvolatileMemory {
  bool save(uint16_t index) override {
    indices.push_back(index);
    return works;
  }
  void changed() override {}
  std::vector<uint16_t> indices;
  bool works = true;
};

constexpr uint16_t kFirst = 11000;

class Values : public ::testing::Test {
 protected:
  Saves memory_;
  ValueWindow window_{memory_, kFirst, 6, 4};
};

TEST_F(Values, TheFirstAreKept) {
  for (const uint16_t kept : std::initializer_list<uint16_t>{0, 3}) {
    EXPECT_TRUE(window_.stored(kept));
    EXPECT_EQ(window_.kept_at(static_cast<uint16_t>(kFirst + kept)), &window_.kept()[kept]);
  }
  EXPECT_FALSE(window_.stored(4));
  for (const uint16_t other : std::initializer_list<uint16_t>{0, 4, kFirst - 1, kFirst + 4, 0xFFFF})
    EXPECT_EQ(window_.kept_at(other), nullptr) << other;
  EXPECT_EQ(window_.words().size(), 6U);
  EXPECT_EQ(ValueWindow(memory_, kFirst, 2, 4).kept().size(), 2U) << "no more are kept than there are";
}

TEST_F(Values, OnlyTheStoringServiceKeeps) {
  EXPECT_EQ(window_.write(3, 5, false), 5);
  EXPECT_EQ(window_.write(4, 6, true), 6);
  EXPECT_TRUE(memory_.indices.empty());
  EXPECT_EQ(window_.write(3, 7, true), 7);
  EXPECT_EQ(memory_.indices, std::vector<uint16_t>{kFirst + 3});
  EXPECT_EQ(window_.kept()[3], 7);
  memory_.works = false;
  const ParameterReply reply = window_.write(3, 8, true);
  ASSERT_FALSE(reply);
  EXPECT_EQ(reply.error(), stdlib::return_codes::kNotSaved);
  EXPECT_EQ(window_.read(3), 8) << "the working value";
  EXPECT_EQ(window_.kept()[3], 7) << "the stored value is the old one";
}

// The words of a running program take over what is there, and give it back before they vanish.
TEST_F(Values, WordsOfSomebodyElse) {
  window_.write(0, 1, true);
  window_.write(5, 2, false);
  {
    std::array<int32_t, 8> others{9, 9, 9, 9, 9, 9, 9, 9};
    window_.use(others);
    EXPECT_EQ(others, (std::array<int32_t, 8>{1, 0, 0, 0, 0, 2, 9, 9})) << "as many as the window has";
    others[1] = 3;
    EXPECT_EQ(window_.read(1), 3);
    window_.park();
    others.fill(7);
  }
  EXPECT_EQ(std::vector<int32_t>(window_.words().begin(), window_.words().end()),
            (std::vector<int32_t>{1, 3, 0, 0, 0, 2}));
  window_.park();
  EXPECT_EQ(window_.read(1), 3) << "they are its own already";
}

TEST_F(Values, PowerOnLeavesTheWordsOfSomebodyElse) {
  window_.write(3, 1, true);
  window_.write(5, 2, false);
  std::array<int32_t, 6> others{};
  window_.use(others);
  window_.write(0, 4, false);
  window_.restart();
  EXPECT_EQ(std::vector<int32_t>(window_.words().begin(), window_.words().end()),
            (std::vector<int32_t>{0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(window_.words().size(), 6U);
  EXPECT_EQ(others[0], 4);
  EXPECT_NE(window_.words().data(), others.data());
}

class Program : public ::testing::Test {
 protected:
  Saves memory_;
  ProgramWindow window_{memory_, 16000, 8};
};

TEST_F(Program, HasAWordForEveryIndexAndForAllOfTheProgram) {
  EXPECT_TRUE(window_.restart(std::vector<uint32_t>{1, 2}));
  EXPECT_EQ(window_.read(1), 2);
  EXPECT_EQ(window_.read(7), 0);
  const std::vector<uint32_t> longer(9, 0xEE);
  EXPECT_TRUE(window_.restart(longer));
  EXPECT_EQ(window_.code(), longer);
}

// A command behind all others has its operands, of words that are 0, and so has one that was written.
TEST_F(Program, TheLastCommandHasItsOperands) {
  for (const vm::OpcodeInfo& row : vm::opcode_table()) {
    const std::vector<uint32_t> whole = code_of({I(row.opcode)});
    ASSERT_LE(whole.size(), 4U);
    if (whole.front() == 0 || vm::decode(whole, 0).status != vm::DecodeStatus::Ok) continue;
    window_.restart(std::vector<uint32_t>{whole.front()});
    EXPECT_EQ(window_.code(), whole) << row.mnemonic();
    window_.restart({});
    window_.write(0, static_cast<int32_t>(whole.front()), false);
    EXPECT_EQ(window_.code(), whole) << row.mnemonic();
  }
}

// JMP 0 ends in a word that is 0, RET is one word, and what is no command counts as one word.
TEST_F(Program, EndsWithItsLastCommand) {
  window_.restart({});
  EXPECT_TRUE(window_.code().empty());
  const auto jump = code_of({I(Opcode::Jmp, 0)});
  ASSERT_EQ(jump.back(), 0U);
  window_.restart(jump);
  EXPECT_EQ(window_.code(), jump);
  const auto two = code_of({I(Opcode::AddHK, 200, 1), I(Opcode::Jmp, 0)});
  window_.restart(two);
  EXPECT_EQ(window_.code(), two);
  window_.restart(std::vector<uint32_t>{0xEE, 0, 0xEE, 0, 0});
  EXPECT_EQ(window_.code(), (std::vector<uint32_t>{0xEE, 0, 0xEE}));
}

TEST_F(Program, ItsChangeIsKeptUntilItIsTakenBack) {
  const std::vector<uint32_t> plant = code_of({I(Opcode::SetHK, 200, 7), I(Opcode::End)});
  window_.restart(plant);
  EXPECT_EQ(window_.write(7, 0xEE, false), 0xEE);
  EXPECT_TRUE(memory_.indices.empty());
  EXPECT_EQ(window_.kept(), std::nullopt) << "written volatile";
  EXPECT_EQ(window_.write(6, 0xEF, true), 0xEF);
  EXPECT_EQ(memory_.indices, std::vector<uint16_t>{16006});
  ASSERT_TRUE(window_.kept());
  EXPECT_EQ(window_.kept()->words.size(), 8U) << "the whole memory as it is then";
  EXPECT_TRUE(window_.restart(plant));
  EXPECT_EQ(window_.read(6), 0xEF);
  const NvProgram before = *window_.kept();
  memory_.works = false;
  EXPECT_EQ(window_.write(6, 0, true).error(), stdlib::return_codes::kNotSaved);
  EXPECT_EQ(window_.read(6), 0) << "the working word";
  EXPECT_EQ(window_.kept(), before);
  memory_.works = true;
  EXPECT_EQ(window_.write(7, 0, true), 0);
  EXPECT_EQ(window_.kept(), std::nullopt) << "it is the plant's program again";
}

TEST_F(Program, AChangeOfAnotherProgramIsDropped) {
  window_.set_kept(NvProgram{0, {1}});
  EXPECT_FALSE(window_.restart(std::vector<uint32_t>{5}));
  EXPECT_EQ(window_.kept(), std::nullopt);
  EXPECT_EQ(window_.read(0), 5);
  // The CRC-32 of these words, least significant byte first, by Python's zlib.
  window_.set_kept(NvProgram{0x86829DEB, {6}});
  EXPECT_TRUE(window_.restart(std::vector<uint32_t>{0x12345678, 0x9ABCDEF0}));
  EXPECT_EQ(window_.read(0), 6);
  EXPECT_EQ(window_.read(1), 0);
}

TEST_F(Program, IsClosedWhileAnyTaskRuns) {
  const std::vector<uint32_t> code = code_of({I(Opcode::End)});
  const vm::Limits limits{512, 8, 3, 16};
  vm::Machine machine(vm::verify(code, limits, {}).image.value(), {});
  window_.restart(code);
  EXPECT_EQ(window_.write(5, 1, false), 1) << "no machine";
  window_.watch(&machine);
  EXPECT_EQ(window_.write(5, 2, false), 2) << "no task";
  for (int task = 1; task <= 3; ++task) {
    machine.start_task(task, 0);
    const ParameterReply reply = window_.write(5, 3, true);
    ASSERT_FALSE(reply) << task;
    EXPECT_EQ(reply.error(), stdlib::return_codes::kProtected);
    EXPECT_EQ(window_.read(5), 2);
    machine.stop_all();
    EXPECT_EQ(window_.write(5, 2, false), 2);
  }
  EXPECT_TRUE(memory_.indices.empty());
  machine.start_task(1, 0);
  window_.watch(nullptr);
  EXPECT_EQ(window_.write(5, 4, false), 4);
}

}  // namespace
}  // namespace ipos::runtime
