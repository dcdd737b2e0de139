// What will happen in a plant by itself: the story at the head of its file, and what the file plans.
#pragma once

#include "tools/serve/host/plant_host.hpp"

namespace ipos::tools::serve {

// Empty: the file has none.
std::string story_of(PlantHost& host);
// Of each planned act: from when on, how often again, and what, in words. Times in microseconds.
Json planned_acts(const runtime::Plant& plant);

}  // namespace ipos::tools::serve
