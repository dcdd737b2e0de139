// The station's tick and its bus port.
#include "runtime/plant/station.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "runtime/plant/serial_plan.hpp"
#include "runtime/services/drive_variables.hpp"
#include "stdlib/faults.hpp"

namespace ipos::runtime {
namespace {

constexpr uint32_t kTick = 0;  // the only kind of event a station schedules

}  // namespace

vm::Limits limits_of(const stdlib::UnitType& unit) {
  return {unit.variables, unit.program_words, unit.tasks, unit.call_depth};
}

Station::Station(EventQueue& queue, uint32_t source, const StationConfig& config,
                 std::optional<vm::Image> program, StationLines lines, Journal& journal,
                 std::optional<vm::Rates> rates)
    : queue_(queue),
      source_(source),
      config_(config),
      lines_(lines),
      journal_(journal),
      drive_(*config.unit, config.machine, config.options),
      movilink_(drive_, drive_, journal, config.name),
      image_(std::move(program)),
      rates_(rates) {}

std::optional<std::string> Station::set_parameter(const ParameterSetting& setting) {
  return drive_.set_parameter(setting.parameter, setting.value);
}

void Station::power_on() {
  uint32_t inputs = 0;
  for (const InputSetting& input : config_.inputs) inputs |= (input.level ? 1U : 0U) << input.input;
  drive_.state().set_inputs(static_cast<uint16_t>(inputs));
  drive_.state().set_analog(config_.analog);
  for (const int number : {1, 2}) connect_sbus(number);
  connect_serial();
  if (image_) {
    const auto objects = [this](int number) {
      SbusPort* port = sbus(number);
      return port == nullptr ? nullptr : &port->objects();
    };
    commands_.emplace(queue_, journal_, config_.name, std::array{objects(1), objects(2)}, movilink_);
    machine_.emplace(*vm::verify(image_->code, limits_of(*config_.unit), {}).image, commands_->host());
    drive_.connect_program(*machine_);
    for (const auto& port : sbus_)
      if (port) port->connect_program(*machine_);
    machine_->start();
  }
  queue_.schedule(queue_.now(), source_, *this, kTick);
}

void Station::connect_sbus(int number) {
  CanLine* line = lines_.sbus[static_cast<size_t>(number - 1)];
  if (line == nullptr) return;
  const SbusSettings settings = sbus_settings(drive_, number);
  if (!settings.movilink)
    return journal_.note(
        queue_.now(), Weight::Warning, config_.name,
        fmt::format("SBus {} is silent: its protocol is CANopen (P{}), which is not simulated", number,
                    number == 1 ? 880 : 890));
  sbus_[static_cast<size_t>(number - 1)] = std::make_unique<SbusPort>(
      queue_, source_, *line, number, config_.name, settings, drive_, movilink_, journal_);
}

void Station::connect_serial() {
  if (lines_.x13 != nullptr) {
    x13_ = std::make_unique<SerialPort>(queue_, source_, *lines_.x13, kX13Baud, config_.name, "X13", true,
                                        drive_, movilink_.client(MovilinkBus::SerialX13), journal_);
    movilink_.connect(MovilinkBus::SerialX13, x13_->master());
  }
  if (lines_.xt == nullptr) return;
  xt_ = std::make_unique<SerialPort>(queue_, source_, *lines_.xt, xt_baud(config_), config_.name, "XT", false,
                                     drive_, movilink_.client(MovilinkBus::SerialXt), journal_);
  if (config_.serial.keypad)
    keypad_ = std::make_unique<Keypad>(queue_, source_, *lines_.xt);
  else
    movilink_.connect(MovilinkBus::SerialXt, xt_->master());
}

void Station::on_event(Time now, uint32_t /*kind*/, uint64_t /*argument*/) {
  drive_.state().tick();
  report_drive(now);
  if (x13_) x13_->configure(now);
  if (xt_) xt_->configure(now);
  if (machine_) {
    show_drive(drive_.state(), machine_->variables());
    vm::run_tick(*machine_, rates_.value_or(drive_.rates()));
    take_program_orders(machine_->variables(), drive_.state());
    if (machine_->fault().number != 0 && !fault_reported_) report_fault(now);
  }
  for (const auto& port : sbus_)
    if (port) port->tick(now);
  queue_.schedule(now + kMillisecond, source_, *this, kTick);
}

void Station::report_fault(Time now) {
  fault_reported_ = true;
  const vm::Fault& fault = machine_->fault();
  for (const auto& port : sbus_)
    if (port) port->stop_program();
  movilink_.stop();
  drive_.state().raise_fault(fault.number);
  const std::string place = source_place(fault.address);
  journal_.note(now, Weight::Fault, config_.name,
                fmt::format("F{:02} in task {} at {}word {}: {}", fault.number, fault.task,
                            place.empty() ? "" : place + ", ", fault.address, fault.reason));
}

// Faults, and with --why every change of the reason why the drive is not enabled or takes another setpoint.
void Station::report_drive(Time now) {
  const Drive& drive = drive_.state();
  const uint8_t fault = drive.fault();
  if (fault != told_fault_ && fault != 0 && fault != (machine_ ? machine_->fault().number : 0)) {
    const stdlib::FaultRow* row = stdlib::find_fault(fault);
    journal_.note(now, drive.error() ? Weight::Fault : Weight::Warning, config_.name,
                  row == nullptr ? fmt::format("F{:02}", fault)
                                 : fmt::format("F{:02} {}: {}", fault, row->name, row->meaning));
  }
  told_fault_ = fault;
  if (const uint16_t reserved = drive.reserved_control_bits(); reserved != told_reserved_) {
    told_reserved_ = reserved;
    if (reserved != 0)
      journal_.note(
          now, Weight::Warning, config_.name,
          fmt::format("reserved bits of the control word are 1 ({:04X}h): they have no effect and are "
                      "to be sent as 0",
                      reserved));
  }
  if (const Block block = drive.verdict().reason; block != told_block_) {
    told_block_ = block;
    journal_.note(now, Weight::Why, config_.name,
                  block == Block::None ? std::string(block_text(block))
                                       : fmt::format("not enabled: {}", block_text(block)));
  }
  if (const SetpointNote note = drive.setpoint().note; note != told_note_) {
    told_note_ = note;
    if (note != SetpointNote::None)
      journal_.note(now, Weight::Why, config_.name, std::string(setpoint_note_text(note)));
  }
}

bool Station::program_over() const {
  if (!machine_) return true;
  for (int task = 1; task <= vm::kTasks; ++task)
    if (machine_->task(task).state != vm::TaskState::Stopped) return false;
  return true;
}

uint8_t Station::fault() const { return drive_.state().fault(); }

bool Station::error() const { return drive_.state().error(); }

uint16_t Station::status_word_1() const { return drive_.state().status_word_1(); }

std::optional<uint32_t> Station::find_variable(std::string_view name) const {
  if (!image_) return std::nullopt;
  for (const vm::Symbol& symbol : image_->symbols)
    if (symbol.name == name) return symbol.variable;
  if (name.size() < 2 || name[0] != 'H') return std::nullopt;
  uint32_t number = 0;
  const auto [end, status] = std::from_chars(name.data() + 1, name.data() + name.size(), number);
  if (status != std::errc() || end != name.data() + name.size() || number >= config_.unit->variables)
    return std::nullopt;
  return number;
}

std::string Station::source_place(uint32_t address) const {
  if (!image_) return {};
  const auto next =
      std::upper_bound(image_->lines.begin(), image_->lines.end(), address,
                       [](uint32_t at, const vm::LineEntry& entry) { return at < entry.address; });
  if (next == image_->lines.begin()) return {};
  const vm::LineEntry& entry = *(next - 1);
  return fmt::format("{}:{}:{}", image_->files[entry.file], entry.line, entry.column);
}

}  // namespace ipos::runtime
