// The date in the head of an ASC log, in the words of the system it was written on: English or German, with or without am
// and pm in letters of either size.
#pragma once

#include <optional>

#include "tools/logs/fields.hpp"

namespace ipos::tools {

// "Sat Jan 01 03:06:13.191 pm 2000"; since runtime::kCandumpEpoch, UTC (ours). Nothing where it is not understood.
std::optional<runtime::Time> asc_date(Fields fields);

}  // namespace ipos::tools
