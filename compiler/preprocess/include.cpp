// Search for included files. Names may use the separators of either world.
#include "compiler/preprocess/include.hpp"

#include <algorithm>
#include <cctype>

namespace ipos::compiler {
namespace {

std::string with_slashes(std::string path) {
  std::replace(path.begin(), path.end(), '\\', '/');
  return path;
}

bool is_absolute(const std::string& path) {
  return path.starts_with('/') || (path.size() > 2 && path[1] == ':' && path[2] == '/');
}

// With its slash; empty for a file without a directory.
std::string directory_of(const SourceFile& file) { return file.path.substr(0, file.path.rfind('/') + 1); }

// The built-in headers come from a file system that does not tell cases apart (ours).
bool same_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

}  // namespace

std::optional<FoundFile> find_include(const std::string& name, const SourceFile& includer,
                                      const SourceFile& main, const PreprocessOptions& options,
                                      std::vector<std::string>& searched) {
  const std::string plain = with_slashes(name);
  std::vector<std::string> directories;
  const auto add = [&directories](const std::string& directory) {
    if (std::find(directories.begin(), directories.end(), directory) == directories.end())
      directories.push_back(directory);
  };
  if (is_absolute(plain)) {
    add("");
  } else {
    add(directory_of(includer.path.empty() ? main : includer));
    add(directory_of(main));
    for (const std::string& directory : options.include_dirs)
      add(directory.empty() || directory.ends_with('/') ? directory : directory + '/');
  }
  for (const std::string& directory : directories) {
    std::string path = directory + plain;
    if (options.read_file) {
      if (std::optional<std::string> text = options.read_file(path))
        return FoundFile{path, path, std::move(*text)};
    }
    searched.push_back(directory.empty() ? "the current directory" : directory);
  }
  for (const stdlib::EmbeddedFile& header : options.headers)
    if (same_ignoring_case(header.name, plain)) return FoundFile{name, "", std::string(header.text)};
  searched.emplace_back("the built-in headers");
  return std::nullopt;
}

}  // namespace ipos::compiler
