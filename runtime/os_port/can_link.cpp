// One RTM_GETLINK request (rtnetlink(7)); the bit rate stands in IFLA_CAN_BITTIMING.
#include "runtime/os_port/can_link.hpp"

#include <fmt/format.h>
#include <linux/can/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "runtime/os_port/descriptor.hpp"

namespace ipos::runtime {
namespace {

// Calls `take(type, data, size)` for each attribute in a block.
template <typename Take>
void for_each_attribute(const char* data, size_t size, Take take) {
  while (size >= sizeof(rtattr)) {
    rtattr head{};
    std::memcpy(&head, data, sizeof head);
    if (head.rta_len < sizeof head || head.rta_len > size) return;
    take(head.rta_type & NLA_TYPE_MASK, data + sizeof head, head.rta_len - sizeof head);
    const size_t step = std::min(size, static_cast<size_t>(RTA_ALIGN(head.rta_len)));
    data += step;
    size -= step;
  }
}

void take_link_info(const char* data, size_t size, CanLink& link) {
  for_each_attribute(data, size, [&link](int type, const char* part, size_t length) {
    if (type == IFLA_INFO_KIND) link.kind.assign(part, strnlen(part, length));
    if (type != IFLA_INFO_DATA) return;
    for_each_attribute(part, length, [&link](int inner, const char* value, size_t bytes) {
      can_bittiming timing{};
      if (inner != IFLA_CAN_BITTIMING || bytes < sizeof timing) return;
      std::memcpy(&timing, value, sizeof timing);
      // Old slcand opens an adapter whose rate the kernel does not know: 0 or all bits set.
      if (timing.bitrate != 0 && timing.bitrate != ~0U) link.bit_rate = timing.bitrate;
    });
  });
}

}  // namespace

tl::expected<CanLink, PortError> query_can_link(const std::string& name) {
  const unsigned index = if_nametoindex(name.c_str());
  if (index == 0)
    return tl::unexpected(port_error(PortFault::NoSuchInterface, name,
                                     fmt::format("'ip link' lists them; 'ip link add vcan0 type vcan' makes "
                                                 "one; a serial device is written with its path, ./{}",
                                                 name)));
  const Descriptor socket_fd(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE));
  if (!socket_fd.is_open()) return tl::unexpected(system_error(errno, name));
  struct {
    nlmsghdr header;
    ifinfomsg info;
  } request{};
  request.header.nlmsg_len = sizeof request;
  request.header.nlmsg_type = RTM_GETLINK;
  request.header.nlmsg_flags = NLM_F_REQUEST;
  request.info.ifi_index = static_cast<int>(index);
  std::array<char, 16384> answer{};
  if (::send(socket_fd.get(), &request, sizeof request, 0) < 0)
    return tl::unexpected(system_error(errno, name));
  const ssize_t size = recv(socket_fd.get(), answer.data(), answer.size(), 0);
  if (size < 0) return tl::unexpected(system_error(errno, name));
  nlmsghdr header{};
  ifinfomsg info{};
  constexpr size_t kHead = NLMSG_LENGTH(sizeof(ifinfomsg));
  if (static_cast<size_t>(size) < kHead)
    return tl::unexpected(port_error(PortFault::System, name, "short answer"));
  std::memcpy(&header, answer.data(), sizeof header);
  if (header.nlmsg_type != RTM_NEWLINK)
    return tl::unexpected(port_error(PortFault::System, name, "the kernel does not describe it"));
  std::memcpy(&info, answer.data() + NLMSG_HDRLEN, sizeof info);
  CanLink link;
  link.index = static_cast<int>(index);
  for_each_attribute(answer.data() + kHead, static_cast<size_t>(size) - kHead,
                     [&link](int type, const char* data, size_t length) {
                       if (type == IFLA_LINKINFO) take_link_info(data, length, link);
                     });
  if (info.ifi_type != ARPHRD_CAN) return tl::unexpected(port_error(PortFault::NotCan, name));
  if ((info.ifi_flags & IFF_UP) == 0)
    return tl::unexpected(port_error(PortFault::Down, name, fmt::format("ip link set {} up", name)));
  return link;
}

}  // namespace ipos::runtime
