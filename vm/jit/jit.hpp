// Machine code for verified programs (x86-64, AArch64): all commands but those of the host become native
// ones, the variables loops use most stay in registers. Takes memory from the heap and from the operating
// system, so it is a layer of its own beside the VM; a build without it has a compile() that says no.
#pragma once

#include <memory>

#include "vm/fast/native.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::vm::jit {

class Code {
 public:
  virtual ~Code() = default;
  // For Machine::use; machines with the same program can share it. Lives as long as this object.
  virtual const fast::Native& native() const = 0;
  virtual size_t bytes() const = 0;  // of machine code
};

// Nothing when this build or target has no machine code, or there is no memory for it. The code's words are
// not needed afterwards.
std::unique_ptr<Code> compile(const VerifiedImage& program);

// Whether this build has it.
bool available();

}  // namespace ipos::vm::jit
