// The files of the plant: which there are, reading, writing, what a language server says of the texts in the editor.
#include <fmt/format.h>

#include <algorithm>

#include "stdlib/unit_types.hpp"
#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

constexpr auto kListed = std::chrono::seconds(1);  // a list is as new as that

std::string_view word_of(Files::Kind kind) {
  switch (kind) {
    case Files::Kind::Plant: return "plant";
    case Files::Kind::Program: return "program";
    case Files::Kind::Include: return "include";
    case Files::Kind::Test: return "test";
    case Files::Kind::Session: break;
  }
  return "session";
}

class FilesTab final : public Tab {
 public:
  explicit FilesTab(PlantHost& host) : host_(host) {
    Router& router = host.router();
    router.add_command("files", [this](const Router::Call&) {
      Json files = Json::array();
      list_.clear();
      for (const Files::Entry& entry : list()) files.push_back(json_of(entry));
      return Json{{"files", std::move(files)}, {"build", state()}};
    });
    router.add_command("file.read", [this](const Router::Call& call) { return read(call.arguments); });
    router.add_command("file.write", [this](const Router::Call& call) { return write(call.arguments); });
    router.add_command("build", [this](const Router::Call&) { return build(); });
    router.add_command("load", [this](const Router::Call& call) { return download(call.arguments); });
    router.add_topic("files", [this](Client& client, Subscription& subscription) { publish(client, subscription); });
    router.add_command("language", [this](const Router::Call& call) { return ask(call.arguments); });
  }

  Json save() override { return {{"good", good_}, {"messages", messages_}}; }
  void load(const Json& state) override {
    good_ = state["good"];
    messages_ = state["messages"];
    list_.clear();
  }

 private:
  static Json json_of(const Files::Entry& entry) {
    return {{"name", entry.name}, {"kind", word_of(entry.kind)}, {"uri", entry.uri}, {"read_only", entry.read_only}};
  }

  const std::vector<Files::Entry>& list() {
    const auto now = host_.router().clock().now();
    if (list_.empty() || now - listed_ > kListed) {
      list_ = host_.files().list();
      listed_ = now;
    }
    return list_;
  }

  Json read(const Arguments& a) {
    const std::string name = a.text("name");
    const auto text = host_.files().text(name);
    if (!text) throw Mistake(fmt::format("{} is none of the plant's files, or it is not there", name));
    const auto& all = list();
    const auto known = std::find_if(all.begin(), all.end(), [&](const Files::Entry& one) { return one.name == name; });
    Json file = known != all.end() ? json_of(*known) : Json{{"name", name}, {"kind", "include"}, {"uri", ""}, {"read_only", "it is none of the plant's files"}};
    if (Json(*text).dump(-1, ' ', false, Json::error_handler_t::ignore) !=
        Json(*text).dump(-1, ' ', false, Json::error_handler_t::replace))
      file["read_only"] = "it is not UTF-8, and would be another file after it was saved here";
    file["text"] = *text;
    file["version"] = version_of(*text);
    return file;
  }

  // `version`: of the text that the editor began with.
  Json write(const Arguments& a) {
    const std::string name = a.text("name");
    const std::string text = a.text("text");
    if (!a.flag("over", false)) {
      const auto now = host_.files().text(name);
      const std::string version = now ? version_of(*now) : "";
      if (now && version != version_of(text) && version != a.text("version", ""))
        throw Mistake(fmt::format("{} has changed since it was opened here; take the changed file, or save over it", name));
    }
    const std::string place = host_.files().write(name, text);
    list_.clear();
    return {{"name", place}, {"version", version_of(text)}};
  }

  // What the last build has to say, and whether something waits for a restart or for being loaded.
  Json state() const { return {{"good", good_}, {"messages", messages_}, {"waits", host_.offers()}}; }

  Json build() {
    Build build = host_.files().build();
    good_ = build.good();
    messages_ = Json::array();
    for (const Told& one : build.messages)
      messages_.push_back({{"severity", one.severity}, {"file", one.file}, {"line", one.line}, {"column", one.column},
                           {"text", one.text}, {"code", one.code}});
    if (good_) host_.offer(std::move(build));
    Json event = state();
    event["event"] = "build";
    host_.router().send_all(event);
    return state();
  }

  // As a download to the drive: its program begins anew, the variables and the drive stay as they are.
  Json download(const Arguments& a) {
    const std::string name = a.text("station");
    const runtime::Station& station = host_.station(name);
    const Build& build = host_.offered();
    const auto at = std::find(build.stations.begin(), build.stations.end(), name);
    const auto row = static_cast<size_t>(at - build.stations.begin());
    if (at == build.stations.end() || !build.programs[row])
      throw Mistake(fmt::format("{} has no program in what was built; restart", name));
    const vm::Image& image = *build.programs[row];
    if (stdlib::find_unit(image.unit) != station.config().unit)
      throw Mistake(fmt::format("{} is another unit in what was built; restart", name));
    host_.act("load", {{"station", name}, {"image", Json::binary(vm::write_image(image))}, {"texts", build.texts}});
    host_.router().refresh();
    return Json::object();
  }

  // The versions of all of them as they are now, so that an editor hears of changes outside.
  void publish(Client& client, Subscription& subscription) {
    Json versions = Json::object();
    for (const Files::Entry& entry : list())
      if (const auto text = host_.files().text(entry.name)) versions[entry.name] = version_of(*text);
    if (subscription.is_news("files", versions))
      host_.router().send(client, {{"event", "files"}, {"versions", std::move(versions)}});
  }

  // The programs and the plant are there with every question: a header is looked at in its program, a test in its plant.
  Json ask(const Arguments& a) {
    Texts texts;
    for (const Files::Entry& entry : list())
      if (entry.kind == Files::Kind::Program || entry.kind == Files::Kind::Plant)
        if (auto text = host_.files().text(entry.name)) texts[entry.uri] = std::move(*text);
    if (a.has("texts")) {
      const Json& given = a.json()["texts"];
      if (!given.is_object()) throw Mistake("'texts' is an object: a text by its uri");
      for (const auto& [uri, text] : given.items()) {
        if (!text.is_string()) throw Mistake("'texts' is an object: a text by its uri");
        texts[uri] = text.get<std::string>();
      }
    }
    const Json params = a.has("params") ? a.json()["params"] : Json::object();
    return {{"result", host_.language().answer(a.text("method"), params, texts)}};
  }

  PlantHost& host_;
  bool good_ = true;
  Json messages_ = Json::array();
  std::vector<Files::Entry> list_;
  WallClock::time_point listed_{};
};

}  // namespace

std::unique_ptr<Tab> make_files_tab(PlantHost& host) { return std::make_unique<FilesTab>(host); }

}  // namespace ipos::tools::serve
