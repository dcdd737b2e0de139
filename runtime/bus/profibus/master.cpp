// The master as a machine of three kinds of event: a frame of its own has gone out, something was heard, or
// its one timer has run out: the slot time after a request, or the silence of a lost token.
#include "runtime/bus/profibus/master.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace ipos::profibus {
namespace {

constexpr uint32_t kTokenAttempts = 3;
constexpr uint32_t kRotationsToHear = 2;  // before a master is ready for the ring

constexpr uint8_t request_code(FdlRequest request) {
  return static_cast<uint8_t>(control::kRequest | static_cast<uint8_t>(request));
}

// After which a master claims the ring: longer for higher addresses, so that the lowest one does.
constexpr Bits silence_of(const MasterSettings& settings) {
  return (6 + 2 * Bits{settings.address}) * settings.slot;
}

}  // namespace

Master::Master(runtime::EventQueue& queue, uint32_t source, Line& line, std::string name,
               MasterSettings settings, MasterClient* client)
    : queue_(queue),
      source_(source),
      line_(line),
      node_(line.attach(std::move(name), *this)),
      settings_(settings),
      client_(client) {
  if (settings_.slot == 0) settings_.slot = find_baud_rate(line.baud())->slot;
  set_next(settings_.address);
}

// The GAP starts again with each new successor.
void Master::set_next(uint8_t address) {
  next_ = address;
  gap_ = settings_.address;
}

size_t Master::add_slave(SlavePlan plan) {
  assert(state_ == State::Off);
  partners_.push_back(&slaves_.emplace_back(settings_.address, std::move(plan)));
  return slaves_.size() - 1;
}

void Master::start() { listen(); }

void Master::stop() {
  state_ = State::Off;
  in_ring_ = ready_ = false;
  queue_.cancel(std::exchange(timer_, runtime::kNoEvent));
}

// --- timer

void Master::arm(Bits at) {
  queue_.cancel(timer_);
  timer_ = queue_.schedule(line_.at(at), source_, *this, 0);
}

void Master::on_event(Time, uint32_t, uint64_t) {
  timer_ = runtime::kNoEvent;
  if (state_ == State::Listening || state_ == State::Idle) return silence_over();
  if (line_.is_busy()) return arm(line_.now() + settings_.slot);  // an answer that has begun is waited for
  slot_over();
}

void Master::listen() {
  state_ = State::Listening;
  in_ring_ = ready_ = false;
  list_.reset();
  rotations_heard_ = 0;
  await_silence();
}

void Master::await_silence() {
  const Bits timeout = silence_of(settings_);
  arm(std::max(line_.quiet_since() + timeout, line_.now() + 1));
}

void Master::silence_over() {
  const Bits timeout = silence_of(settings_);
  if (line_.is_busy() || line_.now() < line_.quiet_since() + timeout) {
    arm(std::max(line_.quiet_since(), line_.is_busy() ? line_.now() : 0) + timeout);
    return;
  }
  list_.reset();
  set_next(settings_.address);
  attempts_ = 0;
  send(State::Claiming, line_.now(), make_token(settings_.address, settings_.address));
}

void Master::slot_over() {
  switch (state_) {
    case State::AwaitAnswer: return repeat_or_give_up();
    case State::AwaitStatus: return work(line_.now());
    case State::PassingToken:
      if (++attempts_ < kTokenAttempts) return send(State::PassingToken, line_.now(), sent_);
      list_.reset(next_);
      set_next(next_in_list());
      return pass_token(line_.now());
    case State::Off:
    case State::Listening:
    case State::Idle:
    case State::Holding:
    case State::Claiming: return;
  }
}

// --- with the token

void Master::take_token(Bits from) {
  in_ring_ = ready_ = true;
  state_ = State::Holding;
  worked_ = gap_polled_ = false;
  ++rotations_;
  const Time now = queue_.now();
  hold_until_ = settings_.rotation == runtime::kNever ? runtime::kNever : token_at_ + settings_.rotation;
  token_at_ = now;
  if (turn_ == partners_.size()) {
    turn_ = 0;
    ++cycles_;
    const Bits bit = line_.now();
    cycle_bits_ = bit - std::exchange(cycle_from_, bit);
    if (client_ != nullptr) client_->on_cycle(now);
  }
  work(from);
}

void Master::work(Bits from) {
  queue_.cancel(std::exchange(timer_, runtime::kNoEvent));
  if (send_slave_request(from) || send_control(from) || send_gap_poll(from)) return;
  pass_token(from);
}

bool Master::send_slave_request(Bits from) {
  if (worked_ && queue_.now() >= hold_until_) return false;
  while (turn_ < partners_.size()) {
    auto request = partners_[turn_]->request(queue_.now());
    if (!request) {
      ++turn_;
      continue;
    }
    worked_ = true;
    attempts_ = 0;
    send(State::AwaitAnswer, from, std::move(*request));
    return true;
  }
  return false;
}

bool Master::send_control(Bits from) {
  if (controls_.empty()) return false;
  const GlobalCommand command = controls_.front();
  controls_.pop_front();
  send(State::Holding, from,
       make_frame(kBroadcast, settings_.address, request_code(FdlRequest::SdnHigh),
                  static_cast<uint8_t>(DpService::GlobalControl), kMasterAccessPoint,
                  {command.command, command.groups}));
  return true;
}

