// The parser tells where a value stands; the characters there are replaced. A key that is not there gets a line below the head
// of its table.
#include "tools/campaign/toml_edit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "runtime/plant_file/read_toml.hpp"

namespace ipos::tools::campaign {
namespace {

// toml++ counts characters, not bytes.
size_t offset_of(std::string_view text, const toml::source_position& place) {
  size_t at = 0;
  for (uint32_t line = 1; line < place.line; ++line) at = text.find('\n', at) + 1;
  for (uint32_t column = 1; column < place.column; ++column) {
    ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U) ++at;
  }
  return at;
}

std::string key_text(std::string_view key) {
  const bool bare = !key.empty() && std::ranges::all_of(key, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  });
  return bare ? std::string(key) : fmt::format("\"{}\"", key);
}

std::vector<std::string> parts_of(std::string_view path) {
  std::vector<std::string> parts(1);
  bool quoted = false;
  for (const char c : path) {
    if (c == '"')
      quoted = !quoted;
    else if (c == '.' && !quoted)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

// Of a table that stands on a line of its own; not of one within a line, or one that only dots name.
bool has_head(const toml::table& table, std::string_view text) {
  const size_t at = offset_of(text, table.source().begin);
  return !table.is_inline() && at < text.size() && text[at] == '[';
}

}  // namespace

void TomlEdit::insert_line(uint32_t after, std::string_view line) {
  size_t at = 0;
  for (uint32_t n = 0; n < after; ++n) {
    at = text_.find('\n', at);
    if (at == std::string::npos) {
      text_ += '\n';
      at = text_.size();
      break;
    }
    ++at;
  }
  text_.insert(at, fmt::format("{}\n", line));
  added_.push_back(after + 1);
}

uint32_t TomlEdit::original_line(uint32_t line) const {
  for (auto added = added_.rbegin(); added != added_.rend(); ++added) {
    if (line == *added) return 0;
    if (line > *added) --line;
  }
  return line;
}

void TomlEdit::append(std::string_view text) {
  if (!text_.empty() && text_.back() != '\n') text_ += '\n';
  text_ += text;
}

std::optional<std::string> TomlEdit::set(std::string_view path, std::string_view toml) {
  const auto root = runtime::read_toml(text_);
  if (!root) return root.error().text;
  const std::vector<std::string> parts = parts_of(path);
  const toml::table* table = &*root;
  const toml::table* head = nullptr;  // the innermost table on the way that has a line of its own
  size_t below_head = 0;              // the first part behind it
  for (size_t n = 0;; ++n) {
    const toml::node* node = table->get(parts[n]);
    const bool last = n + 1 == parts.size();
    if (node == nullptr) {
      if (table->is_inline()) {
        std::string rest;
        for (size_t k = n; k < parts.size(); ++k) rest += (k == n ? "" : ".") + key_text(parts[k]);
        const size_t brace = offset_of(text_, table->source().begin) + 1;
        text_.insert(brace, fmt::format(" {} = {}{}", rest, toml, table->empty() ? " " : ","));
        return std::nullopt;
      }
      if (head == nullptr) return fmt::format("the plant has no '{}'", parts[0]);
      std::string rest;
      for (size_t k = below_head; k < parts.size(); ++k) rest += (k == below_head ? "" : ".") + key_text(parts[k]);
      insert_line(head->source().begin.line, fmt::format("{} = {}", rest, toml));
      return std::nullopt;
    }
    if (const toml::array* tables = node->as_array(); tables != nullptr && node->is_array_of_tables()) {
      if (last) return fmt::format("'{}' has several: name one, {}.NAME", parts[n], path);
      auto named = std::find_if(tables->begin(), tables->end(), [&](const toml::node& one) {
        return (*one.as_table())["name"].value<std::string_view>() == parts[n + 1];
      });
      // Those without a name by their number, from 0.
      size_t number = 0;
      const char* const end = parts[n + 1].data() + parts[n + 1].size();
      if (const auto [done, status] = std::from_chars(parts[n + 1].data(), end, number);
          named == tables->end() && status == std::errc() && done == end && number < tables->size())
        named = tables->begin() + static_cast<std::ptrdiff_t>(number);
      if (named == tables->end()) return fmt::format("there is no {} '{}'", parts[n], parts[n + 1]);
      if (++n + 1 == parts.size()) return fmt::format("'{}' is a table; name a key of it", path);
      table = named->as_table();
    } else if (const toml::table* inner = node->as_table()) {
      if (last) return fmt::format("'{}' is a table; name a key of it", path);
      table = inner;
    } else {
      if (!last) return fmt::format("'{}' is a value and has no keys", parts[n]);
      const size_t begin = offset_of(text_, node->source().begin);
      text_.replace(begin, offset_of(text_, node->source().end) - begin, toml);
      return std::nullopt;
    }
    if (has_head(*table, text_)) {
      head = table;
      below_head = n + 1;
    }
  }
}

}  // namespace ipos::tools::campaign
