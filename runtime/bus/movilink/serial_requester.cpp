// One request after the other: pause, send, wait for the response, repeat.
#include "runtime/bus/movilink/serial_requester.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace ipos::runtime {

std::string_view request_end_text(RequestEnd end) {
  static constexpr std::string_view kTexts[] = {
#define REQUEST_END(name, text) text,
#include "runtime/bus/movilink/request_ends.def"
  };
  return kTexts[static_cast<size_t>(end)];
}

SerialRequester::SerialRequester(EventQueue& queue, uint32_t source, SerialSender& sender,
                                 RequesterTiming timing)
    : queue_(queue), source_(source), sender_(sender), timing_(timing) {}

void SerialRequester::set_timer(Time at) {
  queue_.cancel(timer_);
  timer_ = queue_.schedule(at, source_, *this, 0);
}

void SerialRequester::start(Time now, const SerialTelegram& request, RequesterClient& client) {
  jobs_.push_back({request, &client});
  if (jobs_.size() == 1) begin(now);
}

void SerialRequester::begin(Time now) {
  assert(!jobs_.empty());
  attempts_ = 0;
  begin_attempt(now);
}

void SerialRequester::begin_attempt(Time now) {
  ++attempts_;
  step_ = Step::Pause;
  give_up_ = now + timing_.line_wait;
  set_timer(std::max(now, next_start_));
}

void SerialRequester::abort(Time now, const RequesterClient& client) {
  const auto mine = [&client](const Job& job) { return job.client == &client; };
  if (jobs_.empty()) return;
  const bool running = mine(jobs_.front());
  std::erase_if(jobs_, mine);
  if (!running) return;
  if (step_ == Step::Sending) {
    sender_.break_off();
    own_end_ = now + timing_.character;
    receiver_.occupied(own_end_);
    next_start_ = own_end_ + kAbortPause;
  }
  queue_.cancel(std::exchange(timer_, kNoEvent));
  step_ = Step::Idle;
  if (!jobs_.empty()) begin(now);
}

void SerialRequester::send(Time now) {
  step_ = Step::Sending;
  const SerialBytes bytes = encode(jobs_.front().request);
  if (!sender_.send(bytes.span())) return cut_off(now);
  set_timer(now + (bytes.size + 1) * timing_.character);  // on_sent() comes before, unless the line is cut
}

// No response will come.
void SerialRequester::cut_off(Time now) {
  step_ = Step::Awaiting;
  own_end_ = now;
  set_timer(now + timing_.response_delay);
}

void SerialRequester::on_sent(Time now) {
  own_end_ = now;
  receiver_.occupied(now);
  next_start_ = std::max(next_start_, now + kStartPause);
  if (step_ != Step::Sending) return;
  const uint8_t address = jobs_.front().request.address;
  if (address_kind(address) == AddressKind::Broadcast) next_start_ = now + kBroadcastPause;
  if (!is_answered(address)) return finish(now, RequestEnd::Sent, nullptr);
  step_ = Step::Awaiting;
  // A start character that begins in time is known only when it has ended.
  set_timer(now + timing_.response_delay + timing_.character);
}

bool SerialRequester::is_answer(const SerialTelegram& telegram) const {
  const SerialTelegram& request = jobs_.front().request;
  // A slave answers 254 with 254 or with its own address (ours: the manual names neither).
  const bool right_address =
      telegram.address == request.address ||
      (request.address == kUniversalAddress && address_kind(telegram.address) == AddressKind::Single);
  return telegram.response && right_address && telegram.format == request.format;
}

void SerialRequester::on_character(Time now, const Character& character) {
  if (step_ == Step::Sending || character.start < own_end_) return;  // an echo, or a collision
  next_start_ = std::max(next_start_, character.end + kStartPause);
  const bool in_time = character.start - own_end_ <= timing_.response_delay;
  const bool was_receiving = receiver_.receiving();
  const auto reception = receiver_.take(character);
  if (reception && !reception->telegram) statistics_.count(reception->telegram.error());
  if (step_ == Step::Awaiting && !was_receiving && receiver_.receiving() && in_time) step_ = Step::Receiving;
  if (step_ != Step::Receiving) return;
  if (!reception) return set_timer(receiver_.deadline() + timing_.character);
  if (!reception->telegram) return attempt_failed(now, RequestEnd::Disturbed);
  if (is_answer(*reception->telegram)) return finish(now, RequestEnd::Answered, &*reception->telegram);
  // Somebody else's telegram: the wait goes on, if there is time left.
  step_ = Step::Awaiting;
  set_timer(std::max(now, own_end_ + timing_.response_delay + timing_.character));
}

void SerialRequester::on_event(Time now, uint32_t /*kind*/, uint64_t /*argument*/) {
  timer_ = kNoEvent;
  switch (step_) {
    case Step::Pause:
      if (now >= next_start_) return send(now);
      if (now >= give_up_) return finish(now, RequestEnd::LineBusy, nullptr);
      return set_timer(std::min(next_start_, give_up_));
    case Step::Awaiting:
      statistics_.count(SerialError::NoResponse);
      return attempt_failed(now, RequestEnd::NoResponse);
    case Step::Receiving:  // the response stopped in the middle
      if (const auto cut = receiver_.give_up()) statistics_.count(cut->telegram.error());
      return attempt_failed(now, RequestEnd::Disturbed);
    case Step::Sending: return cut_off(now);
    case Step::Idle: return;
  }
}

// The pause before the next request is kept from here on, so that a response that comes too late is heard
// (ours).
void SerialRequester::attempt_failed(Time now, RequestEnd reason) {
  next_start_ = std::max(next_start_, now + kStartPause);
  if (attempts_ > timing_.repeats) return finish(now, reason, nullptr);
  begin_attempt(now);
}

void SerialRequester::finish(Time now, RequestEnd end, const SerialTelegram* response) {
  queue_.cancel(std::exchange(timer_, kNoEvent));
  step_ = Step::Idle;
  RequesterClient* client = jobs_.front().client;
  jobs_.erase(jobs_.begin());
  if (!jobs_.empty()) begin(now);
  client->on_request_done(now, end, response);
}

}  // namespace ipos::runtime
