// Looking names up in a finished index, and the pieces of making one: front end, symbols, occurrences.
#include "compiler/symbols/index.hpp"

#include <algorithm>

#include "compiler/parse/parse.hpp"
#include "compiler/sema/declarations.hpp"
#include "compiler/symbols/indexer.hpp"
#include "stdlib/headers.hpp"

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

ProgramIndex index_program(const std::string& name, const std::string& path, std::string text,
                           const CompileOptions& options, const stdlib::UnitType& unit) {
  ProgramIndex index;
  PreprocessOptions preprocessing{options.include_dirs, options.defines, stdlib::headers::embedded_files(),
                                  options.read_file, options.list_files};
  // The mistakes are told by compile(); here they only leave gaps.
  Diagnostics unheard;
  index.main = &index.sources->add(name, path, std::move(text));
  const PreprocessedText tokens = preprocess(*index.sources, *index.main, preprocessing, unheard);
  const ast::Program tree = parse_tokens(*index.sources, tokens, unheard);
  Context context{unit, *index.sources, unheard, {}, {}, {}, {}, {}, {}};
  declare(tree, context);
  Indexer indexer(index, context.scope);
  indexer.add_macros(tokens.record);
  indexer.add_declarations(tree);
  indexer.add_tokens(tokens.tokens);
  indexer.add_bodies(tokens.record);
  indexer.finish(tokens.record);
  return index;
}

}  // namespace ipos::compiler
