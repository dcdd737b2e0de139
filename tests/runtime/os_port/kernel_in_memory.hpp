// The kernel's side of SocketCAN in memory: while an object of this lives, the raw CAN socket and the rtnetlink socket
// that a port opens are its own, and it has one interface. Every other call of the test program goes to the real
// kernel, unless a test answers in place of the driver of a serial device.
#pragma once

#include <linux/can.h>
#include <termios.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ipos::tests {

// What the socket gives at a reading: a frame with what the kernel says of it, or an error.
struct CanPacket {
  can_frame frame{};
  int error = 0;
  int64_t software = 0, hardware = 0;  // stamps in nanoseconds; 0: none
  bool stamped = true;
  std::optional<uint32_t> lost;  // frames that the socket had no room for, since it was opened
  int level = 0;                 // of one more control message, which is not for us; 0: there is none
};

class KernelInMemory {
 public:
  static constexpr std::string_view kInterface = "can-of-15-chars";  // the longest name that Linux has
  static constexpr int kIndex = 4711;

  KernelInMemory();
  ~KernelInMemory();
  KernelInMemory(const KernelInMemory&) = delete;
  KernelInMemory& operator=(const KernelInMemory&) = delete;

  // rtnetlink. Errors are errno values.
  std::string link;   // the answer
  std::string asked;  // the request
  int ask_socket_error = 0, ask_error = 0, answer_error = 0;

  // The raw socket.
  int socket_error = 0, bind_error = 0;
  int socket_type = 0, socket_protocol = 0;
  std::map<std::pair<int, int>, int> option_errors;
  std::map<std::pair<int, int>, std::string> options;  // by level and number
  sockaddr_can bound{};
  std::deque<int> refusals;  // of the next frames; 0: it is taken
  int attempts = 0;
  std::vector<can_frame> written;
  std::deque<CanPacket> packets;
  std::string asked_flags_of;
  short flags = 0;
  int flags_error = 0, flags_asked = 0;

  // In place of a serial device's driver: 0, or an errno value; nothing: the real one answers.
  std::function<std::optional<int>(unsigned long request, void* argument)> driver;
  std::function<std::optional<int>(termios& wanted)> set;
  std::function<void(termios& got)> got;  // behind the real one
  std::optional<unsigned> major;          // of all character devices

  int can() const { return can_; }
  // Descriptors that are ours and open only to have a number.
  int can_ = -1, ask_ = -1;
};

}  // namespace ipos::tests
