// A drive on its course: a tick leaves it as it is, but for what moves, warms and counts. As long as nobody
// touches it the next ticks do the same, so they need not be decided anew. That a drive is on its course is
// tried, not concluded from its parts: its bytes before and after a tick are the same but for those, and what
// it does follows from them. Bytes between members may differ by chance; then ticks are executed in full that
// need not be.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "runtime/drive/drive.hpp"

namespace ipos::runtime {

// The bytes of an object, to be compared with what they are later.
template <class T>
class Bytes {
 public:
  void note(const T& object) { std::memcpy(noted_.data(), static_cast<const void*>(&object), sizeof(T)); }
  const std::byte* at(size_t offset) const { return noted_.data() + offset; }
  bool same(const T& object, size_t begin = 0, size_t end = sizeof(T)) const {
    return std::memcmp(noted_.data() + begin, reinterpret_cast<const std::byte*>(&object) + begin,
                       end - begin) == 0;
  }

 private:
  std::array<std::byte, sizeof(T)> noted_;
};

class DriveCourse {
 public:
  // Before a tick.
  void note(const Drive& drive) { before_.note(drive); }
  // Behind it: how many ticks from now on would only go on (Drive::hold_course); 0 when that one did more.
  uint32_t ticks(const Drive& drive) const;

 private:
  template <class Member>
  Member noted(const Drive& drive, const Member& member) const;

  Bytes<Drive> before_;
};

}  // namespace ipos::runtime
