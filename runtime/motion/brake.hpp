// The mechanical brake: its torque goes and comes a while after the order (times of its data sheet; P731 and P732 are how
// long the drive waits for it).
#pragma once

#include <algorithm>
#include <cstdint>

namespace ipos::runtime {

class Brake {
 public:
  // A millisecond under this order.
  void step(bool open, int32_t release_ms, int32_t apply_ms) {
    if (open != ordered_) {
      ordered_ = open;
      left_ms_ = open ? release_ms : apply_ms;
    }
    if (left_ms_ == 0)
      open_ = ordered_;
    else
      --left_ms_;
  }
  bool open() const { return open_; }
  bool operator==(const Brake&) const = default;

 private:
  bool ordered_ = false, open_ = false;
  int32_t left_ms_ = 0;
};

}  // namespace ipos::runtime
