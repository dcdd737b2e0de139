// What `ipos bus monitor` shows: telegrams in words, one a line or in a table, with what the line lost and the errors of
// the bus between them where they came. The sources (monitor_sources.hpp) bring the telegrams.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "runtime/bus/log/candump.hpp"
#include "runtime/bus/log/serial_log.hpp"
#include "runtime/bus/movilink/describe.hpp"
#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/movilink/station_filter.hpp"
#include "runtime/bus/profibus/fdl_receiver.hpp"
#include "runtime/bus/words/bus_words.hpp"
#include "tools/bus/monitor_screen.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tools {

class Monitor {
 public:
  // Which telegrams are shown; those of PROFIBUS all.
  struct Filters {
    runtime::StationFilter can, serial;
  };

  // `count` telegrams are shown, 0: no limit.
  // `screen` for a table in place of a line a telegram.
  Monitor(runtime::BusWords words, Filters filters, uint64_t count, std::unique_ptr<MonitorScreen> screen)
      : words_(std::move(words)), filters_(std::move(filters)), limit_(count), screen_(std::move(screen)) {}

  // Times as in candump logs (kCandumpEpoch).
  void take(const runtime::LogEntry& entry);
  void take(runtime::Time time, const std::string& line, const runtime::Reception& reception);
  void take(const runtime::SerialEntry& entry);
  void take(const runtime::ProfibusEntry& entry);
  void take(runtime::Time time, const std::string& line, const profibus::Reception& reception);
  // Frames or bytes that were lost before they could be read. Losses in a row are shown once, with their sum
  // after.
  void lost(runtime::Time time, const std::string& line, uint64_t count, const char* what);
  // An error of the bus. Equal ones in a row are shown once and counted.
  void bus_error(runtime::Time time, const std::string& line, const std::string& text);
  void note(const std::string& text) const;

  // No more is wanted: so many telegrams were shown, or the user wants to end.
  bool full() const { return (limit_ != 0 && shown_ >= limit_) || (screen_ && screen_->ended()); }
  void flush();

  // Totals, to standard error.
  void finish();

 private:
  // Its text, if it is to be shown.
  std::optional<std::string> words(const runtime::Reception& reception);
  void show(runtime::Time time, const std::string& line, const std::string& text);
  void show(runtime::Time time, const std::string& line, const runtime::Reception& reception,
            const std::string& text);
  void begin_line();
  void end_repetition();

  runtime::BusWords words_;
  Filters filters_;
  uint64_t limit_;
  std::unique_ptr<MonitorScreen> screen_;
  uint64_t seen_ = 0;
  uint64_t shown_ = 0;
  uint64_t void_ = 0;
  uint64_t lost_ = 0;
  uint64_t errors_ = 0;
  std::string last_error_;
  uint64_t repeated_ = 0;
  const char* losing_ = nullptr;                 // what is being lost: the last line shown says so
  uint64_t lost_more_ = 0;                       // since then
  std::set<std::pair<bool, uint32_t>> unknown_;  // extended, identifier; at most kUnknown of them
};

}  // namespace ipos::tools
