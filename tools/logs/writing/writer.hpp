// Writes logs in the forms of tools/logs/log_forms.hpp but BLF, bit by bit, so that what is written can be read at once.
// Virtual time 0 is 1 January 2000, as in candump logs. It knows streams only: `ipos run` has files, the page a download.
#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/can/node.hpp"
#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/profibus/fdl_receiver.hpp"

namespace ipos::tools {

class LogWriter {
 public:
  virtual ~LogWriter() = default;

  virtual void can(runtime::Time time, const std::string& bus, const runtime::Frame& frame) = 0;
  // Forms without a row for error frames leave them out.
  virtual void can_error(const runtime::CanLine& /*line*/, const runtime::ErrorRecord& /*error*/) {}
  // Forms of CAN alone leave these out.
  virtual void serial(const std::string& /*line*/, const runtime::Reception& /*reception*/) {}
  virtual void dp(const std::string& /*line*/, const profibus::Reception& /*reception*/) {}
  virtual bool has_serial() const { return false; }
};

enum class LineKind : uint8_t { Can, Serial, Dp };

// A log that several writers make one after the other: its lines in their order, and whether a part begins or ends it. As it
// stands here one writer makes all of it, and lines come as they are first heard.
struct LogPart {
  struct Line {
    std::string name;
    LineKind kind;
  };
  std::vector<Line> lines{};
  bool begins = true, ends = true;
};

// By the ending of a file's name: ".pcapng", ".asc", ".trc"; everything else is candump. The stream must outlive it.
std::unique_ptr<LogWriter> make_writer(std::string_view ending, std::ostream& out, const LogPart& part = {});

}  // namespace ipos::tools
