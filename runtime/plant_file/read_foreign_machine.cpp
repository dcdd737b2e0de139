// [[machine]] of the plant file: names and numbers. Whether the FMU has such variables is asked when it is opened.
#include <algorithm>
#include <cmath>

#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

constexpr std::string_view kMachine = "a [[machine]]";
constexpr int64_t kLongestStep = 1'000'000'000;        // ns (ours)
constexpr int64_t kLongestAnswer = 3'600'000'000'000;  // ns on the clock (ours)

const toml::table* part(PlantReader& reader, const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  if (node != nullptr && !node->is_table()) reader.error(place_of(*node), fmt::format("write [machine.{}]", key));
  return node == nullptr ? nullptr : node->as_table();
}

void read_wires(PlantReader& reader, const toml::table& table, std::string_view key, std::vector<MachineWire>& wires) {
  const toml::table* rows = part(reader, table, key);
  if (rows == nullptr) return;
  for (const auto& [name, node] : *rows) {
    const std::string signal = node.value_or(std::string());
    if (signal.empty())
      reader.error(place_of(node), fmt::format("write \"{}\" = \"STATION.SIGNAL\"", name.str()));
    else
      wires.push_back({std::string(name.str()), signal, place_of(node)});
  }
  // A table of TOML is sorted by name; values go and come in the order of the file.
  std::stable_sort(wires.begin(), wires.end(), [](const MachineWire& a, const MachineWire& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
}

void read_settings(PlantReader& reader, const toml::table& table, std::vector<MachineSetting>& settings) {
  const toml::table* rows = part(reader, table, "parameters");
  if (rows == nullptr) return;
  for (const auto& [name, node] : *rows) {
    std::optional<double> value;
    if (node.is_boolean()) value = node.value_or(false) ? 1.0 : 0.0;
    if (node.is_number()) value = node.value<double>();
    if (!value || !std::isfinite(*value))
      reader.error(place_of(node), fmt::format("{} must be a number, true or false", name.str()));
    else
      settings.push_back({std::string(name.str()), *value, place_of(node)});
  }
}

int64_t read_time(PlantReader& reader, const toml::table& table, std::string_view key, int64_t otherwise, int64_t most) {
  const toml::node* node = table.get(key);
  const int64_t time = reader.duration(table, key, otherwise);
  if (node == nullptr || time < 0) return otherwise;
  if (time >= kShortest && time <= most && time % kShortest == 0) return time;
  reader.error(place_of(*node), fmt::format("{} is whole milliseconds, 1 ms to {} s", key, most / 1'000'000'000));
  return otherwise;
}

void read_foreign_machine(PlantReader& reader, const toml::table& table) {
  reader.known_keys(table, "[[machine]]", {"name", "fmu", "every", "limit", "inputs", "outputs", "parameters"});
  MachineConfig machine;
  machine.place = place_of(table);
  machine.name = reader.text(table, "name", kMachine, true);
  reader.unique(reader.machine_names, machine.name, "machine", machine.place);
  if (reader.station_names.contains(machine.name))
    reader.error(place_of(*table.get("name")), fmt::format("'{}' is the name of a station", machine.name));
  machine.fmu = reader.text(table, "fmu", kMachine, true);
  machine.fmu_place = machine.fmu.empty() ? machine.place : place_of(*table.get("fmu"));
  machine.every = read_time(reader, table, "every", machine.every, kLongestStep);
  machine.limit = read_time(reader, table, "limit", machine.limit, kLongestAnswer);
  read_wires(reader, table, "inputs", machine.inputs);
  read_wires(reader, table, "outputs", machine.outputs);
  read_settings(reader, table, machine.parameters);
  reader.result.plant.machines.push_back(std::move(machine));
}

}  // namespace

void read_foreign_machines(PlantReader& reader, const toml::table& root) {
  reader.for_each_table(root, "machine", [&](const toml::table& table) { read_foreign_machine(reader, table); });
}

}  // namespace ipos::runtime
