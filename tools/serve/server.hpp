// The server of `ipos serve`: gives the page to browsers and carries messages between their WebSockets and the host.
// It knows nothing of what they say. Boost stays in server.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "tools/serve/sockets.hpp"

namespace ipos::tools::serve {

struct ServerOptions {
  std::string bind = "127.0.0.1";
  uint16_t port = 0;                     // 0: a free one
  std::optional<uint16_t> rather = {};  // of the free ones
  std::string token;
  std::string_view page;
  uint16_t last_number = UINT16_MAX;  // of clients; then numbers start again at 1
};

// Limits (ours).
inline constexpr size_t kMostClients = 8;
inline constexpr size_t kMostConnections = 64;
inline constexpr uint32_t kMostHeader = 8 * 1024;
inline constexpr size_t kMostBody = 64 * 1024;           // of a request by HTTP
inline constexpr size_t kMostMessage = 128 * 1024;  // texts of the editor; the channel to the host holds it whole
inline constexpr size_t kMostWaiting = 8 * 1024 * 1024;  // bytes for a client that does not read
inline constexpr int kMostUnanswered = 32;  // messages of a client; the next is read when one was answered

class Server {
 public:
  // Listens; a Failure says why it cannot. `host` is the server's end of the pair and belongs to it.
  Server(const ServerOptions& options, Socket host);
  ~Server();

  // "http://127.0.0.1:8080/?token=..."
  std::string address() const;
  uint16_t port() const;
  // Until Ctrl-C, which somebody catches (tools/cli/interrupt.hpp), or the end of the host. `ready` is called once, when the host is there.
  void run(const std::function<void()>& ready);

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

// 32 hexadecimal digits nobody can guess.
std::string make_token();

}  // namespace ipos::tools::serve
