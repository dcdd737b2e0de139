// What a packet of a capture holds (pcap and pcapng), by its link type: CAN of SocketCAN, also after the head of a capture of
// all interfaces (SLL), and the telegrams that ipos writes under link types for private use.
#pragma once

#include <string>
#include <string_view>

#include "tools/logs/bytes.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tools {

struct Packet {
  uint32_t link;
  const std::string& bus;
  runtime::Time time;     // since runtime::kCandumpEpoch
  std::string_view data;  // what was captured
  size_t original;        // bytes of the packet on the line
  std::string_view comment;
  size_t at;        // of its bytes in the file, for messages
  bool big_endian;  // numbers of the machine that captured
};

// Gives what it is, or leaves it out.
void read_packet(const Packet& packet, const LogReader& reader);

// Of an interface in a capture, for logs of lines and for people: as one word, and cut where a stranger made it long. A cut one
// has the number of the interface after, so that two of them stay two.
std::string interface_name(std::string_view name, size_t number);

// Seconds since 1970 and nanoseconds; nothing for a time later than this project knows.
std::optional<runtime::Time> capture_time(uint64_t seconds, uint64_t nanoseconds);

}  // namespace ipos::tools
