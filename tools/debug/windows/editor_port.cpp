// Sockets of Windows. One that knows no overlapped calls can be read and written as a file.
#include "tools/debug/editor_port.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <io.h>
#include <winsock2.h>

#include "tools/cli/failure.hpp"

namespace ipos::tools::debug {
namespace {

class Listener {
 public:
  Listener() {
    WSADATA data{};
    if (WSAStartup(MAKEWORD(2, 2), &data) == 0) socket_ = WSASocketW(AF_INET, SOCK_STREAM, 0, nullptr, 0, 0);
  }
  ~Listener() {
    if (socket_ != INVALID_SOCKET) closesocket(socket_);
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  SOCKET get() const { return socket_; }

 private:
  SOCKET socket_ = INVALID_SOCKET;
};

}  // namespace

// Without the exclusive use another program could listen at the same port, and get the editor.
runtime::Descriptor editor_at(uint16_t port, const std::function<void(uint16_t)>& listening) {
  const Listener listener;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const BOOL on = TRUE;
  setsockopt(listener.get(), SOL_SOCKET, SO_EXCLUSIVEADDRUSE, reinterpret_cast<const char*>(&on), sizeof on);
  if (::bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || ::listen(listener.get(), 1) != 0)
    throw Failure(kIoError, fmt::format("port {} cannot be listened at", port));
  int size = sizeof address;
  getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size);
  listening(ntohs(address.sin_port));
  const SOCKET editor = ::accept(listener.get(), nullptr, nullptr);
  if (editor == INVALID_SOCKET) throw Failure(kIoError, "no editor came");
  return runtime::Descriptor(_open_osfhandle(static_cast<intptr_t>(editor), O_RDWR | O_BINARY));
}

}  // namespace ipos::tools::debug
