// Names to signals, as every front end reads them; two values are the debugger's own: `now`, and `fault` between a command
// that faults and the tick in which its drive learns of it.
#include "tools/debugger/values.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/signals/find.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::tools::debug {
namespace {

using runtime::Station;
using signals::Signal;

ValuePlace place_of(uint32_t station, std::string_view name, Signal signal, uint32_t elements = 1) {
  return {station, elements, std::string(name), std::make_shared<const Signal>(std::move(signal))};
}

int64_t fault_at_once(const Station& station) {
  const uint8_t fault = station.fault();
  return fault == 0 && station.machine() != nullptr ? station.machine()->fault().number : fault;
}

std::optional<ValuePlace> find_in(Station& station, uint32_t number, std::string_view name) {
  for (const vm::Symbol& symbol : station.symbols())
    if (symbol.name == name)
      return place_of(number, name, signals::signal_at(station, signals::Group::Variable, symbol.variable).value(),
                      symbol.count);
  auto found = signals::find_station_signals(station, name);
  if (found.size() != 1) return std::nullopt;  // a structure has no value of its own
  if (found.front().group == signals::Group::Drive && found.front().own_name().ends_with("fault"))
    found.front().read = [&station] { return fault_at_once(station); };
  return place_of(number, name, std::move(found.front()));
}

}  // namespace

std::optional<ValuePlace> find_value(const runtime::Plant& plant, uint32_t station, std::string_view name) {
  const auto& stations = plant.stations();
  if (name == "now") {
    Signal now;
    now.name = name;
    now.read = [&plant] { return plant.now() / runtime::kMillisecond; };
    now.group = signals::Group::Task;  // no variable
    return place_of(station, name, std::move(now));
  }
  if (station < stations.size())
    if (auto found = find_in(*stations[station], station, name)) return found;
  for (uint32_t n = 0; n < stations.size(); ++n) {
    const std::string prefix = stations[n]->config().name + ".";
    if (!name.starts_with(prefix)) continue;
    if (auto found = find_in(*stations[n], n, name.substr(prefix.size()))) {
      found->name = name;
      return found;
    }
  }
  if (name.find('.') == std::string_view::npos || signals::is_pattern(name)) return std::nullopt;
  auto others = signals::find_signals(plant, name);  // gateways and lines
  if (!others || others->size() != 1) return std::nullopt;
  return place_of(station, name, std::move(others->front()));
}

std::optional<ValuePlace> variable_place(const runtime::Plant& plant, uint32_t station, uint32_t number,
                                         std::string name) {
  auto found = signals::signal_at(*plant.stations()[station], signals::Group::Variable, number);
  if (!found) return std::nullopt;
  return place_of(station, name, *std::move(found));
}

ValuePlace find_again(const runtime::Plant& plant, const ValuePlace& place) {
  ValuePlace found = evaluate_place(plant, place.station, place.name, true);
  found.elements = place.elements;
  return found;
}

int32_t read_value(const ValuePlace& place) {
  const Signal& signal = *place.signal;
  return signal.parameter != nullptr ? static_cast<int32_t>(signal.read()) : static_cast<int32_t>(signal.rounded());
}

void write_value(const ValuePlace& place, int32_t value) {
  const Signal& signal = *place.signal;
  if (signal.put == nullptr) throw ValueError(fmt::format("{} cannot be set", place.name));
  if (signal.is_input()) {
    signal.line().forced = value;
    return;
  }
  if (const auto refused = signal.write(value)) throw ValueError(*refused);
}

std::string number_text(int32_t value, bool hex) {
  return hex ? fmt::format("{:#x}", static_cast<uint32_t>(value)) : fmt::format("{}", value);
}

std::string value_text(const ValuePlace& place, int32_t value, bool hex) {
  const Signal& signal = *place.signal;
  if (signal.parameter != nullptr)
    return fmt::format("{} ({})", hex ? number_text(value, true) : fmt::format("{}", signal.parameter->number_of(value)),
                       signal.words(value));
  return number_text(value, hex) + (signal.unit.empty() || hex ? "" : " " + signal.unit);
}

std::string value_text(const ValuePlace& place, bool hex) {
  const Signal& signal = *place.signal;
  if (hex || signal.parameter != nullptr || signal.factor == 1) return value_text(place, read_value(place), hex);
  return signal.words(signal.read());
}

std::optional<Whole> find_whole(const runtime::Plant& plant, uint32_t station, std::string_view name) {
  const auto in = [&](uint32_t number, std::string_view own) -> std::optional<Whole> {
    const Station& unit = *plant.stations()[number];
    if (unit.machine() == nullptr || unit.image() == nullptr) return std::nullopt;
    auto all = signals::named_variables(unit.image()->symbols, *unit.config().unit, own);
    if (all.size() < 2) return std::nullopt;
    return Whole{number, std::string(own), std::move(all)};
  };
  const auto& stations = plant.stations();
  if (station < stations.size())
    if (auto found = in(station, name)) return found;
  for (uint32_t n = 0; n < stations.size(); ++n)
    if (const std::string prefix = stations[n]->config().name + "."; name.starts_with(prefix))
      if (auto found = in(n, name.substr(prefix.size()))) return found;
  return std::nullopt;
}

std::string whole_text(const runtime::Plant& plant, const Whole& whole, bool hex) {
  constexpr size_t kShown = 32;
  std::string text = "{";
  for (size_t n = 0; n < std::min(whole.variables.size(), kShown); ++n)
    text += (n == 0 ? "" : ", ") +
            number_text(plant.stations()[whole.station]->variable(whole.variables[n].number), hex);
  return text + (whole.variables.size() > kShown ? ", ...}" : "}");
}

int32_t evaluate_for(const runtime::Plant& plant, uint32_t station, const ValuePlace& place,
                     std::string_view text) {
  const size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
  const std::string_view words = text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
  const stdlib::Parameter* row = place.signal->parameter;
  if (row == nullptr) return evaluate(plant, station, words);
  if (const auto shown = words.find(" ("); words.ends_with(')') && shown != std::string_view::npos) {
    // Of what is shown a person changes either the number or the words.
    try {
      const int32_t value = evaluate(plant, station, words.substr(0, shown));
      const auto told = stdlib::parse_parameter_text(*row, words.substr(shown + 2, words.size() - shown - 3));
      return told && value == read_value(place) ? *told : value;
    } catch (const ValueError&) {  // "2 * (1 + 1)" is an expression as a whole
    }
  }
  try {
    return evaluate(plant, station, words);
  } catch (const ValueError&) {
    if (const auto told = stdlib::parse_parameter_text(*row, words)) return *told;
    throw;
  }
}

}  // namespace ipos::tools::debug
