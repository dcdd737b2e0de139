// Sockets of POSIX.
#include "tools/debug/editor_port.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include "tools/cli/failure.hpp"

namespace ipos::tools::debug {

runtime::Descriptor editor_at(uint16_t port, const std::function<void(uint16_t)>& listening) {
  const runtime::Descriptor listener(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int on = 1;
  setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (!listener.is_open() || bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      listen(listener.get(), 1) != 0)
    throw Failure(kIoError, fmt::format("port {} cannot be listened at", port));
  socklen_t size = sizeof address;
  getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size);
  listening(ntohs(address.sin_port));
  runtime::Descriptor editor(accept(listener.get(), nullptr, nullptr));
  if (!editor.is_open()) throw Failure(kIoError, "no editor came");
  return editor;
}

}  // namespace ipos::tools::debug
