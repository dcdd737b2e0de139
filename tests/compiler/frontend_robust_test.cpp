// Input that is hostile or broken: nothing may crash, hang or use memory without bound.
#include <gtest/gtest.h>

#include <random>

#include "compiler/diag/render.hpp"
#include "tests/compiler/frontend_run.hpp"

namespace ipos::tests {
namespace {

std::string repeat(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

constexpr int kMany = 50'000;

class FrontendDepth : public testing::TestWithParam<std::string> {};

TEST_P(FrontendDepth, IsReportedOnce) {
  const Messages found = messages_of(GetParam());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].substr(0, 5), "E0176");
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, FrontendDepth,
    testing::Values(
        "main() { x = " + repeat("(", kMany) + "1" + repeat(")", kMany) + "; }",
        "main() { x = " + repeat("- ", kMany) + "1; }", "main() { x = " + repeat("!", kMany) + "1; }",
        "main() { x = 1" + repeat(" + 1", kMany) + "; }", "main() { " + repeat("x = ", kMany) + "1; }",
        "main() { x = " + repeat("1 ? 2 : ", kMany) + "3; }", "main() { x" + repeat(".m", kMany) + "; }",
        "main() { x" + repeat("[1]", kMany) + "; }",
        "main() { " + repeat("x[", kMany) + "1" + repeat("]", kMany) + "; }",
        "main() { " + repeat("f(", kMany) + repeat(")", kMany) + "; }",
        "main() { 1" + repeat(", 1", kMany) + "; }", "main() " + repeat("{", kMany) + repeat("}", kMany),
        "main() { " + repeat("if (x) ", kMany) + "; }", "main() { " + repeat("if (x) ; else ", kMany) + "; }",
        "main() { " + repeat("while (x) ", kMany) + "; }",
        "main() { " + repeat("do ", kMany) + ";" + repeat(" while (x);", kMany) + " }",
        "main() { " + repeat("for (;;) ", kMany) + "; }",
        "main() { " + repeat("switch (x) ", kMany) + "; }"));

TEST(FrontendDepthLimit, TwoHundredLevelsAreFine) {
  EXPECT_EQ(messages_of("main() { x = " + repeat("(", 200) + "1" + repeat(")", 200) + "; }"), Messages{});
  EXPECT_EQ(messages_of("main() { x = 1" + repeat(" + 1", 200) + "; }"), Messages{});
  EXPECT_EQ(messages_of("main() " + repeat("{", 200) + repeat("}", 200)), Messages{});
  EXPECT_EQ(messages_of("main() { " + repeat("if (x) ; else ", 200) + "; }"), Messages{});
}

TEST(FrontendDepthLimit, NestedConditionsOfThePreprocessor) {
  EXPECT_EQ(messages_of("#if " + repeat("(", kMany) + "1\n#endif").size(), 1U);
  EXPECT_EQ(messages_of("#if " + repeat("-", kMany) + "1\n#endif").size(), 1U);
  EXPECT_EQ(messages_of("#if " + repeat("1 ? 1 : ", kMany) + "1\n#endif").size(), 1U);
  EXPECT_EQ(messages_of(repeat("#if 1\n", kMany) + repeat("#endif\n", kMany)), Messages{});
}

TEST(FrontendLimits, MacrosThatDoubleEachOther) {
  std::string source;
  for (int i = 0; i < 60; ++i) {
    const std::string next = "M" + std::to_string(i + 1);
    source += "#define M" + std::to_string(i) + " " + next + " " + next + "\n";
  }
  EXPECT_EQ(messages_of(source + "M0"), Messages{"E0127 61:1"});
  EXPECT_EQ(messages_of(source + "#define M60\nM0"), Messages{"E0127 62:1"});  // even when nothing comes out
}

TEST(FrontendLimits, FilesThatDoubleEachOther) {
  FrontendRun::Files files;
  for (int i = 0; i < 60; ++i) {
    const std::string next = "#include \"f" + std::to_string(i + 1) + "\"\n";
    files["f" + std::to_string(i)] = next + next;
  }
  files["f60"] = "// " + std::string(10'000, '-');
  FrontendRun run("#include \"f0\"", files);
  ASSERT_EQ(run.parse().messages().size(), 1U);
  EXPECT_EQ(run.messages()[0].substr(0, 5), "E0127");
}

// Whatever the bytes: an end, a tree that prints, and messages that render.
void survive(const std::string& source) {
  FrontendRun run(source, {{"t.IPC", source}});
  run.parse();
  run.tree();
  compiler::render_text(run.diagnostics.all(), run.map, true);
  compiler::render_sarif(run.diagnostics.all(), run.map);
  EXPECT_LE(run.diagnostics.error_count(), 150U + source.size()) << source;
}

TEST(FrontendRandom, Bytes) {
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    std::string source(random() % 300, ' ');
    for (char& c : source) c = static_cast<char>(random());
    survive(source);
  }
}

const char* const kProgram =
    "#include \"t.IPC\"\n#define A (x + 1)\n#if defined A && A > 2\n#else\n#endif\n#pragma globals 130 H200\n"
    "#declare B H1 + 2\ntypedef struct { long a; long b[3]; } P;\ninitial long x, y[4]; P p, *q; SCREC r;\n"
    "main() { long z; if (x == A) { y[1] = -3; } else if (!x) f(); else { p.a ? x++ : --x; }\n"
    "for (x = 0; x < 10; x++) { switch (x) { case 1: break; default: continue; } }\n"
    "do { *x = numof(p) << 2; } while (x && y || 0x1F); _Wait(10, \"a\", 'b', 1.5); goto e; e: return; "
    "}\nf() { x = 1 }\n";

TEST(FrontendRandom, TruncatedPrograms) {
  const std::string program(kProgram);
  for (size_t length = 0; length <= program.size(); ++length) survive(program.substr(0, length));
}

TEST(FrontendRandom, ShuffledTokens) {
  std::vector<std::string> pieces;
  std::istringstream words(kProgram);
  for (std::string word; words >> word;) pieces.push_back(word);
  for (const char* more :
       {"{", "}", "(", ")", ";", ",", "\n", "\n#", "else", "while", "typedef", "struct", "long"})
    pieces.emplace_back(more);
  std::mt19937 random(2);
  for (int round = 0; round < 2000; ++round) {
    std::string source = round % 2 == 0 ? "main() { " : "";
    for (auto i = random() % 60; i > 0; --i) source += pieces[random() % pieces.size()] + " ";
    survive(source);
  }
}

TEST(FrontendRandom, OneTokenRemovedOrDoubledGivesFewMessages) {
  // A single slip must not set off an avalanche; only where a brace goes the text has another meaning to its
  // end.
  const std::string program =
      "long x; long y[4];\ntypedef struct { long a; long b; } P;\nP p;\nmain() {\n  if (x == 1) {\n    y[1] "
      "= x + 3;\n"
      "  } else {\n    f();\n  }\n  for (x = 0; x < 10; x++) {\n    p.a = x;\n  }\n  while (x) { x--; }\n"
      "  switch (x) {\n    case 1:\n      break;\n    default:\n      x = 2;\n  }\n}\nf() {\n  x = (x + 1) * "
      "2;\n}\n";
  FrontendRun whole(program);
  ASSERT_EQ(whole.parse().messages(), Messages{});
  compiler::Diagnostics none;
  const auto tokens = compiler::preprocess(whole.map, *whole.main, whole.options, none).tokens;
  for (const compiler::Token& token : tokens) {
    if (token.text.empty()) continue;
    const auto at = static_cast<size_t>(token.text.data() - whole.main->text.data());
    const bool brace = token.text == "{" || token.text == "}";
    const size_t limit = brace ? 5 : 2;
    std::string removed = program;
    removed.erase(at, token.text.size());
    EXPECT_LE(messages_of(removed).size(), limit) << removed;
    std::string doubled = program;
    doubled.insert(at, std::string(token.text) + " ");
    EXPECT_LE(messages_of(doubled).size(), limit) << doubled;
  }
}

}  // namespace
}  // namespace ipos::tests
