// All directives except conditions. Each function reads its line to the end.
#include <algorithm>

#include "compiler/preprocess/include.hpp"
#include "compiler/preprocess/preprocessor.hpp"
#include "compiler/preprocess/scanned_header.hpp"
#include "stdlib/spelling.hpp"

namespace ipos::compiler {
namespace {

constexpr size_t kMaxIncludeDepth = 64;  // ours

bool same_text(std::span<const Token> a, std::span<const Token> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Token& x, const Token& y) { return x.text == y.text; });
}

// What tells two files from each other: the place read from, or the name of a built-in header.
const std::string& identity(const std::string& path, const std::string& name) {
  return path.empty() ? name : path;
}

}  // namespace

void Preprocessor::directive(const Token& hash) {
  struct Row {
    std::string_view word;
    void (Preprocessor::*run)(const Token&);
  };
  static constexpr Row kRows[] = {
      {"define", &Preprocessor::define},   {"undef", &Preprocessor::undefine},
      {"include", &Preprocessor::include}, {"declare", &Preprocessor::declare},
      {"pragma", &Preprocessor::pragma},   {"error", &Preprocessor::user_error},
  };
  Token word = read();
  if (word.kind == TokenKind::Newline || word.kind == TokenKind::End) return;  // a lone # is nothing, as in C
  word.span.begin = hash.span.begin;
  if (conditional(word)) return;
  const auto* row = std::find_if(std::begin(kRows), std::end(kRows),
                                 [&word](const Row& candidate) { return candidate.word == word.text; });
  if (!live() || row == std::end(kRows)) {
    if (live()) {
      Diagnostic& message = diagnostics_.report(Diag::UnknownDirective, word.span, {std::string(word.text)});
      std::vector<std::string_view> known = {"if", "ifdef", "ifndef", "elif", "else", "endif"};
      for (const Row& candidate : kRows) known.push_back(candidate.word);
      const std::string_view best = stdlib::nearest(word.text, known);
      if (!best.empty()) message.notes.push_back({{}, "did you mean '#" + std::string(best) + "'?"});
    }
    left_out_.clear();
    const Line line = read_line();
    if (!live() && word.text == "define" && !line.empty() && line[0].kind == TokenKind::Name) note_left_out(line[0]);
    return;
  }
  (this->*row->run)(word);
}

bool Preprocessor::macro_name(const Token& directive, const Line& line) {
  if (line.empty() || line[0].kind != TokenKind::Name) {
    const Span place = line.empty() ? directive.span : line[0].span;
    if (!line.empty() && line[0].kind == TokenKind::BadName)
      diagnostics_.report(Diag::BadIdentifier, place, {std::string(line[0].text)});
    else
      diagnostics_.report(Diag::ExpectedMacroName, place, {std::string(directive.text)});
    return false;
  }
  if (line[0].text == "defined") {
    diagnostics_.report(Diag::ReservedMacroName, line[0].span, {std::string(line[0].text)});
    return false;
  }
  return true;
}

// In #undef, #ifdef and after `defined`.
void Preprocessor::macro_used(const Token& name) {
  if (const Macro* macro = macros_.find(name.text)) result_.record.uses.push_back({name.span, macro->name});
}

void Preprocessor::no_more(const Token& directive, const Line& line, size_t used) {
  if (line.size() > used)
    diagnostics_.report(Diag::ExtraTokens, {line[used].span.begin, line.back().span.end},
                        {std::string(directive.text)});
}

void Preprocessor::define(const Token& directive) {
  Line line = read_line();
  if (!macro_name(directive, line)) return;
  const Token name = line[0];
  if (line.size() > 1 && line[1].kind == TokenKind::LeftParen && !line[1].spaced) {
    diagnostics_.report(Diag::MacroParameters, {name.span.begin, line[1].span.end}, {std::string(name.text)});
    return;
  }
  line.erase(line.begin());
  const Macro* old = macros_.find(name.text);
  if (old != nullptr && !same_text(old->body, line)) {
    Diagnostic& warning = diagnostics_.report(Diag::MacroRedefined, name.span, {std::string(name.text)});
    warning.notes.push_back({old->name, "the former text is here"});
  }
  result_.record.definitions.push_back({name.span, std::move(line)});
  macros_.define(name.text, {name.span, result_.record.definitions.back().body});
}

