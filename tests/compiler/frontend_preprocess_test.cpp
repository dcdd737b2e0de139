// Macros, conditions, includes, #declare and #pragma.
#include <gtest/gtest.h>

#include <algorithm>

#include "stdlib/headers.hpp"
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
  EXPECT_EQ(words("#define A B\n#define B B + 1\nA B A"), "B + 1 B + 1 B + 1");
  EXPECT_EQ(words("#define A B C\n#define B C B\n#define C A B C\nA"), "A B C B A C B C");
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

// Built-in headers are scanned once in a process: the second program, where they lie elsewhere, and a header of the same
// text beside the program read as the first one does, with the same places.
TEST(FrontendIncludes, BuiltInHeadersReadAsTheirTexts) {
  const auto lines = [](const compiler::PreprocessedText& text, const compiler::SourceMap& map) {
    std::string all;
    const auto add = [&](compiler::Span span) {
      const compiler::Position at = map.position(map.spelling(span.begin));
      const compiler::Position end = map.position(map.spelling(span.end));
      all += at.file->name + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + "-" + std::to_string(end.column) + " ";
    };
    for (const auto& one : text.record.definitions) {
      add(one.name);
      for (const compiler::Token& token : one.body) (add(token.span), all += token.text), all += '\n';
    }
    for (const auto& one : text.record.includes) add(one.header);
    for (const compiler::Token& token : text.tokens) (add(token.span), all += token.text), all += '\n';
    return all;
  };
  const auto read = [&](const std::string& front, bool built_in) {
    compiler::PreprocessOptions options;
    FrontendRun::Files files;
    for (const stdlib::EmbeddedFile& one : stdlib::headers::embedded_files()) files[std::string(one.name)] = one.text;
    if (built_in) {
      files.clear();
      options.headers = stdlib::headers::embedded_files();
    }
    FrontendRun run(front + "#include <constb.h>\n#include <iob.h>\nlong x; main() { x = DI10 + ML_BT_SBUS1; }\n", files, options);
    const std::string all = lines(compiler::preprocess(run.map, *run.main, run.options, run.diagnostics), run.map);
    EXPECT_EQ(run.messages(), Messages{});
    EXPECT_EQ(run.map.files().size(), 4U);  // const.h, too
    return all;
  };
  const std::string front = "// A line more.\n#define MINE 1\n";
  EXPECT_EQ(read("", true), read("", false));
  EXPECT_EQ(read(front, true), read(front, false));
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

TEST(FrontendIncludes, LimitsSayWhatTheyAre) {
  FrontendRun::Files files;
  for (int i = 0; i < 100; ++i)
    files["f" + std::to_string(i)] = "#include \"f" + std::to_string(i + 1) + "\"";
  FrontendRun deep("#include \"f0\"", files);
  deep.parse();
  EXPECT_EQ(deep.diagnostics.all().at(0).text, "more than 64 files included within each other");
  FrontendRun cycle("#include <a.h>\nx", {{"a.h", "y\n#include <a.h>\nz"}});
  EXPECT_EQ(cycle.parse().messages(), Messages{"E0125 a.h:2:10"});
  EXPECT_EQ(cycle.diagnostics.all().at(0).text, "'a.h' includes itself");
}

TEST(FrontendIncludes, OfAShortName) {
  EXPECT_EQ(FrontendRun("#include <a>\n#include \"b\"", {{"a", "x"}, {"b", "y"}}).words(), "x y");
}

TEST(FrontendIncludes, TwiceIsFine) {
  EXPECT_EQ(FrontendRun("#include \"a.h\"\n#include \"a.h\"", {{"a.h", "x"}}).words(), "x x");
}

// The first note of the first message.
std::string hint(const FrontendRun::Files& folders, compiler::PreprocessOptions options,
                 const std::string& source) {
  options.list_files = [folders](const std::string& folder) {
    const auto found = folders.find(folder);
    return found == folders.end() ? std::vector<std::string>{} : std::vector<std::string>{found->second};
  };
  FrontendRun run(source, {}, std::move(options));
  run.words();
  return run.diagnostics.all().empty() ? "" : run.diagnostics.all()[0].notes.at(0).text;
}

TEST(FrontendIncludes, NotFoundNamesWhatIsSimilar) {
  const stdlib::EmbeddedFile built_in[] = {{"const.h", "constants"}, {"io.h", "terminals"}};
  compiler::PreprocessOptions options;
  options.headers = built_in;
  options.include_dirs = {"one"};
  EXPECT_EQ(hint({{"", "Own.h"}}, options, "#include \"own.h\""), "did you mean 'Own.h'?");
  EXPECT_EQ(hint({{"one/", "OWN.H"}}, options, "#include \"own.h\""), "did you mean 'OWN.H'?");
  EXPECT_EQ(hint({{"one/lib/", "OWN.H"}}, options, "#include \"lib\\own.h\""), "did you mean 'lib/OWN.H'?");
  EXPECT_EQ(hint({{"", "other.h"}}, options, "#include \"own.h\""),
            "searched: the current directory, one/, the built-in headers");
  EXPECT_EQ(hint({}, options, "#include <cnst.h>"), "did you mean 'const.h'?");
  EXPECT_EQ(hint({}, options, "#include <const>"), "did you mean 'const.h'?");
  EXPECT_EQ(hint({}, options, "#include </abs/own.h>"),
            "searched: the current directory, the built-in headers");
}

TEST(FrontendIncludes, PathsOfBothWorlds) {
  compiler::PreprocessOptions options;
  options.include_dirs = {"dir", "", "two/"};
  const auto read = [&](const std::string& name, const std::string& path) {
    return FrontendRun("#include <" + name + ">", {{path, "found"}}, options).words();
  };
  EXPECT_EQ(read("C:/x.h", "C:/x.h"), "found");
  EXPECT_EQ(read("C:\\x.h", "C:/x.h"), "found");
  EXPECT_EQ(read("C:/x.h", "dir/C:/x.h"), "");
  EXPECT_EQ(read("C:x.h", "dir/C:x.h"), "found");
  EXPECT_EQ(read("C/:x.h", "dir/C/:x.h"), "found");
  EXPECT_EQ(read("a/b.h", "dir/a/b.h"), "found");
  EXPECT_EQ(read("x.h", "x.h"), "found");
  EXPECT_EQ(read("x.h", "two/x.h"), "found");
  EXPECT_EQ(read("x.h", "two//x.h"), "");
}

TEST(FrontendIncludes, TextBehindTheNameIsTold) {
  FrontendRun run("#include <a.h> b\n#include \"a.h\" // nothing\nc", {{"a.h", "x"}});
  EXPECT_EQ(run.words(), "x x c");
  EXPECT_EQ(run.messages(), Messages{"W0123 1:16"});
}

TEST(FrontendMacros, RecordForEditors) {
  FrontendRun run(
      "#define A 1 + B\n#define B 2\n#ifdef A\nA\n#endif\n#undef B\n#if defined(A) && defined "
      "B\n#endif\n#include \"a.h\"\nB",
      {{"a.h", "#ifndef A\n#endif\n"}});
  const compiler::PreprocessedText text =
      compiler::preprocess(run.map, *run.main, run.options, run.diagnostics);
  EXPECT_TRUE(text.complete);
  const auto place = [&](compiler::Location at) {
    at = run.map.spelling(at);
    const compiler::Position found = run.map.position(at);
    return (found.file == run.main ? "" : found.file->name + ":") + std::to_string(found.line) + ":" +
           std::to_string(found.column);
  };
  std::vector<std::string> definitions;
  for (const auto& one : text.record.definitions)
    definitions.push_back(place(one.name.begin) + " " + std::to_string(one.body.size()));
  EXPECT_EQ(definitions, (std::vector<std::string>{"1:9 3", "2:9 1"}));
  std::vector<std::string> includes;
  for (const auto& one : text.record.includes)
    includes.push_back(place(one.header.begin) + " " + one.file->name);
  EXPECT_EQ(includes, std::vector<std::string>{"9:10 a.h"});
  // A is asked for in lines 3 and 7 and in the header, and replaced in line 4, with it the B of its text; B is
  // taken back in line 6.
  std::vector<std::string> asked;
  for (const auto& one : text.record.uses)
    asked.push_back(place(one.name.begin) + " " + place(one.definition.begin));
  std::sort(asked.begin(), asked.end());
  EXPECT_EQ(std::count(asked.begin(), asked.end(), "3:8 1:9"), 1);
  EXPECT_EQ(std::count(asked.begin(), asked.end(), "4:1 1:9"), 1);
  EXPECT_EQ(std::count(asked.begin(), asked.end(), "1:15 2:9"), 1);
  EXPECT_EQ(std::count(asked.begin(), asked.end(), "6:8 2:9"), 1);
  EXPECT_EQ(std::count(asked.begin(), asked.end(), "7:13 1:9"), 1);
  EXPECT_EQ(std::count(asked.begin(), asked.end(), "a.h:1:9 1:9"), 1);
  EXPECT_EQ(asked.size(), 6U) << "B is none any more";
}

TEST(FrontendMacros, TokensKnowWhereTheyStand) {
  FrontendRun run("#define A (x)\nA b\n  c A\n");
  const auto tokens = compiler::preprocess(run.map, *run.main, run.options, run.diagnostics).tokens;
  std::string starts;
  for (const compiler::Token& token : tokens)
    starts += std::string(token.text) + (token.line_start ? "! " : " ");
  EXPECT_EQ(starts, "(! x ) b c! ( x ) ! ");
}

TEST(FrontendLimits, OfTokensCountLineEndsAndTheEnd) {
  const auto said = [](const std::string& source, size_t most) {
    compiler::PreprocessOptions options;
    options.max_tokens = most;
    FrontendRun run(source, {}, options);
    const Messages found = run.parse().messages();
    return found.empty() ? "" : run.diagnostics.all()[0].text;
  };
  EXPECT_EQ(said("long a;", 4), "");
  EXPECT_EQ(said("long a;", 3), "the program is too large: more than 3 tokens");
  EXPECT_EQ(said("long\na;\n", 6), "");
  EXPECT_EQ(said("long\na;\n", 5), "the program is too large: more than 5 tokens");
  // Six for the #define with its line end, then A and its three, `b`, `;` and the end.
  EXPECT_EQ(said("#define A long a,\nA b;", 7 + 1 + 3 + 3), "");
  EXPECT_EQ(said("#define A long a,\nA b;", 13), "the program is too large: more than 13 tokens");
}

TEST(FrontendLimits, OfBytesCountAllFiles) {
  const std::string large((64U << 20U) - 20, ' ');
  FrontendRun one(large + std::string(21, ' '));
  EXPECT_EQ(one.parse().messages(), Messages{"E0127 1:1"});
  EXPECT_EQ(one.diagnostics.all()[0].text, "the program is too large: more than 64 MB of text");
  FrontendRun two("#include \"large.h\"   ", {{"large.h", large}});
  EXPECT_EQ(two.parse().messages(), Messages{"E0127 1:10"});
  FrontendRun full("#include \"large.h\"  ", {{"large.h", large}});
  EXPECT_EQ(full.parse().messages(), Messages{}) << "64 MB to the byte";
}

TEST(FrontendText, InSixteenBitsIsRefused) {
  for (const char* mark : {"\xFF\xFE", "\xFE\xFF"}) {
    FrontendRun run(mark + std::string("long a"));
    EXPECT_EQ(run.parse().messages(), Messages{"E0103 1:1"});
    FrontendRun inner("#include \"a.h\"\nnonsense (", {{"a.h", mark + std::string("x")}});
    EXPECT_EQ(inner.parse().messages(), Messages{"E0103 a.h:1:1"});
  }
  EXPECT_EQ(FrontendRun("\xFF\xFF").parse().messages()[0], "E0105 1:1");
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
