// What a station and a bus show from outside, in a fixed order.
#include "tools/recording/trace_hash.hpp"

#include <fmt/format.h>

namespace ipos::tools {

TraceHash::TraceHash(runtime::Plant& plant) : plant_(plant) {
  plant.add_observer(static_cast<runtime::CanObserver&>(*this));
  plant.add_observer(static_cast<runtime::SerialObserver&>(*this));
}

void TraceHash::sample(runtime::Time now) {
  if (now % runtime::kMillisecond != 0) return;
  add_all(now);
  for (const auto& station : plant_.stations()) add_station(*station);
}

std::string TraceHash::text() const { return fmt::format("{:016x}", hash_); }

void TraceHash::add_station(runtime::Station& station) {
  const runtime::Drive& drive = station.drive().state();
  const runtime::AxisState& axis = drive.axis();
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

void TraceHash::on_frame(const runtime::CanLine& line, const runtime::FrameRecord& record) {
  add_text(line.name());
  const runtime::Frame& frame = record.frame;
  add_all(record.sender, record.start, record.end, record.bits, frame.id, frame.length);
  for (size_t n = 0; n < frame.length; ++n) add(frame.data[n]);
}

void TraceHash::on_line_event(const runtime::CanLine& line, const runtime::LineEvent& event) {
  add_text(line.name());
  add_all(event.kind, event.time, event.node, event.other, event.id, event.fault);
}

void TraceHash::on_character(const runtime::Rs485Line& line, runtime::NodeId sender,
                             const runtime::Character& character) {
  add_text(line.name());
  add_all(sender, character.start, character.end, character.data, character.parity_error,
          character.framing_error);
}

void TraceHash::on_serial_event(const runtime::Rs485Line& line, const runtime::SerialEvent& event) {
  add_text(line.name());
  add_all(event.kind, event.time, event.node, event.other);
}

void TraceHash::add_text(const std::string& text) {
  add(text.size());
  for (const char c : text) add(static_cast<unsigned char>(c));
}

}  // namespace ipos::tools
