// All bytes to a file of the system, or from it; false: its other end is gone.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>

namespace ipos::tools {

// Windows counts a piece in 32 bits.
inline unsigned piece_of(size_t size) { return static_cast<unsigned>(std::min(size, size_t{1} << 30U)); }

inline bool write_all(int file, const char* bytes, size_t size) {
  while (size != 0) {
    const ssize_t count = write(file, bytes, piece_of(size));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes += count;
    size -= static_cast<size_t>(count);
  }
  return true;
}

inline bool read_all(int file, char* bytes, size_t size) {
  while (size != 0) {
    const ssize_t count = read(file, bytes, piece_of(size));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes += count;
    size -= static_cast<size_t>(count);
  }
  return true;
}

}  // namespace ipos::tools
