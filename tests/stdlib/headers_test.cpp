// The language's headers agree with the tables they repeat: keywords.def and system_variables.def, both ways,
// and the embedded copies are the files to the byte.
#include "stdlib/headers.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "stdlib/header_names.hpp"
#include "stdlib/language_tables.hpp"
#include "stdlib/system_variables.hpp"
#include "vm/isa/blocks.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::stdlib {
namespace {

std::string_view embedded(std::string_view name) {
  for (const EmbeddedFile& file : headers::embedded_files())
    if (file.name == name) return file.text;
  return {};
}

// Name and replacement text of each #define with a text, comments cut off.
std::map<std::string, std::string> defines(std::string_view header) {
  std::map<std::string, std::string> all;
  std::istringstream in{std::string(embedded(header))};
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line.substr(0, line.find("//")));
    std::string directive, name, text, word;
    words >> directive >> name;
    if (directive != "#define") continue;
    while (words >> word) text += text.empty() ? word : " " + word;
    if (text.empty()) continue;  // guard
    EXPECT_TRUE(all.emplace(name, text).second) << header << " defines " << name << " twice";
  }
  return all;
}

bool is_variable(const std::string& text) {
  return text.size() > 1 && text[0] == 'H' && std::isdigit(text[1]);
}

TEST(Headers, EmbeddedCopiesAreTheFiles) {
  ASSERT_EQ(headers::embedded_files().size(), 4U);
  for (const EmbeddedFile& file : headers::embedded_files()) {
    std::ifstream in(std::string(IPOS_STDLIB_INCLUDE) + "/" + std::string(file.name), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    EXPECT_FALSE(text.empty()) << file.name;
    EXPECT_EQ(file.text, text) << file.name;
  }
}

TEST(Headers, EmbeddedBlocksAreTheFiles) {
  size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(IPOS_STDLIB_BLOCKS)) {
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const EmbeddedFile* built_in = find_built_in_file("blocks/" + entry.path().filename().string());
    ASSERT_NE(built_in, nullptr) << entry.path();
    EXPECT_EQ(built_in->text, text) << entry.path();
    ++files;
  }
  EXPECT_EQ(files, blocks::embedded_files().size());
  EXPECT_EQ(built_in_files().size(), files + headers::embedded_files().size());
  EXPECT_EQ(find_built_in_file("Const.H")->name, "const.h");
  EXPECT_EQ(find_built_in_file("ramp.h"), nullptr);
}

TEST(Headers, EachHasAGuard) {
  for (const EmbeddedFile& file : headers::embedded_files()) {
    const size_t guard = file.text.find("#ifndef ");
    ASSERT_NE(guard, std::string_view::npos) << file.name;
    const std::string_view name = file.text.substr(guard + 8, file.text.find('\n', guard) - guard - 8);
    EXPECT_NE(file.text.find("#define " + std::string(name) + "\n"), std::string_view::npos) << file.name;
    EXPECT_TRUE(file.text.ends_with("#endif\n")) << file.name;
  }
}

TEST(Headers, KeywordConstantsAgreeBothWays) {
  const auto constants = defines("const.h");
  std::set<std::string> keywords;
  for (const vm::KeywordInfo& keyword : vm::keyword_table()) {
    const std::string name(keyword.constant);
    keywords.insert(name);
    ASSERT_TRUE(constants.count(name)) << name;
    EXPECT_EQ(constants.at(name), std::to_string(keyword.value)) << name;
  }
  for (const auto& [name, text] : constants) {
    if (is_variable(text) || name.rfind("ML_", 0) == 0) continue;
    EXPECT_TRUE(keywords.count(name)) << name << " is no keyword";
  }
}

