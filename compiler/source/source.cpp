// Places in files and in macro expansions.
#include "compiler/source/source.hpp"

#include <algorithm>

namespace ipos::compiler {
namespace {

constexpr uint32_t kMacroBit = 0x8000'0000U;

std::vector<uint32_t> find_line_starts(std::string_view text) {
  std::vector<uint32_t> starts{0};
  for (size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1))
    starts.push_back(static_cast<uint32_t>(at + 1));
  return starts;
}

}  // namespace

const SourceFile& SourceMap::add(std::string name, std::string path, std::string text, Location included_at) {
  // One place more than there are bytes, so that "end of file" has a location of its own.
  const uint32_t base =
      files_.empty() ? 1 : files_.back()->base + static_cast<uint32_t>(files_.back()->text.size()) + 1;
  auto file = std::make_unique<SourceFile>();
  file->name = std::move(name);
  file->path = std::move(path);
  file->text = std::move(text);
  file->base = base;
  file->included_at = included_at;
  file->line_starts = find_line_starts(file->text);
  files_.push_back(std::move(file));
  return *files_.back();
}

Location SourceMap::add_expansion(std::string_view macro, Location spelling, Location use) {
  expansions_.push_back({macro, spelling, use});
  return {kMacroBit | static_cast<uint32_t>(expansions_.size() - 1)};
}

const SourceMap::Expansion& SourceMap::expansion(Location at) const {
  return expansions_[at.value & ~kMacroBit];
}

Location SourceMap::spelling(Location at) const {
  while (at.in_macro()) at = expansion(at).spelling;
  return at;
}

Location SourceMap::use(Location at) const {
  while (at.in_macro()) at = expansion(at).use;
  return at;
}

const SourceFile* SourceMap::file_of(Location at) const {
  at = use(at);
  if (!at.valid()) return nullptr;
  const auto behind = std::upper_bound(files_.begin(), files_.end(), at.value,
                                       [](uint32_t value, const auto& file) { return value < file->base; });
  return behind == files_.begin() ? nullptr : std::prev(behind)->get();
}

Position SourceMap::position(Location at) const {
  at = use(at);
  const SourceFile* file = file_of(at);
  if (file == nullptr) return {};
  const uint32_t offset = at.value - file->base;
  const auto behind = std::upper_bound(file->line_starts.begin(), file->line_starts.end(), offset);
  const auto line = static_cast<uint32_t>(behind - file->line_starts.begin());
  return {file, line, offset - file->line_starts[line - 1] + 1};
}

std::string_view SourceMap::line_text(const SourceFile& file, uint32_t line) {
  if (line == 0 || line > file.line_starts.size()) return {};
  std::string_view text = std::string_view(file.text).substr(file.line_starts[line - 1]);
  text = text.substr(0, text.find('\n'));
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

}  // namespace ipos::compiler
