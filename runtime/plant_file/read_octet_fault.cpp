// [[fault]] of a line that carries octets: RS-485, RS-232, PROFIBUS.
#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

// In messages: RS-485 and RS-232 have not the same faults.
std::string line_words(BusKind kind) {
  return is_serial(kind) ? fmt::format("an {} line", info(kind).name) : std::string(info(kind).line);
}

std::string fault_words(OctetLine line) {
  std::vector<std::string_view> words;
  for (const OctetFaultType& type : octet_fault_types())
    if (type.is_of(line)) words.push_back(type.word);
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

void read_octet_fault(PlantReader& reader, const toml::table& table, BusKind line) {
  reader.known_keys(table, fmt::format("[[fault]] of {}", line_words(line)),
                    {"bus", "kind", "station", "frame", "rate", "seed", "from", "until"});
  FaultConfig config;
  config.place = place_of(table.source());
  config.bus = reader.bus_use(table, "bus", line).bus;
  config.station = reader.station_name(table, "station");
  OctetFault& fault = config.octets.emplace();
  const std::string word = reader.text(table, "kind", "a [[fault]]", true);
  if (const OctetFaultType* const type = find_octet_fault(word, octet_line_of(line)))
    fault.kind = type->kind;
  else if (!word.empty())
    reader.error(place_of(*table.get("kind")), fmt::format("'{}' is no fault of {}; known are {}", word, line_words(line),
                                                           fault_words(octet_line_of(line))));
  const bool of_station = octet_fault_type(fault.kind).scope == OctetFaultScope::Station;
  if (of_station && config.station.empty())
    reader.error(config.place, fmt::format("a fault '{}' needs station = \"...\"", word));
  for (const char* key : {"frame", "rate", "seed"})
    if (const toml::node* node = table.get(key); node != nullptr && of_station)
      reader.error(place_of(*node), fmt::format("{} does not belong to a fault '{}'", key, word));
  const bool counted = table.contains("frame");  // a wrong number is told once, and then goes as the first
  fault.frame = reader.count(table, "frame", INT32_MAX, counted ? 1 : 0);
  fault.per_mille = reader.count(table, "rate", 1000, 1000);
  fault.seed = reader.count(table, "seed", INT32_MAX, 1);
  if (counted && (fault.frame == 0 || table.contains("rate")))
    reader.error(place_of(*table.get("frame")),
                 "a fault strikes the n-th frame, counted from 1, or a rate of them");
  fault.from = reader.duration(table, "from", 0);
  fault.until = reader.duration(table, "until", kNever);
  if (fault.from >= 0 && fault.until >= 0 && fault.until <= fault.from)
    reader.error(config.place, "until must be after from");
  reader.result.plant.faults.push_back(std::move(config));
}

}  // namespace ipos::runtime
