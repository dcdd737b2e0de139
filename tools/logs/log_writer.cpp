// What a plant's lines bring into a log.
#include "tools/logs/log_writer.hpp"

#include "runtime/station/can_bus.hpp"
#include "runtime/station/profibus_bus.hpp"
#include "tools/cli/output_forms.hpp"

namespace ipos::tools {

using runtime::Time;

std::unique_ptr<LogWriter> make_log_writer(const std::string& path, std::ostream& out) {
  return make_writer(output_ending("--log", path), out);
}

PlantLog::PlantLog(runtime::Plant& plant, LogWriter& writer) : writer_(writer) {
  const bool all = writer.has_serial();
  stays_empty_ = !all && !plant.buses().empty() && plant.all<runtime::CanBus>().empty();
  for (const auto& bus : plant.buses())
    visit(
        *bus,
        [this](runtime::CanBus& can) { can.line().add_observer(static_cast<runtime::CanObserver&>(*this)); },
        [this, all](runtime::SerialBus& serial) {
          if (all) serial.line().add_observer(*this);
        },
        [this, all](runtime::ProfibusBus& profibus) {
          if (all) profibus.line().add_observer(*this);
        });
}

void PlantLog::finish() {
  for (auto& [line, receiver] : receivers_)
    if (const auto reception = receiver.give_up()) writer_.serial(line, *reception);
}

void PlantLog::on_frame(const runtime::CanLine& line, const runtime::FrameRecord& record) {
  writer_.can(record.end, line.name(), record.frame);
}

void PlantLog::on_character(const runtime::Rs485Line& line, runtime::NodeId /*sender*/,
                            const runtime::Character& character) {
  if (const auto reception = receivers_[line.name()].take(character)) writer_.serial(line.name(), *reception);
}

void PlantLog::on_frame(const profibus::Line& line, profibus::NodeId /*sender*/,
                        const profibus::Reception& reception) {
  writer_.dp(line.name(), reception);
}

}  // namespace ipos::tools
