// Rename. Whether the new name clashes is left to the compiler: the renamed programs have to compile to the
// same code as before, else nothing is changed.
#include <fmt/format.h>

#include <algorithm>

#include "compiler/preprocess/token.hpp"
#include "stdlib/language_tables.hpp"
#include "tools/lsp/features.hpp"
#include "tools/lsp/plant_names.hpp"

namespace ipos::tools::lsp {
namespace {

using compiler::IndexedSymbol;
using compiler::SymbolKind;

[[noreturn]] void refuse(const std::string& reason) { throw RequestError(ErrorCode::RequestFailed, reason); }

// Names of the language, of the unit and of the built-in headers stay.
void check_renamable(const Cursor& cursor) {
  if (cursor.symbol == nullptr) refuse("there is no name here");
  const IndexedSymbol& symbol = *cursor.symbol;
  if (!symbol.definition)
    refuse(fmt::format("'{}' is a name of the language and cannot be renamed", symbol.name));
  for (const compiler::Occurrence& one : cursor.program.index.occurrences)
    if (one.symbol == cursor.occurrence->symbol && one.place.file->path.empty())
      refuse(fmt::format("'{}' is a name of the built-in {} and cannot be renamed", symbol.name,
                         one.place.file->name));
  if (symbol.kind == SymbolKind::Function && symbol.name == "main")
    refuse("'main' is where task 1 begins and cannot be renamed");
}

void check_new_name(const std::string& name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const bool good = !name.empty() && letter(name[0]) &&
                    std::all_of(name.begin(), name.end(), [&](char c) { return letter(c) || digit(c); });
  if (!good) refuse(fmt::format("'{}' is no name: letters, digits and _ only, no digit first", name));
  if (name.size() > 32) refuse("names have at most 32 characters");
  if (compiler::keyword_kind(name) != compiler::TokenKind::Name || name == "defined")
    refuse(fmt::format("'{}' is a word of the language", name));
  if (stdlib::find_system_function(name) != nullptr) refuse(fmt::format("'{}' is a system function", name));
  if (name[0] == 'H' && name.size() > 1 && std::all_of(name.begin() + 1, name.end(), digit))
    refuse(fmt::format("'{}' is a variable of the unit", name));
}

std::string first_error(const Program& program) {
  for (const compiler::Diagnostic& one : program.compiled.diagnostics.all())
    if (one.severity == compiler::Severity::Error) return one.text;
  return "the program changes";
}

// Nothing but the names may change.
void check_same(const Program& before, const Program& after, const std::string& name) {
  const bool both = before.compiled.image.has_value() && after.compiled.image.has_value();
  const bool neither = !before.compiled.image && !after.compiled.image;
  if (both && before.compiled.image->code == after.compiled.image->code &&
      before.compiled.image->symbols.size() == after.compiled.image->symbols.size())
    return;
  if (neither && before.compiled.diagnostics.error_count() == after.compiled.diagnostics.error_count() &&
      before.index.occurrences.size() == after.index.occurrences.size())
    return;
  refuse(fmt::format("'{}' cannot be used in {}: {}", name, after.path,
                     both ? "the program changes" : first_error(after)));
}

}  // namespace

Json prepare_rename(Workspace& workspace, const Json& params) {
  const Cursor cursor = cursor_of(workspace, params);
  check_renamable(cursor);
  const compiler::Place& place = cursor.occurrence->place;
  return {{"range", range_of(place.file->text, place.begin, place.end, workspace.encoding)},
          {"placeholder", cursor.symbol->name}};
}

Json rename(Workspace& workspace, const Json& params) {
  const Cursor cursor = cursor_of(workspace, params);
  check_renamable(cursor);
  const std::string name = params.value("newName", "");
  check_new_name(name);
  if (name == cursor.symbol->name) return {{"changes", Json::object()}};

  Json request = params;
  request["context"] = {{"includeDeclaration", true}};
  Json changes = Json::object();
  std::map<std::string, std::vector<Json>> places;  // by path
  for (const Json& where : program_references(workspace, request)) {
    const std::string& uri = where["uri"].get_ref<const std::string&>();
    changes[uri].push_back({{"range", where["range"]}, {"newText", name}});
    places[path_of(uri)].push_back(where["range"]);
  }

  std::map<std::string, std::string> texts;
  std::set<const Program*> programs{&cursor.program};
  for (auto& [path, ranges] : places) {
    std::string text = workspace.text(path).value_or("");
    const std::string before = text;
    std::vector<std::pair<uint32_t, uint32_t>> offsets;
    for (const Json& range : ranges)
      offsets.emplace_back(offset_of(before, range["start"], workspace.encoding),
                           offset_of(before, range["end"], workspace.encoding));
    std::sort(offsets.rbegin(), offsets.rend());
    for (const auto& [begin, end] : offsets) text.replace(begin, end - begin, name);
    texts[path] = std::move(text);
    for (const Program* program : workspace.programs_with(path)) programs.insert(program);
  }
  for (const Program* program : programs) check_same(*program, workspace.compile(program->path, texts), name);
  for (const Program* program : programs)
    for (const NameUse& use : uses_of(workspace, *program, *cursor.symbol)) {
      const Json where = location_of(workspace, use);
      changes[where["uri"].get_ref<const std::string&>()].push_back(
          {{"range", where["range"]}, {"newText", name}});
    }
  return {{"changes", std::move(changes)}};
}

}  // namespace ipos::tools::lsp
