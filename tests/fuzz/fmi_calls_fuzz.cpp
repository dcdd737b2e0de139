// The functions of FMI 2.0 and 3.0 under sequences of calls, right and wrong: tests/fmi/random_calls.cpp.
#include "tests/fmi/random_calls.hpp"
#include "tests/fuzz/fuzz.hpp"

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (const char* broken = ipos::tests::play_fmi_calls({data, size})) ipos::tests::broken(broken);
  return 0;
}
