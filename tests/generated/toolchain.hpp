// The code under test as one call: compile, write and read the image, verify, disassemble and assemble, run.
#pragma once

#include <string>

#include "tests/generated/program.hpp"
#include "vm/image/image.hpp"

namespace ipos::tests {

struct ToolchainRun {
  Outcome outcome;
  size_t commands = 0;  // executed
  vm::Image image;      // what ran
  std::string trouble;  // a stage that failed; empty: the outcome counts
};
ToolchainRun run_toolchain(const Program& program, const std::string& source);

}  // namespace ipos::tests
