// Bytes into and out of a descriptor that never blocks: their number, 0 for none now, or an errno value.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <span>
#include <string_view>

#include <tl/expected.hpp>

namespace ipos::runtime {

inline tl::expected<size_t, int> write_some(int descriptor, std::string_view bytes) {
  for (;;) {
    const ssize_t size = ::write(descriptor, bytes.data(), bytes.size());
    if (size >= 0) return static_cast<size_t>(size);
    if (errno == EAGAIN) return size_t{0};
    if (errno != EINTR) return tl::unexpected(errno);
  }
}

// The end of a device is EIO.
inline tl::expected<size_t, int> read_some(int descriptor, std::span<char> into) {
  for (;;) {
    const ssize_t size = ::read(descriptor, into.data(), into.size());
    if (size > 0) return static_cast<size_t>(size);
    if (size == 0) return tl::unexpected(EIO);
    if (errno == EAGAIN) return size_t{0};
    if (errno != EINTR) return tl::unexpected(errno);
  }
}

}  // namespace ipos::runtime
