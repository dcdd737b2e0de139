// How a slave finds the rate of its line by itself: from the highest rate down, until a frame comes without
// error (MOVITRAC 31 PROFIBUS, 7.1, prints the rates alone; the rest is as usual for slave circuits).
//
// A rate is given up when what comes is faulty for 100 ms without one good frame, locked or not; an idle line
// says nothing. The frame that locks is only listened to. Both ours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

#include "runtime/bus/profibus/timing.hpp"

namespace ipos::profibus {

class BaudSearch {
 public:
  static constexpr Time kPatience = 100 * runtime::kMillisecond;

  uint32_t baud() const { return kBaudRates[rate_].baud; }
  bool locked() const { return locked_; }

  // True when the slave takes part: it had locked before this frame.
  bool heard_frame() {
    faulty_since_ = runtime::kNever;
    const bool before = locked_;
    locked_ = true;
    return before;
  }
  // True when another rate is to be tried.
  bool heard_error(Time now) {
    if (faulty_since_ == runtime::kNever) faulty_since_ = now;
    if (now - faulty_since_ < kPatience) return false;
    if (locked_)
      begin();
    else
      rate_ = (rate_ + 1) % std::size(kBaudRates);
    faulty_since_ = runtime::kNever;
    return true;
  }
  void begin() { *this = {}; }

 private:
  size_t rate_ = 0;
  bool locked_ = false;
  Time faulty_since_ = runtime::kNever;  // kNever: the last frame was good
};

}  // namespace ipos::profibus
