// Names of a plant: a station, gateway or line, and the rest; and names among signals that are there already.
#include "runtime/signals/find.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "runtime/signals/gateways.hpp"
#include "runtime/signals/telegrams.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

void add_line(const PlantParts& plant, const Bus& line, std::vector<Signal>& out) {
  const auto add = [&](std::string_view name, std::string_view unit, std::string_view meaning,
                       std::function<int64_t()> read) {
    Signal& signal = out.emplace_back();
    signal.station = line.name();
    signal.name = fmt::format("{}.{}", line.name(), name);
    signal.unit = unit;
    signal.group = Group::Bus;
    signal.meaning = meaning;
    signal.read = std::move(read);
  };
  add("load", "%", "bus load of the last full second",
      [&plant, &line]() -> int64_t { return line.load(plant.now()).window_percent; });
  add("count", "", "frames, or telegrams of a serial line, so far",
      [&plant, &line] { return static_cast<int64_t>(line.load(plant.now()).frames); });
}

// Of what is no station with a drive: gateways, and lines.
std::vector<Signal> other_signals(const PlantParts& plant) {
  std::vector<Signal> signals;
  for (const Gateway* gateway : plant.all<Gateway>())
    for (Signal& signal : gateway_signals(*gateway)) signals.push_back(std::move(signal));
  for (const auto& bus : plant.buses()) add_line(plant, *bus, signals);
  return signals;
}

// Of a pattern: the station's part, as far as it can be told.
std::vector<Signal> match(const PlantParts& plant, std::string_view pattern) {
  std::vector<Signal> found;
  const auto take = [&found](std::vector<Signal> more) {
    for (Signal& signal : more) found.push_back(std::move(signal));
  };
  for (const auto& station : plant.stations()) {
    const std::string& name = station->config().name;
    // Names of stations may contain dots themselves: every dot may be the one after the name.
    bool named = false;
    for (size_t dot = pattern.find('.'); dot != std::string_view::npos && !named;
         dot = pattern.find('.', dot + 1)) {
      named = matches(pattern.substr(0, dot), name);
      if (named) take(match_station_signals(*station, pattern.substr(dot + 1)));
    }
    if (!named && plant.stations().size() == 1) take(match_station_signals(*station, pattern));
  }
  take(match_among(other_signals(plant), pattern));
  take(match_telegram_signals(plant, pattern));
  return found;
}

}  // namespace

std::vector<Signal> plant_signals(const PlantParts& plant) {
  std::vector<Signal> all;
  for (const auto& station : plant.stations())
    for (Signal& signal : station_signals(*station)) all.push_back(std::move(signal));
  for (Signal& signal : other_signals(plant)) all.push_back(std::move(signal));
  for (Signal& signal : telegram_signals(plant)) all.push_back(std::move(signal));
  return all;
}

tl::expected<std::vector<Signal>, std::string> find_signals(const PlantParts& plant, std::string_view name) {
  if (is_pattern(name)) {
    if (auto found = match(plant, name); !found.empty()) return found;
    return tl::unexpected(fmt::format("no signal is called like '{}'", name));
  }
  const auto& stations = plant.stations();
  Station* owner = nullptr;
  std::string_view rest = name;
  for (const auto& station : stations) {
    // The longest name that fits.
    const std::string prefix = station->config().name + ".";
    if (!name.starts_with(prefix) || (owner != nullptr && prefix.size() <= name.size() - rest.size()))
      continue;
    owner = station.get();
    rest = name.substr(prefix.size());
  }
  if (owner == nullptr && stations.size() == 1) owner = stations.front().get();
  if (owner != nullptr)
    if (auto found = find_station_signals(*owner, rest); !found.empty()) return found;
  const std::vector<Signal> without_drive = other_signals(plant);
  if (auto found = find_among(without_drive, name)) return std::vector{*std::move(found)};
  if (auto found = find_telegram_signal(plant, name)) return std::vector{*std::move(found)};
  for (const Gateway* gateway : plant.all<Gateway>())
    if (name.starts_with(gateway->name() + "."))
      return tl::unexpected(fmt::format("gateway '{}' has no signal '{}'; it has {}", gateway->name(),
                                        name.substr(gateway->name().size() + 1),
                                        names_of(gateway_signals(*gateway))));
  std::vector<std::string_view> buses;
  for (const Signal& signal : without_drive)
    if (signal.group == Group::Bus) buses.push_back(signal.name);
  const std::string others = buses.empty() ? "" : fmt::format("; the buses have {}", fmt::join(buses, ", "));
  if (owner != nullptr)
    return tl::unexpected(fmt::format("station '{}' has no signal '{}'; it has {}{}", owner->config().name,
                                      rest, station_signal_names(*owner), others));
  std::vector<std::string> known;
  for (const auto& station : stations) known.push_back(station->config().name + ".");
  return tl::unexpected(
      fmt::format("'{}' is no signal; signals begin with {}{}", name, fmt::join(known, ", "), others));
}

