// A station that puts the frames of a log on a simulated line at their times. The log has the moment of
// delivery, so a frame is queued so much earlier that it is delivered then if the line is free.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/bus/can/node.hpp"
#include "runtime/bus/log/candump.hpp"

namespace ipos::runtime {

class Replay final : public CanNode, private EventTarget {
 public:
  // Times of the entries are moved so that the first one is at `begin` or, where its own length forbids, a
  // little later.
  Replay(EventQueue& queue, uint32_t source, std::vector<LogEntry> entries, Time begin);

  // `bit_time` of the line; `sender` is the place on it.
  void start(FrameSender& sender, Time bit_time);

  uint64_t sent() const { return sent_; }        // got through
  uint64_t refused() const { return refused_; }  // the station's queue was full, or it is not on the line
  size_t frames() const { return entries_.size(); }
  Time end() const {
    return entries_.empty() ? 0 : entries_.back().time;
  }  // of the last frame, in virtual time

  void on_frame(Time, const Frame&) override {}
  void on_sent(Time, const Frame&, uint64_t) override { ++sent_; }
  bool minds_repeats() const override { return false; }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent reason) override;
  void on_bus_off(Time) override { sender_->recover(); }

 private:
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void schedule(size_t entry);

  EventQueue& queue_;
  uint32_t source_;
  std::vector<LogEntry> entries_;  // in rising order of time
  FrameSender* sender_ = nullptr;
  Time bit_time_ = 0;
  uint64_t sent_ = 0;
  uint64_t refused_ = 0;
};

}  // namespace ipos::runtime
