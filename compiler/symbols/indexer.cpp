// Symbols from the scope, occurrences from the tokens. Members are found by following the objects in front of
// the dot through the words, which works in a broken statement as well.
#include "compiler/symbols/indexer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/preprocess/number.hpp"
#include "stdlib/language_tables.hpp"

namespace ipos::compiler {

const SourceFile* Indexer::canonical(const SourceFile* file) {
  if (file != asked_.first) asked_ = {file, files_.emplace(identity(*file), file).first->second};
  return asked_.second;
}

// Where the word is written, also when a macro brought it to its place. Names longer than the language's
// limit keep their whole length.
Place Indexer::place(Span span) {
  const Location begin = index_.sources->spelling(span.begin);
  const SourceFile* file = index_.sources->file_of(begin);
  if (file == nullptr) return {};
  const Location end = index_.sources->spelling(span.end);
  const uint32_t first = begin.value - file->base;
  const uint32_t last = end.value >= begin.value ? end.value - file->base : first;
  return {canonical(file), first, std::min(last, static_cast<uint32_t>(file->text.size()))};
}

// A name, of a member behind that of its structure.
std::string Indexer::id_of(const std::string& container, std::string_view name) {
  return container.empty() ? std::string(name) : fmt::format("{}.{}", container, name);
}

size_t Indexer::add_symbol(IndexedSymbol symbol) {
  const auto [at, fresh] = ids_.emplace(id_of(symbol.container, symbol.name), index_.symbols.size());
  if (!fresh) return at->second;
  const size_t id = index_.symbols.size();
  if (symbol.definition) occurrences_[*symbol.definition] = {*symbol.definition, id, true, symbol.number};
  index_.symbols.push_back(std::move(symbol));
  return id;
}

void Indexer::add_occurrence(Place where, size_t symbol, std::optional<uint32_t> number) {
  if (where.file == nullptr) return;
  const auto behind = last_ == occurrences_.end() ? last_ : std::next(last_);
  last_ = occurrences_.try_emplace(behind, where, Occurrence{where, symbol, false, number});
}

// All #defines of one name are one symbol: which of them counts is a matter of conditions.
void Indexer::add_macros(const PreprocessRecord& record) {
  for (const PreprocessRecord::Definition& one : record.definitions) {
    const Place where = place(one.name);
    IndexedSymbol symbol;
    symbol.kind = SymbolKind::Macro;
    symbol.name = where.file->text.substr(where.begin, where.end - where.begin);
    symbol.definition = where;
    symbol.extent = where;
    if (!one.body.empty()) {
      const Place body = place({one.body.front().span.begin, one.body.back().span.end});
      symbol.extent.end = std::max(body.end, where.end);
      symbol.type = where.file->text.substr(body.begin, body.end - body.begin);
    }
    const auto [at, fresh] = macros_.emplace(symbol.name, index_.symbols.size());
    if (fresh) index_.symbols.push_back(std::move(symbol));
    occurrences_[where] = {where, at->second, true, std::nullopt};
  }
  for (const PreprocessRecord::Use& use : record.uses) {
    const Place definition = place(use.definition);
    const auto found = occurrences_.find(definition);
    if (found != occurrences_.end()) add_occurrence(place(use.name), found->second.symbol);
  }
}

void Indexer::add_structure(const StructType& type, Span extent) {
  IndexedSymbol symbol;
  symbol.kind = SymbolKind::Structure;
  symbol.name = type.name;
  symbol.count = type.size;
  if (type.span.begin.valid()) {
    symbol.definition = place(type.span);
    symbol.extent = place(extent);
  }
  add_symbol(std::move(symbol));
  for (const StructMember& member : type.members) {
    for (const std::string& name : member.names) {
      IndexedSymbol one;
      one.kind = SymbolKind::Member;
      one.name = name;
      one.container = type.name;
      one.type = type_text(member.type);
      if (member.type.structure != nullptr) one.structure = member.type.structure->name;
      one.number = member.offset;
      one.count = member.type.size();
      one.array = member.type.count != 0;
      if (member.span.begin.valid()) one.definition = one.extent = place(member.span);
      add_symbol(std::move(one));
    }
  }
}

void Indexer::add_declarations(const ast::Program& tree) {
  std::map<Place, Span> extents;  // of declarations, by the place of the name
  const auto extent = [&](const ast::Ident& name, Span span) { extents.emplace(place(name.span), span); };
  for (const ast::Decl& decl : tree.declarations) {
    if (const auto* row = std::get_if<ast::VariableDecl>(&decl))
      for (const ast::Declarator& one : row->declarators) extent(one.name, row->span);
    if (const auto* row = std::get_if<ast::StructDecl>(&decl)) extent(row->name, row->span);
    if (const auto* row = std::get_if<ast::FunctionDecl>(&decl)) extent(row->name, row->span);
    if (const auto* row = std::get_if<ast::AliasDecl>(&decl)) extent(row->name, row->span);
  }
  const auto whole = [&](Span name) {
    const auto found = extents.find(place(name));
    const Place all = found == extents.end() ? place(name) : place(found->second);
    const Place word = place(name);
    return all.file == word.file && all.begin <= word.begin && all.end >= word.end ? all : word;
  };
  for (const StructType& type : scope_.types()) {
    const auto found = extents.find(place(type.span));
    add_structure(type, found == extents.end() ? type.span : found->second);
  }
  for (const Variable& variable : scope_.variables()) {
    IndexedSymbol symbol;
    symbol.kind = variable.storage == Storage::Alias ? SymbolKind::Alias : SymbolKind::Variable;
    symbol.name = variable.name;
    symbol.definition = place(variable.span);
    symbol.extent = whole(variable.span);
    symbol.type = type_text(variable.type);
    if (variable.type.structure != nullptr) symbol.structure = variable.type.structure->name;
    symbol.number = variable.number;
    symbol.count = variable.type.size();
    symbol.array = variable.type.count != 0;
    symbol.initial = variable.storage == Storage::Initial;
    add_symbol(std::move(symbol));
  }
  for (const FunctionName& function : scope_.functions()) {
    IndexedSymbol symbol;
    symbol.kind = SymbolKind::Function;
    symbol.name = function.name;
    symbol.definition = place(function.span);
    symbol.extent = whole(function.span);
    add_symbol(std::move(symbol));
  }
}

// Names that are no macro: of the program, H variables, system functions.
std::optional<size_t> Indexer::symbol_of(std::string_view name) {
  if (const auto found = ids_.find(name); found != ids_.end()) return found->second;
  IndexedSymbol symbol;
  uint32_t number = 0;
  if (raw_number(name, number)) {
    symbol.kind = SymbolKind::RawVariable;
    symbol.name = "H" + std::to_string(number);  // H007 is H7
    symbol.type = "long";
    symbol.number = number;
  } else if (const auto* function = stdlib::find_system_function(name)) {
    symbol.kind = SymbolKind::SystemFunction;
    symbol.name = function->name;
    symbol.type = function->arguments;
  } else {
    return std::nullopt;
  }
  return add_symbol(std::move(symbol));
}

std::optional<size_t> Indexer::member_of(const StructType& type, std::string_view name) {
  const auto found = ids_.find(id_of(type.name, name));
  return found == ids_.end() ? std::nullopt : std::optional(found->second);
}

void Indexer::name(const Token& token, Chain& chain) {
  const bool behind_dot = chain.before != nullptr &&
                          (chain.before->kind == TokenKind::Dot || chain.before->kind == TokenKind::Arrow);
  const Object base = std::exchange(chain.object, {});
  chain.index_member = false;
  if (behind_dot) {
    if (!base.known || base.type.structure == nullptr || base.type.count != 0) return;
    const StructMember* member = base.type.structure->find(token.text);
    const auto symbol = member_of(*base.type.structure, token.text);
    if (member == nullptr || !symbol) return;
    chain.object = {true, member->type, base.number};
    if (chain.object.number) *chain.object.number += member->offset;
    chain.index_member = base.type.structure->name == "MOVLNK" && member->names.front() == "Index";
    add_occurrence(place(token.span), *symbol, chain.object.number);
    return;
  }
  const auto symbol = symbol_of(token.text);
  if (!symbol) return;
  const IndexedSymbol& found = index_.symbols[*symbol];
  if (found.kind == SymbolKind::RawVariable) {
    chain.object = {true, {}, found.number};
  } else if (const Entity* entity = scope_.find(token.text)) {
    if (const auto* variable = std::get_if<const Variable*>(entity))
      chain.object = {true, (*variable)->type, (*variable)->number};
  }
  add_occurrence(place(token.span), *symbol, chain.object.number);
}

// `Ml.Index = 8318`: the number names a parameter.
void Indexer::number(const Token& token, const Chain& chain) {
  if (!chain.index_member || chain.before == nullptr || chain.before->kind != TokenKind::Assign) return;
  const ParsedNumber parsed = parse_number(token.text, false);
  if (parsed.form != NumberForm::Good || parsed.value > 0xFFFF) return;
  IndexedSymbol symbol;
  symbol.kind = SymbolKind::Parameter;
  symbol.name = std::to_string(parsed.value);
  symbol.number = parsed.value;
  add_occurrence(place(token.span), add_symbol(std::move(symbol)), parsed.value);
}

void Indexer::close(TokenKind bracket, Chain& chain) {
  const TokenKind open = bracket == TokenKind::RightBracket ? TokenKind::LeftBracket : TokenKind::LeftParen;
  while (!chain.brackets.empty()) {
    const auto [kind, object] = chain.brackets.back();
    chain.brackets.pop_back();
    if (kind != open) continue;
    if (open == TokenKind::LeftParen) return;  // (a).b: what is inside goes on
    std::optional<uint32_t> element;
    // A number alone; of `[n + 1]` nobody knows the element. A bracket stands in front of it, so it is not the first.
    if (chain.before->kind == TokenKind::Number && chain.before[-1].kind == open && object.number) {
      const ParsedNumber parsed = parse_number(chain.before->text, false);
      if (parsed.form == NumberForm::Good && parsed.value < object.type.count)
        element = *object.number + parsed.value * object.type.element().size();
    }
    chain.object = {object.known && object.type.count != 0, object.type.element(), element};
    return;
  }
  chain.object = {};
}

void Indexer::add_tokens(std::span<const Token> tokens) {
  Chain chain;
  for (const Token& token : tokens) {
    switch (token.kind) {
      case TokenKind::Name: name(token, chain); break;
      case TokenKind::Number: number(token, chain); break;
      case TokenKind::LeftBracket:
      case TokenKind::LeftParen:
        chain.brackets.emplace_back(token.kind, std::exchange(chain.object, {}));
        break;
      case TokenKind::RightBracket:
      case TokenKind::RightParen: close(token.kind, chain); break;
      case TokenKind::Dot:
      case TokenKind::Arrow: break;
      default:
        chain.object = {};
        if (token.kind == TokenKind::Semicolon || token.kind == TokenKind::LeftBrace) chain.brackets.clear();
        break;
    }
    if (token.kind != TokenKind::Assign && token.kind != TokenKind::Name) chain.index_member = false;
    chain.before = &token;
  }
}

void Indexer::add_bodies(const PreprocessRecord& record) {
  for (const PreprocessRecord::Definition& one : record.definitions) {
    const Token* before = nullptr;
    for (const Token& token : one.body) {
      const bool member =
          before != nullptr && (before->kind == TokenKind::Dot || before->kind == TokenKind::Arrow);
      before = &token;
      if (token.kind != TokenKind::Name || member) continue;
      if (const auto macro = macros_.find(token.text); macro != macros_.end())
        add_occurrence(place(token.span), macro->second);
      else if (const auto symbol = symbol_of(token.text))
        add_occurrence(place(token.span), *symbol, index_.symbols[*symbol].number);
    }
  }
}

void Indexer::finish(const PreprocessRecord& record) {
  for (const PreprocessRecord::Include& include : record.includes)
    index_.includes.push_back({place(include.header), canonical(include.file)});
  index_.occurrences.reserve(occurrences_.size());
  for (const auto& [where, occurrence] : occurrences_) index_.occurrences.push_back(occurrence);
}

}  // namespace ipos::compiler
