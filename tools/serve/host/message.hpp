// What a host and its clients say to each other: a message comes from a client or goes to one. Who carries them (sockets, a
// browser's worker, a test) is no matter of the host.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace ipos::tools::serve {

enum class MessageKind : uint8_t {
  // to the host
  Opened,   // a client has come
  Text,     // what it says
  Closed,   // it is gone
  Drained,  // so many bytes of events have gone to it: body as text
  // from the host
  Ready,   // the host is there; before this nobody is let in
  Reply,   // a text for the client
  Event,   // the same, of a topic
  Binary,  // of a topic or a view
  Taken,   // a message of the client was carried out
};

// Times outside of the plant.
using WallClock = std::chrono::steady_clock;

struct Message {
  MessageKind kind = MessageKind::Ready;
  uint16_t client = 0;
  std::string body{};
  WallClock::time_point arrived{};  // of a Text: when the server had it, at the latest (arrival.hpp)
};

// Where a host's messages go.
class Outbox {
 public:
  virtual ~Outbox() = default;
  // False: nobody takes them any more.
  virtual bool send(MessageKind kind, uint16_t client, std::string_view body) = 0;
};

// What time it is outside; the host asks nobody else.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual WallClock::time_point now() const = 0;
};

}  // namespace ipos::tools::serve
