// Codec of variable telegrams: one 64-bit value, high or low byte first.
#include "runtime/bus/movilink/variable_telegram.hpp"

#include <cstring>

namespace ipos::runtime {
std::optional<VariablePair> frame_variables(const Frame& frame, VariableFormat format) {
  if (!fits(frame, format)) return std::nullopt;
  if (format.length == 0) return VariablePair{};
  uint64_t value = 0;
  std::memcpy(&value, frame.data.data(), sizeof value);
  value = detail::in_order(value, format.layout);
  const unsigned missing = detail::missing_bits(format);
  value = format.layout == VariableLayout::Intel ? value << missing >> missing : value >> missing;
  return VariablePair{static_cast<int32_t>(static_cast<uint32_t>(value)),
                      static_cast<int32_t>(static_cast<uint32_t>(value >> 32))};
}

}  // namespace ipos::runtime
