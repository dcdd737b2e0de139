// The tables [[control]] and [[fault]] of the plant file, for its reader only: `Reader` is the class of
// plant_file.cpp with its checks and messages.
#pragma once

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <string>
#include <vector>

#include "runtime/plant/plant_file.hpp"

namespace ipos::runtime {

inline FilePlace place_of(const toml::source_region& region) {
  return {region.begin.line, region.begin.column};
}

template <typename Reader>
void read_control_target(Reader& reader, const toml::table& table, ControlSettings& settings) {
  reader.known_keys(table, "[[control.target]]", {"address", "group", "po", "every"});
  ControlTarget target;
  target.group = table.contains("group");
  if (target.group == table.contains("address"))
    reader.error(place_of(table.source()), "a [[control.target]] needs address = ... or group = ...");
  target.address = static_cast<uint8_t>(reader.count(table, target.group ? "group" : "address", 63, 0));
  target.every = reader.duration(table, "every", 0);
  if (table.contains("every") && target.every == 0)
    reader.error(place_of(table.get("every")->source()), "every must be more than 0");
  if (target.group && target.every == 0)
    reader.error(place_of(table.source()), "group process data need every = ...: they cannot be synchronous");
  if (const toml::array* words = table["po"].as_array()) {
    if (words->size() > target.output.size())
      reader.error(place_of(words->source()), "there are three process data words");
    for (size_t n = 0; n < std::min(words->size(), target.output.size()); ++n) {
      int32_t word = 0;
      if (!reader.number(*words->get(n), "a process data word", word)) continue;
      if (word < INT16_MIN || word > UINT16_MAX)
        reader.error(place_of(words->get(n)->source()), "a process data word has 16 bits");
      target.output[n] = static_cast<uint16_t>(word);
    }
  } else if (table.contains("po")) {
    reader.error(place_of(table.get("po")->source()), "po is a list of up to three numbers");
  }
  settings.targets.push_back(target);
}

template <typename Reader>
void read_control(Reader& reader, const toml::table& table, PlantFile& plant) {
  reader.known_keys(table, "[[control]]", {"name", "sbus", "sync", "cycle", "terminator", "target"});
  ControlConfig config;
  config.place = place_of(table.source());
  config.name = reader.text(table, "name", "a [[control]]", true);
  reader.new_station(config.name, config.place);
  config.sbus = reader.bus_name(table, "sbus", "a [[control]]", true);
  config.terminator = reader.flag(table, "terminator");
  if (table.contains("sync"))
    config.settings.sync_id = static_cast<uint16_t>(reader.count(table, "sync", 2047, 0));
  config.settings.cycle = reader.duration(table, "cycle", kSyncCycle);
  if (config.settings.cycle >= 0 && config.settings.cycle < kSyncCycle)
    reader.error(place_of(table.get("cycle")->source()), "a sync cycle has at least 5ms");
  reader.for_each_table(table, "target", [&](const toml::table& target) {
    read_control_target(reader, target, config.settings);
  });
  const auto is_synchronous = [](const ControlTarget& target) { return target.every == 0; };
  if (!config.settings.sync_id &&
      std::any_of(config.settings.targets.begin(), config.settings.targets.end(), is_synchronous))
    reader.error(config.place,
                 "a target without every = ... is synchronous and needs sync = ... in its [[control]]");
  plant.controls.push_back(std::move(config));
}

// Where and to whom a fault happens.
template <typename Reader>
void read_fault_place(Reader& reader, const toml::table& table, FaultConfig& config) {
  const FaultKind kind = config.fault.kind;
  const bool behind = table.contains("behind");
  if (behind && kind != FaultKind::Cut)
    reader.error(place_of(table.get("behind")->source()), "behind belongs to kind = \"cut\"");
  if (behind && table.contains("station"))
    reader.error(place_of(table.get("behind")->source()),
                 "a cut is behind a station, or of the connection of one station: not both");
  config.fault.behind = behind;
  config.station = reader.station_name(table, behind ? "behind" : "station");
  const bool needs_station = kind == FaultKind::Cut || kind == FaultKind::Swap;
  const bool takes_none = kind == FaultKind::Short || kind == FaultKind::Stuck ||
                          kind == FaultKind::Terminator || kind == FaultKind::Duplicate;
  if (needs_station && config.station.empty())
    reader.error(config.place, fmt::format("a fault '{}' needs station = \"...\"{}", fault_type(kind).word,
                                           kind == FaultKind::Cut ? " or behind = \"...\"" : ""));
  if (takes_none && !config.station.empty())
    reader.error(config.place, fmt::format("a fault '{}' concerns the whole line", fault_type(kind).word));
}

// Which frames it strikes.
template <typename Reader>
void read_fault_choice(Reader& reader, const toml::table& table, LineFault& fault) {
  const FaultType& type = fault_type(fault.kind);
  if (type.scope == FaultScope::Wiring) {
    for (const char* key : {"id", "frame", "rate", "seed"})
      if (const toml::node* node = table.get(key))
        reader.error(place_of(node->source()),
                     fmt::format("{} does not belong to a fault '{}'", key, type.word));
    return;
  }
  if (table.contains("id")) fault.id = reader.count(table, "id", 0x1FFF'FFFF, 0);
  fault.frame = reader.count(table, "frame", INT32_MAX, 0);
  fault.per_mille = reader.count(table, "rate", 1000, 1000);
  fault.seed = reader.count(table, "seed", INT32_MAX, 1);
  if (table.contains("frame") && fault.frame == 0)
    reader.error(place_of(table.get("frame")->source()), "frames are counted from 1");
  if (table.contains("frame") && table.contains("rate"))
    reader.error(place_of(table.get("rate")->source()),
                 "a fault strikes the n-th frame, or a rate of them: not both");
}

template <typename Reader>
void read_fault(Reader& reader, const toml::table& table, PlantFile& plant) {
  reader.known_keys(
      table, "[[fault]]",
      {"bus", "kind", "station", "behind", "id", "frame", "rate", "seed", "from", "until", "delay"});
  FaultConfig config;
  config.place = place_of(table.source());
  config.bus = reader.bus_name(table, "bus", "a [[fault]]", true);
  const std::string word = reader.text(table, "kind", "a [[fault]]", true);
  const auto type = std::find_if(std::begin(kFaultTypes), std::end(kFaultTypes),
                                 [&](const FaultType& candidate) { return candidate.word == word; });
  if (type == std::end(kFaultTypes)) {
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
  if (config.fault.from >= 0 && config.fault.until >= 0 && config.fault.until <= config.fault.from)
    reader.error(config.place, "until must be after from");
  plant.faults.push_back(std::move(config));
}

}  // namespace ipos::runtime
