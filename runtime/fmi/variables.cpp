// Which signals an FMU has, in which order, and what each of them is to a simulator.
#include "runtime/fmi/variables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runtime/fmi/names.hpp"
#include "runtime/fmi/types.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::fmi {
namespace {

using runtime::Plant;
using runtime::Station;
using signals::Group;
using signals::Signal;

// Inputs that hang on something in the plant: nobody else can set them.
std::set<std::string> wired_inputs(const runtime::PlantFile& file) {
  std::set<std::string> wired;
  const auto add = [&](const runtime::Signal& input) { wired.insert(fmt::format("{}.{}", input.station, input.name)); };
  for (const auto& wire : file.wires) add(wire.to);
  for (const auto& cam : file.switches) add(cam.input);
  for (const auto& barrier : file.barriers) add(barrier.input);
  return wired;
}

// The unit has the terminal, not only the list of names.
bool has_terminal(const stdlib::UnitType& unit, const Signal& signal) {
  if (signal.group == Group::Analog) {
    for (const runtime::AnalogKind& kind : runtime::analog_kinds())
      if (runtime::line_of(kind) == signal.number) return kind.is_of(unit);
    return false;
  }
  const auto terminals = signal.group == Group::Input ? runtime::binary_inputs() : runtime::binary_outputs();
  for (const runtime::BinaryTerminal& terminal : terminals)
    if (terminal.bit == signal.number)
      return terminal.parameter.empty() || stdlib::parameter_table(unit).find(terminal.parameter) != nullptr;
  return false;
}

bool is_shown_by_a_terminal(const Signal& signal) {
  return signal.group == Group::Input || signal.group == Group::Output || signal.group == Group::Analog;
}

class Collection {
 public:
  Collection(Plant& plant, Variables& out) : wired_(wired_inputs(plant.file())), types_(out) {}

  void choose(const Signal& signal) {
    if (chosen_.insert(signal.name).second) ordered_.push_back(signal);
  }

  void add_station(Station& station) {
    const stdlib::UnitType& unit = *station.config().unit;
    for (const Signal& signal : signals::station_signals(station))
      if (!is_shown_by_a_terminal(signal) || has_terminal(unit, signal)) add(signal, causality_of(signal));
    for (const Signal& signal : signals::signals_of(station, Group::Parameter))
      if (signal.is_writable() && signal.own_name().starts_with('P')) add(signal, Causality::Parameter);
  }

  void add(const Signal& signal, Causality causality) {
    if (!names_.insert(signal.name).second) return;
    if (causality == Causality::Local && chosen_.contains(signal.name)) causality = Causality::Output;
    types_.add(signal, causality);
  }

  void add_chosen() {
    for (const Signal& signal : ordered_) add(signal, Causality::Output);
  }

 private:
  Causality causality_of(const Signal& signal) const {
    if (signal.is_input()) return wired_.contains(signal.name) ? Causality::Local : Causality::Input;
    switch (signal.group) {
      case Group::Drive: return signal.put != nullptr ? Causality::Input : Causality::Output;
      case Group::Variable:
      case Group::SystemVariable:
      case Group::Task: return Causality::Local;
      default: return Causality::Output;
    }
  }

  std::set<std::string> wired_;
  std::set<std::string> names_;
  std::set<std::string> chosen_;
  std::vector<Signal> ordered_;
  Types types_;
};

bool is_chosen(const Choice& choice, const std::string& station) {
  return choice.stations.empty() || std::find(choice.stations.begin(), choice.stations.end(), station) != choice.stations.end();
}

// The load of lines, and gateways; what their telegrams carry only where somebody asks for it.
void add_others(const Plant& plant, const Choice& choice, Collection& out) {
  const auto is_station = [&](const std::string& name) {
    return std::any_of(plant.stations().begin(), plant.stations().end(),
                       [&](const auto& station) { return station->config().name == name; });
  };
  for (const Signal& signal : signals::plant_signals(plant)) {
    if (is_station(signal.station)) continue;
    if (plant.find_gateway(signal.station) != nullptr) {
      if (is_chosen(choice, signal.station)) out.add(signal, Causality::Output);
    } else if (signal.own_name() == "load" || signal.own_name() == "count") {
      out.add(signal, Causality::Output);
    }
  }
}

std::string unknown_station(const Plant& plant, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& station : plant.stations()) names.push_back(station->config().name);
  for (const runtime::Gateway* gateway : plant.all<runtime::Gateway>()) names.push_back(gateway->name());
  return fmt::format("there is no station '{}'; the plant has {}", name, fmt::join(names, ", "));
}

}  // namespace

tl::expected<Variables, std::string> variables_of(Plant& plant, const Choice& choice) {
  for (const std::string& name : choice.stations) {
    const bool known = plant.find_gateway(name) != nullptr ||
                       std::any_of(plant.stations().begin(), plant.stations().end(),
                                   [&](const auto& station) { return station->config().name == name; });
    if (!known) return tl::unexpected(unknown_station(plant, name));
  }
  Variables variables;
  Collection collection(plant, variables);
  for (const std::string& name : choice.signals) {
    auto found = signals::find_signals(plant, name);
    if (!found) return tl::unexpected(std::move(found).error());
    for (const Signal& signal : *found) collection.choose(signal);
  }
  for (const auto& station : plant.stations())
    if (is_chosen(choice, station->config().name)) collection.add_station(*station);
  add_others(plant, choice, collection);
  collection.add_chosen();
  return variables;
}

}  // namespace ipos::fmi
