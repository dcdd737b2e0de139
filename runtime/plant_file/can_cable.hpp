// What is wrong with the cable of a CAN line as the plant file describes it (1053 1610 p. 8, 12, 13; MOVITRAC 07
// chapters 2.1, 3.1, 7.1; MDX60B/61B chapter 3.3.1). `ipos bus plan` finds it, and a plant tells it when it starts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/plant_file/plant_file.hpp"

namespace ipos::runtime {

enum class CableRule : uint8_t { TooManyStations, LineTooLong, CableData, Termination, MixedMch42a };

struct CableFinding {
  CableRule rule;
  std::string text;
};

uint32_t can_length_limit(uint32_t baud);  // m (1053 1610 p. 13)

std::vector<CableFinding> can_cable_findings(const PlantFile& file, const BusConfig& bus);

}  // namespace ipos::runtime
