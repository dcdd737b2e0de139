// First indices of the areas as constants: kFirstVariables + n is Hn (1053 1610 p. 74).
#pragma once

#include <cstdint>

namespace ipos::stdlib {

#define INDEX_AREA(name, first, count, everywhere, meaning) inline constexpr uint16_t kFirst##name = first;
#include "stdlib/index_areas.def"

inline constexpr uint16_t kFirmwareIndex = kFirstDrive;  // P076, the lowest of all

}  // namespace ipos::stdlib
