// Places in sources and the tree as text, and what the renderers make of any bytes, long lines and long chains.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "compiler/diag/places.hpp"
#include "compiler/diag/render.hpp"
#include "compiler/parse/parse.hpp"
#include "tests/compiler/frontend_run.hpp"

namespace ipos::tests {
namespace {

using compiler::Location;
using compiler::SourceMap;

std::string place_of(const SourceMap& map, Location at) {
  const compiler::Position found = map.position(at);
  return found.file == nullptr
             ? "none"
             : found.file->name + ":" + std::to_string(found.line) + ":" + std::to_string(found.column);
}

TEST(FrontendPlaces, OfEveryByteAndTheEndOfEachFile) {
  SourceMap map;
  const auto& first = map.add("a", "dir/a", "x\n\nyz");
  const auto& second = map.add("b", "", "");
  const auto& third = map.add("c", "c", "\n", Location{first.base});
  const std::string expected[] = {"none",  "a:1:1", "a:1:2", "a:2:1", "a:3:1",
                                  "a:3:2", "a:3:3", "b:1:1", "c:1:1", "c:2:1"};
  for (uint32_t at = 0; at < 10; ++at) EXPECT_EQ(place_of(map, Location{at}), expected[at]) << at;
  EXPECT_EQ(map.file_of(Location{0}), nullptr);
  EXPECT_EQ(map.file_of(Location{first.base}), &first);
  EXPECT_EQ(map.file_of(Location{second.base}), &second);
  EXPECT_EQ(map.file_of(Location{third.base + 1}), &third);
  EXPECT_EQ(first.path, "dir/a");
  EXPECT_EQ(third.included_at, Location{first.base});
  EXPECT_FALSE(first.included_at.valid());
  ASSERT_EQ(map.files().size(), 3U);
  EXPECT_EQ(map.files()[1].get(), &second);
}

TEST(FrontendPlaces, LinesWithoutTheirEnds) {
  SourceMap map;
  const auto& file = map.add("a", "", "one\r\n\ntwo\rthree\r\n\r\nlast");
  const std::string_view expected[] = {"", "one", "", "two\rthree", "", "last", ""};
  for (uint32_t line = 0; line < 7; ++line)
    EXPECT_EQ(SourceMap::line_text(file, line), expected[line]) << line;
  const auto& ended = map.add("b", "", "x\n");
  EXPECT_EQ(SourceMap::line_text(ended, 1), "x");
  EXPECT_EQ(SourceMap::line_text(ended, 2), "");
}

TEST(FrontendPlaces, InMacrosWithinMacros) {
  SourceMap map;
  const auto& file = map.add("a", "", "inner outer use");
  const Location written{file.base};
  const Location used{file.base + 12};
  const Location outer = map.add_expansion("OUTER", Location{file.base + 6}, used);
  const Location inner = map.add_expansion("INNER", written, outer);
  EXPECT_TRUE(inner.in_macro());
  EXPECT_FALSE(used.in_macro());
  EXPECT_EQ(map.spelling(inner), written);
  EXPECT_EQ(map.use(inner), used);
  EXPECT_EQ(map.use(used), used);
  EXPECT_EQ(map.spelling(written), written);
  EXPECT_EQ(map.expansion(inner).macro, "INNER");
  EXPECT_EQ(map.expansion(outer).macro, "OUTER");
  EXPECT_EQ(map.expansion(inner).use, outer);
  EXPECT_EQ(place_of(map, inner), "a:1:13");
  EXPECT_EQ(map.file_of(inner), &file);
}

TEST(FrontendPlaces, RangesAreNeverTurnedRound) {
  SourceMap map;
  const auto& file = map.add("a", "", "one\ntwo");
  const auto& other = map.add("b", "", "x");
  const auto range = [&](uint32_t begin, uint32_t end) {
    const compiler::Range found = compiler::range_of({{begin}, {end}}, map);
    return std::to_string(found.begin.line) + ":" + std::to_string(found.begin.column) + "-" +
           std::to_string(found.end.line) + ":" + std::to_string(found.end.column);
  };
  EXPECT_EQ(range(file.base + 1, file.base + 3), "1:2-1:4");
  EXPECT_EQ(range(file.base + 1, file.base + 1), "1:2-1:2");
  EXPECT_EQ(range(file.base + 2, file.base + 1), "1:3-1:3");
  EXPECT_EQ(range(file.base + 2, file.base + 4), "1:3-2:1") << "a column further left in a later line";
  EXPECT_EQ(range(file.base + 5, file.base + 2), "2:2-2:2");
  EXPECT_EQ(range(file.base + 1, other.base), "1:2-1:2");
  EXPECT_EQ(range(file.base + 1, 0), "1:2-1:2");
}

std::string encoded_character(uint32_t c) {
  const auto byte = [](uint32_t value) { return static_cast<char>(value); };
  if (c < 0x80) return {byte(c)};
  if (c < 0x800) return {byte(0xC0 | c >> 6), byte(0x80 | (c & 0x3F))};
  if (c < 0x10000) return {byte(0xE0 | c >> 12), byte(0x80 | (c >> 6 & 0x3F)), byte(0x80 | (c & 0x3F))};
  return {byte(0xF0 | c >> 18), byte(0x80 | (c >> 12 & 0x3F)), byte(0x80 | (c >> 6 & 0x3F)),
          byte(0x80 | (c & 0x3F))};
}

TEST(FrontendBytes, CharactersOfUtf8StayAsTheyAre) {
  for (const uint32_t c : {0x09U,   0x20U,    0x7EU,    0xA0U,    0xFFU,    0x100U,    0x7FFU,   0x800U,
                           0xFFFU,  0x1000U,  0xCFFFU,  0xD000U,  0xD7FFU,  0xE000U,   0xEFFFU,  0xF000U,
                           0xFFFFU, 0x10000U, 0x3FFFFU, 0x40000U, 0xFFFFFU, 0x100000U, 0x10FFFFU}) {
    const std::string text = encoded_character(c);
    EXPECT_EQ(compiler::printable(text), text) << c;
    EXPECT_EQ(compiler::characters(text), 1U) << c;
    EXPECT_EQ(compiler::characters("a" + text + "b"), 3U) << c;
    // Cut off, every byte of it is a character of Latin-1.
    for (size_t length = 1; length < text.size(); ++length)
      EXPECT_EQ(compiler::characters(text.substr(0, length)), length) << c;
    for (size_t n = 1; n < text.size(); ++n) {
      std::string broken = text;
      broken[n] = 'x';
      EXPECT_GT(compiler::characters(broken), 1U) << c << " " << n;
      broken[n] = '\xC0';
      EXPECT_GT(compiler::characters(broken), 1U) << c << " " << n;
    }
  }
  for (const uint32_t c : {0x00U, 0x08U, 0x0AU, 0x1FU, 0x7FU, 0x80U, 0x9FU})
    EXPECT_EQ(compiler::printable(encoded_character(c)), "?") << c;
}

// Table 3-7 of the Unicode standard: which second bytes go with which first ones.
TEST(FrontendBytes, OnlyShortestFormsOfTrueCharacters) {
  for (uint32_t first = 0x80; first <= 0xFF; ++first)
    for (uint32_t second = 0; second <= 0xFF; ++second) {
      const uint32_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
      bool good = second >= 0x80 && second <= 0xBF && first >= 0xC2 && first <= 0xF4;
      if (first == 0xE0) good = good && second >= 0xA0;
      if (first == 0xED) good = good && second <= 0x9F;
      if (first == 0xF0) good = good && second >= 0x90;
      if (first == 0xF4) good = good && second <= 0x8F;
      std::string text{static_cast<char>(first), static_cast<char>(second)};
      text += std::string(length - 2, '\xBF');
      EXPECT_EQ(compiler::characters(text) == 1, good) << first << " " << second;
      EXPECT_TRUE(nlohmann::json::accept("\"" + std::string(good ? compiler::printable(text) : "") + "\""))
          << first << " " << second;
    }
}

TEST(FrontendBytes, BytesThatAreNoUtf8AreLatin1) {
  for (uint32_t byte = 0x80; byte <= 0xFF; ++byte)
    EXPECT_EQ(compiler::printable(std::string(1, static_cast<char>(byte))),
              byte < 0xA0 ? "?" : encoded_character(byte))
        << byte;
  EXPECT_EQ(compiler::printable("\xE4\xF6"), encoded_character(0xE4) + encoded_character(0xF6));
  EXPECT_EQ(compiler::printable("a\tb\x1b[1m"), "a\tb?[1m");
}

// `begin` counts from 0.
std::string quoted(const std::string& line, size_t begin) {
  return compiler::render_mistake("p", "t", 7, line, begin, false);
}

TEST(FrontendQuotes, AreCutToAHundredSixtyCharactersAroundThePlace) {
  const auto line_of = [](size_t size) {
    std::string out;
    for (size_t n = 0; n < size; ++n) out += static_cast<char>('a' + n % 26);
    return out;
  };
  const auto expected = [](const std::string& shown, size_t caret) {
    return "p error: t\n    7 | " + shown + "\n      | " + std::string(caret, ' ') + "^\n";
  };
  EXPECT_EQ(quoted(line_of(160), 0), expected(line_of(160), 0));
  EXPECT_EQ(quoted(line_of(160), 159), expected(line_of(160), 159));
  EXPECT_EQ(quoted(line_of(161), 80), expected(line_of(160), 80));
  EXPECT_EQ(quoted(line_of(161), 81), expected(line_of(161).substr(1), 80));
  EXPECT_EQ(quoted(line_of(1000), 500), expected(line_of(1000).substr(420, 160), 80));
  EXPECT_EQ(quoted(line_of(1000), 990), expected(line_of(1000).substr(910), 80));
  EXPECT_EQ(quoted("", 0), "p error: t\n") << "no line, no quote";
  EXPECT_EQ(compiler::render_mistake("p", "t", 7, "ab", 1, true),
            "\x1b[1mp\x1b[0m \x1b[1;31merror:\x1b[0m t\n    7 | ab\n      |  \x1b[1;32m^\x1b[0m\n");
}

std::string shown(FrontendRun& run) {
  run.parse();
  return compiler::render_text(run.diagnostics.all(), run.map, false);
}

TEST(FrontendQuotes, OfSeveralLinesShowTheFirst) {
  FrontendRun run("f(long a,\n  long b) { }");
  EXPECT_EQ(shown(run),
            "t.IPC:1:3: error: functions have no parameters; write 'f() { ... }' and pass values in global "
            "variables "
            "[E0158]\n    1 | f(long a,\n      |   ^~~~~~~\n");
}

TEST(FrontendQuotes, NameTheFlagOfAWarning) {
  FrontendRun run("#if A\n#endif");
  EXPECT_EQ(
      shown(run),
      "t.IPC:1:5: warning: 'A' is not defined and counts as 0 [W0124, -Wundefined-macro]\n    1 | #if A\n"
      "      |     ^\n");
  EXPECT_EQ(compiler::severity_word(compiler::Severity::Note), "note");
}

TEST(FrontendQuotes, ColourEveryKindOfMessage) {
  FrontendRun run("#define A 1.5\n#if B\n#endif\nmain() { x = A; }");
  run.parse();
  EXPECT_EQ(compiler::render_text(run.diagnostics.all(), run.map, true),
            "\x1b[1mt.IPC:2:5:\x1b[0m \x1b[1;35mwarning:\x1b[0m 'B' is not defined and counts as 0 [W0124, "
            "-Wundefined-macro]\n"
            "    2 | #if B\n      |     \x1b[1;32m^\x1b[0m\n"
            "\x1b[1mt.IPC:4:14:\x1b[0m \x1b[1;31merror:\x1b[0m '1.5' has a fraction, but there are whole "
            "numbers only; scale "
            "the value [E0108]\n"
            "    4 | main() { x = A; }\n      |              \x1b[1;32m^\x1b[0m\n"
            "\x1b[1mt.IPC:1:11:\x1b[0m \x1b[1;36mnote:\x1b[0m in macro 'A', defined at t.IPC:1\n"
            "    1 | #define A 1.5\n      |           \x1b[1;32m^\x1b[0m\n");
}

TEST(FrontendQuotes, TellEightMacrosAndEightFilesOfAChain) {
  for (int length = 7; length <= 10; ++length) {
    std::string source;
    for (int n = 1; n < length; ++n)
      source += "#define M" + std::to_string(n) + " M" + std::to_string(n + 1) + "\n";
    FrontendRun macros(source + "#define M" + std::to_string(length) + " 1.5\nmain() { x = M1; }");
    macros.parse();
    const auto notes = compiler::all_notes(macros.diagnostics.all().at(0), macros.map);
    EXPECT_EQ(notes.size(), static_cast<size_t>(std::min(length, 9)));
    EXPECT_EQ(notes[0].text,
              "in macro 'M" + std::to_string(length) + "', defined at t.IPC:" + std::to_string(length));
    if (length > 8) {
      EXPECT_EQ(notes.back().text, "and in " + std::to_string(length - 8) + " more macros");
    }

    FrontendRun::Files files;
    for (int n = 1; n < length; ++n)
      files["f" + std::to_string(n)] = "\n#include \"f" + std::to_string(n + 1) + "\"";
    files["f" + std::to_string(length)] = "main() { x = 1.5; }";
    FrontendRun includes("#include \"f1\"", files);
    includes.parse();
    const auto chain = compiler::all_notes(includes.diagnostics.all().at(0), includes.map);
    EXPECT_EQ(chain.size(), static_cast<size_t>(std::min(length, 9)));
    EXPECT_EQ(chain[0].text,
              "'f" + std::to_string(length) + "' included from f" + std::to_string(length - 1) + ":2");
    if (length > 8) {
      EXPECT_EQ(chain.back().text, "and " + std::to_string(length - 8) + " more files");
    }
  }
}

TEST(FrontendQuotes, CutArgumentsBehindAThousandBytes) {
  compiler::Diagnostics diagnostics;
  const std::string longest(1000, 'x');
  EXPECT_EQ(diagnostics.report(compiler::Diag::UnknownName, {}, {longest}).text,
            "unknown name '" + longest + "'");
  EXPECT_EQ(diagnostics.report(compiler::Diag::UnknownName, {}, {longest + "y"}).text,
            "unknown name '" + longest + "...'");
  EXPECT_EQ(diagnostics.report(compiler::Diag::Initializer, {}, {"{}"}).text,
            "a declaration gives no value; assign '{}' in main()");
  EXPECT_EQ(diagnostics.report(compiler::Diag::ExpectedBefore, {}, {"{}", "b"}).text, "expected {} before b");
  EXPECT_EQ(diagnostics.report(compiler::Diag::ExpectedBefore, {}, {"a"}).text, "expected a before {}");
  EXPECT_EQ(diagnostics.report(compiler::Diag::StrayBrace, {}, {}).text, "'}' without '{'");
  EXPECT_EQ(diagnostics.error_count(), 6U);
}

TEST(FrontendQuotes, JsonHasEveryFieldOfAMessage) {
  FrontendRun run("#define A 1 +\nmain() {\n  x = A;\n  y = 2.5;\n}\n#if B\n#endif\n");
  run.parse();
  std::istringstream lines(compiler::render_json(run.diagnostics.all(), run.map));
  std::vector<nlohmann::json> found;
  for (std::string line; std::getline(lines, line);) found.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(found.size(), 3U);
  const auto expected = nlohmann::json::parse(R"([
    {"severity": "warning", "code": "W0124", "message": "'B' is not defined and counts as 0", "flag": "undefined-macro",
     "file": "t.IPC", "line": 6, "column": 5, "end_line": 6, "end_column": 6, "source": "#if B", "notes": []},
    {"severity": "error", "code": "E0150", "message": "expected an expression before ';'",
     "file": "t.IPC", "line": 3, "column": 8, "end_line": 3, "end_column": 9, "source": "  x = A;", "notes": []},
    {"severity": "error", "code": "E0108",
     "message": "'2.5' has a fraction, but there are whole numbers only; scale the value",
     "file": "t.IPC", "line": 4, "column": 7, "end_line": 4, "end_column": 10, "source": "  y = 2.5;", "notes": []}])");
  for (size_t n = 0; n < 3; ++n) EXPECT_EQ(found[n], expected[n]);
  compiler::Diagnostics whole;
  whole.report(compiler::Diag::NoMain, {}, {}).notes.push_back({{}, "a note"});
  EXPECT_EQ(nlohmann::json::parse(compiler::render_json(whole.all(), run.map)),
            nlohmann::json::parse(R"({"severity": "error", "code": "E0207",
              "message": "the program has no main(), where task 1 starts", "notes": [{"message": "a note"}]})"));
}

TEST(FrontendQuotes, SarifHasItsRulesAndRelatedPlaces) {
  FrontendRun run("main() {\n while (1) {\n", {});
  run.parse();
  run.diagnostics.report(compiler::Diag::NoMain, {}, {});
  run.diagnostics.report(compiler::Diag::Goto, {{run.main->base}, {run.main->base + 4}}, {});
  run.diagnostics.report(compiler::Diag::Goto, {{run.main->base}, {run.main->base + 4}}, {});
  const auto log = nlohmann::json::parse(compiler::render_sarif(run.diagnostics.all(), run.map));
  EXPECT_EQ(log["$schema"], "https://json.schemastore.org/sarif-2.1.0.json");
  ASSERT_EQ(log["runs"].size(), 1U);
  const auto& rules = log["runs"][0]["tool"]["driver"]["rules"];
  ASSERT_EQ(rules.size(), 3U) << "one each, in the order of the table";
  EXPECT_EQ(rules[0], nlohmann::json::parse(R"({"id": "E0150", "name": "ExpectedBefore",
    "shortDescription": {"text": "expected {} before {}"}, "defaultConfiguration": {"level": "error"}})"));
  EXPECT_EQ(rules[1]["id"], "E0161");
  EXPECT_EQ(rules[2]["id"], "E0207");
  const auto& results = log["runs"][0]["results"];
  ASSERT_EQ(results.size(), 4U);
  const auto place = nlohmann::json::parse(R"({"artifactLocation": {"uri": "t.IPC"},
    "region": {"startLine": 1, "startColumn": 1, "endLine": 1, "endColumn": 5}})");
  EXPECT_EQ(results[2]["locations"][0]["physicalLocation"], place);
  EXPECT_EQ(results[2]["message"]["text"], "there is no 'goto'; use a loop with 'break' or 'continue'");
  EXPECT_FALSE(results[2].contains("relatedLocations"));
  EXPECT_FALSE(results[1].contains("locations"));
  ASSERT_EQ(results[0]["relatedLocations"].size(), 1U);
  EXPECT_EQ(results[0]["relatedLocations"][0]["physicalLocation"]["region"]["startLine"], 2);
  EXPECT_EQ(results[0]["relatedLocations"][0]["message"]["text"], run.diagnostics.all()[0].notes.at(0).text);
}

