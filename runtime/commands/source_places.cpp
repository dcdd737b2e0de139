// The line table: each entry holds up to the next one.
#include "runtime/commands/source_places.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime {

namespace {

const vm::LineEntry* entry_of(const vm::Image& image, uint32_t address) {
  const auto next =
      std::upper_bound(image.lines.begin(), image.lines.end(), address,
                       [](uint32_t at, const vm::LineEntry& entry) { return at < entry.address; });
  return next == image.lines.begin() ? nullptr : &*(next - 1);
}

}  // namespace

std::string source_place(const vm::Image& image, uint32_t address) {
  const vm::LineEntry* entry = entry_of(image, address);
  if (entry == nullptr) return {};
  return fmt::format("{}:{}:{}", image.files[entry->file], entry->line, entry->column);
}

uint32_t source_line(const vm::Image& image, uint32_t address) {
  const vm::LineEntry* entry = entry_of(image, address);
  return entry == nullptr ? 0 : entry->line;
}

}  // namespace ipos::runtime
