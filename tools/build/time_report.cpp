// The figures are those of compiler/timing with the rates that the tasks of each station have.
#include "tools/build/time_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compiler/analysis/timing.hpp"

namespace ipos::tools {
namespace {

using compiler::FunctionTiming;
using Json = nlohmann::ordered_json;

std::array<uint32_t, 3> rates_of(const runtime::Station& station, std::optional<uint32_t> speed) {
  if (speed) return {*speed, *speed, *speed};
  return station.drive().rates().commands;
}

std::vector<FunctionTiming> timings_of(const runtime::Station& station, std::optional<uint32_t> speed) {
  return compiler::function_timings(*station.image(), station.config().unit->variables, rates_of(station, speed));
}

const char* text_of(FunctionTiming::Kind kind) {
  switch (kind) {
    case FunctionTiming::Kind::Call: return "call";
    case FunctionTiming::Kind::Turn: return "turn";
    case FunctionTiming::Kind::Interrupt: return "interrupt";
  }
  return "";
}

std::string number(const std::optional<uint64_t>& value) { return value ? fmt::format("{}", *value) : "-"; }

Json number_or_null(const std::optional<uint64_t>& value) { return value ? Json(*value) : Json(); }

std::string lines_text(const std::vector<uint32_t>& lines) {
  std::string text;
  for (size_t n = 0; n < lines.size();) {
    size_t last = n;
    while (last + 1 < lines.size() && lines[last + 1] == lines[last] + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ",", lines[n]);
    if (last != n) text += fmt::format("-{}", lines[last]);
    n = last + 1;
  }
  return text;
}

}  // namespace

std::string time_table(const runtime::Plant& plant, std::optional<uint32_t> speed) {
  std::string out;
  for (const auto& station : plant.stations()) {
    if (station->image() == nullptr) continue;
    const auto rates = rates_of(*station, speed);
    out += fmt::format("{}{} ({}): {}, {} and {} commands/ms for tasks 1, 2 and 3\n", out.empty() ? "" : "\n", station->config().name,
                       station->config().unit->title, rates[0], rates[1], rates[2]);
    const std::vector<FunctionTiming> all = timings_of(*station, speed);
    size_t width = 8;
    for (const FunctionTiming& row : all) width = std::max(width, row.name.size());
    out += fmt::format("{:<{}}  {:>5}  {:>4}  {:<9}  {:>9}  {:>9}  {}\n", "function", width, "line", "task", "one", "commands", "ms", "");
    for (const FunctionTiming& row : all) {
      out += fmt::format("{:<{}}  {:>5}  {:>4}  {:<9}  {:>9}  {:>9}", row.name, width, row.line, row.task, text_of(row.kind),
                         number(row.commands), number(row.ms));
      if (!row.because.empty()) out += "  " + row.because;
      out += "\n";
      if (row.commands && !row.longest.empty()) out += fmt::format("{:{}}  longest way: lines {}\n", "", width, lines_text(row.longest));
      for (const compiler::LoopTiming& loop : row.loops)
        out += fmt::format("{:{}}  loop at line {}: a turn {} commands, {}\n", "", width, loop.line, number(loop.commands),
                           loop.turns ? fmt::format("at most {} turns", *loop.turns) : "no known end");
    }
  }
  return out;
}

std::string time_json(const runtime::Plant& plant, std::optional<uint32_t> speed) {
  Json functions = Json::array();
  for (const auto& station : plant.stations()) {
    if (station->image() == nullptr) continue;
    for (const FunctionTiming& row : timings_of(*station, speed)) {
      Json loops = Json::array();
      for (const compiler::LoopTiming& loop : row.loops)
        loops.push_back({{"line", loop.line}, {"turns", number_or_null(loop.turns)}, {"commands", number_or_null(loop.commands)}});
      functions.push_back({{"station", station->config().name},
                           {"name", row.name},
                           {"line", row.line},
                           {"task", row.task},
                           {"one", text_of(row.kind)},
                           {"commands", number_or_null(row.commands)},
                           {"ms", number_or_null(row.ms)},
                           {"because", row.because},
                           {"longest", row.longest},
                           {"loops", std::move(loops)}});
    }
  }
  return Json{{"functions", std::move(functions)}}.dump(2) + "\n";
}

}  // namespace ipos::tools
