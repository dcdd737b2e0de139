// Where #include looks for a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/preprocess/preprocess.hpp"

namespace ipos::compiler {

struct FoundFile {
  std::string name;  // for messages
  std::string path;  // empty: built in
  std::string text;
  const stdlib::EmbeddedFile* header = nullptr;  // that is built in
};

// Order of IPOSplus p. 179: a name with an explicit path as it stands, else beside the source file, then the
// configured directories; the built-in headers come last (ours). "Beside the source file" is tried for the
// including file first and for the main file then (ours). `searched` receives the places tried.
std::optional<FoundFile> find_include(const std::string& name, const SourceFile& includer,
                                      const SourceFile& main, const PreprocessOptions& options,
                                      std::vector<std::string>& searched);

// The file that a wrong name was probably meant to be: the same apart from capitals, or a built-in header like it;
// empty when there is none.
std::string similar_include(const std::string& name, const SourceFile& includer, const SourceFile& main,
                            const PreprocessOptions& options);

}  // namespace ipos::compiler
