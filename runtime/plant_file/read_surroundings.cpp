// What drives the inputs of stations: [[stimulus]], [[wire]] and [[switch]] of the plant file.
#include <algorithm>
#include <set>

#include "runtime/plant_file/plant_reader.hpp"
#include "runtime/plant_file/state_names.hpp"

namespace ipos::runtime {
namespace {

struct ActionKey {
  std::string_view key;
  Stimulus::Action action;
};
constexpr ActionKey kActions[] = {{"set", Stimulus::Action::Set},
                                  {"force", Stimulus::Action::Force},
                                  {"pulse", Stimulus::Action::Pulse},
                                  {"release", Stimulus::Action::Release}};

// A number, or a text with a unit.
bool read_written(PlantReader& reader, const toml::node& node, std::string_view key, Stimulus& stimulus) {
  if (const auto* text = node.as_string())
    stimulus.written = text->get();
  else if (node.is_number())
    stimulus.written = fmt::format("{}", *node.value<double>());
  else
    reader.error(place_of(node), fmt::format("{} of a signal is a number, or a text with its unit", key));
  return !stimulus.written.empty();
}

// The value of set, force or pulse in the form the signal has. False with an error.
bool read_value(PlantReader& reader, const toml::node& node, std::string_view key, Stimulus& stimulus) {
  Signal& signal = stimulus.signal;
  if (signal.kind == SignalKind::Any) return read_written(reader, node, key, stimulus);
  if (signal.kind == SignalKind::Parameter)
    return reader.parameter_value(node, reader.unit_of(signal.station), signal.name, stimulus.value);
  if (signal.kind == SignalKind::Switch) {
    if (!node.is_boolean() && !reader.number(node, key, stimulus.value)) return false;
    if (node.is_boolean()) stimulus.value = node.as_boolean()->get() ? 1 : 0;
    const int32_t most = find_switch(signal.name)->most;
    if (stimulus.value >= 0 && stimulus.value <= most) return true;
    reader.error(place_of(node), fmt::format("{} is 0 to {}", signal.name, most));
    return false;
  }
  if (signal.kind != SignalKind::Input) return reader.number(node, key, stimulus.value);
  if (signal.line >= kBinaryLines) {
    const auto setting = parse_analog(signal.name, node.value_or(std::string()));
    if (!setting) {
      reader.error(place_of(node), fmt::format("{} needs {}", signal.name, kAnalogForms));
      return false;
    }
    signal.line = setting->line;
    stimulus.value = setting->value;
    return true;
  }
  if (node.is_boolean()) {
    stimulus.value = node.as_boolean()->get() ? 1 : 0;
    return true;
  }
  if (!reader.number(node, key, stimulus.value)) return false;
  if (stimulus.value == 0 || stimulus.value == 1) return true;
  reader.error(place_of(node), fmt::format("{} is 0 or 1", signal.name));
  return false;
}

void read_action(PlantReader& reader, const toml::table& table, std::string_view what, Stimulus& stimulus) {
  const ActionKey* found = nullptr;
  for (const ActionKey& row : kActions) {
    if (table.get(row.key) == nullptr) continue;
    if (found != nullptr)
      return reader.error(place_of(*table.get(row.key)),
                          fmt::format("{} has either {} or {}", what, found->key, row.key));
    found = &row;
  }
  if (table.contains("mains")) {
    if (found != nullptr)
      return reader.error(place_of(*table.get(found->key)), fmt::format("{} has either mains or {}", what, found->key));
    stimulus.value = reader.off_or_on(table, "mains", what).value_or(true) ? 1 : 0;
    return;
  }
  if (found == nullptr)
    return reader.error(stimulus.place, fmt::format("{} needs set, force, pulse or release", what));
  stimulus.action = found->action;
  if (stimulus.signal.kind == SignalKind::Switch && found->action != Stimulus::Action::Set)
    return reader.error(place_of(*table.get(found->key)), "a switch stays as it is turned: write set");
  const toml::node& node = *table.get(found->key);
  if (found->action == Stimulus::Action::Release) {
    if (!reader.flag(table, "release").value_or(false)) reader.error(place_of(node), "write release = true");
  } else {
    read_value(reader, node, found->key, stimulus);
  }
}

void read_times(PlantReader& reader, const toml::table& table, std::string_view what, Stimulus& stimulus) {
  const bool pulse = stimulus.action == Stimulus::Action::Pulse;
  stimulus.length = reader.duration(table, "for", pulse ? "a pulse" : what, pulse);
  stimulus.every = reader.duration(table, "every", what, false);
  if (const toml::node* node = table.get("for")) {
    if (!pulse && stimulus.action != Stimulus::Action::Force)
      reader.error(place_of(*node), "only force and pulse have a length (for)");
    else if (stimulus.length < kShortest)
      reader.error(place_of(*node), "the length (for) is less than a millisecond");
  }
  if (const toml::node* node = table.get("every"); node != nullptr && stimulus.every < kShortest)
    reader.error(place_of(*node), "every is less than a millisecond");
  if (const toml::node* node = table.get("times")) {
    int32_t times = 0;
    if (stimulus.every == 0) reader.error(place_of(*node), "times needs every = \"...\"");
    if (reader.number(*node, "times", times) && times < 1)
      reader.error(place_of(*node), "times is 1 or more");
    stimulus.times = times;
  }
}

void read_stimuli(PlantReader& reader, const toml::table& table) {
  constexpr std::string_view kWhat = "a [[stimulus]]";
  reader.known_keys(table, "[[stimulus]]",
                    {"station", "at", "variable", "parameter", "input", "analog", "switch", "signal", "mains", "set", "force",
                     "pulse", "release", "for", "every", "times"});
  Stimulus stimulus;
  stimulus.place = place_of(table);
  stimulus.signal.station = reader.station(table, kWhat);
  stimulus.at = reader.duration(table, "at", kWhat, true);
  if (read_stimulus(reader, table, kWhat, stimulus))
    reader.result.plant.stimuli.push_back(std::move(stimulus));
}

// "unit1.DO01": station and terminal.
Signal terminal(PlantReader& reader, const toml::table& table, std::string_view key, SignalKind kind) {
  Signal signal;
  signal.kind = kind;
  const std::string written = reader.text(table, key, "a [[wire]]", true);
  if (written.empty()) return signal;
  const FilePlace place = place_of(*table.get(key));
  const size_t dot = written.rfind('.');
  signal.station = written.substr(0, dot == std::string::npos ? 0 : dot);
  signal.name = dot == std::string::npos ? written : written.substr(dot + 1);
  const int bit = kind == SignalKind::Input ? parse_input(signal.name) : parse_output(signal.name);
  if (signal.station.empty() || bit < 0)
    reader.error(place, fmt::format("'{}' is no {}; write for example \"unit1.{}\"", written,
                                    kind == SignalKind::Input ? "input of a station" : "output of a station",
                                    kind == SignalKind::Input ? "DI03" : "DO01"));
  else
    reader.use_station(signal.station, place);
  signal.line = static_cast<uint8_t>(std::max(bit, 0));
  return signal;
}

void read_wire(PlantReader& reader, const toml::table& table) {
  reader.known_keys(table, "[[wire]]", {"from", "to", "invert"});
  Wire wire;
  wire.place = place_of(table);
  wire.from = terminal(reader, table, "from", SignalKind::Output);
  wire.to = terminal(reader, table, "to", SignalKind::Input);
  wire.invert = reader.flag(table, "invert").value_or(false);
  reader.result.plant.wires.push_back(std::move(wire));
}

void read_switch(PlantReader& reader, const toml::table& table) {
  constexpr std::string_view kWhat = "a [[switch]]";
  reader.known_keys(table, "[[switch]]", {"station", "input", "from", "to", "active", "part_at", "belt"});
  PositionSwitch added;
  added.place = place_of(table);
  added.input.station = reader.station(table, kWhat);
  if (!reader.signal(table, kWhat, {"input"}, added.input)) return;
  const std::string active = reader.text(table, "active", kWhat, false);
  if (!active.empty() && active != "high" && active != "low")
    reader.error(place_of(*table.get("active")), "active is \"high\" or \"low\"");
  added.active_high = active != "low";
  const toml::node* from = table.get("from");
  const toml::node* to = table.get("to");
  if (table.contains("part_at")) {
    for (const toml::node* end : {from, to})
      if (end != nullptr) reader.error(place_of(*end), "a [[switch]] sees the axis (from, to) or parts (part_at)");
    return read_barrier(reader, table, {added.input, {}, 0, added.active_high, added.place});
  }
  if (const toml::node* belt = table.get("belt")) reader.error(place_of(*belt), "belt needs part_at");
  if (from == nullptr && to == nullptr)
    reader.error(added.place, "a [[switch]] needs from, to or both, in increments, or part_at");
  if (from != nullptr) reader.number(*from, "from", added.from);
  if (to != nullptr) reader.number(*to, "to", added.to);
  if (added.from > added.to) reader.error(place_of(*to), "to is below from");
  reader.result.plant.switches.push_back(std::move(added));
}

// What is wired to a machine, if it is a terminal: "hoist.DI03".
std::optional<Signal> input_of(const std::string& written) {
  const size_t dot = written.rfind('.');
  if (dot == std::string::npos) return std::nullopt;
  Signal signal;
  signal.station = written.substr(0, dot);
  signal.name = written.substr(dot + 1);
  signal.kind = SignalKind::Input;
  const int line = std::max(parse_input(signal.name), parse_analog_input(signal.name));
  if (line < 0) return std::nullopt;
  signal.line = static_cast<uint8_t>(line);
  return signal;
}

// An input has one driver, and what is driven can be forced, but not set.
void check_drivers(PlantReader& reader) {
  const PlantFile& plant = reader.result.plant;
  struct Driven {
    Signal signal;
    std::string_view by;
  };
  std::vector<Driven> driven;
  std::set<std::string> machine_driven;  // "hoist.load_torque"
  const auto driver_of = [&](const Signal& signal) {
    const auto found = std::find_if(driven.begin(), driven.end(), [&](const Driven& other) {
      return signal.kind == SignalKind::Input && other.signal.station == signal.station &&
             same_terminal(other.signal.line, signal.line);
    });
    return found == driven.end() ? std::string_view() : found->by;
  };
  const auto drive = [&](const Signal& signal, std::string_view by, FilePlace place) {
    if (signal.station.empty()) return;
    if (const auto other = driver_of(signal); !other.empty())
      reader.error(place, fmt::format("{} of {} has a {} already", signal.name, signal.station, other));
    driven.push_back({signal, by});
  };
  constexpr std::string_view kWireOrSwitch = "wire or switch";
  for (const Wire& wire : plant.wires) drive(wire.to, kWireOrSwitch, wire.place);
  for (const PositionSwitch& added : plant.switches) drive(added.input, kWireOrSwitch, added.place);
  for (const LightBarrier& barrier : plant.barriers) drive(barrier.input, kWireOrSwitch, barrier.place);
  for (const MachineConfig& machine : plant.machines)
    for (const MachineWire& wire : machine.outputs) {
      machine_driven.insert(wire.signal);
      if (const auto input = input_of(wire.signal)) drive(*input, "machine", wire.place);
    }
  for (const Stimulus& stimulus : plant.stimuli) {
    if (stimulus.action != Stimulus::Action::Set) continue;
    const bool by_machine = stimulus.signal.kind == SignalKind::Any &&
                            machine_driven.contains(fmt::format("{}.{}", stimulus.signal.station, stimulus.signal.name));
    const std::string_view by = by_machine ? "machine" : driver_of(stimulus.signal);
    if (!by.empty())
      reader.error(stimulus.place, fmt::format("{} of {} hangs on a {}: force it, do not set it", stimulus.signal.name,
                                               stimulus.signal.station, by));
  }
}

}  // namespace

bool read_stimulus(PlantReader& reader, const toml::table& table, std::string_view what, Stimulus& stimulus) {
  if (!reader.signal(table, what, {"variable", "parameter", "input", "analog", "switch", "signal", "mains"}, stimulus.signal))
    return false;
  read_action(reader, table, what, stimulus);
  read_times(reader, table, what, stimulus);
  return true;
}

void read_surroundings(PlantReader& reader, const toml::table& root) {
  reader.for_each_table(root, "stimulus", [&](const toml::table& table) { read_stimuli(reader, table); });
  reader.for_each_table(root, "wire", [&](const toml::table& table) { read_wire(reader, table); });
  reader.for_each_table(root, "switch", [&](const toml::table& table) { read_switch(reader, table); });
  check_drivers(reader);
}

}  // namespace ipos::runtime
