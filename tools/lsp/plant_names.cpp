// A station has its program from the plant, a test its stations from the plant it names.
#include "tools/lsp/plant_names.hpp"

#include <algorithm>

#include "runtime/plant_file/toml_kind.hpp"
#include "tools/cli/files.hpp"
#include "tools/lsp/plant_document.hpp"
#include "tools/lsp/toml_lines.hpp"

namespace ipos::tools::lsp {
namespace {

using compiler::IndexedSymbol;
using compiler::SymbolKind;

// Keys whose text names a variable, or may do so, and those that name a station.
bool names_variable(std::string_view key) { return key == "variable" || key == "signal" || key == "hex"; }
bool names_station(std::string_view key) { return key == "station" || key == "behind"; }

// A file, cut into its tables.
struct TomlDocument {
  std::string path;
  std::string text;
  std::vector<std::string_view> lines;
  std::vector<TomlTable> tables;

  std::string_view find(const TomlTable& table, std::string_view key) const {
    for (size_t n = table.first; n < table.end; ++n)
      if (key_of(lines[n]) == key) return value_of(lines[n]);
    return {};
  }
};

// Its lines point into its text, so it stays where it is made.
std::unique_ptr<const TomlDocument> read_toml(const Workspace& workspace, const std::string& path) {
  auto text = workspace.text(path);
  if (!text) return nullptr;
  auto document = std::make_unique<TomlDocument>();
  document->path = path;
  document->text = std::move(*text);
  document->lines = lines_of(document->text);
  document->tables = tables_of(document->lines);
  return document;
}

// The plant whose stations the file has: itself, or that which a test names.
std::string plant_of(const TomlDocument& document) {
  const std::string_view named =
      runtime::named_test(document.path) ? document.find(document.tables.front(), "plant") : "";
  return named.empty() ? document.path : tidy(beside(document.path, std::string(named)));
}

struct StationRow {
  std::string name;
  std::string program;  // path
  NameUse place;
  NameUse program_place;
};

std::vector<StationRow> stations_in(const TomlDocument& document) {
  std::vector<StationRow> stations;
  for (const TomlTable& table : document.tables) {
    if (table.name != "station") continue;
    StationRow& row = stations.emplace_back();
    for (size_t n = table.first; n < table.end; ++n)
      for (const TextInRow& one : texts_in(document.lines[n])) {
        const uint32_t begin = offset_in(document.text, one.text);
        const NameUse place{document.path, begin, begin + static_cast<uint32_t>(one.text.size()), true};
        if (one.key == "name") {
          row.name = one.text;
          row.place = place;
        } else if (one.key == "program") {
          row.program = tidy(beside(document.path, std::string(one.text)));
          row.program_place = place;
        }
      }
  }
  return stations;
}

std::vector<StationRow> stations_for(const Workspace& workspace, const TomlDocument& document) {
  const std::string plant = plant_of(document);
  if (plant == document.path) return stations_in(document);
  const auto other = read_toml(workspace, plant);
  return other ? stations_in(*other) : std::vector<StationRow>{};
}

// The station that a table is about: that of its key, or the one it belongs to, or the only one.
std::string station_at(const TomlDocument& document, size_t table, const std::vector<StationRow>& stations) {
  const TomlTable& own = document.tables[table];
  if (const std::string_view named = document.find(own, "station"); !named.empty()) return std::string(named);
  if (own.name == "station" || own.name.starts_with("station."))
    for (size_t n = table + 1; n-- > 0;)
      if (document.tables[n].name == "station") return std::string(document.find(document.tables[n], "name"));
  return stations.size() == 1 ? stations.front().name : std::string();
}

void add_uses(const Workspace& workspace, const std::string& path, std::vector<VariableUse>& out) {
  const auto document = read_toml(workspace, path);
  if (!document) return;
  const std::vector<StationRow> stations = stations_for(workspace, *document);
  for (size_t number = 0; number < document->tables.size(); ++number) {
    const TomlTable& table = document->tables[number];
    const std::string station = station_at(*document, number, stations);
    const auto row = std::find_if(stations.begin(), stations.end(),
                                  [&](const StationRow& one) { return one.name == station; });
    if (row == stations.end() || row->program.empty()) continue;
    for (size_t n = table.first; n < table.end; ++n)
      for (const TextInRow& one : texts_in(document->lines[n])) {
        if (!names_variable(one.key)) continue;
        VariableUse& use = out.emplace_back();
        use.path = path;
        use.begin = offset_in(document->text, one.text);
        use.end = use.begin + static_cast<uint32_t>(one.text.size());
        use.text = one.text;
        use.program = row->program;
      }
  }
}

struct NameSpot {
  std::unique_ptr<const TomlDocument> document;
  uint32_t offset = 0;

