// Marks in sources: `// equivalent: reason` behind a statement says that a mistake in it cannot be seen.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace ipos::tools::mutants {

struct Mark {
  uint32_t column = 0;
  std::string reason;
};

// By line, from 1.
std::map<uint32_t, Mark> marks_of(std::string_view text);

}  // namespace ipos::tools::mutants
