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

TEST(FrontendNumbers, EveryDigitHasItsValue) {
  const std::string_view small = "0123456789abcdef";
  const std::string_view large = "0123456789ABCDEF";
  for (uint32_t digit = 0; digit < 16; ++digit)
    for (const std::string_view letters : {small, large})
      for (const char* prefix : {"0x", "0X"}) {
        const std::string one(1, letters[digit]);
        EXPECT_EQ(parse_number(prefix + one, false).value, digit);
        EXPECT_EQ(parse_number(prefix + one + "0", false).value, 16 * digit);
        EXPECT_EQ(parse_number(prefix + one, false).form, NumberForm::Good);
        EXPECT_EQ(parse_number("0b1" + one, false).form, digit < 2 ? NumberForm::Good : NumberForm::Bad)
            << one;
        EXPECT_EQ(parse_number("0B1" + one, false).form, digit < 2 ? NumberForm::Good : NumberForm::Bad)
            << one;
        if (digit < 10) {
          EXPECT_EQ(parse_number(one, false).value, digit);
          EXPECT_EQ(parse_number(one + "7", false).value, 10 * digit + 7);
        } else {
          EXPECT_EQ(parse_number(one + "1", false).form, NumberForm::Bad);
        }
      }
  // What stands beside the digits in ASCII.
  for (const char beside : {'/', ':', '@', 'G', '`', 'g', '_', '\xB1'})
    for (const char* prefix : {"0x", "0b", "1"})
      EXPECT_EQ(parse_number(prefix + std::string(1, beside), false).form, NumberForm::Bad) << beside;
}

TEST(FrontendNumbers, OnlyDecimalOnesAreLargerBehindAMinus) {
  for (const bool minus : {false, true}) {
    EXPECT_EQ(parse_number("0x80000000", minus).value, 0x8000'0000U);
    EXPECT_EQ(parse_number("0xFFFFFFFF", minus).value, 0xFFFF'FFFFU);
    EXPECT_EQ(parse_number("0x100000000", minus).form, NumberForm::TooLarge);
    EXPECT_EQ(parse_number("2147483649", minus).form, NumberForm::TooLarge);
    EXPECT_EQ(parse_number("99999999999999999999999x", minus).form, NumberForm::Bad);
    EXPECT_EQ(parse_number("0xFFFFFFFFFFFFFFFFFFFFFFFG", minus).form, NumberForm::Bad);
    EXPECT_EQ(parse_number("21474836480", minus).form, NumberForm::TooLarge);
    EXPECT_EQ(parse_number("42949672960", minus).form, NumberForm::TooLarge);
    EXPECT_EQ(parse_number("0x1000000000", minus).form, NumberForm::TooLarge);
  }
  EXPECT_EQ(parse_number("2147483648", true).value, 0x8000'0000U);
  EXPECT_FALSE(parse_number("2147483648", true).pattern);
  EXPECT_TRUE(parse_number("0x100000000", false).pattern);
  EXPECT_FALSE(parse_number("4294967296", false).pattern);
  EXPECT_FALSE(parse_number("1.5", false).pattern);
}

// All spellings of the table: what the program reads is what it was written for.
TEST(FrontendTokens, EverySpellingIsItsOwnKind) {
  using compiler::TokenKind;
  struct Spelling {
    TokenKind kind;
    std::string text;
    bool word;
  };
  const Spelling rows[] = {
#define PUNCTUATOR(kind, spelling) {TokenKind::kind, spelling, false},
#define KEYWORD(kind, spelling) {TokenKind::kind, spelling, true},
#include "compiler/preprocess/tokens.def"
  };
  for (const Spelling& row : rows) {
    EXPECT_EQ(compiler::punctuator_kind(row.text).has_value(), !row.word) << row.text;
    if (!row.word) {
      EXPECT_EQ(compiler::punctuator_kind(row.text), row.kind) << row.text;
    }
    EXPECT_EQ(compiler::keyword_kind(row.text), row.word ? row.kind : TokenKind::Name) << row.text;
    EXPECT_EQ(compiler::category(row.kind), row.word ? "keyword" : "operator") << row.text;
    EXPECT_EQ(FrontendRun("a " + row.text + " b").tokens(),
              "1:1 name a\n1:3 " + std::string(compiler::category(row.kind)) + " " + row.text +
                  "\n1:" + std::to_string(row.text.size() + 4) +
                  " name b\n1:" + std::to_string(row.text.size() + 5) + " end\n");
    // Nothing may stand in front of it: of a longer word only the last eight bytes fit into a number.
    const std::string longer = "x" + std::string(8 - row.text.size(), '\0') + row.text;
    EXPECT_EQ(compiler::punctuator_kind(longer), std::nullopt) << row.text;
    EXPECT_EQ(compiler::keyword_kind(longer), TokenKind::Name) << row.text;
  }
  EXPECT_EQ(compiler::punctuator_kind(""), std::nullopt);
  EXPECT_EQ(compiler::keyword_kind(""), TokenKind::Name);
  EXPECT_EQ(compiler::keyword_kind("Long"), TokenKind::Name);
}

TEST(FrontendTokens, ListingNamesEveryCategory) {
  EXPECT_EQ(
      FrontendRun("n 1 \"s\" 'c' \xE4 @ x # \n#declare A B\n#pragma list\n\"o\n").tokens(),
      "1:1 name n\n1:3 number 1\n1:5 string \"s\"\n1:9 character 'c'\n1:13 bad name \xE4\n1:15 stray @\n"
      "1:17 name x\n1:19 hash #\n2:1 directive declare\n2:10 name A\n2:12 name B\n2:13 directive end\n"
      "3:1 directive pragma\n3:9 name list\n3:13 directive end\n4:1 open quote \"o\n5:1 end\n");
  EXPECT_EQ(compiler::category(compiler::TokenKind::Newline), "newline");
  EXPECT_EQ(compiler::category(compiler::TokenKind::HeaderName), "header");
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

TEST(FrontendTokens, LongNamesOfTextLeftOutAreNotTold) {
  const std::string name33(33, 'n');
  FrontendRun run("#if 0\n" + name33 + "\n#else\nx\n#endif");
  EXPECT_EQ(run.words(), "x");
  EXPECT_EQ(run.messages(), Messages{});
}

TEST(FrontendTokens, LongNamesAreTheSameMacro) {
  const std::string name32(32, 'n');
  EXPECT_EQ(FrontendRun("#define " + name32 + "x 5\n" + name32 + "y").words(), "5");
}

}  // namespace
}  // namespace ipos::tests
