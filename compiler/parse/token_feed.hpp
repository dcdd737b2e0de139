// What stands between preprocessor and parser: makes the parser's symbols, knows which names are types,
// explains syntax errors, and finds the place to go on after one.
#pragma once

#include <span>
#include <unordered_map>

#include "compiler/diag/diag.hpp"
#include "compiler/parse/grammar.hpp"
#include "compiler/preprocess/token.hpp"

namespace ipos::compiler {

// What the parser takes: a token of the grammar with its place and value.
struct Symbol {
  Parser::token_kind_type kind;
  Span span;
  SemanticValue value;
};

class TokenFeed {
 public:
  // `tokens` ends with End. `unclosed`: the '{' whose '}' seems to be missing.
  TokenFeed(std::span<const Token> tokens, const TypeNames& types, Diagnostics& diagnostics,
            std::optional<size_t> unclosed)
      : tokens_(tokens), types_(types), diagnostics_(diagnostics), unclosed_(unclosed) {}

  // The parser's next symbol; after an error, Sync or SyncBlock from the place to go on.
  Symbol next();

  // Called by the parser when the symbol delivered last fits nowhere.
  void syntax_error(const Parser::context& context);

 private:
  // An open bracket, or the head of if, for, while, switch until its ')'.
  struct Open {
    TokenKind kind;  // LeftBrace, LeftParen, LeftBracket or the keyword
    size_t token;
    bool values;  // a brace after '='
  };
  // Which tokens the parser would have taken.
  struct Expected {
    explicit Expected(const Parser::context& context);
    bool has(Parser::symbol_kind_type kind) const { return set[static_cast<size_t>(kind)]; }
    bool only(Parser::symbol_kind_type kind) const { return has(kind) && count == 1; }
    std::vector<bool> set;
    int count = 0;
  };

  // token_feed.cpp
  Symbol symbol(const Token& token);
  ast::Number number(const Token& token);
  Diagnostic* tell(Diag diag, Span place, std::vector<std::string> words = {});
  void stray();
  void accepted(size_t token);
  void close(TokenKind opener);
  bool inside_braces() const;
  void stop();

  // syntax_error.cpp
  void explain(const Expected& expected);
  std::optional<size_t> ended_if() const;
  std::optional<size_t> comma_of_head() const;
  bool explain_inside(const Expected& expected);
  bool explain_outside(const Expected& expected);
  bool explain_parameters();
  void explain_directive();
  std::string expected_words(const Expected& expected) const;
  std::string found_words() const;
  Note open_brace(const char* text) const;
  const Token& found() const { return tokens_[last_]; }
  const Token& before(size_t distance) const;

  // recovery.cpp
  Symbol resume();
  enum class Place : uint8_t { Next, Block, Body };  // for Sync, SyncBlock, SyncBody
  Symbol sync(size_t at, Place place = Place::Next);
  size_t behind_directive(size_t at) const;
  size_t behind_head(size_t at, size_t head) const;
  size_t behind_statement(size_t at);
  size_t behind_declaration(size_t at, Place& place);
  bool is_function_head(size_t begin, size_t end) const;
  size_t behind_group(size_t brace);
  bool begins_statement(size_t at) const;
  bool begins_declaration(size_t at) const;
  bool continues_here(size_t at) const;

  std::span<const Token> tokens_;
  const TypeNames& types_;
  Diagnostics& diagnostics_;
  std::optional<size_t> unclosed_;
  std::vector<Open> open_;
  std::unordered_map<size_t, size_t> behind_groups_;  // of each '{', once it is asked for
  size_t next_ = 0;                  // token to deliver next
  size_t last_ = SIZE_MAX;           // token delivered last, not yet known to be accepted
  size_t told_ = 0;                  // tokens before it have been delivered, and told what is wrong in them
  size_t declaration_ = 0;           // where the outermost declaration began
  std::optional<size_t> directive_;  // the open #pragma or #declare
  size_t last_error_ = SIZE_MAX;     // token of the last syntax error: never two at one place
  bool fresh_ = true;                // the next token begins a declaration
  bool resuming_ = false;            // next() has to send Sync
  int repeated_ = 0;                 // errors before at the place of this one
  bool semicolon_fits_ = false;      // a ';' would have been right at the error
  bool brace_fits_ = false;          // a '{' would have been
  bool brace_reported_ = false;      // a missing '}' is known
  bool stopped_ = false;             // everything else is left unread
};

}  // namespace ipos::compiler
