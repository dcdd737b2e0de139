// Engines by name; machine code for the runtime, which does not know vm/jit.
#include "tools/input/engine.hpp"

#include "runtime/unit/program_shelf.hpp"
#include "tools/cli/failure.hpp"
#include "vm/jit/jit.hpp"

namespace ipos::tools {
namespace {

std::shared_ptr<const vm::fast::Native> machine_code(const vm::VerifiedImage& program) {
  const std::shared_ptr<const vm::jit::Code> code = vm::jit::compile(program);
  if (!code) return nullptr;
  return {code, &code->native()};
}

}  // namespace

void add_engine_option(cli::Verb& verb, std::string& engine) {
  verb.option("--engine", engine,
              "what executes the programs, with equal results: reference, fast or native (machine code); "
              "default: native where this build has it, else fast")
      .one_of({"reference", "fast", "native"});
}

runtime::Execution execution_of(const std::string& engine) {
  static const auto shelf = std::make_shared<runtime::ProgramShelf>();
  runtime::Execution execution;
  execution.shelf = shelf;
  execution.fast = engine != "reference";
  if (engine == "native" && !vm::jit::available())
    throw Failure(kUsage, "--engine native: this build has no machine code");
  if (engine.empty() || engine == "native")
    execution.compiler = vm::jit::available() ? machine_code : nullptr;
  return execution;
}

}  // namespace ipos::tools
