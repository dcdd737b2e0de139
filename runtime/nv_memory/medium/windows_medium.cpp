// CreateFile, which shares a file that is written with those who only read it.
#include <windows.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "runtime/nv_memory/medium/file_copy.hpp"
#include "runtime/nv_memory/medium/file_medium.hpp"

namespace ipos::runtime {
namespace {

std::string last_reason() { return std::system_category().message(static_cast<int>(GetLastError())); }

class WindowsMedium final : public NvMedium {
 public:
  explicit WindowsMedium(HANDLE file) : file_(file) {}
  ~WindowsMedium() override { CloseHandle(file_); }
  WindowsMedium(const WindowsMedium&) = delete;
  WindowsMedium& operator=(const WindowsMedium&) = delete;

  tl::expected<size_t, std::string> read(uint64_t offset, std::span<uint8_t> out) override {
    size_t done = 0;
    while (done < out.size()) {
      OVERLAPPED place = at(offset + done);
      DWORD count = 0;
      if (ReadFile(file_, out.data() + done, piece(out.size() - done), &count, &place) == 0) {
        if (GetLastError() == ERROR_HANDLE_EOF) break;
        return tl::unexpected(last_reason());
      }
      if (count == 0) break;
      done += count;
    }
    return done;
  }

  std::optional<std::string> write(uint64_t offset, std::span<const uint8_t> bytes) override {
    for (size_t done = 0; done < bytes.size();) {
      OVERLAPPED place = at(offset + done);
      DWORD count = 0;
      if (WriteFile(file_, bytes.data() + done, piece(bytes.size() - done), &count, &place) == 0)
        return last_reason();
      done += count;
    }
    return std::nullopt;
  }

  std::optional<std::string> sync() override {
    if (FlushFileBuffers(file_) == 0) return last_reason();
    return std::nullopt;
  }

 private:
  static OVERLAPPED at(uint64_t offset) {
    OVERLAPPED place{};
    place.Offset = static_cast<DWORD>(offset);
    place.OffsetHigh = static_cast<DWORD>(offset >> 32U);
    return place;
  }
  static DWORD piece(size_t size) { return static_cast<DWORD>(std::min<size_t>(size, 1U << 20U)); }

  HANDLE file_;
};

}  // namespace

tl::expected<std::unique_ptr<NvMedium>, std::string> open_file_medium(const std::string& path, FileUse use) {
  const bool writes = use == FileUse::Write;
  const DWORD shared = writes ? FILE_SHARE_READ : FILE_SHARE_READ | FILE_SHARE_WRITE;
  const HANDLE file =
      CreateFileW(std::filesystem::path(path).c_str(), writes ? GENERIC_READ | GENERIC_WRITE : GENERIC_READ,
                  shared, nullptr, writes ? OPEN_ALWAYS : OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, nullptr);
  if (file == INVALID_HANDLE_VALUE) {
    const DWORD error = GetLastError();
    std::error_code none;
    if (error == ERROR_FILE_NOT_FOUND && !writes) return copy_of_nothing();
    if (error == ERROR_SHARING_VIOLATION) return tl::unexpected(std::string("another run is using it"));
    if (std::filesystem::is_directory(path, none)) return tl::unexpected(std::string("not a file"));
    return tl::unexpected(last_reason());
  }
  auto medium = std::make_unique<WindowsMedium>(file);
  if (GetFileType(file) != FILE_TYPE_DISK) return tl::unexpected(std::string("not a file"));
  if (!writes) return copy_of(*medium);
  return medium;
}

}  // namespace ipos::runtime
