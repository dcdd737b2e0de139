// [station.machine] of the plant file, and the light barriers over conveyors.
#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

constexpr std::array kKinds{
#define MACHINE_KIND(kind, word, unit, per_turn) MachineKindInfo{MachineKind::kind, word, unit, per_turn},
#include "runtime/plant_file/machine_kinds.def"
};

constexpr size_t kLongestUnit = 12;     // characters (ours)
constexpr double kFarthest = 1e9;       // places in the unit (ours)
constexpr double kMostParts = 1000;     // at a time on a conveyor (ours)

// A number with or without a point, at least `least` and at most `most`. Nothing with an error, or when it is not there.
std::optional<double> read_size(PlantReader& reader, const toml::table& table, std::string_view key, double least,
                                double most) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value) {
    reader.error(place_of(*node), fmt::format("{} must be a number, in the unit of the machine", key));
    return std::nullopt;
  }
  if (*value >= least && *value <= most) return value;
  reader.error(place_of(*node), fmt::format("{} is {} to {}", key, least, most));
  return std::nullopt;
}

// False with an error.
bool read_kind(PlantReader& reader, const toml::table& table, MachineKind& kind) {
  const std::string word = reader.text(table, "kind", "[station.machine]", true);
  if (word.empty()) return false;
  const auto found = std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& row) { return row.word == word; });
  if (found != kKinds.end()) {
    kind = found->kind;
    return true;
  }
  AllowedValues allowed;
  std::vector<std::string_view> words;
  for (const MachineKindInfo& row : kKinds) {
    words.push_back(row.word);
    allowed.each.emplace_back(fmt::format("\"{}\"", row.word));
  }
  reader.error(place_of(*table.get("kind")),
               fmt::format("unknown kind '{}' of a machine; known are {}", word, fmt::join(words, ", ")), std::move(allowed));
  return false;
}

void read_unit(PlantReader& reader, const toml::table& table, DrivenMachine& machine) {
  const toml::node* unit = table.get("unit");
  const toml::node* per_turn = table.get("per_turn");
  machine.unit = info(machine.kind).unit;
  machine.per_turn = info(machine.kind).per_turn;
  if (unit != nullptr) machine.unit = reader.text(table, "unit", "[station.machine]", true);
  if (machine.unit.size() > kLongestUnit)
    reader.error(place_of(*unit), fmt::format("unit has at most {} characters", kLongestUnit));
  constexpr double kLeast = 1e-6, kMost = 1e6;
  if (const auto size = read_size(reader, table, "per_turn", -kMost, kMost)) {
    if (std::abs(*size) < kLeast)
      reader.error(place_of(*per_turn), "per_turn must not be 0: it is what the machine moves by in a turn of the motor");
    else
      machine.per_turn = *size;
  }
  if (unit != nullptr && per_turn == nullptr)
    reader.error(place_of(*unit), "unit needs per_turn: what the machine moves by in a turn of the motor");
  if (per_turn != nullptr && unit == nullptr && info(machine.kind).per_turn == 1)
    reader.error(place_of(*per_turn), "per_turn needs unit = \"mm\", or what else it is in");
}

void read_travel(PlantReader& reader, const toml::table& table, DrivenMachine& machine) {
  const auto from = read_size(reader, table, "from", -kFarthest, kFarthest);
  const auto to = read_size(reader, table, "to", -kFarthest, kFarthest);
  const toml::node* from_node = table.get("from");
  const toml::node* to_node = table.get("to");
  if ((from_node == nullptr) != (to_node == nullptr))
    return reader.error(place_of(*(from_node != nullptr ? from_node : to_node)), "from and to belong together");
  if (!from || !to) return;
  if (*from < *to)
    machine.travel = {*from, *to};
  else
    reader.error(place_of(*to_node), "to is not above from");
}

