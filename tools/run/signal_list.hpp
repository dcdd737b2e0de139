// `ipos run --signals list`: what of a plant can be recorded, watched and expected.
#pragma once

#include <string>

#include "runtime/plant/plant.hpp"

namespace ipos::tools {

// A line a signal: name, unit, what it is; or a JSON array of objects.
std::string signal_list(const runtime::Plant& plant, bool json);

}  // namespace ipos::tools
