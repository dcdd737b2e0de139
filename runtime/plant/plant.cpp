// Builds a plant from its file and runs it.
#include "runtime/plant/plant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "runtime/plant/serial_plan.hpp"

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

}  // namespace

Plant::Plant(PlantFile file, std::vector<std::optional<vm::Image>> programs, std::optional<vm::Rates> rates,
             std::vector<PlantError>& errors)
    : file_(std::move(file)) {
  // Sources order the events of one moment: first the lines, then the stations, each in the order of the
  // file.
  make_lines();
  for (size_t n = 0; n < file_.stations.size(); ++n) {
    const StationConfig& config = file_.stations[n];
    const StationLines lines = lines_of(config);
    if (programs[n]) {
      const std::vector<PlantError> refused = verify_program(config, *programs[n]);
      errors.insert(errors.end(), refused.begin(), refused.end());
    }
    stations_.push_back(std::make_unique<Station>(queue_, next_source_++, config, std::move(programs[n]),
                                                  lines, journal_, rates));
    for (const ParameterSetting& setting : config.parameters)
      if (const auto refused = stations_.back()->set_parameter(setting))
        errors.push_back({setting.place, fmt::format("station '{}': {}", config.name, *refused)});
  }
  resolve_expectations(errors);
  if (!errors.empty()) return;
  tell_findings();
  for (const auto& station : stations_) station->power_on();
}

void Plant::make_lines() {
  for (const BusConfig& bus : file_.buses) {
    if (is_serial(bus.kind)) {
      add_serial_line(bus.name, bus.baud, next_source_++);
      continue;
    }
    lines_.push_back(std::make_unique<CanLine>(queue_, next_source_++, bus.name, bus.baud));
    lines_.back()->add_observer(*this);
  }
}

void Plant::add_serial_line(const std::string& name, uint32_t baud, uint32_t source) {
  serial_lines_.push_back(std::make_unique<SerialLine>(
      queue_, source, name, baud,
      [this](Time now, std::string text) { journal_.note(now, Weight::Warning, "", std::move(text)); }));
}

// A keypad hangs on a line of its own, which comes right before its station.
StationLines Plant::lines_of(const StationConfig& station) {
  const auto serial = [this](const std::string& name) -> Rs485Line* {
    for (const auto& line : serial_lines_)
      if (!name.empty() && line->line.name() == name) return &line->line;
    return nullptr;
  };
  StationLines found;
  for (const auto& line : lines_)
    if (line->name() == station.sbus) found.sbus = line.get();
  found.x13 = serial(station.serial.x13.bus);
  found.xt = serial(station.serial.xt.bus);
  if (station.serial.keypad) {
    add_serial_line(station.name + ".keypad", xt_baud(station), next_source_++);
    found.xt = &serial_lines_.back()->line;
  }
  return found;
}

void Plant::tell_findings() {
  const ParameterOf parameter = [this](size_t station, std::string_view number) {
    return stations_[station]->drive().value(number);
  };
  for (const PlanFinding& finding : serial_findings(file_, parameter))
    journal_.note(queue_.now(), Weight::Warning, finding.station, finding.text);
}

void Plant::resolve_expectations(std::vector<PlantError>& errors) {
  for (const Expectation& expectation : file_.expectations) {
    const auto station = std::find_if(stations_.begin(), stations_.end(), [&](const auto& candidate) {
      return candidate->config().name == expectation.station;
    });
    if (station == stations_.end()) continue;  // reported by read_plant_file
    const auto variable = (*station)->find_variable(expectation.variable);
    if (variable)
      due_.push_back({&expectation, station->get(), *variable});
    else
      errors.push_back({expectation.place, fmt::format("station '{}' has no variable '{}'",
                                                       expectation.station, expectation.variable)});
  }
  std::stable_sort(due_.begin(), due_.end(),
                   [](const Due& a, const Due& b) { return a.expectation->at < b.expectation->at; });
}

void Plant::add_observer(CanObserver& observer) {
  for (const auto& line : lines_) line->add_observer(observer);
}

void Plant::add_observer(SerialObserver& observer) {
  for (const auto& line : serial_lines_) line->line.add_observer(observer);
}

bool Plant::run_until(Time end, const std::function<bool(Time)>& keep_going) {
  for (Time at = queue_.now(); at < end;) {
    at = std::min(end, (at / kMillisecond + 1) * kMillisecond);
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
    const int32_t actual = due.station->variable(due.variable);
    results_.push_back({due.expectation, actual == due.expectation->equals, actual});
  }
}

bool Plant::programs_over() const {
  return std::all_of(stations_.begin(), stations_.end(),
                     [](const auto& station) { return station->program_over(); });
}

bool Plant::has_fault() const {
  return std::any_of(stations_.begin(), stations_.end(),
                     [](const auto& station) { return station->error(); });
}

void Plant::on_frame(const CanLine& /*line*/, const FrameRecord& /*record*/) {}

void Plant::on_line_event(const CanLine& line, const LineEvent& event) {
  journal_.note(event.time, Weight::Warning, "", describe(line, event));
}

}  // namespace ipos::runtime
