// What an editor draws on a text: folds, colours by meaning, numbers after declarations, and lenses above what can be
// run. Programs here, plants and tests in plant_marks.cpp.
#include <fmt/format.h>

#include <algorithm>

#include "compiler/analysis/timing.hpp"
#include "tools/lsp/marks.hpp"
#include "tools/lsp/plant_names.hpp"
#include "vm/sched/scheduler.hpp"

namespace ipos::tools::lsp {
namespace {

using compiler::IndexedSymbol;
using compiler::Occurrence;
using compiler::SymbolKind;

// The file as the program reads it; null where it does not.
const compiler::SourceFile* file_of(Workspace& workspace, const Json& params, const Program*& program) {
  Json at_begin = params;
  at_begin["position"] = {{"line", 0}, {"character", 0}};
  const Cursor cursor = cursor_of(workspace, at_begin);
  program = &cursor.program;
  return cursor.file;
}

// Lines from 0 that end a block or a comment with the line that begins it. Texts and comments hide braces.
std::vector<std::pair<uint32_t, uint32_t>> blocks_of(std::string_view text,
                                                     std::vector<std::pair<uint32_t, uint32_t>>& comments) {
  std::vector<std::pair<uint32_t, uint32_t>> blocks;
  std::vector<uint32_t> open;
  uint32_t line = 0;
  for (size_t n = 0; n < text.size(); ++n) {
    const std::string_view rest = text.substr(n);
    if (rest.starts_with("//")) {
      n = std::min(text.find('\n', n), text.size()) - 1;
    } else if (rest.starts_with("/*")) {
      const size_t end = std::min(text.find("*/", n + 2), text.size());
      const auto more =
          static_cast<uint32_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(n),
                                           text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
      if (more != 0) comments.emplace_back(line, line + more);
      line += more;
      n = std::min(end + 1, text.size());
    } else if (text[n] == '"') {
      while (++n < text.size() && text[n] != '"' && text[n] != '\n') {
      }
      if (n < text.size() && text[n] == '\n') ++line;
    } else if (text[n] == '{') {
      open.push_back(line);
    } else if (text[n] == '}' && !open.empty()) {
      if (open.back() < line) blocks.emplace_back(open.back(), line);
      open.pop_back();
    } else if (text[n] == '\n') {
      ++line;
    }
  }
  return blocks;
}

// Position in kTokenTypes; nothing for what has no colour of its own.
std::optional<TokenType> type_of(const IndexedSymbol& symbol) {
  switch (symbol.kind) {
    case SymbolKind::Macro: return TokenType::Macro;
    case SymbolKind::Variable:
    case SymbolKind::Alias:
    case SymbolKind::RawVariable: return TokenType::Variable;
    case SymbolKind::Function:
    case SymbolKind::SystemFunction: return TokenType::Function;
    case SymbolKind::Structure: return TokenType::Type;
    case SymbolKind::Member: return TokenType::Property;
    case SymbolKind::Parameter: return TokenType::Number;
  }
  return std::nullopt;
}

Json lens(const Json& range, const std::string& title, const std::string& command, Json arguments) {
  return {{"range", range},
          {"command", {{"title", title}, {"command", command}, {"arguments", std::move(arguments)}}}};
}

}  // namespace

Json folding_ranges(Workspace& workspace, const Json& params) {
  Json out = Json::array();
  const auto text = workspace.text(document_path(params));
  if (!text) return out;
  std::vector<std::pair<uint32_t, uint32_t>> comments;
  // The line of the closing brace stays in view.
  for (const auto& [begin, end] : blocks_of(*text, comments))
    if (end - begin > 1) out.push_back({{"startLine", begin}, {"endLine", end - 1}});
  for (const auto& [begin, end] : comments)
    out.push_back({{"startLine", begin}, {"endLine", end}, {"kind", "comment"}});
  return out;
}

// The number of its first variable after each declared name.
Json inlay_hints(Workspace& workspace, const Json& params) {
  Json out = Json::array();
  const Program* program = nullptr;
  const compiler::SourceFile* file = file_of(workspace, params, program);
  if (file == nullptr) return out;
  const Json range = params.value("range", Json::object());
  const uint32_t begin = offset_of(file->text, range.value("start", Json()), workspace.encoding);
  const uint32_t end = range.contains("end") ? offset_of(file->text, range["end"], workspace.encoding)
                                             : static_cast<uint32_t>(file->text.size());
  for (const IndexedSymbol& symbol : program->index.symbols) {
    const bool variable = symbol.kind == SymbolKind::Variable;
    if (!variable || !symbol.number || !symbol.definition || symbol.definition->file != file) continue;
    if (symbol.definition->end < begin || symbol.definition->begin > end) continue;
    const uint32_t last = *symbol.number + symbol.count - 1;
    out.push_back({{"position", position_of(file->text, symbol.definition->end, workspace.encoding)},
                   {"label", symbol.count > 1 ? fmt::format("H{}..H{}", *symbol.number, last)
                                              : fmt::format("H{}", *symbol.number)},
                   {"paddingLeft", true}});
  }
  return out;
}

Json semantic_tokens(Workspace& workspace, const Json& params) {
  const Program* program = nullptr;
  const compiler::SourceFile* file = file_of(workspace, params, program);
  TokenRow row;
  if (file == nullptr) return row.json();
  for (const Occurrence& one : program->index.occurrences) {
    if (one.place.file != file) continue;
    const IndexedSymbol& symbol = program->index.symbols[one.symbol];
    const auto type = type_of(symbol);
    if (!type) continue;
    uint32_t modifiers = one.definition ? uint32_t{kDeclaration} : 0U;
    if (!symbol.definition) modifiers |= kDefaultLibrary;
    row.add(range_of(file->text, one.place.begin, one.place.end, workspace.encoding), *type, modifiers);
  }
  return row.json();
}

// "at most 18 commands, 9 ms": what a function costs, as `ipos build --time` says, at the rates that P938 and P939 have in the factory.
std::string title_of(const compiler::FunctionTiming& timing) {
  using Kind = compiler::FunctionTiming::Kind;
  const char* const what = timing.kind == Kind::Turn ? "a turn: " : timing.kind == Kind::Interrupt ? "an interrupt: " : "";
  if (!timing.commands) return fmt::format("{}no bound: {}", what, timing.because);
  return fmt::format("{}at most {} commands{}", what, *timing.commands, timing.ms ? fmt::format(", {} ms", *timing.ms) : "");
}

void add_timings(const Program& program, const compiler::SourceFile* file, Encoding encoding, Json& out) {
  const auto& image = program.compiled.image;
  if (!image) return;
  for (const compiler::FunctionTiming& timing :
       compiler::function_timings(*image, program.compiled.unit->variables, vm::Rates{}.commands))
    for (const IndexedSymbol& symbol : program.index.symbols)
      if (symbol.kind == SymbolKind::Function && symbol.name == timing.name && symbol.definition && symbol.definition->file == file)
        out.push_back(lens(range_of(file->text, symbol.definition->begin, symbol.definition->end, encoding), title_of(timing), "",
                           Json::array()));
}

// Above main(): run and debug the program, and the plants that have it; above every function what it costs.
Json code_lenses(Workspace& workspace, const Json& params) {
  Json out = Json::array();
  const Program* program = nullptr;
  const compiler::SourceFile* file = file_of(workspace, params, program);
  if (file == nullptr) return out;
  const std::string path = document_path(params);
  for (const IndexedSymbol& symbol : program->index.symbols) {
    if (symbol.kind != SymbolKind::Function || symbol.name != "main" || !symbol.definition ||
        symbol.definition->file != file)
      continue;
    const Json range =
        range_of(file->text, symbol.definition->begin, symbol.definition->end, workspace.encoding);
    out.push_back(lens(range, "Run", "ipos.run", {uri_of(path)}));
    out.push_back(lens(range, "Debug", "ipos.debug", {uri_of(path)}));
    for (const StationOf& station : stations_of(workspace, path)) {
      const std::string name = station.path.substr(station.path.rfind('/') + 1);
      const Json where = location_of(workspace, station);
      out.push_back(lens(range, fmt::format("{} in {}", station.station, name), "ipos.open",
                         {where["uri"], where["range"]["start"]}));
    }
  }
  add_timings(*program, file, workspace.encoding, out);
  return out;
}

void TokenRow::add(const Json& range, TokenType type, uint32_t modifiers) {
  const uint32_t line = range["start"]["line"], begin = range["start"]["character"];
  const uint32_t end = range["end"]["character"];
  if (range["end"]["line"] != line || end <= begin) return;
  tokens_.push_back({line, begin, end - begin, static_cast<uint32_t>(type), modifiers});
}

// Each relative to the one before, in order of their places.
Json TokenRow::json() {
  std::sort(tokens_.begin(), tokens_.end());
  Json data = Json::array();
  uint32_t line = 0, begin = 0;
  for (const Token& token : tokens_) {
    const bool same = token[0] == line;
    for (const uint32_t number :
         {token[0] - line, same ? token[1] - begin : token[1], token[2], token[3], token[4]})
      data.push_back(number);
    line = token[0];
    begin = token[1];
  }
  return {{"data", std::move(data)}};
}

}  // namespace ipos::tools::lsp
