// Runs the built `ipos` with arguments, in a folder of its own.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace ipos::tests {

// Some containers have no /dev/pts, and so no pseudo-terminals; tests that need one are skipped there.
inline constexpr const char* kNoPty = "there is no /dev/pts: no pseudo-terminals here";
inline bool has_pty() { return std::filesystem::exists("/dev/pts/ptmx"); }

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

// The program that is tested: that of the build, or the one that IPOS_PROGRAM names in the environment, in which
// tests/mutation has planted a mistake.
const char* ipos_program();

struct CommandResult {
  int exit_code;
  std::string out;
  std::string err;
};

// Runs `ipos ARGUMENTS...`; `directory` is the working folder.
CommandResult run_ipos(const std::vector<std::string>& arguments,
                       const std::filesystem::path& directory = {});

// The same in the background, for verbs that go on until a signal.
class RunningIpos {
 public:
  RunningIpos(const std::vector<std::string>& arguments, const std::filesystem::path& directory = {});
  ~RunningIpos();  // kills it if it still runs
  RunningIpos(const RunningIpos&) = delete;
  RunningIpos& operator=(const RunningIpos&) = delete;

  // Waits until its standard output or its messages contain the text. If it does not come within a minute, the test has failed.
  bool prints(const std::string& text) const;
  bool tells(const std::string& text) const;

  void signal(int number) const;
  CommandResult wait();

 private:
  std::unique_ptr<TemporaryFolder> folder_;
  int child_;
};

// A folder of the project, for example "examples".
std::filesystem::path project(const std::string& path);

std::string read_text(const std::filesystem::path& path);

}  // namespace ipos::tests
