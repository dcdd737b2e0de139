// What a worker of a browser calls of ipos: a host of a plant, or of the gallery, that takes messages and gives messages. The
// verbs are main(), as on a command line. Files are those of emscripten in memory; what of them is kept, and where, is the
// worker's matter (web/src/alone).
#include <emscripten.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plant_file/plant_file.hpp"
#include "tools/cli/end_of_process.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/folder_plant.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/serve/gallery_host.hpp"
#include "tools/serve/host/plant_host.hpp"
#include "tools/serve/host/settings.hpp"
#include "tools/serve/language.hpp"
#include "tools/serve/opened_session.hpp"
#include "tools/serve/plant_files.hpp"

// A message of the host for one of its clients. Bytes are gone when this returns.
EM_JS(void, ipos_give, (int kind, int client, const char* body, size_t size), {
  Module["take"](kind, client, HEAPU8.subarray(body, body + size));
});

namespace ipos::tools::browser {
namespace {

class Out final : public serve::Outbox {
 public:
  bool send(serve::MessageKind kind, uint16_t client, std::string_view body) override {
    ipos_give(static_cast<int>(kind), client, body.data(), body.size());
    return true;
  }
};

class BrowserClock final : public serve::Clock {
 public:
  serve::WallClock::time_point now() const override { return serve::WallClock::now(); }
};

// Each plant has its own, as with `ipos serve`; below the folder that the worker keeps.
serve::SettingsPlace settings_of(const std::string& plant) {
  const std::string file = "/home/.kept" + std::filesystem::absolute(plant).string() + ".json";
  const auto read = [file] {
    serve::Json settings = serve::Json::parse(try_read_file(file).value_or("{}"), nullptr, false);
    return settings.is_object() ? settings : serve::Json::object();
  };
  return {read,
          [file, read](const std::function<void(serve::Json&)>& act) {
            serve::Json settings = read();
            act(settings);
            std::error_code error;
            std::filesystem::create_directories(std::filesystem::path(file).parent_path(), error);
            std::ofstream(file) << settings.dump(-1, ' ', false, serve::Json::error_handler_t::replace);
            return true;
          }};
}

// A host and what is around it.
struct Hosted {
  std::unique_ptr<const serve::OpenedSession> session;
  std::optional<sessions::OfTest> test;
  Out out;
  BrowserClock clock;
  serve::Copies copies;
  serve::Ports ports;
  serve::PlantFiles files;
  serve::LanguageServer language;
  serve::PlantHost host;

  // `opened`: the session that has the plant, if one was opened. `keeps`: what was set on the page is found again.
  Hosted(PlantInput input, std::unique_ptr<const serve::OpenedSession> opened, bool keeps = true)
      : session(std::move(opened)),
        test(session ? session->beside() : std::nullopt),
        files(input.path, {}, session && session->is_unpacked() ? serve::kFilesOfSession : "", test),
        language({}),
        host(test ? serve::debuggee_of(*test, {}) : debug::Debuggee([input] { return make_plant(input, runtime::FileUse::Look); }),
             std::filesystem::path(input.path).filename().string(), IPOS_VERSION, {out, clock, copies, ports, files, language}) {
    const serve::SettingsPlace place = settings_of(session ? session->path() : input.path);
    serve::add_settings(host.router(), place);
    if (session) session->resume(host);
    if (keeps) host.restore(place.read());
  }
};

constexpr std::string_view kStandIn = "[[station]]\nname = \"none\"\nunit = \"mdxb\"\n";

// The plants of the folders below the one we are in.
std::vector<std::string> plants_below() {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(".")) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_directory() || name.starts_with('.')) continue;
    for (const std::string& plant : plants_in(name)) all.push_back(plant);
  }
  std::sort(all.begin(), all.end());
  return all;
}

struct Gallery {
  Out out;
  BrowserClock clock;
  serve::GalleryHost host{out, clock, {IPOS_VERSION, "", plants_below, [](const std::string& path) { read_plant_input(path, {}); }}};

  Gallery() { serve::add_settings(host.router(), settings_of(".")); }
};

// One of them, or none.
std::unique_ptr<Hosted> hosted;
std::unique_ptr<Gallery> gallery;

void close() {
  hosted.reset();
  gallery.reset();
}

}  // namespace
}  // namespace ipos::tools::browser

namespace browser = ipos::tools::browser;
namespace serve = ipos::tools::serve;

extern "C" {

// Of a plant, a program or a session. 0, or the exit code of what stands on standard error then.
EMSCRIPTEN_KEEPALIVE int ipos_open(const char* path) {
  browser::close();
  return ipos::tools::end_of_process([path] {
    auto session = serve::is_session(path) ? std::make_unique<const serve::OpenedSession>(path) : nullptr;
    ipos::tools::PlantInput input;
    if (session && session->beside())
      input.path = session->plant();  // the test makes it
    else
      input = ipos::tools::read_plant_input(session ? session->plant() : path, {});
    browser::hosted = std::make_unique<browser::Hosted>(std::move(input), std::move(session));
    return 0;
  });
}

// Of a plant or a program with mistakes: a unit that does nothing stands in for it, with its files in the editor. The first build
// that is good takes its place at a restart.
EMSCRIPTEN_KEEPALIVE int ipos_open_to_mend(const char* path) {
  browser::close();
  return ipos::tools::end_of_process([path] {
    ipos::tools::PlantInput input{path, ipos::runtime::read_plant_file(browser::kStandIn).plant, {std::nullopt}};
    browser::hosted = std::make_unique<browser::Hosted>(std::move(input), nullptr, false);
    return 0;
  });
}

// That of the folder we are in.
EMSCRIPTEN_KEEPALIVE int ipos_open_gallery() {
  browser::close();
  return ipos::tools::end_of_process([] {
    browser::gallery = std::make_unique<browser::Gallery>();
    return 0;
  });
}

EMSCRIPTEN_KEEPALIVE void ipos_take(int kind, int client, const char* body, size_t size) {
  serve::Message message;
  message.kind = static_cast<serve::MessageKind>(kind);
  message.client = static_cast<uint16_t>(client);
  message.body.assign(body, size);
  message.arrived = serve::WallClock::now();
  if (browser::hosted) browser::hosted->host.take(message);
  if (browser::gallery) browser::gallery->host.take(message);
}

// Some milliseconds of the plant. In how many of the clock's the next turn is due.
EMSCRIPTEN_KEEPALIVE double ipos_turn() {
  using Milliseconds = std::chrono::duration<double, std::milli>;
  constexpr double kLongest = 100;  // then the tabs have their turn
  if (!browser::hosted) return kLongest;
  const auto due = browser::hosted->host.turn();
  const auto now = browser::hosted->clock.now();
  if (due <= now) return 0;
  return due - now > std::chrono::milliseconds(100) ? kLongest : Milliseconds(due - now).count();
}
}
