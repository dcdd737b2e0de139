// Bytes waiting for a device that takes them when it likes; whole messages at a time, so that one that finds
// no room is lost as a whole.
#pragma once

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace ipos::runtime {

class OutBytes {
 public:
  explicit OutBytes(size_t limit) : limit_(limit) {}

  // False when there is no room for all of it.
  bool push(std::string_view bytes) {
    if (bytes_.size() - sent_ + bytes.size() > limit_) return false;
    bytes_.erase(0, sent_);
    sent_ = 0;
    bytes_ += bytes;
    return true;
  }

  // Writes what the device takes: write(bytes) gives the number that it has taken, 0 for none now, or an errno value.
  // 0, or the errno value of a failure.
  template <typename Write>
  int write_by(Write write) {
    while (!empty()) {
      const tl::expected<size_t, int> done = write(waiting());
      if (!done) return done.error();
      if (*done == 0) return 0;
      sent_ += *done;
    }
    clear();
    return 0;
  }

  std::string_view waiting() const { return std::string_view(bytes_).substr(sent_); }
  bool empty() const { return sent_ == bytes_.size(); }
  void clear() {
    bytes_.clear();
    sent_ = 0;
  }

 private:
  std::string bytes_;
  size_t sent_ = 0;
  size_t limit_;
};

}  // namespace ipos::runtime
