// Reports of a run.
#include "tools/running/run_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/cli/json_text.hpp"
#include "tools/cli/xml_text.hpp"
#include "tools/running/watch.hpp"

namespace ipos::tools {

double load_percent(const runtime::LineLoad& load) {
  return load.elapsed_bits == 0
             ? 0.0
             : 100.0 * static_cast<double>(load.busy_bits) / static_cast<double>(load.elapsed_bits);
}

WatchChoice watch_choice(const std::string& flag) {
  WatchChoice watch;
  watch.on = !flag.empty();
  if (!watch.on || flag == "*") return watch;
  std::istringstream names(flag);
  for (std::string name; std::getline(names, name, ',');) watch.names.push_back(name);
  return watch;
}

void print_journal(const runtime::Plant& plant, bool why) {
  for (const auto& station : plant.stations())
    if (why && !station->config().options.own_motor)
      fmt::print(stderr, "{}: note: the motor is ideal: one of 1.5 kW that keeps every speed; [station.motor] and control = \"real\" describe another\n",
                 station->config().name);
  for (const runtime::JournalEntry& entry : plant.journal().entries()) {
    if (entry.weight == runtime::Weight::Why && !why) continue;
    const char* weight = entry.weight == runtime::Weight::Fault     ? "fault"
                         : entry.weight == runtime::Weight::Warning ? "warning"
                                                                    : "note";
    fmt::print(stderr, "{}{}{}: {} (at {:.3f} ms)\n", entry.station, entry.station.empty() ? "" : ": ",
               weight, entry.text, static_cast<double>(entry.time) / 1e6);
  }
}

std::string text_report(runtime::Plant& plant, const WatchChoice& watch) {
  std::string text;
  if (watch.on) {
    for (const auto& station : plant.stations()) {
      const std::vector<WatchRow> rows = watch_rows(*station, watch.names);
      // Names that were asked for may be those of other stations.
      if (rows.empty() && (station->image() == nullptr || !watch.names.empty())) continue;
      const std::string& program = station->config().program;
      text += fmt::format("{} ({}){}{}\n", station->config().name, station->config().unit->title,
                          program.empty() ? "" : ", ", program);
      text += watch_window(rows) + "\n";
    }
  }
  if (const std::vector<WatchRow> rows = watch_rows(plant, watch.names); !rows.empty())
    text += "gateways and lines\n" + watch_window(rows) + "\n";
  for (const auto& bus : plant.buses()) {
    const runtime::LineLoad load = bus->load(plant.now());
    text += fmt::format("{}: {} {}s in {:.3f} s, bus load {:.2f} % of {} baud\n", bus->name(), load.frames,
                        runtime::info(bus->kind()).message, static_cast<double>(plant.now()) / 1e9,
                        load_percent(load), bus->baud());
  }
  return utf8(text);
}

namespace {

nlohmann::ordered_json number_json(double value) {
  const auto whole = std::llround(value);
  if (static_cast<double>(whole) == value) return whole;
  return value;
}

nlohmann::ordered_json signal_json(const WatchRow& row) {
  return {{"name", row.name}, {"value", number_json(row.value)}, {"text", row.text}};
}

}  // namespace

std::string json_report(runtime::Plant& plant, const WatchChoice& watch) {
  using nlohmann::ordered_json;
  ordered_json report;
  report["time_us"] = plant.now() / runtime::kMicrosecond;
  report["stations"] = ordered_json::array();
  for (const auto& station : plant.stations()) {
    ordered_json entry;
    entry["name"] = station->config().name;
    entry["unit"] = station->config().unit->name;
    entry["fault"] = station->fault();
    entry["status_word_1"] = station->status_word_1();
    entry["variables"] = ordered_json::array();
    for (const WatchRow& row : watch_rows(*station, watch.names))
      if (row.index)
        entry["variables"].push_back({{"name", row.name}, {"index", *row.index}, {"value", number_json(row.value)}});
      else
        entry["signals"].push_back(signal_json(row));
    report["stations"].push_back(std::move(entry));
  }
  for (const WatchRow& row : watch_rows(plant, watch.names)) report["signals"].push_back(signal_json(row));
  report["buses"] = ordered_json::array();
  for (const auto& bus : plant.buses()) {
    const runtime::LineLoad load = bus->load(plant.now());
    report["buses"].push_back({{"name", bus->name()},
                               {"kind", runtime::info(bus->kind()).word},
                               {"frames", load.frames},
                               {"load_percent", load_percent(load)}});
  }
  return json_text(report) + "\n";
}

}  // namespace ipos::tools
