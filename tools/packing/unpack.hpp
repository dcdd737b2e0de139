// Unpacks piece by piece: packed bytes may claim any size, and never is more than a piece of them in memory.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

namespace ipos::tools {

enum class Packing : uint8_t { Zlib, Gzip };

enum class Unpacked : uint8_t { Whole, EndsEarly, Damaged };

bool has_zlib();

// Calls `take` with each piece until it is false, which is whole, too.
Unpacked unpack(std::string_view packed, Packing packing, const std::function<bool(std::string_view)>& take);

}  // namespace ipos::tools
