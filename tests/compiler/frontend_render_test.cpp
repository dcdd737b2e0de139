// Diagnostics as text, JSON and SARIF; chains of macros and includes; the -W options.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

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

TEST(FrontendText, UnderlinesToTheEndOfWhatIsShown) {
  const std::string name(300, 'n');
  const auto expected = [&](size_t blanks) {
    const std::string line = "long" + std::string(blanks, ' ') + name + ";";
    const size_t column = 4 + blanks;
    const size_t cut = column > 80 ? column - 80 : 0;
    const size_t caret = column - cut;
    return "t.IPC:1:" + std::to_string(column + 1) + ": warning: '" + name +
           "' is longer than 32 characters; only '" + name.substr(0, 32) +
           "' counts [W0101, -Wlong-identifier]\n    1 | " + line.substr(cut, 160) + "\n      | " +
           std::string(caret, ' ') + "^" + std::string(159 - caret, '~') + "\n";
  };
  for (const size_t blanks : {1U, 75U, 76U, 77U, 100U}) {
    FrontendRun run("long" + std::string(blanks, ' ') + name + ";");
    EXPECT_EQ(text_of(run), expected(blanks)) << blanks;
  }
}

TEST(FrontendText, UnderlinesCharactersNotBytes) {
  FrontendRun run("long a, Dr\xC3\xBC_\xC3\xBC;");
  EXPECT_NE(text_of(run).find("\n      |         ^~~~~\n"), std::string::npos) << text_of(run);
  FrontendRun one("long a, \xC3\xBC;");
  EXPECT_NE(text_of(one).find("\n      |         ^\n"), std::string::npos) << text_of(one);
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

TEST(FrontendJson, RangesOverSeveralLinesHaveBothEnds) {
  FrontendRun run("\nf(long a,\n  long \xC3\xA4x) { }");
  run.parse();
  ASSERT_FALSE(run.diagnostics.all().empty());
  const auto& parameters = run.diagnostics.all().back();
  ASSERT_EQ(parameters.diag, compiler::Diag::FunctionParameters);
  const auto json = nlohmann::json::parse(compiler::render_json({&parameters, 1}, run.map));
  EXPECT_EQ(json["line"], 2);
  EXPECT_EQ(json["column"], 3);
  EXPECT_EQ(json["end_line"], 3);
  EXPECT_EQ(json["end_column"], 11);
  EXPECT_EQ(json["source"], "f(long a,");
  const auto log = nlohmann::json::parse(compiler::render_sarif({&parameters, 1}, run.map));
  const auto& region = log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["region"];
  EXPECT_EQ(region,
            nlohmann::json::parse(R"({"startLine": 2, "startColumn": 3, "endLine": 3, "endColumn": 10})"));
}

// The severities of all warnings under some options, by flag; the errors stay errors.
std::map<std::string_view, compiler::Severity> severities(const std::vector<std::string>& options) {
  compiler::WarningOptions warnings;
  for (const std::string& option : options) EXPECT_TRUE(warnings.apply(option)) << option;
  std::map<std::string_view, compiler::Severity> out;
  for (const compiler::DiagInfo& row : compiler::diagnostic_table()) {
    if (row.severity != compiler::Severity::Warning)
      EXPECT_EQ(warnings.severity(row), row.severity) << row.code;
    else
      out[row.flag] = warnings.severity(row);
  }
  return out;
}

TEST(FrontendWarnings, EveryFlagAloneAndTogether) {
  using compiler::Severity;
  // Rows marked OPT_IN say on their page that they have to be asked for.
  const std::set<std::string_view> by_request = {"steps-by-number", "fall-through", "several-writers", "unread-result", "switch-state", "unset-parameter", "exact-position", "task-restarted"};
  const std::map<std::string_view, Severity> at_first = severities({});
  for (const auto& [flag, severity] : at_first)
    EXPECT_EQ(severity == Severity::Note, by_request.contains(flag)) << flag;
  for (const auto& row : at_first) {
    const std::string flag(row.first);
    const std::pair<std::vector<std::string>, Severity> cases[] = {
        {{flag}, Severity::Warning},
        {{"no-" + flag}, Severity::Note},
        {{"error=" + flag}, Severity::Error},
        {{"no-error=" + flag}, Severity::Warning},
        {{"no-" + flag, flag}, Severity::Warning},
        {{flag, "no-" + flag}, Severity::Note},
        {{"error=" + flag, flag}, Severity::Error},
        {{"error=" + flag, "no-error=" + flag}, Severity::Warning},
        {{"no-error=" + flag, "error=" + flag}, Severity::Error},
        {{"error=" + flag, "no-" + flag}, Severity::Note},
        {{"error=" + flag, "no-" + flag, flag}, Severity::Warning},
        {{"error", flag}, Severity::Error},
        {{flag, "error", "no-error"}, Severity::Warning},
        {{"error", "no-error=" + flag}, Severity::Warning},
        {{"error", "no-error=" + flag, flag}, Severity::Warning},
        {{"error", "no-" + flag}, Severity::Note},
    };
    for (const auto& [options, expected] : cases) {
      std::map<std::string_view, Severity> wanted = at_first;
      wanted[flag] = expected;
      const bool all_errors = options.front() == "error";
      for (auto& [other, severity] : wanted)
        if (all_errors && other != flag && severity == Severity::Warning) severity = Severity::Error;
      EXPECT_EQ(severities(options), wanted) << options.back();
    }
  }
  for (const auto& [options, expected] :
       {std::pair<std::vector<std::string>, Severity>{{"all"}, Severity::Warning},
        {{"no-all"}, Severity::Note},
        {{"error=all"}, Severity::Error},
        {{"no-error=all"}, Severity::Warning},
        {{"no-all", "all"}, Severity::Warning},
        {{"no-all", "error"}, Severity::Note},
        {{"all", "error"}, Severity::Error},
        {{"error=all", "all", "no-error"}, Severity::Error}})
    for (const auto& [flag, severity] : severities(options))
      EXPECT_EQ(severity, expected) << flag << options[0];
  for (const char* unknown : {"no-", "error=", "no-error=", "no-no-comment", "error=no-comment", "comments",
                              "commen", "error=none", "no-error=none", "Comment"})
    EXPECT_FALSE(compiler::WarningOptions().apply(unknown)) << unknown;
}

// A warning that is off takes notes, too, and nobody reads them.
TEST(FrontendWarnings, ThatAreOffAreNotKept) {
  compiler::WarningOptions off;
  ASSERT_TRUE(off.apply("no-comment"));
  compiler::Diagnostics diagnostics(off);
  diagnostics.report(compiler::Diag::BackslashInComment, {}).notes.push_back({{}, "a note"});
  EXPECT_TRUE(diagnostics.report(compiler::Diag::NestedComment, {}).notes.empty());
  EXPECT_TRUE(diagnostics.all().empty());
  EXPECT_EQ(diagnostics.error_count(), 0U);
  EXPECT_FALSE(diagnostics.has_errors());
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
