// A row an action: which step it is, or why it is none.
#include "tools/serve/host/step_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/plant_file/signal.hpp"
#include "runtime/signals/find.hpp"
#include "stdlib/parameters.hpp"
#include "tools/serve/host/arguments.hpp"
#include "tools/serve/host/line_monitor.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::Plant;
using signals::Group;
using signals::Signal;

std::string station_row(const Arguments& a) { return toml_row("station", a.text("station")); }

// The value of a parameter in its words where they say it exactly, else as it is transferred.
std::string parameter_value(const stdlib::Parameter* row, int64_t value) {
  if (row != nullptr) {
    const std::string words = stdlib::parameter_text(*row, static_cast<int32_t>(value));
    const auto read = stdlib::parse_parameter_text(*row, words);
    if (read && *read == static_cast<int32_t>(value)) return toml_text(words);
  }
  return std::to_string(value);
}

std::string input(const Plant&, const Arguments& a) {
  const std::string action = a.text("action", "set");
  std::string rows = station_row(a) + toml_row("input", a.text("name"));
  if (action == "release") return rows + "release = true\n";
  rows += fmt::format("{} = {}\n", action == "set" ? "set" : "force", a.flag("on") ? 1 : 0);
  if (action == "pulse") rows += toml_row("for", fmt::format("{}ms", a.whole("ms", 1, 3'600'000, 100)));
  return rows;
}

std::string analog(const Plant&, const Arguments& a) {
  const std::string action = a.text("action", "set");
  const std::string rows = station_row(a) + toml_row("analog", a.text("name"));
  return rows + (action == "release" ? "release = true\n" : toml_row(action, a.text("value")));
}

std::string reset(const Plant&, const Arguments& a) { return station_row(a) + "reset = true\n"; }

std::string power(const Plant&, const Arguments& a) {
  return station_row(a) + toml_row("power", a.flag("on") ? "on" : "off");
}

std::string mains(const Plant&, const Arguments& a) {
  return station_row(a) + toml_row("mains", a.flag("on") ? "on" : "off");
}

std::string line_fault(const Plant& plant, const Arguments& a) {
  const std::string kind = a.text("kind");
  std::string keys = fmt::format("bus = {}, kind = {}", toml_text(a.text("bus")), toml_text(kind));
  if (a.has("station")) keys += fmt::format(", station = {}", toml_text(a.text("station")));
  if (a.has("identifier")) keys += fmt::format(", id = {}", a.whole("identifier", 0, UINT32_MAX));
  if (a.has("rate")) keys += fmt::format(", rate = {}", std::lround(a.number("rate", 0, 1) * 1000));
  // Of the page all are so late.
  const runtime::FaultConfig made = plant.find_bus(a.text("bus"))->make_fault({kind});
  if (!made.octets && made.fault.lag != 0) keys += fmt::format(", delay = \"{}ms\"", made.fault.lag / runtime::kMillisecond);
  return fmt::format("{} = {{ {} }}\n", a.flag("on") ? "fault" : "repair", keys);
}

std::string bytes_text(const Arguments& a) {
  return fmt::format("{:02X}", fmt::join(bytes_of(a.text("data", ""), SIZE_MAX), " "));
}

std::string frame_text(const Arguments& a) {
  std::string text = runtime::id_text(static_cast<uint32_t>(a.whole("identifier", 0, UINT32_MAX)), a.flag("extended", false));
  text += '#';
  if (a.flag("remote", false)) return text + 'R';
  for (const uint8_t byte : bytes_of(a.text("data", ""), SIZE_MAX)) text += fmt::format("{:02X}", byte);
  return text;
}

std::string bus_send(const Plant& plant, const Arguments& a) {
  const std::string bus = a.text("bus");
  const bool can = plant.find_bus(bus)->kind() == runtime::BusKind::Can;
  return toml_row("bus", bus) + toml_row("send", can ? frame_text(a) : bytes_text(a));
}

