// The station's tick and its bus port.
#include "runtime/plant/station.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/plant/serial_plan.hpp"
#include "runtime/plant/variable_names.hpp"
#include "runtime/services/drive_variables.hpp"
#include "runtime/services/source_places.hpp"
#include "stdlib/faults.hpp"

namespace ipos::runtime {
namespace {

constexpr uint8_t kFaultWatchdog = 41;

}  // namespace

vm::Limits limits_of(const stdlib::UnitType& unit) {
  return {unit.variables, unit.program_words, unit.tasks, unit.call_depth};
}

Station::Station(EventQueue& queue, uint32_t source, const StationConfig& config,
                 std::optional<vm::Image> program, StationLines lines, Journal& journal,
                 std::optional<vm::Rates> rates, const Execution& execution)
    : queue_(queue),
      source_(source),
      execution_(execution),
      rates_(rates),
      drive_(*config.unit, config.machine, config.options),
      config_(config),
      lines_(lines),
      journal_(journal),
      movilink_(*config.unit, drive_, drive_, journal, config.name),
      image_(std::move(program)) {
  drive_.use(*this);
  movilink_.use(*this);
  for (const InputSetting& input : config.inputs) inputs_.line(input.input).set = input.level ? 1 : 0;
  AnalogInputs analog = config.analog;
  for (size_t n = kBinaryLines; n < kInputLines; ++n) inputs_.line(n).set = analog_value(analog, n);
}

std::optional<std::string> Station::set_parameter(const ParameterSetting& setting) {
  return drive_.set_parameter(setting.parameter, setting.value);
}

void Station::power_on() {
  if (powered_) return;
  powered_ = true;
  fault_reported_ = false;
  told_fault_ = 0;
  if (was_off_) {
    drive_.disconnect_program();
    machine_.reset();
    drive_.power_cycle();
  }
  if (const uint8_t fault = drive_.memory().fault(); fault != 0) drive_.state().raise_fault(fault);
  if (config_.unit->generation != stdlib::Generation::M07) {
    positioning_.emplace(drive_.state(), drive_.parameters(), journal_, config_.name,
                         [this](uint32_t address) { return source_place(address); });
    positioning_commands_.emplace(*positioning_);
  }
  for (const int number : {1, 2}) connect_sbus(number);
  connect_serial();
  for (std::string& setting : drive_.parameters().tell_settings())
    journal_.note(queue_.now(), Weight::Why, config_.name, std::move(setting));
  restart_program_memory();
  tick_ = queue_.schedule(queue_.now(), source_, *this, kTick);
}

StationServices Station::services() {
  const auto objects = [this](int number) {
    SbusPort* port = sbus(number);
    return port == nullptr ? nullptr : &port->objects();
  };
  return {queue_,
          drive_.state(),
          drive_.parameters(),
          timers_,
          drive_.memory(),
          movilink_,
          {objects(1), objects(2)},
          positioning_commands_ ? &*positioning_commands_ : nullptr};
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
  // After a power-off the new port takes the place of the old one on the line.
  auto& port = sbus_[static_cast<size_t>(number - 1)];
  const std::optional<NodeId> node = port ? std::optional(port->node()) : std::nullopt;
  port = std::make_unique<SbusPort>(queue_, source_, *line, node, number, config_.name, settings, drive_,
                                    movilink_, journal_);
}

void Station::connect_serial() {
  if (was_off_) return reconnect_serial();
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
  if (asleep_ && now < back_at_) return sleep_through(now);
  tick(now);
}

void Station::tick(Time now) {
  if (asleep_) {
    leave_out_to(back_at_ - kMillisecond);
    get_up();
  }
  if (late_) {
    execute_to(now);
  } else {
    next_tick_ = now + kMillisecond;
    if (!execute(now)) return;
  }
  schedule_tick(now, send_telegrams(now));
}

// The tick, but for its telegrams. False: the runner stops in the middle.
bool Station::execute(Time now) {
  end_ahead();
  steady_ = steady_ && stays_steady();
  unwritten_ = quiet_ && !touched_ && execution_.skip_idle && runner_ == nullptr;
  touched_ = false;
  if (steady_ && machine_ && (!positioning_ || positioning_->idles())) {
    steady_tick(now);
    return true;
  }
  move_drive(now);
  if (!steady_) {
    report_drive(now);
    if (x13_) x13_->configure(now);
    if (xt_) xt_->configure(now);
  }
  if (machine_) {
    begin_program(now);
    try_program();
    if (!run_commands()) return false;
    end_program(now);
  }
  settle(now);
  return true;
}

void Station::move_drive(Time now) {
  Drive& drive = drive_.state();
  if (!steady_ && !inputs_.known()) {
    drive.set_inputs(inputs_.levels());
    drive.set_analog(inputs_.analog());
  }
  const PositionControl position = positioning_ && machine_
                                       ? positioning_->order(now, machine_->variables(), drive_.syncs())
                                       : PositionControl{};
  steady_ = steady_ && position == drive.position_control();
  if (steady_)
    drive.advance(1);
  else
    drive.tick(position);
}

bool Station::run_commands() {
  const vm::Rates& rates = this->rates();
  if (runner_ == nullptr) {
    vm::run_tick(*machine_, rates);
    return true;
  }
  if (!in_tick_) steps_.begin(*machine_, rates);
  in_tick_ = !runner_->run(*this, *machine_, steps_);
  return !in_tick_;
}

void Station::resume_tick() {
  if (!in_tick_ || !run_commands()) return;
  const Time now = queue_.now();
  end_program(now);
  settle(now);
  schedule_tick(now, send_telegrams(now));
}

// Returns when the next one is due.
Time Station::send_telegrams(Time now) {
  if (reach_.sends_position) end_ahead();
  Time next = kNever;
  for (const auto& port : sbus_)
    if (port) next = std::min(next, port->tick(now));
  return next;
}

void Station::settle(Time now) {
  drive_.memory().tick(now);
  if (drive_.memory().has_messages()) note_memory(now);
  if (!steady_ && execution_.skip_idle && runner_ == nullptr) try_steady();
}

void Station::begin_program(Time now) {
  if (!steady_) {
    raise_drive_events();
    restart_after_reset(now);
  }
  const std::span<int32_t> h = machine_->variables();
  if (!steady_) mirrored_->show(h);
  show_drive(drive_.state(), h);
  if (positioning_) show_positioning(now);
  count_timers(h);
  if (!steady_ && pid_) pid_->tick(h);
  if (steady_ ? !quiet_ : before_tick_.has_value()) noted_.note(h);
}

void Station::count_timers(std::span<int32_t> h) {
  if (machine_->fault().number != 0) return;
  const Timers::Expired expired = timers_.tick(h);
  if (expired.timer_0) machine_->raise_event(vm::Event::Timer0);
  if (expired.watchdog) machine_->raise_fault(kFaultWatchdog, "the watchdog has run out, H490 is 0");
}

void Station::show_positioning(Time now) {
  if (positioning_->writes_variables()) {
    touch();
    steady_ = false;
  }
  positioning_->show(now, machine_->variables());
  if (positioning_->positioner().touch_probes().probe(0).fresh) machine_->raise_event(vm::Event::TouchProbe);
  positioning_commands_->tick(*machine_);
}

void Station::end_program(Time now) {
  const std::span<int32_t> h = machine_->variables();
  steady_ = steady_ && !must_look();
  if (steady_) return;
  if (!unwritten_ || touched_) {
    mirrored_->take(h);
    take_program_orders(h, drive_.state());
  }
  if (drive_.has_reasons()) report_reasons(now);
  if (has_fresh_fault()) report_fault(now);
}

void Station::report_reasons(Time now) {
  // MOVLNK to the own unit.
  if (std::string refused = drive_.take_reason(); !refused.empty())
    journal_.note(now, Weight::Why, config_.name, "refused " + std::move(refused));
  for (std::string& obstacle : drive_.take_obstacles())
    journal_.note(now, Weight::Why, config_.name, std::move(obstacle));
}

// An error that is new, or back after a reset, is the event of the ERROR interrupt; warnings are not (ours).
void Station::raise_drive_events() {
  const Drive& drive = drive_.state();
  const uint8_t error = drive.error() ? drive.fault() : 0;
  if (error != 0 && (error != error_seen_ || drive.resets() != resets_seen_))
    machine_->raise_event(vm::Event::Error);
  error_seen_ = error;
}

// A program that a fault has stopped begins anew when the fault is reset, by whatever (ours); its variables
// keep their values. Where the program memory has been changed meanwhile, what it holds now begins.
void Station::restart_after_reset(Time now) {
  const uint32_t resets = drive_.state().resets();
  if (resets != resets_seen_ && machine_->fault().number != 0) {
    std::optional<std::string> refused;
    if (drive_.memory().program().code() == code_)
      start_machine();
    else
      refused = load_program();
    if (refused)
      journal_.note(now, Weight::Warning, config_.name, "program not started: " + *refused);
    else
      journal_.note(now, Weight::Why, config_.name, "the program starts anew after the reset of its fault");
  }
  resets_seen_ = resets;
}

void Station::report_fault(Time now) {
  fault_reported_ = true;
  const vm::Fault& fault = machine_->fault();
  for (const auto& port : sbus_)
    if (port) port->stop_program();
  movilink_.stop();
  timers_.stop_watchdog();
  drive_.state().raise_fault(fault.number);
  resets_seen_ = drive_.state().resets();
  const std::string place = source_place(fault.address);
  journal_.note(
      now, Weight::Fault, config_.name,
      fmt::format("F{:02} in task {}{} at {}word {}: {}", fault.number, fault.task,
                  fault.context == fault.task ? "" : fmt::format(" ({})", vm::context_name(fault.context)),
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
  if (runs_ahead() && !reach_.may_stop) return false;  // the same without looking
  look();
  if (!machine_) return true;
  for (int task = 1; task <= vm::kTasks; ++task)
    if (machine_->task(task).state != vm::TaskState::Stopped) return false;
  return true;
}

uint8_t Station::fault() const {
  look();
  return drive_.state().fault();
}

bool Station::error() const {
  look();
  return drive_.state().error();
}

uint16_t Station::status_word_1() const {
  look();
  return drive_.state().status_word_1();
}

int32_t Station::read(uint16_t index) const {
  look();
  // Reading is a service like others, though it changes nothing.
  auto& parameters = const_cast<Station*>(this)->drive_.parameters();
  return parameters.execute(ParameterService::Read, index).value_or(0);
}

std::optional<uint32_t> Station::find_variable(std::string_view name) const {
  if (!image_) return std::nullopt;
  const auto named = named_variables(image_->symbols, *config_.unit, name);
  return named.empty() ? std::nullopt : std::optional(named.front().number);
}

std::string Station::source_place(uint32_t address) const {
  return image_ && code_ == image_->code ? runtime::source_place(*image_, address) : std::string();
}

}  // namespace ipos::runtime
