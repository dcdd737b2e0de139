// Outlines: the names a file declares, and the search for a name in all programs.
#include <algorithm>
#include <cctype>

#include "tools/lsp/features.hpp"

namespace ipos::tools::lsp {
namespace {

using compiler::IndexedSymbol;
using compiler::SymbolKind;

constexpr size_t kMaxFound = 1000;

// SymbolKind of the protocol.
int protocol_kind(SymbolKind kind) {
  switch (kind) {
    case SymbolKind::Function: return 12;
    case SymbolKind::Structure: return 23;
    case SymbolKind::Member: return 8;
    case SymbolKind::Macro: return 14;
    default: return 13;
  }
}

std::string detail(const IndexedSymbol& symbol) {
  const bool variable = symbol.kind == SymbolKind::Variable || symbol.kind == SymbolKind::Alias;
  return variable ? symbol.type + " H" + std::to_string(symbol.number.value_or(0)) : symbol.type;
}

Json outline(const Workspace& workspace, const IndexedSymbol& symbol) {
  const std::string& text = symbol.definition->file->text;
  return {{"name", symbol.name},
          {"detail", detail(symbol)},
          {"kind", protocol_kind(symbol.kind)},
          {"range", range_of(text, symbol.extent.begin, symbol.extent.end, workspace.encoding)},
          {"selectionRange",
           range_of(text, symbol.definition->begin, symbol.definition->end, workspace.encoding)}};
}

// The letters of the query in their order, in any case, as editors expect.
bool matches(std::string_view name, std::string_view query) {
  size_t at = 0;
  for (const char c : name)
    if (at < query.size() &&
        std::tolower(static_cast<unsigned char>(c)) == std::tolower(static_cast<unsigned char>(query[at])))
      ++at;
  return at == query.size();
}

}  // namespace

Json document_symbols(Workspace& workspace, const Json& params) {
  Json cursor_params = params;
  cursor_params["position"] = {{"line", 0}, {"character", 0}};
  const Cursor cursor = cursor_of(workspace, cursor_params);
  Json all = Json::array();
  if (cursor.file == nullptr) return all;
  for (const IndexedSymbol& symbol : cursor.program.index.symbols) {
    if (!symbol.definition || symbol.definition->file != cursor.file || symbol.kind == SymbolKind::Member)
      continue;
    Json one = outline(workspace, symbol);
    if (symbol.kind == SymbolKind::Structure)
      for (const IndexedSymbol& member : cursor.program.index.symbols)
        if (member.kind == SymbolKind::Member && member.container == symbol.name && member.definition)
          one["children"].push_back(outline(workspace, member));
    all.push_back(std::move(one));
  }
  return all;
}

Json workspace_symbols(Workspace& workspace, const Json& params) {
  const std::string query = params.value("query", "");
  Json all = Json::array();
  std::set<std::pair<std::string, uint32_t>> seen;
  for (const Program* program : workspace.programs()) {
    for (const IndexedSymbol& symbol : program->index.symbols) {
      if (all.size() == kMaxFound) return all;
      if (!symbol.definition || symbol.definition->file->path.empty() || !matches(symbol.name, query))
        continue;
      if (!seen.emplace(symbol.definition->file->path, symbol.definition->begin).second) continue;
      Json one{{"name", symbol.name},
               {"kind", protocol_kind(symbol.kind)},
               {"location", location(workspace, *symbol.definition)}};
      if (!symbol.container.empty()) one["containerName"] = symbol.container;
      all.push_back(std::move(one));
    }
  }
  return all;
}

}  // namespace ipos::tools::lsp
