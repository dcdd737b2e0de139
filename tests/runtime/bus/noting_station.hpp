// Stations and an observer that note all that they are told of a CAN line, for tests of two lines against each other.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "runtime/bus/can/line.hpp"

namespace ipos::runtime {

class NotingStation final : public CanNode {
 public:
  // `minds`: repetitions that nobody acknowledges, each of them.
  explicit NotingStation(bool minds) : minds_(minds) {}
  void on_frame(Time now, const Frame& frame) override { heard.emplace_back('r', now, frame.id, frame.data[0]); }
  void on_sent(Time now, const Frame& frame, uint64_t tag) override { heard.emplace_back('s', now, frame.id, tag); }
  void on_not_sent(Time now, const Frame& frame, uint64_t tag, NotSent reason) override {
    ++failures;
    if (minds_ || reason != NotSent::NoAcknowledge)
      heard.emplace_back("ncxd"[static_cast<size_t>(reason)], now, frame.id, tag);
  }
  bool minds_repeats() const override { return minds_; }
  void on_bus_off(Time now) override {
    heard.emplace_back('b', now, 0, 0);
    line->recover(node);
  }

  CanLine* line = nullptr;
  NodeId node = 0;
  std::vector<std::tuple<char, Time, uint32_t, uint64_t>> heard;
  uint64_t failures = 0;

 private:
  bool minds_;
};

class NotingObserver final : public CanObserver {
 public:
  void on_frame(const CanLine&, const FrameRecord& record) override {
    frames.emplace_back(record.start, record.end, record.bits, record.sender, record.frame.id, record.frame.data[0]);
  }
  void on_line_event(const CanLine& line, const LineEvent& event) override {
    events.push_back(std::to_string(event.time) + ' ' + describe(line, event));
  }
  std::vector<std::tuple<Time, Time, uint32_t, NodeId, uint32_t, int>> frames;
  std::vector<std::string> events;
};

inline std::array<uint64_t, 5> load_of(const CanLine& line, Time now) {
  const LineLoad load = line.load(now);
  return {load.frames, load.busy_bits, load.percent, load.window_percent, load.peak_window_percent};
}

}  // namespace ipos::runtime
