// [[control]] of the plant file: a master control on an SBus; one on a PROFIBUS has a reader of its own.
#include <algorithm>

#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

void read_control_target(PlantReader& reader, const toml::table& table, ControlSettings& settings) {
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

void read_sbus_control(PlantReader& reader, const toml::table& table, ControlConfig& config) {
  reader.known_keys(table, "[[control]]", {"name", "kind", "sbus", "sync", "cycle", "terminator", "target"});
  config.sbus = reader.bus_name(table, "sbus", "a [[control]]", true);
  config.terminator = reader.flag(table, "terminator");
  auto& settings = config.kind.emplace<ControlSettings>();
  if (table.contains("sync"))
    settings.sync_id = static_cast<uint16_t>(reader.count(table, "sync", 2047, 0));
  settings.cycle = reader.duration(table, "cycle", kSyncCycle);
  if (settings.cycle >= 0 && settings.cycle < kSyncCycle)
    reader.error(place_of(table.get("cycle")->source()), "a sync cycle has at least 5ms");
  reader.for_each_table(table, "target", [&](const toml::table& target) {
    read_control_target(reader, target, settings);
  });
  const auto is_synchronous = [](const ControlTarget& target) { return target.every == 0; };
  if (!settings.sync_id &&
      std::any_of(settings.targets.begin(), settings.targets.end(), is_synchronous))
    reader.error(config.place,
                 "a target without every = ... is synchronous and needs sync = ... in its [[control]]");
}

void read_control(PlantReader& reader, const toml::table& table) {
  ControlConfig config;
  config.place = place_of(table.source());
  config.name = reader.text(table, "name", "a [[control]]", true);
  reader.new_station(config.name, config.place);
  const std::string kind = reader.text(table, "kind", "", false);
  if (!kind.empty() && kind != "canopen" && kind != "sbus" && kind != "fms")
    reader.error(place_of(*table.get("kind")),
                 fmt::format("'{}' is no kind of control; known are sbus, canopen, fms", kind));
  if (kind == "fms") {
    read_fms_master(reader, table, config);
  } else if (table.contains("profibus")) {
    read_profibus_master(reader, table, config);
  } else if (kind == "canopen") {
    config.sbus = reader.bus_name(table, "sbus", "a [[control]]", true);
    config.terminator = reader.flag(table, "terminator");
    config.kind = read_canopen_master(reader, table);
  } else {
    read_sbus_control(reader, table, config);
  }
  reader.result.plant.controls.push_back(std::move(config));
}

// A station whose switch is at FMS takes longer to answer: the masters of its line wait longer (the time is ours).
void lengthen_slots(PlantFile& plant) {
  const auto lengthen = [&plant](const std::string& bus, profibus::MasterSettings& settings) {
    const bool mixed = std::any_of(plant.stations.begin(), plant.stations.end(), [&](const StationConfig& station) {
      return station.profibus.fms_switch && station.profibus.bus.bus == bus;
    });
    const auto line = std::find_if(plant.buses.begin(), plant.buses.end(), [&](const BusConfig& one) { return one.name == bus; });
    if (!mixed || line == plant.buses.end()) return;
    if (const profibus::BaudRate* rate = profibus::find_baud_rate(line->baud)) settings.slot = rate->slot + rate->fms_min_tsdr;
  };
  for (ControlConfig& control : plant.controls) {
    if (auto* const dp = std::get_if<ProfibusMasterConfig>(&control.kind)) lengthen(dp->bus, dp->settings);
    if (auto* const fms = std::get_if<FmsMasterConfig>(&control.kind)) lengthen(fms->bus, fms->settings);
  }
}

}  // namespace

void read_controls(PlantReader& reader, const toml::table& root) {
  reader.for_each_table(root, "control", [&](const toml::table& table) { read_control(reader, table); });
  // In the order of the file, with the gateways that stand among the stations.
  auto& controls = reader.result.plant.controls;
  std::stable_sort(controls.begin(), controls.end(), [](const ControlConfig& a, const ControlConfig& b) {
    return a.place.line < b.place.line;
  });
  lengthen_slots(reader.result.plant);
}

}  // namespace ipos::runtime
