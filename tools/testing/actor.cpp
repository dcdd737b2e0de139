// Steps.
#include "tools/testing/actor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/signals/find.hpp"

namespace ipos::tools::testing {

using runtime::kMillisecond;

Actor::Actor(runtime::Plant& plant, const std::vector<Item>& items, uint64_t seed, Problem on_problem)
    : plant_(plant), actions_(plant, "a test"), seed_(seed), on_problem_(std::move(on_problem)) {
  for (const Item& item : items)
    if (const auto* step = std::get_if<Step>(&item.what))
      if (const auto* send = std::get_if<SendStep>(step)) plant.find_bus(send->bus)->attach_hand();
}

runtime::Station& Actor::station(const std::string& name) {
  return **std::find_if(plant_.stations().begin(), plant_.stations().end(),
                        [&](const auto& station) { return station->config().name == name; });
}

void Actor::plan(const Item& item, const Step& step, Time at) {
  // What holds longer than a moment is a stimulus of the plant.
  if (const auto* stimulus = std::get_if<runtime::Stimulus>(&step)) {
    std::string why;
    const auto signal = signals::find_signal(plant_, stimulus->signal, why);
    if (!signal) return on_problem_(item, why);
    if (stimulus->action != runtime::Stimulus::Action::Set || stimulus->every != 0) {
      runtime::Stimulus timed = *stimulus;
      timed.at = at;
      return plant_.surroundings().add(*signal, timed);
    }
  }
  plant_.surroundings().act(at, [this, &item, &step, at] {
    std::optional<std::string> problem;
    if (const auto* stimulus = std::get_if<runtime::Stimulus>(&step)) problem = set(*stimulus);
    if (const auto* words = std::get_if<ProcessDataStep>(&step)) set_word(*words);
    if (const auto* send = std::get_if<SendStep>(&step))
      problem = plant_.find_bus(send->bus)->send(send->text);
    if (const auto* fault = std::get_if<runtime::FaultConfig>(&step)) problem = plant_fault(*fault, at);
    if (const auto* fault = std::get_if<DriveFaultStep>(&step))
      station(fault->station).drive().state().raise_fault(fault->number);
    if (const auto* program = std::get_if<ProgramStep>(&step)) problem = runtime::PlantActions::order(station(program->station), program->action);
    if (const auto* power = std::get_if<PowerStep>(&step)) plant_.set_power(power->station, power->on);
    if (problem) on_problem_(item, *problem);
  });
}

runtime::Refusal Actor::set(const runtime::Stimulus& stimulus) {
  std::string why;
  return actions_.set(*signals::find_signal(plant_, stimulus.signal, why), stimulus.value);
}

void Actor::set_word(const ProcessDataStep& step) {
  const auto word = signals::find_in_group(station(step.station), signals::Group::ProcessData, step.word).value();
  if (step.action != ProcessDataStep::Action::Force) actions_.release(word);
  if (step.action == ProcessDataStep::Action::Set) actions_.set(word, step.value);
  if (step.action == ProcessDataStep::Action::Force) actions_.force(word, step.value);
}

runtime::Refusal Actor::plant_fault(runtime::FaultConfig fault, Time at) {
  fault.begin_at(0, seed_);
  return actions_.plant_fault(std::move(fault), at);
}

}  // namespace ipos::tools::testing
