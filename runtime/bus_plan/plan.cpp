// The trial run and the order of the planning steps.
#include "runtime/bus_plan/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus_plan/checks.hpp"
#include "runtime/bus_plan/identifiers.hpp"
#include "runtime/bus_plan/profibus_lines.hpp"
#include "runtime/bus_plan/roster.hpp"
#include "runtime/bus_plan/serial_lines.hpp"
#include "runtime/bus_plan/telegrams.hpp"
#include "runtime/plant_file/can_cable.hpp"

namespace ipos::runtime {
namespace {

constexpr FindingType kFindingTypes[] = {
#define FINDING(name, code, weight, meaning) {FindingKind::name, code, FindingWeight::weight, meaning},
#include "runtime/bus_plan/findings.def"
};

// Distances of equal identifiers in the trial run.
class Watcher final : public CanObserver {
 public:
  void on_frame(const CanLine& line, const FrameRecord& record) override {
    if (!is_plain(record.frame)) return;
    SeenTelegram& telegram = seen[&line][record.frame.id];
    if (telegram.count++ > 0) telegram.closest = std::min(telegram.closest, record.end - telegram.last);
    telegram.last = record.end;
  }
  void on_line_event(const CanLine&, const LineEvent&) override {}

  std::map<const CanLine*, SeenTelegrams> seen;
};

}  // namespace

std::span<const FindingType> finding_types() { return kFindingTypes; }

const FindingType& finding_type(FindingKind kind) { return kFindingTypes[static_cast<size_t>(kind)]; }

bool BusPlan::has_errors() const {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding_type(finding.kind).weight == FindingWeight::Error;
  });
}

void check_timing(const LinePlan& plan, std::vector<Finding>& findings) {
  const uint64_t percent_tenths = plan.load_bits * 1000 / plan.baud;
  if (plan.load_bits * 100 > uint64_t{plan.baud} * 70)
    findings.push_back({FindingKind::Overload, plan.name,
                        fmt::format("worst-case load {}.{} %, at most 70 % may be planned",
                                    percent_tenths / 10, percent_tenths % 10)});
  for (const PlannedTelegram& telegram : plan.telegrams) {
    if (telegram.rhythm != Rhythm::Cyclic ||
        (telegram.response.bounded && telegram.response.worst <= telegram.period))
      continue;
    const std::string response = telegram.response.bounded
                                     ? fmt::format("may take {} us", telegram.response.worst / kMicrosecond)
                                     : std::string("may wait for ever");
    findings.push_back(
        {FindingKind::TooLate, plan.name,
         fmt::format("{} of {}, identifier {}, {}, its period is {} us", telegram.what, telegram.sender,
                     id_words(telegram.id), response, telegram.period / kMicrosecond)});
  }
}

BusPlan make_plan(Plant& plant, const PlanOptions& options) {
  Watcher watcher;
  plant.add_observer(watcher);
  SerialWatcher serial_watcher;
  plant.add_observer(serial_watcher);
  plant.calm_lines();
  plant.run_until(options.trial);

  BusPlan plan;
  plan.trial = options.trial;
  plan.acyclic = options.acyclic;
  for (const LineRoster& roster : line_rosters(plant)) {
    LinePlan line;
    line.name = roster.config->name;
    line.baud = roster.config->baud;
    line.stations = roster.members.size();
    line.length = (roster.config->length_mm + 999) / 1000;
    line.length_limit = can_length_limit(line.baud);
    line.identifiers = planned_identifiers(roster);
    line.closed = closed_identifiers(roster);
    line.telegrams = planned_telegrams(roster, watcher.seen[roster.line], options);
    analyse(line.telegrams, roster.line->bit_time());
    line.load_bits = worst_load(line.telegrams);
    check_cable(roster, plant.file(), plan.findings);
    check_profile(roster, line, plan.findings);
    check_objects(roster, line, plan.findings);
    check_timing(line, plan.findings);
    plan.lines.push_back(std::move(line));
  }
  plan_serial_lines(plant, serial_watcher, plan);
  plan_profibus_lines(plant, plan);
  check_reached(plant, plan.findings);
  return plan;
}

}  // namespace ipos::runtime
