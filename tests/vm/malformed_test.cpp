// Malformed programs as readable text: each breaks one rule of the verifier, and says in its head which and
// where.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "compiler/asm/assembler.hpp"
#include "stdlib/unit_types.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::vm {
namespace {

namespace fs = std::filesystem;

struct Malformed {
  std::string rule;
  uint32_t address;
  std::string text;  // with repeated lines written out
};

// "; repeat N" repeats the next line.
Malformed read_malformed(const fs::path& path) {
  Malformed program;
  std::ifstream in(path);
  int repeat = 1;
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (std::regex_match(line, match, std::regex("; expect (V\\d\\d) at (\\d+)"))) {
      program.rule = match[1];
      program.address = static_cast<uint32_t>(std::stoul(match[2]));
    }
    const bool is_repeat = std::regex_match(line, match, std::regex("; repeat (\\d+)"));
    for (int n = 0; n < repeat; ++n) program.text += line + "\n";
    repeat = is_repeat ? std::stoi(match[1]) : 1;
  }
  return program;
}

std::vector<fs::path> malformed_files() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(IPOS_MALFORMED_DIR)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Malformed, EachIsRefusedByItsRule) {
  std::set<std::string> rules;
  for (const fs::path& path : malformed_files()) {
    const Malformed program = read_malformed(path);
    compiler::SourceMap sources;
    compiler::Diagnostics diagnostics;
    const auto image =
        compiler::assemble(sources.add(path.filename().string(), path.string(), program.text), diagnostics);
    ASSERT_TRUE(image) << path << " " << (diagnostics.all().empty() ? "" : diagnostics.all()[0].text);
    const stdlib::UnitType& unit = *stdlib::find_unit(image->unit);
    std::array<Violation, 4> violations{};
    const Verification result =
        verify(image->code, {unit.variables, unit.program_words, unit.tasks, unit.call_depth}, violations);
    EXPECT_EQ(result.violations, 1U) << path;
    EXPECT_FALSE(result.image) << path;
    EXPECT_EQ(info(violations[0].rule).code, program.rule) << path;
    EXPECT_EQ(violations[0].address, program.address) << path;
    rules.insert(program.rule);
  }
  for (const RuleInfo& rule : rule_table())
    EXPECT_TRUE(rules.contains(rule.code)) << "no program breaks " << rule.code;
}

}  // namespace
}  // namespace ipos::vm
