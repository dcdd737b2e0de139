// Names to values. Parameters are read as the drive shows them and written as over the parameter channel,
// volatile; so are variables, which are parameters 11000 + n (IPOSplus p. 28).
#include "tools/debug/values.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/plant_file/signal.hpp"
#include "runtime/signals/variable_names.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::tools::debug {
namespace {

using runtime::Station;

constexpr uint32_t kFirstVariable = 11'000;

std::optional<ValuePlace> find_variable(const Station& station, uint32_t number, std::string_view name) {
  ValuePlace place{number, ValueKind::Variable, 0, 1, std::string(name)};
  for (const vm::Symbol& symbol : station.symbols())
    if (symbol.name == name) {
      place.number = symbol.variable;
      place.elements = symbol.count;
      return place;
    }
  const auto found = signals::named_variables(station.symbols(), *station.config().unit, name);
  if (found.size() != 1) return std::nullopt;  // a structure has no value of its own
  place.number = found.front().number;
  return place;
}

std::optional<ValuePlace> find_in(const Station& station, uint32_t number, std::string_view name) {
  if (auto variable = find_variable(station, number, name)) return variable;
  ValuePlace place{number, ValueKind::Input, 0, 1, std::string(name)};
  if (const int line = runtime::parse_input(name); line >= 0) {
    place.number = static_cast<uint32_t>(line);
    return place;
  }
  place.kind = ValueKind::Output;
  if (const int bit = runtime::parse_output(name); bit >= 0) {
    place.number = static_cast<uint32_t>(bit);
    return place;
  }
  place.kind = ValueKind::Parameter;
  const auto* row =
      name.starts_with('P') ? stdlib::parameter_table(*station.config().unit).find(name) : nullptr;
  if (row != nullptr && row->index != 0) {
    place.number = row->index;
    return place;
  }
  place.kind = ValueKind::Fault;
  if (name == "fault") return place;
  auto found = signals::find_station_signals(station, name);
  if (found.size() != 1) return std::nullopt;
  place.kind = ValueKind::Signal;
  place.signal = std::make_shared<const signals::Signal>(std::move(found.front()));
  return place;
}

// The row of the table; nullptr when the place is no parameter.
const stdlib::Parameter* parameter_of(const runtime::Plant& plant, const ValuePlace& place) {
  if (place.kind != ValueKind::Parameter) return nullptr;
  const auto& table = stdlib::parameter_table(*plant.stations()[place.station]->config().unit);
  const auto* row = table.find(place.name.substr(place.name.rfind('.') + 1));
  return row != nullptr ? row : table.find(static_cast<uint16_t>(place.number));
}

}  // namespace

std::optional<ValuePlace> find_value(const runtime::Plant& plant, uint32_t station, std::string_view name) {
  if (name == "now") return ValuePlace{station, ValueKind::Time, 0, 1, "now"};
  const auto& stations = plant.stations();
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
  return std::nullopt;
}

int32_t read_value(const runtime::Plant& plant, const ValuePlace& place) {
  Station& station = *plant.stations()[place.station];
  switch (place.kind) {
    case ValueKind::Variable: return station.variable(place.number);
    case ValueKind::Parameter: return station.drive().parameters().value(static_cast<uint16_t>(place.number));
    case ValueKind::Input: return station.inputs().line(place.number).value();
    case ValueKind::Output: return station.drive().state().outputs() >> place.number & 1;
    case ValueKind::Time: return static_cast<int32_t>(plant.now() / runtime::kMillisecond);
    case ValueKind::Signal: return static_cast<int32_t>(place.signal->read());
    case ValueKind::Fault: break;
  }
  // After the command that faults the drive does not know of it yet.
  const uint8_t fault = station.fault();
  return fault == 0 && station.machine() != nullptr ? station.machine()->fault().number : fault;
}

void write_value(runtime::Plant& plant, const ValuePlace& place, int32_t value) {
  Station& station = *plant.stations()[place.station];
  uint32_t index = place.number;
  switch (place.kind) {
    case ValueKind::Input: station.inputs().line(place.number).forced = value; return;
    case ValueKind::Variable: index = kFirstVariable + place.number; break;
    case ValueKind::Parameter: break;
    case ValueKind::Output:
    case ValueKind::Time:
    case ValueKind::Signal:
    case ValueKind::Fault: throw ValueError(fmt::format("{} cannot be set", place.name));
  }
  runtime::ParameterStore& parameters = station.drive().parameters();
  const auto service = runtime::ParameterService::WriteVolatile;
  const auto reply = parameters.execute(service, static_cast<uint16_t>(index), value);
  if (!reply)
    throw ValueError(parameters.explain(static_cast<uint8_t>(service), static_cast<uint16_t>(index), value,
                                        reply.error()));
}

std::string number_text(int32_t value, bool hex) {
  return hex ? fmt::format("{:#x}", static_cast<uint32_t>(value)) : fmt::format("{}", value);
}

std::string value_text(const runtime::Plant& plant, const ValuePlace& place, int32_t value, bool hex) {
  if (place.kind == ValueKind::Signal && !place.signal->unit.empty())
    return fmt::format("{} ({} {})", number_text(value, hex), place.signal->text(value), place.signal->unit);
  const stdlib::Parameter* row = parameter_of(plant, place);
  if (row == nullptr) return number_text(value, hex);
  return fmt::format("{} ({})", hex ? number_text(value, true) : fmt::format("{}", row->number_of(value)),
                     stdlib::parameter_text(*row, value));
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
  const stdlib::Parameter* row = parameter_of(plant, place);
  if (row == nullptr) return evaluate(plant, station, words);
  if (const auto shown = words.find(" ("); words.ends_with(')') && shown != std::string_view::npos) {
    // Of what is shown a person changes either the number or the words.
    try {
      const int32_t value = evaluate(plant, station, words.substr(0, shown));
      const auto told = stdlib::parse_parameter_text(*row, words.substr(shown + 2, words.size() - shown - 3));
      return told && value == read_value(plant, place) ? *told : value;
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
