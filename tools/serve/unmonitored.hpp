// Whether a drive on a line ends a movement by itself when its process data stay away, before a telegram goes out that could
// enable it.
#pragma once

#include "tools/links/bus_link.hpp"
#include "tools/serve/host/enabling_telegrams.hpp"

namespace ipos::tools::serve {

// Asks the unit. A Mistake says why the telegram does not go out, and what would have to be switched on.
void refuse_unmonitored(BusLink& link, const EnablingTelegram& telegram);

}  // namespace ipos::tools::serve
