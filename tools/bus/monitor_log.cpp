// The monitor at a log, candump or of RS-485 lines, also one that another program is writing, or at standard
// input.
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include "runtime/port/descriptor.hpp"
#include "runtime/port/system_clock.hpp"
#include "tools/bus/monitor_sources.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/interrupt.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

constexpr Time kLook = 50 * runtime::kMillisecond;  // how often a log that is followed is looked at (ours)

class LogFile {
 public:
  explicit LogFile(const std::string& path) : path_(path), descriptor_(open_input(path, kLogLimit)) {}

  // More text: false at the end of what is there now. Waits for a pipe at most kLook.
  bool read_more() {
    pollfd polled{descriptor_.get(), POLLIN, 0};
    if (poll(&polled, 1, static_cast<int>(kLook / runtime::kMillisecond)) == 0 || interrupted()) return true;
    std::array<char, 65536> chunk{};
    const ssize_t size = ::read(descriptor_.get(), chunk.data(), chunk.size());
    if (size < 0 && errno == EINTR) return true;
    if (size < 0) throw Failure(kNoInput, fmt::format("{}: {}", path_, std::strerror(errno)));
    text_.append(chunk.data(), static_cast<size_t>(size));
    return size > 0;
  }

  // The next complete line; at the end of the log also the last one without line end.
  std::optional<std::string_view> line(bool at_end) {
    const size_t end = text_.find('\n', at_);
    if (end == std::string::npos && !(at_end && at_ < text_.size())) {
      text_.erase(0, at_);
      at_ = 0;
      return std::nullopt;
    }
    const size_t from = at_;
    at_ = end == std::string::npos ? text_.size() : end + 1;
    ++number_;
    return std::string_view(text_).substr(from, (end == std::string::npos ? text_.size() : end) - from);
  }

  // The file has become shorter: somebody began it anew.
  bool begun_anew() {
    struct stat now {};
    const off_t place = lseek(descriptor_.get(), 0, SEEK_CUR);
    if (place < 0 || fstat(descriptor_.get(), &now) != 0 || now.st_size >= place) return false;
    lseek(descriptor_.get(), 0, SEEK_SET);
    text_.clear();
    at_ = number_ = 0;
    return true;
  }

  size_t number() const { return number_; }  // of the last line, from 1

 private:
  const std::string& path_;
  runtime::Descriptor descriptor_;
  std::string text_;
  size_t at_ = 0;
  size_t number_ = 0;
};

}  // namespace

int monitor_log(Monitor& monitor, const std::string& path, bool follow, Time duration) {
  runtime::SystemClock clock;
  LogFile log(path);
  const Time begin = clock.now();
  std::optional<Time> first;
  bool bad = false;
  bool in_time = true;
  const auto over = [&] {
    if (follow && duration != runtime::kNever && clock.now() - begin >= duration) in_time = false;
    return interrupted() || monitor.full() || !in_time;
  };
  const auto show = [&](const auto& entry, std::optional<Time> time) {
    if (!entry) {
      bad = true;
      fmt::print(stderr, "{}:{}:{}: error: {}\n", path, entry.error().line, entry.error().column,
                 entry.error().message);
      return;
    }
    if (!first) first = time;
    if (!follow && duration != runtime::kNever && time && *time - *first >= duration)
      in_time = false;
    else
      monitor.take(*entry);
  };
  const auto take = [&](std::string_view row) {
    if (row.find_first_not_of(" \t\r") == std::string_view::npos) return;
    if (runtime::is_serial_line(row)) {
      const auto entry = runtime::parse_serial_line(row, log.number());
      show(entry, entry ? entry->time : std::nullopt);
    } else {
      const auto entry = runtime::parse_candump_line(row, log.number());
      show(entry, entry ? std::optional(entry->time) : std::nullopt);
    }
  };
  for (bool more = true; !over();) {
    more = log.read_more();
    while (!over()) {
      const auto row = log.line(!more && !follow);
      if (!row) break;
      take(*row);
    }
    monitor.flush();
    if (more || over()) continue;
    if (!follow) break;
    if (log.begun_anew()) monitor.note(path + " has been begun anew");
    clock.wait(clock.now() + kLook, {});
  }
  monitor.finish();
  if (interrupted()) return kInterrupted;
  return bad ? kBadInput : kGood;
}

}  // namespace ipos::tools
