// What the TOML parser must not see is found in front of it, with its place; what TOML allows goes through.
#include <gtest/gtest.h>

#include <string>

#include "runtime/plant_file/plant_file.hpp"
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
      {"a = \"\"\" \\ \r\n\t\n \xC3\xB6\"\"\"", 3, 2},
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

}  // namespace
}  // namespace ipos::runtime