void read_part_places(PlantReader& reader, const toml::table& table, DrivenMachine& machine) {
  const toml::node* node = table.get("parts");
  if (node == nullptr) return;
  const toml::array* places = node->as_array();
  const auto is_place = [](const toml::node& place) {
    return place.is_number() && std::abs(place.value_or(kFarthest * 2)) <= kFarthest;
  };
  if (places == nullptr || !std::all_of(places->begin(), places->end(), is_place))
    return reader.error(place_of(*node), "parts must be a list of places, in the unit of the machine");
  for (const toml::node& place : *places) machine.parts.push_back(place.value_or(0.0));
  if (static_cast<double>(machine.parts.size()) > kMostParts)
    return reader.error(place_of(*node), fmt::format("at most {} parts lie on a conveyor", kMostParts));
  const auto& travel = machine.travel;
  for (const toml::node& place : *places)
    if (travel && !(place.value_or(0.0) >= travel->from && place.value_or(0.0) <= travel->to))
      reader.error(place_of(place), fmt::format("a part lies from {} to {} (from and to)", travel->from, travel->to));
}

void read_parts(PlantReader& reader, const toml::table& table, DrivenMachine& machine) {
  for (const std::string_view key : {"parts", "part_length", "feed"})
    if (table.contains(key) && machine.kind != MachineKind::Conveyor)
      return reader.error(place_of(*table.get(key)), fmt::format("{} is of a conveyor", key));
  read_part_places(reader, table, machine);
  const auto length = read_size(reader, table, "part_length", 0, kFarthest);
  if (length) machine.part_length = *length;
  const auto feed = read_size(reader, table, "feed", 0, kFarthest);
  const toml::node* first = table.contains("parts") ? table.get("parts") : table.get("feed");
  if (first == nullptr) return;
  if (!table.contains("part_length") || (length && *length == 0))
    reader.error(place_of(*first), "parts need part_length, which is above 0");
  if (!table.contains("from") || !table.contains("to"))
    reader.error(place_of(*first), "parts need from and to, where the belt begins and ends");
  if (!feed) return;
  const double way = machine.travel ? machine.travel->to - machine.travel->from : 0;
  if (*feed == 0 || *feed < machine.part_length)
    reader.error(place_of(*table.get("feed")), "feed is not below part_length: parts lie one after the other");
  else if (way / *feed > kMostParts)
    reader.error(place_of(*table.get("feed")), fmt::format("at most {} parts lie on a conveyor", kMostParts));
  else
    machine.feed = *feed;
}

}  // namespace

std::span<const MachineKindInfo> machine_kinds() { return kKinds; }

const MachineKindInfo& info(MachineKind kind) { return kKinds[static_cast<size_t>(kind)]; }

void read_machine(PlantReader& reader, const toml::table& station, StationConfig& config) {
  const toml::table* table = reader.subtable(station, "machine");
  if (table == nullptr) return;
  reader.known_keys(*table, "[station.machine]",
                    {"kind", "unit", "per_turn", "from", "to", "parts", "part_length", "feed"});
  DrivenMachine machine;
  machine.place = place_of(*table);
  const bool known = read_kind(reader, *table, machine.kind);
  if (known) read_unit(reader, *table, machine);
  read_travel(reader, *table, machine);
  if (known) read_parts(reader, *table, machine);
  config.driven = std::move(machine);
}

void read_barrier(PlantReader& reader, const toml::table& table, LightBarrier barrier) {
  if (const auto at = read_size(reader, table, "part_at", -kFarthest, kFarthest)) barrier.at = *at;
  const toml::node* belt = table.get("belt");
  barrier.belt = belt == nullptr ? barrier.input.station : reader.text(table, "belt", "", true);
  const FilePlace place = place_of(belt == nullptr ? *table.get("part_at") : *belt);
  if (belt != nullptr && !barrier.belt.empty()) reader.use_station(barrier.belt, place);
  for (const StationConfig& station : reader.result.plant.stations) {
    if (station.name != barrier.belt) continue;
    const auto& machine = station.driven;
    if (!machine || machine->kind != MachineKind::Conveyor || !machine->travel)
      reader.error(place, fmt::format("'{}' has no [station.machine] with kind = \"conveyor\", from and to", barrier.belt));
    else if (!machine->carries())
      reader.error(place, fmt::format("the conveyor of '{}' has neither parts nor feed", barrier.belt));
    else if (!(barrier.at >= machine->travel->from && barrier.at <= machine->travel->to))
      reader.error(place_of(*table.get("part_at")), fmt::format("the belt of '{}' goes from {} to {}", barrier.belt,
                                                              machine->travel->from, machine->travel->to));
  }
  reader.result.plant.barriers.push_back(std::move(barrier));
}

}  // namespace ipos::runtime