// IPOSplus p. 309
TEST(Headers, MovilinkConstantsArePrinted) {
  const std::map<std::string, int> printed = {
      {"ML_BT_S0", 1},      {"ML_BT_S1", 2},   {"ML_BT_SBUS", 5},    {"ML_FT_PAR1", 0},
      {"ML_FT_1", 1},       {"ML_FT_PAR2", 2}, {"ML_FT_2", 3},       {"ML_FT_PAR3", 4},
      {"ML_FT_3", 5},       {"ML_FT_PAR", 6},  {"ML_CFT_PAR1", 128}, {"ML_CFT_1", 129},
      {"ML_CFT_PAR2", 130}, {"ML_CFT_2", 131}, {"ML_CFT_PAR3", 132}, {"ML_CFT_3", 133},
      {"ML_CFT_PAR", 134},  {"ML_S_RD", 1},    {"ML_S_WR", 2},       {"ML_S_WRV", 3}};
  size_t found = 0;
  for (const auto& [name, text] : defines("const.h")) {
    if (name.rfind("ML_", 0) != 0) continue;
    ASSERT_TRUE(printed.count(name)) << name;
    EXPECT_EQ(text, std::to_string(printed.at(name))) << name;
    ++found;
  }
  EXPECT_EQ(found, printed.size());
  const auto b = defines("constb.h");
  EXPECT_EQ(b.at("ML_BT_SBUS1"), "5");
  EXPECT_EQ(b.at("ML_BT_SBUS2"), "8");
  EXPECT_EQ(std::stol(b.at("SCD_SBUS2"), nullptr, 16), 1 << 24);  // p. 232
  EXPECT_EQ(std::stol(b.at("SCD_SBUS1"), nullptr, 16), 0);
}

TEST(Headers, SystemVariablesAgreeBothWays) {
  std::map<std::string, std::string> in_headers;
  for (const auto& [name, text] : defines("const.h"))
    if (is_variable(text)) in_headers[name] = text;
  const size_t a = in_headers.size();
  for (const auto& [name, text] : defines("constb.h"))
    if (is_variable(text)) in_headers[name] = text;

  size_t a_rows = 0;
  for (const SystemVariable& variable : system_variables()) {
    a_rows += variable.units == VariableUnits::A;
    const std::string name(variable.compiler_name);
    ASSERT_TRUE(in_headers.count(name)) << name;
    EXPECT_EQ(in_headers[name], "H" + std::to_string(variable.number));
  }
  EXPECT_EQ(a_rows, a);
  EXPECT_EQ(system_variables().size(), in_headers.size());
  EXPECT_NE(embedded("constb.h").find("#include <const.h>"), std::string_view::npos);
}

TEST(Headers, InputsAndOutputsAreBits) {
  const auto io = defines("io.h");
  EXPECT_EQ(io.at("DI00"), "((H483 >> 0) & 1)");
  EXPECT_EQ(io.at("DI05"), "((H483 >> 5) & 1)");
  EXPECT_EQ(io.count("DI06"), 0U);
  EXPECT_EQ(io.at("DI17"), "((H483 >> 15) & 1)");
  EXPECT_EQ(io.at("DB00"), "((H481 >> 0) & 1)");
  EXPECT_EQ(io.at("DO02"), "((H481 >> 2) & 1)");
  EXPECT_EQ(io.at("DO10"), "((H480 >> 0) & 1)");
  const auto iob = defines("iob.h");
  EXPECT_EQ(iob.at("DI07"), "((H483 >> 7) & 1)");
  EXPECT_EQ(iob.at("DO05"), "((H481 >> 5) & 1)");
  // Both may be included: what both define is the same.
  for (const auto& [name, text] : io) {
    ASSERT_TRUE(iob.count(name)) << name;
    EXPECT_EQ(iob.at(name), text) << name;
  }
  // A value, its bit number and its statements name one bit.
  for (const auto& [name, text] : iob) {
    if (name.rfind("BIT_", 0) != 0) continue;
    const std::string io_name = name.substr(4);
    EXPECT_NE(iob.at(io_name).find(">> " + text + ")"), std::string::npos) << name;
    if (io_name[1] == 'I') continue;
    EXPECT_NE(iob.at("SET_" + io_name).find(", " + text + ")"), std::string::npos) << name;
    EXPECT_EQ(iob.at("SET_" + io_name).substr(8, 4), iob.at(io_name).substr(2, 4)) << name;
    EXPECT_EQ(iob.at("CLEAR_" + io_name).substr(9, 5), iob.at("SET_" + io_name).substr(7, 5)) << name;
  }
}

