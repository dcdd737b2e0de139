// The assembler and the disassembler at their bounds: what a message says and where, the largest number of every
// operand and directive, and every form of a name, a listing and a line entry.
#include <gtest/gtest.h>

#include "compiler/asm/disassembler.hpp"
#include "tests/compiler/assembler_run.hpp"

namespace ipos::compiler::test {
namespace {

using Words = std::vector<uint32_t>;

const std::string kNumber = "-2147483648 to 2147483647, in hexadecimal or binary up to 0xFFFFFFFF";

// '`' begins and '$' ends the place of the message.
TEST(AssemblerBounds, MessagesWordForWord) {
  const std::string constant = "the number here must be " + kNumber;
  const std::pair<std::string, std::string> rows[] = {
      {"NOP\n  `FOO$ H1", "'FOO' is no command of the assembler"},
      {"`REMARK$ H1", "'REMARK' is no command of the assembler"},
      {"`!$ H1", "'!' is no command of the assembler"},
      {"`M1$ NOP", "'M1' is no command of the assembler"},
      {"M1 : M2 : `FOO$", "'FOO' is no command of the assembler"},
      {"ADD H0 `~$ 1", "ADD: expected `+` here"},
      {"add `5$ + 1", "add: expected a variable here"},
      {"ADD H0 + `x$", "ADD: expected a variable or a constant here"},
      {"ADD H0`\n$NOP", "ADD: expected `+` here"},
      {"NOP `1$", "NOP: expected the end of the line here"},
      {"ADD H0 + 1 `2$", "ADD: expected the end of the line here"},
      {"JMP H0 <= 15 , `N$01", "JMP: expected a label here"},
      {"SCOM `S$OMETHING , H1", "SCOM: expected TRANSMIT CYCLIC, TRANSMIT ACYCLIC, RECEIVE here"},
      {"SCOMST `O$N , H1", "SCOMST: expected STOP, START here"},
      {"BSET H1.`x$ = 1", "BSET: expected a bit number here"},
      {"COPY H1 = H2 , `x$", "COPY: expected a count here"},
      {"BMOVN H1.2 = `H$3.4", "BMOVN: expected `NOT` here"},
      {"WORD` $x", "WORD: expected a constant of 32 bits here"},
      {"WORD` $", "WORD: expected a constant of 32 bits here"},
      {"WORD` 4294967296$", "WORD: expected a constant of 32 bits here"},
      {"WORD` 1 $2", "WORD: expected a constant of 32 bits here"},
      {"SET `H$4096 = 1", "the number here must be 0 to 4095"},
      {"BMOV H1.`4$096 = H3.4", "the number here must be 0 to 4095"},
      {"BMOV H1.2 = `H$65536.4", "the number here must be 0 to 65535"},
      {"BMOV H1.2 = H3.`6$5536", "the number here must be 0 to 65535"},
      {"SET H0 = `4$294967296", constant},
      {"SET H0 = `2$147483648", constant},
      {"SET H0 = `-$2147483649", constant},
      {"SET H0 = `0$x100000000", constant},
      {"SET H0 = `1$00000000 hex", constant},
      {"NOP\nJMP `M5$", "label M05 stands at no command"},
      {".function f `M12$\nNOP", "label M12 stands at no command"},
      {"M1 : NOP\n`M01$ : END", "label M01 stands at two commands"},
      {"M7 : `m7$ : END", "label M07 stands at two commands"},
      {"`.label$ x", "unknown directive '.label'; known are .unit, .file, .symbol, .function and .line"},
      {"`.unit$", "this directive has the form '.unit TYPE, once'"},
      {".unit md60a\n`.unit$ mc07", "this directive has the form '.unit TYPE, once'"},
      {"`.unit$ md60a x", "this directive has the form '.unit TYPE, once'"},
      {".unit `256$", "unknown unit '256'; known are md60a, compact, mc07, mdxb, mc31, mc07b"},
      {".unit `7b$", "unknown unit '7b'; known are md60a, compact, mc07, mdxb, mc31, mc07b"},
      {"`.file$", "this directive has the form '.file NAME'"},
      {"`.file$ a b", "this directive has the form '.file NAME'"},
      {"`.file$ \"\\x4\"", "this directive has the form '.file NAME'"},
      {"`.file$ \"\\xG0\"", "this directive has the form '.file NAME'"},
      {"`.file$ \"\\x0G\"", "this directive has the form '.file NAME'"},
      {"`.file$ \"abc\\", "this directive has the form '.file NAME'"},
      {"`.symbol$ H65536 x", "this directive has the form '.symbol Hn NAME [COUNT]'"},
      {"`.symbol$ H1", "this directive has the form '.symbol Hn NAME [COUNT]'"},
      {"`.symbol$ H1 x 0", "this directive has the form '.symbol Hn NAME [COUNT]'"},
      {"`.symbol$ H1 x 65536", "this directive has the form '.symbol Hn NAME [COUNT]'"},
      {"`.symbol$ H1 x 5 6", "this directive has the form '.symbol Hn NAME [COUNT]'"},
      {"`.symbol$ H1 x y", "this directive has the form '.symbol Hn NAME [COUNT]'"},
      {"`.function$ f", "this directive has the form '.function NAME LABEL'"},
      {"`.function$ f M1 M2\nM1 : M2 : NOP", "this directive has the form '.function NAME LABEL'"},
      {"`.function$ f @4294967296\nNOP", "this directive has the form '.function NAME LABEL'"},
      {"`.function$ f @1\nNOP", "the number here must be the address of a code word"},
      {"NOP\n`.function$ f @4294967295", "the number here must be the address of a code word"},
      {"M1 : NOP\n.function f M1\n`.function$ g M2\nM2 :",
       "the number here must be the address of a code word"},
      {".file a\n`.line$ 0 1", "this directive has the form '.line [@ADDRESS] FILE LINE COLUMN'"},
      {".file a\n`.line$ 0 1 2 3", "this directive has the form '.line [@ADDRESS] FILE LINE COLUMN'"},
      {".file a\n`.line$ @ 0 1 2", "this directive has the form '.line [@ADDRESS] FILE LINE COLUMN'"},
      {".file a\n`.line$ 65536 1 2", "this directive has the form '.line [@ADDRESS] FILE LINE COLUMN'"},
      {".file a\n`.line$ 0 4294967296 2", "this directive has the form '.line [@ADDRESS] FILE LINE COLUMN'"},
      {".file a\n`.line$ 0 1 65536", "this directive has the form '.line [@ADDRESS] FILE LINE COLUMN'"},
      {".file a\n`.line$ @4294967296 0 1 2\nNOP",
       "this directive has the form '.line [@ADDRESS] FILE LINE COLUMN'"},
      {".file a\n`.line$ 1 1 2\nNOP", "the number here must be that of a .file directive, counted from 0"},
      {".file a\nNOP\n`.line$ 0 1 2",
       "the number here must be the address of a code word, not before that of the last .line"},
      {".file a\n.line @1 0 1 2\n`.line$ @0 0 1 2\nNOP\nNOP",
       "the number here must be the address of a code word, not before that of the last .line"},
  };
  for (const auto& [marked, text] : rows) {
    const size_t begin = marked.find('`');
    const size_t end = marked.find('$') - 1;
    std::string source = marked;
    source.erase(end + 1, 1).erase(begin, 1);
    const auto result = assemble_text(source);
    EXPECT_FALSE(result->image) << source;
    ASSERT_EQ(result->diagnostics.all().size(), 1U) << source;
    const Diagnostic& found = result->diagnostics.all()[0];
    const uint32_t base = result->sources.files()[0]->base;
    EXPECT_EQ(found.text, text) << source;
    EXPECT_EQ(found.span.begin.value - base, begin) << source;
    EXPECT_EQ(found.span.end.value - base, end) << source;
  }
}

// Coding of docs/reference/isa.md: the opcode in the low byte, two operands of 12 bits, more of 16 bits in a word of
// their own, then constants and labels of 32 bits.
TEST(AssemblerBounds, LargestNumbers) {
  EXPECT_EQ(code("SET H4095 = 1"), (Words{0xFFF21, 1}));
  EXPECT_EQ(code("SET H4095 = H4095"), (Words{0xFFFFFF20}));
  EXPECT_EQ(code("BMOV H4095.4095 = H65535.65535"), (Words{0xFFFFFF52, 0xFFFFFFFF}));
  EXPECT_EQ(code("BMOV H1.2 = H3.4"), (Words{0x00200152, 0x00040003}));
  const std::pair<const char*, uint32_t> constants[] = {{"2147483647", 0x7FFFFFFF},
                                                        {"-2147483648", 0x80000000},
                                                        {"0xFFFFFFFF", 0xFFFFFFFF},
                                                        {"0x80000000", 0x80000000},
                                                        {"-0x80000000", 0x80000000},
                                                        {"0X7fffffff", 0x7FFFFFFF},
                                                        {"FFFFFFFF hex", 0xFFFFFFFF},
                                                        {"ffffffff HEX", 0xFFFFFFFF},
                                                        {"10 hex", 16},
                                                        {"-10 hex", 0xFFFFFFF0},
                                                        {"0b11111111111111111111111111111111", 0xFFFFFFFF},
                                                        {"0B101", 5},
                                                        {"0b1 hex", 0xB1},
                                                        {"#5", 5},
                                                        {"# -5", 0xFFFFFFFB},
                                                        {"- 5", 0xFFFFFFFB},
                                                        {"007", 7},
                                                        {"0", 0},
                                                        {"-0", 0}};
  for (const auto& [text, value] : constants) {
    EXPECT_EQ(code("SET H0 = " + std::string(text)), (Words{0x21, value})) << text;
    EXPECT_EQ(code("WORD " + std::string(text)), Words{value}) << text;
  }
  for (const char* bad :
       {"0x", "0xG", "0b", "0b2", "5x", "F", "hex", "5 hexa", "0xFFFFFFFFFFFFFFFFFF", "--5", "5-"})
    EXPECT_FALSE(assemble_text("SET H0 = " + std::string(bad))->image) << bad;
}

TEST(AssemblerBounds, WordsStandWhole) {
  EXPECT_EQ(code("rem a ; b"), Words{});
  EXPECT_EQ(code("REM"), Words{});
  EXPECT_EQ(code("WORD 5;6"), Words{5});
  EXPECT_EQ(code("M1:M2: M03 :NOP\nJMP M2\nJMP m1\nJMP M003"), code("M1 : NOP\nJMP M1\nJMP M1\nJMP M1"));
  EXPECT_EQ(code("JMP @0"), code("M1 : JMP M1"));
  EXPECT_EQ(code("NOP\nJMP @1"), code("NOP\nM1 : JMP M1"));
  EXPECT_EQ(code("SCOM  transmit \t cyclic,H1"), code("SCOM TRANSMIT CYCLIC , H1"));
  EXPECT_EQ(code("SCOM 1 , H1"), code("SCOM TRANSMIT CYCLIC , H1"));
  EXPECT_EQ(code("SCOM 4095 , H1"), (Words{0x001FFF61}));
  EXPECT_FALSE(assemble_text("SCOM TRANSMITCYCLIC , H1")->image);
  EXPECT_FALSE(assemble_text("SCOM RECEIVED , H1")->image);
  EXPECT_FALSE(assemble_text("NOP5")->image);
  EXPECT_FALSE(assemble_text("SET TargetPosX = 1")->image);
  EXPECT_FALSE(assemble_text("M1 NOP")->image);
  EXPECT_FALSE(assemble_text("M : NOP")->image);
  EXPECT_FALSE(assemble_text("SET H5a = 1")->image);
}

TEST(AssemblerBounds, NamesAndTheirEscapes) {
  const auto names = [](const std::string& text) {
    const auto result = assemble_text(".file " + text + "\nNOP");
    EXPECT_TRUE(result->image) << text;
    return result->image ? result->image->files : std::vector<std::string>{};
  };
  const std::pair<const char*, std::string> rows[] = {
      {"aZ09_.[]@", "aZ09_.[]@"}, {"\"a b\"", "a b"},      {"\"a;b\" ; c", "a;b"},
      {"\"a\\\"b\"", "a\"b"},     {"\"a\\\\\"", "a\\"},    {"\"\\x41\\x7aB\"", "AzB"},
      {"\"\\xfF\"", "\xFF"},      {"\"\"", ""},
      {"\"\\q\"", "q"},           {"\"\\\\\" ; \"", "\\"}, {"\"\\\";\"", "\";"}};
  for (const auto& [text, name] : rows) EXPECT_EQ(names(text), std::vector<std::string>{name}) << text;
  // What would act where a name is shown is refused.
  for (const char* text : {"\"\\x0A\"", "\"a\\x1Bb\"", "\"\\x7F\"", "\"\\x9b\"", "\"\\xC2\\x9B\"", "\"a\tb\""})
    EXPECT_FALSE(assemble_text(std::string(".file ") + text + "\nNOP")->image) << text;
  // And written back: bare where nothing else is in them, bytes beyond ASCII by their numbers.
  vm::Image image;
  image.unit = 1;
  image.code = {2};
  for (const auto& [name, written] : {std::pair<std::string, std::string>{"aZ09_.[]@", "aZ09_.[]@"},
                                      {"", "\"\""},
                                      {"a b", "\"a b\""},
                                      {"a\"\\", "\"a\\\"\\\\\""},
                                      {"\x1F\x7F~\xC4", "\"\\x1F\\x7F~\\xC4\""},
                                      {"a/b", "\"a/b\""},
                                      {"`{", "\"`{\""}}) {
    image.files = {name};
    EXPECT_EQ(disassemble(image), ".unit md60a\n.file " + written + "\n      END\n");
  }
}

TEST(AssemblerBounds, DirectivesAtTheirLargest) {
  const auto result = assemble_text(
      ".unit 255\n.symbol H65535 a 65535\n.symbol H0 b 1\n.symbol TargetPos c\n.file x\n.file y\n.function f "
      "@0\n.function g M1\n"
      ".line 0 4294967295 65535\nNOP\n.line 1 7 8\n.line 1 8 8\nM1 : NOP\n");
  ASSERT_TRUE(result->image) << render_text(result->diagnostics.all(), result->sources, false);
  EXPECT_EQ(result->image->unit, 255);
  EXPECT_EQ(result->image->symbols,
            (std::vector<vm::Symbol>{{"a", 65535, 65535}, {"b", 0, 1}, {"c", 492, 1}}));
  EXPECT_EQ(result->image->functions, (std::vector<vm::FunctionEntry>{{"f", 0}, {"g", 1}}));
  EXPECT_EQ(result->image->lines,
            (std::vector<vm::LineEntry>{{0, 0, 4294967295, 65535}, {1, 1, 7, 8}, {1, 1, 8, 8}}));
  EXPECT_EQ(assemble_text("NOP")->image->unit, 1) << "MD_60A unless it is said";
  for (const auto& [name, number] : {std::pair<const char*, int>{"md60a", 1},
                                     {"compact", 2},
                                     {"mc07", 3},
                                     {"mdxb", 4},
                                     {"mc31", 5},
                                     {"0", 0}})
    EXPECT_EQ(assemble_text(".unit " + std::string(name))->image->unit, number);
}

TEST(DisassemblerBounds, LinesThatBelongToNoCommand) {
  vm::Image image;
  image.unit = 77;
  image.code = {0x21, 5, 2};  // SET H0 = 5, END
  image.files = {"a"};
  image.lines = {{0, 0, 1, 1}, {1, 0, 2, 2}, {2, 0, 3, 3}, {9, 0, 4, 4}};
  EXPECT_EQ(disassemble(image),
            ".unit 77\n.file a\n.line 0 1 1\n.line @1 0 2 2\n      SET H0 = 5\n.line 0 3 3\n      END\n.line "
            "@9 0 4 4\n");
  image.lines = {{2, 0, 3, 3}, {0, 0, 1, 1}};
  EXPECT_EQ(disassemble(image),
            ".unit 77\n.file a\n.line @2 0 3 3\n.line @0 0 1 1\n      SET H0 = 5\n      END\n");
  image.lines.clear();
  image.functions = {{"main", 0}, {"middle", 1}, {"behind", 3}, {"beyond", 4}};
  EXPECT_EQ(disassemble(image),
            ".unit 77\n.file a\n.function main M01\n.function middle @1\n.function behind M02\n.function "
            "beyond @4\n"
            "M01 : SET H0 = 5\n      END\nM02 :\n");
}

TEST(DisassemblerBounds, ListingTellsEachLineOnce) {
  vm::Image image;
  image.unit = 1;
  image.code = {2, 2, 0x21, 5, 2, 2, 0xFF};
  image.files = {"a", "b"};
  image.functions = {{"f", 0}, {"g", 0}, {"h", 2}};
  image.lines = {{0, 0, 1, 1}, {1, 0, 1, 9}, {3, 0, 2, 1}, {4, 1, 2, 1}, {5, 7, 2, 1}};
  const auto lines = [](size_t file, uint32_t line) -> std::optional<std::string_view> {
    if (file == 0) return line == 1 ? "one" : "two";
    return std::nullopt;
  };
  const std::string words = std::string(28, ' ');
  EXPECT_EQ(listing(image, lines), "\nf:\n\ng:\n; a:1: one\n    0  00000002 " + words +
                                       " M01 : END\n    1  00000002 " + words +
                                       "       END\n"
                                       "\nh:\n; a:2: two\n    2  00000021 00000005 " +
                                       std::string(19, ' ') +
                                       " M02 : SET H0 = 5\n"
                                       "; b:2: \n    4  00000002 " +
                                       words + "       END\n; ?:2: \n    5  00000002 " + words +
                                       "       END\n"
                                       "    6  000000FF " +
                                       words + "       WORD 0x000000FF\n");
  EXPECT_NE(listing(image, {}).find("; a:1: \n"), std::string::npos) << "without the source";
}

TEST(DisassemblerBounds, EveryKindOfOperand) {
  using vm::Opcode;
  EXPECT_EQ(command_text({Opcode::Scom, {2, 7}}, ""), "SCOM TRANSMIT ACYCLIC, H7");
  EXPECT_EQ(command_text({Opcode::Scom, {9, 7}}, ""), "SCOM 9, H7") << "a keyword nobody knows";
  EXPECT_EQ(command_text({Opcode::JmpLeHK, {3, -5, 0}}, "M07"), "JMP H3 <= -5 , M07");
  EXPECT_EQ(command_text({Opcode::BitMoveNeg, {1, 2, 492, 4}}, "", VariableNames::Compiler),
            "BMOVN H1.2 = NOT TargetPos.4");
  EXPECT_EQ(command_text({Opcode::SetHK, {492 + 65536, 1}}, "", VariableNames::Compiler), "SET H66028 = 1");
  EXPECT_EQ(command_text({Opcode::SetHK, {400, 1}}, "", VariableNames::Assembler), "SET H400 = 1");
  EXPECT_EQ(command_text({Opcode::ScomOn, {}}, ""), "SCOMON");
}

}  // namespace
}  // namespace ipos::compiler::test
