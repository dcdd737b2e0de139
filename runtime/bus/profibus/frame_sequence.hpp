// The frame count bit on the side of a master (EN 50170 volume 2, FDL): the first request begins a sequence, and the bit changes
// with each answer.
#pragma once

#include <cstdint>

#include "runtime/bus/profibus/fdl_frame.hpp"

namespace ipos::profibus {

class FrameSequence {
 public:
  uint8_t bits() const {
    return static_cast<uint8_t>((bit_ ? control::kFrameCount : 0) | (first_ ? 0 : control::kFrameCountValid));
  }
  void answered() {
    first_ = false;
    bit_ = !bit_;
  }

 private:
  bool first_ = true;
  bool bit_ = true;
};

}  // namespace ipos::profibus
