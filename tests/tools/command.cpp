// Child processes by fork and exec, output through files.
#include "tests/tools/command.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "tests/harness/reach.hpp"

namespace ipos::tests {

namespace fs = std::filesystem;

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "ipos-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string TemporaryFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return (path_ / name).string();
}

const char* ipos_program() {
  const char* other = std::getenv("IPOS_PROGRAM");
  return other != nullptr ? other : IPOS_PROGRAM;
}

RunningIpos::RunningIpos(const std::vector<std::string>& arguments, const fs::path& directory)
    : folder_(std::make_unique<TemporaryFolder>()) {
  goes_through(kVerb);
  const std::string out = (folder_->path() / "out").string();
  const std::string err = (folder_->path() / "err").string();
  child_ = fork();
  if (child_ < 0) throw std::runtime_error("fork failed");
  if (child_ > 0) return;
  const int out_file = open(out.c_str(), O_WRONLY | O_CREAT, 0600);
  const int err_file = open(err.c_str(), O_WRONLY | O_CREAT, 0600);
  const int null_file = open("/dev/null", O_RDONLY);
  if (!directory.empty() && chdir(directory.c_str()) != 0) _exit(126);
  setenv("XDG_CACHE_HOME", folder_->path().c_str(),
         0);  // nothing in that of the user, unless a test says where
  dup2(null_file, 0);
  dup2(out_file, 1);
  dup2(err_file, 2);
  std::vector<char*> argv{const_cast<char*>("ipos")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv(ipos_program(), argv.data());
  _exit(127);
}

RunningIpos::~RunningIpos() {
  if (child_ <= 0) return;
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

namespace {

bool comes(const fs::path& file, const std::string& text) {
  for (int n = 0; n < 6000; ++n) {
    if (read_text(file).find(text) != std::string::npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ADD_FAILURE() << "'" << text << "' has not come within a minute; there is: " << read_text(file);
  return false;
}

}  // namespace

bool RunningIpos::prints(const std::string& text) const { return comes(folder_->path() / "out", text); }
bool RunningIpos::tells(const std::string& text) const { return comes(folder_->path() / "err", text); }
void RunningIpos::signal(int number) const { kill(child_, number); }

CommandResult RunningIpos::wait() {
  int status = 0;
  waitpid(child_, &status, 0);
  child_ = 0;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          read_text(folder_->path() / "out"), read_text(folder_->path() / "err")};
}

CommandResult run_ipos(const std::vector<std::string>& arguments, const fs::path& directory) {
  return RunningIpos(arguments, directory).wait();
}

fs::path project(const std::string& path) { return fs::path(IPOS_SOURCE_DIR) / path; }

}  // namespace ipos::tests
