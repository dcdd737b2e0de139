// What was built takes the place of what runs: by a restart of the plant, or as a download into one of its drives.
#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "tools/serve/host/plant_host.hpp"
#include "tools/serve/host/tabs.hpp"
#include "vm/image/image.hpp"

namespace ipos::tools::serve {
namespace {

std::string version_of_all(const Texts& texts) {
  std::string all;
  for (const auto& [file, text] : texts) all += fmt::format("{}:{}:", file, text.size()) + text;
  return version_of(all);
}

}  // namespace

// What a person forces stays so; what else was done to the plant is forgotten.
void PlantHost::restart() {
  std::vector<Json> forced;
  for (const signals::Hold& hold : plant_->surroundings().holds().all())
    if (hold.by == kPerson && hold.until == runtime::kNever)
      forced.push_back({{"name", hold.signal.name}, {"value", hold.value}});
  const RunningTexts before = texts_;
  try {
    std::optional<debug::Debuggee> next;
    if (offered_) {
      next = offered().make;
      texts_.restarted(build_->texts);
    }
    for (const auto& tab : tabs_) tab->restarted();
    debugger_->restart(std::move(next));
    cost_.begin(*debugger_);
  } catch (const std::runtime_error& mistake) {  // the old plant goes on
    texts_ = before;
    const Motion failed = std::exchange(now_, {});
    new_generation();
    router_.fail(failed.client, failed.id, mistake.what());
    return tell_time();
  }
  build_.reset();
  const bool rebuilt = std::exchange(offered_, std::nullopt).has_value();
  for (Json& hold : forced) {
    const std::string name = hold["name"];
    try {
      act("force", std::move(hold));
    } catch (const std::runtime_error& mistake) {
      output(fmt::format("{} is not forced any more: {}\n", name, mistake.what()));
    }
  }
  finish({debug::Reason::Step, {}, {}, {}});
  if (rebuilt) router_.send_all({{"event", "rebuilt"}});
}

void PlantHost::offer(Build build) {
  offered_ = version_of_all(build.texts);
  build_ = std::move(build);
}

// A copy that goes on from an earlier moment does not have it.
const Build& PlantHost::offered() {
  if (!offered_) throw Mistake("nothing was built since the plant began; save and build first");
  if (!build_) {
    Build again = files_.build();
    if (!again.good() || version_of_all(again.texts) != *offered_) {
      offered_.reset();
      throw Mistake("the files have changed since they were built; build again");
    }
    build_ = std::move(again);
  }
  return *build_;
}

// `image` and `texts` are of the program, so that it is loaded again when its moment comes again, in whatever copy.
void PlantHost::load_program(const Arguments& a) {
  const uint32_t number = station_number(a.text("station"));
  const auto& bytes = a.json()["image"].get_binary();
  vm::ImageResult read = vm::read_image(bytes);
  if (read.error != vm::ImageError::None) throw Mistake("the program is damaged");
  if (const auto refused = plant_->stations()[number]->load_program(std::move(read.image))) throw Mistake(*refused);
  texts_.loaded(number, a.json()["texts"].get<Texts>());
  debugger_->program_changed(number);
  for (const auto& tab : tabs_) tab->loaded(number);
}

}  // namespace ipos::tools::serve
