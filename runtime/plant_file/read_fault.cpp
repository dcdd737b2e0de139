// [[fault]] of the plant file: what is done to a line; those of a CAN line.
#include <algorithm>

#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

// Where and to whom a fault happens.
void read_fault_place(PlantReader& reader, const toml::table& table, FaultConfig& config) {
  const FaultKind kind = config.fault.kind;
  const bool behind = table.contains("behind");
  if (behind && kind != FaultKind::Cut)
    reader.error(place_of(table.get("behind")->source()), "behind belongs to kind = \"cut\"");
  if (behind && table.contains("station"))
    reader.error(place_of(table.get("behind")->source()),
                 "a cut is behind a station, or of the connection of one station: not both");
  config.fault.behind = behind;
  config.station = reader.station_name(table, behind ? "behind" : "station");
  const FaultPlace at = fault_type(kind).at;
  if (at == FaultPlace::Station && config.station.empty())
    reader.error(config.place, fmt::format("a fault '{}' needs station = \"...\"{}", fault_type(kind).word,
                                           kind == FaultKind::Cut ? " or behind = \"...\"" : ""));
  if (at == FaultPlace::Line && !config.station.empty())
    reader.error(config.place, fmt::format("a fault '{}' concerns the whole line", fault_type(kind).word));
}

// Which frames it strikes.
void read_fault_choice(PlantReader& reader, const toml::table& table, LineFault& fault) {
  const FaultType& type = fault_type(fault.kind);
  if (type.scope == FaultScope::Wiring) {
    for (const char* key : {"id", "frame", "rate", "seed"})
      if (const toml::node* node = table.get(key))
        reader.error(place_of(node->source()),
                     fmt::format("{} does not belong to a fault '{}'", key, type.word));
    return;
  }
  if (table.contains("id")) fault.id = reader.count(table, "id", 0x1FFF'FFFF, 0);
  const bool counted = table.contains("frame");  // a wrong number is told once, and then goes as the first
  fault.frame = reader.count(table, "frame", INT32_MAX, counted ? 1 : 0);
  fault.per_mille = reader.count(table, "rate", 1000, 1000);
  fault.seed = reader.count(table, "seed", INT32_MAX, 1);
  if (counted && fault.frame == 0)
    reader.error(place_of(table.get("frame")->source()), "frames are counted from 1");
  if (counted && table.contains("rate"))
    reader.error(place_of(table.get("rate")->source()),
                 "a fault strikes the n-th frame, or a rate of them: not both");
}

// What its station is set to.
void read_fault_baud(PlantReader& reader, const toml::table& table, FaultConfig& config) {
  const toml::node* node = table.get("baud");
  if ((node != nullptr) != (config.fault.kind == FaultKind::Baud))
    return reader.error(config.place, "baud = ... belongs to kind = \"baud\", and there it must be");
  int32_t rate = 0;
  if (node == nullptr || !reader.number(*node, "baud", rate)) return;
  const auto& rates = info(BusKind::Can).rates;
  config.fault.baud = static_cast<uint32_t>(rate);
  if (std::find(rates.begin(), rates.end(), config.fault.baud) == rates.end())
    reader.error(place_of(*node), fmt::format("a CAN station has {} baud, not {}", fmt::join(rates, ", "), rate));
}

}  // namespace

void read_fault(PlantReader& reader, const toml::table& table) {
  const auto& buses = reader.result.plant.buses;
  const std::string bus = table["bus"].value_or(std::string());
  const auto octets = std::find_if(buses.begin(), buses.end(), [&](const BusConfig& candidate) {
    return candidate.name == bus && carries_octets(candidate.kind);
  });
  if (octets != buses.end()) return read_octet_fault(reader, table, octets->kind);
  reader.known_keys(
      table, "[[fault]]",
      {"bus", "kind", "station", "behind", "id", "frame", "rate", "seed", "from", "until", "delay", "baud"});
  FaultConfig config;
  config.place = place_of(table.source());
  config.bus = reader.bus_name(table, "bus", "a [[fault]]", true);
  const std::string word = reader.text(table, "kind", "a [[fault]]", true);
  const FaultType* const type = find_fault_type(word);
  if (type == nullptr) {
    std::vector<std::string_view> words;
    for (const FaultType& known : kFaultTypes) words.push_back(known.word);
    if (!word.empty())
      reader.error(place_of(table.get("kind")->source()),
                   fmt::format("'{}' is no fault; known are {}", word, fmt::join(words, ", ")));
    return;
  }
  config.fault.kind = type->kind;
  read_fault_place(reader, table, config);
  read_fault_choice(reader, table, config.fault);
  config.fault.from = reader.duration(table, "from", 0);
  config.fault.until = reader.duration(table, "until", kNever);
  config.fault.lag = reader.duration(table, "delay", 0);
  if (table.contains("delay") != (type->kind == FaultKind::Delay))
    reader.error(config.place, "delay = ... belongs to kind = \"delay\", and there it must be");
  read_fault_baud(reader, table, config);
  if (config.fault.from >= 0 && config.fault.until >= 0 && config.fault.until <= config.fault.from)
    reader.error(config.place, "until must be after from");
  reader.result.plant.faults.push_back(std::move(config));
}

void read_faults(PlantReader& reader, const toml::table& root) {
  reader.for_each_table(root, "fault", [&](const toml::table& table) { read_fault(reader, table); });
}

}  // namespace ipos::runtime