std::string parameters_set(const Plant& plant, const Arguments& a) {
  const auto index = static_cast<uint32_t>(a.whole("index", 0, UINT16_MAX));
  const auto& all = plant.stations();
  const auto station =
      std::find_if(all.begin(), all.end(), [&](const auto& one) { return one->config().name == a.text("station"); });
  const auto found = signals::signal_at(**station, Group::Parameter, index);
  if (!found) throw Mistake(fmt::format("index {} is no parameter that a step sets", index));
  return station_row(a) + toml_row("parameter", found->own_name()) +
         fmt::format("set = {}\n", parameter_value(found->parameter, a.whole("value", INT32_MIN, UINT32_MAX)));
}

std::string parameters_load(const Plant&, const Arguments&) {
  throw Mistake("a step sets one parameter, not those of a file; write them into [station.parameters] of the plant");
}

std::string load(const Plant&, const Arguments&) {
  throw Mistake("a test has the programs of the files, from its beginning on; restart the plant with the new one");
}

// A value by its name. `action`: set, force; release has no value.
std::string value_rows(const Signal& signal, std::string_view action, std::optional<int64_t> value) {
  std::string rows = toml_row("station", signal.station);
  std::string text = value ? std::to_string(*value) : "true";
  if (signal.is_variable()) {
    rows += toml_row("variable", signal.own_name());
  } else if (signal.group == Group::Parameter) {
    rows += toml_row("parameter", signal.own_name());
    if (value) text = parameter_value(signal.parameter, *value);
  } else if (signal.group == Group::ProcessData) {
    rows += toml_row("process_data", signal.own_name());
  } else if (signal.group == Group::Analog) {
    rows += toml_row("analog", signal.own_name());
    if (value) text = toml_text(signal.words(*value));
  } else if (signal.group == Group::Input) {
    rows += toml_row("input", signal.own_name());
  } else {
    throw Mistake(fmt::format("{} is nothing that a step sets", signal.name));
  }
  return rows + fmt::format("{} = {}\n", action, text);
}

Signal signal_named(const Plant& plant, const Arguments& a) {
  auto found = signals::find_signals(plant, a.text("name"));
  if (!found || found->size() != 1) throw Mistake(fmt::format("there is no {} any more", a.text("name")));
  return std::move(found->front());
}
std::string force(const Plant& plant, const Arguments& a) {
  return value_rows(signal_named(plant, a), "force", a.whole("value", INT32_MIN, UINT32_MAX));
}
std::string release(const Plant& plant, const Arguments& a) {
  return value_rows(signal_named(plant, a), "release", std::nullopt);
}

struct Words {
  std::string_view action;
  std::string (*rows)(const Plant& plant, const Arguments& details);
};
constexpr Words kWords[] = {
    {"input", input},         {"analog", analog},
    {"reset", reset},         {"power", power},
    {"fault", line_fault},    {"bus.send", bus_send},
    {"force", force},         {"release", release},
    {"parameters.set", parameters_set}, {"parameters.load", parameters_load},
    {"load", load},           {"mains", mains},
};

}  // namespace

std::string toml_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') out += '\\';
    if (byte < 0x20 || byte == 0x7F)
      out += fmt::format("\\u{:04X}", byte);
    else
      out += c;
  }
  return out + '"';
}

std::string toml_row(std::string_view key, std::string_view text) {
  return fmt::format("{} = {}\n", key, toml_text(text));
}

std::string step_text(const Plant& plant, const debug::Change& change) {
  if (change.action.is_null()) {
    const debug::ValuePlace place = debug::find_again(plant, change.place);
    return value_rows(*place.signal, "set", change.value);
  }
  const std::string name = change.action["act"];
  for (const Words& row : kWords)
    if (row.action == name) return row.rows(plant, Arguments(change.action));
  throw Mistake(fmt::format("no step does '{}'", name));
}

std::vector<std::string_view> actions_with_words() {
  std::vector<std::string_view> names;
  for (const Words& row : kWords) names.push_back(row.action);
  return names;
}

}  // namespace ipos::tools::serve
