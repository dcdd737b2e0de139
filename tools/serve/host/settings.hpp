// What a person has set on the page and finds again: the commands `settings` and `settings.set`, and Router::keep. Where it is
// kept is the caller's matter.
#pragma once

#include <functional>

#include "tools/serve/host/router.hpp"

namespace ipos::tools::serve {

// All settings by their names, as one object; asked for each time, as others may keep theirs in the same place.
struct SettingsPlace {
  std::function<Json()> read;
  // Gives them to be changed and keeps what they are then; nobody else changes them meanwhile. False: they cannot be kept.
  std::function<bool(const std::function<void(Json&)>&)> change;
};
void add_settings(Router& router, SettingsPlace place);

}  // namespace ipos::tools::serve
