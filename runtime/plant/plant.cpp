// Builds a plant from its file and runs it.
#include "runtime/plant/plant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

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
  for (const BusConfig& bus : file_.buses) {
    lines_.push_back(std::make_unique<CanLine>(queue_, next_source_++, bus.name, bus.baud));
    lines_.back()->add_observer(*this);
  }
  for (size_t n = 0; n < file_.stations.size(); ++n) {
    const StationConfig& config = file_.stations[n];
    const auto line = std::find_if(lines_.begin(), lines_.end(),
                                   [&](const auto& candidate) { return candidate->name() == config.sbus; });
    if (programs[n]) {
      const std::vector<PlantError> refused = verify_program(config, *programs[n]);
      errors.insert(errors.end(), refused.begin(), refused.end());
    }
    stations_.push_back(std::make_unique<Station>(queue_, next_source_++, config, std::move(programs[n]),
                                                  line == lines_.end() ? nullptr : line->get(), journal_,
                                                  rates));
    for (const ParameterSetting& setting : config.parameters)
      if (const auto refused = stations_.back()->set_parameter(setting))
        errors.push_back({setting.place, fmt::format("station '{}': {}", config.name, *refused)});
  }
  resolve_expectations(errors);
  if (!errors.empty()) return;
  for (const auto& station : stations_) station->power_on();
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
