// Machine code for the programs of a plant, for runtime::Execution::compiler.
#pragma once

#include <memory>

#include "vm/jit/jit.hpp"

namespace ipos::tests {

inline std::shared_ptr<const vm::fast::Native> machine_code(const vm::VerifiedImage& program) {
  const std::shared_ptr<const vm::jit::Code> code = vm::jit::compile(program);
  return code ? std::shared_ptr<const vm::fast::Native>(code, &code->native()) : nullptr;
}

}  // namespace ipos::tests
