// Codec of variable telegrams: one 64-bit value, high or low byte first.
#include "runtime/bus/movilink/variable_telegram.hpp"

namespace ipos::runtime {
namespace {

// Weight, in bytes, of data byte `i`.
unsigned significance(VariableFormat format, unsigned i) {
  return format.layout == VariableLayout::Intel ? i : format.length - 1U - i;
}

}  // namespace

Frame variable_frame(uint32_t id, VariableFormat format, VariablePair variables) {
  const uint64_t value =
      uint64_t{static_cast<uint32_t>(variables.high)} << 32 | static_cast<uint32_t>(variables.low);
  Frame frame;
  frame.id = id;
  frame.length = format.length;
  for (unsigned i = 0; i < format.length; ++i)
    frame.data[i] = static_cast<uint8_t>(value >> (8 * significance(format, i)));
  return frame;
}

std::optional<VariablePair> frame_variables(const Frame& frame, VariableFormat format) {
  if (!is_plain(frame) || frame.length != format.length) return std::nullopt;
  uint64_t value = 0;
  for (unsigned i = 0; i < format.length; ++i)
    value |= uint64_t{frame.data[i]} << (8 * significance(format, i));
  return VariablePair{static_cast<int32_t>(static_cast<uint32_t>(value)),
                      static_cast<int32_t>(static_cast<uint32_t>(value >> 32))};
}

}  // namespace ipos::runtime
