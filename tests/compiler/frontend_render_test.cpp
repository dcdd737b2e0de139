// Diagnostics as text, JSON and SARIF; chains of macros and includes; the -W options.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "compiler/diag/render.hpp"
#include "tests/compiler/frontend_run.hpp"

namespace ipos::tests {
namespace {

std::string text_of(FrontendRun& run) {
  run.parse();
  return compiler::render_text(run.diagnostics.all(), run.map, false);
}

TEST(FrontendText, PlaceLineAndCaret) {
  FrontendRun run("main() {\n\tx = 1.25 ;\n}");
  EXPECT_EQ(
      text_of(run),
      "t.IPC:2:6: error: '1.25' has a fraction, but there are whole numbers only; scale the value [E0108]\n"
      "    2 | \tx = 1.25 ;\n"
      "      | \t    ^~~~\n");
}

TEST(FrontendText, MissingSemicolonPointsBehindTheLine) {
  FrontendRun run("main() {\n  x = 1   // one\n}");
  EXPECT_EQ(text_of(run),
            "t.IPC:2:8: error: expected ';' before '}' [E0150]\n"
            "    2 |   x = 1   // one\n"
            "      |        ^\n");
}

TEST(FrontendText, WideCharactersTakeOneColumnOfTheCaretLine) {
  FrontendRun utf8("main() { /* \xC3\xA4\xC3\xB6 */ x = 1.5; }");
  EXPECT_NE(text_of(utf8).find("\n      |                       ^~~\n"), std::string::npos) << text_of(utf8);
  FrontendRun latin1("main() { /* \xE4\xF6 */ x = 1.5; }");
  EXPECT_NE(text_of(latin1).find("/* \xC3\xA4\xC3\xB6 */ x = 1.5; }\n      |                       ^~~\n"),
            std::string::npos);
}

TEST(FrontendText, ChainOfMacrosAndIncludes) {
  FrontendRun run("#include \"a.h\"\n", {{"a.h", "\n#include \"b.h\"\n"},
                                         {"b.h", "#define IN 3 4\n#define OUT (IN)\nf() { x = OUT; }\n"}});
  EXPECT_EQ(text_of(run),
            "b.h:3:11: error: expected ')' before '4' [E0150]\n"
            "    3 | f() { x = OUT; }\n      |           ^~~\n"
            "b.h:1:14: note: in macro 'IN', defined at b.h:1\n"
            "    1 | #define IN 3 4\n      |              ^\n"
            "b.h:2:14: note: in macro 'OUT', defined at b.h:2\n"
            "    2 | #define OUT (IN)\n      |              ^\n"
            "a.h:2:10: note: 'b.h' included from a.h:2\n"
            "    2 | #include \"b.h\"\n      |          ^\n"
            "t.IPC:1:10: note: 'a.h' included from t.IPC:1\n"
            "    1 | #include \"a.h\"\n      |          ^\n");
}

TEST(FrontendText, LongChainsAreCut) {
  std::string source;
  for (int i = 0; i < 20; ++i)
    source += "#define M" + std::to_string(i) + " M" + std::to_string(i + 1) + "\n";
  FrontendRun run(source + "#define M20 1.5\nmain() { x = M0; }");
  EXPECT_NE(text_of(run).find("note: and in 13 more macros\n"), std::string::npos) << text_of(run);
}

TEST(FrontendText, LongLinesAreCutAroundThePlace) {
  FrontendRun run("main() { " + std::string(5000, ' ') + "x = 1.5;" + std::string(5000, ' ') + "}");
  for (std::string rest = text_of(run); !rest.empty(); rest.erase(0, rest.find('\n') + 1))
    EXPECT_LT(rest.find('\n'), 200U);
}

TEST(FrontendText, Color) {
  FrontendRun run("long *p;");
  run.parse();
  const std::string text = compiler::render_text(run.diagnostics.all(), run.map, true);
  EXPECT_NE(text.find("\x1b[1;31merror:\x1b[0m"), std::string::npos);
  EXPECT_NE(text.find("\x1b[1;32m^\x1b[0m"), std::string::npos);
}

TEST(FrontendText, ControlCharactersOfTheSourceDoNotReachTheTerminal) {
  FrontendRun run("main() { /* \x1b[31m */ x = 1.5; }");
  EXPECT_EQ(text_of(run).find('\x1b'), std::string::npos);
}

TEST(FrontendJson, OneObjectALine) {
  FrontendRun run("#define A 1.5\nmain() { x = A; }\n// \\\n");
  run.parse();
  std::istringstream lines(compiler::render_json(run.diagnostics.all(), run.map));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  const auto warning = nlohmann::json::parse(line);
  EXPECT_EQ(warning["severity"], "warning");
  EXPECT_EQ(warning["flag"], "comment");
  ASSERT_TRUE(std::getline(lines, line));
  const auto error = nlohmann::json::parse(line);
  EXPECT_EQ(error["severity"], "error");
  EXPECT_EQ(error["code"], "E0108");
  EXPECT_EQ(error["file"], "t.IPC");
  EXPECT_EQ(error["line"], 2);
  EXPECT_EQ(error["column"], 14);
  EXPECT_EQ(error["end_column"], 15);
  EXPECT_EQ(error["source"], "main() { x = A; }");
  EXPECT_EQ(error["notes"][0]["message"], "in macro 'A', defined at t.IPC:1");
  EXPECT_EQ(error["notes"][0]["line"], 1);
  EXPECT_FALSE(std::getline(lines, line));
}

TEST(FrontendJson, AnyByteInTheSourceGivesValidJson) {
  std::string bytes;
  for (int b = 0; b < 256; ++b)
    if (b != '\n' && b != '*') bytes += static_cast<char>(b);
  FrontendRun run("main() { /* " + bytes + " */ x = 1.5 \xF0\x90 \xED\xA0\x80 \xC0\x80 y; }\n#error " +
                  bytes);
  run.parse();
  ASSERT_FALSE(run.diagnostics.all().empty());
  std::istringstream lines(compiler::render_json(run.diagnostics.all(), run.map));
  for (std::string line; std::getline(lines, line);) EXPECT_TRUE(nlohmann::json::accept(line)) << line;
  EXPECT_TRUE(nlohmann::json::accept(compiler::render_sarif(run.diagnostics.all(), run.map)));
}

TEST(FrontendSarif, ShapeOfTheLog) {
  FrontendRun run("long \xC3\xA4;\nmain() { /* \xC3\xA4 */ x = 1.5; y = 2.5; }", {});
  run.parse();
  const auto log = nlohmann::json::parse(compiler::render_sarif(run.diagnostics.all(), run.map));
  EXPECT_EQ(log["version"], "2.1.0");
  const auto& sarif_run = log["runs"][0];
  EXPECT_EQ(sarif_run["columnKind"], "unicodeCodePoints");
  EXPECT_EQ(sarif_run["tool"]["driver"]["name"], "ipos");
  ASSERT_EQ(sarif_run["results"].size(), 3U);
  for (const auto& result : sarif_run["results"]) {
    const size_t rule = result["ruleIndex"];
    EXPECT_EQ(sarif_run["tool"]["driver"]["rules"][rule]["id"], result["ruleId"]);
    EXPECT_EQ(result["level"], "error");
  }
  const auto& region = sarif_run["results"][1]["locations"][0]["physicalLocation"]["region"];
  EXPECT_EQ(region["startLine"], 2);
  EXPECT_EQ(region["startColumn"], 22);  // the byte column is 23
  EXPECT_EQ(region["endColumn"], 25);
}

TEST(FrontendSarif, FileNamesBecomeUris) {
  compiler::SourceMap map;
  const auto& file = map.add("dir/my prog\xE4.IPC", "", "x");
  compiler::Diagnostics diagnostics;
  diagnostics.report(compiler::Diag::Goto, {{file.base}, {file.base + 1}});
  const auto log = nlohmann::json::parse(compiler::render_sarif(diagnostics.all(), map));
  EXPECT_EQ(log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"],
            "dir/my%20prog%E4.IPC");
}

Messages with_options(const std::vector<std::string>& options, bool& errors) {
  compiler::WarningOptions warnings;
  for (const std::string& option : options) EXPECT_TRUE(warnings.apply(option)) << option;
  FrontendRun run("// \\\n#if A\n#endif\n", {}, {}, warnings);
  const Messages found = run.parse().messages();
  errors = run.diagnostics.has_errors();
  return found;
}

TEST(FrontendWarnings, Options) {
  bool errors = false;
  const Messages both{"W0102 1:4", "W0124 2:5"};
  EXPECT_EQ(with_options({}, errors), both);
  EXPECT_FALSE(errors);
  EXPECT_EQ(with_options({"no-comment"}, errors), Messages{"W0124 2:5"});
  EXPECT_EQ(with_options({"no-all"}, errors), Messages{});
  EXPECT_EQ(with_options({"no-all", "comment"}, errors), Messages{"W0102 1:4"});
  EXPECT_EQ(with_options({"no-all", "all"}, errors), both);
  EXPECT_FALSE(errors);
  EXPECT_EQ(with_options({"error"}, errors), both);
  EXPECT_TRUE(errors);
  with_options({"error", "no-error"}, errors);
  EXPECT_FALSE(errors);
  with_options({"error=comment"}, errors);
  EXPECT_TRUE(errors);
  with_options({"error=comment", "comment"}, errors);
  EXPECT_TRUE(errors);
  with_options({"error", "no-error=comment", "no-undefined-macro"}, errors);
  EXPECT_FALSE(errors);
  EXPECT_FALSE(compiler::WarningOptions().apply("no-such-warning"));
  EXPECT_FALSE(compiler::WarningOptions().apply(""));
}

}  // namespace
}  // namespace ipos::tests
