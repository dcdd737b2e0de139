// Wires and switches first, then what is due, then what is held.
#include "runtime/plant/surroundings.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime {

void Surroundings::connect(const PlantFile& file, const std::vector<std::unique_ptr<Station>>& stations,
                           std::vector<PlantError>& errors) {
  const auto find = [&](const Signal& signal, FilePlace place) {
    std::string why;
    const auto port = signals::SignalPort::find(stations, signal, why);
    if (!why.empty()) errors.push_back({place, why});
    return port;
  };
  for (const Wire& wire : file.wires) {
    const auto from = find(wire.from, wire.place);
    const auto to = find(wire.to, wire.place);
    if (from && to) leads_.push_back({*from, *to, wire.invert});
  }
  for (const PositionSwitch& row : file.switches)
    if (const auto input = find(row.input, row.place))
      for (const auto& station : stations)
        if (station->config().name == row.input.station)
          cams_.push_back({*input, station.get(), row.from, row.to, row.active_high});
  for (const Stimulus& stimulus : file.stimuli)
    if (const auto port = find(stimulus.signal, stimulus.place)) {
      due_.emplace(stimulus.at, Due{scripts_.size(), 0, {}});
      scripts_.push_back({*port, stimulus});
    }
}

void Surroundings::start() { wake(queue_.now()); }

void Surroundings::add(const signals::SignalPort& port, const Stimulus& stimulus) {
  due_.emplace(stimulus.at, Due{scripts_.size(), 0, {}});
  scripts_.push_back({port, stimulus});
  schedule_next(queue_.now());
}

void Surroundings::act(Time at, std::function<void()> action) {
  due_.emplace(at, Due{0, 0, std::move(action)});
  schedule_next(queue_.now());
}

// The earlier of this time and what was scheduled.
void Surroundings::wake(Time at) {
  if (at >= event_at_) return;
  if (event_at_ != kNever) queue_.cancel(event_);
  event_at_ = at;
  event_ = queue_.schedule(at, source_, *this, 0);
}

void Surroundings::on_event(Time now, uint32_t /*kind*/, uint64_t /*argument*/) {
  event_at_ = kNever;
  for (const Lead& lead : leads_) lead.to.drive((lead.from.read() != 0) != lead.invert ? 1 : 0);
  for (const Cam& cam : cams_) {
    const int32_t position = cam.station->shaft_position();
    const bool within = position >= cam.from && position <= cam.to;
    cam.input.drive(within == cam.active_high ? 1 : 0);
  }
  while (!due_.empty() && due_.begin()->first <= now) {
    const Time at = due_.begin()->first;
    const Due due = std::move(due_.begin()->second);
    due_.erase(due_.begin());
    if (due.action)
      due.action();
    else if (due.ends != 0)
      release(scripts_[due.script].port, due.ends);
    else
      perform(at, due.script);
  }
  for (const Hold& held : holds_)
    if (held.port.read() != held.value) write(now, held.port, held.value);
  schedule_next(now);
}

void Surroundings::perform(Time now, size_t script) {
  Script& s = scripts_[script];
  const Stimulus& stimulus = s.stimulus;
  switch (stimulus.action) {
    case Stimulus::Action::Set:
      if (s.port.is_input())
        s.port.line().set = stimulus.value;
      else
        write(now, s.port, stimulus.value);
      break;
    case Stimulus::Action::Force:
    case Stimulus::Action::Pulse: hold(now, script); break;
    case Stimulus::Action::Release: release(s.port, 0); break;
  }
  ++s.done;
  if (stimulus.every != 0 && (stimulus.times == 0 || s.done < stimulus.times))
    due_.emplace(now + stimulus.every, Due{script, 0, {}});
}

void Surroundings::force(const signals::SignalPort& port, int32_t value) {
  hold(port, value);
  schedule_next(queue_.now());
}

Surroundings::Hold& Surroundings::hold(const signals::SignalPort& port, int32_t value) {
  auto held =
      std::find_if(holds_.begin(), holds_.end(), [&](const Hold& other) { return other.port == port; });
  if (held == holds_.end()) held = holds_.insert(held, {port, {}, {}, {}});  // the numbers follow
  held->value = value;
  held->number = ++holds_made_;
  if (port.is_input()) port.line().forced = value;
  return *held;
}

void Surroundings::hold(Time now, size_t script) {
  const signals::SignalPort& port = scripts_[script].port;
  const Stimulus& stimulus = scripts_[script].stimulus;
  Hold& held = hold(port, stimulus.value);
  if (stimulus.action == Stimulus::Action::Pulse && !port.is_input() && !held.before)
    held.before = port.read();
  if (stimulus.length != 0) due_.emplace(now + stimulus.length, Due{script, held.number, {}});
}

// `number` 0 releases whatever holds the terminal; the end of a pulse only its own hold.
void Surroundings::release(const signals::SignalPort& port, uint64_t number) {
  const auto ends = [&](const Hold& held) {
    return number == 0 ? held.port.shares_terminal(port) : held.number == number;
  };
  for (auto held = std::find_if(holds_.begin(), holds_.end(), ends); held != holds_.end();
       held = std::find_if(holds_.begin(), holds_.end(), ends)) {
    const Hold ended = *held;
    holds_.erase(held);
    if (ended.port.is_input()) ended.port.line().forced.reset();
    if (ended.before) write(queue_.now(), ended.port, *ended.before);
  }
}

void Surroundings::write(Time now, const signals::SignalPort& port, int32_t value) {
  if (const auto refused = port.write(value))
    journal_.note(now, Weight::Warning, port.station_name(), "stimulus refused: " + *refused);
}

void Surroundings::schedule_next(Time now) {
  Time next = (now / kMillisecond + 1) * kMillisecond;
  if (leads_.empty() && cams_.empty() && holds_.empty()) {
    if (due_.empty()) return;
    next = std::max(next, (due_.begin()->first + kMillisecond - 1) / kMillisecond * kMillisecond);
  }
  wake(next);
}

}  // namespace ipos::runtime
