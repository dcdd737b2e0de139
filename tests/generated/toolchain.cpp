// Every generated program also goes through the image file and through the assembler text, in turn with each
// set of variable names.
#include "tests/generated/toolchain.hpp"

#include "compiler/asm/assembler.hpp"
#include "compiler/asm/disassembler.hpp"
#include "compiler/compile.hpp"
#include "vm/exec/machine.hpp"
#include "vm/image/image.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tests {
namespace {

constexpr uint32_t kBudget = 20'000'000;  // commands; generated programs need a thousandth of it

std::string first_error(const compiler::Diagnostics& diagnostics, const compiler::SourceMap& map) {
  for (const compiler::Diagnostic& row : diagnostics.all())
    if (row.severity == compiler::Severity::Error)
      return std::string(compiler::info(row.diag).code) + " " + row.text + " (line " +
             std::to_string(map.position(row.span.begin).line) + ")";
  return "no image and no message";
}

uint32_t line_of(const vm::Image& image, uint32_t address) {
  uint32_t line = 0;
  for (const vm::LineEntry& entry : image.lines)
    if (entry.address <= address) line = entry.line;
  return line;
}

// Empty when assemble(disassemble(image)) == image.
std::string round_trip(const vm::Image& image, compiler::VariableNames names) {
  const std::string text = compiler::disassemble(image, names);
  compiler::SourceMap map;
  compiler::Diagnostics diagnostics;
  const auto again = compiler::assemble(map.add("again.asm", "", text), diagnostics);
  if (!again) return "the disassembled image does not assemble: " + first_error(diagnostics, map);
  return *again == image ? "" : "the assembled image differs from the compiled one";
}

}  // namespace

ToolchainRun run_toolchain(const Program& program, const std::string& source) {
  ToolchainRun out;
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit(std::string_view(program.unit));
  const compiler::Compilation compiled = compiler::compile("generated.IPC", "", source, options);
  if (!compiled.image) {
    out.trouble = "does not compile: " + first_error(compiled.diagnostics, *compiled.sources);
    return out;
  }
  const std::vector<uint8_t> bytes = vm::write_image(*compiled.image);
  const vm::ImageResult read = vm::read_image(bytes);
  if (read.error != vm::ImageError::None || read.image != *compiled.image) {
    out.trouble = std::string("the written image is read as another one: ") + vm::to_text(read.error);
    return out;
  }
  out.trouble = round_trip(read.image, static_cast<compiler::VariableNames>(program.seed % 3));
  if (!out.trouble.empty()) return out;

  const stdlib::UnitType& unit = *options.unit;
  vm::Violation violation{};
  const vm::Verification verified = vm::verify(
      read.image.code, {unit.variables, unit.program_words, unit.tasks, unit.call_depth}, {&violation, 1});
  if (!verified.image) {
    out.trouble = "the verifier refuses the image: " + std::string(vm::info(violation.rule).meaning) +
                  " at word " + std::to_string(violation.address);
    return out;
  }
  vm::Machine machine(*verified.image, {});
  machine.start();
  const vm::RunResult result = machine.run(1, kBudget);
  out.commands = result.commands;
  out.image = read.image;
  out.outcome.ended = result.stop == vm::Stop::Ended || result.stop == vm::Stop::Faulted;
  out.outcome.fault = machine.fault().number;
  if (out.outcome.fault != 0) out.outcome.line = line_of(read.image, machine.fault().address);
  out.outcome.variables.assign(machine.variables().begin(), machine.variables().end());
  return out;
}

}  // namespace ipos::tests
