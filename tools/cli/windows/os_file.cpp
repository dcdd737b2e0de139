// MoveFileEx replaces a file in one step, once nobody has the new one open. Names are UTF-8, so all files are opened
// by their wide names.
#include "tools/cli/os_file.hpp"

#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#include <unistd.h>
#include <winsock2.h>
#include <windows.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <random>
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

bool is_socket(HANDLE file) {
  int kind = 0, size = sizeof kind;
  return getsockopt(reinterpret_cast<SOCKET>(file), SOL_SOCKET, SO_TYPE, reinterpret_cast<char*>(&kind), &size) == 0;
}

// A pipe cannot be waited for: it is looked at.
bool pipe_is_readable(HANDLE pipe, int milliseconds) {
  for (const ULONGLONG end = GetTickCount64() + static_cast<ULONGLONG>(milliseconds);; Sleep(1)) {
    DWORD there = 0;
    if (PeekNamedPipe(pipe, nullptr, 0, nullptr, &there, nullptr) == 0 || there != 0) return true;
    if (GetTickCount64() >= end) return false;
  }
}
Descriptor open_as(const std::string& path, int how) {
  return Descriptor(
      _wopen(std::filesystem::path(path).c_str(), how | O_BINARY | O_NOINHERIT, S_IREAD | S_IWRITE));
}

// A virus scanner, an indexer or a backup holds a new file for a moment.
bool is_held(DWORD error) { return error == ERROR_ACCESS_DENIED || error == ERROR_SHARING_VIOLATION; }

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

bool look_at(const std::string& path, struct stat& info) {
  return _wstat64(std::filesystem::path(path).c_str(), &info) == 0;
}

Descriptor open_to_read(const std::string& path) { return open_as(path, O_RDONLY); }
Descriptor open_to_write(const std::string& path) { return open_as(path, O_WRONLY); }
Descriptor open_new(const std::string& path) { return open_as(path, O_WRONLY | O_CREAT | O_EXCL); }

// A file that somebody has open cannot be removed here, so who removes need not ask.
void hold(const Descriptor&) {}
bool is_written(const std::string&, int64_t) { return false; }

bool put_in_place(Descriptor file, const std::string& from, const std::string& to) {
  constexpr DWORD kPatience_ms = 2000, kPause_ms = 20;  // ours
  if (_commit(file.get()) != 0) return false;
  file = Descriptor();  // closes it
  const std::filesystem::path source(from), target(to);
  for (DWORD waited = 0;; waited += kPause_ms) {
    if (MoveFileExW(source.c_str(), target.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0)
      return true;
    const DWORD error = GetLastError();
    const DWORD rights = GetFileAttributesW(target.c_str());
    const bool may_not = rights != INVALID_FILE_ATTRIBUTES && (rights & FILE_ATTRIBUTE_READONLY) != 0;
    if (!is_held(error) || may_not || waited >= kPatience_ms) {
      errno = is_held(error) ? EACCES : EIO;
      return false;
    }
    Sleep(kPause_ms);
  }
}

bool readable(int file, int milliseconds) {
  const auto handle = reinterpret_cast<HANDLE>(_get_osfhandle(file));
  switch (GetFileType(handle)) {
    case FILE_TYPE_CHAR: return WaitForSingleObject(handle, static_cast<DWORD>(milliseconds)) == WAIT_OBJECT_0;
    case FILE_TYPE_PIPE: break;
    default: return true;
  }
  if (!is_socket(handle)) return pipe_is_readable(handle, milliseconds);
  WSAPOLLFD waiting{reinterpret_cast<SOCKET>(handle), POLLRDNORM, 0};
  return WSAPoll(&waiting, 1, milliseconds) > 0;
}

Descriptor open_without_name() {
  std::array<wchar_t, MAX_PATH + 1> folder{};
  std::array<wchar_t, MAX_PATH + 1> name{};
  if (GetTempPathW(MAX_PATH, folder.data()) == 0 || GetTempFileNameW(folder.data(), L"ipo", 0, name.data()) == 0)
    return Descriptor();
  return Descriptor(_wopen(name.data(), O_RDWR | O_BINARY | O_NOINHERIT | O_TEMPORARY));
}

// In a folder that only this user can read, as that for temporary files is.
std::optional<std::string> make_folder(const std::string& beginning) {
  constexpr int kTries = 100;
  std::random_device any;
  for (int n = 0; n < kTries; ++n) {
    const std::string name = beginning + std::to_string(any());
    std::error_code error;
    if (std::filesystem::create_directory(std::filesystem::path(name), error)) return name;
  }
  return std::nullopt;
}

bool may_write(const std::string& path) { return _waccess(std::filesystem::path(path).c_str(), W_OK) == 0; }

bool may_make_files_in(const std::string& folder) {
  if (std::filesystem::is_directory(folder)) return true;
  errno = ENOENT;
  return false;
}

}  // namespace ipos::tools
