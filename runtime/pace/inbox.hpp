// Telegrams that wait until the ticks of their reader have come as far as they.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "runtime/pace/timed.hpp"

namespace ipos::runtime {

class Inbox {
 public:
  static constexpr size_t kMost = 4;

  bool full() const { return posted_ == kMost; }

  // A telegram that came after the tick at `after`, in the order of time.
  void post(Time after, TelegramReader& reader, size_t number, const TelegramData& data) {
    assert(!full());
    assert(posted_ == 0 || after >= telegrams_[posted_ - 1U].after);
    if (read_ == posted_) next_ = after;
    telegrams_[posted_++] = {after, &reader, number, data};
  }

  // The tick after which the next one came; kNever for none.
  Time next() const { return next_; }

  void read_next() {
    assert(read_ < posted_);
    const Telegram& telegram = telegrams_[read_++];
    telegram.reader->read(telegram.number, telegram.data);
    if (read_ == posted_) read_ = posted_ = 0;
    next_ = posted_ == 0 ? kNever : telegrams_[read_].after;
  }

 private:
  struct Telegram {
    Time after;
    TelegramReader* reader;
    size_t number;
    TelegramData data;
  };
  Time next_ = kNever;
  std::array<Telegram, kMost> telegrams_{};
  uint8_t posted_ = 0;
  uint8_t read_ = 0;
};

}  // namespace ipos::runtime
