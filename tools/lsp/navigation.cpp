// Where a name is: definition, references, highlights, and the cursor all requests begin with.
#include <algorithm>

#include "stdlib/headers.hpp"
#include "tools/lsp/features.hpp"
#include "tools/lsp/plant_names.hpp"

namespace ipos::tools::lsp {
namespace {

using compiler::Occurrence;
using compiler::Place;
using compiler::ProgramIndex;
using compiler::SymbolKind;

// The symbol of another program that stands at the same place of the same file, or that the language brings
// under the same name.
std::optional<size_t> same_symbol(const compiler::IndexedSymbol& symbol, const ProgramIndex& index) {
  for (size_t n = 0; n < index.symbols.size(); ++n) {
    const compiler::IndexedSymbol& other = index.symbols[n];
    if (other.kind != symbol.kind || other.name != symbol.name || other.container != symbol.container)
      continue;
    if (!symbol.definition && !other.definition) return n;
    if (symbol.definition && other.definition && symbol.definition->begin == other.definition->begin &&
        tidy(identity(*symbol.definition->file)) == tidy(identity(*other.definition->file)))
      return n;
  }
  return std::nullopt;
}

}  // namespace

std::string document_path(const Json& params) {
  const auto document = params.find("textDocument");
  if (document == params.end() || !document->is_object() || !document->contains("uri") ||
      !(*document)["uri"].is_string())
    throw RequestError(ErrorCode::InvalidParams, "no textDocument.uri");
  return tidy(path_of((*document)["uri"].get_ref<const std::string&>()));
}

Cursor cursor_of(Workspace& workspace, const Json& params) {
  const std::string path = document_path(params);
  const Program& program = workspace.program(path);
  Cursor cursor{program, nullptr, 0, nullptr, nullptr};
  for (const auto& file : program.index.sources->files())
    if (cursor.file == nullptr && tidy(file->path) == path) cursor.file = file.get();
  if (cursor.file == nullptr) return cursor;
  cursor.offset = offset_of(cursor.file->text, params.value("position", Json()), workspace.encoding);
  cursor.occurrence = program.index.at(*cursor.file, cursor.offset);
  if (cursor.occurrence != nullptr) cursor.symbol = &program.index.symbols[cursor.occurrence->symbol];
  return cursor;
}

Place word_at(const Cursor& cursor) {
  const std::string& text = cursor.file->text;
  uint32_t begin = cursor.offset, end = cursor.offset;
  while (begin > 0 && is_word(text[begin - 1])) --begin;
  while (end < text.size() && is_word(text[end])) ++end;
  return {cursor.file, begin, end};
}

Json location(const Workspace& workspace, const Place& place) {
  return {{"uri", uri_of(tidy(compiler::identity(*place.file)))},
          {"range", range_of(place.file->text, place.begin, place.end, workspace.encoding)}};
}

Json definition(Workspace& workspace, const Json& params) {
  const Cursor cursor = cursor_of(workspace, params);
  if (cursor.file == nullptr) return nullptr;
  for (const ProgramIndex::Include& include : cursor.program.index.includes)
    if (include.header.file == cursor.file && include.header.begin <= cursor.offset &&
        cursor.offset <= include.header.end)
      return location(workspace, {include.file, 0, 0});
  if (cursor.symbol == nullptr) return nullptr;
  Json all = Json::array();
  for (const Occurrence& one : cursor.program.index.occurrences)
    if (one.definition && one.symbol == cursor.occurrence->symbol)
      all.push_back(location(workspace, one.place));
  return all;
}

Json program_references(Workspace& workspace, const Json& params) {
  const Cursor cursor = cursor_of(workspace, params);
  Json all = Json::array();
  if (cursor.symbol == nullptr) return all;
  const Json context = params.value("context", Json::object());
  const bool declarations = context.is_object() && context.value("includeDeclaration", true);
  std::vector<const Program*> programs{&cursor.program};
  // A name of a header may be used by every program that includes it.
  if (cursor.symbol->definition)
    programs = workspace.programs_with(tidy(compiler::identity(*cursor.symbol->definition->file)));
  if (std::find(programs.begin(), programs.end(), &cursor.program) == programs.end())
    programs.push_back(&cursor.program);
  for (const Program* program : programs) {
    const auto symbol = same_symbol(*cursor.symbol, program->index);
    if (!symbol) continue;
    for (const Occurrence& one : program->index.occurrences) {
      if (one.symbol != *symbol || (one.definition && !declarations)) continue;
      Json where = location(workspace, one.place);
      if (std::find(all.begin(), all.end(), where) == all.end()) all.push_back(std::move(where));
    }
  }
  return all;
}

// And the plants and tests that name it.
Json references(Workspace& workspace, const Json& params) {
  Json all = program_references(workspace, params);
  const Cursor cursor = cursor_of(workspace, params);
  if (cursor.symbol == nullptr || !cursor.symbol->definition) return all;
  const std::string path = tidy(compiler::identity(*cursor.symbol->definition->file));
  for (const Program* program : workspace.programs_with(path))
    for (const NameUse& use : uses_of(workspace, *program, *cursor.symbol)) {
      Json where = location_of(workspace, use);
      if (std::find(all.begin(), all.end(), where) == all.end()) all.push_back(std::move(where));
    }
  return all;
}

Json highlights(Workspace& workspace, const Json& params) {
  const Cursor cursor = cursor_of(workspace, params);
  Json all = Json::array();
  if (cursor.symbol == nullptr) return all;
  for (const Occurrence& one : cursor.program.index.occurrences)
    if (one.symbol == cursor.occurrence->symbol && one.place.file == cursor.file)
      all.push_back(
          {{"range", range_of(cursor.file->text, one.place.begin, one.place.end, workspace.encoding)}});
  return all;
}

// The text of a built-in header or block, for editors that show one: "ipos:/const.h", "ipos:/blocks/ramp.h".
Json header_text(Workspace&, const Json& params) {
  const std::string uri = params.value("uri", "");
  std::string_view name = uri;
  if (name.starts_with(kHeaderScheme)) name.remove_prefix(kHeaderScheme.size());
  if (const stdlib::EmbeddedFile* header = stdlib::find_built_in_file(name)) return {{"text", std::string(header->text)}};
  throw RequestError(ErrorCode::InvalidParams, "there is no built-in header " + std::string(name));
}

}  // namespace ipos::tools::lsp
