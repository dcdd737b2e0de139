// What a person has set on the page and finds again: the commands `settings` and `settings.set`, and Router::keep. Where it is
// kept is the caller's matter.
#pragma once

#include <functional>

#include "tools/serve/host/router.hpp"

namespace ipos::tools::serve {

// All settings by their names, as one object; asked for each time, as others may keep theirs in the same place.
struct SettingsPlace {
  std::function<Json()> read;
  std::function<bool(const Json&)> write;  // false: they cannot be kept
};
void add_settings(Router& router, SettingsPlace place);

}  // namespace ipos::tools::serve
