// Names that steps and expectations have in common.
#include "tools/test_file/item_reader.hpp"

#include <algorithm>

namespace ipos::tools::testing {

std::string read_item_station(PlantReader& reader, const toml::table& table, std::string_view what,
                              bool gateway_too) {
  const auto& stations = reader.result.plant.stations;
  if (!table.contains("station") && stations.size() == 1) return stations.front().name;
  std::string name = reader.station(table, what, gateway_too);
  const bool is_drive = std::any_of(stations.begin(), stations.end(), [&](const auto& one) { return one.name == name; });
  if (!is_drive && reader.station_names.contains(name) && !reader.gateway_names.contains(name))
    reader.error(place_of(*table.get("station")), fmt::format("'{}' is a control: of a test only faults of a bus name it", name));
  return name;
}

const runtime::BusConfig* read_item_bus(PlantReader& reader, const toml::table& table,
                                        std::string_view what) {
  const std::string name = reader.text(table, "bus", what, true);
  if (name.empty()) return nullptr;
  const auto& buses = reader.result.plant.buses;
  const auto bus = std::find_if(buses.begin(), buses.end(), [&](const auto& b) { return b.name == name; });
  if (bus != buses.end()) return &*bus;
  reader.error(place_of(*table.get("bus")), fmt::format("there is no bus '{}'", name));
  return nullptr;
}

std::optional<std::string> read_word(PlantReader& reader, const toml::node& node, bool inputs) {
  const std::string name = node.value_or(std::string());
  constexpr std::string_view kWords[] = {"PO1", "PO2", "PO3", "PI1", "PI2", "PI3"};
  const auto end = inputs ? std::end(kWords) : std::begin(kWords) + 3;
  const auto word = std::find(std::begin(kWords), end, name);
  if (word != end) return name;
  reader.error(place_of(node),
               fmt::format("process_data is {}",
                           inputs ? "\"PO1\" to \"PO3\" or \"PI1\" to \"PI3\"" : "\"PO1\" to \"PO3\""));
  return std::nullopt;
}

}  // namespace ipos::tools::testing
