// What the two processes of `ipos serve` say to each other over a pair of sockets: the server, which has the browsers,
// and the host, which has the plant or the drive. A letter is whole or not there, so a copy of the host that goes on
// from a snapshot finds the next one.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ipos::tools::serve {

enum class LetterKind : uint8_t {
  // to the host
  Opened,   // a client has come
  Message,  // what it says
  Closed,   // it is gone
  Drained,  // so many bytes of events have gone to it: body as text
  // to the server
  Ready,   // the host is there; before this nobody is let in
  Reply,   // a text for the client
  Event,   // the same, of a topic
  Binary,  // of a topic or a view
  Taken,   // a message of the client was carried out
};

// The clock of both processes: it has one zero for all of this machine.
using WallClock = std::chrono::steady_clock;

struct Letter {
  LetterKind kind = LetterKind::Ready;
  uint16_t client = 0;
  std::string body{};
  WallClock::time_point arrived{};  // of a Message: when the server had it, at the latest (arrival.hpp)
};

// Arrival, length of the body, client, kind; in the order of this machine.
inline constexpr size_t kLetterHead = 16;
struct LetterHead {
  WallClock::time_point arrived{};
  uint32_t length = 0;
  uint16_t client = 0;
  LetterKind kind = LetterKind::Ready;
};
std::array<char, kLetterHead> head_bytes(const Letter& letter);
LetterHead head_of(const std::array<char, kLetterHead>& bytes);

// Where a host gets its letters and posts its own.
class Post {
 public:
  virtual ~Post() = default;
  // False: nobody takes them any more.
  virtual bool send(LetterKind kind, uint16_t client, std::string_view body) = 0;
  // The next letter, if one comes within so many milliseconds.
  virtual std::optional<Letter> wait(int milliseconds) = 0;
  virtual bool open() const = 0;
};

// The host's end of the pair.
class Channel final : public Post {
 public:
  explicit Channel(int socket) : socket_(socket) {}
  bool send(LetterKind kind, uint16_t client, std::string_view body) override;
  std::optional<Letter> wait(int milliseconds) override;
  bool open() const override { return open_; }

 private:
  bool write_all(const char* bytes, size_t size);
  bool read_all(char* bytes, size_t size);
  bool has_letter();  // a whole one

  int socket_;
  bool open_ = true;
};

}  // namespace ipos::tools::serve
