// Temporaries of tasks and interrupt routines: what one of them computes with is never touched by another.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/compiler/backend_test.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::compiler::test {
namespace {

using Lines = std::vector<std::string>;

// Variables below H420 that the commands reached from an address use, calls included.
std::set<int32_t> temporaries_from(const vm::Image& image, uint32_t start) {
  std::set<int32_t> out;
  std::set<uint32_t> seen;
  std::vector<uint32_t> open{start};
  while (!open.empty()) {
    const uint32_t at = open.back();
    open.pop_back();
    if (!seen.insert(at).second) continue;
    const vm::Decoded decoded = vm::decode(image.code, at);
    const vm::OpcodeInfo& row = vm::info(decoded.instruction.opcode);
    for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n) {
      const int32_t operand = decoded.instruction.operands[n];
      if (row.operands[n].kind == vm::OperandKind::Variable && operand >= 300 && operand < 420)
        out.insert(operand);
      const bool follows = row.flow == vm::Flow::Jump || row.flow == vm::Flow::Branch ||
                           row.flow == vm::Flow::Call || row.flow == vm::Flow::SystemCall;
      if (row.operands[n].kind == vm::OperandKind::Label && follows)
        open.push_back(static_cast<uint32_t>(operand));
    }
    if (row.flow != vm::Flow::Jump && row.flow != vm::Flow::Return && row.flow != vm::Flow::End)
      open.push_back(at + decoded.words);
  }
  return out;
}

// Start addresses of main and of everything that is started or installed.
std::vector<uint32_t> roots(const vm::Image& image) {
  std::vector<uint32_t> out{0};
  for (const CodeItem& item : code_items(image.code)) {
    const vm::Opcode opcode = item.command->opcode;
    if (opcode == vm::Opcode::Task || opcode == vm::Opcode::Task2 || opcode == vm::Opcode::SetInt ||
        opcode == vm::Opcode::VarInt)
      out.push_back(static_cast<uint32_t>(item.command->operands[1]));
  }
  return out;
}

void expect_disjoint(const std::string& text) {
  const Compilation c = compile_text(text, "mdxb");
  ASSERT_TRUE(c.image) << render_text(c.diagnostics.all(), *c.sources, false);
  const std::vector<uint32_t> starts = roots(*c.image);
  for (size_t a = 0; a < starts.size(); ++a) {
    const auto first = temporaries_from(*c.image, starts[a]);
    EXPECT_FALSE(first.empty());
    for (size_t b = a + 1; b < starts.size(); ++b)
      for (const int32_t number : temporaries_from(*c.image, starts[b]))
        EXPECT_FALSE(first.contains(number)) << "H" << number;
  }
}

TEST(Temporaries, OfTasksAndInterruptsAreDisjoint) {
  expect_disjoint(
      "long a, b, c; VARINT v;"
      "t2() { a = b * c + a; } t3() { a = b * c + a; } e() { a = b * c + a; } i() { a = b * c + a; }"
      "main() { _SetTask2(1, t2); _SetTask(1, t3); _SetInterrupt(1, e); _SetVarInterrupt(v, i); a = b * c + "
      "a; }");
}

TEST(Temporaries, OfASharedFunctionAreDisjointForEachCaller) {
  expect_disjoint(
      "long a, b, c; shared() { a = b * c + a; } outer() { shared(); }"
      "t() { outer(); } e() { outer(); }"
      "main() { _SetTask2(1, t); _SetInterrupt(1, e); _SetInterrupt(2, e); outer(); }");
}

TEST(Temporaries, OfOneFunctionAsTwoTasksAreDisjoint) {
  expect_disjoint("long a, b, c; t() { a = b * c + a; } main() { _SetTask2(1, t); _SetTask(1, t); t(); }");
}

TEST(Temporaries, EachCallThatInstallsAVariableInterruptCountsAsOne) {
  expect_disjoint(
      "long a, b, c; VARINT v, w; i() { a = b * c + a; }"
      "main() { _SetVarInterrupt(v, i); _SetVarInterrupt(w, i); a = b * c + a; }");
}

