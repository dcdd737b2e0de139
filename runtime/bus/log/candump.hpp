// CAN logs in candump's file format, which can-utils and python-can read: (seconds.microseconds) name
// ID#DATA. Virtual time 0 is written as 1 January 2000, for readers that take second 0 as "no time" (ours).
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/bus/can/node.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

inline constexpr Time kCandumpEpoch = 946'684'800 * kSecond;

// One line without line end.
std::string candump_line(Time time, std::string_view bus, const Frame& frame);
// An error frame, as `candump -e` logs it: CAN_ERR_ACK, or CAN_ERR_PROT and CAN_ERR_BUSERROR without a detail
// (linux/can/error.h).
std::string candump_line(const CanLine& line, const ErrorRecord& error);

// Writes each frame of the lines it observes at its moment of delivery, and each error frame at its end.
class CandumpLog final : public CanObserver {
 public:
  explicit CandumpLog(std::ostream& out) : out_(out) {}
  void on_frame(const CanLine& line, const FrameRecord& record) override;
  void on_error_frame(const CanLine& line, const ErrorRecord& record) override;
  void on_line_event(const CanLine&, const LineEvent&) override {}

 private:
  std::ostream& out_;
};

struct LogEntry {
  Time time;  // since kCandumpEpoch
  std::string bus;
  Frame frame;

  friend bool operator==(const LogEntry&, const LogEntry&) = default;
};

struct LogError {
  size_t line;    // from 1
  size_t column;  // from 1
  std::string message;
};

tl::expected<LogEntry, LogError> parse_candump_line(std::string_view text, size_t line = 1);

// Every line of a log; empty lines are skipped, the first bad one ends it.
tl::expected<std::vector<LogEntry>, LogError> parse_candump(std::string_view text);

}  // namespace ipos::runtime
