// The master side of one MOVLNK exchange over SBus (1053 1610 p. 47-49): the parameter request first, then
// the process output data, each with its answer; a group gets its telegrams and gives none.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "runtime/bus/can/node.hpp"
#include "runtime/bus/movilink/format.hpp"
#include "runtime/bus/movilink/parameter_telegram.hpp"
#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

inline constexpr int32_t kGroupAddressBase = 100;  // MOVLNK address = group address + 100

// The elements of MOVLNK and MLDATA that go out.
struct SbusJob {
  int32_t address = 0;  // 0..63 or 100..163
  int32_t format = 0;
  int32_t service = 0;
  int32_t index = 0;  // subindex in bits 16..23
  int32_t write_value = 0;
  std::array<int32_t, 3> output{};  // the low 16 bits are sent
};

// What came back; after an error neither read value nor input words.
struct SbusResult {
  uint32_t result = 0;                // 0 or a packed return code
  std::optional<int32_t> read_value;  // of a reading service
  uint8_t words = 0;                  // input words to store: as many as the format has
  std::array<int32_t, 3> input{};     // with sign
};

class SbusMasterClient {
 public:
  virtual void on_exchange_done(Time now, const SbusResult& result) = 0;

 protected:
  ~SbusMasterClient() = default;
};

inline constexpr Time kSbusReplyTimeout = 50 * kMillisecond;  // ours, as on RS-485 (1053 1610 p. 27)

class SbusMaster final : private EventTarget {
 public:
  // `timeout` bounds the wait for each answer; `tag` marks the frames of this master at the sender.
  SbusMaster(EventQueue& queue, uint32_t source, FrameSender& sender, uint64_t tag, Time timeout,
             SbusMasterClient& client);

  bool busy() const { return step_ != Step::Idle; }

  // Begins an exchange; must not be busy(). A job that cannot be sent is refused at once (class 5, code 5);
  // otherwise the client hears the result later, never from within this call.
  std::optional<ReturnCode> start(Time now, const SbusJob& job);

  // Gives up without a result: program stop or reset.
  void abort();

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
  SbusMasterClient& client_;

  Step step_ = Step::Idle;
  EventId timer_ = kNoEvent;
  bool group_ = false;
  uint8_t address_ = 0;
  TelegramFormat format_;
  ParameterTelegram request_;
  ProcessWords output_{};
  SbusResult result_;
};

}  // namespace ipos::runtime