TEST(Temporaries, FunctionsWithoutThemAreThereOnce) {
  const Compilation c = compile_text("f() { H0++; } t() { f(); } main() { _SetTask2(1, t); f(); }");
  EXPECT_EQ((Lines{"M01 : TASK2 START , M03", "CALL M02", "END", "M02 : ADD H0 + 1", "RET", "M03 : CALL M02",
                   "RET"}),
            commands(c));
}

TEST(Temporaries, CopiesAreNamedAfterTheirRoot) {
  const Compilation c =
      compile_text("long a, b; f() { a = a * b + a; } t() { f(); } main() { _SetTask2(1, t); f(); }");
  ASSERT_TRUE(c.image);
  std::vector<std::string> names;
  for (const vm::FunctionEntry& function : c.image->functions) names.push_back(function.name);
  EXPECT_EQ((std::vector<std::string>{"main", "f", "f@t", "t"}), names);
}

// One function may be several roots: then the copies' names go on with a number, that of the copy.
TEST(Temporaries, CopiesOfOneFunctionHaveNamesOfTheirOwn) {
  const Compilation c = compile_text(
      "long a, b, c; t() { a = b * c + a; } main() { _SetTask2(1, t); _SetTask(1, t); t(); }", "mdxb");
  ASSERT_TRUE(c.image);
  std::vector<std::string> names;
  for (const vm::FunctionEntry& function : c.image->functions) names.push_back(function.name);
  EXPECT_EQ((std::vector<std::string>{"main", "t", "t@t", "t@t@3"}), names);
}

// A program that is too long names what stands more than once: here all of it is main, once as main, once as task 2.
TEST(Temporaries, MainAsATaskIsACopyToo) {
  std::string text = "long a, b, c; main() { _SetTask2(1, main); ";
  for (int n = 0; n < 500; ++n) text += "a = b * c + a; ";
  const Compilation c = compile_text(text + "}", "md60a");
  const auto message = std::find_if(c.diagnostics.all().begin(), c.diagnostics.all().end(),
                                    [](const Diagnostic& row) { return row.diag == Diag::ProgramTooLong; });
  ASSERT_NE(message, c.diagnostics.all().end());
  // TASK2 and END or RET; SET, MUL and ADD of variables are a word each.
  const int words = 2 * (2 + 500 * 3 + 1);
  EXPECT_NE(message->text.find(std::to_string(words)), std::string::npos) << message->text;
  ASSERT_EQ(message->notes.size(), 1U);
  EXPECT_EQ(message->notes[0].text,
            "'main' stands 2 times (main, main): " + std::to_string(words) + " words");
}

// STOP and DISABLE do not say which task or interrupt: a copy that this command has started or installed, if there is
// one, else any.
TEST(Temporaries, WhatIsStoppedIsACopyOfTheFunction) {
  // Where the labels of the calls lead, all of them copies of t.
  const auto labels = [](const std::string& calls) {
    const Compilation c = compile_text(
        "long a, b, c; t() { a = b * c + a; } main() { t(); " + calls + " a = b * c + a; }", "mdxb");
    std::vector<uint32_t> out;
    if (!c.image) return out;
    out = roots(*c.image);
    out.erase(out.begin());  // main
    for (const uint32_t start : out) {
      const auto at =
          std::find_if(c.image->functions.begin(), c.image->functions.end(),
                       [&](const vm::FunctionEntry& function) { return function.address == start; });
      EXPECT_TRUE(at != c.image->functions.end() && at->name.substr(0, 1) == "t") << calls;
    }
    return out;
  };
  for (const char* calls : {"_SetInterrupt(2, t); _SetInterrupt(0, t);", "_SetTask2(1, t); _SetTask2(0, t);",
                            "_SetTask(1, t); _SetTask(0, t);"}) {
    const std::vector<uint32_t> found = labels(calls);
    ASSERT_EQ(found.size(), 2U) << calls;
    EXPECT_EQ(found[0], found[1]) << calls;
  }
  EXPECT_EQ(labels("_SetTask2(1, t); _SetTask(0, t);").size(), 2U);
  EXPECT_EQ(labels("_SetTask(0, t);").size(), 1U);
}

