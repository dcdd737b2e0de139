// Headers and blocks in one list.
#include "stdlib/headers.hpp"

#include <algorithm>
#include <vector>

#include "stdlib/spelling.hpp"

namespace ipos::stdlib {

std::span<const EmbeddedFile> built_in_files() {
  static const std::vector<EmbeddedFile> kFiles = [] {
    std::vector<EmbeddedFile> files;
    for (const auto part : {headers::embedded_files(), blocks::embedded_files()})
      files.insert(files.end(), part.begin(), part.end());
    return files;
  }();
  return kFiles;
}

const EmbeddedFile* find_built_in_file(std::string_view name) {
  const std::span<const EmbeddedFile> files = built_in_files();
  const auto found = std::find_if(files.begin(), files.end(),
                                  [&](const EmbeddedFile& file) { return equal_but_for_case(file.name, name); });
  return found == files.end() ? nullptr : &*found;
}

}  // namespace ipos::stdlib
