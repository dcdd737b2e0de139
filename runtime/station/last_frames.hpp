// The last data frame of each identifier of a CAN line, from the moment on that somebody asks for one: a line that nobody
// asks has no such list.
#pragma once

#include <unordered_map>

#include "runtime/bus/can/line.hpp"

namespace ipos::runtime {

struct LastFrame {
  Frame frame;
  uint64_t count = 0;
};

class LastFrames final : public CanObserver {
 public:
  explicit LastFrames(CanLine& line) { line.add_observer(static_cast<CanObserver&>(*this)); }

  // Nothing has come: an empty frame, counted 0 times.
  const LastFrame& of(uint32_t id, bool extended) const {
    const auto found = frames_.find(key(id, extended));
    return found == frames_.end() ? nothing_ : found->second;
  }

 private:
  static uint32_t key(uint32_t id, bool extended) { return id | (extended ? kExtendedIdLimit : 0); }
  void on_frame(const CanLine&, const FrameRecord& record) override {
    if (record.frame.remote) return;
    LastFrame& last = frames_[key(record.frame.id, record.frame.extended)];
    last.frame = record.frame;
    ++last.count;
  }
  void on_line_event(const CanLine&, const LineEvent&) override {}

  LastFrame nothing_;
  std::unordered_map<uint32_t, LastFrame> frames_;
};

}  // namespace ipos::runtime
