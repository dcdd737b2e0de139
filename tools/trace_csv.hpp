// A recording as CSV: `time_ms`, then one column a signal with its unit in the header, one row a millisecond.
#pragma once

#include <ostream>

#include "tools/recording.hpp"

namespace ipos::tools {

void write_csv(std::ostream& out, const Recording& recording);

}  // namespace ipos::tools
