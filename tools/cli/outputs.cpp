// Where an output goes: standard output, a device, or a new file that takes the place of the old one.
#include "tools/cli/outputs.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <utility>

#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/os_file.hpp"

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
  return look_at(path, info) && !S_ISREG(info.st_mode);
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
    const auto piece = static_cast<unsigned>(std::min(bytes.size(), size_t{1} << 30U));
    const ssize_t count = write(file.get(), bytes.data(), piece);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, errno);
    bytes.remove_prefix(static_cast<size_t>(count));
  }
}

Descriptor open_special(const std::string& path) {
  Descriptor file = open_to_write(path);
  if (!file.is_open()) fail(path, errno);
  return file;
}

// Files of writers that were killed before their file took its place.
void remove_left_overs(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const std::string begin = "." + name + ".";
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end;
       at.increment(error)) {
    const std::string file = at->path().filename().string();
    if (!file.starts_with(begin) || !file.ends_with(".tmp")) continue;
    int64_t process = 0;
    const char* const behind = file.data() + file.size();
    const auto read = std::from_chars(file.data() + begin.size(), behind, process);
    const bool ours = read.ec == std::errc() && read.ptr != behind && *read.ptr == '.';
    std::error_code ignored;
    if (ours && !is_written(at->path().string(), process)) fs::remove(at->path(), ignored);
  }
}

// A new file beside `target`; removed again unless it takes its place.
class Beside {
 public:
  explicit Beside(const std::string& target) {
    const fs::path path(target);
    const std::string name = path.filename().string().substr(0, kNameLimit);
    remove_left_overs(path.parent_path(), name);
    for (int number = 0; !file_.is_open(); ++number) {
      path_ = (path.parent_path() / fmt::format(".{}.{}.{}.tmp", name, getpid(), number)).string();
      file_ = open_new(path_);
      if (!file_.is_open() && errno != EEXIST) fail(target, errno);
      if (file_.is_open()) hold(file_);
    }
  }
  ~Beside() {
    file_ = Descriptor();
    std::error_code ignored;
    if (!path_.empty()) fs::remove(path_, ignored);
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  const Descriptor& file() const { return file_; }

  void replace(const std::string& target) {
    if (!put_in_place(std::move(file_), path_, target)) fail(target, errno);
    path_.clear();
  }

 private:
  std::string path_;
  Descriptor file_;
};

// Why `target` could not be replaced; 0 when it can.
int obstacle(const std::string& target) {
  struct stat info {};
  if (look_at(target, info) && !may_write(target)) return errno;
  return may_make_files_in(folder_of(target)) ? 0 : errno;
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
  file_.open(fs::path(path), std::ios::binary);
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
