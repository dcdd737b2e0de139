// Shell patterns mean what fnmatch(3) of the C library makes of them.
#include "tools/testing/pattern.hpp"

#include <fnmatch.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

namespace ipos::tests {
namespace {

using tools::testing::matches;

TEST(Pattern, MeansWhatTheCLibrarySays) {
  std::mt19937 random(1);
  const auto text_of = [&](const std::string& letters, size_t most) {
    std::string text(random() % (most + 1), ' ');
    for (char& letter : text) letter = letters[random() % letters.size()];
    return text;
  };
  int matching = 0;
  for (int n = 0; n < 400'000; ++n) {
    // Whole brackets, as what the C library makes of `[` without its end differs from version to version.
    std::string pattern;
    for (size_t parts = random() % 5; parts > 0; --parts)
      pattern += random() % 3 == 0 ? (random() % 2 == 0 ? "[" : "[!") + text_of("abcd-", 3) + "x]"
                                   : text_of("ab/*?", 3) + (random() % 4 == 0 ? "\\*" : "");
    const std::string text = text_of("abc*-/", 5);
    const bool expected = fnmatch(pattern.c_str(), text.c_str(), 0) == 0;
    ASSERT_EQ(matches(pattern, text), expected) << pattern << " and " << text;
    matching += expected ? 1 : 0;
  }
  EXPECT_GT(matching, 20'000);
}

TEST(Pattern, Brackets) {
  EXPECT_TRUE(matches("[]a]", "]"));
  EXPECT_TRUE(matches("[!]a]", "b"));
  EXPECT_FALSE(matches("[!]a]", "]"));
  EXPECT_TRUE(matches("[^a]", "b"));
  EXPECT_TRUE(matches("[a-]", "-"));
  EXPECT_TRUE(matches("[\\]]", "]"));
  EXPECT_FALSE(matches("[c-a]", "b"));
  EXPECT_TRUE(matches("a[1", "a[1"));  // no end: it stands for itself
  EXPECT_FALSE(matches("a\\", "a\\"));
  EXPECT_TRUE(matches("\\[1\\]", "[1]"));
}

}  // namespace
}  // namespace ipos::tests
