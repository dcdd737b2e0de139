// False alarms: every program of the repository that is meant to be right compiles under -Wall without a message, but for
// those that are right and listed here, and those that a language test expects by a comment.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "compiler/compile.hpp"
#include "tests/docs/page.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

// "FILE CODE", and why it is right there.
const std::set<std::string> kRight = {
    "tests/bench/programs/fib.IPC W0209",                    // recursion, to be measured
    "tests/bench/programs/sieve.IPC W0208",                  // fills all numbers
    "tests/language/data/numof_is_constant.IPC W0291",       // a case of numof( )
    "tests/language/data/numof_is_constant.IPC W0292",
    "tests/language/manual/number_circle.IPC W0241",        // writes Hn for the test to look at
    "tests/language/manual/unary_operators.IPC W0241",
    "tests/language/operators/deep_temporaries.IPC W0241",
    "tests/language/preprocess/comments.IPC W0241",
    "tests/language/preprocess/define_itself.IPC W0241",
    "tests/language/statements/switch_block_in_case.IPC W0291",   // tries what no case takes
    "tests/language/statements/switch_default_first.IPC W0260",
    "tests/language/statements/switch_fall_through.IPC W0260",
    "tests/language/statements/switch_no_match.IPC W0291",
    "tests/language/system/wait_argument_changed.IPC W0261",      // tasks that meet in one variable
    "tests/language/tasks/hand_over.IPC W0261",
    "tests/language/tasks/shared_function.IPC W0261",
    "tests/stdlib/blocks/RINGTASK.IPC W0261",                     // a ring between two tasks: its count changes in one command
    "tests/tools/mutate/heater/HEATER.IPC W0257",            // lDegrees, which the test forces
};

// The unit of the first station of a plant beside the program that runs it; null: the default.
const stdlib::UnitType* unit_of(const fs::path& program) {
  for (const auto& file : fs::directory_iterator(program.parent_path())) {
    if (file.path().extension() != ".toml") continue;
    const std::string plant = read_text(file.path());
    const size_t at = plant.find("\"" + program.filename().string() + "\"");
    const size_t table = at == std::string::npos ? at : plant.rfind("[[station]]", at);
    if (table == std::string::npos) continue;
    const size_t key = plant.find("unit = \"", table);
    if (key == std::string::npos) continue;
    const size_t first = key + 8;
    if (const auto* unit = stdlib::find_unit(plant.substr(first, plant.find('"', first) - first))) return unit;
  }
  return nullptr;
}

TEST(AllPrograms, NoFalseAlarm) {
  const std::set<std::string> wrong_on_purpose = {"errors", "warnings", "limits", "units", "faults"};
  size_t programs = 0;
  for (const char* folder : {"examples", "tools/new/template", "tests"})
    for (const auto& file : fs::recursive_directory_iterator(project(folder))) {
      if (file.path().extension() != ".IPC") continue;
      const bool language = file.path().parent_path().parent_path().filename() == "language";
      if (language && wrong_on_purpose.contains(file.path().parent_path().filename())) continue;
      const std::string text = read_text(file.path());
      compiler::CompileOptions options;
      options.unit = unit_of(file.path());
      options.include_dirs = {file.path().parent_path()};
      options.read_file = [](const std::string& path) -> std::optional<std::string> {
        if (!fs::is_regular_file(path)) return std::nullopt;
        return read_text(path);
      };
      ASSERT_TRUE(options.warnings.apply("all"));
      const auto result = compiler::compile(file.path().filename(), file.path(), text, options);
      ++programs;
      for (const compiler::Diagnostic& one : result.diagnostics.all()) {
        const compiler::DiagInfo& row = compiler::info(one.diag);
        const std::string known = fs::relative(file.path(), project(".")).string() + " " + std::string(row.code);
        const bool expected = text.find("expect warning " + std::string(row.code)) != std::string::npos;
        if (one.severity != compiler::Severity::Warning || expected) continue;
        EXPECT_TRUE(kRight.contains(known)) << known << ": " << one.text;
      }
    }
  EXPECT_GT(programs, 400U);
}

}  // namespace
}  // namespace ipos::tests
