// Planned are the [[stimulus]] and the [[fault]] of the plant file; a fault that ends is planned twice.
#include "tools/serve/host/story.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/signals/find.hpp"
#include "tools/cli/head_story.hpp"
#include "tools/serve/host/line_faults.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::kMicrosecond;
using runtime::Stimulus;

std::string act_text(const runtime::Plant& plant, Stimulus stimulus) {
  std::string text = stimulus.signal.station + "." + stimulus.signal.name;
  if (stimulus.action == Stimulus::Action::Release) return text + " is released";
  std::string why;
  const auto signal = signals::find_target(plant, stimulus, why);
  text += " = " + (signal ? signal->words(stimulus.value) : std::to_string(stimulus.value));
  if (stimulus.length != 0) text += fmt::format(" for {} ms", stimulus.length / runtime::kMillisecond);
  if (stimulus.action == Stimulus::Action::Force) text += ", forced";
  return text;
}

}  // namespace

std::string story_of(PlantHost& host) {
  const auto files = host.files().list();
  const auto plant = std::find_if(files.begin(), files.end(),
                                  [](const Files::Entry& entry) { return entry.kind == Files::Kind::Plant; });
  return plant == files.end() ? "" : head_story(host.files().text(plant->name).value_or(""));
}

Json planned_acts(const runtime::Plant& plant) {
  Json all = Json::array();
  for (const Stimulus& stimulus : plant.file().stimuli)
    all.push_back({{"us", stimulus.at / kMicrosecond},
                   {"every_us", stimulus.every / kMicrosecond},
                   {"times", stimulus.times},
                   {"text", act_text(plant, stimulus)}});
  const auto add = [&](runtime::Time at, std::string text) {
    all.push_back({{"us", at / kMicrosecond}, {"every_us", 0}, {"times", 1}, {"text", std::move(text)}});
  };
  for (const runtime::FaultConfig& fault : plant.file().faults) {
    const auto [from, until] = LineFaults::times(fault);
    std::string text = fmt::format("{}: {}{}{}", fault.bus, LineFaults::word(fault), fault.station.empty() ? "" : " at ", fault.station);
    if (until != runtime::kNever) add(until, text + " ends");
    add(from, std::move(text));
  }
  return all;
}

}  // namespace ipos::tools::serve
