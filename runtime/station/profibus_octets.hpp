// "10 08 02 49 fcs 16": a PROFIBUS frame as a person writes it. The word fcs before the end delimiter stands for the frame
// check sequence, which begins at DA.
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>

#include "runtime/bus/profibus/fdl_frame.hpp"
#include "runtime/plant_file/bytes_text.hpp"

namespace ipos::runtime {

inline uint8_t check_from_address(std::span<const uint8_t> octets) {
  using profibus::Delimiter;
  const size_t head = !octets.empty() && octets[0] == static_cast<uint8_t>(Delimiter::SD2) ? 4 : 1;
  return profibus::frame_check(octets.subspan(std::min(head, octets.size())));
}

inline std::optional<profibus::Octets> parse_octets(std::string_view text) {
  return parse_bytes(text, {"fcs", check_from_address, 1});
}

}  // namespace ipos::runtime
