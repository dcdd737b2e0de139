// What a worker of a browser calls of ipos: a host of a plant that takes messages and gives messages. The verbs are main(), as on a command line. Files are those of emscripten in memory; what of them is kept, and where, is the
// worker's matter (web/src/worker).
#include <emscripten.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>

#include "tools/cli/end_of_process.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/serve/host/plant_host.hpp"
#include "tools/serve/host/settings.hpp"
#include "tools/serve/language.hpp"
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
  Out out;
  BrowserClock clock;
  serve::Copies copies;
  serve::Ports ports;
  serve::PlantFiles files;
  serve::LanguageServer language;
  serve::PlantHost host;

  explicit Hosted(PlantInput input)
      : files(input.path, {}),
        language({}),
        host([input] { return make_plant(input, runtime::FileUse::Look); },
             std::filesystem::path(input.path).filename().string(), IPOS_VERSION, {out, clock, copies, ports, files, language}) {
    const serve::SettingsPlace place = settings_of(input.path);
    serve::add_settings(host.router(), place);
    host.restore(place.read());
  }
};

std::unique_ptr<Hosted> hosted;

}  // namespace
}  // namespace ipos::tools::browser

namespace browser = ipos::tools::browser;

extern "C" {

// 0, or the exit code of what stands on standard error then.
EMSCRIPTEN_KEEPALIVE int ipos_open(const char* path) {
  browser::hosted.reset();
  return ipos::tools::end_of_process([path] {
    browser::hosted = std::make_unique<browser::Hosted>(ipos::tools::read_plant_input(path, {}));
    return 0;
  });
}

EMSCRIPTEN_KEEPALIVE void ipos_close() { browser::hosted.reset(); }

EMSCRIPTEN_KEEPALIVE void ipos_take(int kind, int client, const char* body, size_t size) {
  if (!browser::hosted) return;
  ipos::tools::serve::Message message;
  message.kind = static_cast<ipos::tools::serve::MessageKind>(kind);
  message.client = static_cast<uint16_t>(client);
  message.body.assign(body, size);
  message.arrived = browser::hosted->clock.now();
  browser::hosted->host.take(message);
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
