// The file system of emscripten in memory: one process, which nobody interrupts.
#include "tools/cli/os_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace ipos::tools {

using runtime::Descriptor;

namespace {

FileIdentity identity(const struct stat& info) {
  return {info.st_dev, info.st_ino, info.st_ctim.tv_sec, static_cast<uint32_t>(info.st_ctim.tv_nsec)};
}

}  // namespace

std::optional<FileIdentity> identity_of(const Descriptor& file) {
  struct stat info {};
  if (fstat(file.get(), &info) != 0) return std::nullopt;
  return identity(info);
}

std::optional<FileIdentity> identity_of(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return std::nullopt;
  return identity(info);
}

bool look_at(const std::string& path, struct stat& info) { return stat(path.c_str(), &info) == 0; }

Descriptor open_to_read(const std::string& path) { return Descriptor(open(path.c_str(), O_RDONLY)); }

Descriptor open_to_write(const std::string& path) { return Descriptor(open(path.c_str(), O_WRONLY)); }

Descriptor open_new(const std::string& path) {
  return Descriptor(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666));
}

void hold(const Descriptor&) {}
bool is_written(const std::string&, int64_t) { return false; }

bool put_in_place(Descriptor, const std::string& from, const std::string& to) {
  return rename(from.c_str(), to.c_str()) == 0;
}

bool readable(int file, int milliseconds) {
  pollfd waiting{file, POLLIN, 0};
  return poll(&waiting, 1, milliseconds) > 0;
}

Descriptor open_without_name() {
  std::string name = P_tmpdir "/ipos-XXXXXX";
  Descriptor file(mkstemp(name.data()));
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
