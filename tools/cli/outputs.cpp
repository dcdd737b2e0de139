// Replacing by rename(2), which is one step for everybody who looks.
#include "tools/cli/outputs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>

#include "runtime/os_port/descriptor.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"

namespace ipos::tools {
namespace {

namespace fs = std::filesystem;
using runtime::Descriptor;

constexpr int kMostLinks = 40;      // as the system's own limit
constexpr size_t kNameLimit = 200;  // of 255, for what is added

[[noreturn]] void fail(const std::string& path, int error) {
  throw Failure(kIoError, fmt::format("{}: {}", path, std::strerror(error)));
}

void refuse_input(const std::string& path) {
  if (is_input(path)) throw Failure(kUsage, fmt::format("{}: is an input, and would be overwritten", path));
}

// Something that is there and is no regular file; folders, too.
bool is_special(const std::string& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode);
}

// What the links at the end of the path lead to, which need not exist yet.
std::string behind_links(const std::string& path) {
  fs::path at(path);
  for (int links = 0;; ++links) {
    std::error_code none;
    const fs::path next = fs::read_symlink(at, none);
    if (none) return at.string();
    if (links == kMostLinks) fail(path, ELOOP);
    at = next.is_absolute() ? next : at.parent_path() / next;
  }
}

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

void write_all(const Descriptor& file, std::string_view bytes, const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t count = write(file.get(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, errno);
    bytes.remove_prefix(static_cast<size_t>(count));
  }
}

// A pipe that nobody reads is an error here, and blocks nobody.
Descriptor open_special(const std::string& path) {
  Descriptor file(open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!file.is_open()) fail(path, errno);
  fcntl(file.get(), F_SETFL, fcntl(file.get(), F_GETFL) & ~O_NONBLOCK);
  return file;
}

// A new file beside `target`; removed again unless it takes its place.
class Beside {
 public:
  explicit Beside(const std::string& target) {
    const fs::path path(target);
    const std::string name = path.filename().string().substr(0, kNameLimit);
    for (int number = 0; !file_.is_open(); ++number) {
      path_ = (path.parent_path() / fmt::format(".{}.{}.{}.tmp", name, getpid(), number)).string();
      file_ = Descriptor(open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
      if (!file_.is_open() && errno != EEXIST) fail(target, errno);
    }
  }
  ~Beside() {
    if (!path_.empty()) unlink(path_.c_str());
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  const Descriptor& file() const { return file_; }

  void replace(const std::string& target) {
    struct stat old {};
    if (stat(target.c_str(), &old) == 0) {
      // The owner is kept where that is allowed, the mode always; in this order, as a new owner clears bits.
      if (fchown(file_.get(), old.st_uid, old.st_gid) != 0) errno = 0;
      if (fchmod(file_.get(), old.st_mode & 07777U) != 0) fail(target, errno);
    }
    if (fsync(file_.get()) != 0 || rename(path_.c_str(), target.c_str()) != 0) fail(target, errno);
    path_.clear();
    const Descriptor folder(open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.is_open()) fsync(folder.get());
  }

 private:
  std::string path_;
  Descriptor file_;
};

// Why `target` could not be replaced; 0 when it can.
int obstacle(const std::string& target) {
  struct stat info {};
  if (stat(target.c_str(), &info) == 0 && access(target.c_str(), W_OK) != 0) return errno;
  return access(folder_of(target).c_str(), W_OK | X_OK) == 0 ? 0 : errno;
}

}  // namespace

bool is_standard_output(const std::string& path) { return path == "-" || path == "/dev/stdout"; }

void replace_file(const std::string& path, std::string_view bytes) {
  refuse_input(path);
  rewrite_file(path, bytes);
}

void replace_file(const std::string& path, std::span<const uint8_t> bytes) {
  replace_file(path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void rewrite_file(const std::string& path, std::string_view bytes) {
  if (is_standard_output(path)) {
    fmt::print("{}", bytes);
  } else if (is_special(path)) {
    write_all(open_special(path), bytes, path);
  } else {
    const std::string target = behind_links(path);
    if (const int error = obstacle(target)) fail(path, error);
    Beside beside(target);
    write_all(beside.file(), bytes, path);
    beside.replace(target);
  }
}

void check_output(const std::string& path) {
  if (path.empty() || is_standard_output(path)) return;
  refuse_input(path);
  if (is_special(path))
    open_special(path);
  else if (const int error = obstacle(behind_links(path)))
    fail(path, error);
}

LogOutput::LogOutput(const std::string& path) : path_(path) {
  if (path.empty()) return;
  if (is_standard_output(path)) {
    out_ = &std::cout;
    return;
  }
  check_output(path);
  file_.open(path, std::ios::binary);
  if (!file_) fail(path, errno);
  out_ = &file_;
}

void LogOutput::flush() {
  if (out_ != nullptr) out_->flush();
}

void LogOutput::finish() {
  errno = 0;
  if (out_ != nullptr && !out_->flush()) fail(path_, errno == 0 ? EIO : errno);
}

}  // namespace ipos::tools
