// Messages on a socket, whole ones only.
#include "tools/serve/channel.hpp"

#include <chrono>
#include <cstring>
#include <thread>

namespace ipos::tools::serve {

std::array<char, kMessageHead> head_bytes(const Message& message) {
  std::array<char, kMessageHead> bytes{};
  const auto length = static_cast<uint32_t>(message.body.size());
  const int64_t arrived = message.arrived.time_since_epoch().count();
  std::memcpy(bytes.data(), &arrived, sizeof arrived);
  std::memcpy(bytes.data() + 8, &length, sizeof length);
  std::memcpy(bytes.data() + 12, &message.client, sizeof message.client);
  bytes[14] = static_cast<char>(message.kind);
  return bytes;
}

MessageHead head_of(const std::array<char, kMessageHead>& bytes) {
  MessageHead head;
  int64_t arrived = 0;
  std::memcpy(&arrived, bytes.data(), sizeof arrived);
  head.arrived = WallClock::time_point(WallClock::duration(arrived));
  std::memcpy(&head.length, bytes.data() + 8, sizeof head.length);
  std::memcpy(&head.client, bytes.data() + 12, sizeof head.client);
  head.kind = static_cast<MessageKind>(bytes[14]);
  return head;
}

bool Channel::write_all(const char* bytes, size_t size) {
  while (size != 0) {
    const auto count = send_some(socket_, bytes, size);
    if (count <= 0) return open_ = false;
    bytes += count;
    size -= static_cast<size_t>(count);
  }
  return true;
}

bool Channel::read_all(char* bytes, size_t size) {
  while (size != 0) {
    const auto count = receive_some(socket_, bytes, size);
    if (count <= 0) return open_ = false;
    bytes += count;
    size -= static_cast<size_t>(count);
  }
  return true;
}

bool Channel::send(MessageKind kind, uint16_t client, std::string_view body) {
  const auto head = head_bytes({kind, client, std::string(body), {}});
  return write_all(head.data(), head.size()) && write_all(body.data(), body.size());
}

// Of a message that is not whole the rest may never come: its writer may have been stopped.
bool Channel::has_message() {
  std::array<char, kMessageHead> bytes{};
  const auto count = peek(socket_, bytes.data(), bytes.size());
  if (count == 0) return open_ = false;
  return count == static_cast<std::ptrdiff_t>(bytes.size()) && bytes_there(socket_) >= kMessageHead + head_of(bytes).length;
}

std::optional<Message> Channel::wait(int milliseconds) {
  if (!open_ || !wait_readable(socket_, milliseconds)) return std::nullopt;
  if (!has_message()) {
    if (open_ && milliseconds > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return std::nullopt;
  }
  std::array<char, kMessageHead> bytes{};
  if (!read_all(bytes.data(), bytes.size())) return std::nullopt;
  const MessageHead head = head_of(bytes);
  Message message{head.kind, head.client, std::string(head.length, '\0'), head.arrived};
  if (!read_all(message.body.data(), message.body.size())) return std::nullopt;
  return message;
}

}  // namespace ipos::tools::serve
