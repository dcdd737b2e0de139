// How functions come to stand in an image: lines and functions of the table, copies in messages, and calls that would lose
// an intermediate result.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/compiler/backend_test.hpp"

namespace ipos::compiler::test {
namespace {

using Entries = std::vector<vm::LineEntry>;

// `a = b * c + a` is SET, MUL, ADD of a word each; SET of a constant has two, END and RET one.
TEST(Lines, BeginWhereThePlaceChanges) {
  const Compilation c = compile_text(
      "long a, b, c;\n"
      "main() {\n"
      "a = b * c + a;\n"
      "a = 1;\n"
      "b = 1; c = 1;\n"
      "}\n");
  ASSERT_TRUE(c.image);
  EXPECT_EQ(c.image->lines, (Entries{{0, 0, 3, 5}, {3, 0, 4, 1}, {5, 0, 5, 1}, {7, 0, 5, 8}, {9, 0, 6, 1}}));
}

// The same line and column of another file is another place.
TEST(Lines, KnowTheirFile) {
  CompileOptions options;
  options.read_file = [](const std::string&) -> std::optional<std::string> { return "\nH2 = 1;\n\nH3 = 1;"; };
  const Compilation c = compile("test.IPC", "", "main() {\nH1 = 1;\n#include \"x.h\"\nH4 = 1; }", options);
  ASSERT_TRUE(c.image) << commands(c)[0];
  EXPECT_EQ(c.image->files.size(), 2U);
  EXPECT_EQ(c.image->lines, (Entries{{0, 0, 2, 1}, {2, 1, 2, 1}, {4, 1, 4, 1}, {6, 0, 4, 1}, {8, 0, 4, 9}}));
}

// Also functions at one place, as those of a macro, have a line of their own each.
TEST(Lines, EveryFunctionHasOne) {
  const Compilation c = compile_text(
      "#define BOTH f() { } g() { }\nBOTH main() { _SetTask2(1, f); _SetInterrupt(1, g); _SetInterrupt(2, "
      "f); }");
  ASSERT_TRUE(c.image) << commands(c)[0];
  ASSERT_EQ(c.image->functions.size(), 3U);
  for (const vm::FunctionEntry& function : c.image->functions)
    EXPECT_EQ(std::count_if(c.image->lines.begin(), c.image->lines.end(),
                            [&](const vm::LineEntry& line) { return line.address == function.address; }),
              1)
        << function.name;
}

// A program may fill the memory of its unit to the last word, and not by one more.
TEST(Length, TheLastWordOfTheUnitIsTheProgramsOwn) {
  for (const char* const name : {"md60a", "compact", "mc07", "mdxb"}) {
    const stdlib::UnitType& unit = *stdlib::find_unit(std::string_view(name));
    // A copy of a variable is a word, and so is the END.
    const auto program = [](uint32_t words) {
      std::string text = "long a, b; main() {\n";
      for (uint32_t n = 1; n < words; ++n) text += n % 2 == 0 ? "a = b;\n" : "b = a;\n";
      return text + "}";
    };
    const Compilation full = compile_text(program(unit.program_words), name);
    ASSERT_TRUE(full.image) << name;
    EXPECT_EQ(full.image->code.size(), unit.program_words) << name;
    const Compilation beyond = compile_text(program(unit.program_words + 1U), name);
    EXPECT_FALSE(beyond.image && !beyond.diagnostics.has_errors()) << name;
    ASSERT_FALSE(beyond.diagnostics.all().empty()) << name;
    EXPECT_EQ(beyond.diagnostics.all().back().diag, Diag::ProgramTooLong) << name;
  }
}

// The five longest, the longest first, of equals in the order of the source; what stands once is none of them.
TEST(Copies, OfATooLongProgramAreTheLongestFive) {
  const int statements[] = {60, 100, 40, 140, 80, 140, 20};
  std::string text = "long a, b, c;\n", calls;
  for (size_t n = 0; n < std::size(statements); ++n) {
    const std::string name = "f" + std::to_string(n);
    calls += name + "(); ";
    text += name + "() { ";
    for (int k = 0; k < statements[n]; ++k) text += "a = b * c + a; ";
    text += "}\n";
  }
  text += "once() { ";
  for (int k = 0; k < 300; ++k) text += "a = 1; ";
  text += "}\nt() { " + calls + "}\nmain() { _SetTask2(1, t); once(); " + calls + "}\n";
  const Compilation c = compile_text(text, "md60a");
  const auto message = std::find_if(c.diagnostics.all().begin(), c.diagnostics.all().end(),
                                    [](const Diagnostic& row) { return row.diag == Diag::ProgramTooLong; });
  ASSERT_NE(message, c.diagnostics.all().end());
  std::vector<std::string> notes, wanted;
  for (const Note& note : message->notes) notes.push_back(note.text);
  for (const size_t n : {3U, 5U, 1U, 4U, 0U})
    wanted.push_back("'f" + std::to_string(n) +
                     "' stands 2 times (main, t): " + std::to_string(2 * (3 * statements[n] + 1)) + " words");
  EXPECT_EQ(notes, wanted);
}

// To stop what stands somewhere already makes no further copy of it.
TEST(Copies, AreNotMadeForAStop) {
  for (const char* const calls :
       {"t(); _SetTask2(0, t);", "t(); _SetTask(0, t); _SetTask2(0, t); _SetInterrupt(0, t);",
        "_SetTask2(0, t);", "_SetTask2(1, t); _SetTask2(0, t); _SetTask(0, t);"}) {
    const Compilation c =
        compile_text("long a, b, c; t() { a = b * c + a; } main() { " + std::string(calls) + " }", "mdxb");
    ASSERT_TRUE(c.image) << calls;
    std::vector<std::string> names;
    for (const vm::FunctionEntry& function : c.image->functions) names.push_back(function.name);
    EXPECT_EQ(names, (std::vector<std::string>{"main", "t"})) << calls;
  }
}

std::string lost(const std::string& text) {
  const Compilation c = compile_text("long a, b;\n" + text);
  std::string out;
  for (const Diagnostic& message : c.diagnostics.all())
    if (message.diag == Diag::RecursionTemporary)
      out += message.text.substr(0, message.text.find(" calls")) + " ";
  EXPECT_EQ(c.image.has_value(), out.empty());
  return out;
}

// A call in front of which an intermediate result is held must not come back to its own function (E0233), directly or by
// others. What is not held, and rings that the function is no part of, are well.
TEST(Recursion, LosesWhatIsHeld) {
  EXPECT_EQ(lost("f() { a = b * b + (f(), b); } main() { f(); }"), "'f' ");
  EXPECT_EQ(lost("f() { a = b * b + (g(), b); } g() { f(); } main() { f(); }"), "'g' ");
  EXPECT_EQ(lost("f() { a = b * b + (g(), b); } g() { h(); } h() { b = 1; g(); f(); } main() { f(); }"),
            "'g' ");
  EXPECT_EQ(lost("f() { a = b * b + (f(), b); a = b * b + (f(), b); } main() { f(); }"), "'f' 'f' ");
  EXPECT_EQ(lost("f() { a = b * b + a; f(); } main() { f(); }"), "");
  EXPECT_EQ(lost("f() { b = 1; f(); } main() { a = b * b + (f(), b); }"), "");
  EXPECT_EQ(lost("f() { g(); } g() { f(); } main() { a = b * b + (f(), b); }"), "");
  EXPECT_EQ(lost("f() { b = 1; } main() { a = b * b + (f(), f(), b); }"), "");
}

}  // namespace
}  // namespace ipos::compiler::test
