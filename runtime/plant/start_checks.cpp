// Findings on paper, and addresses that are given twice.
#include "runtime/plant/start_checks.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "runtime/plant_file/serial_plan.hpp"
#include "runtime/plant_file/state_names.hpp"
#include "runtime/signals/find.hpp"

namespace ipos::runtime {
namespace {

// The check of an SBus tells of two units with one address, and watches their telegrams.
void check_slaves(const Plant& plant) {
  for (const auto& station : plant.stations())
    for (const int number : {1, 2})
      if (const SbusPort* port = station->sbus(number))
        as<CanBus>(plant.find_bus(port->line().name()))
            ->check()
            .add_slave(plant.now(), port->line(), port->node(), port->settings().slave);
}

}  // namespace

void tell_findings(const Plant& plant, Journal& journal) {
  const Time now = plant.now();
  for (const auto& station : plant.stations())
    for (const std::string& name : signals::hidden_names(*station))
      journal.note(now, Weight::Why, station->config().name,
                   fmt::format("'{0}' is a variable of the program, and hides what the unit calls so: that is 'drive.{0}'", name));
  for (const Expectation& expectation : plant.file().expectations)
    if (const std::string old = old_state(expectation.signal.name);
        expectation.signal.kind == SignalKind::State && !old.empty()) {
      journal.note(now, Weight::Why, expectation.signal.station, old);
      break;
    }
  const ParameterOf parameter = [&plant](size_t station, std::string_view number) {
    return std::as_const(*plant.stations()[station]).drive().value(number);
  };
  for (const PlanFinding& finding : serial_findings(plant.file(), parameter))
    journal.note(now, Weight::Warning, finding.station, finding.text);
  for (const auto& bus : plant.buses())
    for (const std::string& text : bus->findings(plant.file()))
      journal.note(now, Weight::Warning, "", fmt::format("{}: {}", bus->name(), text));
}

// Two nodes with one number send the same identifiers, and both answer (CiA 301: a number is given once).
void check_nodes(const Plant& plant, Journal& journal) {
  check_slaves(plant);
  std::vector<std::pair<const CanopenPort*, const Station*>> nodes;
  for (const auto& station : plant.stations())
    for (const int sbus : {1, 2}) {
      const CanopenPort* const port = std::as_const(*station).canopen(sbus);
      if (port == nullptr) continue;
      const uint8_t node = port->settings().canopen_address;
      for (const auto& [other, of] : nodes)
        if (&other->line() == &port->line() && other->settings().canopen_address == node)
          journal.note(plant.now(), Weight::Warning, "",
                       fmt::format("{}: {} and {} both have CANopen address {}: they send the same identifiers, and "
                                   "their answers collide",
                                   port->line().name(), of->config().name, station->config().name, node));
      nodes.emplace_back(port, station.get());
    }
}

}  // namespace ipos::runtime
