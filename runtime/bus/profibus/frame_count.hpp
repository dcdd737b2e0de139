// The frame count bit on the side of the slave (EN 50170 volume 2, FDL): a request with the bit unchanged is a
// repetition and gets the stored answer, whatever it contains; nothing runs twice. FDL status and requests
// without answer leave it alone.
#pragma once

#include <optional>

#include "runtime/bus/profibus/fdl_frame.hpp"

namespace ipos::profibus {

class FrameCount {
 public:
  // The stored answer, when this request repeats the last one of this master.
  const FdlFrame* repeated(const FdlFrame& request) const {
    if (!request.frame_count_valid() || !known_ || request.source != master_ || request.frame_count() != bit_)
      return nullptr;
    return &answer_;
  }
  void store(const FdlFrame& request, const FdlFrame& answer) {
    known_ = request.frame_count_valid() || request.frame_count();
    master_ = request.source;
    bit_ = request.frame_count();
    answer_ = answer;
  }

 private:
  bool known_ = false;
  uint8_t master_ = 0;
  bool bit_ = false;
  FdlFrame answer_;
};

}  // namespace ipos::profibus
