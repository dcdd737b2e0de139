// Builds and targets without machine code.
#include "vm/jit/jit.hpp"

namespace ipos::vm::jit {

std::unique_ptr<Code> compile(const VerifiedImage&) { return nullptr; }
bool available() { return false; }

}  // namespace ipos::vm::jit
