#include "tests/engines/programs.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "compiler/compile.hpp"
#include "tests/engines/pair.hpp"
#include "tests/generated/forms.hpp"
#include "tests/generated/program_generator.hpp"
#include "tests/generated/source_text.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kOrders = 120;
constexpr uint32_t kOrdersOfRepository = 1000;
constexpr vm::Limits kLoopLimits{64, 1024, 3, 6};
constexpr vm::Limits kSoupLimits{1024, 16384, 3, 6};  // few calls, so that F32 is met

vm::Limits limits_of(const stdlib::UnitType& unit) {
  return {unit.variables, unit.program_words, unit.tasks, unit.call_depth};
}

std::optional<std::string> read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

namespace {

void add(std::vector<EngineProgram>& programs, const std::string& what, std::vector<uint32_t> code,
         const vm::Limits& limits, uint64_t seed) {
  if (!code.empty())
    programs.push_back({what + " " + std::to_string(seed), std::move(code), limits, seed, kOrders});
}

}  // namespace

std::vector<EngineProgram> assembled_programs_of(uint64_t seed) {
  std::vector<EngineProgram> programs;
  add(programs, "loops over tables", table_loops(seed, kLoopLimits), kLoopLimits, seed);
  add(programs, "state machine", state_machine(seed), kLoopLimits, seed);
  add(programs, "soup", with_interrupts(sequence_soup(seed), kSoupLimits, seed), kSoupLimits, seed);
  return programs;
}

std::vector<EngineProgram> programs_of(uint64_t seed) {
  std::vector<EngineProgram> programs = assembled_programs_of(seed);
  const auto add_source = [&](const std::string& what, const std::string& text, std::string_view unit) {
    compiler::CompileOptions options;
    options.unit = stdlib::find_unit(unit);
    const compiler::Compilation made = compiler::compile("generated.IPC", "", text, options);
    if (!made.image) return;
    const vm::Limits limits = limits_of(*options.unit);
    add(programs, what, made.image->code, limits, seed);
    add(programs, what + " with interrupts", with_interrupts(made.image->code, limits, seed), limits, seed);
  };
  Program program = generate_program(seed);
  add_source("generated", source_text(program), program.unit);
  add_source("forms", forms_program(seed), "mdxb");
  return programs;
}

std::vector<EngineProgram> programs_of_the_repository() {
  std::vector<EngineProgram> programs;
  for (const char* folder : {"examples", "tests/language", "tests/bench/programs"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(IPOS_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".IPC") continue;
      const std::string path = entry.path().string();
      compiler::CompileOptions options;
      options.read_file = read_text;
      for (const char* unit : {"", "mdxb"}) {
        options.unit = *unit == 0 ? nullptr : stdlib::find_unit(std::string_view(unit));
        const compiler::Compilation made =
            compiler::compile(path, path, read_text(path).value_or(""), options);
        if (!made.image) continue;
        const vm::Limits limits = limits_of(*made.unit);
        const std::string name = fs::relative(path, IPOS_SOURCE_DIR).string();
        for (uint64_t seed = 1; seed <= 2; ++seed) {
          const auto code = seed == 1 ? made.image->code : with_interrupts(made.image->code, limits, seed);
          if (vm::verify(code, limits, {}).image)
            programs.push_back({name, code, limits, seed, kOrdersOfRepository});
        }
      }
    }
  return programs;
}

}  // namespace ipos::tests
