// Any octets and any characters on PROFIBUS: what is accepted is a frame and has a text.
#include <algorithm>

#include "runtime/bus/profibus/fdl_receiver.hpp"
#include "runtime/bus/profibus/frame_text.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace ipos::profibus;  // NOLINT
using namespace ipos::tests;     // NOLINT
namespace runtime = ipos::runtime;

namespace {

void check_decoder(const uint8_t* data, size_t size) {
  const auto frame = decode({data, size});
  if (!frame) return;
  const Octets octets = encode(*frame);
  require(std::equal(octets.begin(), octets.end(), data, data + size), "a frame is its own octets");
  require(!describe(*frame).empty(), "a frame has a text");
}

void check_receiver(Input input) {
  FdlReceiver receiver(input.u8() % 2 == 0 ? strict_limits(500'000) : kPortLimits);
  Time now = 0;
  while (!input.empty()) {
    const uint8_t kind = input.u8();
    if (kind % 8 == 0) now += input.u8() * (runtime::kMillisecond / 16);
    runtime::Character character;
    character.start = now;
    character.end = now += 22 * runtime::kMicrosecond;
    character.data = input.u8();
    character.parity_error = kind == 0xFF;
    character.framing_error = kind == 0xFE;
    for (const Reception& reception : receiver.take(character)) {
      require(!reception.octets.empty() && reception.start < reception.end,
              "a reception has octets and time");
      if (reception.frame)
        require(encode(*reception.frame) == reception.octets, "a frame heard is its own octets");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  check_decoder(data, size);
  check_receiver({data, size});
  return 0;
}
