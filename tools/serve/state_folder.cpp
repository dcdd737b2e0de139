// Files of mode 0600, written aside and renamed.
#include "tools/serve/state_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>

namespace ipos::tools::serve {
namespace {

constexpr size_t kLongest = 512 * 1024;  // of a file: what is longer is neither written nor read
constexpr size_t kReadablePart = 40;    // characters of a name, the last ones

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

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<size_t>(count));
  }
  return true;
}

}  // namespace

// A relative path in the variable is to be ignored (XDG Base Directory Specification).
std::filesystem::path state_folder() {
  const char* named = std::getenv("XDG_STATE_HOME");
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

// FNV-1a, 64 bits: it need only tell the few files of one user apart.
std::string state_name(std::string_view kind, std::string_view of) {
  uint64_t sum = 0xCBF29CE484222325;
  for (const char c : of) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  std::string readable(of.substr(of.size() - std::min(of.size(), kReadablePart)));
  for (char& c : readable)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return fmt::format("{}-{}-{:016x}", kind, readable, sum);
}

std::optional<std::string> read_state(const std::string& name) {
  const std::filesystem::path folder = state_folder();
  if (folder.empty()) return std::nullopt;
  const File file(open((folder / name).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat about {};
  if (!file || fstat(file.number(), &about) != 0 || !S_ISREG(about.st_mode) || about.st_uid != geteuid() ||
      (about.st_mode & 077) != 0 || about.st_size > static_cast<off_t>(kLongest))
    return std::nullopt;
  std::string text;
  std::array<char, 4096> part{};
  for (;;) {
    const ssize_t count = read(file.number(), part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 || text.size() > kLongest) return std::nullopt;
    if (count == 0) return text;
    text.append(part.data(), static_cast<size_t>(count));
  }
}

bool write_state(const std::string& name, std::string_view text) {
  const std::filesystem::path folder = state_folder();
  if (folder.empty() || text.size() > kLongest) return false;
  const std::filesystem::path aside = folder / fmt::format(".{}.{}.tmp", name, getpid());
  unlink(aside.c_str());  // of a killed one that had this number
  bool written = false;
  {
    const File file(open(aside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
    written = file && write_all(file.number(), text) && fsync(file.number()) == 0;
  }
  written = written && rename(aside.c_str(), (folder / name).c_str()) == 0;
  if (!written) unlink(aside.c_str());
  return written;
}

StateLock::StateLock(const std::string& name) {
  const std::filesystem::path folder = state_folder();
  if (folder.empty()) return;
  file_ = open((folder / fmt::format(".{}.lock", name)).c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  while (file_ >= 0 && flock(file_, LOCK_EX) != 0 && errno == EINTR) continue;
}

StateLock::~StateLock() {
  if (file_ >= 0) close(file_);
}

void remove_state(const std::string& name) {
  if (const std::filesystem::path folder = state_folder(); !folder.empty()) unlink((folder / name).c_str());
}

}  // namespace ipos::tools::serve
