// The outputs and inputs of a slave with Sync and Freeze (MOVITRAC 31 PROFIBUS, 3.5): in Sync mode new outputs
// wait for the next Sync, in Freeze mode the master reads the inputs of the last Freeze. Both hold the whole
// image, parameter channel included (ours).
#pragma once

#include <algorithm>
#include <span>
#include <utility>

#include "runtime/bus/profibus/fdl_frame.hpp"

namespace ipos::profibus {

class ProcessImage {
 public:
  // A new data exchange: outputs 0, no mode.
  void begin(size_t octets) {
    outputs_.assign(octets, 0);
    buffer_.assign(octets, 0);
    waiting_ = false;
    end_modes();
  }
  void end_modes() {
    synced_ = false;
    frozen_.clear();
  }

  size_t size() const { return outputs_.size(); }
  const Octets& outputs() const { return outputs_; }  // as they act
  bool synced() const { return synced_; }
  bool is_frozen() const { return !frozen_.empty(); }
  const Octets& frozen() const { return frozen_; }

  // The following say whether the acting outputs were given again.
  bool take(std::span<const uint8_t> octets) {
    buffer_.assign(octets.begin(), octets.end());
    waiting_ = true;
    return !synced_ && move();
  }
  bool sync() {
    synced_ = true;
    return move();
  }
  bool unsync() {
    synced_ = false;
    return move();
  }
  bool clear() {
    std::fill(buffer_.begin(), buffer_.end(), uint8_t{0});
    waiting_ = true;
    return move();
  }

  void freeze(Octets inputs) { frozen_ = std::move(inputs); }
  void unfreeze() { frozen_.clear(); }

 private:
  bool move() {
    if (!std::exchange(waiting_, false)) return false;
    outputs_ = buffer_;
    return true;
  }

  Octets outputs_;
  Octets buffer_;
  Octets frozen_;  // empty: not in Freeze mode
  bool synced_ = false;
  bool waiting_ = false;  // the buffer has something new
};

}  // namespace ipos::profibus