void Preprocessor::undefine(const Token& directive) {
  const Line line = read_line();
  if (!macro_name(directive, line)) return;
  macro_used(line[0]);
  macros_.undefine(line[0].text);
  no_more(directive, line, 1);
}

void Preprocessor::include(const Token& directive) {
  const Token header = files_.back().header_name();
  const bool line_ended = header.kind == TokenKind::Newline || header.kind == TokenKind::End;
  const Line rest = line_ended ? Line{} : read_line();
  if (header.kind != TokenKind::HeaderName || header.text.size() < 3) {
    diagnostics_.report(Diag::IncludeSyntax, line_ended ? directive.span : header.span);
    result_.complete = false;
    return;
  }
  no_more(directive, rest, 0);

  const std::string name(header.text.substr(1, header.text.size() - 2));
  std::vector<std::string> searched;
  std::optional<FoundFile> found = find_include(name, *files_.back().file, main_, options_, searched);
  if (!found) {
    std::string places;
    for (const std::string& place : searched) places += (places.empty() ? "" : ", ") + place;
    Diagnostic& message = diagnostics_.report(Diag::IncludeNotFound, header.span, {name});
    const std::string similar = similar_include(name, *files_.back().file, main_, options_);
    if (!similar.empty()) message.notes.push_back({{}, "did you mean '" + similar + "'?"});
    message.notes.push_back({{}, "searched: " + places});
    result_.complete = false;
    return;
  }
  // Guards may stop a file that includes itself; only the third time it is a cycle for certain.
  const std::string& wanted = identity(found->path, found->name);
  const auto times = std::count_if(files_.begin(), files_.end(), [&wanted](const OpenFile& open) {
    return identity(open.file->path, open.file->name) == wanted;
  });
  if (times > 1 || files_.size() > kMaxIncludeDepth) {
    if (times > 1)
      diagnostics_.report(Diag::IncludeCycle, header.span, {name});
    else
      diagnostics_.report(Diag::IncludeDepth, header.span, {std::to_string(kMaxIncludeDepth)});
    given_up_ = true;
    result_.complete = false;
    return;
  }
  if (found->text.size() > byte_budget_) {
    give_up("64 MB of text", header.span);
    return;
  }
  const SourceFile& file =
      map_.add(std::move(found->name), std::move(found->path), std::move(found->text), header.span.begin);
  result_.record.includes.push_back({header.span, &file});
  open(file, found->header != nullptr ? scanned_header(*found->header) : std::span<const Token>());
}

// The new name is taken as written, all after it with macros expanded.
void Preprocessor::declare(const Token& directive) {
  const Line line = read_line();
  Token mark = directive;
  mark.kind = TokenKind::Declare;
  result_.tokens.push_back(mark);
  Location end = directive.span.end;
  for (size_t i = 0; i < line.size(); ++i) {
    if (i == 0)
      result_.tokens.push_back(line[i]);
    else
      emit(line[i]);
    end = line[i].span.end;
  }
  result_.tokens.push_back({TokenKind::DirectiveEnd, false, false, {end, end}, {}});
}

void Preprocessor::pragma(const Token& directive) {
  static constexpr std::string_view kKnown[] = {"var", "globals", "initials", "list"};
  const Line line = read_line();
  if (line.empty() || std::find(std::begin(kKnown), std::end(kKnown), line[0].text) == std::end(kKnown)) {
    diagnostics_.report(Diag::UnknownPragma, line.empty() ? directive.span : line[0].span,
                        {line.empty() ? "" : std::string(line[0].text)});
    return;
  }
  Token mark = directive;
  mark.kind = TokenKind::Pragma;
  result_.tokens.push_back(mark);
  result_.tokens.push_back(line[0]);
  for (size_t i = 1; i < line.size(); ++i) emit(line[i]);
  const Location end = line.back().span.end;
  result_.tokens.push_back({TokenKind::DirectiveEnd, false, false, {end, end}, {}});
}

void Preprocessor::user_error(const Token& directive) {
  const Line line = read_line();
  std::string text;
  Span place = directive.span;
  if (!line.empty()) {
    const SourceFile& file = *files_.back().file;
    place.end = line.back().span.end;
    text = file.text.substr(line[0].span.begin.value - file.base, place.end.value - line[0].span.begin.value);
  }
  diagnostics_.report(Diag::UserError, place, {text});
}

}  // namespace ipos::compiler
