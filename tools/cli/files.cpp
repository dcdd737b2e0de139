// A file is looked at before it is opened, as opening a device or a pipe may have effects or block; and once
// more after it, as another one may stand there by then.
#include "tools/cli/files.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <utility>

#include "stdlib/plain_text.hpp"
#include "stdlib/spelling.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/os_file.hpp"

namespace ipos::tools {
namespace {

using runtime::Descriptor;

// Tests are read on several threads.
std::mutex opened_mutex;
std::set<FileIdentity> opened;

bool is_standard_input(const std::string& path) { return path == "-" || path == "/dev/stdin"; }

// Why a file is not open.
struct Reason {
  std::string text;
  bool missing = false;
};

// For who asked for the file. When it is not there, perhaps its neighbour was meant.
std::string told(const std::string& path, const Reason& reason) {
  const std::string& why = reason.text;
  if (!reason.missing) return why;
  const std::filesystem::path asked(path);
  const std::vector<std::string> names = list_files(asked.parent_path().string());
  const std::string_view near =
      stdlib::nearest(asked.filename().string(), std::vector<std::string_view>(names.begin(), names.end()));
  if (near.empty()) return why;
  return fmt::format("{}; did you mean '{}'?", why, (asked.parent_path() / near).generic_string());
}

std::string too_large(size_t limit) { return fmt::format("is larger than {} MB", limit >> 20U); }

// Why it is no file to read, or nothing.
std::optional<std::string> trouble(const struct stat& info, size_t limit) {
  if (S_ISDIR(info.st_mode)) return "is a folder";
  if (!S_ISREG(info.st_mode)) return "is no file but a device or a pipe";
  if (static_cast<uint64_t>(info.st_size) > limit) return too_large(limit);
  return std::nullopt;
}

tl::expected<Descriptor, Reason> open_regular(const std::string& path, size_t limit) {
  struct stat info {};
  if (!stdlib::is_plain(path)) return tl::unexpected(Reason{"a file name has no control characters"});
  if (!look_at(path, info)) return tl::unexpected(Reason{std::strerror(errno), errno == ENOENT});
  if (auto why = trouble(info, limit)) return tl::unexpected(Reason{std::move(*why)});
  Descriptor file = open_to_read(path);
  if (!file.is_open() || fstat(file.get(), &info) != 0)
    return tl::unexpected(Reason{std::strerror(errno)});
  if (auto why = trouble(info, limit)) return tl::unexpected(Reason{std::move(*why)});
  const std::lock_guard lock(opened_mutex);
  if (const auto file_identity = identity_of(file)) opened.insert(*file_identity);
  return file;
}

tl::expected<std::string, std::string> read_all(const Descriptor& file, size_t limit) {
  std::string text;
  char buffer[65536];
  for (;;) {
    const ssize_t count = read(file.get(), buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return tl::unexpected(std::string(std::strerror(errno)));
    if (count == 0) return text;
    text.append(buffer, static_cast<size_t>(count));
    if (text.size() > limit) return tl::unexpected(too_large(limit));
  }
}

}  // namespace

Descriptor open_input(const std::string& path, size_t limit) {
  if (is_standard_input(path)) return Descriptor(dup(STDIN_FILENO));
  auto file = open_regular(path, limit);
  if (!file) throw Failure(kNoInput, fmt::format("{}: {}", path, told(path, file.error())));
  return std::move(*file);
}

std::string read_file(const std::string& path, size_t limit) {
  auto text = read_all(open_input(path, limit), limit);
  if (!text) throw Failure(kNoInput, fmt::format("{}: {}", path, text.error()));
  return *std::move(text);
}

tl::expected<std::string, std::string> load_file(const std::string& path) {
  const auto file = open_regular(path, kInputLimit);
  if (!file) return tl::unexpected(told(path, file.error()));
  return read_all(*file, kInputLimit);
}

std::optional<std::string> try_read_file(const std::string& path) {
  const auto file = open_regular(path, kInputLimit);
  if (!file) return std::nullopt;
  auto text = read_all(*file, kInputLimit);
  return text ? std::optional(*std::move(text)) : std::nullopt;
}

std::optional<std::string> unreadable(const std::string& path) {
  const auto file = open_regular(path, kInputLimit);
  return file ? std::nullopt : std::optional(told(path, file.error()));
}

bool is_folder(const std::string& path) {
  std::error_code none;
  return std::filesystem::is_directory(path, none);
}

std::vector<std::string> files_below(const std::string& folder) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code ignored;
    if (at->is_regular_file(ignored)) files.push_back(at->path().generic_string());
  }
  if (error) throw Failure(kNoInput, fmt::format("{}: {}", folder, error.message()));
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> list_files(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code trouble;
  std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, trouble);
  for (; !trouble && entry != std::filesystem::directory_iterator(); entry.increment(trouble))
    names.push_back(entry->path().filename().string());
  return names;
}

std::string beside(const std::string& file, const std::string& name) {
  namespace fs = std::filesystem;
  const fs::path path = fs::path(file).parent_path() / name;
  const fs::path normal = path.lexically_normal();
  std::error_code error;  // behind a link to a folder `..` leads elsewhere
  return (fs::equivalent(path, normal, error) ? normal : path).generic_string();
}

bool is_input(const std::string& path) {
  const auto file_identity = identity_of(path);
  const std::lock_guard lock(opened_mutex);
  return file_identity && opened.contains(*file_identity);
}

}  // namespace ipos::tools
