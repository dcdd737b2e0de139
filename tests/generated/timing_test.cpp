// What the analysis of time says of programs whose commands were counted by hand in their listing, and of random ones, which
// never need more than it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "compiler/compile.hpp"
#include "compiler/analysis/timing.hpp"
#include "tests/generated/forms.hpp"
#include "tests/generated/program_generator.hpp"
#include "tests/generated/source_text.hpp"
#include "tests/generated/toolchain.hpp"
#include "vm/exec/machine.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tests {
namespace {

using compiler::FunctionTiming;
using Kind = FunctionTiming::Kind;
using Lines = std::vector<uint32_t>;

std::vector<FunctionTiming> timings(const std::string& text, const std::array<uint32_t, 3>& rates = {1, 2, 20}) {
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit("mdxb");
  const compiler::Compilation made = compiler::compile("T.IPC", "", text, options);
  EXPECT_TRUE(made.image.has_value()) << text;
  return made.image ? compiler::function_timings(*made.image, options.unit->variables, rates) : std::vector<FunctionTiming>{};
}

FunctionTiming timing(const std::string& text, const std::string& name = "main", const std::array<uint32_t, 3>& rates = {1, 2, 20}) {
  for (const FunctionTiming& row : timings(text, rates))
    if (row.name == name) return row;
  ADD_FAILURE() << "no function " << name;
  return {};
}

const std::string kVariables = "#include <constb.h>\nlong i, j, a, b, n[10];\n";

// SET, ADD; END.
TEST(Timing, StraightCode) {
  const FunctionTiming row = timing(kVariables + "main() { a = 1; a = a + b; }");
  EXPECT_EQ(row.commands, 3U);
  EXPECT_EQ(row.ms, 3U);
  EXPECT_EQ(row.because, "");
  EXPECT_EQ(row.kind, Kind::Call);
}

// The longer way of two: JMP, MUL, ADD, then END; the other one is JMP, SET, JMP, END. Task 1 has 3 commands a ms.
TEST(Timing, LongestWay) {
  const FunctionTiming row = timing(kVariables + "main()\n{\n  if (a == b)\n    i = 1;\n  else\n    i = i * 3 + 1;\n}", "main", {3, 2, 20});
  EXPECT_EQ(row.commands, 4U);
  EXPECT_EQ(row.ms, 2U);
  EXPECT_TRUE(std::find(row.longest.begin(), row.longest.end(), 8U) != row.longest.end());
  EXPECT_TRUE(std::find(row.longest.begin(), row.longest.end(), 6U) == row.longest.end());
}

// SET i, ten turns of MUL, ADD, JMP; END.
TEST(Timing, LoopsThatCount) {
  for (const char* loop : {"for (i = 0; i < 10; i++) a *= 3;", "for (i = 10; i > 0; i--) a *= 3;", "for (i = 0; i != 10; i++) a *= 3;",
                           "for (i = 1; i <= 10; i++) a *= 3;", "for (i = -20; i < 0; i += 2) a *= 3;",
                           "i = 0; do { a *= 3; i++; } while (i < 10);"}) {
    const FunctionTiming row = timing(kVariables + "main() { " + loop + " }");
    EXPECT_EQ(row.commands, 32U) << loop;
    ASSERT_EQ(row.loops.size(), 1U) << loop;
    EXPECT_EQ(row.loops.front().turns, 10U) << loop;
    EXPECT_EQ(row.loops.front().commands, 3U) << loop;
  }
  // SET, JMP; eleven times SET, SUB, JMP and ten times MUL; END.
  for (const char* loop : {"i = 10; while (i--) a *= 3;", "i = 10; while (i-- > 0) a *= 3;"}) {
    const FunctionTiming row = timing(kVariables + "main() { " + loop + " }");
    EXPECT_EQ(row.commands, 46U) << loop << row.because;
  }
}

// Four times SET j, five turns of ADD, ADD, JMP, then ADD and JMP: 1 + 4 * (1 + 15 + 2) + END.
TEST(Timing, LoopsInLoops) {
  const FunctionTiming row = timing(kVariables + "main() { for (i = 0; i < 4; i++) for (j = 0; j < 5; j++) a += b; }");
  EXPECT_EQ(row.commands, 74U);
}

// An index is in the array, so it does not change the counter.
TEST(Timing, StoresThroughAnIndex) {
  const FunctionTiming row = timing(kVariables + "main() { for (i = 0; i < 10; i++) n[i] = i; }");
  // SET, SET; SETI, ADD, ADD, JMP; END
  EXPECT_EQ(row.commands, 43U);
}

// The number of an element that grows with the counter is in the array, too: it is bounded as the counter is.
TEST(Timing, StoresThroughNumbersThatGrow) {
  const std::string head = "#include <constb.h>\ntypedef struct { long p; long q; long r; } T;\nlong i, j, a[9], b[9], s;\nT t[4];\nmain() { ";
  // SET, SET; SETI, ADD, SETI, three times ADD, JMP; END
  EXPECT_EQ(timing(head + "for (i = 0; i < 4; i++) t[i].q = t[i].p + 1; }").commands, 3U + 4 * 7 + 1);
  // From a variable that is known: SET s, SET, JMP, SET, ADD; SETI, three times ADD, JMP; END
  EXPECT_EQ(timing(head + "s = 3; for (i = s; i < 8; i++) b[0] += a[i]; }").commands, 5U + 5 * 5 + 1);
  // The whole of it: three times three times SET, SETI, ADD and the like. Only that it ends is told here.
  EXPECT_TRUE(timing(head + "for (i = 0; i < 3; i++) for (j = 0; j < 3; j++) a[i * 3 + j] = 0; }").commands);
  EXPECT_TRUE(timing(head + "for (i = 7; i > 0; i--) for (j = 0; j < i; j++) if (a[j] > a[j + 1]) { s = a[j]; a[j] = a[j + 1]; a[j + 1] = s; } }").commands);
}

TEST(Timing, WhatIsNotKnown) {
  EXPECT_FALSE(timing(kVariables + "main() { while (a < b) a++; }").commands);
  EXPECT_FALSE(timing(kVariables + "main() { for (i = 0; i < 10; i++) *a = 1; }").commands);  // whatever a names
  EXPECT_FALSE(timing(kVariables + "main() { for (i = 0; i < 10; i++) if (a) i = 0; }").commands);
  EXPECT_FALSE(timing(kVariables + "main() { while (!(H483 & 8)) ; }").commands);
  // The limit is the other task's.
  EXPECT_FALSE(timing(kVariables + "T() { while (1) b = a; }\nmain() { _SetTask2(T2_START, T); b = 5; for (i = 0; i < b; i++) a++; }").commands);
  // The counter is that of an interrupt routine.
  EXPECT_FALSE(timing(kVariables + "T() { i = 0; }\nmain() { _SetInterrupt(SI_TIMER0, T); for (i = 0; i < 5; i++) a++; }").commands);
  // The telegram's data come at any time.
  EXPECT_FALSE(timing(kVariables + "SCREC r;\nmain() { r.ObjectNo = 9; r.Format = 4; r.DPointer = numof(b); _SBusCommDef(SCD_REC, r); "
                                   "_SBusCommOn(); b = 3; for (i = 0; i < b; i++) a++; }").commands);
  // And without them it is known.
  EXPECT_TRUE(timing(kVariables + "main() { b = 3; for (i = 0; i < b; i++) a++; }").commands);
  EXPECT_NE(timing(kVariables + "main() { while (a < b) a++; }").because.find("line 3"), std::string::npos);
}

// A turn of the loop: ADD, WAIT, JMP. The wait lasts 10 ms and what is left of the one it begins in.
TEST(Timing, TurnsOfWhatNeverEnds) {
  const std::string text = kVariables + "T() { while (1) { a++; _Wait(10); } }\nmain() { b = 7; _SetTask2(T2_START, T); while (1) ; }";
  const FunctionTiming task = timing(text, "T");
  EXPECT_EQ(task.kind, Kind::Turn);
  EXPECT_EQ(task.task, 2);
  EXPECT_EQ(task.commands, 3U);
  EXPECT_EQ(task.ms, 13U);
  EXPECT_EQ(timing(text).commands, 1U);
}

TEST(Timing, WaitsThatOthersEnd) {
  const FunctionTiming row = timing(kVariables + "MOVLNK m;\nmain() { while (1) { _MoviLink(m); a++; } }");
  EXPECT_EQ(row.commands, 3U);
  EXPECT_FALSE(row.ms);
  EXPECT_EQ(row.because, "waits at line 4");
}

TEST(Timing, CallsAndRoutines) {
  const std::string text = kVariables + "F() { a++; }\nT() { F(); }\nmain() { _SetInterrupt(SI_TIMER0, T); while (1) { F(); F(); } }";
  EXPECT_EQ(timing(text, "F").commands, 2U);
  EXPECT_EQ(timing(text, "T").kind, Kind::Interrupt);
  EXPECT_EQ(timing(text, "T").commands, 4U);  // CALL, ADD, RET, RET
  EXPECT_EQ(timing(text).commands, 7U);       // twice CALL, ADD, RET; JMP
}

TEST(Timing, NeverBelowWhatRandomProgramsNeed) {
  size_t known = 0, met = 0;
  constexpr uint64_t kPrograms = 1000;
  for (uint64_t seed = 1; seed <= kPrograms; ++seed) {
    Program program = generate_program(seed);
    const ToolchainRun run = run_toolchain(program, source_text(program));
    ASSERT_EQ(run.trouble, "") << seed;
    const auto all = compiler::function_timings(run.image, stdlib::find_unit(run.image.unit)->variables, {1, 2, 20});
    const auto main = std::find_if(all.begin(), all.end(), [](const FunctionTiming& row) { return row.name == "main"; });
    ASSERT_NE(main, all.end()) << seed;
    if (!main->commands) continue;
    ++known;
    met += run.commands == *main->commands ? 1 : 0;
    ASSERT_LE(run.commands, *main->commands) << "seed " << seed << ": " << main->because << "\n" << source_text(program);
  }
  std::printf("%zu of %zu programs have a figure, %zu need that many\n", known, static_cast<size_t>(kPrograms), met);
  EXPECT_GT(known, kPrograms / 6) << "most write through pointers that name anything, counters among it";
}

TEST(Timing, NeverBelowWhatRandomLoopsNeed) {
  const stdlib::UnitType& unit = *stdlib::find_unit(std::string_view("mdxb"));
  size_t known = 0, met = 0;
  constexpr uint64_t kPrograms = 600, kMost = 300'000;
  for (uint64_t seed = 1; seed <= kPrograms; ++seed) {
    compiler::CompileOptions options;
    options.unit = &unit;
    const std::string text = forms_program(seed);
    const compiler::Compilation made = compiler::compile("T.IPC", "", text, options);
    ASSERT_TRUE(made.image) << text;
    const auto all = compiler::function_timings(*made.image, unit.variables, {1, 2, 20});
    const auto main = std::find_if(all.begin(), all.end(), [](const FunctionTiming& row) { return row.name == "main"; });
    ASSERT_NE(main, all.end()) << seed;
    if (!main->commands) continue;
    ++known;
    const auto image = vm::verify(made.image->code, {unit.variables, unit.program_words, unit.tasks, unit.call_depth}, {}).image;
    vm::Machine machine(*image, {});
    machine.start();
    const uint64_t needed = machine.run(1, kMost).commands;
    met += needed == *main->commands ? 1 : 0;
    ASSERT_LE(needed, *main->commands) << "seed " << seed << ": " << main->because << "\n" << text;
  }
  std::printf("%zu of %zu programs have a figure, %zu need that many\n", known, static_cast<size_t>(kPrograms), met);
  EXPECT_GT(known, kPrograms / 20);
}

}  // namespace
}  // namespace ipos::tests
