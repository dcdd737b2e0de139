// Codec of variable telegrams: one 64-bit value, high or low byte first.
#include "runtime/bus/movilink/variable_telegram.hpp"

#include <bit>
#include <cstring>

namespace ipos::runtime {
namespace {

// The number that stands in memory as this one does in a telegram of eight bytes.
uint64_t in_order(uint64_t value, VariableLayout layout) {
  const bool low_first = layout == VariableLayout::Intel;
  return low_first == (std::endian::native == std::endian::little) ? value : __builtin_bswap64(value);
}

// Bits of the eight bytes that a telegram does not carry.
unsigned missing_bits(VariableFormat format) { return 64U - 8U * format.length; }

}  // namespace

Frame variable_frame(uint32_t id, VariableFormat format, VariablePair variables) {
  const uint64_t value =
      uint64_t{static_cast<uint32_t>(variables.high)} << 32 | static_cast<uint32_t>(variables.low);
  Frame frame;
  frame.id = id;
  frame.length = format.length;
  if (format.length == 0) return frame;
  const unsigned missing = missing_bits(format);
  const bool low_first = format.layout == VariableLayout::Intel;
  const uint64_t bytes = in_order(low_first ? value << missing >> missing : value << missing, format.layout);
  std::memcpy(frame.data.data(), &bytes, sizeof bytes);
  return frame;
}

std::optional<VariablePair> frame_variables(const Frame& frame, VariableFormat format) {
  if (!is_plain(frame) || frame.length != format.length) return std::nullopt;
  if (format.length == 0) return VariablePair{};
  uint64_t value = 0;
  std::memcpy(&value, frame.data.data(), sizeof value);
  value = in_order(value, format.layout);
  const unsigned missing = missing_bits(format);
  value = format.layout == VariableLayout::Intel ? value << missing >> missing : value >> missing;
  return VariablePair{static_cast<int32_t>(static_cast<uint32_t>(value)),
                      static_cast<int32_t>(static_cast<uint32_t>(value >> 32))};
}

}  // namespace ipos::runtime
