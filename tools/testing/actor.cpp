// Steps.
#include "tools/testing/actor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/signals/find.hpp"

namespace ipos::tools::testing {

using runtime::kMillisecond;

Actor::Actor(runtime::Plant& plant, const TestCase& test, uint64_t seed, Problem on_problem)
    : plant_(plant),
      actions_(plant, "a test"),
      by_hand_(test.by_hand),
      seed_(seed),
      on_problem_(std::move(on_problem)),
      planted_(plant.file().faults) {
  if (by_hand_) return;
  for (const Item& item : test.items)
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
    runtime::Stimulus timed = *stimulus;
    const auto signal = signals::find_target(plant_, timed, why);
    if (!signal) return on_problem_(item, why);
    if (stimulus->action != runtime::Stimulus::Action::Set || stimulus->every != 0) {
      timed.at = at;
      return plant_.surroundings().add(*signal, timed);
    }
  }
  plant_.surroundings().act(at, [this, &item, &step, at] { act(item, step, at); });
}

// What repeats or ends by itself is left to the surroundings, and so is power: the page does the same.
void Actor::act_by_hand(const Item& item, const Step& step, Time at) {
  using Act = runtime::Stimulus::Action;
  const auto* stimulus = std::get_if<runtime::Stimulus>(&step);
  if (std::holds_alternative<PowerStep>(step) ||
      (stimulus != nullptr && (stimulus->every != 0 || stimulus->action == Act::Pulse)))
    return plan(item, step, at);
  act(item, step, at);
}

void Actor::act(const Item& item, const Step& step, Time at) {
  std::optional<std::string> problem;
  if (const auto* stimulus = std::get_if<runtime::Stimulus>(&step)) problem = apply(*stimulus);
  if (const auto* words = std::get_if<ProcessDataStep>(&step)) set_word(*words);
  if (const auto* send = std::get_if<SendStep>(&step)) {
    runtime::Bus& bus = *plant_.find_bus(send->bus);
    bus.attach_hand();
    problem = bus.send(send->text);
  }
  if (const auto* fault = std::get_if<runtime::FaultConfig>(&step)) problem = plant_fault(*fault, at);
  if (const auto* ended = std::get_if<RepairStep>(&step)) problem = repair(ended->fault);
  if (const auto* fault = std::get_if<DriveFaultStep>(&step))
    station(fault->station).drive().state().raise_fault(fault->number);
  if (const auto* reset = std::get_if<ResetStep>(&step)) station(reset->station).drive().state().reset_fault();
  if (const auto* program = std::get_if<ProgramStep>(&step))
    problem = runtime::PlantActions::order(station(program->station), program->action);
  if (const auto* power = std::get_if<PowerStep>(&step)) plant_.set_power(power->station, power->on);
  if (problem) on_problem_(item, *problem);
}

runtime::Refusal Actor::apply(runtime::Stimulus stimulus) {
  using Act = runtime::Stimulus::Action;
  std::string why;
  const auto signal = signals::find_target(plant_, stimulus, why);
  if (!signal) return why;
  if (stimulus.action == Act::Force) return actions_.force(*signal, stimulus.value, stimulus.length);
  if (stimulus.action != Act::Release) return actions_.set(*signal, stimulus.value);
  actions_.release(*signal);
  return std::nullopt;
}

void Actor::set_word(const ProcessDataStep& step) {
  const auto word = signals::find_in_group(station(step.station), signals::Group::ProcessData, step.word).value();
  using Act = ProcessDataStep::Action;
  // On the page a word that is forced comes again.
  if (step.action == Act::Release || (step.action == Act::Set && !by_hand_)) actions_.release(word);
  if (step.action == Act::Set) actions_.set(word, step.value);
  if (step.action == Act::Force) actions_.force(word, step.value);
}

runtime::Refusal Actor::plant_fault(runtime::FaultConfig fault, Time at) {
  fault.begin_at(0, seed_);
  if (auto refused = actions_.plant_fault(fault, at)) return refused;
  fault.begin_at(at, 0);
  planted_.push_back(std::move(fault));
  return std::nullopt;
}

// The last one of the same place and kind.
runtime::Refusal Actor::repair(const runtime::FaultConfig& fault) {
  const auto known = std::find_if(planted_.rbegin(), planted_.rend(), [&](const runtime::FaultConfig& other) {
    return runtime::are_alike(fault, other) && runtime::is_active(other, plant_.now());
  });
  if (known == planted_.rend()) return "there is no such fault to repair";
  if (!plant_.repair_fault(*known)) return "the end of this fault is set already";
  planted_.erase(std::next(known).base());
  return std::nullopt;
}

}  // namespace ipos::tools::testing
