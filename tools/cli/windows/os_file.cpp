// MoveFileEx replaces a file in one step, once nobody has the new one open.
#include "tools/cli/os_file.hpp"

#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#include <unistd.h>
#include <windows.h>

#include <cerrno>
#include <filesystem>
#include <utility>

namespace ipos::tools {
namespace {

using runtime::Descriptor;

std::optional<FileIdentity> look_at(HANDLE file) {
  BY_HANDLE_FILE_INFORMATION info{};
  if (file == INVALID_HANDLE_VALUE || GetFileInformationByHandle(file, &info) == 0) return std::nullopt;
  const auto whole = [](DWORD high, DWORD low) { return uint64_t{high} << 32U | low; };
  return FileIdentity{
      info.dwVolumeSerialNumber, whole(info.nFileIndexHigh, info.nFileIndexLow),
      static_cast<int64_t>(whole(info.ftCreationTime.dwHighDateTime, info.ftCreationTime.dwLowDateTime)), 0};
}

}  // namespace

std::optional<FileIdentity> identity_of(const Descriptor& file) {
  return look_at(reinterpret_cast<HANDLE>(_get_osfhandle(file.get())));
}

std::optional<FileIdentity> identity_of(const std::string& path) {
  constexpr DWORD kShared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
  const HANDLE file = CreateFileW(std::filesystem::path(path).c_str(), 0, kShared, nullptr, OPEN_EXISTING,
                                  FILE_FLAG_BACKUP_SEMANTICS, nullptr);
  const auto identity = look_at(file);
  if (file != INVALID_HANDLE_VALUE) CloseHandle(file);
  return identity;
}

Descriptor open_to_read(const std::string& path) {
  return Descriptor(open(path.c_str(), O_RDONLY | O_BINARY | O_NOINHERIT));
}

Descriptor open_to_write(const std::string& path) {
  return Descriptor(open(path.c_str(), O_WRONLY | O_BINARY | O_NOINHERIT));
}

Descriptor open_new(const std::string& path) {
  return Descriptor(
      open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_BINARY | O_NOINHERIT, S_IREAD | S_IWRITE));
}

// A file that somebody has open cannot be removed here, so who removes need not ask.
void hold(const Descriptor&) {}
bool is_written(const std::string&, int64_t) { return false; }

bool put_in_place(Descriptor file, const std::string& from, const std::string& to) {
  if (_commit(file.get()) != 0) return false;
  file = Descriptor();  // closes it
  const std::filesystem::path source(from), target(to);
  if (MoveFileExW(source.c_str(), target.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0)
    return true;
  errno = GetLastError() == ERROR_ACCESS_DENIED || GetLastError() == ERROR_SHARING_VIOLATION ? EACCES : EIO;
  return false;
}

bool may_write(const std::string& path) { return access(path.c_str(), W_OK) == 0; }

bool may_make_files_in(const std::string& folder) {
  if (std::filesystem::is_directory(folder)) return true;
  errno = ENOENT;
  return false;
}

}  // namespace ipos::tools
