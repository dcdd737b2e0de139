// All bytes to a file of the system, or from it; false: its other end is gone.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstddef>

namespace ipos::tools {

inline bool write_all(int file, const char* bytes, size_t size) {
  while (size != 0) {
    const ssize_t count = write(file, bytes, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes += count;
    size -= static_cast<size_t>(count);
  }
  return true;
}

inline bool read_all(int file, char* bytes, size_t size) {
  while (size != 0) {
    const ssize_t count = read(file, bytes, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes += count;
    size -= static_cast<size_t>(count);
  }
  return true;
}

}  // namespace ipos::tools
