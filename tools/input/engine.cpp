// Engines by name; machine code for the runtime, which does not know vm/jit.
#include "tools/input/engine.hpp"

#include <algorithm>
#include <list>
#include <mutex>
#include <vector>

#include "tools/cli/failure.hpp"
#include "vm/jit/jit.hpp"

namespace ipos::tools {
namespace {

using Native = std::shared_ptr<const vm::fast::Native>;

// Of the programs that came last: stations share one, and a campaign builds the same plant again and again.
class MadeCode {
 public:
  Native of(const vm::VerifiedImage& program) {
    const std::lock_guard lock(mutex_);
    const auto known = std::find_if(made_.begin(), made_.end(), [&](const Made& one) {
      return one.call_depth == program.limits().call_depth && one.variables == program.limits().variables &&
             std::equal(one.words.begin(), one.words.end(), program.code().begin(), program.code().end());
    });
    if (known != made_.end()) {
      made_.splice(made_.begin(), made_, known);
      return made_.front().native;
    }
    const std::shared_ptr<const vm::jit::Code> code = vm::jit::compile(program);
    made_.push_front({{program.code().begin(), program.code().end()}, program.limits().call_depth, program.limits().variables,
                      code ? Native(code, &code->native()) : nullptr});
    if (made_.size() > kKept) made_.pop_back();
    return made_.front().native;
  }

 private:
  static constexpr size_t kKept = 32;  // ours; a page or two each
  struct Made {
    std::vector<uint32_t> words;
    uint32_t call_depth;
    uint32_t variables;
    Native native;
  };
  std::mutex mutex_;
  std::list<Made> made_;  // the last one used first
};

Native machine_code(const vm::VerifiedImage& program) {
  static MadeCode made;
  return made.of(program);
}

}  // namespace

void add_engine_option(cli::Verb& verb, std::string& engine) {
  verb.option("--engine", engine,
              "what executes the programs, with equal results: reference, fast or native (machine code); "
              "default: native where this build has it, else fast")
      .one_of({"reference", "fast", "native"});
}

runtime::Execution execution_of(const std::string& engine) {
  runtime::Execution execution;
  execution.fast = engine != "reference";
  if (engine == "native" && !vm::jit::available())
    throw Failure(kUsage, "--engine native: this build has no machine code");
  if (engine.empty() || engine == "native")
    execution.compiler = vm::jit::available() ? machine_code : nullptr;
  return execution;
}

}  // namespace ipos::tools
