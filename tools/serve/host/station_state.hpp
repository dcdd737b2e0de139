// How a station or a gateway stands, for the cards of the tab Plant.
#pragma once

#include "runtime/plant/plant.hpp"
#include "tools/serve/host/arguments.hpp"

namespace ipos::tools::serve {

Json station_state(const runtime::Plant& plant, const runtime::Station& station);
Json gateway_state(const runtime::Gateway& gateway);

}  // namespace ipos::tools::serve
