// Any bytes to the image reader, as they are and with a checksum that is right: a refusal, or an image that
// is written as the same one and is verified without harm. What the tools take of it can be disassembled and assembled.
#include "runtime/unit/program_image.hpp"
#include "tests/fuzz/programs.hpp"

using namespace ipos;         // NOLINT
using namespace ipos::tests;  // NOLINT

namespace {

void check(std::span<const uint8_t> bytes) {
  const vm::ImageResult read = vm::read_image(bytes);
  require(read.offset <= bytes.size(), "the trouble is within the file");
  if (read.error != vm::ImageError::None) {
    require(read.image == vm::Image{}, "a refused file gives no image");
    require(*vm::to_text(read.error) != '\0', "a refusal has a text");
    return;
  }
  const vm::ImageResult again = vm::read_image(vm::write_image(read.image));
  require(again.error == vm::ImageError::None && again.image == read.image,
          "a written image is read as the same image");
  const auto limits = limits_of(read.image.unit);
  if (!limits) return;
  // A name with control characters, or a row beyond the unit, no tool takes: neither does the assembler.
  if (runtime::read_program_image(bytes)) check_round_trips(read.image);
  vm::Violation violations[4];
  const vm::Verification verified = vm::verify(read.image.code, *limits, violations);
  require(verified.image.has_value() == (verified.violations == 0), "accepted means no violation");
  for (uint32_t n = 0; n < verified.violations && n < 4; ++n)
    require(violations[n].address <= read.image.code.size(), "a violation is within the code");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  check({data, size});
  if (size < 4) return 0;
  std::vector<uint8_t> repaired(data, data + size - 4);
  const uint32_t checksum = vm::crc32(repaired);
  for (uint32_t shift = 0; shift < 32; shift += 8)
    repaired.push_back(static_cast<uint8_t>(checksum >> shift));
  check(repaired);
  return 0;
}
