// Telegrams that wait until the ticks of their reader have come as far as they.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/pace/timed.hpp"

namespace ipos::runtime {

class Inbox {
 public:
  static constexpr size_t kMost = 4;
  static constexpr size_t kMostBytes = 8;

  bool full() const { return posted_ == kMost; }

  // A telegram that came behind the tick at `after`, in the order of time.
  void post(Time after, TelegramReader& reader, size_t number, std::span<const uint8_t> bytes) {
    assert(!full() && bytes.size() <= kMostBytes);
    Telegram& telegram = telegrams_[posted_++];
    telegram = {after, &reader, number, {}, bytes.size()};
    std::copy(bytes.begin(), bytes.end(), telegram.bytes.begin());
  }

  // The tick behind which the next one came; kNever for none.
  Time next() const { return read_ == posted_ ? kNever : telegrams_[read_].after; }

  void read_next() {
    const Telegram& telegram = telegrams_[read_++];
    telegram.reader->read(telegram.number, {telegram.bytes.data(), telegram.length});
    if (read_ == posted_) read_ = posted_ = 0;
  }

 private:
  struct Telegram {
    Time after;
    TelegramReader* reader;
    size_t number;
    std::array<uint8_t, kMostBytes> bytes;
    size_t length;
  };
  std::array<Telegram, kMost> telegrams_{};
  uint8_t posted_ = 0;
  uint8_t read_ = 0;
};

}  // namespace ipos::runtime
