// Makes an index: first the symbols, then every word of the text that means one of them.
#pragma once

#include <map>
#include <set>
#include <span>

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
  size_t add_symbol(IndexedSymbol symbol);
  void add_structure(const StructType& type, Span extent);
  void add_occurrence(Place where, size_t symbol, std::optional<uint32_t> number = std::nullopt);
  void name(const Token& token, Chain& chain);
  void number(const Token& token, const Chain& chain);
  void close(TokenKind bracket, Chain& chain);
  std::optional<size_t> symbol_of(std::string_view name);
  std::optional<size_t> member_of(const StructType& type, std::string_view name);

  ProgramIndex& index_;
  const Scope& scope_;
  std::map<Place, Occurrence> occurrences_;
  std::map<std::pair<std::string, std::string>, size_t, std::less<>> ids_;  // container and name
  std::map<std::string, size_t, std::less<>> macros_;
  std::map<std::string, const SourceFile*, std::less<>> files_;
};

}  // namespace ipos::compiler
