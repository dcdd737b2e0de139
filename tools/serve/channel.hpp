// What the two halves of `ipos serve` say to each other over a pair of sockets: the server, which has the browsers,
// and the host, which has the plant or the drive. A message is whole or not there, so a copy of the host that goes on
// from a snapshot finds the next one.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "tools/serve/host/message.hpp"
#include "tools/serve/sockets.hpp"

namespace ipos::tools::serve {

// Arrival, length of the body, client, kind; in the order of this machine.
inline constexpr size_t kMessageHead = 16;
struct MessageHead {
  WallClock::time_point arrived{};
  uint32_t length = 0;
  uint16_t client = 0;
  MessageKind kind = MessageKind::Ready;
};
std::array<char, kMessageHead> head_bytes(const Message& message);
MessageHead head_of(const std::array<char, kMessageHead>& bytes);

// Where a host gets its messages and leaves its own.
class Mailbox : public Outbox {
 public:
  // The next message, if one comes within so many milliseconds.
  virtual std::optional<Message> wait(int milliseconds) = 0;
  virtual bool open() const = 0;
};

// The clock of both: it has one zero for all of this machine.
class SteadyClock final : public Clock {
 public:
  WallClock::time_point now() const override { return WallClock::now(); }
};

// The host's end of the pair.
class Channel final : public Mailbox {
 public:
  explicit Channel(Socket socket) : socket_(socket) {}
  bool send(MessageKind kind, uint16_t client, std::string_view body) override;
  std::optional<Message> wait(int milliseconds) override;
  bool open() const override { return open_; }

 private:
  bool write_all(const char* bytes, size_t size);
  bool read_all(char* bytes, size_t size);
  bool has_message();  // a whole one

  Socket socket_;
  bool open_ = true;
};

}  // namespace ipos::tools::serve
