// The flow of tokens through the preprocessor, and the limits that keep hostile input finite.
#include "compiler/preprocess/preprocessor.hpp"

#include <algorithm>

namespace ipos::compiler {
namespace {

constexpr size_t kMaxBytes = 64U << 20U;  // of all files, included ones as often as they are (ours)
constexpr size_t kSignificant = 32;       // characters of a name, IPOSplus p. 190

bool is_utf16(std::string_view text) { return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"); }

}  // namespace

PreprocessedText Preprocessor::run() {
  token_budget_ = options_.max_tokens;
  byte_budget_ = kMaxBytes;
  define_from_command_line();
  run_file(main_);
  Token end;
  end.line_start = true;
  const Location behind{main_.base + static_cast<uint32_t>(main_.text.size())};
  end.span = {behind, behind};
  result_.tokens.push_back(end);
  // Only now: for the directives every word is a name.
  for (Token& token : result_.tokens)
    if (token.kind == TokenKind::Name) token.kind = keyword_kind(token.text);
  return std::move(result_);
}

// -D options are lines of a file of their own, so that messages about them have a place.
void Preprocessor::define_from_command_line() {
  std::string text;
  for (const std::string& option : options_.defines) {
    const size_t equals = option.find('=');
    text += "#define " + option.substr(0, equals) + ' ';
    text += equals == std::string::npos ? "1" : option.substr(equals + 1);
    text += '\n';
  }
  if (!text.empty()) run_file(map_.add("<command line>", "", std::move(text)));
}

void Preprocessor::run_file(const SourceFile& file) {
  open(file);
  while (!files_.empty()) {
    const Token token = read();
    if (token.kind == TokenKind::End)
      close();
    else if (token.kind == TokenKind::Hash && token.line_start)
      directive(token);
    else if (token.kind != TokenKind::Newline)
      live() ? emit(token) : leave_out(token);
  }
}

void Preprocessor::open(const SourceFile& file, std::span<const Token> scanned) {
  const Location start{file.base};
  if (is_utf16(file.text)) {
    diagnostics_.report(Diag::WrongEncoding, {start, start}, {file.name});
    result_.complete = false;
    return;
  }
  if (file.text.size() > byte_budget_) {
    give_up("64 MB of text", {start, start});
    return;
  }
  byte_budget_ -= file.text.size();
  files_.push_back({&file, {}, scanned, {}});
  if (scanned.empty()) files_.back().scanner.emplace(file, diagnostics_);
}

Token Preprocessor::OpenFile::next_scanned() {
  Token token = scanned.front();
  if (scanned.size() > 1) scanned = scanned.subspan(1);  // as a scanner, which gives End again and again
  token.span.begin.value += file->base;
  token.span.end.value += file->base;
  return token;
}

void Preprocessor::close() {
  if (!given_up_)
    for (const Condition& condition : files_.back().conditions)
      diagnostics_.report(Diag::UnterminatedConditional, condition.directive.span,
                          {std::string(condition.directive.text)});
  files_.pop_back();
}

Token Preprocessor::read() {
  if (given_up_) return {};
  Token token = files_.back().next();
  if (token_budget_ == 0) {
    too_much(token.span);
    return {};
  }
  --token_budget_;
  if (token.kind == TokenKind::Name && token.text.size() > kSignificant) {
    const std::string_view whole = token.text;
    token.text = whole.substr(0, kSignificant);
    if (live() && long_names_.insert(whole).second)
      diagnostics_.report(Diag::LongIdentifier, token.span, {std::string(whole), std::string(token.text)});
  }
  return token;
}

Preprocessor::Line Preprocessor::read_line() {
  Line line;
  line.reserve(4);  // most are a #define of one number
  for (Token token = read(); token.kind != TokenKind::Newline && token.kind != TokenKind::End; token = read())
    line.push_back(token);
  return line;
}

void Preprocessor::emit(const Token& token) {
  if (!macros_.expand(token, result_.tokens, token_budget_)) too_much(token.span);
}

// Two words side by side declare, as in `long a, b;`; a word with empty brackets before a '{' is a function.
void Preprocessor::leave_out(const Token& token) {
  if (token.kind != TokenKind::Semicolon && token.kind != TokenKind::LeftBrace && token.kind != TokenKind::RightBrace) {
    left_out_.push_back(token);
    return;
  }
  const Line line = std::move(left_out_);
  left_out_.clear();
  const auto is_name = [&](size_t n) { return n < line.size() && line[n].kind == TokenKind::Name; };
  if (token.kind == TokenKind::LeftBrace && line.size() == 3 && is_name(0) && line[1].kind == TokenKind::LeftParen)
    note_left_out(line[0]);
  if (token.kind != TokenKind::Semicolon || !is_name(0) || !is_name(1)) return;
  for (size_t n = 1; n < line.size(); ++n)
    if (is_name(n) && (is_name(n - 1) || line[n - 1].kind == TokenKind::Comma)) note_left_out(line[n]);
}

void Preprocessor::note_left_out(const Token& name) {
  const std::vector<Condition>& conditions = files_.back().conditions;
  const auto outermost = std::find_if(conditions.begin(), conditions.end(), [](const Condition& each) { return !each.live; });
  result_.record.left_out.try_emplace(name.text, PreprocessRecord::LeftOut{name.span, outermost->directive.span});
}

Preprocessor::Line Preprocessor::expand(const Line& line) {
  Line expanded;
  for (const Token& token : line) {
    if (!macros_.expand(token, expanded, token_budget_)) {
      too_much(token.span);
      break;
    }
  }
  return expanded;
}

bool Preprocessor::live() const {
  return files_.back().conditions.empty() || files_.back().conditions.back().live;
}

void Preprocessor::give_up(std::string limit, Span place) {
  if (!given_up_) diagnostics_.report(Diag::SourceTooLarge, place, {std::move(limit)});
  given_up_ = true;
  result_.complete = false;
}

void Preprocessor::too_much(Span place) { give_up(std::to_string(options_.max_tokens) + " tokens", place); }

PreprocessedText preprocess(SourceMap& map, const SourceFile& main, const PreprocessOptions& options,
                            Diagnostics& diagnostics) {
  return Preprocessor(map, main, options, diagnostics).run();
}

}  // namespace ipos::compiler
