// The ports of a station and its power.
#include "runtime/station/station.hpp"

#include <algorithm>
#include <utility>

#include "runtime/plant_file/serial_plan.hpp"

namespace ipos::runtime {

Station::Station(EventQueue& queue, uint32_t source, const StationConfig& config,
                 std::optional<vm::Image> program, StationLines lines, Journal& journal,
                 std::optional<vm::Rates> rates, const Execution& execution)
    : queue_(queue),
      source_(source),
      unit_(queue, {config.name, *config.unit, config.machine, config.options}, std::move(program), journal,
            rates, execution),
      pacer_(queue, source, *this, execution.pace, unit_.milliseconds()),
      config_(config),
      lines_(lines),
      journal_(journal) {
  UnitInputs& inputs = unit_.inputs();
  for (const InputSetting& input : config.inputs) inputs.line(input.input).set = input.level ? 1 : 0;
  AnalogInputs analog = config.analog;
  for (size_t n = kBinaryLines; n < kInputLines; ++n) inputs.line(n).set = analog_value(analog, n);
}

std::optional<std::string> Station::set_parameter(const ParameterSetting& setting) {
  return unit_.server().set_parameter(setting.parameter, setting.value);
}

std::optional<std::string> Station::use_memory(std::unique_ptr<NvMedium> medium, std::string name) {
  return unit_.server().memory().open(std::move(medium), std::move(name));
}

void Station::power_on() {
  if (powered_) return;
  powered_ = true;
  unit_.power_on();
  leads_ = false;
  for (const int number : {1, 2}) connect_sbus(number);
  connect_serial();
  connect_profibus();
  list_ports();
  unit_.restart_program_memory(queue_.now());
  pacer_.start();
}

// The bus ports are off the line until the next power-on creates them again.
void Station::power_off() {
  if (!powered_) return;
  pacer_.touch();
  store_memory();
  powered_ = false;
  was_off_ = true;
  pacer_.stop();
  unit_.power_off();
  for (StationPort* port : std::exchange(ports_, {})) port->power_off();
  if (keypad_) keypad_->set_powered(false);
}

void Station::list_ports() {
  ports_.clear();
  const auto add = [this](const auto& port) {
    if (port) ports_.push_back(port.get());
  };
  add(x13_);
  add(xt_);
  for (const auto& port : sbus_) add(port);
  for (const auto& port : canopen_) add(port);
  tells_changes_ = canopen_[0] || canopen_[1];
  add(profibus_);
}

void Station::connect_sbus(int number) {
  CanLine* line = lines_.sbus[static_cast<size_t>(number - 1)];
  if (line == nullptr) return;
  const SbusSettings settings = sbus_settings(unit_.server(), number);
  // After a power-off the new port takes the place of the old one on the line.
  auto& port = sbus_[static_cast<size_t>(number - 1)];
  auto& canopen = canopen_[static_cast<size_t>(number - 1)];
  const std::optional<NodeId> node = port      ? std::optional(port->node())
                                     : canopen ? std::optional(canopen->node())
                                               : std::nullopt;
  if (!settings.movilink) {
    unit_.movilink().disconnect(number == 1 ? MovilinkBus::Sbus : MovilinkBus::Sbus2);
    if (number == 1) unit_.movilink().disconnect(MovilinkBus::Canopen);
    port.reset();
    canopen = std::make_unique<CanopenPort>(queue_, source_, *line, node, number, config_.name, settings,
                                            door_, journal_);
    return;
  }
  canopen.reset();
  port = std::make_unique<SbusPort>(queue_, source_, *line, node, number, config_.name, settings, door_,
                                    journal_);
  leads_ = leads_ || port->leads();
}

void Station::connect_serial() {
  if (was_off_) return reconnect_serial();
  MovilinkCommand& movilink = unit_.movilink();
  if (lines_.x13 != nullptr) {
    x13_ = std::make_unique<SerialPort>(queue_, source_, *lines_.x13, kX13Baud, config_.name, "X13", true,
                                        door_, movilink.client(MovilinkBus::SerialX13), journal_);
    movilink.connect(MovilinkBus::SerialX13, x13_->master());
  }
  if (lines_.xt == nullptr) return;
  xt_ = std::make_unique<SerialPort>(queue_, source_, *lines_.xt, xt_baud(config_), config_.name, "XT", false,
                                     door_, movilink.client(MovilinkBus::SerialXt), journal_);
  if (config_.serial.keypad)
    keypad_ = std::make_unique<Keypad>(queue_, source_, *lines_.xt);
  else
    movilink.connect(MovilinkBus::SerialXt, xt_->master());
}

void Station::connect_profibus() {
  if (lines_.profibus == nullptr) return miss_profibus();
  if (profibus_)
    profibus_->power_on();
  else
    profibus_ = std::make_unique<ProfibusPort>(queue_, *lines_.profibus, config_, door_, journal_);
}

bool Station::has_switch(StationSwitch which) const {
  if (which == StationSwitch::Mains) return true;
  if (which == StationSwitch::S13)
    return !config_.serial.xt.bus.empty() && serial_interfaces(*config_.unit).xt_has_s13;
  if (config_.profibus.bus.bus.empty() || config_.profibus.option == nullptr) return false;
  return which != StationSwitch::FmsSwitch || config_.profibus.option->fms;
}

int32_t Station::switch_value(StationSwitch which) const {
  if (which == StationSwitch::Mains) return drive().state().mains() ? 1 : 0;
  if (which == StationSwitch::S13) return xt_ ? (xt_->baud() == kS13Baud ? 1 : 0) : config_.serial.s13 ? 1 : 0;
  const ProfibusUse& use = config_.profibus;
  const profibus::CardSwitches set = profibus_ ? profibus_->card().station().switches().set()
                                               : profibus::CardSwitches{use.address, use.fms_switch, use.terminator.value_or(false)};
  switch (which) {
    case StationSwitch::FmsSwitch: return set.fms ? 1 : 0;
    case StationSwitch::ProfibusAddress: return set.address;
    default: return set.terminated ? 1 : 0;
  }
}

std::optional<std::string> Station::set_switch(StationSwitch which, int32_t value) {
  if (which == StationSwitch::Mains) {
    if (std::as_const(*this).drive().state().mains() == (value != 0)) return std::nullopt;
    drive().state().set_mains(value != 0);
    journal_.tell(queue_.now(), Weight::Why, config_.name, value != 0 ? "the mains are back" : "the mains are off; the 24 V supply stays");
    return std::nullopt;
  }
  if (which == StationSwitch::S13) {
    if (!xt_) return "the station was never on";
    xt_->set_baud(value != 0 ? kS13Baud : kFactoryXtBaud);
    return std::nullopt;
  }
  if (!profibus_) return "the station was never on";
  profibus::LatchedSwitches& switches = profibus_->card().station().switches();
  profibus::CardSwitches set = std::as_const(switches).set();
  switch (which) {
    case StationSwitch::FmsSwitch: set.fms = value != 0; break;
    case StationSwitch::ProfibusAddress: set.address = static_cast<uint8_t>(value); break;
    default: set.terminated = value != 0;
  }
  switches.set(set);
  return std::nullopt;
}

bool Station::has_further_words() const {
  const profibus::OptionType* card = config_.profibus.option;
  return (card != nullptr && card->accepts.most > kProcessWords) || canopen(1) != nullptr || canopen(2) != nullptr;
}

// A unit whose P100 or P101 names a fieldbus that is not there.
void Station::miss_profibus() {
  const BusSource& fieldbus = bus_source(PoSource::Fieldbus);
  const UnitInterface& server = unit_.server();
  if (!server.unit().has(stdlib::Trait::FieldbusCard)) return;
  for (const auto& [number, code] : {std::pair("100", stdlib::code(fieldbus.setpoint)), std::pair("101", stdlib::code(fieldbus.control))})
    if (server.value(number) == code)
      journal_.note(
          queue_.now(), Weight::Warning, config_.name,
          std::string("P") + number +
              " is FIELDBUS, but the station is on no PROFIBUS (option and profibus of its [[station]])");
}

void Station::reconnect_serial() {
  MovilinkCommand& movilink = unit_.movilink();
  if (x13_) {
    x13_->power_on(queue_.now());
    movilink.connect(MovilinkBus::SerialX13, x13_->master());
  }
  if (xt_) xt_->power_on(queue_.now());
  if (xt_ && !keypad_) movilink.connect(MovilinkBus::SerialXt, xt_->master());
  if (keypad_) keypad_->set_powered(true);
}

std::optional<std::string> Station::start_program() {
  if (!powered_) return "the station is off";
  return door_.touch().load_program();
}

std::optional<std::string> Station::load_program(vm::Image image) {
  if (!powered_) return "the station is off";
  return door_.touch().take_program(std::move(image));
}

void Station::stop_program() { door_.touch().stop_tasks(); }

void Station::use_runner(CommandRunner& runner) {
  pacer_.use(Pace::InTurn);
  runner_ = &runner;
  unit_.use_runner(*this);
}

bool Station::run(vm::Machine& machine, vm::TickSteps& steps) { return runner_->run(*this, machine, steps); }

bool Station::tick(Time now) {
  const bool over = pacer_.pace() == Pace::InTurn ? tick_in_turn(now) : ticks_.tick(now);
  if (over) tell_watchers(now);
  return over;
}

Ticks Station::advance(Time first, Ticks most) {
  if (watchers_.empty()) return ticks_.advance(first, most);
  const bool moves = ticks_.mode() == ManyTicks::Mode::Moving;  // in each of them
  const Ticks executed = ticks_.advance(first, moves ? 1 : most);
  if (executed != 0 && ticks_.settled()) tell_watchers(first);  // one tick, with the program in full
  return executed;
}

bool Station::tick_in_turn(Time now) {
  in_tick_ = !unit_.tick(now);
  return !in_tick_;
}

void Station::resume_tick() {
  if (!in_tick_) return;
  in_tick_ = !unit_.run_tasks();
  if (in_tick_) return;
  unit_.finish(queue_.now());
  tell_watchers(queue_.now());
  pacer_.resume();
}

Time Station::send(Time now) {
  settle_to_send();
  Time next = kNever;
  for (StationPort* port : ports_) next = std::min(next, port->tick(now));
  return next;
}

Time Station::send_at_rest(Time now, Time until) {
  settle_to_send();
  Time next = kNever;
  for (StationPort* port : ports_) next = std::min(next, port->tick_at_rest(now, until));
  return next;
}

void Station::rest_ends() {
  for (StationPort* port : ports_) port->rest_ends();
}

Ticks Station::horizon(Time first) {
  return ticks_.mode() == ManyTicks::Mode::Idle ? horizon_of_idle(first) : ticks_.horizon(first);
}

// The ticks of an idle unit are over: from now on its variables may change.
Ticks Station::horizon_of_idle(Time first) {
  const Ticks ticks = ticks_.horizon(first);
  if (!ticks_.variables_rest()) want_frames_again();
  return ticks;
}

// Who is on a serial line is asked at any time. A CANopen node tells what the unit decides: of one that has just been called to its
// turn it is found out now whether the next ticks are such that decide nothing.
Ticks Station::silence(Time first) {
  if (ticks_.mode() != ManyTicks::Mode::Idle && (x13_ || xt_)) return 0;
  if (tells_changes_ && ticks_.mode() == ManyTicks::Mode::Steady) horizon(first);
  const Ticks known = ticks_.known_silence();
  const Ticks silent = known != 0 ? known : find_silence(first);
  return tells_changes_ ? std::min(silent, ticks_.undecided()) : silent;
}

Ticks Station::find_silence(Time first) {
  bool waits = false;
  for (const StationPort* port : ports_) waits = waits || port->has_waiting_frames();
  return ticks_.silence(first, waits);
}

void Station::touched() {
  ticks_.touched();
  want_frames_again();
}

// A unit that ran ahead when the telegram came may be idle by now: then its loops are those of the variables before.
void Station::before_telegram() {
  if (ticks_.mode() != ManyTicks::Mode::Idle) return;
  settle();
  touched();
}

void Station::want_frames_again() {
  for (StationPort* port : ports_) port->want_again();
}

bool Station::store_memory() {
  Unit& unit = door_.touch();
  for (const auto* port : {&x13_, &xt_})
    if (*port) (*port)->report(queue_.now());
  return unit.store_memory(queue_.now());
}

bool Station::program_over() const {
  // No task ends or begins while it rests, or where its program goes round for ever.
  const bool same = pacer_.rests() || ticks_.is_endless();
  const vm::Machine* machine = same ? unit_.machine() : this->machine();
  if (machine == nullptr) return true;
  for (int task = 1; task <= vm::kTasks; ++task)
    if (machine->task(task).state != vm::TaskState::Stopped) return false;
  return true;
}

uint8_t Station::fault() const { return door_.look().drive().fault(); }

bool Station::error() const { return door_.look().drive().error(); }

uint16_t Station::status_word_1() const { return door_.look().drive().status_word_1(); }

int32_t Station::read(uint16_t index) const {
  return door_.look().server().parameters().read(index).value_or(0);
}

}  // namespace ipos::runtime
