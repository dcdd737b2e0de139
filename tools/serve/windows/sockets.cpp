// Windows makes no pairs: one end listens at the loopback for a moment, and takes nobody but the other end.
#include "tools/serve/sockets.hpp"

#include <winsock2.h>

#include <windows.h>

#include <timeapi.h>

#include <algorithm>
#include <climits>
#include <cstring>

#include "tools/cli/failure.hpp"

namespace ipos::tools::serve {
namespace {

SOCKET system_socket(Socket socket) { return static_cast<SOCKET>(socket); }

// While it lives a wait is exact to a millisecond instead of 16.
struct ExactWaits {
  ExactWaits() { timeBeginPeriod(1); }
  ~ExactWaits() { timeEndPeriod(1); }
  ExactWaits(const ExactWaits&) = delete;
  ExactWaits& operator=(const ExactWaits&) = delete;
};

struct Winsock {
  Winsock() {
    WSADATA data{};
    WSAStartup(MAKEWORD(2, 2), &data);
  }
};

int piece_of(size_t size) { return static_cast<int>(std::min<size_t>(size, INT_MAX)); }

SOCKET new_socket() { return ::socket(AF_INET, SOCK_STREAM, IPPROTO_TCP); }

bool address_of(int (WSAAPI *ask)(SOCKET, sockaddr*, int*), SOCKET socket, sockaddr_in& address) {
  int size = sizeof address;
  return ask(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0;
}

[[noreturn]] void refuse() { throw Failure(kIoError, "the system gives no sockets"); }

void send_at_once(SOCKET socket) {
  const BOOL on = TRUE;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, reinterpret_cast<const char*>(&on), sizeof on);
}

}  // namespace

SocketPair make_socket_pair() {
  static const Winsock winsock;
  const SOCKET listener = new_socket(), server = new_socket();
  OwnedSocket listening(static_cast<Socket>(listener)), server_end(static_cast<Socket>(server));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto* const there = reinterpret_cast<const sockaddr*>(&address);
  const BOOL on = TRUE;
  setsockopt(listener, SOL_SOCKET, SO_EXCLUSIVEADDRUSE, reinterpret_cast<const char*>(&on), sizeof on);
  if (::bind(listener, there, sizeof address) != 0 || ::listen(listener, 1) != 0 ||
      !address_of(getsockname, listener, address) || ::connect(server, there, sizeof address) != 0)
    refuse();
  const SOCKET host = ::accept(listener, nullptr, nullptr);
  OwnedSocket host_end(static_cast<Socket>(host));
  sockaddr_in ours{}, came{};
  if (!address_of(getsockname, server, ours) || !address_of(getpeername, host, came) ||
      ours.sin_port != came.sin_port || ours.sin_addr.s_addr != came.sin_addr.s_addr)
    refuse();
  send_at_once(server);
  send_at_once(host);
  return {server_end.release(), host_end.release()};
}

void close_socket(Socket socket) { closesocket(system_socket(socket)); }

std::ptrdiff_t send_some(Socket socket, const char* bytes, size_t size) {
  return ::send(system_socket(socket), bytes, piece_of(size), 0);
}

std::ptrdiff_t receive_some(Socket socket, char* bytes, size_t size) {
  return ::recv(system_socket(socket), bytes, piece_of(size), 0);
}

std::ptrdiff_t peek(Socket socket, char* bytes, size_t size) {
  if (!wait_readable(socket, 0)) return -1;
  const int count = ::recv(system_socket(socket), bytes, piece_of(size), MSG_PEEK);
  return count < 0 ? 0 : count;
}

size_t bytes_there(Socket socket) {
  u_long there = 0;
  return ioctlsocket(system_socket(socket), FIONREAD, &there) == 0 ? there : 0;
}

bool wait_readable(Socket socket, int milliseconds) {
  static const ExactWaits exact;
  WSAPOLLFD waiting{system_socket(socket), POLLRDNORM, 0};
  return WSAPoll(&waiting, 1, milliseconds) > 0;
}

}  // namespace ipos::tools::serve
