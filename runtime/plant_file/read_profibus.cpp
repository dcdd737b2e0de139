// PROFIBUS in the plant file: the card of a [[station]], a [[control]] that is a master.
#include <algorithm>

#include "runtime/bus/profibus/card.hpp"
#include "runtime/bus/profibus/cfg_data.hpp"
#include "runtime/plant_file/bytes_text.hpp"
#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kChannelOctets = 8;  // octets of the parameter channel

// The option pcb where the file says which of the two it is.
struct Pcb {
  std::string_view word;
  char letter;
};
constexpr std::string_view kFfp31 = "ffp31";
constexpr Pcb kPcbs[] = {{"ffp31a", 'A'}, {"ffp31c", 'C'}};

void read_option(PlantReader& reader, const toml::table& table, StationConfig& config) {
  std::string word = reader.text(table, "option", "", false);
  if (word.empty()) return;
  ProfibusUse& use = config.profibus;
  for (const Pcb& pcb : kPcbs)
    if (word == pcb.word) {
      use.fit.pcb = pcb.letter;
      word = kFfp31;
    }
  use.option_place = place_of(*table.get("option"));
  std::vector<std::string_view> words, units;
  for (const profibus::OptionType& option : profibus::option_types()) {
    if (option.kind == profibus::OptionKind::Gateway) continue;
    if (std::find(words.begin(), words.end(), option.word) == words.end()) words.push_back(option.word);
    if (option.word == word) units.push_back(option.unit);
    if (option.word == kFfp31)
      for (const Pcb& pcb : kPcbs) words.push_back(pcb.word);
  }
  if (units.empty())
    return reader.error(use.option_place,
                        fmt::format("'{}' is no option; known are {}", word, fmt::join(words, ", ")));
  if (config.unit == nullptr) return;
  use.option = profibus::find_option_type(word, config.unit->name);
  if (use.option == nullptr)
    reader.error(use.option_place, fmt::format("option '{}' is for unit {}, not for {}", word,
                                               fmt::join(units, " and "), config.unit->name));
  // The slot takes DFC11B, which makes SBus 2, or a fieldbus card (MDX60B/61B chapter 3.3).
  if (use.option != nullptr && !config.sbus2.empty())
    reader.error(use.option_place,
                 fmt::format("option '{}' and SBus 2 (option DFC11B) need the same slot of {}: there is one",
                             word, config.name));
}

std::optional<profibus::Octets> read_octets(PlantReader& reader, const toml::table& table,
                                            std::string_view key) {
  const std::string text = reader.text(table, key, "", false);
  if (text.empty()) return std::nullopt;
  auto octets = parse_bytes(text);
  if (!octets)
    reader.error(place_of(*table.get(key)),
                 fmt::format("'{}' are no octets; write for example \"F3 F2\"", text));
  return octets;
}

std::optional<profibus::Octets> read_process_words(PlantReader& reader, const toml::table& table) {
  const toml::node* node = table.get("po");
  if (node == nullptr) return std::nullopt;
  const toml::array* words = node->as_array();
  if (words == nullptr) return reader.error(place_of(*node), "po is a list of numbers"), std::nullopt;
  profibus::Octets octets;
  for (const toml::node& word : *words) {
    int32_t value = 0;
    if (!reader.number(word, "a process data word", value)) continue;
    if (value < INT16_MIN || value > UINT16_MAX)
      reader.error(place_of(word), "a process data word has 16 bits");
    octets.push_back(static_cast<uint8_t>(value >> 8));
    octets.push_back(static_cast<uint8_t>(value));
  }
  return octets;
}

// 10 ms x factor 1 x factor 2, each up to 255. False: no two such factors.
bool find_factors(Time watchdog, profibus::PrmData& prm) {
  constexpr Time kUnit = 10 * kMillisecond;
  const Time product = watchdog / kUnit;
  for (Time factor = 1; factor <= 255; ++factor)
    if (watchdog % kUnit == 0 && product % factor == 0 && product / factor <= 255) {
      prm.watchdog_factor_1 = static_cast<uint8_t>(product / factor);
      prm.watchdog_factor_2 = static_cast<uint8_t>(factor);
      return true;
    }
  return false;
}

class MasterReader {
 public:
  MasterReader(PlantReader& reader, ProfibusMasterConfig& config) : reader_(reader), config_(config) {}

