// The monitor at a log of any form, or at standard input; a log of lines also while another program writes it.
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include "compiler/diag/places.hpp"
#include "runtime/os_port/descriptor.hpp"
#include "runtime/os_port/system_clock.hpp"
#include "tools/bus/monitor_sources.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/os_file.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

constexpr Time kLook = 50 * runtime::kMillisecond;  // how often a log that is followed is looked at (ours)

class LogFile {
 public:
  explicit LogFile(const std::string& path) : path_(path), descriptor_(open_input(path, kLogLimit)) {}

  // More text: false at the end of what is there now. Waits for a pipe at most kLook.
  bool read_more() {
    const bool there = readable(descriptor_.get(), static_cast<int>(kLook / runtime::kMillisecond));
    if (interrupted() || !there) return true;
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

  // The file has become shorter: somebody started it again.
  bool begun_anew() {
    struct stat now {};
    const off_t place = lseek(descriptor_.get(), 0, SEEK_CUR);
    if (place < 0 || fstat(descriptor_.get(), &now) != 0 || now.st_size >= place) return false;
    lseek(descriptor_.get(), 0, SEEK_SET);
    text_.clear();
    at_ = number_ = 0;
    return true;
  }

  // Forms are known by their first line; binary ones may have none.
  bool tells_its_form() const {
    constexpr size_t kShortest = 8;
    return text_.size() >= kToKnowTheForm ||
           (text_.size() >= kShortest && text_.find('\n') != std::string::npos);
  }
  std::string_view text() const { return text_; }
  size_t number() const { return number_; }  // of the last line, from 1

 private:
  const std::string& path_;
  runtime::Descriptor descriptor_;
  std::string text_;
  size_t at_ = 0;
  size_t number_ = 0;
};

// Whether more may be shown, and what came of it.
class Showing {
 public:
  Showing(Monitor& monitor, const LogFlags& log, Time duration)
      : monitor_(monitor), findings_(log.path), choice_(log), duration_(duration) {}

  // Of a log that is not followed, `duration` is time in the log.
  template <typename Entry>
  void take(const Entry& entry, std::optional<Time> time, bool in_log) {
    if (!first_) first_ = time;
    if (in_log && duration_ != runtime::kNever && time && *time - *first_ >= duration_)
      over_ = true;
    else if (!over())
      monitor_.take(entry);
  }
  void end() { over_ = true; }
  bool over() const { return over_ || interrupted() || monitor_.full(); }
  int finish() {
    monitor_.finish();
    const bool good = findings_.finish();
    if (interrupted()) return kInterrupted;
    if (findings_.understood() && !over_ && !monitor_.full()) choice_.check();
    return good ? kGood : kBadInput;
  }
  // Passes on what a reader finds, but nothing of what comes when all is over.
  LogReader reader(bool in_log) {
    LogReader all = findings_.watch(choice_.choose(
        {[this, in_log](const runtime::LogEntry& entry, LogPlace) { take(entry, entry.time, in_log); },
         [this, in_log](const runtime::SerialEntry& entry, LogPlace) { take(entry, entry.time, in_log); },
         [this, in_log](const runtime::ProfibusEntry& entry, LogPlace) {
           take(entry, entry.reception.start, in_log);
         },
         {}}));
    all.wrong = [this, wrong = std::move(all.wrong)](LogPlace place, const std::string& message) {
      if (!over()) wrong(place, message);
    };
    all.left_out = [this, left_out = std::move(all.left_out)](LeftOut what) {
      if (!over()) left_out(what);
    };
    return all;
  }

 private:
  Monitor& monitor_;
  LogFindings findings_;
  ChannelChoice choice_;
  Time duration_;
  std::optional<Time> first_;
  bool over_ = false;
};

// All of it, for a log whose form is not one of lines.
void read_whole(LogFile& log, const LogReader& reader) {
  while (log.read_more() && !interrupted()) continue;
  read_log(log.text(), reader);
}

}  // namespace

int monitor_log(Monitor& monitor, const LogFlags& flags, bool follow, Time duration) {
  runtime::SystemClock clock;
  LogFile log(flags.path);
  Showing showing(monitor, flags, duration);
  const LogReader reader = showing.reader(!follow);
  const Time begin = clock.now();
  bool looked = false;
  for (bool more = true; !showing.over();) {
    more = log.read_more();
    if (!looked && (!more || log.tells_its_form())) {
      looked = true;
      if (log_form(log.text()) != LogForm::Lines) {
        if (follow) throw Failure(kUsage, "--follow is for candump and serial logs");
        read_whole(log, reader);
        return showing.finish();
      }
    }
    while (looked && !showing.over()) {
      const auto row = log.line(!more && !follow);
      if (!row) break;
      read_log_line(*row, log.number(), reader);
    }
    monitor.flush();
    if (follow && duration != runtime::kNever && clock.now() - begin >= duration) showing.end();
    if (more || showing.over()) continue;
    if (!follow) break;
    if (log.begun_anew()) monitor.note(compiler::printable(flags.path) + " has been begun anew");
    clock.wait(clock.now() + kLook, {});
  }
  return showing.finish();
}

}  // namespace ipos::tools
