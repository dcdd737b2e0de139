// TOML text to a table. Mistakes that the parser must not see are found first (toml_text.hpp). Readers of files include
// this; it needs toml++.
#pragma once

#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "runtime/plant_file/toml_text.hpp"

namespace ipos::runtime {

inline FilePlace place_of(const toml::source_region& region) {
  return {region.begin.line, region.begin.column};
}
inline FilePlace place_of(const toml::node& node) { return place_of(node.source()); }

struct TomlError {
  FilePlace place;
  std::string text;  // for the user
};

// The table of a whole text, or its first mistake.
tl::expected<toml::table, TomlError> read_toml(std::string_view text);

}  // namespace ipos::runtime
