// TOML, row by row. Texts of several rows are not looked into: plants have none.
#include "tools/lsp/toml_lines.hpp"

namespace ipos::tools::lsp {
namespace {

constexpr std::string_view kTomlBlanks = " \t\r";

}  // namespace

std::string_view trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(kTomlBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kTomlBlanks) - begin + 1);
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (true) {
    const size_t end = text.find('\n');
    lines.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return lines;
    text.remove_prefix(end + 1);
  }
}

std::string_view table_of(std::string_view row) {
  row = trimmed(row.substr(0, row.find('#')));
  if (!row.starts_with('[')) return {};
  const size_t begin = row.find_first_not_of('[');
  const size_t end = row.find(']');
  return begin == std::string_view::npos || end == std::string_view::npos || end < begin
             ? std::string_view{}
             : trimmed(row.substr(begin, end - begin));
}

std::string_view key_of(std::string_view row) {
  const size_t equals = row.find('=');
  return equals == std::string_view::npos ? std::string_view{} : trimmed(row.substr(0, equals));
}

std::string_view value_of(std::string_view row) {
  const auto texts = texts_in(row);
  return texts.empty() ? std::string_view{} : texts.front().text;
}

std::vector<TextInRow> texts_in(std::string_view row) {
  std::vector<TextInRow> found;
  std::string_view key;
  for (size_t n = 0, word = 0; n < row.size(); ++n) {
    const char c = row[n];
    if (c == '#') break;
    if (c == '=') key = trimmed(row.substr(word, n - word));
    if (c == ',' || c == '{' || c == '[') word = n + 1;
    if (c != '"' && c != '\'') continue;
    size_t end = n + 1;
    while (end < row.size() && row[end] != c) end += c == '"' && row[end] == '\\' ? 2 : 1;
    if (end >= row.size()) break;
    if (!key.empty()) found.push_back({key, row.substr(n + 1, end - n - 1)});
    n = end;
  }
  return found;
}

std::vector<TomlTable> tables_of(const std::vector<std::string_view>& lines) {
  std::vector<TomlTable> tables{{{}, 0, 0}};
  for (size_t n = 0; n < lines.size(); ++n) {
    if (const std::string_view name = table_of(lines[n]); !name.empty()) tables.push_back({name, n, n});
    tables.back().end = n + 1;
  }
  return tables;
}

}  // namespace ipos::tools::lsp
