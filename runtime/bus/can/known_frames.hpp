// What is known of frames that come again, as cyclic telegrams often bring the same values: of each
// identifier the last frame, how long it is on the wire, and which nodes need not be told of it another time.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "runtime/bus/can/frame.hpp"
#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/bus/line/node_id.hpp"

namespace ipos::runtime {

class KnownFrames {
 public:
  static constexpr NodeId kMostNodes = 64;  // others are told of every frame

  struct Known {
    uint64_t head = UINT64_MAX;  // all but the data; at first that of no frame
    uint64_t resting = 0;        // a bit for each node that need not be told of it another time
    uint64_t data = 0;
    uint32_t bits = 0;  // frame_bits()
    FrameHead before_data;
  };
  // As the last one of its identifier from now on. Another frame than the last one is told to everybody.
  const Known& know(const Frame& frame) {
    const uint64_t head = head_of(frame);
    const auto data = std::bit_cast<uint64_t>(frame.data);
    Known& known = known_[frame.id % known_.size()];
    if (known.head == head && known.data == data) return known;
    if (known.head != head) known.before_data = frame_head(frame);
    known = {head, 0, data, frame_bits(frame, known.before_data), known.before_data};
    return known;
  }
  uint32_t bits(const Frame& frame) { return know(frame).bits; }

  // Nothing when the frame is not the last one of its identifier.
  void rest(NodeId node, const Frame& frame) {
    Known& known = known_[frame.id % known_.size()];
    if (node < kMostNodes && known.head == head_of(frame) &&
        known.data == std::bit_cast<uint64_t>(frame.data))
      known.resting |= uint64_t{1} << node;
  }
  void want_again(NodeId node, uint32_t id) {
    if (node < kMostNodes) known_[id % known_.size()].resting &= ~(uint64_t{1} << node);
  }
  // This frame is told to everybody, though it may not be the last one known.
  void stir_all(const Frame& frame) { known_[frame.id % known_.size()].resting = 0; }
  // What is known of this frame, the last one.
  const Known& last(const Frame& frame) const { return known_[frame.id % known_.size()]; }

 private:
  static uint64_t head_of(const Frame& frame) { return std::bit_cast<std::array<uint64_t, 2>>(frame)[0]; }

  std::array<Known, 256> known_{};
};

}  // namespace ipos::runtime
