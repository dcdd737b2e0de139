// A document is looked at line by line for the cursor; everything else is the readers' business.
#include "tools/lsp/plant_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "runtime/plant/all_mistakes.hpp"
#include "runtime/plant/plant.hpp"
#include "runtime/plant_file/toml_kind.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/unit_names.hpp"
#include "tools/cli/files.hpp"
#include "tools/lsp/features.hpp"
#include "tools/lsp/plant_names.hpp"
#include "tools/lsp/toml_lines.hpp"
#include "tools/test_file/read_tests.hpp"

namespace ipos::tools::lsp {
namespace {

using runtime::PlantError;

constexpr std::string_view kBlanks = " \t\r";
constexpr std::string_view kProbe = "ipos_probe";  // a key and a value that no reader knows

// What the units say about their parameters: a plant without programs, and without what needs their variables.
std::vector<PlantError> refused_parameters(runtime::PlantFile plant) {
  for (runtime::StationConfig& station : plant.stations) {
    station.program.clear();
    station.nvram.clear();
  }
  plant.expectations.clear();
  plant.stimuli.clear();
  std::vector<PlantError> errors;
  std::vector<std::optional<vm::Image>> programs(plant.stations.size());
  const runtime::Plant made(std::move(plant), std::move(programs), std::nullopt, errors);
  return errors;
}

std::vector<PlantError> errors_of(const std::string& path, const std::string& text) {
  if (runtime::named_test(path)) {
    std::vector<PlantError> errors;
    for (const testing::TestCase& test : testing::read_test_file(path, text))
      if (test.errors_in.empty())
        for (const PlantError& error : test.errors) errors.push_back(error);
    return errors;
  }
  runtime::PlantFileResult result = runtime::read_plant_file(text, path);
  if (result.errors.empty()) return refused_parameters(std::move(result.plant));
  std::vector<std::optional<vm::Image>> programs(result.plant.stations.size());
  return runtime::all_mistakes(result.plant, std::move(programs), std::move(result.errors));
}

// Where the cursor stands: in which table, at a key or after '='.
struct Spot {
  std::shared_ptr<const std::string> source;
  std::string_view text;                // of source
  std::vector<std::string_view> lines;  // of text
  size_t line = 0;                      // from 0
  size_t column = 0;
  std::string_view table;  // "station.parameters"; empty at the top
  std::string_view key;    // before '='
  bool at_value = false;

