// Wires, switches, encoder cables and belts first, then what is due, then what is held.
#include "runtime/plant/surroundings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/signals/find.hpp"

namespace ipos::runtime {
namespace {

// What a wire or switch says.
void drive(const signals::Signal& input, bool level) {
  const int32_t driven = level ? 1 : 0;
  if (std::as_const(*input.owner).inputs().line(input.number).driven != driven) input.line().driven = driven;
}

// The count of a shaft at a socket of another station, which is touched only when the shaft has turned.
void count(Station& station, EncoderSocket socket, int32_t shaft) {
  EncoderInputs encoders = std::as_const(station).drive().state().encoders();
  (socket == EncoderSocket::X14 ? encoders.x14 : encoders.x42) = shaft;
  if (encoders != std::as_const(station).drive().state().encoders()) station.drive().state().set_encoders(encoders);
}

Station* station_of(const PlantParts& plant, std::string_view name) {
  for (const auto& station : plant.stations())
    if (station->config().name == name) return station.get();
  return nullptr;
}

}  // namespace

void Surroundings::connect(const PlantFile& file, const PlantParts& plant, std::vector<PlantError>& errors) {
  const auto find = [&](const Signal& named, FilePlace place) {
    std::string why;
    auto signal = signals::find_signal(plant, named, why);
    if (!why.empty()) errors.push_back({place, why});
    return signal;
  };
  for (const Wire& wire : file.wires) {
    const auto from = find(wire.from, wire.place);
    const auto to = find(wire.to, wire.place);
    if (from && to) wires_.push_back({*from, *to, wire.invert});
  }
  for (const PositionSwitch& row : file.switches)
    if (const auto input = find(row.input, row.place)) cams_.push_back({*input, input->owner, row.from, row.to, row.active_high});
  for (const auto& station : plant.stations())
    for (const EncoderUse& use : station->config().encoders)
      if (const Station* from = station_of(plant, use.shaft)) cables_.push_back({from, station.get(), use.socket});
  for (const auto& station : plant.stations())
    if (const auto& machine = station->config().driven; machine && machine->carries())
      conveyors_.push_back({station.get(), Belt(*machine)});
  for (const LightBarrier& row : file.barriers)
    if (const auto input = find(row.input, row.place))
      for (const Conveyor& conveyor : conveyors_)
        if (conveyor.station->config().name == row.belt)
          barriers_.push_back({*input, &conveyor.belt, conveyor.belt.way_to(row.at), row.active_high});
  for (Stimulus stimulus : file.stimuli) {
    std::string why;
    const auto signal = signals::find_target(plant, stimulus, why);
    if (!why.empty()) errors.push_back({stimulus.place, why});
    if (!signal) continue;
    due_.emplace(stimulus.at, Due{scripts_.size(), 0, {}});
    scripts_.push_back({*signal, std::move(stimulus)});
  }
}

const Belt* Surroundings::belt_of(const Station& station) const {
  for (const Conveyor& conveyor : conveyors_)
    if (conveyor.station == &station) return &conveyor.belt;
  return nullptr;
}

void Surroundings::start() { wake(queue_.now()); }

void Surroundings::add(const signals::Signal& signal, const Stimulus& stimulus) {
  due_.emplace(stimulus.at, Due{scripts_.size(), 0, {}});
  scripts_.push_back({signal, stimulus});
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
  for (const LiveWire& lead : wires_) drive(lead.to, (lead.from.read() != 0) != lead.invert);
  for (const Cam& cam : cams_) {
    const int32_t position = cam.station->shaft_position();
    const bool within = position >= cam.from && position <= cam.to;
    drive(cam.input, within == cam.active_high);
  }
  for (const EncoderCable& cable : cables_) count(*cable.to, cable.socket, cable.from->shaft_position());
  for (Conveyor& conveyor : conveyors_) conveyor.belt.move(conveyor.station->shaft_position());
  for (const Barrier& barrier : barriers_) drive(barrier.input, barrier.belt->covers(barrier.way) == barrier.active_high);
  while (!due_.empty() && due_.begin()->first <= now) {
    const Time at = due_.begin()->first;
    const Due due = std::move(due_.begin()->second);
    due_.erase(due_.begin());
    if (due.action)
      due.action();
    else if (due.ends != 0)
      holds_.release(due.ends);
    else
      perform(at, due.script);
  }
  holds_.act();
  schedule_next(now);
}

void Surroundings::perform(Time now, size_t script) {
  Script& s = scripts_[script];
  const Stimulus& stimulus = s.stimulus;
  switch (stimulus.action) {
    case Stimulus::Action::Set: write(now, s.signal, stimulus.value); break;
    case Stimulus::Action::Force:
    case Stimulus::Action::Pulse:
      hold(s.signal, stimulus.value, "a stimulus", now, stimulus.length, stimulus.action == Stimulus::Action::Pulse);
      break;
    case Stimulus::Action::Release: holds_.release(s.signal); break;
  }
  ++s.done;
  if (stimulus.every != 0 && (stimulus.times == 0 || s.done < stimulus.times))
    due_.emplace(now + stimulus.every, Due{script, 0, {}});
}

signals::Refusal Surroundings::force(const signals::Signal& signal, int64_t value, std::string_view by, Time length) {
  if (auto wrong = signal.check(value)) return wrong;
  if (!signal.is_input())
    if (auto refused = signal.write(value)) return refused;
  hold(signal, static_cast<int32_t>(value), by, queue_.now(), length, false);
  schedule_next(queue_.now());
  return std::nullopt;
}

// A pulse gives back what was there.
void Surroundings::hold(const signals::Signal& signal, int32_t value, std::string_view by, Time now, Time length,
                        bool pulse) {
  const auto before = static_cast<int32_t>(signal.read());
  signals::Hold& held = holds_.hold(signal, value, by);
  if (pulse && !signal.is_input() && !held.before) held.before = before;
  held.until = length == 0 ? kNever : now + length;
  if (length != 0) due_.emplace(held.until, Due{0, held.number, {}});
}

void Surroundings::write(Time now, const signals::Signal& signal, int32_t value) {
  if (const auto refused = signal.write(value))
    journal_.note(now, Weight::Warning, signal.station, "stimulus refused: " + *refused);
}

void Surroundings::schedule_next(Time now) {
  Time next = (now / kMillisecond + 1) * kMillisecond;
  if (wires_.empty() && cams_.empty() && cables_.empty() && conveyors_.empty() && holds_.empty()) {
    if (due_.empty()) return;
    next = std::max(next, (due_.begin()->first + kMillisecond - 1) / kMillisecond * kMillisecond);
  }
  wake(next);
}

}  // namespace ipos::runtime
