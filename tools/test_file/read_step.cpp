// [[step]] of a test file: one thing that is done to the plant.
#include <algorithm>

#include "tools/test_file/item_reader.hpp"

namespace ipos::tools::testing {
namespace {

constexpr std::string_view kStep = "a [[step]]";

// What a step does, by the key that says so, and the keys it takes beside those of every step.
struct Action {
  std::string_view key;
  std::vector<std::string_view> keys;
  std::optional<Step> (*read)(PlantReader& reader, const toml::table& table);
};

std::optional<Step> read_signal(PlantReader& reader, const toml::table& table) {
  runtime::Stimulus stimulus;
  stimulus.place = place_of(table);
  stimulus.signal.station = read_item_station(reader, table, kStep);
  if (!runtime::read_stimulus(reader, table, kStep, stimulus)) return std::nullopt;
  return stimulus;
}

std::optional<Step> read_process_data(PlantReader& reader, const toml::table& table) {
  using Act = ProcessDataStep::Action;
  ProcessDataStep step;
  step.station = read_item_station(reader, table, kStep);
  const auto word = read_word(reader, *table.get("process_data"), false);
  if (!word) return std::nullopt;
  step.word = *word;
  int actions = 0;
  for (const auto& [key, action] :
       {std::pair{"set", Act::Set}, {"force", Act::Force}, {"release", Act::Release}}) {
    const toml::node* node = table.get(key);
    if (node == nullptr) continue;
    ++actions;
    step.action = action;
    int32_t value = 0;
    if (action == Act::Release || !reader.number(*node, key, value)) continue;
    if (value < INT16_MIN || value > UINT16_MAX)
      reader.error(place_of(*node), fmt::format("{} does not fit into a word", value));
    step.value = static_cast<uint16_t>(value);
  }
  if (actions != 1) {
    reader.error(place_of(table), "process_data needs one of set, force, release");
    return std::nullopt;
  }
  return step;
}

std::optional<Step> read_send(PlantReader& reader, const toml::table& table) {
  const runtime::BusConfig* bus = read_item_bus(reader, table, kStep);
  const std::string text = reader.text(table, "send", kStep, true);
  if (bus == nullptr || text.empty()) return std::nullopt;
  if (const auto why = runtime::refuse_message(bus->kind, text)) {
    reader.error(place_of(*table.get("send")), *why);
    return std::nullopt;
  }
  return SendStep{bus->name, text};
}

std::optional<Step> read_awaited(PlantReader& reader, const toml::table& table) {
  auto expect = read_await(reader, table);
  if (!expect) return std::nullopt;
  return AwaitStep{std::move(*expect)};
}

// A fault as a table in the step, with the keys of a [[fault]].
std::optional<runtime::FaultConfig> read_planted(PlantReader& reader, const toml::table& table, std::string_view key) {
  const toml::node& node = *table.get(key);
  if (!node.is_table()) {
    reader.error(place_of(node),
                 fmt::format("write {} = {{ bus = \"...\", kind = \"...\" }}, with the keys of a [[fault]]", key));
    return std::nullopt;
  }
  auto& faults = reader.result.plant.faults;
  const size_t before = faults.size();
  runtime::read_fault(reader, *node.as_table());
  if (faults.size() == before) return std::nullopt;
  runtime::FaultConfig fault = std::move(faults.back());
  faults.pop_back();
  return fault;
}

// Times of the fault count from the step on.
std::optional<Step> read_line_fault(PlantReader& reader, const toml::table& table) {
  auto fault = read_planted(reader, table, "fault");
  if (!fault) return std::nullopt;
  return *std::move(fault);
}

std::optional<Step> read_repair(PlantReader& reader, const toml::table& table) {
  auto fault = read_planted(reader, table, "repair");
  if (!fault) return std::nullopt;
  return RepairStep{*std::move(fault)};
}

std::optional<Step> read_drive_fault(PlantReader& reader, const toml::table& table) {
  return DriveFaultStep{read_item_station(reader, table, kStep),
                        static_cast<uint8_t>(reader.count(table, "drive_fault", UINT8_MAX, 0))};
}

std::optional<Step> read_reset(PlantReader& reader, const toml::table& table) {
  if (!reader.flag(table, "reset").value_or(false))
    reader.error(place_of(*table.get("reset")), "write reset = true");
  return ResetStep{read_item_station(reader, table, kStep)};
}

// The value of a key that takes one of a few words: its place among them, or nothing with an error.
std::optional<size_t> read_choice(PlantReader& reader, const toml::table& table, std::string_view key,
                                  const std::vector<std::string_view>& words) {
  const std::string text = reader.text(table, key, kStep, true);
  const auto found = std::find(words.begin(), words.end(), text);
  if (found != words.end()) return static_cast<size_t>(found - words.begin());
  reader.error(place_of(*table.get(key)), fmt::format("{} is one of {}", key, fmt::join(words, ", ")));
  return std::nullopt;
}

std::optional<Step> read_program(PlantReader& reader, const toml::table& table) {
  const std::string station = read_item_station(reader, table, kStep);
  const auto choice = read_choice(reader, table, "program", {"start", "stop", "restart"});
  if (!choice) return std::nullopt;
  return ProgramStep{station, static_cast<runtime::ProgramOrder>(*choice)};
}

std::optional<Step> read_power(PlantReader& reader, const toml::table& table) {
  const std::string station = read_item_station(reader, table, kStep, true);
  const auto choice = read_choice(reader, table, "power", {"off", "on"});
  if (!choice) return std::nullopt;
  return PowerStep{station, *choice == 1};
}

std::optional<Step> read_wait(PlantReader&, const toml::table&) { return Wait{}; }

const std::vector<Action> kActions = {
    {"wait", {}, read_wait},
    {"until", {}, read_wait},
    {"variable", {"station", "set", "force", "pulse", "release", "for", "every", "times"}, read_signal},
    {"parameter", {"station", "set", "force", "pulse", "release", "for", "every", "times"}, read_signal},
    {"input", {"station", "set", "force", "pulse", "release", "for", "every", "times"}, read_signal},
    {"analog", {"station", "set", "force", "pulse", "release", "for", "every", "times"}, read_signal},
    {"switch", {"station", "set"}, read_signal},
    {"signal", {"station", "set", "force", "pulse", "release", "for", "every", "times"}, read_signal},
    {"mains", {"station"}, read_signal},
    {"process_data", {"station", "set", "force", "release"}, read_process_data},
    {"send", {"bus"}, read_send},
    {"await", {"bus", "within"}, read_awaited},
    {"fault", {}, read_line_fault},
    {"repair", {}, read_repair},
    {"drive_fault", {"station"}, read_drive_fault},
    {"reset", {"station"}, read_reset},
    {"program", {"station"}, read_program},
    {"power", {"station"}, read_power},
};

}  // namespace

std::optional<Step> read_step(PlantReader& reader, const toml::table& table) {
  const Action* found = nullptr;
  std::vector<std::string_view> names;
  for (const Action& action : kActions) {
    names.push_back(action.key);
    if (!table.contains(action.key)) continue;
    if (found != nullptr) {
      reader.error(place_of(*table.get(action.key)),
                   fmt::format("{} does one thing: {} or {}", kStep, found->key, action.key));
      return std::nullopt;
    }
    found = &action;
  }
  if (found == nullptr) {
    reader.error(place_of(table), fmt::format("{} needs one of {}", kStep, fmt::join(names, ", ")));
    return std::nullopt;
  }
  std::vector<std::string_view> keys = {IPOS_ITEM_KEYS, found->key};
  keys.insert(keys.end(), found->keys.begin(), found->keys.end());
  reader.known_keys(table, fmt::format("a [[step]] with {}", found->key), keys);
  return found->read(reader, table);
}

}  // namespace ipos::tools::testing
