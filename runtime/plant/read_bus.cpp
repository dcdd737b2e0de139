// [[bus]] of the plant file.
#include <algorithm>

#include "runtime/plant/plant_reader.hpp"

namespace ipos::runtime {
namespace {

struct KindName {
  std::string_view name;
  BusKind kind;
  uint32_t baud;  // factory setting
};
constexpr KindName kKinds[] = {{"can", BusKind::Can, 500'000},
                               {"rs485", BusKind::Rs485, 9'600},
                               {"rs232", BusKind::Rs232, 9'600},
                               {"profibus", BusKind::Profibus, 0}};

void read_kind(PlantReader& reader, const toml::table& table, BusConfig& config) {
  const std::string kind = reader.text(table, "kind", "a [[bus]]", true);
  const auto row =
      std::find_if(std::begin(kKinds), std::end(kKinds), [&](const KindName& k) { return k.name == kind; });
  if (row != std::end(kKinds)) {
    config.kind = row->kind;
    config.baud = row->baud;
  } else if (!kind.empty()) {
    reader.error(place_of(*table.get("kind")),
                 fmt::format("'{}' is no kind of bus; known are can, rs485, rs232, profibus", kind));
  }
  if (config.kind == BusKind::Profibus)
    reader.error(place_of(*table.get("kind")), fmt::format("buses of kind '{}' are not simulated yet", kind));
}

// 1053 1610 p. 8: the rates of the SBus and of RS-232; 57.6 kbaud MDX60B/61B p. 14.
void read_baud(PlantReader& reader, const toml::table& table, BusConfig& config) {
  const toml::node* node = table.get("baud");
  int32_t value = 0;
  if (node == nullptr || !reader.number(*node, "baud", value)) return;
  config.baud = static_cast<uint32_t>(value);
  const auto is_one_of = [value](std::initializer_list<int32_t> rates) {
    return std::find(rates.begin(), rates.end(), value) != rates.end();
  };
  if (config.kind == BusKind::Can && !is_one_of({125'000, 250'000, 500'000, 1'000'000}))
    reader.error(place_of(*node),
                 fmt::format("the SBus has 125000, 250000, 500000 or 1000000 baud, not {}", value));
  if (config.kind == BusKind::Rs485 && !is_one_of({9'600, 57'600}))
    reader.error(place_of(*node), fmt::format("RS-485 has 9600 or 57600 baud, not {}", value));
  if (config.kind == BusKind::Rs232 && !is_one_of({9'600}))
    reader.error(place_of(*node), fmt::format("RS-232 has 9600 baud, not {}", value));
}

// The cable, for the planner.
void read_wiring(PlantReader& reader, const toml::table& table, BusConfig& config) {
  config.shielded = reader.flag(table, "shielded").value_or(false);
  config.terminated = reader.flag(table, "terminated").value_or(false);
  config.impedance = reader.count(table, "impedance", 1000, 0);
  config.capacitance = reader.count(table, "capacitance", 1000, 0);
  const toml::node* length = table.get("length");
  if (length == nullptr) return;
  const auto metres = length->value<double>();
  constexpr double kLongest = 1e6;
  if (!metres || !(*metres > 0) || *metres > kLongest)
    return reader.error(place_of(*length), "length is the length of the line in metres");
  config.length_mm = static_cast<uint32_t>(*metres * 1000 + 0.5);
}

void read_port(PlantReader& reader, const toml::table& table, BusConfig& config) {
  config.port = reader.text(table, "port", "", false);
  const toml::node* port = table.get("port");
  if (port == nullptr) return;
  config.port_place = place_of(*port);
  if (config.port.empty() && port->is_string()) reader.error(config.port_place, "port must not be empty");
  reader.unique(reader.port_names, config.port, "port", config.port_place);
}

void read_bus(PlantReader& reader, const toml::table& table) {
  reader.known_keys(
      table, "[[bus]]",
      {"name", "kind", "baud", "port", "length", "impedance", "capacitance", "shielded", "terminated"});
  BusConfig config;
  config.place = place_of(table);
  config.name = reader.text(table, "name", "a [[bus]]", true);
  reader.unique(reader.bus_names, config.name, "bus", config.place);
  read_kind(reader, table, config);
  read_baud(reader, table, config);
  read_wiring(reader, table, config);
  read_port(reader, table, config);
  reader.result.plant.buses.push_back(std::move(config));
}

}  // namespace

void read_buses(PlantReader& reader, const toml::table& root) {
  reader.for_each_table(root, "bus", [&](const toml::table& table) { read_bus(reader, table); });
}

}  // namespace ipos::runtime
