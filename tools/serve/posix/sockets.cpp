// A pair of local sockets. What a signal interrupts is done again.
#include "tools/serve/sockets.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "tools/cli/failure.hpp"

namespace ipos::tools::serve {
namespace {

int number(Socket socket) { return static_cast<int>(socket); }

template <typename Act>
std::ptrdiff_t again(Act act) {
  for (;;)
    if (const ssize_t count = act(); count >= 0 || errno != EINTR) return count;
}

}  // namespace

SocketPair make_socket_pair() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw Failure(kIoError, "the system gives no sockets");
  return {ends[0], ends[1]};
}

void close_socket(Socket socket) { close(number(socket)); }

std::ptrdiff_t send_some(Socket socket, const char* bytes, size_t size) {
  return again([&] { return send(number(socket), bytes, size, MSG_NOSIGNAL); });
}

std::ptrdiff_t receive_some(Socket socket, char* bytes, size_t size) {
  return again([&] { return recv(number(socket), bytes, size, 0); });
}

std::ptrdiff_t peek(Socket socket, char* bytes, size_t size) {
  return recv(number(socket), bytes, size, MSG_PEEK | MSG_DONTWAIT);
}

size_t bytes_there(Socket socket) {
  int there = 0;
  return ioctl(number(socket), FIONREAD, &there) == 0 ? static_cast<size_t>(there) : 0;
}

bool wait_readable(Socket socket, int milliseconds) {
  pollfd waiting{number(socket), POLLIN, 0};
  return poll(&waiting, 1, milliseconds) > 0;
}

}  // namespace ipos::tools::serve
