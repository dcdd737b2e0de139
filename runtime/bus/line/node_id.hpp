// The number of a participant on a line, in order of attachment.
#pragma once

#include <cstdint>

namespace ipos::runtime {

using NodeId = uint32_t;
inline constexpr NodeId kNoNode = ~0U;

}  // namespace ipos::runtime
