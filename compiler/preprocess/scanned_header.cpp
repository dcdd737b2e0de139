// Scanning as the preprocessor would: what follows #include is a name of a file.
#include "compiler/preprocess/scanned_header.hpp"

#include <mutex>
#include <vector>

#include "compiler/preprocess/scanner.hpp"
#include "stdlib/headers.hpp"

namespace ipos::compiler {
namespace {

std::vector<Token> scan(const stdlib::EmbeddedFile& header) {
  SourceFile file;
  file.name = header.name;
  file.text = header.text;
  Diagnostics none;  // a test holds our headers free of messages
  Scanner scanner(file, none);
  std::vector<Token> tokens;
  tokens.reserve(header.text.size() / 8);
  bool names_file = false;
  do {
    Token token = names_file ? scanner.header_name() : scanner.next();
    names_file = token.text == "include" && !tokens.empty() && tokens.back().kind == TokenKind::Hash;
    token.text = header.text.substr(token.span.begin.value, token.span.end.value - token.span.begin.value);
    tokens.push_back(token);
  } while (tokens.back().kind != TokenKind::End);
  return tokens;
}

}  // namespace

std::span<const Token> scanned_header(const stdlib::EmbeddedFile& header) {
  struct Scanned {
    std::once_flag once;
    std::vector<Token> tokens;
  };
  static std::vector<Scanned> all(stdlib::built_in_files().size());
  const std::span<const stdlib::EmbeddedFile> ours = stdlib::built_in_files();
  for (size_t n = 0; n < ours.size(); ++n) {
    if (&ours[n] != &header) continue;
    std::call_once(all[n].once, [&] { all[n].tokens = scan(header); });
    return all[n].tokens;
  }
  return {};
}

}  // namespace ipos::compiler
