// Whether somebody wants a station to run, which then is not well where it does not.
#pragma once

#include "runtime/station/station.hpp"

namespace ipos::tools::serve {

bool is_ordered(const runtime::Station& station);

}  // namespace ipos::tools::serve
