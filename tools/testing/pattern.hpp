// Shell patterns: of names of tests, and of texts that are expected.
#pragma once

#include <string_view>

namespace ipos::tools::testing {

// Shell pattern with * ? [..], and a backslash in front of what stands for itself; * stands for slashes, too.
bool matches(std::string_view pattern, std::string_view text);
// Whether a filter means the test: such a pattern, or without one of its characters a part of the name.
bool is_chosen(std::string_view filter, std::string_view name);

}  // namespace ipos::tools::testing
