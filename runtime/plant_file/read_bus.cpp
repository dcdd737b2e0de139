// [[bus]] of the plant file.
#include <algorithm>

#include "runtime/bus/log/log_name.hpp"
#include "runtime/plant_file/outer_port.hpp"
#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

void read_kind(PlantReader& reader, const toml::table& table, BusConfig& config) {
  const std::string word = reader.text(table, "kind", "a [[bus]]", true);
  const auto row = std::find_if(bus_kinds().begin(), bus_kinds().end(),
                                [&](const BusKindInfo& kind) { return kind.word == word; });
  if (row != bus_kinds().end()) {
    config.kind = row->kind;
    config.baud = row->baud;
  } else if (!word.empty()) {
    std::vector<std::string_view> words;
    for (const BusKindInfo& kind : bus_kinds()) words.push_back(kind.word);
    reader.error(place_of(*table.get("kind")),
                 fmt::format("'{}' is no kind of bus; known are {}", word, fmt::join(words, ", ")));
  }
}

AllowedValues rates_of(const BusKindInfo& kind) {
  AllowedValues rates;
  for (const uint32_t rate : kind.rates) rates.each.push_back(fmt::format("{}", rate));
  return rates;
}

void read_baud(PlantReader& reader, const toml::table& table, BusConfig& config) {
  const toml::node* node = table.get("baud");
  int32_t value = 0;
  if (node == nullptr || !reader.number(*node, "baud", value)) return;
  config.baud = static_cast<uint32_t>(value);
  const BusKindInfo& kind = info(config.kind);
  if (std::find(kind.rates.begin(), kind.rates.end(), config.baud) != kind.rates.end()) return;
  const auto some = kind.rates.first(kind.rates.size() - 1);
  const std::string last = fmt::format("{}{}", some.empty() ? "" : " or ", kind.rates.back());
  reader.error(place_of(*node),
               fmt::format("{} has {}{} baud, not {}", kind.name, fmt::join(some, ", "), last, value),
               rates_of(kind));
}

// The cable, for the planner.
void read_wiring(PlantReader& reader, const toml::table& table, BusConfig& config) {
  config.shielded = reader.flag(table, "shielded").value_or(false);
  config.terminated = reader.flag(table, "terminated").value_or(false);
  config.impedance = reader.count(table, "impedance", 1000, 0);
  config.capacitance = reader.count(table, "capacitance", 1000, 0);
  for (const auto& [key, out] : {std::pair("loop_resistance", &config.loop_resistance), std::pair("core_diameter", &config.core_diameter),
                                 std::pair("core_section", &config.core_section)}) {
    const toml::node* node = table.get(key);
    if (node == nullptr) continue;
    const auto value = node->value<double>();
    if (!value || !(*value > 0) || *value > 1000)
      reader.error(place_of(*node), fmt::format("{} is a number above 0", key));
    else if (config.kind != BusKind::Profibus)
      reader.error(place_of(*node), fmt::format("{} is of the cable of a PROFIBUS line", key));
    else
      *out = *value;
  }
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
  if (has_outer_port(config)) reader.unique(reader.port_names, config.port, "port", config.port_place);
}

void read_bus(PlantReader& reader, const toml::table& table) {
  reader.known_keys(
      table, "[[bus]]",
      {"name", "kind", "baud", "port", "length", "impedance", "capacitance", "loop_resistance", "core_diameter",
       "core_section", "shielded", "terminated"});
  BusConfig config;
  config.place = place_of(table);
  config.name = reader.text(table, "name", "a [[bus]]", true);
  reader.unique(reader.bus_names, config.name, "bus", config.place);
  if (log_name(config.name) != config.name)
    reader.error(place_of(*table.get("name")),
                 "the name of a bus is one word: it stands in the lines of logs");
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
