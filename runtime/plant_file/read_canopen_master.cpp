// [[control]] with kind = "canopen": a model master with its nodes, their PDOs and what is written to them first.
#include <algorithm>
#include <optional>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/canopen/pdo.hpp"
#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

namespace objects = canopen::objects;

constexpr std::string_view kTarget = "[[control.target]]";
constexpr std::string_view kPdo = "[[control.target.pdo]]";
constexpr uint32_t kWordMost = UINT16_MAX;  // a time of 16 bits

// A time in whole units; 0 when it is not there.
uint16_t time_of(PlantReader& reader, const toml::table& table, std::string_view key, Time unit) {
  const int64_t time = reader.duration(table, key, 0);
  if (time <= 0) return 0;
  if (time % unit != 0 || time / unit > kWordMost) {
    reader.error(place_of(*table.get(key)),
                 fmt::format("{} is a multiple of {} us up to {} us", key, unit / kMicrosecond,
                             kWordMost * unit / kMicrosecond));
    return 0;
  }
  return static_cast<uint16_t>(time / unit);
}

// "PO3" or "PI10".
std::optional<canopen::Mapped> mapped_word(const toml::node& node, bool transmit) {
  const std::string text = node.value_or(std::string());
  if (!text.starts_with(transmit ? "PI" : "PO")) return std::nullopt;
  for (uint8_t n = 1; n <= objects::kProcessWords; ++n)
    if (text.substr(2) == std::to_string(n))
      return canopen::Mapped{{transmit ? objects::kInput : objects::kOutput, n}, 16};
  return std::nullopt;
}

canopen::PdoPlan read_pdo(PlantReader& reader, const toml::table& table) {
  reader.known_keys(table, kPdo, {"number", "transmit", "type", "inhibit", "event", "map"});
  canopen::PdoPlan pdo;
  pdo.number = static_cast<uint8_t>(reader.count(table, "number", objects::kPdos, 1, 1) - 1);
  pdo.transmit = reader.flag(table, "transmit").value_or(false);
  pdo.type = static_cast<uint8_t>(reader.count(table, "type", UINT8_MAX, 1));
  pdo.inhibit = time_of(reader, table, "inhibit", 100 * kMicrosecond);
  pdo.event = time_of(reader, table, "event", kMillisecond);
  const toml::array* words = table["map"].as_array();
  if (words == nullptr) {
    reader.error(
        place_of(table.source()),
        "a [[control.target.pdo]] needs map = [...], a list of PO1..PO10 or, with transmit, PI1..PI10");
    return pdo;
  }
  for (const toml::node& word : *words)
    if (const auto mapped = mapped_word(word, pdo.transmit))
      pdo.mapping.push_back(*mapped);
    else
      reader.error(place_of(word), pdo.transmit ? "a PDO that a node transmits carries PI1 to PI10"
                                                : "a PDO that a node receives carries PO1 to PO10");
  if (bits_of(pdo.mapping) > canopen::kPdoBits)
    reader.error(place_of(words->source()), "a PDO carries at most four words");
  return pdo;
}

void read_words(PlantReader& reader, const toml::table& table, canopen::Words& output) {
  const toml::node* node = table.get("po");
  if (node == nullptr) return;
  const toml::array* words = node->as_array();
  if (words == nullptr || words->size() > output.size())
    return reader.error(place_of(*node), "po is a list of up to ten numbers");
  for (size_t n = 0; n < words->size(); ++n) {
    int32_t word = 0;
    if (!reader.number(*words->get(n), "a process data word", word)) continue;
    if (word < INT16_MIN || word > UINT16_MAX)
      reader.error(place_of(*words->get(n)), "a process data word has 16 bits");
    output[n] = static_cast<uint16_t>(word);
  }
}

// Values by P number or index, as [station.parameters] has them; all nodes are MOVIDRIVE MDX60B/61B.
void read_writes(PlantReader& reader, const toml::table& table, canopen::NodePlan& plan) {
  const toml::table* settings = reader.subtable(table, "parameters");
  if (settings == nullptr) return;
  const stdlib::UnitType& unit = stdlib::unit_with(stdlib::Trait::Canopen);
  for (const auto& [key, value] : *settings) {
    const std::string name(key.str());
    const stdlib::Parameter* parameter = stdlib::parameter_table(unit).find(name);
    int32_t number = 0;
    if (parameter == nullptr)
      reader.error(place_of(key.source()), fmt::format("unit {} has no parameter '{}'", unit.name, name));
    else if (reader.parameter_value(value, &unit, name, number))
      plan.writes.push_back({{parameter->index, 0}, static_cast<uint32_t>(number), 4});
  }
}

canopen::NodePlan read_node(PlantReader& reader, const toml::table& table) {
  reader.known_keys(table, kTarget, {"address", "po", "guard", "life", "heartbeat", "pdo", "parameters"});
  canopen::NodePlan plan;
  if (!table.contains("address"))
    reader.error(place_of(table.source()), "a [[control.target]] needs address = ...");
  plan.node = static_cast<uint8_t>(reader.count(table, "address", canopen::kMaxNode, 1, 1));  // P886, P896
  read_words(reader, table, plan.output);
  plan.guard_time = time_of(reader, table, "guard", kMillisecond);
  plan.life_factor =
      static_cast<uint8_t>(reader.count(table, "life", UINT8_MAX, plan.guard_time != 0 ? 3 : 0));
  plan.heartbeat = time_of(reader, table, "heartbeat", kMillisecond);
  if (plan.guard_time != 0 && plan.heartbeat != 0)
    reader.error(place_of(*table.get("heartbeat")),
                 "a node has guarding or heartbeat, never both (11264926 p. 54)");
  reader.for_each_table(table, "pdo",
                        [&](const toml::table& pdo) { plan.pdos.push_back(read_pdo(reader, pdo)); });
  read_writes(reader, table, plan);
  return plan;
}

}  // namespace

canopen::MasterSettings read_canopen_master(PlantReader& reader, const toml::table& table) {
  reader.known_keys(table, "[[control]]",
                    {"name", "kind", "sbus", "cycle", "node", "heartbeat", "terminator", "target"});
  canopen::MasterSettings settings;
  settings.sync_cycle = std::max<int64_t>(reader.duration(table, "cycle", 5 * kMillisecond), 0);
  settings.node = static_cast<uint8_t>(reader.count(table, "node", canopen::kMaxNode, canopen::kMaxNode));
  settings.heartbeat = time_of(reader, table, "heartbeat", kMillisecond);
  if (2 * settings.heartbeat > UINT16_MAX)
    reader.error(place_of(*table.get("heartbeat")), "the nodes await twice this time: at most 32767 ms");
  reader.for_each_table(table, "target", [&](const toml::table& target) {
    canopen::NodePlan plan = read_node(reader, target);
    const bool twice = std::any_of(settings.nodes.begin(), settings.nodes.end(),
                                   [&](const canopen::NodePlan& other) { return other.node == plan.node; });
    if (twice)
      reader.error(place_of(target.source()), fmt::format("node {} is a target already", plan.node));
    else
      settings.nodes.push_back(std::move(plan));
  });
  return settings;
}

}  // namespace ipos::runtime
