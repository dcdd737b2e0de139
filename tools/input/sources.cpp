// A text a path, for all threads: tests are compiled on several.
#include "tools/input/sources.hpp"

#include <map>
#include <mutex>
#include <utility>

#include "stdlib/headers.hpp"
#include "tools/cli/files.hpp"

namespace ipos::tools {
namespace {

std::mutex kept_mutex;
std::map<std::string, std::string> kept;

}  // namespace

void keep_source(const std::string& path, std::string text) {
  const std::lock_guard lock(kept_mutex);
  kept[path] = std::move(text);
}

std::optional<std::string> read_source(const std::string& path) {
  std::optional<std::string> text = try_read_file(path);
  if (text) keep_source(path, *text);
  return text;
}

std::optional<std::string> source_text(const std::string& path) {
  {
    const std::lock_guard lock(kept_mutex);
    if (const auto known = kept.find(path); known != kept.end()) return known->second;
  }
  if (std::optional<std::string> text = read_source(path)) return text;
  const stdlib::EmbeddedFile* built_in = stdlib::find_built_in_file(path);
  return built_in == nullptr ? std::nullopt : std::optional(std::string(built_in->text));
}

std::string source_line(const std::string& path, size_t line) {
  const std::string text = source_text(path).value_or("");
  size_t begin = 0;
  for (size_t n = 1; n < line && begin != std::string::npos; ++n) {
    begin = text.find('\n', begin);
    if (begin != std::string::npos) ++begin;
  }
  if (line == 0 || begin == std::string::npos) return {};
  std::string found = text.substr(begin, text.find('\n', begin) - begin);
  if (found.ends_with('\r')) found.pop_back();
  return found;
}

bool source_has_changed(const std::string& path) {
  const auto text = source_text(path);
  if (!text) return false;
  const auto now = try_read_file(path);
  return now ? now != text : stdlib::find_built_in_file(path) == nullptr;
}

}  // namespace ipos::tools
