// Plant files for the verbs: read, checked, and the files they name found beside them.
#pragma once

#include <string>
#include <string_view>

#include "runtime/plant_file/plant_file.hpp"
#include "runtime/plant_file/toml_kind.hpp"

namespace ipos::tools {

// *.toml
bool is_plant(std::string_view path);

// Of a file that is no *.toml, or cannot be read: unknown.
runtime::TomlKind kind_of_file(const std::string& path);

// Memory files are relative to the plant file, and so they come back.
runtime::PlantFileResult try_read_plant(const std::string& path);

// For options that take a duration.
std::string check_time(const std::string& text);

// Errors are printed with their places, then a Failure ends the verb.
runtime::PlantFile read_plant(const std::string& path);

}  // namespace ipos::tools
