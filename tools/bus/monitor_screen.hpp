// The table of the monitor on a terminal: drawn over itself a few times a second, with the keys of the user.
#pragma once

#include <chrono>
#include <optional>

#include "tools/bus/monitor_table.hpp"
#include "tools/bus/screen_terminal.hpp"

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
  bool ended_ = false;
  bool finished_ = false;
  bool changed_ = false;  // by a key
  std::optional<ScreenKeys> keys_;
  Clock::time_point drawn_{};
};

}  // namespace ipos::tools
