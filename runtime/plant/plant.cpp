// Builds a plant from its file and runs it.
#include "runtime/plant/plant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "runtime/bus/log/log_name.hpp"
#include "runtime/nv_memory/medium/file_medium.hpp"
#include "runtime/plant_file/can_cable.hpp"
#include "runtime/plant_file/profibus_paper.hpp"
#include "runtime/plant_file/serial_plan.hpp"
#include "runtime/signals/station_signals.hpp"
#include "runtime/signals/station_state.hpp"

namespace ipos::runtime {
namespace {

// What the verifier says about a program that its station's unit cannot run.
std::vector<PlantError> verify_program(const StationConfig& station, const vm::Image& image) {
  std::array<vm::Violation, 4> violations{};
  const vm::Verification result = vm::verify(image.code, limits_of(*station.unit), violations);
  std::vector<PlantError> errors;
  for (size_t n = 0; n < std::min<size_t>(result.violations, violations.size()); ++n) {
    const vm::RuleInfo& rule = vm::info(violations[n].rule);
    errors.push_back(
        {station.program_place,
         fmt::format("station '{}', unit {}: word {} of {}: {} [{}]", station.name, station.unit->name,
                     violations[n].address, station.program, rule.meaning, rule.code)});
  }
  return errors;
}

// What the memory file holds is there before the parameters of the plant file are set.
void open_memory(const StationConfig& config, Station& station, std::vector<PlantError>& errors) {
  if (config.nvram.empty()) return;
  auto medium = open_file_medium(config.nvram, config.nvram_use);
  if (!medium)
    errors.push_back({config.nvram_place, fmt::format("station '{}': {} cannot be used: {}", config.name,
                                                      config.nvram, medium.error())});
  else if (const auto refused = station.use_memory(std::move(*medium), config.nvram))
    errors.push_back({config.nvram_place, fmt::format("station '{}': {}", config.name, *refused)});
}

}  // namespace

Plant::Plant(PlantFile file, std::vector<std::optional<vm::Image>> programs, std::optional<vm::Rates> rates,
             std::vector<PlantError>& errors, const Execution& execution)
    : file_(std::move(file)) {
  journal_.ask_first([this] { look(); });
  // Sources order the events of one moment: first the lines, then the surroundings, then stations and
  // controls, each in the order of the file.
  for (const BusConfig& bus : file_.buses) add_bus(bus);
  surroundings_ = std::make_unique<Surroundings>(queue_, next_source_++, journal_);
  for (size_t n = 0; n < file_.stations.size(); ++n)
    add_station(n, std::move(programs[n]), rates, errors, execution);
  for (ControlConfig& config : file_.controls) add_control(config, errors);
  surroundings_->connect(file_, stations_, errors);
  resolve_expectations(errors);
  if (!errors.empty()) return;
  surroundings_->start();
  tell_findings();
  power_on();
  start_checks();
  check_nodes();
  plant_faults();
}

void Plant::add_station(size_t number, std::optional<vm::Image> program, std::optional<vm::Rates> rates,
                        std::vector<PlantError>& errors, const Execution& execution) {
  const StationConfig& config = file_.stations[number];
  const StationLines lines = lines_of(config);
  if (program) {
    const std::vector<PlantError> refused = verify_program(config, *program);
    errors.insert(errors.end(), refused.begin(), refused.end());
  }
  stations_.push_back(std::make_unique<Station>(queue_, next_source_++, config, std::move(program), lines,
                                                journal_, rates, execution));
  open_memory(config, *stations_.back(), errors);
  for (const ParameterSetting& setting : config.parameters)
    if (const auto refused = stations_.back()->set_parameter(setting))
      errors.push_back({setting.place, fmt::format("station '{}': {}", config.name, *refused)});
}

// Those of the file, or all that speak MOVILINK on the SBus: its telegrams go to each of them.
void Plant::find_drives(ControlConfig& gateway, std::vector<PlantError>& errors) const {
  std::vector<uint8_t> addresses = gateway.gateway->drives;
  if (addresses.empty())
    for (const auto& station : stations_)
      for (const int number : {1, 2}) {
        const StationConfig& config = station->config();
        if ((number == 1 ? config.sbus : config.sbus2) != gateway.sbus) continue;
        const SbusSettings settings = sbus_settings(station->drive(), number);
        if (settings.movilink) addresses.push_back(settings.slave.address);
      }
  std::sort(addresses.begin(), addresses.end());
  addresses.erase(std::unique(addresses.begin(), addresses.end()), addresses.end());
  if (addresses.empty() || addresses.size() > kMostGatewayDrives)
    errors.push_back(
        {gateway.place, fmt::format("gateway '{}' has {} drives on '{}', and it takes 1 to {}: name "
                                    "them with drives = [...]",
                                    gateway.name, addresses.size(), gateway.sbus, kMostGatewayDrives)});
  for (const uint8_t address : addresses)
    gateway.settings.targets.push_back({address, false, {}, kGatewayCycle});
}

void Plant::add_control(ControlConfig& config, std::vector<PlantError>& errors) {
  PlantControl control{&config, nullptr, {}, {}, {}, {}};
  if (config.gateway) {
    find_drives(config, errors);
    control.line = find_can(config.sbus);
    auto* dp = dynamic_cast<ProfibusBus*>(find_bus(config.gateway->profibus.bus.bus));
    if (dp != nullptr && control.line != nullptr && config.settings.targets.size() <= kMostGatewayDrives)
      control.gateway = std::make_unique<Gateway>(queue_, next_source_++, *dp, config, journal_);
  } else if (config.canopen) {
    control.line = find_can(config.sbus);
    control.canopen =
        std::make_unique<CanopenControl>(queue_, next_source_++, config.name, *config.canopen, journal_);
  } else if (!config.profibus) {
    control.line = find_can(config.sbus);
    control.control = std::make_unique<SbusControl>(queue_, next_source_++, config.settings);
  } else if (auto* bus = dynamic_cast<ProfibusBus*>(find_bus(config.profibus->bus))) {
    control.profibus = std::make_unique<ProfibusControl>(queue_, next_source_++, *bus, config, journal_);
  }
  controls_.push_back(std::move(control));
}

Bus* Plant::find_bus(std::string_view name) const {
  const auto bus = std::find_if(buses_.begin(), buses_.end(),
                                [&](const auto& candidate) { return candidate->name() == name; });
  return bus == buses_.end() ? nullptr : bus->get();
}

Gateway* Plant::find_gateway(std::string_view name) const {
  const auto control = std::find_if(controls_.begin(), controls_.end(), [&](const PlantControl& candidate) {
    return candidate.gateway && candidate.config->name == name;
  });
  return control == controls_.end() ? nullptr : control->gateway.get();
}

void Plant::set_power(std::string_view name, bool on) {
  const auto set = [&](auto& unit) {
    if (unit.powered() == on) return;
    // Before what follows from it.
    tell(Weight::Why, name, on ? "the power is switched on" : "the power is switched off");
    on ? unit.power_on() : unit.power_off();
  };
  if (Gateway* gateway = find_gateway(name)) return set(*gateway);
  for (const auto& station : stations_)
    if (station->config().name == name) set(*station);
}

std::optional<signals::SignalPort> Plant::find_port(const Signal& signal, std::string& why) const {
  const Gateway* gateway = find_gateway(signal.station);
  return gateway == nullptr ? signals::SignalPort::find(stations_, signal, why) : signals::SignalPort::find(*gateway, signal, why);
}

CanLine* Plant::find_can(std::string_view name) const {
  auto* bus = dynamic_cast<CanBus*>(find_bus(name));
  return bus == nullptr ? nullptr : &bus->line();
}

// Stations and controls sit on the cable in the order in which they stand in the file.
void Plant::power_on() {
  size_t control = 0;
  const auto begin_control = [&](PlantControl& started) {
    if (started.profibus) started.profibus->start();
    if (started.gateway) return started.gateway->start(*started.line);
    if (started.line == nullptr) return;
    const bool canopen = started.canopen != nullptr;
    CanNode& master = canopen ? static_cast<CanNode&>(started.canopen->master()) : *started.control;
    const NodeId node = started.line->attach(started.config->name, started.line->baud(), master);
    started.port = std::make_unique<LinePort>(*started.line, node);
    if (canopen)
      started.canopen->master().start(queue_.now(), *started.port);
    else
      started.control->start(*started.port);
  };
  for (const auto& station : stations_) {
    const FilePlace place = station->config().place;
    while (control < controls_.size() && controls_[control].config->place.line < place.line)
      begin_control(controls_[control++]);
    station->power_on();
  }
  while (control < controls_.size()) begin_control(controls_[control++]);
}

void Plant::start_checks() {
  for (const auto& station : stations_)
    for (const int number : {1, 2}) {
      const SbusPort* port = station->sbus(number);
      if (port == nullptr) continue;
      auto* bus = dynamic_cast<CanBus*>(find_bus(port->line().name()));
      bus->check().add_slave(queue_.now(), port->line(), port->node(), port->settings().slave);
    }
}

// Two nodes with one number send the same identifiers, and both answer (CiA 301: a number is given once).
void Plant::check_nodes() {
  struct Numbered {
    const CanLine* line;
    uint8_t node;
    const std::string* station;
  };
  std::vector<Numbered> nodes;
  for (const auto& station : stations_)
    for (const int sbus : {1, 2}) {
      const CanopenPort* port = std::as_const(*station).canopen(sbus);
      if (port == nullptr) continue;
      const Numbered added{&port->line(), port->settings().canopen_address, &station->config().name};
      for (const Numbered& other : nodes)
        if (other.line == added.line && other.node == added.node)
          journal_.note(
              queue_.now(), Weight::Warning, "",
              fmt::format("{}: {} and {} both have CANopen address {}: they send the same identifiers, and "
                          "their answers collide",
                          added.line->name(), *other.station, *added.station, added.node));
      nodes.push_back(added);
    }
}

void Plant::plant_faults() {
  for (const FaultConfig& config : file_.faults)
    if (!plant_fault(config))
      journal_.note(
          queue_.now(), Weight::Warning, config.station,
          fmt::format("the fault planted on bus '{}' has no effect: the station is not on it", config.bus));
}

bool Plant::plant_fault(const FaultConfig& config) { return find_bus(config.bus)->plant(config); }

bool Plant::repair_fault(const FaultConfig& config) { return find_bus(config.bus)->repair(config); }

Bus& Plant::add_bus(const BusConfig& config) {
  buses_.push_back(make_bus({queue_, next_source_++, config, [this](Time now, std::string text) {
                               journal_.note(now, Weight::Warning, "", std::move(text));
                             }}));
  Bus& bus = *buses_.back();
  if (auto* can = dynamic_cast<CanBus*>(&bus)) lines_.push_back(&can->line());
  if (auto* serial = dynamic_cast<SerialBus*>(&bus)) serial_lines_.push_back(serial);
  return bus;
}

// A keypad hangs on a line of its own, which comes right before its station.
StationLines Plant::lines_of(const StationConfig& station) {
  const auto serial = [](Bus* bus) {
    auto* found = dynamic_cast<SerialBus*>(bus);
    return found == nullptr ? nullptr : &found->line();
  };
  StationLines found;
  found.sbus = {find_can(station.sbus), find_can(station.sbus2)};
  found.x13 = serial(find_bus(station.serial.x13.bus));
  found.xt = serial(find_bus(station.serial.xt.bus));
  found.profibus = dynamic_cast<ProfibusBus*>(find_bus(station.profibus.bus.bus));
  if (station.serial.keypad) {
    BusConfig& line = keypads_.emplace_back();
    const std::string name = log_name(station.name + ".keypad");
    line.name = name;
    // Another line may have the name, where letters were replaced.
    for (int n = 2; find_bus(line.name) != nullptr; ++n) line.name = fmt::format("{}_{}", name, n);
    line.kind = BusKind::Rs485;
    line.baud = xt_baud(station);
    found.xt = serial(&add_bus(line));
  }
  return found;
}

void Plant::tell_findings() {
  for (const auto& station : stations_)
    for (const std::string& name : signals::hidden_names(*station))
      journal_.note(queue_.now(), Weight::Why, station->config().name,
                    fmt::format("'{0}' is a variable of the program, and hides what the unit calls so: that is 'drive.{0}'", name));
  const ParameterOf parameter = [this](size_t station, std::string_view number) {
    return stations_[station]->drive().value(number);
  };
  for (const PlanFinding& finding : serial_findings(file_, parameter))
    journal_.note(queue_.now(), Weight::Warning, finding.station, finding.text);
  // Of RS-485 the plant file refuses such lines.
  for (const BusConfig& bus : file_.buses) {
    const auto warn = [&](const std::string& text) {
      journal_.note(queue_.now(), Weight::Warning, "", fmt::format("{}: {}", bus.name, text));
    };
    if (bus.kind == BusKind::Can)
      for (const CableFinding& finding : can_cable_findings(file_, bus)) warn(finding.text);
    if (bus.kind == BusKind::Profibus)
      for (const auto& found : {check_line(profibus_paper(file_, bus)), profibus_master_findings(file_, bus)})
        for (const std::string& text : found) warn(text);
  }
}

void Plant::resolve_expectations(std::vector<PlantError>& errors) {
  for (const Expectation& expectation : file_.expectations) {
    std::string why;
    const auto port = find_port(expectation.signal, why);
    if (port) due_.push_back({&expectation, *port});
    if (!why.empty()) errors.push_back({expectation.place, why});
  }
  std::stable_sort(due_.begin(), due_.end(),
                   [](const Due& a, const Due& b) { return a.expectation->at < b.expectation->at; });
}

void Plant::add_observer(CanObserver& observer) {
  for (CanLine* line : lines_) line->add_observer(observer);
}

void Plant::add_observer(SerialObserver& observer) {
  for (SerialBus* bus : serial_lines_) bus->line().add_observer(observer);
}

bool Plant::run_until(Time end, const std::function<bool(Time)>& keep_going) {
  for (Time at = queue_.now(); at < end;) {
    at = keep_going ? std::min(end, (at / kMillisecond + 1) * kMillisecond) : end;
    check_expectations(at);
    queue_.run_until(at);
    if (keep_going && !keep_going(at)) {
      check_expectations(at + 1);
      return false;
    }
  }
  check_expectations(end + 1);
  return true;
}

// Runs up to each expectation that falls due before `until` and checks it, after all that happens at its
// time.
void Plant::check_expectations(Time until) {
  for (; next_due_ < due_.size() && due_[next_due_].expectation->at < until; ++next_due_) {
    const Due& due = due_[next_due_];
    if (due.expectation->at > queue_.now()) queue_.run_until(due.expectation->at);
    const int32_t actual = due.port.read();
    results_.push_back({due.expectation, actual == due.expectation->equals, actual});
  }
}

bool Plant::store_memories() {
  bool all = true;
  for (const auto& station : stations_) all &= station->store_memory();
  return all;
}

void Plant::look() const {
  for (const auto& station : stations_) station->look();
}

bool Plant::programs_over() const {
  return std::all_of(stations_.begin(), stations_.end(),
                     [](const auto& station) { return station->program_over(); });
}

bool Plant::has_fault() const {
  return std::any_of(stations_.begin(), stations_.end(),
                     [](const auto& station) { return station->error(); });
}

std::vector<const Station*> Plant::unforeseen_faults() const {
  std::vector<const Station*> stations;
  for (const auto& station : stations_) {
    const bool foreseen = std::any_of(results_.begin(), results_.end(), [&](const ExpectationResult& result) {
      const Signal& signal = result.expectation->signal;
      return result.met && result.actual != 0 && signal.kind == SignalKind::State &&
             tells_fault(signal.name) && signal.station == station->config().name &&
             (signal.name != "fault" || result.actual == station->fault());
    });
    if (station->error() && !foreseen) stations.push_back(station.get());
  }
  return stations;
}

}  // namespace ipos::runtime
