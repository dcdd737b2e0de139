// The slave side of one unit on SBus (1053 1610 p. 37-46): answers process and parameter telegrams to its
// address, takes group telegrams in silence, and holds synchronous answers back until the sync telegram.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "runtime/bus/can/node.hpp"
#include "runtime/bus/movilink/identifiers.hpp"
#include "runtime/bus/movilink/ignored.hpp"
#include "runtime/bus/movilink/profile.hpp"
#include "runtime/bus/movilink/unit_servers.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

class SlaveObserver {
 public:
  // `code` is set for a refused group write.
  virtual void on_ignored(Time now, const Frame& frame, Ignored reason, ReturnCode code) = 0;

 protected:
  ~SlaveObserver() = default;
};

// Both ours; a PI telegram must come within one millisecond (p. 39).
struct SlaveTiming {
  Time process_delay = 200 * kMicrosecond;
  Time parameter_delay = 2 * kMillisecond;
};

class SbusSlave final : private EventTarget {
 public:
  // `tag` marks the frames of this slave at the sender.
  SbusSlave(EventQueue& queue, uint32_t source, FrameSender& sender, uint64_t tag, SlaveSettings settings,
            SlaveTiming timing, ParameterServer& parameters, ProcessDataServer& process_data,
            SlaveObserver* observer = nullptr);
  ~SbusSlave() { queue_.cancel_all(*this); }  // answers under way
  SbusSlave(const SbusSlave&) = delete;
  SbusSlave& operator=(const SbusSlave&) = delete;

  void configure(SlaveSettings settings);
  const SlaveSettings& settings() const { return settings_; }

  // True when the frame is a MOVILINK telegram to this unit, or its sync telegram.
  bool on_frame(Time now, const Frame& frame);
  bool is_sync(const Frame& frame) const;  // has the identifier of this unit's sync telegram

 private:
  bool is_movilink(uint32_t id) const;  // a MOVILINK telegram from a master to this unit
  void listen();
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void take_telegram(Time now, const Frame& frame, Telegram telegram);
  ParameterTelegram carry_out(Time now, const ParameterTelegram& request);
  void take_request(Time now, const Frame& frame, uint8_t channel);
  void take_group_request(Time now, const Frame& frame);
  void take_sync(Time now);
  void ignore(Time now, const Frame& frame, Ignored reason, ReturnCode code = {});

  EventQueue& queue_;
  uint32_t source_;
  FrameSender& sender_;
  uint64_t tag_;
  SlaveSettings settings_;
  SlaveTiming timing_;
  ParameterServer& parameters_;
  ProcessDataServer& process_data_;
  SlaveObserver* observer_;
  std::optional<ProcessWords> sync_output_;                         // waits for the sync telegram
  std::array<std::optional<ParameterTelegram>, 2> sync_responses_;  // the same, one a channel
};

}  // namespace ipos::runtime