  bool is_in(const NameUse& use) const {
    return use.path == document->path && use.begin <= offset && offset <= use.end;
  }
};

NameSpot name_spot_of(const Workspace& workspace, const Json& params) {
  NameSpot spot{read_toml(workspace, document_path(params)), 0};
  if (!spot.document) throw RequestError(ErrorCode::InvalidParams, "the file cannot be read");
  spot.offset = offset_of(spot.document->text, params.value("position", Json()), workspace.encoding);
  return spot;
}

// The variable or member under the cursor: its program, and its place in the text.
struct Named {
  const Program* program;
  size_t symbol;
  NameUse use;
};
std::optional<Named> variable_at(Workspace& workspace, const NameSpot& spot) {
  for (const VariableUse& use : variable_uses(workspace, spot.document->path)) {
    if (!spot.is_in(use)) continue;
    const Program& program = workspace.program(use.program);
    for (const NamedSymbol& one : symbols_in(program.index, use.text)) {
      NameUse piece = use;
      piece.begin = use.begin + static_cast<uint32_t>(one.begin);
      piece.end = use.begin + static_cast<uint32_t>(one.end);
      if (spot.is_in(piece)) return Named{&program, one.symbol, piece};
    }
  }
  return std::nullopt;
}

// The station under the cursor; empty when there is none.
std::string station_under(const Workspace& workspace, const NameSpot& spot, NameUse& place) {
  const TomlDocument& document = *spot.document;
  for (const StationRow& station : stations_in(document))
    if (spot.is_in(station.place)) return place = station.place, station.name;
  const auto stations = stations_for(workspace, document);
  for (const std::string_view line : document.lines)
    for (const TextInRow& one : texts_in(line)) {
      const uint32_t begin = offset_in(document.text, one.text);
      place = {document.path, begin, begin + static_cast<uint32_t>(one.text.size()), false};
      const bool known = std::any_of(stations.begin(), stations.end(),
                                     [&](const StationRow& station) { return station.name == one.text; });
      if (names_station(one.key) && known && spot.is_in(place)) return std::string(one.text);
    }
  return {};
}

// The params of a request at the declaration.
Json at_definition(const Workspace& workspace, const Named& named, const Json& params) {
  const IndexedSymbol& symbol = named.program->index.symbols[named.symbol];
  if (!symbol.definition)
    throw RequestError(ErrorCode::RequestFailed, "'" + symbol.name + "' is no name of the program");
  const Json where = location(workspace, *symbol.definition);
  Json out = params;
  out["textDocument"] = {{"uri", where["uri"]}};
  out["position"] = where["range"]["start"];
  return out;
}

}  // namespace

std::vector<NamedSymbol> symbols_in(const compiler::ProgramIndex& index, std::string_view text) {
  std::vector<NamedSymbol> found;
  std::string container;
  for (size_t begin = 0; begin < text.size();) {
    const size_t dot = std::min(text.find('.', begin), text.size());
    const size_t end = std::min(text.find('[', begin), dot);
    const IndexedSymbol* symbol = index.find(text.substr(begin, end - begin), container);
    if (symbol == nullptr || (begin != 0 && container.empty())) break;
    found.push_back({static_cast<size_t>(symbol - index.symbols.data()), begin, end});
    container = symbol->structure;
    begin = dot + 1;
  }
  return found;
}

std::vector<VariableUse> variable_uses(const Workspace& workspace, const std::string& path) {
  std::vector<VariableUse> uses;
  add_uses(workspace, path, uses);
  return uses;
}

std::vector<VariableUse> variable_uses(Workspace& workspace) {
  std::vector<VariableUse> uses;
  for (const std::string& path : workspace.plants()) add_uses(workspace, path, uses);
  return uses;
}

std::vector<NameUse> uses_of(Workspace& workspace, const Program& program, const IndexedSymbol& symbol) {
  std::vector<NameUse> found;
  for (const VariableUse& use : variable_uses(workspace)) {
    if (use.program != program.path) continue;
    for (const NamedSymbol& one : symbols_in(program.index, use.text))
      if (const IndexedSymbol& other = program.index.symbols[one.symbol];
          other.name == symbol.name && other.container == symbol.container && other.kind == symbol.kind)
        found.push_back({use.path, use.begin + static_cast<uint32_t>(one.begin),
                         use.begin + static_cast<uint32_t>(one.end), false});
  }
  return found;
}

std::vector<StationOf> stations_of(Workspace& workspace, const std::string& program) {
  std::vector<StationOf> found;
  for (const std::string& path : workspace.plants()) {
    const auto document = read_toml(workspace, path);
    if (!document) continue;
    for (const StationRow& station : stations_in(*document))
      if (station.program == program) found.push_back({station.program_place, station.name});
  }
  return found;
}

std::vector<NameUse> station_uses(Workspace& workspace, const std::string& path, const std::string& station) {
  std::vector<NameUse> found;
  const auto asked = read_toml(workspace, path);
  if (!asked) return found;
  const std::string plant = plant_of(*asked);
  std::vector<std::string> files = workspace.plants();
  if (std::find(files.begin(), files.end(), plant) == files.end()) files.push_back(plant);
  for (const std::string& file : files) {
    const auto document = read_toml(workspace, file);
    if (!document || plant_of(*document) != plant) continue;
    for (const StationRow& row : stations_in(*document))
      if (row.name == station) found.push_back(row.place);
    for (const std::string_view line : document->lines)
      for (const TextInRow& one : texts_in(line)) {
        const uint32_t begin = offset_in(document->text, one.text);
        // "unit1", or "unit1.DO01" of a wire.
        const bool terminal = (one.key == "from" || one.key == "to") && one.text.starts_with(station + ".");
        if (terminal || (names_station(one.key) && one.text == station))
          found.push_back({file, begin, begin + static_cast<uint32_t>(station.size()), false});
      }
  }
  return found;
}

Json location_of(const Workspace& workspace, const NameUse& use) {
  const std::string text = workspace.text(use.path).value_or("");
  return {{"uri", uri_of(use.path)}, {"range", range_of(text, use.begin, use.end, workspace.encoding)}};
}

Json plant_variable(Workspace& workspace, const Json& params) {
  const auto named = variable_at(workspace, name_spot_of(workspace, params));
  if (!named) return nullptr;
  const IndexedSymbol& symbol = named->program->index.symbols[named->symbol];
  return symbol.definition ? location(workspace, *symbol.definition) : Json(nullptr);
}

Json plant_references(Workspace& workspace, const Json& params) {
  const NameSpot spot = name_spot_of(workspace, params);
  if (const auto named = variable_at(workspace, spot)) {
    const IndexedSymbol& symbol = named->program->index.symbols[named->symbol];
    return symbol.definition ? references(workspace, at_definition(workspace, *named, params))
                             : Json::array();
  }
  Json all = Json::array();
  NameUse place;
  const std::string station = station_under(workspace, spot, place);
  if (!station.empty())
    for (const NameUse& use : station_uses(workspace, spot.document->path, station))
      all.push_back(location_of(workspace, use));
  return all;
}

Json plant_prepare_rename(Workspace& workspace, const Json& params) {
  const NameSpot spot = name_spot_of(workspace, params);
  NameUse place;
  std::string name;
  if (const auto named = variable_at(workspace, spot)) {
    prepare_rename(workspace, at_definition(workspace, *named, params));
    place = named->use;
    name = named->program->index.symbols[named->symbol].name;
  } else {
    name = station_under(workspace, spot, place);
  }
  if (name.empty()) throw RequestError(ErrorCode::RequestFailed, "there is no variable and no station here");
  return {{"range", location_of(workspace, place)["range"]}, {"placeholder", name}};
}

Json plant_rename(Workspace& workspace, const Json& params) {
  const NameSpot spot = name_spot_of(workspace, params);
  if (const auto named = variable_at(workspace, spot))
    return rename(workspace, at_definition(workspace, *named, params));
  NameUse place;
  const std::string station = station_under(workspace, spot, place);
  if (station.empty())
    throw RequestError(ErrorCode::RequestFailed, "there is no variable and no station here");
  const std::string name = params.value("newName", "");
  if (name.empty() || name.find_first_of("\"\\\n\r") != std::string::npos)
    throw RequestError(ErrorCode::RequestFailed, "'" + name + "' is no name of a station");
  for (const StationRow& other : stations_for(workspace, *spot.document))
    if (other.name == name && name != station)
      throw RequestError(ErrorCode::RequestFailed, "there is a station '" + name + "' already");
  Json changes = Json::object();
  for (const NameUse& use : station_uses(workspace, spot.document->path, station)) {
    const Json where = location_of(workspace, use);
    changes[where["uri"].get_ref<const std::string&>()].push_back(
        {{"range", where["range"]}, {"newText", name}});
  }
  return {{"changes", std::move(changes)}};
}

}  // namespace ipos::tools::lsp
