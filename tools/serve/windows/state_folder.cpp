// Files below %LOCALAPPDATA%, which belongs to one user, written aside and put in place in one step.
#include "tools/serve/state_folder.hpp"

#include <fmt/format.h>
#include <windows.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

namespace ipos::tools::serve {
namespace {

namespace fs = std::filesystem;

// In the encoding of the system's own functions.
std::wstring variable(const char* name) {
  const std::wstring wide(name, name + std::char_traits<char>::length(name));
  std::wstring value(GetEnvironmentVariableW(wide.c_str(), nullptr, 0), L'\0');
  value.resize(GetEnvironmentVariableW(wide.c_str(), value.data(), static_cast<DWORD>(value.size())));
  return value;
}

class File {
 public:
  File(const fs::path& path, DWORD access, DWORD shared, DWORD disposition)
      : handle_(CreateFileW(path.c_str(), access, shared, nullptr, disposition, FILE_ATTRIBUTE_NORMAL, nullptr)) {}
  ~File() {
    if (handle_ != INVALID_HANDLE_VALUE) CloseHandle(handle_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  HANDLE get() const { return handle_; }
  HANDLE release() { return std::exchange(handle_, INVALID_HANDLE_VALUE); }

 private:
  HANDLE handle_;
};

}  // namespace

const char* const kStateVariable = "LOCALAPPDATA";

// The variable of other systems is asked first, so that a test, or a user, can have another place.
fs::path state_folder() {
  fs::path of_user = variable("XDG_STATE_HOME");
  if (!of_user.is_absolute()) of_user = variable(kStateVariable);
  if (!of_user.is_absolute()) return {};
  std::error_code error;
  fs::create_directories(of_user / "ipos", error);
  return fs::is_directory(of_user / "ipos", error) ? of_user / "ipos" : fs::path{};
}

std::optional<std::string> read_state(const std::string& name) {
  const fs::path folder = state_folder();
  std::error_code error;
  if (folder.empty() || !fs::is_regular_file(folder / name, error) || fs::file_size(folder / name, error) > kLongestState)
    return std::nullopt;
  std::ifstream file(folder / name, std::ios::binary);
  if (!file) return std::nullopt;
  std::string text{std::istreambuf_iterator<char>(file), {}};
  return file.bad() ? std::nullopt : std::optional(std::move(text));
}

bool write_state(const std::string& name, std::string_view text) {
  const fs::path folder = state_folder();
  if (folder.empty() || text.size() > kLongestState) return false;
  const fs::path aside = folder / fmt::format(".{}.{}.tmp", name, GetCurrentProcessId());
  bool written = false;
  {
    const File file(aside, GENERIC_WRITE, 0, CREATE_ALWAYS);
    DWORD count = 0;
    written = WriteFile(file.get(), text.data(), static_cast<DWORD>(text.size()), &count, nullptr) != 0 &&
              count == text.size() && FlushFileBuffers(file.get()) != 0;
  }
  written = written && MoveFileExW(aside.c_str(), (folder / name).c_str(), MOVEFILE_REPLACE_EXISTING) != 0;
  if (!written) DeleteFileW(aside.c_str());
  return written;
}

StateLock::StateLock(const std::string& name) {
  const fs::path folder = state_folder();
  if (folder.empty()) return;
  File file(folder / fmt::format(".{}.lock", name), GENERIC_READ | GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE, OPEN_ALWAYS);
  OVERLAPPED first_byte{};
  if (file.get() == INVALID_HANDLE_VALUE || LockFileEx(file.get(), LOCKFILE_EXCLUSIVE_LOCK, 0, 1, 0, &first_byte) == 0) return;
  file_ = reinterpret_cast<std::intptr_t>(file.release());
}

StateLock::~StateLock() {
  if (file_ != -1) CloseHandle(reinterpret_cast<HANDLE>(file_));
}

void remove_state(const std::string& name) {
  if (const fs::path folder = state_folder(); !folder.empty()) DeleteFileW((folder / name).c_str());
}

}  // namespace ipos::tools::serve
