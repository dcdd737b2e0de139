// Diagnostics as JSON lines and as SARIF 2.1.0.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compiler/diag/places.hpp"
#include "compiler/diag/render.hpp"

namespace ipos::compiler {
namespace {

using Json = nlohmann::ordered_json;

// All texts went through printable(), so dump() meets valid UTF-8 only.
void add_place(Json& json, Span span, const SourceMap& map) {
  const Range range = range_of(span, map);
  if (range.begin.file == nullptr) return;
  json["file"] = printable(range.begin.file->name);
  json["line"] = range.begin.line;
  json["column"] = range.begin.column;
  json["end_line"] = range.end.line;
  json["end_column"] = range.end.column;
}

// A file name as a relative or absolute URI reference.
std::string uri(std::string_view name) {
  std::string out;
  for (char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    if (plain)
      out += c;
    else
      out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

size_t character_column(const Position& at) {
  return characters(SourceMap::line_text(*at.file, at.line).substr(0, at.column - 1)) + 1;
}

Json location(Span span, const SourceMap& map) {
  Json json = Json::object();
  const Range range = range_of(span, map);
  if (range.begin.file == nullptr) return json;
  json["physicalLocation"] = {{"artifactLocation", {{"uri", uri(range.begin.file->name)}}},
                              {"region",
                               {{"startLine", range.begin.line},
                                {"startColumn", character_column(range.begin)},
                                {"endLine", range.end.line},
                                {"endColumn", character_column(range.end)}}}};
  return json;
}

Json sarif_result(const Diagnostic& diagnostic, const SourceMap& map, size_t rule) {
  Json result = {{"ruleId", info(diagnostic.diag).code},
                 {"ruleIndex", rule},
                 {"level", severity_word(diagnostic.severity)},
                 {"message", {{"text", printable(diagnostic.text)}}}};
  if (diagnostic.span.begin.valid()) result["locations"] = Json::array({location(diagnostic.span, map)});
  Json related = Json::array();
  for (const Note& note : all_notes(diagnostic, map)) {
    Json one = location(note.span, map);
    one["message"] = {{"text", printable(note.text)}};
    related.push_back(std::move(one));
  }
  if (!related.empty()) result["relatedLocations"] = std::move(related);
  return result;
}

}  // namespace

std::string render_json(std::span<const Diagnostic> diagnostics, const SourceMap& map) {
  std::string out;
  for (const Diagnostic& diagnostic : diagnostics) {
    const DiagInfo& row = info(diagnostic.diag);
    Json json = {{"severity", severity_word(diagnostic.severity)},
                 {"code", row.code},
                 {"message", printable(diagnostic.text)}};
    if (!row.flag.empty()) json["flag"] = row.flag;
    add_place(json, diagnostic.span, map);
    if (const Position at = map.position(diagnostic.span.begin); at.file != nullptr)
      json["source"] = printable(SourceMap::line_text(*at.file, at.line));
    json["notes"] = Json::array();
    for (const Note& note : all_notes(diagnostic, map)) {
      Json one = {{"message", printable(note.text)}};
      add_place(one, note.span, map);
      json["notes"].push_back(std::move(one));
    }
    out += json.dump() + '\n';
  }
  return out;
}

std::string render_sarif(std::span<const Diagnostic> diagnostics, const SourceMap& map) {
  std::vector<Diag> used;  // in the order of the table, so that the log is the same for the same messages
  for (const DiagInfo& row : diagnostic_table())
    if (std::any_of(diagnostics.begin(), diagnostics.end(),
                    [&row](const Diagnostic& d) { return d.diag == row.diag; }))
      used.push_back(row.diag);

  Json rules = Json::array();
  for (Diag diag : used) {
    const DiagInfo& row = info(diag);
    rules.push_back({{"id", row.code},
                     {"name", row.name},
                     {"shortDescription", {{"text", row.format}}},
                     {"defaultConfiguration", {{"level", severity_word(row.severity)}}}});
  }
  Json results = Json::array();
  for (const Diagnostic& diagnostic : diagnostics) {
    const auto rule = std::find(used.begin(), used.end(), diagnostic.diag) - used.begin();
    results.push_back(sarif_result(diagnostic, map, static_cast<size_t>(rule)));
  }
  const Json log = {{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
                    {"version", "2.1.0"},
                    {"runs", Json::array({{{"tool", {{"driver", {{"name", "ipos"}, {"rules", rules}}}}},
                                           {"columnKind", "unicodeCodePoints"},
                                           {"results", results}}})}};
  return log.dump(2) + '\n';
}

}  // namespace ipos::compiler
