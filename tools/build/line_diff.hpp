// The difference of two texts line by line, in the unified form that patch reads.
#pragma once

#include <string>
#include <string_view>

namespace ipos::tools {

// Empty when the texts are equal. Three lines of context around each change.
std::string unified_diff(std::string_view name, std::string_view before, std::string_view after);

}  // namespace ipos::tools
