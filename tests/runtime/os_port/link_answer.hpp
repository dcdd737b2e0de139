// Answers of rtnetlink about an interface, put together from attributes (rtnetlink(7)).
#pragma once

#include <linux/can/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>

#include <string>
#include <string_view>

#include "tests/runtime/os_port/kernel_in_memory.hpp"

namespace ipos::tests {

template <typename Value>
std::string bytes_of(const Value& value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

// Filled up to four bytes, which its length does not count.
inline std::string attribute(int type, std::string_view data) {
  rtattr head{};
  head.rta_len = static_cast<unsigned short>(sizeof head + data.size());
  head.rta_type = static_cast<unsigned short>(type);
  std::string text = bytes_of(head).append(data);
  text.resize((text.size() + 3) / 4 * 4, '\x55');
  return text;
}

inline std::string bit_timing(uint32_t rate) {
  can_bittiming timing{};
  timing.bitrate = rate;
  return attribute(IFLA_CAN_BITTIMING, bytes_of(timing));
}

inline std::string link_info(std::string_view kind, const std::string& data) {
  return attribute(IFLA_LINKINFO, attribute(IFLA_INFO_KIND, kind) + attribute(IFLA_INFO_DATA, data));
}

inline std::string link_answer(const std::string& attributes, unsigned short kind = ARPHRD_CAN,
                               unsigned flags = IFF_UP, unsigned short type = RTM_NEWLINK) {
  nlmsghdr header{};
  header.nlmsg_type = type;
  ifinfomsg info{};
  info.ifi_type = kind;
  info.ifi_flags = flags;
  info.ifi_index = KernelInMemory::kIndex;
  header.nlmsg_len = static_cast<uint32_t>(sizeof header + sizeof info + attributes.size());
  return bytes_of(header) + bytes_of(info) + attributes;
}

}  // namespace ipos::tests
