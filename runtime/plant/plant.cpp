// Builds a plant from its file and runs it.
#include "runtime/plant/plant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "runtime/bus/log/log_name.hpp"
#include "runtime/nv_memory/medium/file_medium.hpp"
#include "runtime/plant/start_checks.hpp"
#include "runtime/plant_file/line_disturbance.hpp"
#include "runtime/plant_file/serial_plan.hpp"
#include "runtime/plant_file/state_names.hpp"
#include "runtime/signals/find.hpp"
#include "runtime/unit/program_shelf.hpp"

namespace ipos::runtime {
namespace {

// What the verifier says about a program that its station's unit cannot run.
std::vector<PlantError> verify_program(const StationConfig& station, const vm::Image& image, const Execution& execution) {
  if (execution.shelf && execution.shelf->find(image.code, limits_of(*station.unit), execution)) return {};
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
  islands_ = std::make_unique<Islands>(file_, queue_, journal_, execution.threads);
  journal_.ask_first([this] { look(); });
  // Sources order the events of one moment: first the lines, then machines, the surroundings, then stations and
  // controls, each in the order of the file.
  for (const BusConfig& bus : file_.buses) add_bus(bus, islands_->of_bus(bus.name));
  if (execution.pace == Pace::InTurn)
    for (const auto& bus : buses_)
      if (auto* can = as<CanBus>(bus.get())) can->line().repeat_in_turn();
  machines_ = std::make_unique<Machines>(queue_, next_source_, file_, journal_);
  surroundings_ = std::make_unique<Surroundings>(queue_, next_source_++, journal_);
  for (size_t n = 0; n < file_.stations.size(); ++n)
    add_station(n, std::move(programs[n]), rates, errors, execution);
  for (size_t n = 0; n < file_.controls.size(); ++n) {
    const auto [queue, journal, island] = islands_->of_control(n);
    if (auto control = make_control({*this, queue, next_source_, journal}, file_.controls[n], errors))
      controls_.push_back(std::move(control));
  }
  machines_->connect(*this, errors);
  surroundings_->connect(file_, *this, errors);
  resolve_expectations(errors);
  if (!errors.empty()) return;
  machines_->start();
  surroundings_->start();
  tell_findings(*this, journal_);
  power_on();
  check_nodes(*this, journal_);
  disturb_lines();
  plant_faults();
}

void Plant::add_station(size_t number, std::optional<vm::Image> program, std::optional<vm::Rates> rates,
                        std::vector<PlantError>& errors, const Execution& execution) {
  const StationConfig& config = file_.stations[number];
  const StationLines lines = lines_of(number);
  if (program) {
    const std::vector<PlantError> refused = verify_program(config, *program, execution);
    errors.insert(errors.end(), refused.begin(), refused.end());
  }
  const auto [queue, journal, island] = islands_->of_station(number);
  stations_.push_back(std::make_unique<Station>(queue, next_source_++, config, std::move(program), lines, journal, rates,
                                                execution));
  islands_->ask_first(number, [station = stations_.back().get()] { station->look(); });
  open_memory(config, *stations_.back(), errors);
  for (const ParameterSetting& setting : config.parameters)
    if (const auto refused = stations_.back()->set_parameter(setting))
      errors.push_back({setting.place, fmt::format("station '{}': {}", config.name, *refused)});
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

// Stations and controls sit on the cable in the order in which they stand in the file.
void Plant::power_on() {
  auto control = controls_.begin();
  for (const auto& station : stations_) {
    for (; control != controls_.end() && (*control)->config().place.line < station->config().place.line; ++control)
      (*control)->start();
    station->power_on();
  }
  for (; control != controls_.end(); ++control) (*control)->start();
}

// What the file says of a line is as good as a fault from the start; the journal has told what is wrong.
void Plant::disturb_lines() {
  for (const auto& bus : buses_)
    for (const LineDisturbance& disturbance : line_disturbances(file_, bus->config())) {
      WantedFault wanted{disturbance.fault};
      wanted.per_mille = disturbance.per_mille;
      wanted.of_line = true;
      FaultConfig fault = bus->make_fault(wanted);
      fault.bus = bus->name();
      fault.begin_at(0, file_.line_seed);
      bus->plant(fault);
      of_lines_.push_back(std::move(fault));
      journal_.note(queue_.now(), Weight::Warning, "",
                    fmt::format("{}: {}: {} of 1000 {}s are disturbed (how many is a choice of ipos)", bus->name(),
                                disturbance.cause, disturbance.per_mille, info(bus->kind()).message));
    }
}

void Plant::calm_lines() {
  for (const FaultConfig& fault : of_lines_) repair_fault(fault);
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

Bus& Plant::add_bus(const BusConfig& config, Islands::Place place) {
  buses_.push_back(make_bus({place.queue, next_source_++, config, [&journal = place.journal](Time now, std::string text) {
                               journal.note(now, Weight::Warning, "", std::move(text));
                             }}));
  island_of_bus_.push_back(place.island);
  return *buses_.back();
}

size_t Plant::island_of(const Bus& bus) const {
  const auto found = std::find_if(buses_.begin(), buses_.end(), [&](const auto& one) { return one.get() == &bus; });
  return island_of_bus_[static_cast<size_t>(found - buses_.begin())];
}

// A keypad hangs on a line of its own, which comes right before its station.
StationLines Plant::lines_of(size_t number) {
  const StationConfig& station = file_.stations[number];
  const auto line = [](auto* bus) { return bus == nullptr ? nullptr : &bus->line(); };
  const auto can = [&](const std::string& name) { return line(as<CanBus>(find_bus(name))); };
  const auto serial = [&](const std::string& name) { return line(as<SerialBus>(find_bus(name))); };
  StationLines found;
  found.sbus = {can(station.sbus), can(station.sbus2)};
  found.x13 = serial(station.serial.x13.bus);
  found.xt = serial(station.serial.xt.bus);
  found.profibus = as<ProfibusBus>(find_bus(station.profibus.bus.bus));
  if (station.serial.keypad) {
    BusConfig& keypad = keypads_.emplace_back();
    const std::string name = log_name(station.name + ".keypad");
    keypad.name = name;
    // Another line may have the name, where letters were replaced.
    for (int n = 2; find_bus(keypad.name) != nullptr; ++n) keypad.name = fmt::format("{}_{}", name, n);
    keypad.kind = BusKind::Rs485;
    keypad.baud = xt_baud(station);
    found.xt = line(as<SerialBus>(&add_bus(keypad, islands_->of_station(number))));
  }
  return found;
}

void Plant::resolve_expectations(std::vector<PlantError>& errors) {
  for (const Expectation& expectation : file_.expectations) {
    std::string why;
    auto signal = signals::find_signal(*this, expectation.signal, why);
    if (signal) due_.push_back({&expectation, *std::move(signal)});
    if (!why.empty()) errors.push_back({expectation.place, why});
  }
  std::stable_sort(due_.begin(), due_.end(),
                   [](const Due& a, const Due& b) { return a.expectation->at < b.expectation->at; });
  results_.reserve(due_.size());
}

void Plant::add_observer(CanObserver& observer) {
  for (CanBus* bus : all<CanBus>()) bus->line().add_observer(observer);
}

void Plant::add_observer(SerialObserver& observer) {
  for (SerialBus* bus : all<SerialBus>()) bus->line().add_observer(observer);
}

bool Plant::run_until(Time end, const std::function<bool(Time)>& keep_going) {
  for (Time at = queue_.now(); at < end;) {
    at = keep_going ? std::min(end, (at / kMillisecond + 1) * kMillisecond) : end;
    check_expectations(at);
    islands_->run_until(at);
    if (keep_going && (!keep_going(at) || !machines_->failures().empty())) {
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
    if (due.expectation->at > queue_.now()) islands_->run_until(due.expectation->at);
    const int64_t actual = signals::value_for(due.expectation->signal, due.signal);
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
  islands_->gather();
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
