// What a person can keep of what happens on the page: a test of it, and the session as it stands. And tests that are run.
#include <fmt/format.h>

#include <cstring>
#include <memory>

#include "runtime/plant/trace_hash.hpp"
#include "tools/serve/host/kept_session.hpp"
#include "tools/serve/host/kept_test.hpp"
#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

constexpr size_t kMostReport = 4 * 1024 * 1024;  // bytes (ours)
constexpr size_t kMostPinned = 1000;

// Which outputs of a station have changed. What the first millisecond makes of those of a unit that was just switched on is
// where they begin (ours).
class ChangedOutputs final : private runtime::DriveWatcher {
 public:
  explicit ChangedOutputs(runtime::Station& station) : first_(station.outputs()) { station.add_watcher(*this); }
  uint32_t bits() const { return changed_; }

 private:
  void on_decided(const runtime::Drive& drive, runtime::Time tick) override {
    if (tick <= runtime::kMillisecond) first_ = drive.outputs();
    changed_ |= static_cast<uint32_t>(drive.outputs() ^ first_);
  }

  uint16_t first_;
  uint32_t changed_ = 0;
};

// A text that a copy of the host leaves behind.
class LeftText {
 public:
  explicit LeftText(Copies& copies) : memory_(room_for(copies, kMostReport)) {}
  void leave(const std::string& text) const {
    const uint64_t size = std::min(text.size(), kMostReport - sizeof(uint64_t));
    std::memcpy(memory_.get() + sizeof size, text.data(), size);
    std::memcpy(memory_.get(), &size, sizeof size);
  }
  std::string text() const {
    uint64_t size = 0;
    std::memcpy(&size, memory_.get(), sizeof size);
    return {reinterpret_cast<const char*>(memory_.get() + sizeof size), size};
  }

 private:
  Memory memory_;
};

class KeepTab final : public Tab {
 public:
  explicit KeepTab(PlantHost& host) : host_(host) {
    Router& router = host.router();
    router.add_command("keep.test", [this](const Router::Call& call) { return test(call.arguments); });
    router.add_command("session", [this](const Router::Call& call) { return session(call.arguments); });
    router.add_command("tests.run", [this](const Router::Call& call) { return run(call); });
  }

  void built(runtime::Plant& plant) override {
    outputs_.clear();
    for (const auto& station : plant.stations()) outputs_.push_back(std::make_unique<ChangedOutputs>(*station));
  }
  void tend() override {
    if (!running_) return;
    const auto result = running_->run->result();
    if (!result) return;
    const Running done = std::move(*running_);
    running_.reset();
    if (*result)
      answer(done.client, done.id, done.left.text());
    else
      host_.router().fail(done.client, done.id, "the tests came to no end");
  }
  // Another process goes on: it does not hear of them.
  Json save() override { return running_ ? Json{{"client", running_->client}, {"id", running_->id}} : Json(nullptr); }
  void load(const Json& state) override {
    running_.reset();
    if (state.is_object()) host_.router().fail(state["client"], state["id"], "time went back while the tests ran; run them again");
  }

 private:
  struct Running {
    uint16_t client;
    Json id;
    LeftText left;
    std::unique_ptr<SecondRun> run;
  };

  Json test(const Arguments& a) {
    std::vector<uint32_t> changed;
    for (const auto& outputs : outputs_) changed.push_back(outputs->bits());
    std::vector<std::string> pinned;
    if (a.has("pinned")) pinned = a.texts("pinned", kMostPinned);
    const KeptTest kept = keep_as_test(host_, pinned, changed);
    return {{"text", kept.text}, {"left_out", kept.left_out}};
  }

  // `settings`: of the page, which come back with it.
  Json session(const Arguments& a) {
    return {{"text", sessions::session_text(session_of(host_, a.has("settings") ? a.json()["settings"] : Json::object()))}};
  }

  // Those that are asked for, else all of the plant; beside the plant, where there are copies.
  Json run(const Router::Call& call) {
    if (running_) throw Mistake("the tests run already");
    std::vector<std::string> files;
    if (call.arguments.has("files")) files = call.arguments.texts("files", kMostPinned);
    for (const Files::Entry& entry : host_.files().list())
      if (entry.kind == Files::Kind::Test && !call.arguments.has("files")) files.push_back(entry.name);
    if (files.empty()) throw Mistake("there are no tests of this plant yet; Keep as test makes one");
    const LeftText left(host_.copies());
    const auto body = [this, files, left] { left.leave(report(files)); };
    auto second = host_.copies().beside(body);
    if (!second) {
      body();
      answer(call.client.number, call.id, left.text());
    } else {
      running_ = Running{call.client.number, call.id, left, std::move(second)};
    }
    return nullptr;
  }

  std::string report(const std::vector<std::string>& files) const {
    try {
      return host_.files().test(files);
    } catch (const std::exception& mistake) {
      return Json{{"error", mistake.what()}}.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
  }
  void answer(uint16_t client, const Json& id, const std::string& text) {
    const Json report = Json::parse(text, nullptr, false);
    if (!report.is_object())
      host_.router().fail(client, id, "the report of the tests is too long for the page; run ipos test");
    else if (report.contains("error") && report["error"].is_string())
      host_.router().fail(client, id, report["error"]);
    else
      host_.router().reply(client, id, {{"report", report}});
  }

  PlantHost& host_;
  std::vector<std::unique_ptr<ChangedOutputs>> outputs_;  // by station
  std::optional<Running> running_;
};

}  // namespace

std::unique_ptr<Tab> make_keep_tab(PlantHost& host) { return std::make_unique<KeepTab>(host); }

}  // namespace ipos::tools::serve
