// Levels sorted by function.
#include "runtime/drive/terminals.hpp"

#include <cstddef>

namespace ipos::runtime {

Terminals::Terminals(uint16_t levels, const std::array<uint8_t, 16>& functions) {
  for (std::size_t bit = 0; bit < functions.size(); ++bit) {
    if (functions[bit] == 0) continue;
    const uint64_t mask = uint64_t{1} << (functions[bit] & 63U);
    (((levels >> bit) & 1) != 0 ? on_ : off_) |= mask;
  }
}

}  // namespace ipos::runtime