  std::string_view row() const { return lines[line]; }
};

std::optional<Spot> spot_of(const Workspace& workspace, const Json& params) {
  auto text = workspace.text(document_path(params));
  const auto position = params.find("position");
  if (!text || position == params.end()) return std::nullopt;
  Spot spot;
  spot.source = std::make_shared<const std::string>(std::move(*text));
  spot.text = *spot.source;
  spot.lines = lines_of(spot.text);
  const uint32_t offset = offset_of(spot.text, *position, workspace.encoding);
  const std::string_view before = spot.text.substr(0, offset);
  spot.line = static_cast<size_t>(std::count(before.begin(), before.end(), '\n'));
  spot.column = offset - (before.rfind('\n') + 1);
  for (size_t n = 0; n <= spot.line; ++n)
    if (const std::string_view table = table_of(spot.lines[n]); !table.empty()) spot.table = table;
  spot.key = key_of(spot.row());
  spot.at_value = !spot.key.empty() && spot.column > spot.row().find('=');
  return spot;
}

// Of the station whose table the cursor is in, or that the table names.
const stdlib::UnitType* unit_at(const Spot& spot) {
  std::string wanted, name;
  size_t first = spot.line;
  while (first > 0 && table_of(spot.lines[first]).empty()) --first;
  for (size_t n = first; n < spot.lines.size() && (n == first || table_of(spot.lines[n]).empty()); ++n)
    if (key_of(spot.lines[n]) == "station") wanted = value_of(spot.lines[n]);
  const stdlib::UnitType* unit = nullptr;
  bool in_station = false;
  for (size_t n = 0; n < spot.lines.size(); ++n) {
    const std::string_view table = table_of(spot.lines[n]);
    if (!table.empty()) {
      if (table == "station" && wanted.empty() && n > spot.line) break;
      in_station = table == "station";
      if (in_station) name.clear();
    }
    const std::string_view key = key_of(spot.lines[n]);
    if (in_station && key == "name") name = value_of(spot.lines[n]);
    if (in_station && key == "unit" && (wanted.empty() || name == wanted || name.empty()))
      unit = stdlib::find_unit_or_plate(value_of(spot.lines[n]));
    if (!wanted.empty() && unit != nullptr && name == wanted) break;
  }
  return unit;
}

// Still being written: one such row would hide all others from the reader.
bool is_unfinished(std::string_view row) {
  row = trimmed(row.substr(0, row.find('#')));
  return row.ends_with('=') || (row.starts_with('[') && table_of(row).empty()) ||
         (!row.empty() && row.find_first_of("=[]{}\"'") == std::string_view::npos);
}

// The text with another row in place of that of the cursor.
std::string with_row(const Spot& spot, const std::string& row) {
  std::string text;
  for (size_t n = 0; n < spot.lines.size(); ++n) {
    if (n == spot.line)
      text += row;
    else if (!is_unfinished(spot.lines[n]))
      text += spot.lines[n];
    if (n + 1 < spot.lines.size()) text += '\n';
  }
  return text;
}

// "...; known are a, b, c": what the reader would take there.
std::vector<std::string> known_at(const std::string& path, const Spot& spot, const std::string& row) {
  constexpr std::string_view kKnown = "known are ";
  std::vector<std::string> known;
  for (const PlantError& error : errors_of(path, with_row(spot, row))) {
    const size_t at = error.text.find(kKnown);
    if (error.place.line != spot.line + 1 || at == std::string::npos ||
        error.text.find(kProbe) == std::string::npos)
      continue;
    std::string_view list = std::string_view(error.text).substr(at + kKnown.size());
    while (!list.empty()) {
      const size_t comma = std::min(list.find(", "), list.size());
      known.emplace_back(list.substr(0, comma));
      list.remove_prefix(std::min(comma + 2, list.size()));
    }
    break;
  }
  return known;
}

// What the reader takes after the key: it is shown a number that no key has.
std::optional<runtime::AllowedValues> allowed_at(const std::string& path, const Spot& spot) {
  for (const PlantError& error : errors_of(path, with_row(spot, fmt::format("{} = {}", spot.key, INT32_MIN))))
    if (error.place.line == spot.line + 1 && error.allowed) return error.allowed;
  return std::nullopt;
}

void offer(Json& items, const std::string& label, int kind, const std::string& detail = {},
           const std::string& documentation = {}) {
  Json item{{"label", label}, {"kind", kind}};
  if (!detail.empty()) item["detail"] = detail;
  if (!documentation.empty()) item["documentation"] = {{"kind", "markdown"}, {"value", documentation}};
  items.push_back(std::move(item));
}

// Of a range both ends, each with the range beside it.
void offer_allowed(Json& items, const runtime::AllowedValues& allowed) {
  for (const std::string& value : allowed.each) offer(items, value, kValue);
  if (!allowed.each.empty()) return;
  const std::string range =
      fmt::format("{} to {}{}{}", allowed.least, allowed.most, allowed.unit.empty() ? "" : " ", allowed.unit);
  for (const int64_t end : {allowed.least, allowed.most}) offer(items, fmt::format("{}", end), kValue, range);
}

// "Ramp t11 UP CW: 0.000 s..2000.000 s, factory setting 2.000 s". A long list of texts is in the description alone.
std::string parameter_summary(const stdlib::Parameter& row) {
  constexpr size_t kTextsShown = 4;
  std::string text(row.name);
  if (row.texts.size() > kTextsShown)
    text += fmt::format(": one of {}", row.texts.size());
  else if (const std::string range = stdlib::parameter_range(row); !range.empty())
    text += ": " + range;
  if (row.writable)
    text += fmt::format(", factory setting {}",
                        stdlib::parameter_text(row, static_cast<int32_t>(row.default_value)));
  return text;
}

// Names of buses and stations of the file, for keys that name one.
void offer_names(Json& items, const Spot& spot) {
  const bool bus = spot.key.starts_with("sbus") || spot.key.starts_with("rs485") || spot.key == "bus" ||
                   spot.key == "profibus";
  const bool station = spot.key == "station" || spot.key == "behind";
  if (!bus && !station) return;
  std::string_view table;
  for (const std::string_view row : spot.lines) {
    if (const std::string_view begins = table_of(row); !begins.empty()) table = begins;
    if (key_of(row) != "name" || (bus ? table != "bus" : table != "station" && table != "control")) continue;
    const size_t quote = row.find('"');
    if (quote != std::string_view::npos)
      offer(items, std::string(row.substr(quote, row.find('"', quote + 1) - quote + 1)), kValue);
  }
}

void offer_parameters(Json& items, const Spot& spot) {
  const stdlib::UnitType* unit = unit_at(spot);
  if (unit == nullptr) return;
  for (const stdlib::Parameter& row : stdlib::parameter_table(*unit).rows())
    if (row.index != 0 && !row.number.empty() && (row.writable || spot.at_value))
      offer(items, spot.at_value ? fmt::format("\"P{}\"", row.number) : fmt::format("P{}", row.number),
            kField, parameter_summary(row), describe_parameter(row));
}

void offer_parameter_values(Json& items, const Spot& spot) {
  const stdlib::UnitType* unit = unit_at(spot);
  const stdlib::Parameter* row = unit == nullptr ? nullptr : stdlib::parameter_table(*unit).find(spot.key);
  if (row == nullptr) return;
  const std::string documentation = describe_parameter(*row);
  for (const stdlib::ValueText& text : row->texts)
    offer(items, fmt::format("\"{}\"", text.text), kValue,
          fmt::format("{}{}", text.value, text.value == row->default_value ? ", factory setting" : ""),
          documentation);
  if (!row->texts.empty()) return;
  const std::string range = stdlib::parameter_range(*row);
  std::vector<std::string> offered;
  const auto add = [&](int64_t value, const char* what) {
    std::string text = stdlib::parameter_text(*row, static_cast<int32_t>(static_cast<uint32_t>(value)));
    if (std::find(offered.begin(), offered.end(), text) != offered.end()) return;
    offer(items, fmt::format("\"{}\"", text), kValue,
          range.empty() ? std::string(what) : fmt::format("{}; {}", what, range), documentation);
    offered.push_back(std::move(text));
  };
  add(row->default_value, "factory setting");
  if (row->ranges.empty()) return;
  add(row->minimum(), "smallest");
  add(row->maximum(), "largest");
}

// Letters and digits around the cursor.
std::pair<size_t, size_t> word_at(const Spot& spot) {
  const std::string_view row = spot.row();
  size_t begin = std::min(spot.column, row.size()), end = begin;
  while (begin > 0 && is_word(row[begin - 1])) --begin;
  while (end < row.size() && is_word(row[end])) ++end;
  return {begin, end};
}

Json range_in(const Spot& spot, size_t begin, size_t end, Encoding encoding) {
  const auto start = static_cast<size_t>(spot.row().data() - spot.text.data());
  return range_of(spot.text, static_cast<uint32_t>(start + begin), static_cast<uint32_t>(start + end),
                  encoding);
}

}  // namespace

bool is_plant_document(const Workspace& workspace, const std::string& path) {
  if (!path.ends_with(".toml") || runtime::named_campaign(path)) return false;  // the campaign's own verb reads it
  if (runtime::named_test(path)) return true;
  const auto text = workspace.text(path);
  if (!text) return false;
  const auto lines = lines_of(*text);
  return std::any_of(lines.begin(), lines.end(), [](std::string_view row) {
    const std::string_view table = table_of(row);
    return table == "station" || table == "bus";
  });
}

Json plant_diagnostics(const Workspace& workspace, const std::string& path) {
  Json out = Json::array();
  const auto text = workspace.text(path);
  if (!text) return out;
  const auto lines = lines_of(*text);
  for (const PlantError& error : errors_of(path, *text)) {
    const size_t line = std::clamp<size_t>(error.place.line, 1, lines.size()) - 1;
    const std::string_view row = lines[line].substr(0, lines[line].find_last_not_of(kBlanks) + 1);
    const size_t column = std::min<size_t>(error.place.column == 0 ? 0 : error.place.column - 1, row.size());
    const auto start = static_cast<size_t>(row.data() - text->data());
    out.push_back({{"range", range_of(*text, static_cast<uint32_t>(start + column),
                                      static_cast<uint32_t>(start + row.size()), workspace.encoding)},
                   {"severity", 1},
                   {"source", "ipos"},
                   {"message", error.text}});
  }
  return out;
}

Json plant_hover(Workspace& workspace, const Json& params) {
  const auto spot = spot_of(workspace, params);
  if (!spot) return nullptr;
  const auto [begin, end] = word_at(*spot);
  const std::string_view word = spot->row().substr(begin, end - begin);
  const stdlib::UnitType* unit = unit_at(*spot);
  if (unit == nullptr || word.empty()) return nullptr;
  const bool number = word.find_first_not_of("0123456789", 1) == std::string_view::npos;
  if (!number || (word[0] != 'P' && !(spot->table.ends_with("parameters") && !spot->at_value)))
    return nullptr;
  const stdlib::Parameter* row = stdlib::parameter_table(*unit).find(word);
  if (row == nullptr) return nullptr;
  return {{"contents", {{"kind", "markdown"}, {"value", describe_parameter(*row)}}},
          {"range", range_in(*spot, begin, end, workspace.encoding)}};
}

Json plant_completion(Workspace& workspace, const Json& params) {
  Json items = Json::array();
  const auto spot = spot_of(workspace, params);
  if (!spot) return items;
  const std::string path = document_path(params);
  const std::string_view row = trimmed(spot->row());
  if (row.starts_with('[')) {
    for (const std::string& known : known_at(path, *spot, fmt::format("[[{}]]", kProbe)))
      offer(items, known, kKeyword);
  } else if (spot->table.ends_with(".parameters") && spot->at_value) {
    offer_parameter_values(items, *spot);
  } else if (spot->table.ends_with(".parameters") || (spot->at_value && spot->key == "parameter")) {
    offer_parameters(items, *spot);
  } else if (spot->table.ends_with(".inputs") && !spot->at_value) {
    for (const runtime::BinaryTerminal& terminal : runtime::binary_inputs()) offer(items, std::string(terminal.name), kField);
  } else if (spot->at_value) {
    offer_names(items, *spot);
    for (const std::string& known : known_at(path, *spot, fmt::format("{} = \"{}\"", spot->key, kProbe)))
      offer(items, fmt::format("\"{}\"", known), kValue);
    if (const auto allowed = allowed_at(path, *spot)) offer_allowed(items, *allowed);
    if (spot->key == "program" || spot->key == "plant")
      for (const std::string& file : list_files(std::filesystem::path(path).parent_path().string()))
        if (spot->key == "program" ? is_program(file) : file.ends_with(".toml") && !runtime::named_test(file) && !runtime::named_campaign(file))
          offer(items, fmt::format("\"{}\"", file), kFile);
  } else {
    for (const std::string& known : known_at(path, *spot, fmt::format("{} = 0", kProbe)))
      offer(items, known, kField);
  }
  return items;
}

Json plant_definition(Workspace& workspace, const Json& params) {
  if (Json declared = plant_variable(workspace, params); !declared.is_null()) return declared;
  const auto spot = spot_of(workspace, params);
  if (!spot || (spot->key != "program" && spot->key != "plant" && spot->key != "source")) return nullptr;
  const size_t quote = spot->row().find('"');
  if (quote == std::string_view::npos) return nullptr;
  const std::string name(spot->row().substr(quote + 1, spot->row().find('"', quote + 1) - quote - 1));
  const Json begin{{"line", 0}, {"character", 0}};
  return {{"uri", uri_of(beside(document_path(params), name))},
          {"range", {{"start", begin}, {"end", begin}}}};
}

Json plant_symbols(Workspace& workspace, const Json& params) {
  Json out = Json::array();
  const auto text = workspace.text(document_path(params));
  if (!text) return out;
  constexpr int kObject = 19;  // SymbolKind
  const auto lines = lines_of(*text);
  for (size_t n = 0; n < lines.size(); ++n) {
    const std::string_view table = table_of(lines[n]);
    if (table.empty()) continue;
    size_t last = n;
    std::string name(table);
    while (last + 1 < lines.size() && table_of(lines[last + 1]).empty()) {
      ++last;
      if (key_of(lines[last]) == "name")
        name += " " + std::string(trimmed(lines[last].substr(lines[last].find('=') + 1)));
    }
    const auto at = [&](std::string_view row) { return static_cast<uint32_t>(row.data() - text->data()); };
    const auto end = [&](std::string_view row) { return static_cast<uint32_t>(at(row) + row.size()); };
    out.push_back({{"name", name},
                   {"kind", kObject},
                   {"range", range_of(*text, at(lines[n]), end(lines[last]), workspace.encoding)},
                   {"selectionRange", range_of(*text, at(lines[n]), end(lines[n]), workspace.encoding)}});
  }
  return out;
}

}  // namespace ipos::tools::lsp
