// Time, record and restoring.
#include "runtime/library/session.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace ipos::library {

tl::expected<std::unique_ptr<Session>, Mistakes> Session::open(Contents contents, bool recorded) {
  auto plant = contents.build();
  if (!plant) return tl::unexpected(std::move(plant).error());
  return std::unique_ptr<Session>(new Session(std::move(contents), *std::move(plant), recorded));
}

Session::Session(Contents contents, std::unique_ptr<runtime::Plant> plant, bool recorded)
    : contents_(std::move(contents)),
      instance_(std::make_unique<Instance>(std::move(plant))),
      recorded_(recorded) {}

bool Session::run_until(Time limit, const std::function<bool()>& condition) {
  if (condition()) return true;
  bool met = false;
  plant().run_until(limit, [&](Time) {
    met = condition();
    return !met;
  });
  return met;
}

// What was refused may have left something behind, a reason or a count: it is part of the record like the rest.
Refusal Session::perform(Action action) {
  action.at = plant().now();
  Refusal refused = instance_->perform(action);
  if (recorded_) record_.push_back(std::move(action));
  return refused;
}

Refusal Session::write(const SignalId& id, const signals::Signal& signal, int64_t value) {
  const Time now = plant().now();
  Refusal refused = instance_->set(signal, value);
  if (recorded_) record_.push_back({.at = now, .act = Act::Write, .signal = id, .value = value});
  return refused;
}

uint32_t Session::add_signal(const SignalId& id, std::string_view name) {
  const auto known = std::find_if(signals_.begin(), signals_.end(),
                                  [&](const Signal& signal) { return signal.id == id && signal.name == name; });
  const auto number = static_cast<uint32_t>(known - signals_.begin());
  if (known == signals_.end()) find_again(signals_.emplace_back(Signal{id, std::string(name), {}}));
  return number;
}

// Its reader looks into the instance of now.
void Session::find_again(Signal& signal) const { signal.shown = signal_of(plant(), signal.id, signal.name).value(); }

int64_t Session::read(const Signal& signal) {
  return signal.id.kind == Kind::Analog ? now(signal).read() : signal.shown.read();
}

std::vector<uint8_t> Session::save() const {
  assert(recorded_);
  return to_bytes(contents_.identity(), plant().now(), runtime::state_digest(plant()), record_);
}

// Signals read in the instance that is entered; `instance` takes the one that is left.
void Session::enter(std::unique_ptr<Instance>& instance) {
  std::swap(instance_, instance);
  for (Signal& signal : signals_) find_again(signal);
}

Session::Restored Session::restore(std::span<const uint8_t> bytes, std::string& why,
                                   const std::function<void()>& look) {
  auto saved = from_bytes(bytes);
  if (!saved) {
    why = saved.error();
    return Restored::Damaged;
  }
  if (saved->identity != contents_.identity()) {
    why = "the state was saved in a plant of another file, other programs or other options";
    return Restored::OtherPlant;
  }
  auto plant = contents_.build();
  if (!plant) {
    why = plant.error().front().text;
    return Restored::Damaged;
  }
  auto instance = std::make_unique<Instance>(*std::move(plant));
  enter(instance);
  std::function<bool(Time)> watch;
  if (look)
    watch = [&look](Time now) {
      if (now % runtime::kMillisecond == 0) look();
      return true;
    };
  if (look) look();
  uint32_t tags = 0;
  for (const Action& action : saved->actions) {
    this->plant().run_until(action.at, watch);
    instance_->perform(action);
    if (action.act == Act::Send) tags = std::max(tags, static_cast<uint32_t>(action.value));
  }
  this->plant().run_until(saved->time, watch);
  if (runtime::state_digest(this->plant()) != saved->digest) {
    enter(instance);
    why = "the run that was saved comes to another state here: a memory file or the library has changed";
    return Restored::Damaged;
  }
  record_ = std::move(saved->actions);
  tags_ = tags;
  shadow_.reset();
  return Restored::Done;
}

Refusal Session::restart() {
  if (contents_.writes_memory()) return "it writes the memories of its units: a new beginning would find in them what they hold now";
  auto plant = contents_.build();
  if (!plant) return plant.error().front().text;
  auto instance = std::make_unique<Instance>(*std::move(plant));
  enter(instance);
  record_.clear();
  tags_ = 0;
  shadow_.reset();
  return std::nullopt;
}

uint64_t Session::trace_hash() {
  if (!shadow_) shadow_ = std::make_unique<Shadow>(*contents_.build());
  const auto run = [this](Time until) {
    if (shadow_->instance.plant().now() == until) return;
    shadow_->instance.plant().run_until(until, [this](Time now) {
      shadow_->hash.sample(now);
      return true;
    });
  };
  for (; shadow_->done < record_.size(); ++shadow_->done) {
    const Action& action = record_[shadow_->done];
    run(action.at);
    shadow_->instance.perform(action);
  }
  run(plant().now());
  return shadow_->hash.value();
}

}  // namespace ipos::library