  void read_slave(const toml::table& table) {
    reader_.known_keys(table, "[[control.slave]]",
                       {"address", "ident", "cfg", "watchdog", "sync", "freeze", "groups", "min_tsdr", "po",
                        "channel", "change"});
    profibus::SlavePlan plan;
    if (!table.contains("address")) reader_.error(place_of(table), "a [[control.slave]] needs address = ...");
    plan.address = number(table, "address", profibus::kLastStation, 0);
    plan.prm.lock = true;
    plan.prm.sync = reader_.flag(table, "sync").value_or(true);
    plan.prm.freeze = reader_.flag(table, "freeze").value_or(true);
    plan.prm.ident =
        static_cast<uint16_t>(reader_.count(table, "ident", UINT16_MAX, option_at(plan.address).ident));
    plan.prm.groups = number(table, "groups", 255, 0);
    plan.prm.min_tsdr = number(table, "min_tsdr", 255, profibus::kLeastMinTsdr);
    if (const Time watchdog = reader_.duration(table, "watchdog", 0); watchdog > 0) {
      plan.prm.watchdog = true;
      if (!find_factors(watchdog, plan.prm))
        reader_.error(place_of(*table.get("watchdog")),
                      "a watchdog time is 10ms times two factors of 1 to 255, for example 200ms");
    }
    plan.cfg = read_octets(reader_, table, "cfg").value_or(profibus::Octets{0xF2});
    const auto modules = profibus::decode_cfg(plan.cfg);
    if (!modules) reader_.error(place_of(table), "cfg ends within an identifier");
    size_t inputs = 0, outputs = 0;
    for (const profibus::CfgModule& module : modules.value_or(std::vector<profibus::CfgModule>{})) {
      inputs += module.input_octets();
      outputs += module.output_octets();
    }
    if (inputs > kMostOctets || outputs > kMostOctets)
      reader_.error(place_of(table), fmt::format("cfg asks for more than {} octets", kMostOctets));
    plan.inputs = static_cast<uint8_t>(std::min(inputs, kMostOctets));
    plan.outputs = static_cast<uint8_t>(std::min(outputs, kMostOctets));
    config_.slaves.push_back(plan);
    read_output(table, 0);
    reader_.for_each_table(table, "change", [&](const toml::table& change) {
      reader_.known_keys(change, "[[control.slave.change]]", {"at", "po", "channel"});
      read_output(change, reader_.duration(change, "at", "a [[control.slave.change]]", true));
    });
  }

  void read_command(const toml::table& table) {
    namespace global = profibus::global_control;
    struct Word {
      std::string_view word;
      ProfibusOrder::Kind kind;
      uint8_t command;
    };
    using Kind = ProfibusOrder::Kind;
    static constexpr Word kWords[] = {{"operate", Kind::Control, 0},
                                      {"clear", Kind::Control, global::kClear},
                                      {"sync", Kind::Control, global::kSync},
                                      {"unsync", Kind::Control, global::kUnsync},
                                      {"freeze", Kind::Control, global::kFreeze},
                                      {"unfreeze", Kind::Control, global::kUnfreeze},
                                      {"start", Kind::Start, 0},
                                      {"stop", Kind::Stop, 0},
                                      {"activate", Kind::Activate, 0},
                                      {"deactivate", Kind::Deactivate, 0}};
    constexpr std::string_view kWhat = "a [[control.command]]";
    reader_.known_keys(table, "[[control.command]]", {"at", "command", "groups", "address"});
    const std::string word = reader_.text(table, "command", kWhat, true);
    const Time at = reader_.duration(table, "at", kWhat, true);
    const uint8_t groups = number(table, "groups", 255, 0);
    const auto row = std::find_if(std::begin(kWords), std::end(kWords),
                                  [&](const Word& known) { return known.word == word; });
    const bool of_one = row != std::end(kWords) && row->kind >= Kind::Activate;
    if (table.contains("address") && row != std::end(kWords) && !of_one)
      return reader_.error(place_of(*table.get("address")), "only activate and deactivate are of one slave");
    const size_t slave = of_one ? read_slave_of(table, kWhat) : 0;
    if (row != std::end(kWords)) return config_.orders.push_back({at, row->kind, {row->command, groups}, slave});
    if (!word.empty())
      reader_.error(
          place_of(*table.get("command")),
          fmt::format("'{}' is no command of a master; known are operate, clear, sync, unsync, freeze, "
                      "unfreeze, start, stop, activate, deactivate",
                      word));
  }

 private:
  // The slave with this address, in the order of the file.
  size_t read_slave_of(const toml::table& table, std::string_view what) {
    if (!table.contains("address")) {
      reader_.error(place_of(table), fmt::format("{} needs address = ..., the slave", what));
      return 0;
    }
    const uint8_t address = number(table, "address", profibus::kLastStation, 0);
    for (size_t n = 0; n < config_.slaves.size(); ++n)
      if (config_.slaves[n].address == address) return n;
    reader_.error(place_of(*table.get("address")), fmt::format("the master has no slave {}", address));
    return 0;
  }

  static constexpr size_t kMostOctets = 244;  // of data with both access points

  uint8_t number(const toml::table& table, std::string_view key, uint32_t limit, uint32_t otherwise) {
    return static_cast<uint8_t>(reader_.count(table, key, limit, otherwise));
  }

