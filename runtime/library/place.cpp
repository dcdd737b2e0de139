// The kinds of signals, one function for each question about them.
#include "runtime/library/place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "runtime/plant_file/signal.hpp"
#include "runtime/signals/gateway_signals.hpp"
#include "runtime/signals/station_signals.hpp"
#include "runtime/signals/station_state.hpp"
#include "runtime/signals/variable_names.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/spelling.hpp"

namespace ipos::library {
namespace {

using runtime::Plant;

constexpr std::string_view kWordNames[] = {"PO1", "PO2", "PO3", "PI1", "PI2", "PI3"};

constexpr std::string_view kind_word(Kind kind) {
  constexpr std::string_view kWords[] = {"signal",       "variable", "parameter",    "input", "output",
                                         "analog input", "state",    "process word", "signal"};
  return kWords[static_cast<size_t>(kind)];
}

const Station& station_of(const Plant& plant, const Place& place) { return *plant.stations()[place.station]; }
Station& station_of(Plant& plant, const Place& place) { return *plant.stations()[place.station]; }

const stdlib::Parameter* parameter_of(const Station& station, uint32_t index) {
  if (index == 0 || index > UINT16_MAX) return nullptr;
  return stdlib::parameter_table(*station.config().unit).find(static_cast<uint16_t>(index));
}

const stdlib::Parameter* parameter_of(const Station& station, std::string_view name) {
  if (!name.starts_with('P') && name.find_first_not_of("0123456789") != std::string_view::npos)
    return nullptr;
  const auto* row = stdlib::parameter_table(*station.config().unit).find(name);
  return row != nullptr && row->index != 0 ? row : nullptr;
}

std::optional<uint32_t> find_number(const Station& station, Kind kind, std::string_view name) {
  const auto not_negative = [](int number) {
    return number < 0 ? std::nullopt : std::optional(static_cast<uint32_t>(number));
  };
  switch (kind) {
    case Kind::Variable: return signals::find_variable(station, name);
    case Kind::Parameter: {
      const auto* row = parameter_of(station, name);
      return row == nullptr ? std::nullopt : std::optional<uint32_t>(row->index);
    }
    case Kind::Input: return not_negative(runtime::parse_input(name));
    case Kind::Output: return not_negative(runtime::parse_output(name));
    case Kind::Analog: return not_negative(runtime::parse_analog_input(name));
    case Kind::State: return not_negative(runtime::find_state(name));
    case Kind::Word: {
      const auto* const found = std::find(std::begin(kWordNames), std::end(kWordNames), name);
      if (found == std::end(kWordNames)) return std::nullopt;
      return static_cast<uint32_t>(found - std::begin(kWordNames));
    }
    case Kind::Signal:
      if (signals::find_station_signals(station, name).size() == 1) return 0;
      break;
    case Kind::Any: break;
  }
  return std::nullopt;
}

std::string terminal_names(std::string_view first, std::string_view prefix, int from, int to) {
  std::string names(first);
  for (int n = from; n <= to; ++n) names += fmt::format("{}{}{:02}", names.empty() ? "" : ",", prefix, n);
  return names;
}

// The line of a terminal that was set last: AI1 and AI2 have one for a voltage and one for a current.
size_t live_line(const Station& station, size_t first) {
  const size_t second = first + 1;
  return second < runtime::kInputLines && runtime::same_terminal(first, second) &&
                 station.inputs().line(second).value() != 0
             ? second
             : first;
}

int decimals_of(const runtime::AnalogKind& kind) { return kind.factor < 100 ? 1 : 3; }

// The signal port of what has one.
signals::SignalPort port_of(Plant& plant, const Place& place) {
  const Station& station = station_of(plant, place);
  runtime::Signal signal;
  signal.station = station.config().name;
  if (place.kind == Kind::Variable) {
    signal.name = fmt::format("H{}", place.number);
  } else if (place.kind == Kind::Parameter) {
    signal.kind = runtime::SignalKind::Parameter;
    signal.name = fmt::format("{}", place.number);
  } else {
    signal.kind = runtime::SignalKind::Input;
    signal.line = static_cast<uint8_t>(place.number);
  }
  std::string why;
  return signals::SignalPort::find(plant.stations(), signal, why).value();
}

std::string input_name(uint32_t line) {
  if (line < runtime::kBinaryLines) return fmt::format("DI{:02}", line < 8 ? line : line + 2);
  return std::string(runtime::analog_kinds()[line - runtime::kBinaryLines].name);
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

std::string station_names(const Plant& plant) {
  std::vector<std::string_view> names;
  for (const auto& station : plant.stations()) names.push_back(station->config().name);
  for (const runtime::Gateway* gateway : plant.all<runtime::Gateway>()) names.push_back(gateway->name());
  return fmt::format("{}", fmt::join(names, ", "));
}

signals::Signal shown_signal(const Plant& plant, const Place& place, std::string_view name) {
  if (const runtime::Gateway* gateway = gateway_of(plant, place.station))
    return signals::find_among(signals::gateway_signals(*gateway),
                               fmt::format("{}.{}", gateway->config().name, name))
        .value();
  return signals::find_station_signals(*plant.stations()[place.station], name).front();
}

namespace {

std::vector<std::string> gateway_names(const runtime::Gateway& gateway, Kind kind) {
  std::vector<std::string> names;
  for (const signals::Signal& signal : signals::gateway_signals(gateway))
    if (kind == Kind::Signal || (kind == Kind::State && signal.group == signals::Group::State))
      names.push_back(signal.name.substr(signal.station.size() + 1));
  return names;
}

}  // namespace

std::vector<std::string> place_names(const Plant& plant, uint32_t number, Kind kind,
                                     std::optional<std::string_view> part) {
  if (const runtime::Gateway* gateway = gateway_of(plant, number)) return gateway_names(*gateway, kind);
  const Station& station = *plant.stations()[number];
  std::vector<std::string> names;
  const auto list = [&](std::span<const std::string_view> all) { names.assign(all.begin(), all.end()); };
  switch (kind) {
    case Kind::Variable:
      if (part) {
        for (auto& found : signals::named_variables(station.symbols(), *station.config().unit, *part))
          names.push_back(std::move(found.name));
        break;
      }
      for (const vm::Symbol& symbol : station.symbols())
        for (auto& element : signals::elements_of(symbol)) names.push_back(std::move(element.name));
      break;
    case Kind::Parameter: {
      // Of rows that share a number or an index, that one which the name leads to.
      const stdlib::ParameterTable& table = stdlib::parameter_table(*station.config().unit);
      for (const stdlib::Parameter& row : table.rows()) {
        const std::string shown = fmt::format("P{}", row.number);
        if (row.index != 0 && table.find(std::string_view(shown)) == &row)
          names.push_back(shown);
        else if (row.index != 0 && table.find(row.index) == &row)
          names.push_back(fmt::format("{}", row.index));
      }
      break;
    }
    case Kind::Input:
      for (uint32_t bit = 0; bit < runtime::kBinaryLines; ++bit) names.push_back(input_name(bit));
      break;
    case Kind::Output: {
      const std::string all = terminal_names("DB00", "DO", 1, 5) + "," + terminal_names("", "DO", 10, 17);
      for (size_t begin = 0; begin < all.size(); begin += 5) names.push_back(all.substr(begin, 4));
      break;
    }
    case Kind::Analog:
      for (const runtime::AnalogKind& each : runtime::analog_kinds())
        if (names.empty() || names.back() != each.name) names.emplace_back(each.name);
      break;
    case Kind::Signal:
      for (const signals::Signal& signal : signals::station_signals(station))
        names.push_back(signal.name.substr(signal.station.size() + 1));
      break;
    case Kind::Word: list(kWordNames); break;
    case Kind::State:
      for (const signals::StationState& state : signals::station_states()) names.emplace_back(state.name);
      break;
    case Kind::Any: break;
  }
  return names;
}

namespace {

// Every name that a kind has; of Any those of all kinds that have a few.
std::vector<std::string> all_names(const Plant& plant, uint32_t number, Kind kind) {
  if (kind != Kind::Any) return place_names(plant, number, kind);
  std::vector<std::string> names;
  for (const Kind each : {Kind::Variable, Kind::Parameter, Kind::Input, Kind::Output, Kind::Analog, Kind::State, Kind::Word,
                          Kind::Signal})
    for (std::string& name : place_names(plant, number, each)) names.push_back(std::move(name));
  return names;
}

// " (did you mean 'speed'?); it has lCount, ...": the nearest name of all, and the first ones of the kind.
std::string what_there_is(const Plant& plant, uint32_t number, Kind kind, std::string_view name) {
  const Station& station = *plant.stations()[number];
  constexpr size_t kShown = 24;
  std::vector<std::string> names = place_names(plant, number, kind == Kind::Any ? Kind::Variable : kind);
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
                         fmt::join(place_names(plant, number, Kind::State), ", "));
  const bool is_whole = count <= kShown && kind != Kind::Any && kind != Kind::Variable;  // the list needs no hint
  const std::vector<std::string> all = is_whole ? std::vector<std::string>() : all_names(plant, number, kind);
  const std::vector<std::string_view> candidates(all.begin(), all.end());
  const std::string_view best = stdlib::nearest(name, candidates);
  return fmt::format("{}; it has {}", best.empty() ? "" : fmt::format(" (did you mean '{}'?)", best), known);
}

}  // namespace

tl::expected<Place, std::string> find_place(Plant& plant, uint32_t number, Kind kind, std::string_view name) {
  if (const runtime::Gateway* gateway = gateway_of(plant, number)) {
    const auto all = signals::gateway_signals(*gateway);
    const bool fits = kind == Kind::Any || kind == Kind::Signal || kind == Kind::State;
    if (fits && signals::find_among(all, fmt::format("{}.{}", gateway->config().name, name)))
      return Place{number, Kind::Signal, 0};
    return tl::unexpected(fmt::format("gateway '{}' has no {} '{}'; it has {}", gateway->config().name,
                                      kind_word(kind), name, signals::names_of(all)));
  }
  const Station& station = *plant.stations()[number];
  for (uint8_t n = kind == Kind::Any ? 1 : static_cast<uint8_t>(kind);
       n <= static_cast<uint8_t>(kind == Kind::Any ? Kind::Signal : kind); ++n)
    if (const auto found = find_number(station, static_cast<Kind>(n), name))
      return Place{number, static_cast<Kind>(n), *found};
  return tl::unexpected(fmt::format("station '{}' has no {} '{}'{}", station.config().name, kind_word(kind), name,
                                    what_there_is(plant, number, kind, name)));
}

bool exists(const Plant& plant, const Place& place) {
  if (place.station >= plant.stations().size()) return false;
  const Station& station = station_of(plant, place);
  switch (place.kind) {
    case Kind::Variable: return place.number < station.config().unit->variables;
    case Kind::Parameter: return parameter_of(station, place.number) != nullptr;
    case Kind::Input: return place.number < runtime::kBinaryLines;
    case Kind::Output: return place.number < 16;
    case Kind::Analog: return place.number >= runtime::kBinaryLines && place.number < runtime::kInputLines;
    case Kind::State: return place.number < signals::station_states().size();
    case Kind::Word: return place.number < std::size(kWordNames);
    case Kind::Signal:
    case Kind::Any: break;
  }
  return false;
}

bool is_writable(const Place& place) {
  return place.kind == Kind::Variable || place.kind == Kind::Parameter || place.kind == Kind::Input ||
         place.kind == Kind::Analog || (place.kind == Kind::Word && place.number < runtime::Hands::kWords);
}

PlaceInfo place_info(const Plant& plant, const Place& place, std::string_view name) {
  PlaceInfo info;
  info.name = name;
  info.writable = is_writable(place);
  const Station& station = station_of(plant, place);
  if (place.kind == Kind::Parameter) {
    const stdlib::Parameter& row = *parameter_of(station, place.number);
    const stdlib::DisplayScale scale = stdlib::display_scale(row);
    if (row.display != "hex" && row.texts.empty()) info.unit = row.display;
    info.factor = scale.factor;
    info.decimals = scale.decimals;
    info.writable = row.writable;
  } else if (place.kind == Kind::Analog) {
    const runtime::AnalogKind& kind =
        runtime::analog_kinds()[live_line(station, place.number) - runtime::kBinaryLines];
    info.unit = kind.unit;
    info.factor = 1 / kind.factor;
    info.decimals = decimals_of(kind);
  } else if (place.kind == Kind::State) {
    const std::string_view state = signals::station_states()[place.number].name;
    if (state == "speed" || state == "setpoint") {
      info.unit = "rpm";
      info.factor = 1e-3;
      info.decimals = 3;
    } else if (state == "position") {
      info.unit = "inc";
    }
  }
  return info;
}

int64_t read_place(const Plant& plant, const Place& place) {
  const Station& station = station_of(plant, place);
  switch (place.kind) {
    case Kind::Variable: return station.variable(place.number);
    case Kind::Parameter: {
      const stdlib::Parameter& row = *parameter_of(station, place.number);
      return row.number_of(station.drive().parameters().value(row.index));
    }
    case Kind::Input: return station.inputs().line(place.number).value();
    case Kind::Output: return station.outputs() >> place.number & 1;
    case Kind::Analog: return station.inputs().line(live_line(station, place.number)).value();
    case Kind::State: return signals::station_states()[place.number].read(station);
    case Kind::Word: {
      const runtime::Drive& drive = station.drive().state();
      return place.number < runtime::Hands::kWords ? drive.po()[place.number]
                                                   : drive.pi()[place.number - runtime::Hands::kWords];
    }
    case Kind::Signal:
    case Kind::Any: break;
  }
  return 0;
}

std::string place_text(const Plant& plant, const Place& place) {
  const int64_t value = read_place(plant, place);
  if (place.kind == Kind::Parameter)
    return stdlib::parameter_text(*parameter_of(station_of(plant, place), place.number),
                                  static_cast<int32_t>(value));
  const PlaceInfo info = place_info(plant, place, "");
  return fmt::format("{:.{}f}{}{}", static_cast<double>(value) * info.factor, info.decimals,
                     info.unit.empty() ? "" : " ", info.unit);
}

tl::expected<TextValue, std::string> parse_place_text(const Plant& plant, const Place& place,
                                                      std::string_view text) {
  const Station& station = station_of(plant, place);
  if (place.kind == Kind::Parameter) {
    const stdlib::Parameter& row = *parameter_of(station, place.number);
    const auto value = stdlib::parse_parameter_text(row, text);
    if (!value) return tl::unexpected(fmt::format("P{} {}: {}", row.number, row.name, value.error()));
    return TextValue{place, row.number_of(*value)};
  }
  if (place.kind == Kind::Analog) {
    const std::string name = input_name(place.number);
    if (const auto setting = runtime::parse_analog(name, text))
      return TextValue{{place.station, place.kind, setting->line}, setting->value};
    return tl::unexpected(fmt::format(
        "'{}' is nothing for {}; write a text such as \"5 V\" (-10..10), \"12 mA\" (0..20), for frequency "
        "\"5 kHz\" (0..65), for potentiometer \"50 %\" (0..100)",
        text, name));
  }
  int64_t value = 0;
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  const std::string_view digits = hex ? text.substr(2) : text;
  const auto [end, status] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value, hex ? 16 : 10);
  if (digits.empty() || status != std::errc() || end != digits.data() + digits.size())
    return tl::unexpected(fmt::format("'{}' is no number", text));
  return TextValue{place, value};
}

runtime::Refusal check_value(const Plant& /*plant*/, const Place& place, int64_t value) {
  struct Limits {
    int64_t least, most;
  };
  const auto limits = [&]() -> Limits {
    switch (place.kind) {
      case Kind::Input: return {0, 1};
      case Kind::Word: return {INT16_MIN, UINT16_MAX};
      case Kind::Parameter: return {INT32_MIN, UINT32_MAX};
      default: return {INT32_MIN, INT32_MAX};
    }
  }();
  if (value >= limits.least && value <= limits.most) return std::nullopt;
  return fmt::format("{} is out of range for {} {}: {}..{}", value,
                     place.kind == Kind::Analog || place.kind == Kind::Input ? "an" : "a",
                     kind_word(place.kind), limits.least, limits.most);
}

runtime::Refusal do_to_place(Plant& plant, runtime::Hands& hands, const Place& place, Touch touch,
                             int64_t value) {
  if (place.kind == Kind::Word) {
    Station& station = station_of(plant, place);
    const auto word = static_cast<uint8_t>(place.number);
    if (touch == Touch::Release)
      hands.release_word(station, word);
    else if (touch == Touch::Force)
      hands.force_word(station, word, static_cast<uint16_t>(value));
    else
      hands.set_word(station, word, static_cast<uint16_t>(value));
    return std::nullopt;
  }
  const signals::SignalPort port = port_of(plant, place);
  if (touch == Touch::Release) {
    hands.release(port);
    return std::nullopt;
  }
  const auto bits = static_cast<int32_t>(value);
  if (touch == Touch::Force) return hands.force(port, bits);
  auto refused = runtime::Hands::set(port, port.is_input() ? input_name(place.number) : "", bits);
  // Of the two lines of an analog input the other one is not there any more.
  if (!refused && place.kind == Kind::Analog)
    for (const size_t other : {place.number - 1, place.number + 1})
      if (other >= runtime::kBinaryLines && other < runtime::kInputLines &&
          runtime::same_terminal(place.number, other))
        station_of(plant, place).inputs().line(other).set = 0;
  return refused;
}

}  // namespace ipos::library
