// What a person can keep of what happens on the page: a test of it.
#include <memory>

#include "tools/serve/host/kept_test.hpp"
#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

// Which outputs of a station have changed.
class ChangedOutputs final : private runtime::DriveWatcher {
 public:
  explicit ChangedOutputs(runtime::Station& station) : first_(station.outputs()) { station.add_watcher(*this); }
  uint32_t bits() const { return changed_; }

 private:
  void on_decided(const runtime::Drive& drive, runtime::Time) override {
    changed_ |= static_cast<uint32_t>(drive.outputs() ^ first_);
  }

  uint16_t first_;
  uint32_t changed_ = 0;
};

class KeepTab final : public Tab {
 public:
  explicit KeepTab(PlantHost& host) : host_(host) {
    host.router().add_command("keep.test", [this](const Router::Call& call) { return test(call.arguments); });
  }

  void built(runtime::Plant& plant) override {
    outputs_.clear();
    for (const auto& station : plant.stations()) outputs_.push_back(std::make_unique<ChangedOutputs>(*station));
  }

 private:
  static constexpr size_t kMostPinned = 1000;

  Json test(const Arguments& a) {
    std::vector<uint32_t> changed;
    for (const auto& outputs : outputs_) changed.push_back(outputs->bits());
    std::vector<std::string> pinned;
    if (a.has("pinned")) pinned = a.texts("pinned", kMostPinned);
    const KeptTest kept = keep_as_test(host_, pinned, changed);
    return {{"text", kept.text}, {"left_out", kept.left_out}};
  }

  PlantHost& host_;
  std::vector<std::unique_ptr<ChangedOutputs>> outputs_;  // by station
};

}  // namespace

std::unique_ptr<Tab> make_keep_tab(PlantHost& host) { return std::make_unique<KeepTab>(host); }

}  // namespace ipos::tools::serve
