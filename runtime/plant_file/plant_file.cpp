// Reads the plant file with toml++: the sections one after the other, then what they say of each other.
#include "runtime/plant_file/plant_file.hpp"

#include <algorithm>
#include <charconv>

#include "runtime/plant_file/plant_reader.hpp"
#include "runtime/plant_file/serial_plan.hpp"

namespace ipos::runtime {

void check_plant(PlantReader& reader) {
  for (const auto& [use, kind] : reader.bus_uses) {
    const auto& buses = reader.result.plant.buses;
    const auto bus = std::find_if(buses.begin(), buses.end(),
                                  [&name = use.bus](const BusConfig& b) { return b.name == name; });
    if (bus == buses.end())
      reader.error(use.place, fmt::format("there is no bus '{}'", use.bus));
    else if (info(bus->kind).line != info(kind).line)
      reader.error(use.place,
                   fmt::format("bus '{}' is {}, not {}", use.bus, info(bus->kind).line, info(kind).line));
  }
  for (PlantError& problem : check_serial_plan(reader.result.plant))
    reader.result.errors.push_back(std::move(problem));
  for (const auto& [name, place] : reader.station_uses)
    if (!reader.station_names.contains(name))
      reader.error(place, fmt::format("there is no station '{}'", name));
  if (reader.result.plant.stations.empty() && reader.result.errors.empty())
    reader.error({1, 1}, reader.gateway_names.empty()
                             ? "the plant has no [[station]]"
                             : "the plant has no [[station]] with a drive: a gateway alone does not run");
  std::stable_sort(reader.result.errors.begin(), reader.result.errors.end(),
                   [](const auto& a, const auto& b) {
                     return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
                   });
}

std::optional<toml::table> parse_toml(PlantReader& reader, std::string_view text) {
  auto table = read_toml(text);
  if (table) return *std::move(table);
  reader.error(table.error().place, table.error().text);
  return std::nullopt;
}

void read_plant_sections(PlantReader& reader, const toml::table& root,
                         const std::vector<std::string_view>& also) {
  std::vector<std::string_view> known = {"bus", "station", "control", "fault", "stimulus", "wire", "switch", "machine", "seed"};
  known.insert(known.end(), also.begin(), also.end());
  reader.known_keys(root, "the plant", known);
  read_buses(reader, root);
  read_stations(reader, root);
  read_controls(reader, root);
  read_faults(reader, root);
  read_foreign_machines(reader, root);
  read_surroundings(reader, root);
  move_seeds(reader.result.plant, reader.count(root, "seed", INT32_MAX, 0));
}

void move_seeds(PlantFile& plant, uint64_t by) {
  for (FaultConfig& fault : plant.faults) fault.begin_at(0, by);
  plant.line_seed += by;
  constexpr uint32_t kFarApart = 2'654'435'769U;  // odd, so that no two are the same
  for (StationConfig& station : plant.stations)
    station.machine.noise_seed += static_cast<uint32_t>(by) * kFarApart;
}

bool refuse_others(PlantReader& reader, const toml::table& root, std::string_view path, std::initializer_list<TomlKind> taken) {
  const auto why = wrong_kind(root, path, taken);
  if (why) reader.error(why->place, why->text);
  return why.has_value();
}

PlantFileResult read_plant_file(std::string_view text, std::string_view path) {
  PlantReader reader;
  const auto root = parse_toml(reader, text);
  if (!root || refuse_others(reader, *root, path, {TomlKind::Plant})) return std::move(reader.result);
  read_plant_sections(reader, *root, {"expect"});
  read_expectations(reader, *root);
  check_plant(reader);
  return std::move(reader.result);
}

PlantFileResult read_fault_tables(std::string_view text, const PlantFile& plant) {
  PlantReader reader;
  reader.result.plant.buses = plant.buses;
  reader.result.plant.stations = plant.stations;
  for (const BusConfig& bus : plant.buses) reader.bus_names.insert(bus.name);
  for (const StationConfig& station : plant.stations) reader.station_names.insert(station.name);
  for (const ControlConfig& control : plant.controls) reader.station_names.insert(control.name);
  if (const auto root = parse_toml(reader, text)) {
    reader.known_keys(*root, "the text", {"fault"});
    read_faults(reader, *root);
    check_plant(reader);
  }
  PlantFileResult faults;
  faults.plant.faults = std::move(reader.result.plant.faults);
  faults.errors = std::move(reader.result.errors);
  return faults;
}

int64_t parse_duration(std::string_view text) {
  struct TimeUnit {
    std::string_view name;
    int64_t ns;
  };
  static constexpr TimeUnit kUnits[] = {{"us", 1'000},
                                        {"ms", 1'000'000},
                                        {"min", 60'000'000'000},
                                        {"s", 1'000'000'000},
                                        {"h", 3'600'000'000'000}};
  for (const TimeUnit& unit : kUnits) {
    if (!text.ends_with(unit.name)) continue;
    const std::string_view number = text.substr(0, text.size() - unit.name.size());
    double value = 0;
    const auto [end, status] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (status != std::errc() || end != number.data() + number.size() || !(value >= 0) || value > 1e9)
      return -1;
    const double ns = value * static_cast<double>(unit.ns);
    return ns > 9e18 ? -1 : static_cast<int64_t>(ns + 0.5);
  }
  return -1;
}

}  // namespace ipos::runtime
