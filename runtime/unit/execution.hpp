// How the programs of a plant are executed. Whatever is chosen, the results are the same
// (docs/inside/performance.md).
#pragma once

#include <memory>

#include "runtime/pace/pacer.hpp"
#include "vm/fast/native.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::runtime {

class ProgramShelf;

struct Execution {
  // Machine code of a program, which lives as long as somebody holds it; null when there is none for it.
  // vm/jit can make it, which the runtime does not know.
  using Compiler = std::shared_ptr<const vm::fast::Native> (*)(const vm::VerifiedImage&);

  bool fast = true;             // the fast engine; else the reference interpreter alone
  Compiler compiler = nullptr;  // for the fast engine; null: no machine code
  Pace pace = Pace::Lazy;
  // Of a plant: 0: all events are in one queue. Else its islands (runtime/plant/islands.hpp) run apart, on up to so many
  // threads.
  unsigned threads = 0;
  std::shared_ptr<ProgramShelf> shelf{};  // of what is made of programs; null: each unit makes its own
};

}  // namespace ipos::runtime
