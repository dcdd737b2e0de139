// The blocks of variables that commands work on: the table agrees with the standard structures, the compiler
// checks types and lengths by it, and nothing it lets through is refused by the verifier.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <sstream>

#include "stdlib/language_tables.hpp"
#include "tests/compiler/backend_test.hpp"
#include "vm/isa/blocks.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::compiler::test {
namespace {

std::vector<std::string> words_of(std::string_view text) {
  std::istringstream in{std::string(text)};
  std::vector<std::string> out;
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}

const vm::OpcodeInfo& command_of(const stdlib::SystemFunction& function) {
  for (const vm::OpcodeInfo& row : vm::opcode_table())
    if (row.mnemonic() == function.mnemonic) return row;
  ADD_FAILURE() << function.name;
  return vm::opcode_table().front();
}

TEST(Blocks, AgreeWithTheStandardStructures) {
  for (const vm::BlockInfo& row : vm::block_table()) {
    if (row.type.empty() || row.type == "long") continue;
    const stdlib::Structure* structure = stdlib::find_structure(row.type);
    ASSERT_NE(structure, nullptr) << row.type;
    EXPECT_EQ(row.variables, structure->members.size()) << row.type;
  }
}

TEST(Blocks, EveryVariableOfASystemFunctionHasARow) {
  for (const stdlib::SystemFunction& function : stdlib::system_functions()) {
    const auto kinds = words_of(function.arguments);
    for (size_t n = 0; n < kinds.size(); ++n) {
      if (kinds[n] != "variable" && kinds[n] != "structure") continue;
      const vm::OpcodeInfo& command = command_of(function);
      for (int32_t keyword = 0; keyword < 32; ++keyword) {
        if (vm::coding(command.opcode).keywords != 0 && !vm::coding(command.opcode).has_keyword(keyword))
          continue;
        EXPECT_FALSE(vm::blocks_of(command.opcode, n, keyword).empty()) << function.name << " " << keyword;
      }
    }
  }
}

// Every call of a system function with the variable at `number`.
std::vector<std::string> calls_at(const std::string& name) {
  std::vector<std::string> calls;
  for (const stdlib::SystemFunction& function : stdlib::system_functions()) {
    std::vector<std::string> begun{""};
    const auto kinds = words_of(function.arguments);
    for (size_t n = 0; n < kinds.size(); ++n) {
      std::vector<std::string> choices;
      if (kinds[n] == "keyword") {
        for (const vm::KeywordInfo& word : vm::keyword_table())
          if (word.set == command_of(function).operands[n].keyword_set)
            choices.push_back(std::to_string(word.value));
      } else if (kinds[n] == "variable" || kinds[n] == "structure") {
        choices = {name};
      } else if (kinds[n] == "value") {
        choices = {name, "7", name + " + " + name};
      } else {
        choices = {kinds[n] == "function" ? "f" : "3"};
      }
      std::vector<std::string> more;
      for (const std::string& head : begun)
        for (const std::string& choice : choices) more.push_back(head + (n == 0 ? "" : ", ") + choice);
      begun = more;
    }
    for (const std::string& arguments : begun)
      calls.push_back(fmt::format("{}({})", function.name, arguments));
  }
  return calls;
}

TEST(Blocks, AtTheEndOfMemoryAreFineOrALocatedError) {
  int made = 0;
  int refused = 0;
  for (const char* name : {"md60a", "mc07", "mdxb"}) {
    const stdlib::UnitType& unit = *stdlib::find_unit(std::string_view(name));
    const vm::Limits limits{unit.variables, unit.program_words, unit.tasks, unit.call_depth};
    for (int back = 1; back <= 17; ++back) {
      for (const std::string& call : calls_at(fmt::format("H{}", unit.variables - back))) {
        const Compilation c = compile_text("f() { } main() { " + call + "; f(); }", name);
        if (c.image) {
          ++made;
          std::array<vm::Violation, 1> violation{};
          EXPECT_EQ(vm::verify(c.image->code, limits, violation).violations, 0U)
              << name << ": " << call << ": " << vm::info(violation[0].rule).meaning;
          continue;
        }
        ++refused;
        ASSERT_EQ(c.diagnostics.all().size(), 1U) << call;
        const Diagnostic& message = c.diagnostics.all()[0];
        EXPECT_TRUE(message.diag == Diag::InvalidVariable || message.diag == Diag::ArgumentRange ||
                    message.diag == Diag::MissingTask)
            << call << ": " << message.text;
        EXPECT_TRUE(message.span.begin.valid()) << call;
      }
    }
  }
  EXPECT_GT(made, 4000);
  EXPECT_GT(refused, 200);
}

// The same for named variables that a pragma puts there.
TEST(Blocks, ThatAPragmaPutsAtTheEnd) {
  EXPECT_EQ(commands(compile_text("#pragma globals 1020 1023\nlong v[3], a; main() { _GetSys(v, 5); a = 1; }",
                                  "mdxb"))
                .front(),
            "M01 : GETSYS H1020 = PO-DATA");
  const Compilation c = compile_text("#pragma globals 1023 1023\nlong a; main() { _GetSys(a, 5); }", "mdxb");
  EXPECT_FALSE(c.image);
  EXPECT_NE(commands(c).front().find("H1025 does not exist"), std::string::npos) << commands(c).front();
}

// Warnings about the type for a call, and what they say is expected.
std::string expected_type(const std::string& declaration, const std::string& call) {
  const Compilation c = compile_text("f() { }\n" + declaration + " main() { " + call + "; }", "mdxb");
  std::string out;
  for (const Diagnostic& message : c.diagnostics.all())
    if (message.diag == Diag::StructureType) out += message.text.substr(message.text.find("type ") + 5);
  return out.substr(0, out.find(','));
}

TEST(Blocks, TypesFollowTheKeyword) {
  std::string all;
  for (const stdlib::Structure& s : stdlib::structures())
    all += std::string(s.name) + " v" + std::string(s.name) + "; ";
  all += "long one, two[2], many[16]; typedef struct { long a; long b; long c; } Own; Own own;";
  all = "#pragma globals 130 299\n" + all;
  int right = 0;
  for (const vm::BlockInfo& row : vm::block_table()) {
    if (row.type.empty()) continue;
    for (const stdlib::SystemFunction& function : stdlib::system_functions()) {
      if (command_of(function).opcode != row.opcode) continue;
      const auto call = [&](const std::string& variable) {
        std::string out;
        for (const std::string& kind : words_of(function.arguments)) {
          const int32_t word = row.keyword == vm::kAnyKeyword ? 0 : row.keyword;
          out += (out.empty() ? "" : ", ") + (kind == "keyword"    ? std::to_string(word)
                                              : kind == "function" ? "f"
                                                                   : variable);
        }
        return fmt::format("{}({})", function.name, out);
      };
      const auto rows = vm::blocks_of(row.opcode, row.operand, row.keyword);
      for (const stdlib::Structure& s : stdlib::structures()) {
        bool fits = false;
        for (const vm::BlockInfo& other : rows) fits = fits || other.type == s.name;
        right += fits;
        EXPECT_EQ(expected_type(all, call("v" + std::string(s.name))).empty(), fits)
            << call("v" + std::string(s.name));
      }
      const bool words = row.opcode == vm::Opcode::GetSys || row.opcode == vm::Opcode::SetSys;
      const bool single = row.variables == 1;
      EXPECT_EQ(expected_type(all, call("one")).empty(), single) << call("one");
      EXPECT_EQ(expected_type(all, call("two[1]")).empty(), single) << call("two[1]");
      EXPECT_EQ(expected_type(all, call("two")).empty(), words && row.variables == 2) << call("two");
      EXPECT_EQ(expected_type(all, call("many")).empty(), words && !single) << call("many");
      EXPECT_EQ(expected_type(all, call("own")).empty(), words && !single && row.variables <= 3)
          << call("own");
      EXPECT_EQ(expected_type(all, call("H200")), "") << "a number has no type";
    }
  }
  EXPECT_EQ(right, 15) << "each of the two for cams counts for both of their rows";
  EXPECT_EQ(expected_type(all, "_GetSys(one, 7)"), "long[2]");
  EXPECT_EQ(expected_type(all, "_GetSys(one, 8)"), "GSCAM or GSCAM_EXT");
}

TEST(Blocks, TheMapNamesWhoReadsAndWritesThem) {
  const Compilation c = compile_text(
      "SSPOSRAMP r; GSPODATA3 po; long a, b; main() { r.Up = 1; in(); out(); }\n"
      "in() { _GetSys(po, 5); _BitSet(a, 1); } out() { _SetSys(9, r); _BitMove(b, 0, a, 0); }",
      "mdxb");
  ASSERT_EQ(c.map.size(), 4U);
  using Names = std::vector<std::string>;
  EXPECT_EQ(c.map[0].writers, Names{"main"});
  EXPECT_EQ(c.map[0].readers, Names{"out"});
  EXPECT_EQ(c.map[1].writers, Names{"in"});
  EXPECT_EQ(c.map[1].readers, Names{});
  EXPECT_EQ(c.map[2].writers, Names{"in"});
  EXPECT_EQ(c.map[2].readers, (Names{"in", "out"}));
  EXPECT_EQ(c.map[3].writers, Names{"out"});
}

TEST(Blocks, SystemFunctionsThatWriteWhatIsOnlyRead) {
  for (const char* call : {"_GetSys(H473, 1)", "_BitSet(H473, 1)", "_Copy(H473, H10, 1)", "_Reset(H473)"}) {
    const Compilation c = compile_text(std::string("main() { ") + call + "; }", "mdxb");
    ASSERT_EQ(c.diagnostics.all().size(), 1U) << call;
    EXPECT_EQ(c.diagnostics.all()[0].diag, Diag::ReadOnlyVariable) << call;
  }
}

}  // namespace
}  // namespace ipos::compiler::test
