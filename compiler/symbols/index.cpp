// Looking names up in a finished index, and the pieces of making one: front end, symbols, occurrences.
#include "compiler/symbols/index.hpp"

#include <algorithm>

#include "compiler/parse/parse.hpp"
#include "compiler/sema/declarations.hpp"
#include "compiler/symbols/indexer.hpp"

namespace ipos::compiler {

const std::string& identity(const SourceFile& file) { return file.path.empty() ? file.name : file.path; }

const Occurrence* ProgramIndex::at(const SourceFile& file, uint32_t offset) const {
  const Occurrence* found = nullptr;
  for (const Occurrence& one : occurrences) {
    if (one.place.file != &file || one.place.begin > offset || one.place.end < offset) continue;
    // Of two neighbours the one that begins here.
    if (found == nullptr || one.place.begin == offset) found = &one;
  }
  return found;
}

const IndexedSymbol* ProgramIndex::find(std::string_view name, std::string_view container) const {
  const auto found = std::find_if(symbols.begin(), symbols.end(), [&](const IndexedSymbol& symbol) {
    return symbol.name == name && symbol.container == container && symbol.kind != SymbolKind::Parameter;
  });
  return found == symbols.end() ? nullptr : &*found;
}

const SourceFile* ProgramIndex::file(std::string_view path_or_name) const {
  for (const auto& one : sources->files())
    if (identity(*one) == path_or_name) return one.get();
  return nullptr;
}

IndexedCompilation compile_indexed(const std::string& name, const std::string& path, std::string text,
                                   const CompileOptions& options) {
  FrontEnd front;
  IndexedCompilation made{compile(name, path, std::move(text), options, &front), {}};
  ProgramIndex& index = made.index;
  index.sources = made.compiled.sources;
  index.main = index.sources->files().front().get();
  // The mistakes are told by compile(); here they only leave gaps.
  Diagnostics unheard;
  if (!front.text.complete) front.tree = parse_tokens(*index.sources, front.text, unheard);
  Context context{*made.compiled.unit, *index.sources, unheard, {}, {}, {}, {}, {}, {}};
  declare(front.tree, context);
  Indexer indexer(index, context.scope);
  indexer.add_macros(front.text.record);
  indexer.add_declarations(front.tree);
  indexer.add_tokens(front.text.tokens);
  indexer.add_bodies(front.text.record);
  indexer.finish(front.text.record);
  return made;
}

}  // namespace ipos::compiler
