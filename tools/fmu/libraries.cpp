// The places, tried one after the other.
#include "tools/fmu/libraries.hpp"

#include <cstdlib>

namespace ipos::tools {

namespace fs = std::filesystem;

std::vector<fs::path> library_folders() {
  if (const char* named = std::getenv("IPOS_FMU_LIBRARIES"); named != nullptr && *named != 0) return {named};
  const fs::path own = program_folder();
  if (own.empty()) return {};
  const fs::path above = own.parent_path();
  return {own,           own / "lib",         above / "lib", above / "lib" / "ipos", above / IPOS_LIBRARY_FOLDER / "ipos",
          above.parent_path() / "windows" / "lib"};
}

std::optional<fs::path> find_library(const Platform& platform) {
  for (const fs::path& folder : library_folders()) {
    std::error_code error;
    if (fs::is_regular_file(folder / platform.library, error)) return folder / platform.library;
  }
  return std::nullopt;
}

}  // namespace ipos::tools
