// What a station and a bus show from outside, in a fixed order.
#include "runtime/plant/trace_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ipos::runtime {
namespace {

void add_station(NumberHash& hash, const Station& station) {
  const Drive& drive = station.drive().state();
  const AxisState& axis = drive.axis();
  hash.add_all(station.powered(), drive.fault(), drive.condition(), drive.display(), drive.status_word_1(),
               drive.status_word_2(), drive.inputs(), drive.outputs(), axis.phase, axis.output_stage,
               axis.brake_released, axis.standing, axis.ramping, axis.current_limited, axis.setpoint,
               axis.speed, axis.position, axis.torque, axis.output_current, axis.active_current,
               axis.frequency, axis.dc_link, axis.heat_sink, axis.utilization, axis.motor_utilization,
               axis.energy);
  for (const uint16_t word : drive.pi()) hash.add(word);
  const vm::Machine* machine = station.machine();
  if (machine == nullptr) return;
  hash.add_many(machine->variables());
  for (int number = 1; number <= vm::kContexts; ++number) {
    const vm::TaskContext& context = machine->context(number);
    hash.add_all(context.state, context.depth, context.pc, context.wait_ms, context.commands);
  }
  hash.add_all(machine->fault().number, machine->fault().address);
}

void add_state(NumberHash& hash, const Plant& plant, Time now) {
  hash.add_all(now);
  for (const auto& station : plant.stations()) add_station(hash, *station);
}

constexpr uint64_t pair_of(int32_t high, int32_t low) {
  return uint64_t{static_cast<uint32_t>(high)} << 32 | static_cast<uint32_t>(low);
}

}  // namespace

void NumberHash::add_text(const std::string& text) {
  add(text.size());
  for (const char c : text) add(static_cast<unsigned char>(c));
}

// Four rows of products that do not wait for each other.
void NumberHash::add_many(std::span<const int32_t> values) {
  std::array<NumberHash, 4> rows;
  size_t n = 0;
  for (; n + 8 <= values.size(); n += 8)
    for (size_t row = 0; row < rows.size(); ++row)
      rows[row].add(pair_of(values[n + 2 * row], values[n + 2 * row + 1]));
  for (; n < values.size(); ++n) rows[0].add(static_cast<uint32_t>(values[n]));
  for (const NumberHash& row : rows) add(row.hash_);
}

uint64_t state_digest(const Plant& plant) {
  NumberHash hash;
  add_state(hash, plant, plant.now());
  return hash.value();
}

void TraceHash::Course::note(const Drive& drive, Time now, bool powered) {
  const uint64_t flags = uint64_t{powered} | uint64_t{drive.output_stage()} << 1 |
                         uint64_t{drive.brake_released()} << 2 | uint64_t{drive.standing()} << 3 |
                         uint64_t{drive.current_limited()} << 4;
  const uint64_t status = drive.status_word_1() | uint64_t{drive.fault()} << 16 |
                          static_cast<uint64_t>(drive.axis_phase()) << 24 | flags << 32;
  const Values values{status, uint64_t{drive.inputs()} << 16 | drive.outputs(),
                      pair_of(drive.axis_setpoint(), drive.speed())};
  if (values == last_) return;
  last_ = values;
  hash_.add_all(now);
  for (const uint64_t value : values) hash_.add(value);
}

// What others write between two ticks finds the station not behind, and the next tick comes in its turn.
void TraceHash::Course::sample(Time now) {
  if (!station_.behind()) note(station_.drive().state(), now, station_.powered());
}

TraceHash::TraceHash(Plant& plant, Time step) : plant_(plant), step_(step), islands_(plant.islands().count()) {
  for (const auto& bus : plant.buses()) {
    bus->add_tracer(*this);
    NumberHash name;
    name.add_text(bus->name());
    names_.push_back({bus.get(), name.value(), plant.island_of(*bus)});
  }
  plant.machines().add_watcher(*this);
  for (const auto& station : plant.stations())
    station->add_watcher(*courses_.emplace_back(std::make_unique<Course>(*station)));
}

void TraceHash::sample(Time now) {
  if (now % kMillisecond != 0) return;
  add_heard(hash_);
  for (OfIsland& island : islands_) {
    island.heard.clear();
    island.facts.clear();
  }
  for (const auto& course : courses_) course->sample(now);
  if (now % step_ == 0) add_state(hash_, plant_, now);
}

uint64_t TraceHash::value() const {
  NumberHash whole = hash_;
  add_heard(whole);
  for (const auto& station : plant_.stations()) station->look();
  for (const auto& course : courses_) whole.add(course->value());
  add_state(whole, plant_, plant_.now());
  return whole.value();
}

std::string TraceHash::text() const { return fmt::format("{:016x}", value()); }

void TraceHash::on_trace(const Bus& bus, std::span<const uint64_t> facts) {
  const auto named = std::find_if(names_.begin(), names_.end(), [&](const Named& one) { return one.bus == &bus; });
  // A line tells what stands already while this begins to hear it.
  const bool begins = named == names_.end();
  if (islands_.size() == 1 || begins) {
    if (!begins) hash_.add(named->name);
    for (const uint64_t fact : facts) hash_.add(fact);
    return;
  }
  OfIsland& island = islands_[named->island];
  const size_t begin = island.facts.size();
  island.facts.push_back(named->name);
  island.facts.insert(island.facts.end(), facts.begin(), facts.end());
  island.heard.push_back({plant_.islands().moment(named->island), begin, island.facts.size()});
}

// In the order of one queue.
void TraceHash::add_heard(NumberHash& hash) const {
  if (islands_.size() == 1) return;
  std::vector<std::pair<EventQueue::Moment, std::span<const uint64_t>>> all;
  for (const OfIsland& island : islands_)
    for (const Heard& heard : island.heard)
      all.emplace_back(heard.moment, std::span(island.facts).subspan(heard.begin, heard.end - heard.begin));
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first.at, a.first.source) < std::pair(b.first.at, b.first.source);
  });
  for (const auto& [moment, facts] : all)
    for (const uint64_t fact : facts) hash.add(fact);
}

void TraceHash::on_given(size_t machine, Time now, std::span<const int64_t> samples) {
  hash_.add_all(machine, now);
  for (const int64_t sample : samples) hash_.add(static_cast<uint64_t>(sample));
}

}  // namespace ipos::runtime
