// Memory that all copies of a process have together: what one of them writes the others read. A recording stands here, so
// that the copies for going back (tools/debug/snapshots.hpp) do not each keep one of their own. It begins as zeros, and
// what nobody has written takes no room.
#pragma once

#include <cstddef>

namespace ipos::tools::serve {

class SharedMemory {
 public:
  // A Failure: the system has no room.
  explicit SharedMemory(size_t bytes);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  template <typename Type>
  Type* at(size_t byte) const {
    return reinterpret_cast<Type*>(begin_ + byte);
  }

 private:
  std::byte* begin_;
  size_t bytes_;
};

}  // namespace ipos::tools::serve
