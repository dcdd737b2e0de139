// A recorded signal as the picture of the page wants it (web/src/picture/channel.ts): its name, its unit, and how it is drawn.
#pragma once

#include <nlohmann/json.hpp>

#include "runtime/signals/shape.hpp"

namespace ipos::tools {

nlohmann::json channel_json(const signals::Signal& signal);

}  // namespace ipos::tools
