// Files of mode 0600, written aside and renamed.
#include "tools/serve/state_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>

#include "tools/cli/whole_bytes.hpp"

namespace ipos::tools::serve {
namespace {

class File {
 public:
  explicit File(int number) : number_(number) {}
  ~File() {
    if (number_ >= 0) close(number_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  explicit operator bool() const { return number_ >= 0; }
  int number() const { return number_; }

 private:
  int number_;
};

std::filesystem::path home() {
  if (const char* named = std::getenv("HOME"); named != nullptr && *named == '/') return named;
  const passwd* user = getpwuid(geteuid());
  return user != nullptr && user->pw_dir != nullptr ? user->pw_dir : "";
}

}  // namespace

const char* const kStateVariable = "XDG_STATE_HOME";

// A relative path in the variable is to be ignored (XDG Base Directory Specification).
std::filesystem::path state_folder() {
  const char* named = std::getenv(kStateVariable);
  std::filesystem::path folder;
  if (named != nullptr && *named == '/')
    folder = named;
  else if (const auto of_user = home(); !of_user.empty())
    folder = of_user / ".local" / "state";
  if (folder.empty()) return {};
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  folder /= "ipos";
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) return {};
  return std::filesystem::is_directory(folder, error) ? folder : std::filesystem::path{};
}

std::optional<std::string> read_state(const std::string& name) {
  const std::filesystem::path folder = state_folder();
  if (folder.empty()) return std::nullopt;
  const File file(open((folder / name).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat about {};
  if (!file || fstat(file.number(), &about) != 0 || !S_ISREG(about.st_mode) || about.st_uid != geteuid() ||
      (about.st_mode & 077) != 0 || about.st_size > static_cast<off_t>(kLongestState))
    return std::nullopt;
  std::string text;
  std::array<char, 4096> part{};
  for (;;) {
    const ssize_t count = read(file.number(), part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 || text.size() > kLongestState) return std::nullopt;
    if (count == 0) return text;
    text.append(part.data(), static_cast<size_t>(count));
  }
}

bool write_state(const std::string& name, std::string_view text) {
  const std::filesystem::path folder = state_folder();
  if (folder.empty() || text.size() > kLongestState) return false;
  const std::filesystem::path aside = folder / fmt::format(".{}.{}.tmp", name, getpid());
  unlink(aside.c_str());  // of a killed one that had this number
  bool written = false;
  {
    const File file(open(aside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
    written = file && write_all(file.number(), text.data(), text.size()) && fsync(file.number()) == 0;
  }
  written = written && rename(aside.c_str(), (folder / name).c_str()) == 0;
  if (!written) unlink(aside.c_str());
  return written;
}

StateLock::StateLock(const std::string& name) {
  const std::filesystem::path folder = state_folder();
  if (folder.empty()) return;
  const int file = open((folder / fmt::format(".{}.lock", name)).c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  while (file >= 0 && flock(file, LOCK_EX) != 0 && errno == EINTR) continue;
  file_ = file;
}

StateLock::~StateLock() {
  if (file_ >= 0) close(static_cast<int>(file_));
}

void remove_state(const std::string& name) {
  if (const std::filesystem::path folder = state_folder(); !folder.empty()) unlink((folder / name).c_str());
}

}  // namespace ipos::tools::serve