namespace {

struct KindOfFile {
  Group group;
  std::string_view word;
};
// In the order of the kinds of a plant file.
constexpr KindOfFile kKinds[] = {{Group::Variable, "variable"}, {Group::Parameter, "parameter"}, {Group::Input, "input"},
                                 {Group::Output, "output"},     {Group::State, "state"},         {Group::State, "switch"}};

std::optional<Signal> find_of_gateway(const Gateway& gateway, const runtime::Signal& named, std::string& why) {
  const std::vector<Signal> all = gateway_signals(gateway);
  auto found = find_among(all, fmt::format("{}.{}", named.station, named.name));
  if (!found)
    why = fmt::format("gateway '{}' has no signal '{}'; it has {}", named.station, named.name, names_of(all));
  return found;
}

// The first look is here: from then on a line keeps its telegrams.
std::optional<Signal> find_of_line(const PlantParts& plant, const runtime::Signal& named, std::string& why) {
  const auto found = find_signals(plant, fmt::format("{}.{}", named.station, named.name));
  if (found && found->size() == 1) {
    found->front().read();
    return found->front();
  }
  why = fmt::format("line '{}' has no signal '{}'; it has load, count and its telegrams as 013.PO2", named.station, named.name);
  return std::nullopt;
}

std::optional<Signal> find_of_station(Station& station, const runtime::Signal& named, std::string& why) {
  if (named.kind == SignalKind::Any) {
    auto found = find_station_signals(station, named.name);
    if (found.size() == 1) return std::move(found.front());
    why = fmt::format("station '{}' has no signal '{}'; it has {}", named.station, named.name,
                      station_signal_names(station));
    return std::nullopt;
  }
  const KindOfFile& kind = kKinds[static_cast<size_t>(named.kind)];
  const bool by_line = named.kind == SignalKind::Input && named.line >= kBinaryLines;
  auto found = by_line ? signal_at(station, Group::Analog, named.line) : find_in_group(station, kind.group, named.name);
  if (!found) why = fmt::format("station '{}' has no {} '{}'", named.station, kind.word, named.name);
  return found;
}

// The key of a stimulus that names what is of this group; empty: none but `signal`.
std::string_view own_key(Group group) {
  switch (group) {
    case Group::Variable:
    case Group::SystemVariable: return "variable";
    case Group::Parameter: return "parameter";
    case Group::Input: return "input";
    case Group::Analog: return "analog";
    default: return {};
  }
}

// A number counts in the signal's unit.
Refusal read_written(const Signal& signal, Stimulus& stimulus) {
  const std::string& text = stimulus.written;
  double shown = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), shown);
  int64_t sample = 0;
  if (status == std::errc() && end == text.data() + text.size()) {
    sample = std::llround(std::clamp(shown / signal.factor, -1e15, 1e15));
  } else {
    const auto parsed = signal.parse(text);
    if (!parsed) return parsed.error();
    sample = parsed->sample;
  }
  if (auto wrong = signal.check(sample)) return wrong;
  stimulus.value = static_cast<int32_t>(sample);
  return std::nullopt;
}

}  // namespace

std::optional<Signal> find_signal(const PlantParts& plant, const runtime::Signal& named, std::string& why) {
  why.clear();
  if (const Gateway* gateway = plant.find_gateway(named.station)) return find_of_gateway(*gateway, named, why);
  for (const auto& station : plant.stations())
    if (station->config().name == named.station) return find_of_station(*station, named, why);
  if (plant.find_bus(named.station) != nullptr) return find_of_line(plant, named, why);
  return std::nullopt;
}

std::optional<Signal> find_target(const PlantParts& plant, Stimulus& stimulus, std::string& why) {
  auto signal = find_signal(plant, stimulus.signal, why);
  if (!signal || stimulus.signal.kind != SignalKind::Any) return signal;
  if (const std::string_view key = own_key(signal->group); !key.empty())
    why = fmt::format("{} has a key of its own: write {} = \"{}\"", stimulus.signal.name, key, stimulus.signal.name);
  else if (!signal->is_writable())
    why = fmt::format("{} of {} can only be read", stimulus.signal.name, stimulus.signal.station);
  else if (stimulus.action != Stimulus::Action::Release)
    why = read_written(*signal, stimulus).value_or("");
  if (!why.empty()) return std::nullopt;
  return signal;
}

int64_t value_for(const runtime::Signal& named, const Signal& signal) {
  return named.kind == SignalKind::Any ? signal.rounded(named.decimals) : static_cast<int32_t>(signal.read());
}

std::optional<Signal> find_among(std::span<const Signal> all, std::string_view name) {
  for (const Signal& signal : all)
    if (signal.name == name) return signal;
  const size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  size_t bit = 0;
  const auto [end, status] = std::from_chars(name.data() + dot + 1, name.data() + name.size(), bit);
  if (status != std::errc() || end != name.data() + name.size()) return std::nullopt;
  for (const Signal& signal : all)
    if (signal.name == name.substr(0, dot) && bit < bit_count(signal)) return bit_of(signal, bit);
  return std::nullopt;
}

std::vector<Signal> match_among(std::span<const Signal> all, std::string_view pattern) {
  const size_t dot = pattern.rfind('.');
  std::vector<Signal> found;
  for (const Signal& signal : all) {
    if (dot != std::string_view::npos && matches(pattern.substr(0, dot), signal.name))
      for (size_t bit = 0; bit < bit_count(signal); ++bit)
        if (matches(pattern.substr(dot + 1), fmt::format("{}", bit))) found.push_back(bit_of(signal, bit));
    if (matches(pattern, signal.name)) found.push_back(signal);
  }
  return found;
}

std::string names_of(std::span<const Signal> all) {
  std::vector<std::string_view> names;
  for (const Signal& signal : all)
    names.push_back(std::string_view(signal.name).substr(signal.station.size() + 1));
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace ipos::signals
