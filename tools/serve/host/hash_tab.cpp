// The command `hash`: the number of `ipos run --trace-hash` over what this plant has done up to now, with all that was done to
// it. A second run finds it, as a run that nobody asks for its hash is not slowed down by it.
#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

#include "runtime/plant/trace_hash.hpp"
#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

class HashTab final : public Tab {
 public:
  explicit HashTab(PlantHost& host) : host_(host) {
    host.router().add_command("hash", [this](const Router::Call& call) {
      if (!run_) {
        found_ = room_for(host_.copies(), sizeof(uint64_t));
        run_ = host_.run_again();
        if (!run_) throw Mistake("a plant with real ports does nothing a second time");
        end_ = host_.plant().now();
      }
      waiting_.emplace_back(call.client.number, call.id);
      return Json(nullptr);
    });
  }

  void tend() override {
    if (!run_) return;
    const std::optional<bool> ended = run_->result();
    if (!ended) return;
    run_.reset();
    for (const auto& [client, id] : std::exchange(waiting_, {})) {
      if (*ended)
        host_.router().reply(client, id, {{"hash", fmt::format("{:016x}", found())}, {"us", end_ / runtime::kMicrosecond}});
      else
        host_.router().fail(client, id, "the plant did not come to the same moment again");
    }
    found_.reset();
  }

  // --- in the second run ---
  void runs_again(Tab& first) override {
    HashTab& asked = static_cast<HashTab&>(first);
    if (!asked.found_) return;  // another tab wants it
    found_ = asked.found_;
    end_ = asked.host_.plant().now();
    repeats_ = true;
    built(host_.plant());
  }
  void built(runtime::Plant& plant) override {
    if (!repeats_) return;
    hash_.emplace(plant);
    note(plant.now());
  }
  // A run takes its first sample after the first millisecond, whatever happens at 0 s.
  void passed(runtime::Time now) override {
    if (!hash_ || now == 0) return;
    hash_->sample(now);
    note(now);
  }

 private:
  uint64_t& found() const { return *reinterpret_cast<uint64_t*>(found_.get()); }
  void note(runtime::Time now) {
    if (now == end_) found() = hash_->value();
  }

  PlantHost& host_;
  Memory found_;  // seen by both
  std::unique_ptr<SecondRun> run_;
  runtime::Time end_ = 0;
  std::vector<std::pair<uint16_t, Json>> waiting_;
  bool repeats_ = false;
  std::optional<runtime::TraceHash> hash_;
};

}  // namespace

std::unique_ptr<Tab> make_hash_tab(PlantHost& host) { return std::make_unique<HashTab>(host); }

}  // namespace ipos::tools::serve