TEST(FrontendQuotes, UrisKeepWhatTheyMay) {
  SourceMap map;
  const auto& file = map.add("AZaz09-._~/ @[`{:\xC4", "", "x");
  compiler::Diagnostics diagnostics;
  diagnostics.report(compiler::Diag::Goto, {{file.base}, {file.base + 1}});
  const auto log = nlohmann::json::parse(compiler::render_sarif(diagnostics.all(), map));
  EXPECT_EQ(log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"],
            "AZaz09-._~/%20%40%5B%60%7B%3A%C4");
}

TEST(FrontendTree, PrintsEveryKindOfNode) {
  FrontendRun run(
      "main() {\n"
      "a.b[1] = *p + 0x1F;\n"
      "-a, +b;\n"
      "!a ? ~b : numof(c);\n"
      "++a; --b; c++; d--;\n"
      "e <<= f(1, g());\n"
      "for (a; ; b) { }\n"
      "for (; c; ) ;\n"
      "if (a) ; else return;\n"
      "h = 0xFFFFFFFF + 0b101;\n"
      "}\n#pragma list\n#declare X H1\n");
  EXPECT_EQ(run.parse().messages(), Messages{});
  EXPECT_EQ(run.tree(),
            "1:1 function main\n"
            "  1:8 block\n"
            "    2:1 expression\n"
            "      2:1 assign =\n"
            "        2:1 index\n"
            "          2:1 member b\n"
            "            2:1 name a\n"
            "          2:5 number 1\n"
            "        2:10 binary +\n"
            "          2:10 pointer\n"
            "            2:11 name p\n"
            "          2:15 number 0x1F\n"
            "    3:1 expression\n"
            "      3:1 comma\n"
            "        3:1 unary -\n"
            "          3:2 name a\n"
            "        3:5 unary +\n"
            "          3:6 name b\n"
            "    4:1 expression\n"
            "      4:1 conditional\n"
            "        4:1 unary !\n"
            "          4:2 name a\n"
            "        4:6 unary ~\n"
            "          4:7 name b\n"
            "        4:11 numof\n"
            "          4:17 name c\n"
            "    5:1 expression\n"
            "      5:1 step ++ before\n"
            "        5:3 name a\n"
            "    5:6 expression\n"
            "      5:6 step -- before\n"
            "        5:8 name b\n"
            "    5:11 expression\n"
            "      5:11 step ++ behind\n"
            "        5:11 name c\n"
            "    5:16 expression\n"
            "      5:16 step -- behind\n"
            "        5:16 name d\n"
            "    6:1 expression\n"
            "      6:1 assign <<=\n"
            "        6:1 name e\n"
            "        6:7 call f\n"
            "          6:9 number 1\n"
            "          6:12 call g\n"
            "    7:1 for\n"
            "      7:6 name a\n"
            "      7:1 none\n"
            "      7:11 name b\n"
            "      7:14 block\n"
            "    8:1 for\n"
            "      8:1 none\n"
            "      8:8 name c\n"
            "      8:1 none\n"
            "      8:13 empty\n"
            "    9:1 if\n"
            "      9:5 name a\n"
            "      9:8 empty\n"
            "      9:15 return\n"
            "    10:1 expression\n"
            "      10:1 assign =\n"
            "        10:1 name h\n"
            "        10:5 binary +\n"
            "          10:5 number 0xFFFFFFFF\n"
            "          10:18 number 0x5\n"
            "12:1 pragma list\n"
            "13:1 declare X\n"
            "  13:12 name H1\n");
}

}  // namespace
}  // namespace ipos::tests
