// What a person has done to the plant on the page, in the words of a test: the keys of the [[step]] that does it again
// (docs/guide/testing.md).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/plant/plant.hpp"
#include "tools/debugger/session.hpp"

namespace ipos::tools::serve {

// A text in quotes, and a row `key = "text"` with its line end.
std::string toml_text(std::string_view text);
std::string toml_row(std::string_view key, std::string_view text);

// The rows of the step. A Mistake says why no step does this.
std::string step_text(const runtime::Plant& plant, const debug::Change& change);
// The actions that it knows, those among them that no step does.
std::vector<std::string_view> actions_with_words();

}  // namespace ipos::tools::serve
