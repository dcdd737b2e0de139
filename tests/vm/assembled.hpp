// A program in assembler text with the machine that runs it, for tests of tasks and interrupts.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compiler/asm/assembler.hpp"
#include "stdlib/unit_types.hpp"
#include "vm/exec/machine.hpp"
#include "vm/sched/scheduler.hpp"

namespace ipos::tests {

// For a MOVIDRIVE B; task 1 is started.
class Assembled {
 public:
  explicit Assembled(const std::string& text, vm::Host host = {})
      : code_(assemble(".unit mdxb\n" + text)), machine_(verified(), host) {
    machine_.start();
  }
  Assembled(const Assembled&) = delete;
  Assembled& operator=(const Assembled&) = delete;

  vm::Machine* operator->() { return &machine_; }
  vm::Machine& machine() { return machine_; }
  int32_t& h(size_t n) { return machine_.variables()[n]; }
  void set(size_t first, std::initializer_list<int32_t> values) {
    for (const int32_t value : values) h(first++) = value;
  }
  vm::RunResult run(uint32_t budget = 1000) { return machine_.run(1, budget); }
  // A millisecond with that many commands for every task.
  uint32_t tick(uint32_t commands = 100) {
    return vm::run_tick(machine_, vm::Rates{{commands, commands, commands}});
  }

 private:
  static std::vector<uint32_t> assemble(const std::string& text) {
    compiler::SourceMap sources;
    compiler::Diagnostics diagnostics;
    const auto image = compiler::assemble(sources.add("test.ipa", "", text), diagnostics);
    EXPECT_TRUE(image) << (diagnostics.all().empty() ? "" : diagnostics.all()[0].text) << "\n" << text;
    return image ? image->code : std::vector<uint32_t>{};
  }
  vm::VerifiedImage verified() const {
    const stdlib::UnitType& unit = *stdlib::find_unit("mdxb");
    const vm::Limits limits{unit.variables, unit.program_words, unit.tasks, unit.call_depth};
    return vm::verify(code_, limits, {}).image.value();
  }

  std::vector<uint32_t> code_;
  vm::Machine machine_;
};

}  // namespace ipos::tests
