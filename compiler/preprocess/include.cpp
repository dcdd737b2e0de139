// Search for included files. Names may use the separators of either world.
#include "compiler/preprocess/include.hpp"

#include <algorithm>
#include <filesystem>

#include "stdlib/spelling.hpp"

namespace ipos::compiler {
namespace {

std::string with_slashes(std::string path) {
  std::replace(path.begin(), path.end(), '\\', '/');
  return path;
}

bool is_absolute(const std::string& path) {
  return path.starts_with('/') || (path.size() > 2 && path[1] == ':' && path[2] == '/');
}

// Of the paths that this system has.
constexpr const char* kSeparators = std::filesystem::path::preferred_separator == '/' ? "/" : "/\\";

// With its slash; empty for a file without a directory.
std::string directory_of(const SourceFile& file) {
  return file.path.substr(0, file.path.find_last_of(kSeparators) + 1);
}

// Where a file is looked for, each with its slash; "" is the current directory.
std::vector<std::string> directories_for(const std::string& plain, const SourceFile& includer,
                                         const SourceFile& main, const PreprocessOptions& options) {
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
  return directories;
}

}  // namespace

std::optional<FoundFile> find_include(const std::string& name, const SourceFile& includer,
                                      const SourceFile& main, const PreprocessOptions& options,
                                      std::vector<std::string>& searched) {
  const std::string plain = with_slashes(name);
  for (const std::string& directory : directories_for(plain, includer, main, options)) {
    std::string path = directory + plain;
    if (options.read_file) {
      if (std::optional<std::string> text = options.read_file(path))
        return FoundFile{path, path, std::move(*text), nullptr};
    }
    searched.push_back(directory.empty() ? "the current directory" : directory);
  }
  // The built-in headers come from a file system that does not tell cases apart (ours).
  for (const stdlib::EmbeddedFile& header : options.headers)
    if (stdlib::equal_but_for_case(header.name, plain))
      return FoundFile{std::string(header.name), "", std::string(header.text), &header};
  searched.emplace_back("the built-in headers");
  return std::nullopt;
}

std::string similar_include(const std::string& name, const SourceFile& includer, const SourceFile& main,
                            const PreprocessOptions& options) {
  const std::string plain = with_slashes(name);
  const std::string folder = plain.substr(0, plain.rfind('/') + 1);
  const std::string file = plain.substr(folder.size());
  if (options.list_files)
    for (const std::string& directory : directories_for(plain, includer, main, options))
      for (const std::string& found : options.list_files(directory + folder))
        if (stdlib::equal_but_for_case(found, file)) return folder + found;
  std::vector<std::string_view> headers;
  for (const stdlib::EmbeddedFile& header : options.headers) headers.push_back(header.name);
  return std::string(stdlib::nearest(plain, headers));
}

}  // namespace ipos::compiler
