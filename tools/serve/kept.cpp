// One JSON object a plant: "token", "port", "settings".
#include "tools/serve/kept.hpp"

#include <algorithm>
#include <filesystem>

#include "tools/serve/host/settings.hpp"
#include "tools/serve/server.hpp"
#include "tools/serve/state_folder.hpp"

namespace ipos::tools::serve {
namespace {

bool is_token(const std::string& text) {
  return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

Kept::Kept(std::string of) : name_(state_name("serve", of)) {}

Kept Kept::of_plant(const std::string& file) {
  std::error_code error;
  const auto whole = std::filesystem::weakly_canonical(file, error);
  return Kept(error ? file : whole.string());
}
Kept Kept::of_drive(const std::string& port, const std::string& address) {
  return Kept("drive " + address + " at " + port);
}

Json Kept::read() const {
  Json kept = Json::parse(read_state(name_).value_or("{}"), nullptr, false);
  return kept.is_object() ? kept : Json::object();
}
bool Kept::change(const std::function<void(Json&)>& act) const {
  const StateLock lock(name_);
  const Json before = read();
  Json kept = before;
  act(kept);
  return kept == before || write_state(name_, kept.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string Kept::token() const {
  std::string token;
  change([&](Json& kept) {
    if (!kept.contains("token") || !kept["token"].is_string() || !is_token(kept["token"])) kept["token"] = make_token();
    token = kept["token"];
  });
  return token;
}

std::optional<uint16_t> Kept::port() const {
  const Json kept = read();
  if (!kept.contains("port") || !kept["port"].is_number_unsigned() || kept["port"] > UINT16_MAX) return std::nullopt;
  return kept["port"].get<uint16_t>();
}

void Kept::keep_port(uint16_t port) const {
  change([port](Json& kept) { kept["port"] = port; });
}

Json Kept::settings() const {
  const Json all = read();
  return all.contains("settings") && all["settings"].is_object() ? all["settings"] : Json::object();
}

void Kept::add_commands(Router& router) const {
  add_settings(router, {[kept = *this] { return kept.settings(); },
                        [kept = *this](const std::function<void(Json&)>& act) {
                          return kept.change([&act](Json& all) {
                            if (!all.contains("settings") || !all["settings"].is_object()) all["settings"] = Json::object();
                            act(all["settings"]);
                          });
                        }});
}

}  // namespace ipos::tools::serve
