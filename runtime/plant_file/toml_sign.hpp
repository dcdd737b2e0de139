// The kind of a table that was read, for the readers of files; it needs toml++ (toml_kind.hpp does not).
#pragma once

#include <initializer_list>
#include <optional>

#include "runtime/plant_file/read_toml.hpp"
#include "runtime/plant_file/toml_kind.hpp"

namespace ipos::runtime {

// The key that a set of parameters begins with (docs/guide/param.md).
inline constexpr std::string_view kParameterSetKey = "ipos-parameters";

struct TomlSign {
  TomlKind kind = TomlKind::Unknown;
  FilePlace place{1, 1};  // of what tells it
};

TomlSign kind_of_toml(const toml::table& root, std::string_view path);

// For a reader that takes only some kinds: nothing, or what is said of a file of another one.
std::optional<TomlError> wrong_kind(const toml::table& root, std::string_view path, std::initializer_list<TomlKind> taken);

}  // namespace ipos::runtime
