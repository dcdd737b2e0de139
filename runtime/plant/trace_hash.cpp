// What a station and a bus show from outside, in a fixed order.
#include "runtime/plant/trace_hash.hpp"

#include <fmt/format.h>

namespace ipos::runtime {

TraceHash::TraceHash(Plant& plant) : plant_(&plant) {
  for (const auto& bus : plant.buses()) bus->add_tracer(*this);
}

void TraceHash::sample(Time now) {
  if (now % kMillisecond != 0) return;
  add_state(now, *plant_);
}

void TraceHash::add_state(Time now, const Plant& plant) {
  add_all(now);
  for (const auto& station : plant.stations()) add_station(*station);
}

uint64_t state_digest(const Plant& plant) {
  TraceHash hash;
  hash.add_state(plant.now(), plant);
  return hash.value();
}

std::string TraceHash::text() const { return fmt::format("{:016x}", hash_); }

void TraceHash::add_station(const Station& station) {
  const Drive& drive = station.drive().state();
  const AxisState& axis = drive.axis();
  add_all(station.powered(), drive.fault(), drive.condition(), drive.display(), drive.status_word_1(),
          drive.status_word_2(), drive.inputs(), drive.outputs(), axis.phase, axis.output_stage,
          axis.brake_released, axis.standing, axis.ramping, axis.current_limited, axis.setpoint, axis.speed,
          axis.position, axis.torque, axis.output_current, axis.active_current, axis.frequency, axis.dc_link,
          axis.heat_sink, axis.utilization, axis.motor_utilization, axis.energy);
  for (const uint16_t word : drive.pi()) add(word);
  const vm::Machine* machine = station.machine();
  if (machine == nullptr) return;
  for (const int32_t value : machine->variables()) add(static_cast<uint64_t>(value));
  for (int number = 1; number <= vm::kContexts; ++number) {
    const vm::TaskContext& context = machine->context(number);
    add_all(context.state, context.depth, context.pc, context.wait_ms, context.commands);
  }
  add_all(machine->fault().number, machine->fault().address);
}

void TraceHash::on_trace(const Bus& bus, std::span<const uint64_t> facts) {
  add_text(bus.name());
  for (const uint64_t fact : facts) add(fact);
}

void TraceHash::add_text(const std::string& text) {
  add(text.size());
  for (const char c : text) add(static_cast<unsigned char>(c));
}

}  // namespace ipos::runtime
