// The kinds of the C functions are groups of signals; names are looked for in the order of the kinds.
#include "runtime/library/signal_id.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "runtime/signals/gateways.hpp"
#include "runtime/signals/variables.hpp"
#include "stdlib/spelling.hpp"

namespace ipos::library {
namespace {

using runtime::Plant;
using signals::Group;
using signals::Signal;

struct KindRow {
  std::string_view word;
  std::optional<Group> group;
};
constexpr KindRow kKinds[] = {{"signal", {}},
                              {"variable", Group::Variable},
                              {"parameter", Group::Parameter},
                              {"input", Group::Input},
                              {"output", Group::Output},
                              {"analog input", Group::Analog},
                              {"state", Group::State},
                              {"process word", Group::ProcessData},
                              {"signal", {}},
                              {"value of the shaft", Group::Drive}};
constexpr std::string_view kShaft[] = {"load_torque", "shaft_speed"};
constexpr Kind kNamed[] = {Kind::Variable, Kind::Parameter, Kind::Input, Kind::Output,
                           Kind::Analog,   Kind::State,     Kind::Word,  Kind::Shaft, Kind::Signal};

const KindRow& row_of(Kind kind) { return kKinds[static_cast<size_t>(kind)]; }

// The words are those of the bus; of the drive's values it is what acts on the shaft.
bool belongs(Kind kind, const Signal& signal) {
  if (kind == Kind::Shaft) return std::find(std::begin(kShaft), std::end(kShaft), signal.own_name()) != std::end(kShaft);
  return kind != Kind::Word || signal.number != UINT32_MAX;
}

// An analog input is one terminal here.
std::string_view name_in(Kind kind, const Signal& signal) {
  return kind == Kind::Analog ? runtime::input_name(signal.number) : signal.own_name();
}

std::optional<SignalId> find_of_kind(Station& station, uint32_t number, Kind kind, std::string_view name) {
  const auto group = row_of(kind).group;
  if (!group) {
    if (signals::find_station_signals(station, name).size() != 1) return std::nullopt;
    return SignalId{number, Kind::Signal, 0};
  }
  if (kind == Kind::Analog) {
    const int line = runtime::parse_analog_input(name);
    return line < 0 ? std::nullopt : std::optional(SignalId{number, kind, static_cast<uint32_t>(line)});
  }
  const auto found = signals::find_in_group(station, *group, name);
  if (!found || !belongs(kind, *found)) return std::nullopt;
  return SignalId{number, kind, found->number};
}

std::vector<std::string> gateway_names(const runtime::Gateway& gateway, Kind kind) {
  std::vector<std::string> names;
  for (const Signal& signal : signals::gateway_signals(gateway))
    if (kind == Kind::Signal || (kind == Kind::State && signal.group == Group::State))
      names.emplace_back(signal.own_name());
  return names;
}

std::string full_name(const runtime::Bus& line, std::string_view name) { return fmt::format("{}.{}", line.name(), name); }

// A line keeps its telegrams from the first look on, which is here.
std::optional<Signal> find_of_line(const Plant& plant, const runtime::Bus& line, std::string_view name) {
  auto found = signals::find_signals(plant, full_name(line, name));
  if (!found || found->size() != 1) return std::nullopt;
  found->front().read();
  return std::move(found->front());
}

std::vector<std::string> line_names(const Plant& plant, const runtime::Bus& line) {
  std::vector<std::string> names;
  if (const auto found = signals::find_signals(plant, full_name(line, "*")))
    for (const Signal& signal : *found) names.emplace_back(signal.name.substr(line.name().size() + 1));
  return names;
}

// Every name that a kind has; of Any those of all kinds that have a few.
std::vector<std::string> all_names(const Plant& plant, uint32_t number, Kind kind) {
  if (kind != Kind::Any) return signal_names(plant, number, kind);
  std::vector<std::string> names;
  for (const Kind each : kNamed)
    for (std::string& name : signal_names(plant, number, each)) names.push_back(std::move(name));
  return names;
}

// " (did you mean 'speed'?); it has lCount, ...": the nearest name of all, and the first ones of the kind.
std::string what_there_is(const Plant& plant, uint32_t number, Kind kind, std::string_view name) {
  const Station& station = *plant.stations()[number];
  constexpr size_t kShown = 24;
  std::vector<std::string> names = signal_names(plant, number, kind == Kind::Any ? Kind::Variable : kind);
  const size_t count = names.size();
  if (count > kShown) names.resize(kShown);
  std::string known = count == 0 ? "none" : fmt::format("{}", fmt::join(names, ", "));
  if (count > kShown) known += fmt::format(" and {} more", count - kShown);
  if (kind == Kind::Any || kind == Kind::Variable)
    known = station.has_variables() ? fmt::format("{}H0..H{} and the system variables",
                                                  count == 0 ? "" : known + ", ", station.config().unit->variables - 1)
                                    : "no variables: its unit has no IPOS";
  if (kind == Kind::Any)
    known += fmt::format("; states {}; terminals, words and parameters",
                         fmt::join(signal_names(plant, number, Kind::State), ", "));
  const bool is_whole = count <= kShown && kind != Kind::Any && kind != Kind::Variable;  // the list needs no hint
  const std::vector<std::string> all = is_whole ? std::vector<std::string>() : all_names(plant, number, kind);
  const std::vector<std::string_view> candidates(all.begin(), all.end());
  const std::string_view best = stdlib::nearest(name, candidates);
  return fmt::format("{}; it has {}", best.empty() ? "" : fmt::format(" (did you mean '{}'?)", best), known);
}

}  // namespace

size_t station_count(const Plant& plant) {
  size_t count = plant.stations().size();
  while (gateway_of(plant, static_cast<uint32_t>(count)) != nullptr) ++count;
  return count;
}

runtime::Gateway* gateway_of(const Plant& plant, uint32_t station) {
  if (station < plant.stations().size()) return nullptr;
  const size_t behind = station - plant.stations().size();
  const auto gateways = plant.all<runtime::Gateway>();
  return behind < gateways.size() ? gateways[behind] : nullptr;
}

runtime::Bus* line_of(const Plant& plant, uint32_t station) {
  if (station < kLine) return nullptr;
  std::vector<runtime::Bus*> lines;
  const auto add = [&](const auto& of_class) { lines.insert(lines.end(), of_class.begin(), of_class.end()); };
  add(plant.all<runtime::CanBus>());
  add(plant.all<runtime::SerialBus>());
  add(plant.all<runtime::ProfibusBus>());
  return station - kLine < lines.size() ? lines[station - kLine] : nullptr;
}

bool has_signals(const Plant& plant, uint32_t station) {
  return station < station_count(plant) || line_of(plant, station) != nullptr;
}

std::string station_names(const Plant& plant) {
  std::vector<std::string_view> names;
  for (const auto& station : plant.stations()) names.push_back(station->config().name);
  for (const runtime::Gateway* gateway : plant.all<runtime::Gateway>()) names.push_back(gateway->name());
  return fmt::format("{}", fmt::join(names, ", "));
}

tl::expected<SignalId, std::string> find_id(const Plant& plant, uint32_t number, Kind kind, std::string_view name) {
  if (const runtime::Gateway* gateway = gateway_of(plant, number)) {
    const bool fits = kind == Kind::Any || kind == Kind::Signal || kind == Kind::State;
    if (fits && signal_of(plant, {number, Kind::Signal, 0}, name)) return SignalId{number, Kind::Signal, 0};
    return tl::unexpected(fmt::format("gateway '{}' has no {} '{}'; it has {}", gateway->config().name,
                                      row_of(kind).word, name, signals::names_of(signals::gateway_signals(*gateway))));
  }
  if (const runtime::Bus* line = line_of(plant, number)) {
    if ((kind == Kind::Any || kind == Kind::Signal) && find_of_line(plant, *line, name)) return SignalId{number, Kind::Signal, 0};
    return tl::unexpected(fmt::format("line '{}' has no {} '{}'; it has {}, and telegrams as 013.PO2", line->name(), row_of(kind).word,
                                      name, fmt::join(line_names(plant, *line), ", ")));
  }
  Station& station = *plant.stations()[number];
  for (const Kind each : kNamed)
    if (kind == Kind::Any || kind == each)
      if (const auto found = find_of_kind(station, number, each, name)) return *found;
  return tl::unexpected(fmt::format("station '{}' has no {} '{}'{}", station.config().name, row_of(kind).word, name,
                                    what_there_is(plant, number, kind, name)));
}

std::optional<Signal> signal_of(const Plant& plant, const SignalId& id, std::string_view name) {
  if (const runtime::Gateway* gateway = gateway_of(plant, id.station))
    return id.kind == Kind::Signal ? signals::find_among(signals::gateway_signals(*gateway),
                                                         fmt::format("{}.{}", gateway->config().name, name))
                                   : std::nullopt;
  if (const runtime::Bus* line = line_of(plant, id.station))
    return id.kind == Kind::Signal ? find_of_line(plant, *line, name) : std::nullopt;
  if (id.station >= plant.stations().size()) return std::nullopt;
  Station& station = *plant.stations()[id.station];
  if (const auto group = row_of(id.kind).group) return signals::signal_at(station, *group, id.number);
  auto found = signals::find_station_signals(station, name);
  return found.size() == 1 ? std::optional(std::move(found.front())) : std::nullopt;
}

std::optional<SignalId> id_of(const Plant& plant, const Signal& signal) {
  const Group group = signal.group == Group::SystemVariable ? Group::Variable : signal.group;
  const auto& stations = plant.stations();
  const auto station = std::find_if(stations.begin(), stations.end(), [&](const auto& each) { return each.get() == signal.owner; });
  if (station == stations.end() || signal.put == nullptr) return std::nullopt;
  for (const Kind kind : kNamed)
    if (row_of(kind).group == group)
      return SignalId{static_cast<uint32_t>(station - stations.begin()), kind, signal.number};
  return std::nullopt;
}

std::vector<std::string> signal_names(const Plant& plant, uint32_t number, Kind kind,
                                      std::optional<std::string_view> part) {
  if (const runtime::Gateway* gateway = gateway_of(plant, number)) return gateway_names(*gateway, kind);
  if (const runtime::Bus* line = line_of(plant, number))
    return kind == Kind::Signal ? line_names(plant, *line) : std::vector<std::string>();
  Station& station = *plant.stations()[number];
  std::vector<std::string> names;
  if (kind == Kind::Variable && part) {
    for (auto& found : signals::named_variables(station.symbols(), *station.config().unit, *part))
      names.push_back(std::move(found.name));
    return names;
  }
  const auto group = row_of(kind).group;
  for (const Signal& signal : group ? signals::signals_of(station, *group) : signals::station_signals(station))
    if (const std::string_view name = name_in(kind, signal);
        belongs(kind, signal) && (names.empty() || names.back() != name))
      names.emplace_back(name);
  return names;
}

}  // namespace ipos::library
