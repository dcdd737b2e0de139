// How a line disturbs its frames, from what the plant file says of its cable: the one place that decides it for all kinds
// of line. What the manuals print decides what is good: the length for the rate, a resistor at both ends and nowhere else
// (1053 1610 p. 13, 64; MOVITRAC 07 chapters 3.1, 7.1; MOVITRAC 31 PROFIBUS 2.5). Which share of the frames is lost between
// good and dead is ours.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plant_file/plant_file.hpp"

namespace ipos::runtime {

struct LineDisturbance {
  std::string_view fault;  // the kind of [[fault]] that it is
  uint32_t per_mille;      // of the frames
  std::string cause;
};

inline constexpr uint32_t kAllFrames = 1000;

// Up to the limit none, from twice the limit on all (ours).
uint32_t share_of_length(uint32_t length_mm, uint32_t limit_m);
// Each switch that is not as it must be costs half of the frames (ours).
uint32_t share_of_terminators(size_t wrong);

// RS-485 and RS-232 may have the same length at every rate (1053 1610 p. 5, 8, 14-15; MDX60B/61B p. 12-15).
std::vector<LineDisturbance> line_disturbances(const PlantFile& file, const BusConfig& bus);

}  // namespace ipos::runtime
