// The state of one preprocessing run: open files, open conditions, macros. Used by preprocess() only.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>

#include "compiler/preprocess/macros.hpp"
#include "compiler/preprocess/preprocess.hpp"
#include "compiler/preprocess/scanner.hpp"

namespace ipos::compiler {

class Preprocessor {
 public:
  Preprocessor(SourceMap& map, const SourceFile& main, const PreprocessOptions& options,
               Diagnostics& diagnostics)
      : map_(map),
        main_(main),
        options_(options),
        diagnostics_(diagnostics),
        macros_(map, result_.record.uses) {}

  PreprocessedText run();

 private:
  struct Condition {
    Token directive;   // the #if, for messages
    bool parent_live;  // the text around is compiled
    bool live;         // the current branch is
    bool taken;        // one of the branches was
    bool else_seen = false;
  };
  struct OpenFile {
    const SourceFile* file;
    std::optional<Scanner> scanner;  // nothing for a built-in header, whose tokens are there
    std::span<const Token> scanned;
    std::vector<Condition> conditions;

    Token next() { return scanner ? scanner->next() : next_scanned(); }
    Token next_scanned();
    Token header_name() { return scanner ? scanner->header_name() : next_scanned(); }
  };
  using Line = std::vector<Token>;

  // preprocessor.cpp: the flow of tokens.
  void define_from_command_line();
  void run_file(const SourceFile& file);
  void open(const SourceFile& file, std::span<const Token> scanned = {});
  void close();
  Token read();
  Line read_line();
  void emit(const Token& token);
  Line expand(const Line& line);
  bool live() const;
  void leave_out(const Token& token);
  void note_left_out(const Token& name);
  void give_up(std::string limit, Span place);
  void too_much(Span place);

  // directives.cpp: one function a directive; `directive` is the word after the #.
  void directive(const Token& hash);
  void define(const Token& directive);
  void undefine(const Token& directive);
  void include(const Token& directive);
  void declare(const Token& directive);
  void pragma(const Token& directive);
  void user_error(const Token& directive);
  bool macro_name(const Token& directive, const Line& line);
  void macro_used(const Token& name);
  void no_more(const Token& directive, const Line& line, size_t used);

  // conditions.cpp
  bool conditional(const Token& directive);
  void open_condition(const Token& directive);
  void next_branch(const Token& directive);
  void end_condition(const Token& directive);
  bool holds(const Token& directive, const Line& line);
  Line replace_defined(const Token& directive, const Line& line, bool& good);

  SourceMap& map_;
  const SourceFile& main_;
  const PreprocessOptions& options_;
  Diagnostics& diagnostics_;
  PreprocessedText result_;
  Macros macros_;
  std::vector<OpenFile> files_;
  Line left_out_;  // tokens of the declaration or statement that is being left out
  std::set<std::string_view> long_names_;  // those warned of
  size_t token_budget_ = 0;
  size_t byte_budget_ = 0;
  bool given_up_ = false;
};

}  // namespace ipos::compiler
