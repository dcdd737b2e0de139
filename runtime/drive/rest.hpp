// A drive at rest: a tick leaves it as it is, but for the time since power-on, which shows once a minute
// (P015), and what cools down. Such ticks need not be executed. That a drive rests is tried, not concluded
// from its parts: its bytes before and after a tick are the same, and what it does follows from them. Bytes
// between members may differ by chance; then ticks are executed that need not be.
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

class DriveRest {
 public:
  // Before a tick of a drive whose output stage is off.
  void note(const Drive& drive);
  // Behind it: how many ticks from now on would change nothing while nobody else touches the drive or its
  // parameters; 0 when that one did.
  uint64_t ticks(const Drive& drive) const;
  // What so many of them would have done.
  static void skip(Drive& drive, uint64_t ticks);

 private:
  Bytes<Drive> before_;
  uint32_t parameters_ = 0;  // changes of them
};

}  // namespace ipos::runtime