// docs/reference/stdlib.md names every function, structure and header.
TEST(Documentation, NamesEverything) {
  std::ifstream in(IPOS_STDLIB_DOC);
  const std::string page{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  for (const SystemFunction& function : system_functions())
    EXPECT_NE(page.find("`" + std::string(function.name) + "("), std::string::npos) << function.name;
  for (const Structure& structure : structures())
    EXPECT_NE(page.find("\n| " + std::string(structure.name) + " | "), std::string::npos) << structure.name;
  for (const EmbeddedFile& file : built_in_files())
    EXPECT_NE(page.find("`" + std::string(file.name) + "`"), std::string::npos) << file.name;
}

// Every constant that is made for a member stands on the page with its value.
TEST(Documentation, HasTheValuesOfMembers) {
  std::ifstream in(IPOS_STDLIB_DOC);
  const std::string page{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  size_t found = 0;
  for (const MemberUse& use : member_uses())
    for (const std::string_view beginning : use.constants())
      for (const HeaderName& name : header_names()) {
        if (!name.name.starts_with(beginning)) continue;
        ++found;
        const std::string row = "| " + std::string(use.structure) + "." + std::string(use.member) + " | " +
                                std::string(name.name) + " | " + std::string(name.text) + " |";
        EXPECT_NE(page.find(row), std::string::npos) << row;
      }
  EXPECT_GE(found, 25U);
}

// The rows of the two tables of system values name the type of their block.
TEST(Documentation, NamesTheTypesOfSystemValues) {
  std::ifstream in(IPOS_STDLIB_DOC);
  const std::string page{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  for (const vm::BlockInfo& row : vm::block_table()) {
    if (row.opcode != vm::Opcode::GetSys && row.opcode != vm::Opcode::SetSys) continue;
    if (row.keyword == vm::kAnyKeyword) continue;
    const auto* word = vm::find_keyword(row.opcode == vm::Opcode::GetSys ? "getsys" : "setsys", row.keyword);
    const size_t name = page.find("\n| " + std::string(word->constant));
    ASSERT_NE(name, std::string::npos) << word->constant;
    const std::string type =
        row.type == "long" ? "long[" + std::to_string(row.variables) + "]" : std::string(row.type);
    EXPECT_LT(page.find(type, name), page.find('\n', name + 1)) << word->constant << ": " << type;
  }
}

TEST(SystemVariables, AreFoundByNumberAndBothNames) {
  ASSERT_NE(find_system_variable(uint16_t{492}), nullptr);
  EXPECT_EQ(find_system_variable(uint16_t{492})->compiler_name, "TargetPos");
  EXPECT_EQ(find_system_variable("TARGET POS")->number, 492);
  EXPECT_EQ(find_system_variable("WdogTimer")->number, 490);
  EXPECT_EQ(find_system_variable("MOD.TAGPOS")->number, 454);
  EXPECT_EQ(find_system_variable(uint16_t{420}), nullptr);
  EXPECT_EQ(find_system_variable("nothing"), nullptr);
}

TEST(SystemVariables, NumbersRiseAndNamesAreUnique) {
  std::set<std::string_view> names;
  uint16_t last = 0;
  for (const SystemVariable& variable : system_variables()) {
    EXPECT_GT(variable.number, last);
    last = variable.number;
    EXPECT_FALSE(variable.assembler_name.empty());
    EXPECT_TRUE(names.insert(variable.compiler_name).second) << variable.compiler_name;
    EXPECT_TRUE(names.insert(variable.assembler_name).second) << variable.assembler_name;
  }
}

}  // namespace
}  // namespace ipos::stdlib
