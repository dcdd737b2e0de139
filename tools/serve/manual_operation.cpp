// A hand, five states, and three words on the line.
#include "tools/serve/manual_operation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/os_port/port_names.hpp"
#include "stdlib/parameters.hpp"
#include "tools/cli/failure.hpp"
#include "tools/serve/host/arguments.hpp"
#include "tools/serve/while.hpp"

namespace ipos::tools::serve {
namespace {

using namespace std::chrono_literals;

// All ours.
// The last word that enables goes out so long after the last `jog`. The exchange may repeat it, and the drive's monitoring
// follows: together less than 0.7 s, also where no stop reaches the drive.
constexpr auto kFresh = 150ms;
constexpr int32_t kSilence = 400;       // ms: of the monitoring, where it is off or too long
constexpr auto kLongestPeriod = 50ms;   // of the words
constexpr auto kShortestPeriod = 10ms;  // drives monitor them from 10 ms on (P812, P815)
constexpr auto kRetry = 200ms;          // of a value that was not taken back
constexpr auto kInhibitRetry = 1s;      // while the drive is not inhibited
constexpr auto kForgotten = 1s;         // without a `jog`, the button that another tab has stopped is off
constexpr int kProof = 3;               // answers: one or two may be late ones to words before the stop
constexpr double kDigitsOfRpm = 5;      // a speed word counts 0.2 rpm (1053 1610 p. 42)
constexpr uint16_t kEnable = 0x0006;    // control word 1: no inhibit, no rapid stop, no stop
constexpr uint16_t kStop = 0x0002;      // the stop with the ramp of the setpoint
static_assert(could_enable(std::array{kEnable}) && !could_enable(std::array{kStop}));

}  // namespace

ManualOperation::ManualOperation(BusLink& link, ParameterAccess& access, uint8_t address,
                                 std::function<void()> changed)
    : link_(link),
      access_(access),
      address_(address),
      changed_(std::move(changed)),
      borrowed_(access, link.port_name(), address),
      serial_(runtime::kind_of_port(link.port_name()) == runtime::PortKind::Serial) {}

void ManualOperation::enter(State state) {
  state_ = state;
  next_words_ = next_try_ = {};
  changed_();
}

void ManualOperation::hold(uint16_t client, double rpm, WallClock::time_point arrived) {
  if (stopped_ && stopped_->client == client) {
    const bool still_held = arrived - stopped_->last < kForgotten;
    stopped_->last = arrived;
    if (still_held) throw Mistake("another tab has stopped the drive: let go of the button first");
    stopped_.reset();
  }
  if (WallClock::now() > arrived + kJogHolds)
    throw Mistake("this order to move is too old: it has waited too long on its way");
  if (hand_ && hand_->client != client) throw Mistake("another client moves the drive");
  if (state_ == State::Stopping) throw Mistake("the drive has not answered the last stop yet");
  if (!link_.carries_process_data())
    throw Mistake("manual operation needs SBus or RS-485: over CANopen the page reaches parameters only");
  hand_ = Hand{client, static_cast<uint16_t>(static_cast<int16_t>(std::lround(rpm * kDigitsOfRpm))), arrived};
  if (state_ == State::Taking || state_ == State::Moving) return;
  enter(State::Taking);
  try {
    take_control();
  } catch (const std::runtime_error&) {
    hand_.reset();
    enter(State::GivingBack);
    throw;
  }
  // The caller that waits for the answer could not say more meanwhile.
  heard_ = WallClock::now();
  waits_until_ = heard_ + kJogHolds;
  enter(State::Moving);
}

void ManualOperation::let_go(uint16_t client) {
  if (hand_ && hand_->client == client) hand_.reset();
  if (stopped_ && stopped_->client == client) stopped_.reset();
  if (rests_for_ == client) rests_for_.reset();
}

void ManualOperation::stop(uint16_t client) {
  if (hand_ && hand_->client != client) stopped_ = Stopped{hand_->client, WallClock::now()};
  if (stopped_ && stopped_->client == client) stopped_.reset();
  hand_.reset();
}

// --- what the drive is asked and told ---

void ManualOperation::take_control() {
  const While asks(asks_);
  expect("870", "CTRL. WORD 1");
  expect("871", "SPEED");
  watch_over();
  use_this_line("100");
  use_this_line("101");
}

void ManualOperation::expect(const char* number, const char* text) {
  const stdlib::Parameter* row = stdlib::parameter_table(access_.unit()).find(std::string_view(number));
  const auto wanted =
      row == nullptr ? tl::expected<int32_t, std::string>(0) : stdlib::parse_parameter_text(*row, text);
  if (row == nullptr || !wanted) throw Mistake(fmt::format("this unit has no P{} = {}", number, text));
  if (borrowed_.read(row->index) != *wanted)
    throw Mistake(fmt::format("manual operation needs P{} = {}", number, text));
}

// A cable, this program and this computer may fail at any moment; then nobody but the drive can end the movement.
void ManualOperation::watch_over() {
  const auto lines =
      monitorings(serial_ ? WordLine::Rs485 : WordLine::Sbus, address_,
                  [this](uint16_t index) { return access_.execute(stdlib::Service::Read, index); });
  if (!lines) throw Mistake(lines.error().trouble);
  const stdlib::ParameterTable& table = stdlib::parameter_table(access_.unit());
  rests_for_.reset();
  period_ = kLongestPeriod;
  for (const Monitoring& line : *lines) {
    if (table.find(line.timeout) == nullptr)
      throw Mistake("this unit does not monitor the process data of this line, so it is not moved over it");
    int32_t timeout = borrowed_.read(line.timeout);
    if (!ends_in_time(timeout)) borrowed_.set(line.timeout, timeout = kSilence);
    period_ =
        std::clamp<WallClock::duration>(std::chrono::milliseconds(timeout) / 4, kShortestPeriod, period_);
    if (hand_ && !borrowed_.is_borrowed(line.timeout)) rests_for_ = hand_->client;
    const stdlib::Parameter* response = table.find(line.response);
    if (response != nullptr && lets_go_on(borrowed_.read(line.response)))
      borrowed_.set(line.response, static_cast<int32_t>(response->default_value));
  }
}

void ManualOperation::use_this_line(const char* number) {
  const char* text = serial_ ? "RS-485" : "SBus";
  const stdlib::Parameter* row = stdlib::parameter_table(access_.unit()).find(std::string_view(number));
  const auto wanted =
      row == nullptr ? tl::expected<int32_t, std::string>(0) : stdlib::parse_parameter_text(*row, text);
  if (row == nullptr || !wanted) throw Mistake(fmt::format("this unit has no P{} = {}", number, text));
  if (borrowed_.read(row->index) != *wanted) borrowed_.set(row->index, *wanted);
}

bool ManualOperation::send(uint16_t control, uint16_t speed) {
  const bool answered = link_.send_process_data(address_, {control, speed, 0});
  const auto now = WallClock::now();
  if (answered) heard_ = now;
  next_words_ = now + period_;
  return answered;
}

void ManualOperation::turn() {
  if (asks_) return;
  const While asks(asks_);
  const auto now = WallClock::now();
  switch (state_) {
    case State::Taking: return;
    case State::Moving: return move(now);
    case State::Stopping:
      if (now >= next_words_) stop_drive();
      return;
    case State::GivingBack:
      if (now >= next_try_) give_back(now);
      [[fallthrough]];
    case State::Idle:
      if (rests_for_ && now >= next_words_) send(kStop, 0);
  }
}

void ManualOperation::move(WallClock::time_point now) {
  const bool held = hand_ && now < hand_->arrived + kJogHolds;
  const bool silent = now - heard_ > std::chrono::milliseconds(kLongestSilence);
  if (silent || !(held || (hand_ && now < waits_until_))) {
    hand_.reset();
    answered_ = 0;
    unanswered_ = silent;
    enter(State::Stopping);
    return stop_drive();
  }
  if (now < next_words_) return;
  if (!held)
    send(kStop, 0);
  else if (now < hand_->arrived + kFresh)
    send(kEnable, hand_->speed);
}

void ManualOperation::stop_drive() {
  const bool answered = send(kStop, 0);
  answered_ = answered ? answered_ + 1 : 0;
  if (answered_ >= kProof) return enter(State::GivingBack);
  if (answered) next_words_ = {};
  if (!answered && !unanswered_) {
    unanswered_ = true;
    changed_();
  }
}

void ManualOperation::give_back(WallClock::time_point now) {
  const auto before = left();
  if (borrowed_.give_back()) return enter(State::Idle);
  next_try_ = now + (borrowed_.wait_for_inhibit() ? kInhibitRetry : kRetry);
  if (left() != before) changed_();
}

void ManualOperation::finish(WallClock::duration patience) {
  let_go();
  rests_for_.reset();
  const auto end = WallClock::now() + patience;
  if (state_ == State::Taking) enter(State::GivingBack);
  do {
    turn();
    if (state_ == State::Idle || (state_ == State::GivingBack && borrowed_.wait_for_inhibit())) break;
    link_.serve(runtime::kMillisecond);
  } while (WallClock::now() < end);
  for (const std::string& text : left()) fmt::print(stderr, "ipos: {}\n", text);
}

void ManualOperation::may_write() {
  if (state_ == State::Idle && !borrowed_.empty()) enter(State::GivingBack);
}

std::string ManualOperation::alarm() const {
  if (state_ != State::Stopping || !unanswered_) return {};
  return "The drive has not answered the stop. It is repeated until it does; meanwhile only the drive's own "
         "monitoring "
         "stops it. Use the emergency stop if it still turns.";
}

std::vector<std::string> ManualOperation::left() const {
  return state_ == State::Idle || state_ == State::GivingBack ? borrowed_.texts()
                                                              : std::vector<std::string>{};
}

}  // namespace ipos::tools::serve
