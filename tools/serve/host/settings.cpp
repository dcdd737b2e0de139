// A setting is a name and any JSON.
#include "tools/serve/host/settings.hpp"

#include <memory>
#include <string>
#include <utility>

namespace ipos::tools::serve {
namespace {

constexpr size_t kMostSettings = 256 * 1024;  // bytes of all of them (ours)

void set(const SettingsPlace& place, const std::string& name, const Json& value) {
  const bool is_kept = place.change([&](Json& all) {
    all[name] = value;
    if (all.dump(-1, ' ', false, Json::error_handler_t::replace).size() > kMostSettings)
      throw Mistake("there is no room for more settings");
  });
  if (!is_kept) throw Mistake("the settings cannot be kept: the state folder cannot be written");
}

}  // namespace

void add_settings(Router& router, SettingsPlace place) {
  const auto shared = std::make_shared<const SettingsPlace>(std::move(place));
  router.add_command("settings", [shared](const Router::Call&) { return Json{{"settings", shared->read()}}; });
  router.add_command("settings.set", [shared](const Router::Call& call) {
    if (!call.arguments.has("value")) throw Mistake("'value' is missing");
    set(*shared, call.arguments.text("name"), call.arguments.json()["value"]);
    return Json::object();
  });
  router.keep = [shared](const std::string& name, const Json& value) {
    try {
      set(*shared, name, value);
    } catch (const Mistake&) {  // it is done all the same, and only forgotten at the next start
    }
  };
}

}  // namespace ipos::tools::serve
