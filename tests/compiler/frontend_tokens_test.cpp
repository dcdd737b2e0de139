// Characters, names, numbers and comments.
#include <gtest/gtest.h>

#include "compiler/preprocess/number.hpp"
#include "tests/compiler/frontend_run.hpp"

namespace ipos::tests {
namespace {

using compiler::NumberForm;
using compiler::parse_number;

TEST(FrontendNumbers, ValuesOfTheManual) {
  // IPOSplus p. 190: decimal, hexadecimal, binary; 030 stands among the decimal ones.
  EXPECT_EQ(parse_number("123", false).value, 123U);
  EXPECT_EQ(parse_number("030", false).value, 30U);
  EXPECT_EQ(parse_number("0x23", false).value, 35U);
  EXPECT_EQ(parse_number("0xabc", false).value, 2748U);
  EXPECT_EQ(parse_number("0b000100", false).value, 4U);
  EXPECT_EQ(parse_number("0b11111111", false).value, 255U);
  EXPECT_EQ(static_cast<int32_t>(parse_number("0xFFFFFFFF", false).value), -1);
}

TEST(FrontendNumbers, Limits) {
  EXPECT_EQ(parse_number("2147483647", false).form, NumberForm::Good);
  EXPECT_EQ(parse_number("2147483648", false).form, NumberForm::TooLarge);
  EXPECT_EQ(parse_number("2147483648", true).form, NumberForm::Good);
  EXPECT_EQ(parse_number("2147483649", true).form, NumberForm::TooLarge);
  EXPECT_EQ(parse_number("0x100000000", true).form, NumberForm::TooLarge);
  EXPECT_EQ(parse_number("0x00000000FFFFFFFF", false).form, NumberForm::Good);
  EXPECT_EQ(parse_number("99999999999999999999999999999999", false).form, NumberForm::TooLarge);
  EXPECT_EQ(parse_number("0b" + std::string(32, '1'), false).form, NumberForm::Good);
  EXPECT_EQ(parse_number("0b1" + std::string(32, '0'), false).form, NumberForm::TooLarge);
}

TEST(FrontendNumbers, Forms) {
  EXPECT_TRUE(parse_number("0x1", false).pattern);
  EXPECT_TRUE(parse_number("0b1", false).pattern);
  EXPECT_FALSE(parse_number("1", false).pattern);
  for (const char* bad : {"0x", "0b", "0b2", "0xG", "12ab", "1_0", "10L", "0b1.1", "e5", "E5"})
    EXPECT_EQ(parse_number(bad, false).form, NumberForm::Bad) << bad;
  for (const char* fraction : {"1.5", ".5", "1.", "1e6", "2E3", "1.5e2"})
    EXPECT_EQ(parse_number(fraction, false).form, NumberForm::Fraction) << fraction;
}

TEST(FrontendTokens, Listing) {
  EXPECT_EQ(FrontendRun("long x;\n  x<<=0x1F;").tokens(),
            "1:1 keyword long\n1:6 name x\n1:7 operator ;\n"
            "2:3 name x\n2:4 operator <<=\n2:7 number 0x1F\n2:11 operator ;\n2:12 end\n");
}

TEST(FrontendTokens, TokensOfAnIncludedFileNameIt) {
  EXPECT_EQ(FrontendRun("#include \"a.h\"\ny", {{"a.h", "x"}}).tokens(),
            "a.h:1:1 name x\n2:1 name y\n2:2 end\n");
}

TEST(FrontendTokens, LongestOperatorWins) {
  EXPECT_EQ(FrontendRun("a+++b>>=c->d&&e&f!==g").words(), "a ++ + b >>= c -> d && e & f != = g");
}

TEST(FrontendTokens, LineEndsAndBlanks) {
  EXPECT_EQ(FrontendRun("a\r\n\tb\v\f c\r\n").tokens(), "1:1 name a\n2:2 name b\n2:6 name c\n3:1 end\n");
  EXPECT_EQ(FrontendRun("a").tokens(), "1:1 name a\n1:2 end\n");
  EXPECT_EQ(FrontendRun("").tokens(), "1:1 end\n");
  EXPECT_EQ(FrontendRun("\n\n").tokens(), "3:1 end\n");
}

TEST(FrontendTokens, LinesJoinedByBackslash) {
  EXPECT_EQ(FrontendRun("#define A 1 \\\r\n + \\\n2\nA").words(), "1 + 2");
}

TEST(FrontendTokens, ByteOrderMarkAndEndMark) {
  EXPECT_EQ(FrontendRun("\xEF\xBB\xBFx\x1A").tokens(), "1:4 name x\n1:6 end\n");
}

TEST(FrontendTokens, AnyByteInComments) {
  std::string bytes;
  for (int b = 1; b < 256; ++b)
    if (b != '\n' && b != '*' && b != '/' && b != '\\') bytes += static_cast<char>(b);
  bytes += '\0';
  FrontendRun run("// " + bytes + "\nx /* " + bytes + "\n" + bytes + " **/ y /**/ z /***/");
  EXPECT_EQ(run.words(), "x y z");
  EXPECT_EQ(run.messages(), Messages{});
}

TEST(FrontendTokens, CommentMarksInsideEachOther) {
  EXPECT_EQ(FrontendRun("a // b /* c\nd /* // */ e").words(), "a d e");
  EXPECT_EQ(FrontendRun("a /*/ b */ c").words(), "a c");
  EXPECT_EQ(FrontendRun("a /* b /*/ c").words(), "a c");
}

TEST(FrontendTokens, NameOfThirtyTwoCharactersIsWhole) {
  const std::string name32(32, 'n');
  FrontendRun good(name32 + " " + name32 + "a " + name32 + "b " + name32 + "b");
  EXPECT_EQ(good.words(), name32 + " " + name32 + " " + name32 + " " + name32);
  EXPECT_EQ(good.messages(), (Messages{"W0101 1:34", "W0101 1:68"}));  // once for each spelling
}

TEST(FrontendTokens, LongNamesAreTheSameMacro) {
  const std::string name32(32, 'n');
  EXPECT_EQ(FrontendRun("#define " + name32 + "x 5\n" + name32 + "y").words(), "5");
}

}  // namespace
}  // namespace ipos::tests
