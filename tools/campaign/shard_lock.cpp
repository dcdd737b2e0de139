// O_EXCL makes a file for one process only, rename() is one step: both hold on network file systems, where locks of open files
// may hold on one machine only. Clocks of machines are not compared: the number has to move while this process looks.
#include "tools/campaign/shard_lock.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>

#include "tools/campaign/machine.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/os_file.hpp"

namespace ipos::tools::campaign {
namespace {

constexpr auto kPatience = std::chrono::seconds(15);  // ours: far above the second between two beats
constexpr auto kLook = std::chrono::milliseconds(200);

// "machine process start" of "machine process start beats".
std::string owner_of(const std::string& text) { return text.substr(0, text.rfind(' ')); }

[[noreturn]] void fail_taken(const std::string& path, const std::string& text) {
  throw Failure(kTaken, fmt::format("another runner has this shard: {} ({})", path, owner_of(text)));
}

}  // namespace

ShardLock::ShardLock(std::string path) : path_(std::move(path)), owner_(this_process()) {
  while (!make()) {
    const auto text = try_read_file(path_);
    if (!text) continue;  // it has gone this moment
    const auto alive = text->empty() ? std::optional<bool>() : is_alive(owner_of(*text));
    if (alive.value_or(false) || (!alive && wait_for_owner())) fail_taken(path_, *text);
    take_over(*text);
  }
}

bool ShardLock::make() {
  const runtime::Descriptor file = open_new(path_);
  if (!file.is_open()) {
    if (errno == EEXIST) return false;
    throw Failure(kIoError, fmt::format("{}: {}", path_, std::strerror(errno)));
  }
  const std::string text = fmt::format("{} 0", owner_);
  if (!write_whole(file, text)) {
    const int error = errno;
    std::filesystem::remove(path_);
    throw Failure(kIoError, fmt::format("{}: {}", path_, std::strerror(error)));
  }
  return true;
}

// True: its number moves, or it is gone by itself, in good order.
bool ShardLock::wait_for_owner() const {
  const auto before = try_read_file(path_);
  for (auto waited = kLook; waited < kPatience; waited += kLook) {
    std::this_thread::sleep_for(kLook);
    if (try_read_file(path_) != before) return true;
  }
  return false;
}

// Another one may do the same: the first to rename has it, and what was renamed must be what was seen.
void ShardLock::take_over(const std::string& stale) {
  const std::string aside = fmt::format("{}.{}", path_, std::hash<std::string>()(owner_));
  std::error_code error;
  std::filesystem::rename(path_, aside, error);
  if (error) return;
  const auto taken = try_read_file(aside);
  if (taken && *taken != stale && owner_of(*taken) != owner_of(stale)) {
    // It was a new one's: it goes back where nobody has made another one.
    std::filesystem::create_hard_link(aside, path_, error);
    std::filesystem::remove(aside, error);
    fail_taken(path_, *taken);
  }
  std::filesystem::remove(aside, error);
}

void ShardLock::beat() {
  const auto text = try_read_file(path_);
  if (!text || owner_of(*text) != owner_) {
    const std::string other = text.value_or("it is gone ");
    owner_.clear();
    fail_taken(path_, other);
  }
  const runtime::Descriptor file = open_to_write(path_);
  if (file.is_open()) write_whole(file, fmt::format("{} {}", owner_, ++beats_));
}

ShardLock::~ShardLock() {
  if (owner_.empty() || !is_own_process(owner_)) return;
  std::error_code error;
  std::filesystem::remove(path_, error);
}

}  // namespace ipos::tools::campaign
