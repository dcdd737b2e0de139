// What `ipos build --maps` prints: the maps of the program of each station as text, as JSON, or as graphs for Graphviz.
#pragma once

#include <string>
#include <string_view>

#include "runtime/plant/plant.hpp"

namespace ipos::tools {

// `format`: text, json or dot.
std::string maps_report(const runtime::Plant& plant, std::string_view format);

}  // namespace ipos::tools
