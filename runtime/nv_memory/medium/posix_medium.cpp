// pread, pwrite, fsync; a file that is new is synchronised with its folder, too.
#include "runtime/nv_memory/medium/file_medium.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "runtime/nv_memory/medium/file_copy.hpp"

namespace ipos::runtime {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

class PosixMedium final : public NvMedium {
 public:
  explicit PosixMedium(int file) : file_(file) {}
  ~PosixMedium() override { close(file_); }
  PosixMedium(const PosixMedium&) = delete;
  PosixMedium& operator=(const PosixMedium&) = delete;

  tl::expected<size_t, std::string> read(uint64_t offset, std::span<uint8_t> out) override {
    size_t done = 0;
    while (done < out.size()) {
      const ssize_t n = pread(file_, out.data() + done, out.size() - done, static_cast<off_t>(offset + done));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return tl::unexpected(reason(errno));
      if (n == 0) break;
      done += static_cast<size_t>(n);
    }
    return done;
  }

  std::optional<std::string> write(uint64_t offset, std::span<const uint8_t> bytes) override {
    for (size_t done = 0; done < bytes.size();) {
      const ssize_t n =
          pwrite(file_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return reason(n < 0 ? errno : ENOSPC);
      done += static_cast<size_t>(n);
    }
    return std::nullopt;
  }

  std::optional<std::string> sync() override {
    if (fsync(file_) != 0) return reason(errno);
    return std::nullopt;
  }

 private:
  int file_;
};

// The entry of a new file in its folder must be on the disk, too.
bool sync_folder(const std::string& path) {
  const size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  const int handle = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return false;
  const bool done = fsync(handle) == 0;
  close(handle);
  return done;
}

using Opened = tl::expected<std::unique_ptr<NvMedium>, std::string>;

}  // namespace

Opened open_file_medium(const std::string& path, FileUse use) {
  const bool writes = use == FileUse::Write;
  // Before it is opened: that may have effects on a device, and blocks at a pipe.
  struct stat status {};
  const bool exists = stat(path.c_str(), &status) == 0;
  if (!exists && errno == ENOENT && !writes) return copy_of_nothing();
  if (!exists && errno != ENOENT) return tl::unexpected(reason(errno));
  if (exists && !S_ISREG(status.st_mode)) return tl::unexpected(std::string("not a file"));
  const int file =
      open(path.c_str(), (writes ? O_RDWR | O_CREAT : O_RDONLY) | O_NONBLOCK | O_NOCTTY | O_CLOEXEC, 0644);
  if (file < 0) return tl::unexpected(reason(errno));
  auto medium = std::make_unique<PosixMedium>(file);
  if (fstat(file, &status) != 0) return tl::unexpected(reason(errno));
  if (!S_ISREG(status.st_mode)) return tl::unexpected(std::string("not a file"));
  if (!writes) return copy_of(*medium);
  if (flock(file, LOCK_EX | LOCK_NB) != 0)
    return tl::unexpected(errno == EWOULDBLOCK ? std::string("another run is using it") : reason(errno));
  if (status.st_size == 0 && !sync_folder(path)) return tl::unexpected(reason(errno));
  return medium;
}

}  // namespace ipos::runtime
