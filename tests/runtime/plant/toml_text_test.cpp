// What the TOML parser must not see is found in front of it, with its place; what TOML allows goes through.
#include <gtest/gtest.h>

#include <string>

#include "runtime/plant_file/plant_file.hpp"
#include "runtime/plant_file/read_toml.hpp"
#include "runtime/plant_file/toml_text.hpp"

namespace ipos::runtime {
namespace {

struct Case {
  const char* text;
  uint32_t line, column;
};

TEST(TomlText, MistakesHaveTheirPlace) {
  constexpr Case kCases[] = {
      // Bytes beyond ASCII, also behind a text, in a key and in a second line.
      {"\xC3\xB6 = 1", 1, 1},
      {"a = \"x\"\xC9\x9E", 1, 8},
      {"a = 1 # \xC3\xB6\nb\xC3\xB6 = 2", 2, 2},
      {"a = '''\n\xC3\xB6'''\n\xC3\xB6", 3, 1},
      // A text in quotes in the middle of a word, or behind another text.
      {"uni=01\"md7\"", 1, 7},
      {"a = x'b'", 1, 6},
      {"a = \"x\" \"y\"", 1, 9},
      {"a = [1 \"y\"]", 1, 8},
      {"a = ]\"y\"", 1, 6},
      // In what begins like a number, with brackets in it, all up to a blank is one word.
      {"a = 1[[\"\xC3\xB6\"", 1, 8},
      {"a = [ +1=\"x\" ]", 1, 10},
      {"a = { b = 1{'x' }", 1, 13},
      {"a = -1e['x'", 1, 9},
      // A } where a list waits for a value, also in the next line and behind a comment.
      {"a = [ } ]", 1, 7},
      {"a = [ 1, } ]", 1, 10},
      {"a = [\n  # none\n}", 3, 1},
      {"a = [ \"}\", # }\n}", 2, 1},
      {"a = { b = [}", 1, 12},
      // The name of a table that begins with no character of a key.
      {"[{a}]", 1, 2},
      {"a = 1\n [ = ]", 2, 4},
      {"[[ + ]]", 1, 4},
      {"[\n", 1, 2},
      {"[[ \r\n]]", 1, 4},
      {"[# none", 1, 2},
      {"[[[a]]]", 1, 3},
      {"[ [a]]", 1, 3},
      {"[.a]", 1, 2},
      // A byte beyond ASCII behind a backslash, also at the end of a line.
      {"a = \"x\\\xC3\xB6\"", 1, 8},
      {"a = \"\"\"\\\n\xC3\"\"\"", 2, 1},  // and no whole character
      // A column is a character, also behind one of several bytes.
      {"a = \"\xC3\xB6\xE2\x82\xAC\" \"y\"", 1, 10},
      // Behind empty texts and texts of several lines with quotes in front of their end.
      {"a = \"\" \"y\"", 1, 8},
      {"a = '' 'y'", 1, 8},
      {"a = \"\"\"\"\"\" \"y\"", 1, 12},
      {"a = \"\"\"x\"\"\"\"\" \"y\"", 1, 15},
      {"a = '''x'''' 'y'", 1, 14},
      {"a = '''\n\nx''' 'y'", 3, 6},
      {"a = \"\xC3\xA9\xC2\xBF\" \"y\"", 1, 10},
      // Dates and times, right and wrong ones: no key takes one.
      {"a = 2026-01-01", 1, 5},
      {"a = 2026-01-01 1\n", 1, 5},
      {"a = [ 1, 2026-01-01T:7:32:00Z ]", 1, 10},
      {"a = 1\nb = 12:00", 2, 5},
      {"a = 1+1", 1, 5},
      {"a = 000e-0e-00 1", 1, 5},
  };
  for (const Case& it : kCases) {
    const auto mistake = toml_mistake(it.text);
    ASSERT_TRUE(mistake) << it.text;
    EXPECT_EQ(mistake->place.line, it.line) << it.text;
    EXPECT_EQ(mistake->place.column, it.column) << it.text;
    const PlantFileResult plant = read_plant_file(it.text);
    ASSERT_EQ(plant.errors.size(), 1U) << it.text;
    EXPECT_EQ(plant.errors[0].text, mistake->text) << it.text;
  }
}

TEST(TomlText, WhatTomlAllowsGoesThrough) {
  constexpr const char* kTexts[] = {
      "",
      "\xEF\xBB\xBF\"a\" = 1",
      "a = \"\xC3\xB6 \\\" }\" # \xC3\xB6 \"",
      "\"a\" = 1\n'b' = 2\r\n\"c\".\"d\" = 3\n[\"e\".'f']\n[[\"g\"]]\n[ -1._ ]\n\"h\" = [ ]",
      "a = [ \"x\", 'y' ]\nb = [\n  \"x\", # one\n  \"y\",\n]",
      "a = { \"b\" = \"c\", 'd' = { } }\ne = {}",
      "a = \"\"\"\n\xC3\xB6 \" \"\" [ }\n\"\"\"\nb = '''['''",
      "a = \"\"\"x \\\n  y \xC3\xB6\\\\\xC3\xB6 \"\"\"\nb = '\\\xC3\xB6'",
      "a = \"\"\"x\"\"\"\"\"\nb = '''x''''\nc = ''",
      "a = [ { b = 1 }, { b = 2 } ]\nc = [ [ 1 ], [ ] ]",
      "a = [ -1, +2, 1e-5, 1E+5, 0x1F, -0.5 ]\nc = 12 # 2026-01-01 1\nd = \"2026-01-01 1\"\n2026-01-01 = 1",
      "1=\"x\"\na = { 2=\"y\", 3='z' }\nb = [ { 4=\"x\" } ]\n[5.\"c\"]\n6.\"d\"=1",
      "a = [\n  [ 1 ],\n  [ +1 ],\n]\nb = [\n  [ -1 ]\n]",
  };
  for (const char* const text : kTexts) {
    const auto mistake = toml_mistake(text);
    EXPECT_FALSE(mistake) << text << ": " << mistake->place.line << ':' << mistake->place.column << ' '
                          << mistake->text;
  }
}

// toml-test valid/string/start-mb and its like: the first character behind a folded line end, in two, three and four bytes.
TEST(TomlText, ACharacterBeyondAsciiMayFollowAFoldedLine) {
  for (const char* letter : {"\xC3\xA9", "\xE2\x82\xAC", "\xF0\x9F\x98\x80"})
    for (const char* fold : {"\\\n", "\\ \r\n\t\n  "}) {
      const auto table = read_toml("a = \"\"\"x" + std::string(fold) + letter + "y\"\"\"\nb = \"" + letter + "\"\n");
      ASSERT_TRUE(table) << table.error().text;
      EXPECT_EQ((*table)["a"].value_or(std::string()), std::string("x") + letter + "y") << fold;
      EXPECT_EQ((*table)["b"].value_or(std::string()), letter);
    }
}

// The parser takes stack for each part of a key and each value in a value. The longest that is taken, all at once, and
// much more.
TEST(TomlText, DeepTextsAreRefusedAndNotFollowed) {
  const auto times = [](const std::string& text, size_t n) {
    std::string all;
    for (size_t k = 0; k < n; ++k) all += text;
    return all;
  };
  EXPECT_TRUE(read_toml(times("a.", 15) + "a = 1"));
  EXPECT_TRUE(read_toml("[" + times("a . \"b.c.d\" . ", 7) + "a]\n"));
  EXPECT_TRUE(read_toml("[" + times("a.", 15) + "a]\n" + times("a.", 15) + "a = " + times("{" + times("a.", 15) + "a = ", 100) + "1" +
                        times("}", 100)));
  const std::string deep[] = {times("a.", 16) + "a = 1", times("a.", 100'000) + "a=1", "[" + times("a.", 100'000) + "a]",
                              "[[" + times("'a'.", 100'000) + "a]]", "a = {" + times("a.", 100'000) + "a = 1}",
                              "a = [{" + times("\"a\" . ", 100'000) + "a = 1}]", "a = " + times("[", 1'000'000),
                              times("a = {", 1'000'000), "a = " + times("[{a = ", 1'000'000),
                              times("[a.a]\n[[", 1'000'000)};
  for (const std::string& text : deep) {
    const auto table = read_toml(text);
    ASSERT_FALSE(table) << text.substr(0, 40);
    EXPECT_FALSE(table.error().text.empty());
    EXPECT_FALSE(read_plant_file(text).errors.empty());
  }
}

// They would act on a terminal, or end a line of a report.
TEST(TomlText, ControlCharactersAreRefusedAtTheirPlace) {
  for (const char* escape : {"\\u001b[2J", "\\u0007", "\\u0000", "\\b", "\\r", "\\u007f", "\\u009b31m"}) {
    for (const std::string& text : {"x = 1\n" + std::string("a = \"") + escape + "\"",
                                    "x = 1\na = { b = [ \"" + std::string(escape) + "\" ] }",
                                    "x = 1\n\"" + std::string(escape) + "\" = 1",
                                    "x = 1\n[\"" + std::string(escape) + "\"]\n"}) {
      const auto table = read_toml(text);
      ASSERT_FALSE(table) << text;
      EXPECT_EQ(table.error().place.line, 2U) << text;
      EXPECT_NE(table.error().text.find("control characters"), std::string::npos) << text;
    }
  }
  EXPECT_TRUE(read_toml("a = \"\"\"one\r\ntwo\tthree\"\"\"\nb = \"\\u00e4\\ufffe\""));
  const PlantFileResult plant = read_plant_file("[[station]]\nname = \"a\\nb\"\nunit = \"mdxb\"\n");
  ASSERT_EQ(plant.errors.size(), 1U);
  EXPECT_EQ(plant.errors[0].place.line, 2U);
  EXPECT_EQ(plant.errors[0].text, "name is one line");
}

// The hundredth is the last one told, in time that grows with the text.
TEST(TomlText, ManyMistakesEnd) {
  std::string text;
  for (int n = 0; n < 200'000; ++n) text += "k" + std::to_string(n) + " = 1\n";
  const PlantFileResult plant = read_plant_file(text);
  ASSERT_EQ(plant.errors.size(), 101U);
  EXPECT_NE(plant.errors.back().text.find("too many"), std::string::npos);
}

// What only `ipos test` looks at does not keep others from the plant; a mistake in it does.
TEST(TomlText, ExpectationsOfTestsArePassedOver) {
  const std::string station = "[[station]]\nname = \"u\"\nunit = \"mdxb\"\n[[expect]]\nstation = \"u\"\n";
  for (const char* rest : {"at = \"5ms\"\nparameter = \"P130\"\nmin = 3\n", "at = \"end\"\nparameter = \"P130\"\nequals = 3\n",
                           "after = \"5ms\"\nparameter = \"P130\"\nequals = 3\nwithin = \"1s\"\nnote = \"x\"\n"}) {
    const PlantFileResult plant = read_plant_file(station + rest);
    EXPECT_TRUE(plant.errors.empty()) << rest << plant.errors[0].text;
    EXPECT_EQ(plant.plant.expectations_of_tests, 1U) << rest;
    EXPECT_TRUE(plant.plant.expectations.empty());
  }
  EXPECT_EQ(read_plant_file(station + "min = 3\nmix = 4\n").errors.size(), 1U);
  const PlantFileResult named = read_plant_file("plant = \"line.toml\"\n[[step]]\nat = \"1s\"\n");
  ASSERT_EQ(named.errors.size(), 1U);
  EXPECT_NE(named.errors[0].text.find("a test of the plant 'line.toml'"), std::string::npos);
}

}  // namespace
}  // namespace ipos::runtime
