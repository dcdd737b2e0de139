// Sockets as the line between server and host needs them; posix and windows have a source each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

namespace ipos::tools::serve {

using Socket = std::intptr_t;

// Two ends of one line. A Failure: the system gives none.
struct SocketPair {
  Socket server = -1;
  Socket host = -1;
};
SocketPair make_socket_pair();
void close_socket(Socket socket);

// Closes one, unless somebody else has taken it over.
class OwnedSocket {
 public:
  explicit OwnedSocket(Socket socket) : socket_(socket) {}
  ~OwnedSocket() {
    if (socket_ != -1) close_socket(socket_);
  }
  OwnedSocket(const OwnedSocket&) = delete;
  OwnedSocket& operator=(const OwnedSocket&) = delete;
  Socket release() { return std::exchange(socket_, -1); }

 private:
  Socket socket_;
};

// How many bytes went or came; 0 or less: the other end is gone.
std::ptrdiff_t send_some(Socket socket, const char* bytes, size_t size);
std::ptrdiff_t receive_some(Socket socket, char* bytes, size_t size);
// The same of what is there, which stays there; 0: the other end is gone, less: nothing is there yet.
std::ptrdiff_t peek(Socket socket, char* bytes, size_t size);
size_t bytes_there(Socket socket);
// Whether bytes, or the end, are there within so many milliseconds.
bool wait_readable(Socket socket, int milliseconds);

}  // namespace ipos::tools::serve
