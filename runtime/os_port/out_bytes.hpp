// Bytes waiting for a device that takes them when it likes; whole messages at a time, so that one that finds
// no room is lost as a whole.
#pragma once

#include <cerrno>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <unistd.h>

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

  // Writes what the device takes; 0, or the errno value of a failure other than "no room now".
  int write_to(int descriptor) {
    while (!empty()) {
      const ssize_t done = ::write(descriptor, bytes_.data() + sent_, bytes_.size() - sent_);
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) return errno == EAGAIN ? 0 : errno;
      sent_ += static_cast<size_t>(done);
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