  // Of the station that has the address; the master's configuration says the same where nothing else is written.
  const profibus::OptionType& option_at(uint8_t address) const {
    const auto is_it = [&](const ProfibusUse& use) {
      return use.bus.bus == config_.bus && use.address == address && use.option != nullptr;
    };
    for (const StationConfig& station : reader_.result.plant.stations)
      if (is_it(station.profibus)) return *station.profibus.option;
    for (const ControlConfig& control : reader_.result.plant.controls)
      if (const auto* gateway = control.as<GatewayConfig>(); gateway != nullptr && is_it(gateway->profibus))
        return *gateway->profibus.option;
    return profibus::option_type(profibus::OptionKind::Ffp31);
  }

  void read_output(const toml::table& table, Time at) {
    const size_t slave = config_.slaves.size() - 1;
    const size_t size = config_.slaves.back().outputs;
    const profibus::SlavePlan& plan = config_.slaves.back();
    const profibus::Configuration* known =
        profibus::find_configuration(plan.cfg, option_at(plan.address).accepts);
    const bool channel = known != nullptr && known->parameter_channel;
    if (const auto octets = read_octets(reader_, table, "channel")) {
      if (!channel || octets->size() != kChannelOctets)
        reader_.error(place_of(*table.get("channel")),
                      "channel are the 8 octets of the parameter channel, which cfg must have");
      else
        config_.outputs.push_back({at, slave, 0, *octets});
    }
    if (const auto words = read_process_words(reader_, table)) {
      const size_t first = channel ? kChannelOctets : 0;
      if (first + words->size() > size)
        reader_.error(place_of(*table.get("po")),
                      fmt::format("cfg has {} process data words", (size - first) / 2));
      else
        config_.outputs.push_back({at, slave, first, *words});
    }
  }

  PlantReader& reader_;
  ProfibusMasterConfig& config_;
};

// What the plate of the inverter says, and its label of service codes.
void read_fit(PlantReader& reader, const toml::table& table, const StationConfig& config, ProfibusFit& fit) {
  const toml::table* rating = reader.subtable(table, "unit_rating");
  if (rating == nullptr) return;
  const bool is_mc31 = config.unit == nullptr || config.unit->has(stdlib::Trait::OwnParameterNumbers);
  for (const std::string_view key : {"series", "size", "service_code"})
    if (const toml::node* node = rating->get(key); node != nullptr && !is_mc31)
      reader.error(place_of(*node), fmt::format("{} is on the plate of unit mc31, not of {}", key, config.unit->name));
  const std::string series = reader.text(*rating, "series", "", false);
  if (series == "B" || series == "C")
    fit.series = series[0];
  else if (!series.empty())
    reader.error(place_of(*rating->get("series")), fmt::format("unknown series '{}'; known are B, C", series), AllowedValues{{"\"B\"", "\"C\""}});
  constexpr uint32_t kLargestSize = 9, kLargestCode = 99;  // ours
  if (rating->contains("size")) fit.size = static_cast<uint8_t>(reader.count(*rating, "size", kLargestSize, 0));
  if (rating->contains("service_code"))
    fit.service_code = static_cast<uint8_t>(reader.count(*rating, "service_code", kLargestCode, 0));
}

}  // namespace

void read_profibus_card(PlantReader& reader, const toml::table& table, StationConfig& config) {
  read_option(reader, table, config);
  ProfibusUse& use = config.profibus;
  read_fit(reader, table, config, use.fit);
  use.bus = reader.bus_use(table, "profibus", BusKind::Profibus);
  use.address = static_cast<uint8_t>(
      reader.count(table, "profibus_address", profibus::kBroadcast, profibus::kNoAddressYet));
  if (use.bus.bus.empty()) {
    if (const toml::node* address = table.get("profibus_address"))
      reader.error(place_of(*address), "profibus_address needs profibus = \"...\"");
    return;
  }
  use.fms_switch = reader.flag(table, "fms_switch").value_or(false);
  if (table.contains("fms_switch") && use.option != nullptr && !use.option->fms)
    reader.error(place_of(*table.get("fms_switch")), fmt::format("{} has no FMS/DP switch", use.option->model));
  if (!table.contains("option"))
    reader.error(use.bus.place, "profibus needs option = \"...\", the card that is fitted");
  if (!table.contains("profibus_address"))
    reader.error(use.bus.place, "profibus needs profibus_address = ..., as its switches are set");
}

void read_profibus_master(PlantReader& reader, const toml::table& table, ControlConfig& control) {
  reader.known_keys(table, "[[control]]", {"name", "profibus", "address", "gap", "slave", "command"});
  ProfibusMasterConfig& config = control.kind.emplace<ProfibusMasterConfig>();
  config.bus = reader.bus_use(table, "profibus", BusKind::Profibus).bus;
  config.settings.address = static_cast<uint8_t>(reader.count(table, "address", profibus::kLastStation, 1));
  config.settings.gap_factor = reader.count(table, "gap", 1000, config.settings.gap_factor);
  MasterReader master(reader, config);
  reader.for_each_table(table, "slave", [&](const toml::table& slave) { master.read_slave(slave); });
  reader.for_each_table(table, "command", [&](const toml::table& command) { master.read_command(command); });
}

}  // namespace ipos::runtime
