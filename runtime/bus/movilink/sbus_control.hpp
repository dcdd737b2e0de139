// A master control on the SBus: sends process data to the units, and the sync telegram at the start of each
// cycle (1053 1610 p. 38-39).
//
// Cycle of synchronous exchange, 5 ms by the manual: the sync telegram at its start; synchronous PO 3 ms
// later, which lies within the permitted 2.5 to 4.5 ms; the PI answers come after the next sync telegram.
// Other PO at any time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/bus/can/node.hpp"
#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

inline constexpr Time kSyncCycle = 5 * kMillisecond;
inline constexpr Time kSyncOutputAt =
    3 * kMillisecond;  // after the start of the cycle (ours, within the window)

// PO-sync must not begin outside of this part of the cycle (p. 39; the wider reading of its "500 us after").
inline constexpr Time kSyncWindowBegin = 1500 * kMicrosecond;
inline constexpr Time kSyncWindowEnd = 4500 * kMicrosecond;

struct ControlTarget {
  uint8_t address = 0;
  bool group = false;
  ProcessWords output{};
  Time every = 0;  // 0: synchronous, once a sync cycle
};

struct ControlSettings {
  std::optional<uint16_t> sync_id;  // none: no sync telegram
  Time cycle = kSyncCycle;
  std::vector<ControlTarget> targets;
};

class SbusControl final : public CanNode, private EventTarget {
 public:
  SbusControl(EventQueue& queue, uint32_t source, ControlSettings settings);

  // Begins now; `sender` is its place on the line.
  void start(FrameSender& sender);
  // Until the next start: it sends nothing, and no target has been asked or has answered.
  void stop();

  struct Answers {
    uint64_t asked = 0;  // single PO sent
    uint64_t answered = 0;
    Time last = 0;  // arrival of the last PI
    ProcessWords input{};
  };
  const ControlSettings& settings() const { return settings_; }
  // The words of a target from its next telegram on.
  void set_output(size_t target, const ProcessWords& words) { settings_.targets[target].output = words; }
  const Answers& answers(size_t target) const { return answers_[target]; }

  void on_frame(Time now, const Frame& frame) override;
  void on_sent(Time, const Frame&, uint64_t) override {}
  bool minds_repeats() const override { return false; }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  void on_bus_off(Time) override { sender_->recover(); }

 private:
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void send_output(size_t target);

  EventQueue& queue_;
  uint32_t source_;
  ControlSettings settings_;
  FrameSender* sender_ = nullptr;
  std::vector<Answers> answers_;
};

}  // namespace ipos::runtime
