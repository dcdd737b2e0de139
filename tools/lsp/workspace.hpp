// What the server knows: texts open in the editor, the sources of the folders, and their programs as compiled
// last. A program is compiled when somebody asks about it and kept until one of its files changes.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/symbols/index.hpp"
#include "tools/lsp_base/positions.hpp"

namespace ipos::tools::lsp {

using ReadFile = std::function<std::optional<std::string>(const std::string& path)>;

struct Program {
  std::string path;
  compiler::Compilation compiled;
  compiler::ProgramIndex index;
  std::set<std::string> files;  // paths of all its files
};

class Workspace {
 public:
  explicit Workspace(ReadFile read_file) : read_file_(std::move(read_file)) {}

  void set_folders(std::vector<std::string> folders);
  // Options of the client: includeDirs, defines, unit, warnings, atomic. Throws RequestError for wrong ones.
  void set_options(const Json& options);

  void open(const std::string& path, std::string text);
  void change(const std::string& path, const Json& changes);
  void close(const std::string& path);
  // A file changed on disk, appeared or is gone.
  void touched(const std::string& path);

  bool is_open(const std::string& path) const { return documents_.contains(path); }
  std::vector<std::string> open_documents() const;
  // As the editor shows it, else as it is on disk.
  std::optional<std::string> text(const std::string& path) const;

  // The program a file is looked at in: the source itself, or the first program that includes the header; the
  // header as if it were one when there is none.
  const Program& program(const std::string& path);
  // All programs of the folders and the editor.
  std::vector<const Program*> programs();
  std::vector<const Program*> programs_with(const std::string& path);
  // Paths of the plants and tests of the folders and the editor.
  std::vector<std::string> plants();
  // With other texts in place of some files, not kept.
  Program compile(const std::string& path, const std::map<std::string, std::string>& texts = {}) const;

  // Of a source as a unit executes it, or of an image on disk; nothing where it cannot be used.
  std::optional<vm::Image> image(const std::string& path, const stdlib::UnitType* unit) const;

  Encoding encoding = Encoding::Utf16;

 private:
  const Program& cached(const std::string& path);
  void forget(const std::string& path);
  void look_into_folders();
  std::vector<std::string> sources();

  ReadFile read_file_;
  std::vector<std::string> folders_;
  compiler::CompileOptions options_;
  std::map<std::string, std::string> documents_;
  std::map<std::string, std::unique_ptr<Program>> programs_;
  std::optional<std::vector<std::string>> sources_;  // of the folders; nothing: look again
  std::vector<std::string> toml_files_;              // of the folders
};

bool is_program(std::string_view path);

}  // namespace ipos::tools::lsp
