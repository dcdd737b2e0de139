// The line table: each entry holds up to the next one.
#include "runtime/commands/source_places.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime {

std::string source_place(const vm::Image& image, uint32_t address) {
  const auto next =
      std::upper_bound(image.lines.begin(), image.lines.end(), address,
                       [](uint32_t at, const vm::LineEntry& entry) { return at < entry.address; });
  if (next == image.lines.begin()) return {};
  const vm::LineEntry& entry = *(next - 1);
  return fmt::format("{}:{}:{}", image.files[entry.file], entry.line, entry.column);
}

}  // namespace ipos::runtime
