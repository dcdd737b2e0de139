// ipos_bench_run PROGRAM.IPC [--engine reference|fast|jit] [--operations] [--repeat N]
// Compiles a program for an mdxb without a drive, executes its task 1 to the end and prints the variable
// `result`. --operations prints what the program was predecoded into. Time is taken by who calls it.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"
#include "vm/exec/machine.hpp"
#include "vm/fast/predecode.hpp"
#include "vm/jit/jit.hpp"

namespace {

using namespace ipos;  // NOLINT

void print_operations(const vm::fast::Predecoded& program) {
  const auto code = program.program().code();
  for (uint32_t at = 0; at < code.size(); at += vm::decode(code, at).words)
    std::printf("%5u %-10s %s\n", at,
                std::string(vm::info(vm::decode(code, at).instruction.opcode).name).c_str(),
                vm::fast::operation_name(program.operation(at)));
}

}  // namespace

int main(int argc, char** argv) {
  std::string file;
  bool operations = false;
  std::string engine = "fast";
  int repeat = 1;
  for (int n = 1; n < argc; ++n) {
    const std::string word = argv[n];
    if (word == "--operations")
      operations = true;
    else if (word == "--engine" && n + 1 < argc)
      engine = argv[++n];
    else if (word == "--repeat" && n + 1 < argc)
      repeat = std::atoi(argv[++n]);
    else
      file = word;
  }
  if (engine != "reference" && engine != "fast" && engine != "jit") {
    std::fprintf(stderr, "'%s' is no engine: reference, fast or jit\n", engine.c_str());
    return 64;
  }
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit(std::string_view("mdxb"));
  const compiler::Compilation made = compiler::compile(file, "", text, options);
  if (!made.image) {
    std::fputs(compiler::render_text(made.diagnostics.all(), *made.sources, false).c_str(), stderr);
    return 1;
  }
  const vm::Limits limits{options.unit->variables, options.unit->program_words, options.unit->tasks,
                          options.unit->call_depth};
  const vm::Verification verified = vm::verify(made.image->code, limits, {});
  std::vector<vm::fast::Slot> slots(vm::fast::Predecoded::slots_needed(made.image->code.size()));
  const vm::fast::Predecoded program(*verified.image, slots);
  if (operations) {
    print_operations(program);
    return 0;
  }
  vm::Machine machine(*verified.image, {});
  std::unique_ptr<vm::jit::Code> native;
  if (engine == "jit") {
    native = vm::jit::compile(*verified.image);
    if (native == nullptr) {
      std::fputs("no machine code in this build\n", stderr);
      return 1;
    }
    std::fprintf(stderr, "%zu bytes of machine code\n", native->bytes());
  }
  if (engine != "reference") machine.use(&program, native == nullptr ? nullptr : &native->native());
  uint64_t commands = 0;
  for (; repeat > 0; --repeat) {
    machine.start();
    vm::RunResult run{};
    do {
      run = machine.run(1, 1'000'000'000);
      commands += run.commands;
    } while (run.stop == vm::Stop::Budget);
  }
  if (machine.fault().number != 0) {
    std::fprintf(stderr, "fault F%u: %s\n", unsigned{machine.fault().number}, machine.fault().reason);
    return 1;
  }
  for (const vm::Symbol& symbol : made.image->symbols)
    if (symbol.name == "result") std::printf("%d\n", machine.variables()[symbol.variable]);
  std::fprintf(stderr, "%llu commands\n", static_cast<unsigned long long>(commands));
}
