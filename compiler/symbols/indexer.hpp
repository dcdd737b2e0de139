// Makes an index: first the symbols, then every word of the text that means one of them.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <unordered_map>

#include "compiler/ast/ast.hpp"
#include "compiler/sema/scope.hpp"
#include "compiler/symbols/index.hpp"

namespace ipos::compiler {

class Indexer {
 public:
  Indexer(ProgramIndex& index, const Scope& scope) : index_(index), scope_(scope) {}

  void add_macros(const PreprocessRecord& record);
  void add_declarations(const ast::Program& tree);
  void add_tokens(std::span<const Token> tokens);
  // Words in macros that nothing uses are looked up by their names.
  void add_bodies(const PreprocessRecord& record);
  void finish(const PreprocessRecord& record);

 private:
  // What the words so far stand for: `a.b[2]` is an object with a type and perhaps a number.
  struct Object {
    bool known = false;
    Type type;
    std::optional<uint32_t> number;
  };
  struct Chain {
    Object object;
    std::vector<std::pair<TokenKind, Object>> brackets;  // open ones, with what stood in front
    const Token* before = nullptr;
    bool index_member = false;  // MOVLNK's Index was the last object
  };

  Place place(Span span);
  const SourceFile* canonical(const SourceFile* file);
  static std::string id_of(const std::string& container, std::string_view name);
  size_t add_symbol(IndexedSymbol symbol);
  void add_structure(const StructType& type, Span extent);
  void add_occurrence(Place where, size_t symbol, std::optional<uint32_t> number = std::nullopt);
  void name(const Token& token, Chain& chain);
  void number(const Token& token, const Chain& chain);
  void close(TokenKind bracket, Chain& chain);
  std::optional<size_t> symbol_of(std::string_view name);
  std::optional<size_t> member_of(const StructType& type, std::string_view name);

  // The files in the order in which they were read.
  struct InText {
    bool operator()(const Place& a, const Place& b) const { return key(a) < key(b); }
    static std::tuple<uint32_t, uint32_t, uint32_t> key(const Place& place) {
      return {place.file == nullptr ? 0 : place.file->base, place.begin, place.end};
    }
  };
  struct HashOfName {
    using is_transparent = void;
    size_t operator()(std::string_view name) const { return std::hash<std::string_view>()(name); }
  };
  using Occurrences = std::map<Place, Occurrence, InText>;

  ProgramIndex& index_;
  const Scope& scope_;
  Occurrences occurrences_;
  Occurrences::iterator last_ = occurrences_.end();  // added last: the next one mostly stands behind it
  std::unordered_map<std::string, size_t, HashOfName, std::equal_to<>> ids_;  // see id_of()
  std::map<std::string, size_t, std::less<>> macros_;
  std::map<std::string, const SourceFile*, std::less<>> files_;
  std::pair<const SourceFile*, const SourceFile*> asked_;  // of canonical() the last file, and what it was
};

}  // namespace ipos::compiler
