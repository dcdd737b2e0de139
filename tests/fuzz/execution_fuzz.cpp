// Execution of accepted programs, under a host that answers at random. The first byte says what the rest is:
// an image file, raw code words, or choices from which a valid program is made.
#include "tests/fuzz/programs.hpp"

using namespace ipos;         // NOLINT
using namespace ipos::tests;  // NOLINT

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  Input input(data, size);
  const uint8_t kind = input.u8();
  const uint64_t seed = input.u8();
  auto unit = static_cast<uint8_t>(1 + kind / 3 % 4);
  std::vector<uint32_t> code;
  if (kind % 3 == 0) {
    vm::ImageResult read = vm::read_image({input.rest(), input.left()});
    code = std::move(read.image.code);
    unit = read.image.unit;
  } else if (kind % 3 == 1) {
    while (!input.empty()) code.push_back(input.u32());
  } else {
    unit = 4;
    code = valid_code(input);
  }
  const auto limits = limits_of(unit);
  if (!limits) return 0;
  const vm::Verification verified = vm::verify(code, *limits, {});
  require(kind % 3 != 2 || verified.image.has_value(), "the verifier accepts every valid program");
  if (verified.image) check_execution(*verified.image, seed);
  return 0;
}
