// Replacing by rename(2), which is one step for everybody who looks.
#include "tools/cli/os_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>

namespace ipos::tools {
namespace {

using runtime::Descriptor;

std::optional<FileIdentity> look_at(int folder, const char* path, int flags) {
  struct statx info {};
  if (statx(folder, path, flags, STATX_INO | STATX_BTIME, &info) != 0) return std::nullopt;
  const bool keeps_time = (info.stx_mask & STATX_BTIME) != 0;
  return FileIdentity{makedev(info.stx_dev_major, info.stx_dev_minor), info.stx_ino,
                      keeps_time ? info.stx_btime.tv_sec : 0, keeps_time ? info.stx_btime.tv_nsec : 0};
}

void sync_folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const Descriptor there(open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (there.is_open()) fsync(there.get());
}

}  // namespace

std::optional<FileIdentity> identity_of(const Descriptor& file) {
  return look_at(file.get(), "", AT_EMPTY_PATH);
}

std::optional<FileIdentity> identity_of(const std::string& path) {
  return look_at(AT_FDCWD, path.c_str(), 0);
}

bool look_at(const std::string& path, struct stat& info) { return stat(path.c_str(), &info) == 0; }

Descriptor open_to_read(const std::string& path) {
  return Descriptor(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
}

// A pipe that nobody reads is an error here, and blocks nobody.
Descriptor open_to_write(const std::string& path) {
  Descriptor file(open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (file.is_open()) fcntl(file.get(), F_SETFL, fcntl(file.get(), F_GETFL) & ~O_NONBLOCK);
  return file;
}

Descriptor open_new(const std::string& path) {
  return Descriptor(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
}

void hold(const Descriptor& file) { flock(file.get(), LOCK_EX | LOCK_NB); }

// The process is asked for first: a file that was made this moment is not held yet. The lock tells of processes that
// have a number of another container.
bool is_written(const std::string& path, int64_t process) {
  if (process <= 0 || kill(static_cast<pid_t>(process), 0) == 0 || errno != ESRCH) return true;
  const Descriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC));
  return !file.is_open() || flock(file.get(), LOCK_EX | LOCK_NB) != 0;
}

bool put_in_place(Descriptor file, const std::string& from, const std::string& to) {
  struct stat old {};
  if (stat(to.c_str(), &old) == 0) {
    // The owner is kept where that is allowed, the mode always; in this order, as a new owner clears bits.
    if (fchown(file.get(), old.st_uid, old.st_gid) != 0) errno = 0;
    if (fchmod(file.get(), old.st_mode & 07777U) != 0) return false;
  }
  if (fsync(file.get()) != 0 || rename(from.c_str(), to.c_str()) != 0) return false;
  sync_folder_of(to);
  return true;
}

bool readable(int file, int milliseconds) {
  pollfd waiting{file, POLLIN, 0};
  return poll(&waiting, 1, milliseconds) > 0;
}

Descriptor open_without_name() {
  std::string name = P_tmpdir "/ipos-XXXXXX";
  Descriptor file(mkostemp(name.data(), O_CLOEXEC));
  if (file.is_open()) unlink(name.c_str());
  return file;
}

std::optional<std::string> make_folder(const std::string& beginning) {
  std::string name = beginning + "XXXXXX";
  return mkdtemp(name.data()) == nullptr ? std::nullopt : std::optional(name);
}

bool may_write(const std::string& path) { return access(path.c_str(), W_OK) == 0; }

bool may_make_files_in(const std::string& folder) { return access(folder.c_str(), W_OK | X_OK) == 0; }

}  // namespace ipos::tools
