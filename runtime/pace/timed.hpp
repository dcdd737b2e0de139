// What lives in milliseconds, as a Pacer drives it. It reads no clock and schedules nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime/clock/event_queue.hpp"
#include "runtime/part/part.hpp"

namespace ipos::runtime {

class Timed {
 public:
  // One millisecond, all of it but what is sent: the reference (docs/inside/cycle.md). False: it stops in the middle;
  // Pacer::resume() says when it has come to its end.
  virtual bool tick(Time now) = 0;

  // Sends what is due after the tick at `now`. Returns the next tick that sends something; kNever for none.
  virtual Time send(Time now) = 0;

  // --- asked of a lazy one only ---
  // How many of the ticks from `first` on advance() can do. 0: the next one is tick().
  virtual Ticks horizon(Time first) = 0;
  // Does `most` ticks at once, or as many of them as it can, and returns how many. 0: nothing has changed, and
  // the next one is tick().
  virtual Ticks advance(Time first, Ticks most) = 0;
  // How many ticks from `first` on may run late unnoticed, telegrams aside.
  virtual Ticks silence(Time first) = 0;
  // advance() may leave what only a reader needs; this does it.
  virtual void settle() = 0;
  // Somebody is about to write. Everything is settled.
  virtual void touched() = 0;
  // A telegram that has waited is about to be read. The ticks in front of it are executed, but not settled.
  virtual void before_telegram() = 0;
  // A telegram that only writes variables can wait until the ticks have come as far as it.
  virtual bool lets_wait() const = 0;
  // In all of this silence nothing changes that others can see, and what is sent is the same without its ticks.
  virtual bool rests() const = 0;
  // send() in such a silence, which ends at `until`. What it sends may be left to somebody else up to then.
  virtual Time send_at_rest(Time now, Time /*until*/) { return send(now); }
  // The rest is over, at its end or before: nothing is left to others any more.
  virtual void rest_ends() {}

 protected:
  ~Timed() = default;
};

// The data of a telegram.
struct TelegramData {
  std::array<uint8_t, 8> bytes{};
  uint8_t length = 0;
};

// Who reads a telegram that has waited: its number and its data, as they were posted.
class TelegramReader {
 public:
  virtual void read(size_t number, const TelegramData& data) = 0;

 protected:
  ~TelegramReader() = default;
};

}  // namespace ipos::runtime