TEST(Temporaries, WhoHasTheirNumberIsNamed) {
  const auto told = [](const std::string& text) {
    const Compilation c = compile_text(text);
    EXPECT_FALSE(c.image) << text;
    for (const Diagnostic& diagnostic : c.diagnostics.all())
      if (diagnostic.diag == Diag::TemporaryTaken) {
        const Position at = c.sources->position(diagnostic.span.begin);
        return std::to_string(at.line) + ":" + std::to_string(at.column) + " " +
               diagnostic.text.substr(0, diagnostic.text.find(';'));
      }
    return std::string();
  };
  const auto message = [&](int number) {
    const std::string at = std::to_string(number);
    return told("#pragma var " + at + " " + at +
                "\nlong x, v[3], y;\n#declare Second v + 1\n"
                "main() { Second = 2; x = v[0] * y + x; }\n");
  };
  // x is H420, v H421 to H423, Second H422, y H424; main has to make room. A number is told where it stands.
  EXPECT_EQ(message(420), "4:1 H420 holds intermediate results and is used by 'x' as well");
  EXPECT_EQ(message(421), "4:1 H421 holds intermediate results and is used by 'v' as well");
  EXPECT_EQ(message(422), "4:1 H422 holds intermediate results and is used by 'Second' as well");
  EXPECT_EQ(message(423), "4:1 H423 holds intermediate results and is used by 'v' as well");
  EXPECT_EQ(message(424), "4:1 H424 holds intermediate results and is used by 'y' as well");
  EXPECT_EQ(told("long a, b; main() {\n H400 = 1; a = b * b + a; }"),
            "2:2 H400 holds intermediate results and is used here by number as well");
}

TEST(Temporaries, CallerAndCalleeShareWhatIsNotHeld) {
  const Compilation c = compile_text("long a, b; f() { a = b * b + a; } main() { a = b * b + a; f(); }");
  EXPECT_EQ((Lines{"M01 : SET H400 = H421", "MUL H400 * H421", "ADD H420 + H400", "CALL M02", "END",
                   "M02 : SET H400 = H421", "MUL H400 * H421", "ADD H420 + H400", "RET"}),
            commands(c));
}

TEST(Temporaries, ACalleeLeavesAloneWhatIsHeld) {
  // b * b is held in H400 while f runs with H401.
  EXPECT_EQ(
      (Lines{"M01 : SET H400 = H421", "MUL H400 * H421", "CALL M02", "ADD H400 + H421", "SET H420 = H400",
             "END", "M02 : SET H401 = H421", "MUL H401 * H421", "ADD H420 + H401", "RET"}),
      commands(compile_text("long a, b; f() { a = b * b + a; } main() { a = b * b + (f(), b); }")));
}

TEST(Temporaries, PragmaMovesThem) {
  const Compilation c = compile_text("#pragma var 300 H310\nlong a, b, c; main() { a = b * c + a; }");
  EXPECT_EQ((Lines{"M01 : SET H300 = H421", "MUL H300 * H422", "ADD H420 + H300", "END"}), commands(c));
}

TEST(Temporaries, TheAdviceOfTheOverflowWorks) {
  // A chain of subtractions nested to the right holds one temporary a level.
  std::string nested = "a";
  for (int level = 0; level < 30; ++level) nested = "b - (c * " + nested + ")";
  const std::string text = "long a, b, c; main() { b = 2; c = 3; a = a - (" + nested + "); }";
  const Compilation broken = compile_text(text);
  ASSERT_FALSE(broken.image);
  ASSERT_EQ(Diag::TemporaryOverflow, broken.diagnostics.all().at(0).diag);
  const std::string& message = broken.diagnostics.all()[0].text;
  const size_t begin = message.find("'#pragma var ") + 1;
  ASSERT_NE(std::string::npos, begin);
  const std::string fix = message.substr(begin, message.find('\'', begin) - begin);
  EXPECT_TRUE(compile_text(fix + "\n" + text).image) << fix;
}

}  // namespace
}  // namespace ipos::compiler::test
