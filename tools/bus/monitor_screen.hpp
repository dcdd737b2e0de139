// The table of the monitor on a terminal: drawn over itself a few times a second, with the keys of the user.
#pragma once

#include <termios.h>

#include <chrono>

#include "tools/bus/monitor_table.hpp"

namespace ipos::tools {

class MonitorScreen {
 public:
  // `live`: the table is drawn while telegrams come; else once, at the end.
  explicit MonitorScreen(bool live);
  ~MonitorScreen();
  MonitorScreen(const MonitorScreen&) = delete;
  MonitorScreen& operator=(const MonitorScreen&) = delete;

  MonitorTable& table() { return table_; }
  // Keys, and the picture if it is old enough. The user wants to end: ended().
  void look();
  bool ended() const { return ended_; }
  // The last picture, which stays.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  void draw();

  MonitorTable table_;
  bool live_;
  bool has_keys_ = false;
  bool ended_ = false;
  bool finished_ = false;
  bool changed_ = false;  // by a key
  termios before_{};
  Clock::time_point drawn_{};
};

}  // namespace ipos::tools
