// The maps are those of compiler/analysis.
#include "tools/build/maps_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compiler/analysis/maps.hpp"

namespace ipos::tools {
namespace {

using compiler::ProgramMaps;
using Json = nlohmann::ordered_json;

Json or_null(const std::optional<int64_t>& value) { return value ? Json(*value) : Json(); }
std::string or_dash(const std::optional<int64_t>& value) { return value ? fmt::format("{}", *value) : "-"; }
std::vector<std::string> texts(const std::vector<compiler::Runner>& runners) {
  std::vector<std::string> all;
  for (const compiler::Runner& one : runners) all.push_back(one.text());
  return all;
}
std::string list(const std::vector<compiler::Runner>& runners) {
  return runners.empty() ? "-" : fmt::format("{}", fmt::join(texts(runners), ", "));
}

std::string where(const compiler::VariableMap& row) {
  return row.count == 1 ? fmt::format("H{}", row.variable) : fmt::format("H{}..{}", row.variable, row.variable + row.count - 1);
}

std::string text_of(const ProgramMaps& maps) {
  std::string out = "variables\n";
  size_t width = 8;
  for (const auto& row : maps.variables) width = std::max(width, row.name.size());
  for (const auto& row : maps.variables)
    out += fmt::format("  {:<10} {:<{}}  {:<4}  read by {}; written by {}\n", where(row), row.name, width, row.kept ? "kept" : "", list(row.read),
                       list(row.written));
  out += "calls\n";
  for (const auto& call : maps.calls) out += fmt::format("  {} {} {} (line {})\n", call.from, call.text(), call.to, call.line);
  out += "telegrams\n";
  for (const auto& telegram : maps.telegrams)
    out += fmt::format("  line {}: {}, object {}, cycle {} ms, offset {} ms, format {}, data from H{}\n", telegram.line, telegram.kind,
                       or_dash(telegram.object), or_dash(telegram.cycle_ms), or_dash(telegram.offset_ms), or_dash(telegram.format),
                       or_dash(telegram.data));
  out += "states\n";
  for (const auto& map : maps.states)
    for (const auto& way : map.ways)
      out += fmt::format("  {}: {} -> {} (line {})\n", map.name, way.from ? fmt::format("{}", *way.from) : "any", way.to, way.line);
  return out;
}

Json json_of(const std::string& station, const ProgramMaps& maps, Json all) {
  for (const auto& row : maps.variables)
    all["variables"].push_back({{"station", station}, {"name", row.name}, {"index", row.variable}, {"count", row.count}, {"kept", row.kept},
                                {"read", texts(row.read)}, {"written", texts(row.written)}});
  for (const auto& call : maps.calls)
    all["calls"].push_back({{"station", station}, {"from", call.from}, {"to", call.to}, {"line", call.line}, {"how", call.text()}});
  for (const auto& telegram : maps.telegrams)
    all["telegrams"].push_back({{"station", station}, {"line", telegram.line}, {"kind", telegram.kind}, {"object", or_null(telegram.object)},
                                {"cycle_ms", or_null(telegram.cycle_ms)}, {"offset_ms", or_null(telegram.offset_ms)},
                                {"format", or_null(telegram.format)}, {"data", or_null(telegram.data)}});
  for (const auto& map : maps.states) {
    Json ways = Json::array();
    for (const auto& way : map.ways) ways.push_back({{"from", or_null(way.from)}, {"to", way.to}, {"line", way.line}});
    all["states"].push_back({{"station", station}, {"name", map.name}, {"index", map.variable}, {"states", map.states}, {"ways", std::move(ways)}});
  }
  return all;
}

// A cluster for the calls and one for each variable that is a state.
std::string dot_of(const std::string& station, const ProgramMaps& maps, size_t number) {
  std::string out = fmt::format("  subgraph cluster_{}_calls {{\n    label=\"{}: calls\"\n", number, station);
  for (const auto& call : maps.calls)
    out += fmt::format("    \"{0}.{1}\" [label=\"{1}\"]\n    \"{0}.{2}\" [label=\"{2}\"]\n    \"{0}.{1}\" -> \"{0}.{2}\" [label=\"{3}\"{4}]\n", station,
                       call.from, call.to, call.how == compiler::CallMap::How::Calls ? "" : call.text(), call.how == compiler::CallMap::How::Calls ? "" : " style=dashed");
  out += "  }\n";
  for (const auto& map : maps.states) {
    out += fmt::format("  subgraph \"cluster_{}_{}\" {{\n    label=\"{}: {}\"\n", number, map.name, station, map.name);
    const auto node = [&](const std::string& state) { return fmt::format("\"{}.{}={}\"", station, map.name, state); };
    for (const int64_t state : map.states)
      out += fmt::format("    {} [label=\"{}\" shape=circle]\n", node(fmt::format("{}", state)), state);
    for (const auto& way : map.ways) {
      if (!way.from) out += fmt::format("    {} [label=\"any\" shape=plaintext]\n", node("any"));
      out += fmt::format("    {} -> {} [label=\"line {}\"]\n", node(way.from ? fmt::format("{}", *way.from) : "any"),
                         node(fmt::format("{}", way.to)), way.line);
    }
    out += "  }\n";
  }
  return out;
}

}  // namespace

std::string maps_report(const runtime::Plant& plant, std::string_view format) {
  std::string text;
  Json json{{"variables", Json::array()}, {"calls", Json::array()}, {"telegrams", Json::array()}, {"states", Json::array()}};
  size_t number = 0;
  for (const auto& station : plant.stations()) {
    if (station->image() == nullptr) continue;
    const std::string& name = station->config().name;
    const ProgramMaps maps = compiler::program_maps(*station->image(), station->config().unit->variables);
    if (format == "json")
      json = json_of(name, maps, std::move(json));
    else if (format == "dot")
      text += dot_of(name, maps, number++);
    else
      text += fmt::format("{}{} ({})\n{}", text.empty() ? "" : "\n", name, station->config().unit->title, text_of(maps));
  }
  if (format == "json") return json.dump(2) + "\n";
  return format == "dot" ? "digraph program {\n" + text + "}\n" : text;
}

}  // namespace ipos::tools
