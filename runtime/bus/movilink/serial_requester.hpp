// Requests over RS-485 by the rules of the line (1053 1610 p. 19-28): pauses before SD1, the wait for the
// response, repeats. One requester serves all who send requests at one interface of a unit, in order.
#pragma once

#include <vector>

#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/rs485/node.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

enum class RequestEnd : uint8_t {
#define REQUEST_END(name, text) name,
#include "runtime/bus/movilink/request_ends.def"
};
std::string_view request_end_text(RequestEnd end);

class RequesterClient {
 public:
  // `response` is there when Answered, and null otherwise.
  virtual void on_request_done(Time now, RequestEnd end, const SerialTelegram* response) = 0;

 protected:
  ~RequesterClient() = default;
};

struct RequesterTiming {
  Time response_delay = kResponseDelay;
  Time line_wait = kSecond;  // ours: for a line that never falls silent
  uint32_t repeats = 1;      // "possible send repeat" (p. 28); their number is ours
  Time character = character_time(9'600);
};

class SerialRequester final : private EventTarget {
 public:
  SerialRequester(EventQueue& queue, uint32_t source, SerialSender& sender, RequesterTiming timing = {});
  ~SerialRequester() { queue_.cancel_all(*this); }
  SerialRequester(const SerialRequester&) = delete;
  SerialRequester& operator=(const SerialRequester&) = delete;

  // Sends now or after the requests before it. The client hears the end later, never from within this call.
  void start(Time now, const SerialTelegram& request, RequesterClient& client);

  // Forgets the requests of this client; one on the line is broken off.
  void abort(Time now, const RequesterClient& client);

  bool busy() const { return !jobs_.empty(); }
  const SerialStatistics& statistics() const { return statistics_; }

  void on_character(Time now, const Character& character);
  void on_sent(Time now);  // also of what others of this station sent

 private:
  enum class Step : uint8_t { Idle, Pause, Sending, Awaiting, Receiving };
  struct Job {
    SerialTelegram request;
    RequesterClient* client;
  };

  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void begin(Time now);
  void begin_attempt(Time now);
  void send(Time now);
  void cut_off(Time now);
  void attempt_failed(Time now, RequestEnd reason);
  void finish(Time now, RequestEnd end, const SerialTelegram* response);
  void set_timer(Time at);
  bool is_answer(const SerialTelegram& telegram) const;

  EventQueue& queue_;
  uint32_t source_;
  SerialSender& sender_;
  RequesterTiming timing_;
  SerialReceiver receiver_;
  SerialStatistics statistics_;
  std::vector<Job> jobs_;  // the first one is being done
  Step step_ = Step::Idle;
  uint32_t attempts_ = 0;
  EventId timer_ = kNoEvent;
  Time next_start_ = 0;  // no SD1 before
  Time give_up_ = 0;     // end of the wait for a quiet line
  Time own_end_ = 0;     // of what this station sent last
};

}  // namespace ipos::runtime
