// Assembler and disassembler: hand-written forms, exact round trips of any image, messages for malformed
// text.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

#include "compiler/asm/disassembler.hpp"
#include "compiler/diag/places.hpp"
#include "stdlib/system_variables.hpp"
#include "stdlib/unit_types.hpp"
#include "tests/compiler/assembler_run.hpp"

namespace ipos::compiler::test {
namespace {

std::vector<uint32_t> encoded(std::vector<vm::Instruction> commands) {
  std::vector<uint32_t> out;
  for (const vm::Instruction& command : commands) {
    std::array<uint32_t, vm::kMaxWords> words{};
    const uint32_t count = vm::encode(command, words);
    out.insert(out.end(), words.begin(), words.begin() + count);
  }
  return out;
}

using vm::Opcode;

TEST(Assembler, FormsOfTheManual) {
  // IPOSplus p. 305, 306, 342 and 316: leading zeros, labels, the suffix hex, keywords.
  EXPECT_EQ(encoded({{Opcode::SetHK, {1, 50}}}), code("SET H01 = 50"));
  EXPECT_EQ(encoded({{Opcode::ShlHH, {1, 2}}}), code("SHL H01 << H02"));
  EXPECT_EQ(encoded({{Opcode::XorHK, {1, 0xF0F0}}}), code("XOR H01 XOR F0F0 hex"));
  EXPECT_EQ(encoded({{Opcode::SetiStore, {8, 2}}}), code("SETI [H008] = H2"));
  EXPECT_EQ(encoded({{Opcode::AddHK, {0, 1}}, {Opcode::JmpLeHK, {0, 15, 0}}}),
            code("M01 : ADD H0 + 1\n      JMP H0 <= 15 , M01"));
  EXPECT_EQ(encoded({{Opcode::Scom, {1, 420}}}), code("SCOM TRANSMIT CYCLIC, H420"));
  // p. 34: '#' in front of a constant.
  EXPECT_EQ(encoded({{Opcode::GoRelK, {0, -8000}}}), code("GOR NOWAIT #-8000"));
  EXPECT_EQ(encoded({{Opcode::SetHK, {1, 50}}}), code("SET H01 = #50"));
}

TEST(Assembler, FreeWriting) {
  EXPECT_EQ(encoded({{Opcode::AddHK, {0, 1}}}), code("add h0+1"));
  EXPECT_EQ(encoded({{Opcode::AddHK, {0, -1}}}), code("ADD H0 + 0xFFFFFFFF ; comment"));
  EXPECT_EQ(encoded({{Opcode::AddHK, {0, 5}}}), code("ADD H0 + 0b101"));
  EXPECT_EQ(encoded({{Opcode::SetHK, {0, INT32_MIN}}}), code("SET H0 = -2147483648"));
  EXPECT_EQ(encoded({{Opcode::SetHK, {0, 0xB1}}}), code("SET H0 = 0B1 hex"));
  EXPECT_EQ(encoded({{Opcode::TouchProbe, {2}}}), code("TOUCHP ENABLE   1 rising"));
  EXPECT_EQ(encoded({{Opcode::TouchProbe, {1}}}), code("TOUCHP ENABLE 1"));
  EXPECT_EQ(encoded({{Opcode::Go0, {5}}}), code("GO0 C,NW,ZP"));
  EXPECT_EQ(encoded({{Opcode::BitMoveNeg, {1, 2, 3, 4}}}), code("BMOVN H1.2 = NOT H3.4"));
  EXPECT_EQ(encoded({{Opcode::Nop, {}}}), code("REM this is not a command\r\n\r\nNOP\r\n; nothing"));
  EXPECT_EQ(encoded({{Opcode::Jmp, {2}}, {Opcode::End, {}}}), code("JMP M7\nm007 : M8: END"));
}

TEST(Assembler, SystemVariablesByBothNames) {
  const auto expected = encoded({{Opcode::SetHH, {492, 453}}});
  EXPECT_EQ(expected, code("SET TargetPos = ModuloCtrl"));
  EXPECT_EQ(expected, code("SET TARGET POS = MODULOCTRL"));
  for (const stdlib::SystemVariable& row : stdlib::system_variables()) {
    const auto bit = encoded({{Opcode::BitSet, {row.number, 3}}});
    EXPECT_EQ(bit, code("BSET " + std::string(row.compiler_name) + ".3 = 1"));
    EXPECT_EQ(bit, code("BSET " + std::string(row.assembler_name) + ".3 = 1"));
  }
}

TEST(Assembler, Directives) {
  const auto result = assemble_text(
      ".unit mdxb\n.file \"a b.IPC\"\n.symbol H420 Tr.ObjectNo\n.symbol H430 buf 10\n.function main M01\n"
      ".line 0 3 5\nM01 : END\nWORD 0xFF\n.line @1 0 4 1\n");
  ASSERT_TRUE(result->image);
  EXPECT_EQ(4, result->image->unit);
  EXPECT_EQ((std::vector<std::string>{"a b.IPC"}), result->image->files);
  EXPECT_EQ((std::vector<vm::Symbol>{{"Tr.ObjectNo", 420, 1}, {"buf", 430, 10}}), result->image->symbols);
  EXPECT_EQ((std::vector<vm::FunctionEntry>{{"main", 0}}), result->image->functions);
  EXPECT_EQ((std::vector<vm::LineEntry>{{0, 0, 3, 5}, {1, 0, 4, 1}}), result->image->lines);
  EXPECT_EQ((std::vector<uint32_t>{0x02, 0xFF}), result->image->code);
}

struct Mistake {
  const char* text;
  const char* code;
  uint32_t line;
  uint32_t column;
};
class AssemblerMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(AssemblerMistakes, AreLocated) {
  const auto result = assemble_text(GetParam().text);
  EXPECT_FALSE(result->image);
  ASSERT_EQ(1U, result->diagnostics.all().size()) << GetParam().text;
  const Diagnostic& found = result->diagnostics.all()[0];
  EXPECT_EQ(GetParam().code, info(found.diag).code);
  const Position at = result->sources.position(found.span.begin);
  EXPECT_EQ(GetParam().line, at.line) << GetParam().text;
  EXPECT_EQ(GetParam().column, at.column) << GetParam().text;
}

const Mistake kMistakes[] = {
    {"NOP\n  FOO H1", "E0301", 2, 3},
    {"!", "E0301", 1, 1},
    {"ADD H0 ~ 1", "E0302", 1, 8},
    {"ADD 5 + 1", "E0302", 1, 5},
    {"ADD H0 + x", "E0302", 1, 10},
    {"ADD H0", "E0302", 1, 7},
    {"NOP 1", "E0302", 1, 5},
    {"JMP H0 <= 15 , N01", "E0302", 1, 16},
    {"SCOM SOMETHING , H1", "E0302", 1, 6},
    {"WORD", "E0302", 1, 5},
    {"SETI [H0 = H1", "E0302", 1, 10},
    {"SET H5000 = 1", "E0303", 1, 5},
    {".file a.IPC\n.line 2 7 17\nEND", "E0303", 2, 1},
    {".file a.IPC\n.line @5 0 7 17\nEND", "E0303", 2, 1},
    {".function main @7\nEND", "E0303", 1, 1},
    {"SET H0 = 4294967296", "E0303", 1, 10},
    {"SET H0 = 2147483648", "E0303", 1, 10},
    {"JMP M5", "E0304", 1, 5},
    {".function f M5", "E0304", 1, 13},
    {"M1 : NOP\nM01 : END", "E0305", 2, 1},
    {".label x", "E0306", 1, 1},
    {".symbol 420 x", "E0307", 1, 1},
    {".symbol H70000 x", "E0307", 1, 1},
    {".line 1 2", "E0307", 1, 1},
    {".file \"abc", "E0307", 1, 1},
    {".file \"\\x4", "E0307", 1, 1},
    {".function f", "E0307", 1, 1},
    {".unit md60a\n.unit md60a", "E0307", 2, 1},
    {".unit md61x", "E0308", 1, 7},
};
INSTANTIATE_TEST_SUITE_P(All, AssemblerMistakes, testing::ValuesIn(kMistakes));

TEST(Assembler, SaysWhatItExpects) {
  const auto said = [](const char* text) { return assemble_text(text)->diagnostics.all().at(0).text; };
  EXPECT_EQ("MOD: expected `MOD` here", said("MOD H0 % 2"));
  EXPECT_EQ("the number here must be -2147483648 to 2147483647, in hexadecimal or binary up to 0xFFFFFFFF",
            said("SET H1 = 4294967295"));
}

TEST(Assembler, FindsEveryMistakeInOneRun) {
  EXPECT_EQ(3U, assemble_text("FOO\nNOP\nBAR\nJMP M9\n")->diagnostics.all().size());
}

void expect_same(const vm::Image& image) {
  for (const VariableNames names :
       {VariableNames::Numbers, VariableNames::Assembler, VariableNames::Compiler}) {
    const std::string text = disassemble(image, names);
    const auto result = assemble_text(text);
    RC_ASSERT(result->diagnostics.all().empty());
    RC_ASSERT(result->image.has_value());
    RC_ASSERT(*result->image == image);
  }
}

TEST(RoundTrip, EveryCommandWithAnyOperands) {
  EXPECT_TRUE(rc::check("valid commands", [] {
    vm::Image image;
    image.unit = 1;
    const auto table = vm::opcode_table();
    const auto count = *rc::gen::inRange(0, 30);
    std::vector<uint32_t> starts;
    std::vector<vm::Instruction> commands;
    uint32_t size = 0;
    for (int n = 0; n < count; ++n) {
      const vm::OpcodeInfo& row = table[*rc::gen::inRange<size_t>(0, table.size())];
      starts.push_back(size);
      size += static_cast<uint32_t>(row.words);
      vm::Instruction command{row.opcode, {}};
      int small = 0;
      for (size_t k = 0; k < static_cast<size_t>(row.operand_count); ++k) {
        const bool wide = row.operands[k].kind == vm::OperandKind::Constant;
        const bool label = row.operands[k].kind == vm::OperandKind::Label;
        if (!wide && !label) ++small;
        command.operands[k] = wide    ? *rc::gen::arbitrary<int32_t>()
                              : label ? *rc::gen::inRange(0, 100)
                                      : *rc::gen::inRange(0, small < 3 ? 0x1000 : 0x10000);
      }
      commands.push_back(command);
    }
    image.code = encoded(commands);
    if (!starts.empty()) image.functions.push_back({"main", starts.back()});
    expect_same(image);
  }));
}

TEST(RoundTrip, AnyWordsAndTables) {
  EXPECT_TRUE(rc::check("any image", [] {
    vm::Image image;
    image.unit = *rc::gen::arbitrary<uint8_t>();
    image.code = *rc::gen::arbitrary<std::vector<uint32_t>>();
    // Opcodes are dense in the low byte only: make commands likely.
    for (uint32_t& word : image.code)
      if (word % 3 != 0) word &= 0x0FFF00FFU;
    // Tables as the image's reader accepts them.
    const auto name = rc::gen::map(rc::gen::arbitrary<std::string>(), [](const std::string& text) {
      std::string plain = printable(text);
      std::replace(plain.begin(), plain.end(), '\t', ' ');
      return plain;
    });
    const stdlib::UnitType* unit = stdlib::find_unit(image.unit);
    const uint32_t variables = unit == nullptr || unit->tasks == 0 ? 0x20000 : unit->variables;
    const auto words = static_cast<uint32_t>(image.code.size());
    for (int n = words == 0 ? 0 : *rc::gen::inRange(0, 4); n > 0; --n) {
      const auto first = *rc::gen::inRange<uint32_t>(0, std::min(variables, 0x10000U));
      const auto count = *rc::gen::inRange<uint32_t>(1, std::min(variables - first + 1, 0x10000U));
      image.symbols.push_back({*name, static_cast<uint16_t>(first), static_cast<uint16_t>(count)});
      image.functions.push_back({*name, *rc::gen::inRange<uint32_t>(0, words)});
      image.files.push_back(*name);
      const uint32_t after = image.lines.empty() ? 0 : image.lines.back().address;
      const auto files = static_cast<uint16_t>(image.files.size());
      image.lines.push_back({*rc::gen::inRange<uint32_t>(after, words), *rc::gen::inRange<uint16_t>(0, files),
                             *rc::gen::arbitrary<uint32_t>(), *rc::gen::arbitrary<uint16_t>()});
    }
    expect_same(image);
  }));
}

TEST(Assembler, AnyBytesGiveAnImageOrMessages) {
  EXPECT_TRUE(rc::check("no crash", [] {
    const char alphabet[] = "ADMNHSETIJPWO0159xXbh[]{}:.,;=<>!+-*/&|~\"\\ @\t\r\n\xC4\x00";
    std::string text;
    const auto bytes = *rc::gen::container<std::vector<uint8_t>>(rc::gen::arbitrary<uint8_t>());
    for (const uint8_t byte : bytes) text += alphabet[byte % (sizeof(alphabet) - 1)];
    const auto result = assemble_text(text);
    RC_ASSERT(result->image.has_value() == !result->diagnostics.has_errors());
  }));
}

TEST(Disassembler, NamesSystemVariables) {
  const vm::Instruction command{Opcode::SetHH, {492, 5}};
  EXPECT_EQ("SET H492 = H5", command_text(command, ""));
  EXPECT_EQ("SET TARGET POS = H5", command_text(command, "", VariableNames::Assembler));
  EXPECT_EQ("SET TargetPos = H5", command_text(command, "", VariableNames::Compiler));
}

TEST(Disassembler, LabelsRiseWithTheAddress) {
  // A jump back and one forward; the command in between is no target.
  const std::vector<uint32_t> words =
      encoded({{Opcode::Nop, {}}, {Opcode::Jmp, {5}}, {Opcode::Jmp, {1}}, {Opcode::End, {}}});
  vm::Image image;
  image.unit = 1;
  image.code = words;
  EXPECT_EQ(".unit md60a\n      NOP\nM01 : JMP M02\n      JMP M01\nM02 : END\n", disassemble(image));
}

TEST(Disassembler, ListingShowsSourceAddressesAndWords) {
  vm::Image image;
  image.unit = 1;
  image.code = encoded({{Opcode::SetHK, {420, 5}}, {Opcode::End, {}}});
  image.functions = {{"main", 0}};
  image.files = {"a.IPC"};
  image.lines = {{0, 0, 3, 1}, {2, 0, 4, 1}};
  const auto lines = [](size_t, uint32_t line) -> std::optional<std::string_view> {
    return line == 3 ? "a = 5;" : "}";
  };
  // Opcode 0x21, variable 420 = 0x1A4 in bits 8..19.
  EXPECT_EQ(
      "\nmain:\n; a.IPC:3: a = 5;\n    0  0001A421 00000005                     M01 : SET H420 = 5\n"
      "; a.IPC:4: }\n    2  00000002                                    END\n",
      listing(image, lines));
}

}  // namespace
}  // namespace ipos::compiler::test
