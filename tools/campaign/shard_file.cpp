// Appends whole lines, brought to the disk about once a second.
#include "tools/campaign/shard_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>

#include "tools/campaign/machine.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"

namespace ipos::tools::campaign {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kMostShards = 1'000'000;  // ours

std::string path_in(const std::string& folder, const Shard& shard, std::string_view ending) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Failure(kIoError, fmt::format("{}: {}", folder, error.message()));
  return (fs::path(folder) / fs::path(shard.file_name()).replace_extension(ending)).string();
}

}  // namespace

std::string Shard::file_name() const { return fmt::format("shard-{}-of-{}.jsonl", number, count); }

Shard shard_of(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  const bool divided = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
  const auto count = divided ? std::from_chars(number.ptr + 1, end, shard.count) : number;
  if (!divided || count.ec != std::errc() || count.ptr != end || shard.number < 1 || shard.number > shard.count || shard.count > kMostShards)
    throw Failure(kUsage, fmt::format("--shard {}: write K/N, for example 3/16: the third of 16", text));
  return shard;
}

std::vector<std::string> shard_files(const std::string& folder) {
  std::vector<std::string> files;
  for (const std::string& name : list_files(folder))
    if (name.starts_with("shard-") && name.ends_with(".jsonl")) files.push_back((fs::path(folder) / name).string());
  std::sort(files.begin(), files.end());
  return files;
}

ShardFile::ShardFile(const std::string& folder, const Shard& shard)
    : path_(path_in(folder, shard, ".jsonl")), lock_(path_in(folder, shard, ".lock")), file_(open_to_append(path_)) {
  if (!file_.is_open()) throw Failure(kIoError, fmt::format("{}: {}", path_, std::strerror(errno)));
  drop_torn_line();
  bring_folder_to_disk(folder);
}

void ShardFile::drop_torn_line() {
  size_ = fs::file_size(path_);
  if (size_ == 0) return;
  const std::string text = read_file(path_, kLogLimit);
  const size_t whole = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
  dropped_ = size_ - whole;
  size_ = whole;
  if (dropped_ != 0 && !cut(file_, whole)) throw Failure(kIoError, fmt::format("{}: {}", path_, std::strerror(errno)));
}

void ShardFile::append(std::string_view lines) {
  if (write_whole(file_, lines)) {
    size_ += lines.size();
    return;
  }
  const int error = errno;
  cut(file_, size_);
  throw Failure(kIoError, fmt::format("{}: {}; the results before are kept, and the same command goes on from there", path_, std::strerror(error)));
}

void ShardFile::keep() {
  if (!bring_to_disk(file_)) throw Failure(kIoError, fmt::format("{}: {}", path_, std::strerror(errno)));
  lock_.beat();
}

}  // namespace ipos::tools::campaign
