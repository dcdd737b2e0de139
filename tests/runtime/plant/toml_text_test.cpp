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
      "a = [ { b = 1 }, { b = 2 } ]\nc = [ [ 1 ], [ ] ]",
  };
  for (const char* const text : kTexts) {
    const auto mistake = toml_mistake(text);
    EXPECT_FALSE(mistake) << text << ": " << mistake->place.line << ':' << mistake->place.column << ' ' << mistake->text;
  }
}

}  // namespace
}  // namespace ipos::runtime
