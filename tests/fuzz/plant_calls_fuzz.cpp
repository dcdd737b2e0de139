// ipos_plant.h under sequences of calls, right and wrong, with memory that fails: tests/runtime/library/calls.cpp.
#include "tests/fuzz/fuzz.hpp"
#include "tests/runtime/library/calls.hpp"

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const ipos::tests::Outcome outcome = ipos::tests::play_calls({data, size});
  if (outcome.broken != nullptr) ipos::tests::broken(outcome.broken);
  return 0;
}
