// What must be looked at in a TOML text before the parser sees it.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace ipos::runtime {

// Where something stands in a file, from 1; 0 when it does not stand there.
struct FilePlace {
  uint32_t line = 0;
  uint32_t column = 0;
};

// The first byte beyond ASCII outside of texts and comments, where TOML allows none; the parser must not see
// it (toml++ 3.3 has undefined behaviour there). Nothing when there is none.
std::optional<FilePlace> stray_character(std::string_view text);

}  // namespace ipos::runtime
