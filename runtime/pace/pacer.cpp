// The order of ticks and telegrams, and when the next event comes.
#include "runtime/pace/pacer.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace ipos::runtime {

void Pacer::start() {
  assert(!runs_ && inbox_.next() == kNever);  // a telegram waits only for ticks that are pending
  done_to_ = queue_.now();
  milliseconds_.begin(done_to_);
  behind_ = rests_ = false;
  event_ = queue_.schedule(done_to_, source_, *this, 0);
}

void Pacer::stop() {
  catch_up();
  end_rest();
  behind_ = false;
  queue_.cancel(event_);
}

void Pacer::use(Pace pace) {
  touch();
  pace_ = pace;
}

void Pacer::on_event(Time now, uint32_t /*kind*/, uint64_t /*argument*/) {
  if (rests_ && now < silent_to_) {
    event_ = queue_.schedule(std::min(timed_.send_at_rest(now, silent_to_), silent_to_), source_, *this, 0);
    return;
  }
  end_rest();
  if (run_to(now)) plan(now);
}

// All ticks up to that at `last`, and the telegrams that came in between. Each finds the time that it belongs
// to. False: a tick stopped in the middle.
bool Pacer::run_to(Time last) {
  if (done_to_ > last && inbox_.next() > last) return true;
  const bool nested = std::exchange(runs_, true);
  EventQueue::Past past(queue_, done_to_, source_);
  for (;;) {
    const Time until = std::min(last, inbox_.next());
    while (done_to_ <= until) {
      const Time first = done_to_;
      past.go_to(first);
      if (pace_ == Pace::Lazy)
        if (const Ticks horizon = timed_.horizon(first); horizon != 0) {
          const auto left = static_cast<uint64_t>(milliseconds_.count(until - first) + 1);
          const auto most = static_cast<Ticks>(std::min<uint64_t>(horizon, left));
          const Ticks executed = timed_.advance(first, most);
          assert(executed <= most);
          done_to_ += static_cast<Time>(executed) * milliseconds_.length();
          if (executed != 0) continue;
        }
      done_to_ += milliseconds_.length();
      if (!timed_.tick(first)) {
        assert(pace_ == Pace::InTurn && !nested);
        runs_ = false;
        return false;
      }
    }
    if (inbox_.next() > last) break;
    timed_.before_telegram();
    inbox_.read_next();
  }
  runs_ = nested;
  return true;
}

void Pacer::resume() {
  assert(pace_ == Pace::InTurn && !runs_);
  plan(queue_.now());
}

// After the tick at `now`: what is due is sent, and the next event is the next tick, the end of the silence
// or the next telegram.
void Pacer::plan(Time now) {
  const Time telegram = timed_.send(now);
  silent_to_ = done_to_;
  if (pace_ == Pace::Lazy && telegram > done_to_)
    silent_to_ += static_cast<Time>(timed_.silence(done_to_)) * milliseconds_.length();
  const Time next = std::min(telegram, silent_to_);
  behind_ = next > done_to_;
  rests_ = behind_ && timed_.rests();
  if (!behind_) timed_.settle();
  event_ = queue_.schedule(next, source_, *this, 0);
}

// The tick of this moment counts when its turn is over. Ticks come a millisecond after the other from the first one on,
// which may lie between two whole milliseconds: a unit is switched on at any time.
Time Pacer::last_tick() const {
  const Time now = queue_.now();
  const Time last = begun_tick();
  return last == now && !queue_.has_passed(source_) ? last - milliseconds_.length() : last;
}

// Of this millisecond.
Time Pacer::begun_tick() const { return milliseconds_.begin_of(queue_.now()); }

void Pacer::catch_up_after_tick() {
  if (!behind_) return;
  run_to(begun_tick());
  timed_.settle();
}

void Pacer::make_up() {
  run_to(last_tick());
  timed_.settle();
}

void Pacer::touch() {
  catch_up();
  timed_.touched();
  if (!behind_ || runs_) return;
  end_rest();
  behind_ = false;
  queue_.cancel(event_);
  event_ = queue_.schedule(done_to_, source_, *this, 0);
}

void Pacer::align(Time behind, Time most) {
  touch();
  if (runs_) return;
  const Time length = milliseconds_.length();
  Time late = done_to_ - queue_.now() - behind;
  if (late > length / 2) late -= length;
  const Time shift = std::clamp(-late, -most, most);
  if (shift == 0) return;
  done_to_ += shift;
  milliseconds_.shift(shift);
  queue_.cancel(event_);
  event_ = queue_.schedule(done_to_, source_, *this, 0);
}

bool Pacer::post(TelegramReader& reader, size_t number, const TelegramData& data) {
  if (!behind_ || inbox_.full() || !timed_.lets_wait()) return false;
  inbox_.post(last_tick(), reader, number, data);
  return true;
}

}  // namespace ipos::runtime
