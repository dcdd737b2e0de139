// The master side of one MOVLNK exchange over SBus (1053 1610 p. 47-49): the parameter request first, then
// the process output data, each with its answer; a group gets its telegrams and gives none.
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/bus/can/node.hpp"
#include "runtime/bus/movilink/exchange.hpp"
#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

inline constexpr int32_t kGroupAddressBase = 100;  // MOVLNK address = group address + 100

inline constexpr Time kSbusReplyTimeout = 50 * kMillisecond;  // ours, as on RS-485 (1053 1610 p. 27)

class SbusMaster final : public MovilinkMaster, private EventTarget {
 public:
  // `timeout` bounds the wait for each answer; `tag` marks the frames of this master at the sender.
  SbusMaster(EventQueue& queue, uint32_t source, FrameSender& sender, uint64_t tag, Time timeout,
             MovilinkClient& client);

  bool busy() const { return step_ != Step::Idle; }

  // Addresses 0..63, groups 100..163.
  std::optional<ReturnCode> start(Time now, const MovilinkJob& job) override;
  void abort() override;

  bool on_frame(Time now, const Frame& frame);  // true when it was the awaited answer
  void on_sent(Time now, uint64_t tag);

 private:
  enum class Step : uint8_t { Idle, Parameter, Process };

  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void send_request(Time now);
  void send_output(Time now);
  void finish_parameter(Time now);
  void finish(Time now);
  void await(Time now, Step step);

  EventQueue& queue_;
  uint32_t source_;
  FrameSender& sender_;
  uint64_t tag_;
  Time timeout_;
  MovilinkClient& client_;

  Step step_ = Step::Idle;
  EventId timer_ = kNoEvent;
  bool group_ = false;
  uint8_t address_ = 0;
  TelegramFormat format_;
  ParameterTelegram request_;
  ProcessWords output_{};
  MovilinkResult result_;
};

}  // namespace ipos::runtime
