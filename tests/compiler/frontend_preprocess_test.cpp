// Macros, conditions, includes, #declare and #pragma.
#include <gtest/gtest.h>

#include "tests/compiler/frontend_run.hpp"

namespace ipos::tests {
namespace {

std::string words(const std::string& source) { return FrontendRun(source).words(); }

TEST(FrontendMacros, ReplacedByAnyText) {
  EXPECT_EQ(words("#define A\n#define B (2 * 3)\n#define STOP halt();\nA B STOP"), "( 2 * 3 ) halt ( ) ;");
}

TEST(FrontendMacros, NameInItsOwnTextStays) {
  EXPECT_EQ(words("#define A A + 1\nA"), "A + 1");
  EXPECT_EQ(words("#define A B\n#define B A\nA B"), "A B");
  EXPECT_EQ(words("#define A B B\n#define B A 1\nA"), "A 1 A 1");
}

TEST(FrontendMacros, TakenWhenUsedNotWhenDefined) {
  EXPECT_EQ(words("#define A B\n#define B 1\nA\n#undef B\nA\n#define B 2\nA"), "1 B 2");
}

TEST(FrontendMacros, BlankBeforeBracketMakesAText) { EXPECT_EQ(words("#define A (x)\nA"), "( x )"); }

TEST(FrontendMacros, KeywordsMayBeMacros) { EXPECT_EQ(words("#define EVER while (1)\nEVER"), "while ( 1 )"); }

TEST(FrontendMacros, SameTextAgainIsSilent) {
  EXPECT_EQ(messages_of("#define A 1 +  2\n#define A 1 + 2 // same\n"), Messages{});
}

TEST(FrontendMacros, FromTheCommandLine) {
  compiler::PreprocessOptions options;
  options.defines = {"A", "B=2 + 3", "C="};
  EXPECT_EQ(FrontendRun("A B C end", {}, options).words(), "1 2 + 3 end");
  options.defines = {"5=1"};
  EXPECT_EQ(FrontendRun("x;", {}, options).parse().messages()[0], "E0121 <command line>:1:9");
}

TEST(FrontendMacros, ChainLongerThanAnyStack) {
  std::string source;
  for (int i = 0; i < 50'000; ++i)
    source += "#define M" + std::to_string(i) + " M" + std::to_string(i + 1) + "\n";
  EXPECT_EQ(words(source + "M0"), "M50000");
}

TEST(FrontendConditions, Branches) {
  EXPECT_EQ(words("#ifdef A\n1\n#else\n2\n#endif\n#ifndef A\n3\n#endif"), "2 3");
  EXPECT_EQ(words("#define A\n#ifdef A\n1\n#else\n2\n#endif\n#ifndef A\n3\n#endif"), "1");
  EXPECT_EQ(words("#if 0\n1\n#elif 1\n2\n#elif 1\n3\n#else\n4\n#endif"), "2");
  EXPECT_EQ(words("#if 0\n1\n#elif 0\n2\n#else\n4\n#endif 5\n6"), "4 6");
}

TEST(FrontendConditions, Nested) {
  EXPECT_EQ(words("#if 0\n#if 1\n1\n#else\n2\n#endif\n3\n#else\n4\n#endif"), "4");
  EXPECT_EQ(words("#if 1\n#if 0\n1\n#elif 1\n2\n#endif\n3\n#else\n4\n#endif"), "2 3");
}

TEST(FrontendConditions, TextLeftOutNeedNotBeRight) {
  EXPECT_EQ(messages_of("#if 0\nit's \"wrong @ 12ab #define\n#include <none>\n#error x\n#foo\n#if ) (\n#elif "
                        "+\n#endif\n#endif"),
            Messages{});
}

TEST(FrontendConditions, DirectiveAsWrittenByHand) {
  EXPECT_EQ(words("  #  define A 1\n/* c */ # if A // c\nA\n#endif\n#\n"), "1");
}

struct Expression {
  const char* text;
  bool value;
};
class FrontendIf : public testing::TestWithParam<Expression> {};

TEST_P(FrontendIf, Value) {
  FrontendRun run("#define A 5\n#define B\n#if " + std::string(GetParam().text) + "\nyes\n#endif");
  EXPECT_EQ(run.words(), GetParam().value ? "yes" : "") << GetParam().text;
  EXPECT_EQ(run.messages(), Messages{}) << GetParam().text;
}

// Values by the rules of C for 32-bit numbers.
INSTANTIATE_TEST_SUITE_P(
    Rules, FrontendIf,
    testing::Values(Expression{"1", true}, Expression{"0", false}, Expression{"A == 5", true},
                    Expression{"defined A && defined(B) && !defined C", true},
                    Expression{"2 + 3 * 4 == 14", true}, Expression{"(2 + 3) * 4 == 20", true},
                    Expression{"10 - 3 - 2 == 5", true}, Expression{"100 / 10 / 5 == 2", true},
                    Expression{"-7 / 2 == -3", true}, Expression{"-7 % 2 == -1", true},
                    Expression{"1 << 2 + 1 == 8", true}, Expression{"-8 >> 1 == -4", true},
                    Expression{"1 | 2 == 2", true}, Expression{"(1 | 2) == 3", true},
                    Expression{"6 & 3 ^ 1 | 8", true}, Expression{"1 < 2 < 1", false},
                    Expression{"1 || 1 / 0", true}, Expression{"0 && 1 % 0", false},
                    Expression{"1 ? 2 : 1 / 0", true}, Expression{"0 ? 1 / 0 : 0", false},
                    Expression{"1 ? 0 : 1 ? 1 : 1", false}, Expression{"!0 + ~0 == 0", true},
                    Expression{"- - 1 == +1", true}, Expression{"0xFFFFFFFF == -1", true},
                    Expression{"-2147483648 < 0", true}, Expression{"2147483647 + 1 < 0", true},
                    Expression{"-2147483648 / -1 < 0", true}, Expression{"1 << 33 == 2", true},
                    Expression{"010 == 10", true}, Expression{"0b11 != 3", false},
                    Expression{"3 <= 3 && 3 >= 3 && 4 > 3", true}, Expression{"0 && UNKNOWN", false}));

TEST(FrontendIncludes, SearchOrder) {
  // IPOSplus p. 179: beside the source file before the configured directories; the built-in ones last.
  const stdlib::EmbeddedFile built_in[] = {{"a.h", "built_in"}, {"Const.h", "constants"}};
  compiler::PreprocessOptions options;
  options.include_dirs = {"one", "two/"};
  options.headers = built_in;
  FrontendRun::Files files{{"a.h", "beside"}, {"one/a.h", "first"}, {"two/a.h", "second"}};
  EXPECT_EQ(FrontendRun("#include <a.h>", files, options).words(), "beside");
  EXPECT_EQ(FrontendRun("#include \"a.h\"", files, options).words(), "beside");
  files.erase("a.h");
  EXPECT_EQ(FrontendRun("#include <a.h>", files, options).words(), "first");
  files.erase("one/a.h");
  EXPECT_EQ(FrontendRun("#include <a.h>", files, options).words(), "second");
  files.erase("two/a.h");
  EXPECT_EQ(FrontendRun("#include <a.h>", files, options).words(), "built_in");
  EXPECT_EQ(FrontendRun("#include <CONST.H>", files, options).words(), "constants");
}

TEST(FrontendIncludes, BesideTheIncludingFileThenBesideTheMainFile) {
  FrontendRun::Files files{{"lib/a.h", "#include \"b.h\"\n#include \"c.h\""},
                           {"lib/b.h", "in_lib"},
                           {"b.h", "in_main"},
                           {"c.h", "only_main"}};
  EXPECT_EQ(FrontendRun("#include \"lib\\a.h\"", files).words(), "in_lib only_main");
}

TEST(FrontendIncludes, ExplicitPath) {
  compiler::PreprocessOptions options;
  options.include_dirs = {"dir"};
  FrontendRun::Files files{{"/abs/a.h", "absolute"}, {"dir//abs/a.h", "wrong"}};
  EXPECT_EQ(FrontendRun("#include </abs/a.h>", files, options).words(), "absolute");
}

TEST(FrontendIncludes, NotFoundNamesThePlaces) {
  compiler::PreprocessOptions options;
  options.include_dirs = {"one"};
  FrontendRun run("#include <no.h>\nnonsense (;", {}, options);
  EXPECT_EQ(run.parse().messages(), Messages{"E0124 1:10"});  // and nothing of what would follow from it
  EXPECT_EQ(run.diagnostics.all()[0].notes[0].text,
            "searched: the current directory, one/, the built-in headers");
}

TEST(FrontendIncludes, GuardedCycleIsFine) {
  FrontendRun run("#include \"a.h\"", {{"a.h", "#ifndef A\n#define A\n#include \"b.h\"\na\n#endif"},
                                       {"b.h", "#include \"a.h\"\nb"}});
  EXPECT_EQ(run.words(), "b a");
  EXPECT_EQ(run.messages(), Messages{});
}

TEST(FrontendIncludes, CycleIsReportedOnce) {
  FrontendRun run("#include \"a.h\"",
                  {{"a.h", "#include \"b.h\"\n#include \"b.h\""}, {"b.h", "\n #include \"a.h\""}});
  EXPECT_EQ(run.parse().messages(), Messages{"E0125 b.h:2:11"});
}

TEST(FrontendIncludes, DepthIsLimited) {
  FrontendRun::Files files;
  for (int i = 0; i < 100; ++i)
    files["f" + std::to_string(i)] = "#include \"f" + std::to_string(i + 1) + "\"";
  EXPECT_EQ(FrontendRun("#include \"f0\"", files).parse().messages(), Messages{"E0126 f63:1:10"});
  files["f60"] = "deep";
  EXPECT_EQ(FrontendRun("#include \"f0\"", files).words(), "deep");
}

TEST(FrontendIncludes, TwiceIsFine) {
  EXPECT_EQ(FrontendRun("#include \"a.h\"\n#include \"a.h\"", {{"a.h", "x"}}).words(), "x x");
}

TEST(FrontendDirectives, DeclareAndPragmaReachTheTree) {
  FrontendRun run(
      "#define BASE H10\n#define K 3\n#declare Ref BASE\n#declare Next BASE + K * 2\n"
      "#pragma globals 130 H200\n#pragma list\n#pragma var (K) 9\n#pragma initials 0 127\n");
  EXPECT_EQ(run.parse().messages(), Messages{});
  EXPECT_EQ(run.tree(),
            "3:1 declare Ref\n  3:14 name H10\n"
            "4:1 declare Next\n  4:15 binary +\n    4:15 name H10\n    4:22 binary *\n      4:22 number 3\n  "
            "    4:26 number 2\n"
            "5:1 pragma globals\n  5:17 number 130\n  5:21 name H200\n"
            "6:1 pragma list\n"
            "7:1 pragma var\n  7:13 number 3\n  7:17 number 9\n"
            "8:1 pragma initials\n  8:18 number 0\n  8:20 number 127\n");
}

TEST(FrontendDirectives, InsideAFunction) {
  FrontendRun run("main() {\n#declare A H1\n x = 1;\n#pragma list\n}");
  EXPECT_EQ(run.parse().messages(), Messages{});
  EXPECT_EQ(run.program.declarations.size(), 3U);
}

}  // namespace
}  // namespace ipos::tests
