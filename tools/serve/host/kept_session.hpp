// The plant of the page as a session: its texts, what was done to it, and the moment where it stands.
#pragma once

#include "tools/serve/host/plant_host.hpp"
#include "tools/sessions/session.hpp"

namespace ipos::tools::serve {

// As it stands now. A Mistake says why it cannot be kept.
sessions::Session session_of(PlantHost& host, Json settings);

}  // namespace ipos::tools::serve