// The GAP: all addresses from its own to that of the next master.
bool Master::send_gap_poll(Bits from) {
  if (gap_polled_ || settings_.gap_factor == 0 || rotations_ < settings_.gap_factor) return false;
  const auto above = [this](uint8_t address) {
    return address >= settings_.highest ? uint8_t{0} : static_cast<uint8_t>(address + 1);
  };
  gap_ = above(gap_);
  if (gap_ == next_ || gap_ == settings_.address) gap_ = above(settings_.address);  // once round
  if (gap_ == next_ || gap_ == settings_.address) return false;                     // there is none
  gap_polled_ = true;
  rotations_ = 0;
  send(State::AwaitStatus, from, make_frame(gap_, settings_.address, request_code(FdlRequest::FdlStatus)));
  return true;
}

void Master::pass_token(Bits from) {
  attempts_ = 0;
  send(State::PassingToken, from, make_token(next_, settings_.address));
}

void Master::send(State then, Bits from, FdlFrame frame) {
  state_ = then;
  sent_ = std::move(frame);
  line_.send(node_, from + kSynBits, sent_);
}

void Master::on_sent(Time) {
  const Bits now = line_.now();
  switch (state_) {
    case State::Holding: return work(now + settings_.idle_2);
    case State::Claiming:
      if (++attempts_ < 2) return send(State::Claiming, now, sent_);  // the claim is made twice
      attempts_ = 0;
      return take_token(now + settings_.idle_2);
    case State::PassingToken:
      if (next_ == settings_.address) return take_token(now + settings_.idle_2);
      return arm(now + settings_.slot);
    case State::AwaitAnswer:
    case State::AwaitStatus: return arm(now + settings_.slot);
    case State::Off:
    case State::Listening:
    case State::Idle: return;  // an answer to another master
  }
}

void Master::repeat_or_give_up() {
  if (attempts_++ < settings_.retries) {
    ++repetitions_;
    return send(State::AwaitAnswer, line_.now(), sent_);
  }
  partners_[turn_++]->unanswered();
  work(line_.now());
}

// --- what it hears

void Master::on_reception(Time, const Reception& reception) {
  if (state_ == State::Off) return;
  if (!reception.frame) return hear_garbage();
  const FdlFrame& frame = *reception.frame;
  if (frame.is_token()) return hear_token(frame);
  if (frame.is_request()) return hear_request(frame);
  hear_answer(frame);
}

void Master::hear_garbage() {
  if (state_ == State::AwaitAnswer) {
    partners_[turn_]->garbled();
    repeat_or_give_up();
  } else if (state_ == State::AwaitStatus) {
    work(line_.now());
  } else if (state_ == State::PassingToken) {  // somebody talks
    state_ = State::Idle;
    await_silence();
  }
}

void Master::hear_answer(const FdlFrame& answer) {
  if (state_ != State::AwaitAnswer && state_ != State::AwaitStatus) return;
  const bool ours = answer.is_acknowledgement() ||
                    (answer.destination == settings_.address && answer.source == sent_.destination);
  if (!ours) return hear_garbage();
  const Bits from = line_.now() + settings_.idle_1;
  if (state_ == State::AwaitAnswer) {
    partners_[turn_++]->answered(queue_.now(), answer);
  } else if (answer.has_control() && answer.station() >= StationKind::MasterReady) {
    list_.set(answer.source);
    set_next(answer.source);
  }
  work(from);
}

// Another master that talks while this one thinks it has the token: it gives way.
void Master::hear_request(const FdlFrame& request) {
  if (state_ == State::PassingToken) {  // the token has arrived
    state_ = State::Idle;
    await_silence();
  } else if (state_ == State::Holding || state_ == State::AwaitAnswer || state_ == State::AwaitStatus) {
    return listen();
  }
  if (request.destination != settings_.address) return;
  unsigned code = static_cast<unsigned>(in_ring_ ? StationKind::MasterInRing
                                        : ready_ ? StationKind::MasterReady
                                                 : StationKind::MasterNotReady)
                  << 4;
  if (request.asks(FdlRequest::SdnLow) || request.asks(FdlRequest::SdnHigh)) return;
  if (!request.asks(FdlRequest::FdlStatus)) code |= static_cast<uint8_t>(FdlAnswer::NoService);
  line_.send(node_, line_.now() + kLeastMinTsdr,
             make_frame(request.source, settings_.address, static_cast<uint8_t>(code)));
}

// Nobody between sender and receiver of a token is in the ring.
void Master::hear_token(const FdlFrame& token) {
  if (state_ == State::Holding || state_ == State::AwaitAnswer || state_ == State::AwaitStatus ||
      state_ == State::Claiming)
    return listen();
  const uint8_t own = settings_.address;
  const auto steps = [](uint8_t from, uint8_t to) {  // upwards round the ring, 1..127
    const int way = (to - from + kBroadcast) % kBroadcast;
    return way == 0 ? int{kBroadcast} : way;
  };
  const bool skipped =
      steps(token.source, own) < steps(token.source, token.destination) && token.source != own;
  for (int way = 1; way < steps(token.source, token.destination); ++way)
    list_.reset(static_cast<size_t>((token.source + way) % kBroadcast));
  list_.set(token.source);
  list_.set(token.destination);
  if (state_ == State::Listening) {
    if (rotations_heard_ == 0) watched_ = token;
    if (token == watched_ && ++rotations_heard_ > kRotationsToHear) {
      ready_ = true;
      state_ = State::Idle;
    }
    return;
  }
  if (state_ == State::PassingToken) {
    state_ = State::Idle;
    await_silence();
  }
  if (skipped && in_ring_) return listen();
  if (token.destination != own || !ready_) return;
  if (next_ != next_in_list()) set_next(next_in_list());
  take_token(line_.now() + settings_.idle_2);
}

uint8_t Master::next_in_list() const {
  for (int way = 1; way < kBroadcast; ++way) {
    const auto address = static_cast<uint8_t>((settings_.address + way) % kBroadcast);
    if (list_.test(address)) return address;
  }
  return settings_.address;
}

}  // namespace ipos::profibus
