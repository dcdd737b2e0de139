// The copies that a host on this system has: forked ones (posix), or none (windows).
#pragma once

#include <memory>

#include "tools/serve/host/copies.hpp"

namespace ipos::tools::serve {

// Without snapshots time goes back by running again from the beginning.
std::unique_ptr<Copies> host_copies(bool snapshots);

}  // namespace ipos::tools::serve
