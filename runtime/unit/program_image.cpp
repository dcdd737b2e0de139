// Rows of tables, one by one. A unit that runs no program has no variables; its images are refused elsewhere.
#include "runtime/unit/program_image.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "stdlib/plain_text.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::runtime {

tl::expected<vm::Image, std::string> read_program_image(std::span<const uint8_t> bytes) {
  vm::ImageResult result = vm::read_image(bytes);
  if (result.error != vm::ImageError::None)
    return tl::unexpected(fmt::format("refused at byte {}: {}", result.offset, to_text(result.error)));
  const vm::Image& image = result.image;
  const auto plain = [](const auto& row) { return stdlib::is_plain(row.name); };
  if (!std::all_of(image.symbols.begin(), image.symbols.end(), plain) ||
      !std::all_of(image.functions.begin(), image.functions.end(), plain) ||
      !std::all_of(image.files.begin(), image.files.end(), stdlib::is_plain))
    return tl::unexpected(std::string("refused: a name has control characters"));
  const stdlib::UnitType* unit = stdlib::find_unit(image.unit);
  if (unit != nullptr && unit->tasks != 0)
    for (const vm::Symbol& symbol : image.symbols)
      if (symbol.variable + symbol.count > unit->variables)
        return tl::unexpected(
            fmt::format("refused: symbol '{}' names variables that the unit {} does not have", symbol.name, unit->name));
  return std::move(result.image);
}

}  // namespace ipos::runtime
