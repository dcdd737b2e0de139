// Runs the built `ipos` with arguments, in a folder of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ipos::tests {

// Some containers have no /dev/pts, and so no pseudo-terminals; tests that need one are skipped there.
inline constexpr const char* kNoPty = "there is no /dev/pts: no pseudo-terminals here";
inline bool has_pty() { return std::filesystem::exists("/dev/pts/ptmx"); }

struct CommandResult {
  int exit_code;
  std::string out;
  std::string err;
};

// Runs `ipos ARGUMENTS...`; `directory` is the working folder.
CommandResult run_ipos(const std::vector<std::string>& arguments,
                       const std::filesystem::path& directory = {});

// A folder of the project, for example "examples".
std::filesystem::path project(const std::string& path);

// A fresh empty folder that is removed at the end of its life.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  // Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

std::string read_text(const std::filesystem::path& path);

}  // namespace ipos::tests
