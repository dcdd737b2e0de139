// Whole files by stdio.
#include "tools/files.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "tools/failure.hpp"

namespace ipos::tools {
namespace {

struct Closer {
  void operator()(std::FILE* file) const {
    if (file != stdin && file != stdout) std::fclose(file);
  }
};
using File = std::unique_ptr<std::FILE, Closer>;

bool is_folder(const std::string& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode);
}

}  // namespace

std::optional<std::string> try_read_file(const std::string& path) {
  if (is_folder(path)) {
    errno = EISDIR;
    return std::nullopt;
  }
  const File file(path == "-" ? stdin : std::fopen(path.c_str(), "rb"));
  if (!file) return std::nullopt;
  std::string text;
  char buffer[65536];
  while (const size_t count = std::fread(buffer, 1, sizeof buffer, file.get())) text.append(buffer, count);
  if (std::ferror(file.get()) != 0) return std::nullopt;
  return text;
}

std::string read_file(const std::string& path) {
  auto text = try_read_file(path);
  if (!text) throw Failure(kNoInput, fmt::format("{}: {}", path, std::strerror(errno)));
  return *std::move(text);
}

std::vector<std::string> list_files(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code trouble;
  std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, trouble);
  for (; !trouble && entry != std::filesystem::directory_iterator(); entry.increment(trouble))
    names.push_back(entry->path().filename().string());
  return names;
}

void write_file(const std::string& path, std::span<const uint8_t> bytes) {
  std::FILE* out = path == "-" ? stdout : std::fopen(path.c_str(), "wb");
  bool good = out != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size();
  if (out == stdout)
    good = std::fflush(out) == 0 && good;
  else if (out != nullptr)
    good = std::fclose(out) == 0 && good;
  if (!good) throw Failure(kIoError, fmt::format("{}: {}", path, std::strerror(errno)));
}

std::ofstream open_output(const std::string& path) {
  std::ofstream file;
  if (path.empty()) return file;
  file.open(path, std::ios::binary);
  if (!file) throw Failure(kIoError, fmt::format("{}: cannot be written", path));
  return file;
}

void close_output(std::ofstream& file, const std::string& path) {
  if (!path.empty() && !file.flush()) throw Failure(kIoError, fmt::format("{}: cannot be written", path));
}

}  // namespace ipos::tools
