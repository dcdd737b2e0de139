// Where the telegrams of `ipos bus monitor` come from: a CAN port, a serial port, or a candump log that may
// still grow. Each goes on until the monitor is full, the time is over, the source has ended or Ctrl-C.
#pragma once

#include <cstdint>
#include <string>

#include "tools/bus/log_input.hpp"
#include "tools/bus/monitor.hpp"

namespace ipos::tools {

enum class MonitorSource : uint8_t { Log, Can, Serial };

// By the name: a file or "-" is a log, see docs/guide/ports.md for the others. Throws for a path where nothing is.
MonitorSource monitor_source(const std::string& name);

// Exit codes. `duration` is time on the clock; in a log that is not followed, time in the log after its
// first frame. Nothing is ever sent to a port.
int monitor_can(Monitor& monitor, const std::string& port, uint32_t baud, runtime::Time duration);
int monitor_serial(Monitor& monitor, const std::string& port, uint32_t baud, runtime::Time duration);
int monitor_profibus(Monitor& monitor, const std::string& port, uint32_t baud, runtime::Time duration);
int monitor_log(Monitor& monitor, const LogFlags& log, bool follow, runtime::Time duration);

}  // namespace ipos::tools
