// What the kernel says of a CAN interface, answer by answer (rtnetlink(7), linux/can/netlink.h), and what is asked.
#include "runtime/os_port/can_link.hpp"

#include <gtest/gtest.h>
#include <linux/can/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>

#include <cerrno>
#include <cstring>

#include "tests/runtime/os_port/link_answer.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT: everything here is about the runtime

const std::string kName(KernelInMemory::kInterface);

struct LinkRig {
  KernelInMemory kernel;

  CanLink ask(const std::string& attributes) {
    kernel.link = link_answer(attributes);
    const auto link = query_can_link(kName);
    EXPECT_TRUE(link) << link.error().text;
    return link.value_or(CanLink{});
  }
  PortError error(const std::string& answer) {
    kernel.link = answer;
    const auto link = query_can_link(kName);
    EXPECT_FALSE(link);
    return link ? PortError{} : link.error();
  }
};

TEST(CanLink, AsksForItsInterface) {
  LinkRig rig;
  rig.ask("");
  nlmsghdr header{};
  ifinfomsg info{};
  ASSERT_EQ(rig.kernel.asked.size(), sizeof header + sizeof info);
  std::memcpy(&header, rig.kernel.asked.data(), sizeof header);
  std::memcpy(&info, rig.kernel.asked.data() + sizeof header, sizeof info);
  EXPECT_EQ(header.nlmsg_len, sizeof header + sizeof info);
  EXPECT_EQ(header.nlmsg_type, RTM_GETLINK);
  EXPECT_EQ(header.nlmsg_flags, NLM_F_REQUEST);
  EXPECT_EQ(info.ifi_index, KernelInMemory::kIndex);
}

TEST(CanLink, HasIndexKindAndRate) {
  LinkRig rig;
  const CanLink link = rig.ask(link_info("can", bit_timing(250'000)));
  EXPECT_EQ(link.index, KernelInMemory::kIndex);
  EXPECT_EQ(link.kind, "can");
  EXPECT_EQ(link.bit_rate, 250'000U);
  const CanLink bare = rig.ask("");
  EXPECT_EQ(bare.index, KernelInMemory::kIndex);
  EXPECT_EQ(bare.kind, "");
  EXPECT_EQ(bare.bit_rate, std::nullopt);
  EXPECT_EQ(rig.ask(link_info("vcan", "")).kind, "vcan");
}

// Kind and rate stand among attributes of all lengths, each of which is filled up to four bytes. The kernel ends the
// kind with a 0, and marks what has attributes inside.
TEST(CanLink, FindsThemAmongOthers) {
  LinkRig rig;
  for (size_t length = 0; length < 9; ++length) {
    const std::string other = attribute(IFLA_IFNAME, std::string(length, 'x'));
    const std::string data = attribute(IFLA_CAN_STATE, std::string(length, '\1')) + bit_timing(125'000) +
                             attribute(IFLA_CAN_RESTART_MS, std::string(length, '\2'));
    const std::string info = attribute(IFLA_INFO_XSTATS, std::string(length, 'y')) +
                             attribute(IFLA_INFO_KIND, std::string_view("can\0", length % 2 == 0 ? 4 : 3)) +
                             attribute(NLA_F_NESTED | IFLA_INFO_DATA, data);
    const CanLink link = rig.ask(other + attribute(NLA_F_NESTED | IFLA_LINKINFO, info) + other);
    EXPECT_EQ(link.kind, "can") << length;
    EXPECT_EQ(link.bit_rate, 125'000U) << length;
  }
  // The number of an attribute means something only where it stands.
  const std::string timing = bit_timing(250'000);
  const CanLink link =
      rig.ask(attribute(IFLA_INFO_KIND, "can") + attribute(IFLA_INFO_DATA, timing) +
              attribute(IFLA_LINKINFO,
                        attribute(IFLA_INFO_SLAVE_DATA, timing) + attribute(IFLA_INFO_SLAVE_KIND, "can") +
                            attribute(IFLA_INFO_DATA, attribute(IFLA_CAN_DATA_BITTIMING, timing.substr(4)))));
  EXPECT_EQ(link.kind, "");
  EXPECT_EQ(link.bit_rate, std::nullopt);
}

// An adapter whose rate the kernel does not know says 0 or all bits set.
TEST(CanLink, ARateThatIsNone) {
  LinkRig rig;
  for (const uint32_t rate : {0U, ~0U})
    EXPECT_EQ(rig.ask(link_info("can", bit_timing(rate))).bit_rate, std::nullopt);
  for (const uint32_t rate : {1U, ~0U - 1})
    EXPECT_EQ(rig.ask(link_info("can", bit_timing(rate))).bit_rate, rate);
  const std::string whole(sizeof(can_bittiming), '\1');
  EXPECT_EQ(rig.ask(link_info("can", attribute(IFLA_CAN_BITTIMING, whole.substr(1)))).bit_rate, std::nullopt);
  EXPECT_EQ(rig.ask(link_info("can", attribute(IFLA_CAN_BITTIMING, whole))).bit_rate, 0x01010101U);
  EXPECT_EQ(rig.ask(link_info("can", attribute(IFLA_CAN_BITTIMING, whole + "more"))).bit_rate, 0x01010101U);
}

// Shorter than its own head, or longer than what is left: nothing can be read behind it.
TEST(CanLink, ABrokenAttributeEndsTheList) {
  LinkRig rig;
  const auto with_length = [](unsigned short length, std::string text) {
    std::memcpy(text.data(), &length, sizeof length);
    return text;
  };
  const std::string other = attribute(IFLA_IFNAME, "1234"), good = link_info("can", "");
  EXPECT_EQ(rig.ask(other + good).kind, "can");
  EXPECT_EQ(rig.ask(with_length(3, other) + good).kind, "");
  EXPECT_EQ(rig.ask(with_length(0, other) + good).kind, "");
  EXPECT_EQ(rig.ask(good + with_length(3, other)).kind, "can");
  const auto size = static_cast<unsigned short>(good.size());
  EXPECT_EQ(rig.ask(with_length(size, good)).kind, "can");
  EXPECT_EQ(rig.ask(with_length(static_cast<unsigned short>(size + 1), good)).kind, "");
  // The last one may lack what fills it up.
  std::string last = attribute(IFLA_LINKINFO, attribute(IFLA_INFO_KIND, "vxcan").substr(0, 4 + 5));
  last.resize(4 + 4 + 5);
  EXPECT_EQ(rig.ask(last).kind, "vxcan");
  EXPECT_EQ(rig.ask(good + std::string(3, '\x7F')).kind, "can") << "too short for one";
  // Empty, with nothing but its head.
  EXPECT_EQ(
      rig.ask(attribute(IFLA_LINKINFO, attribute(IFLA_INFO_KIND, "can") + attribute(IFLA_INFO_KIND, "")))
          .kind,
      "")
      << "the last one counts";
}

TEST(CanLink, WhatIsWrongIsSaid) {
  LinkRig rig;
  EXPECT_EQ(rig.error(link_answer("", ARPHRD_ETHER)).text,
            kName + ": is a network interface, but not for CAN");
  EXPECT_EQ(rig.error(link_answer("", ARPHRD_ETHER, 0)).fault, PortFault::NotCan);
  const PortError down = rig.error(link_answer("", ARPHRD_CAN, IFF_RUNNING));
  EXPECT_EQ(down.fault, PortFault::Down);
  EXPECT_EQ(down.text, kName + ": the interface is down: ip link set " + kName + " up");
  const std::string whole = link_answer("");
  EXPECT_EQ(rig.error(whole.substr(0, whole.size() - 1)).text,
            kName + ": the system refuses it: short answer");
  EXPECT_EQ(rig.error("").text, kName + ": the system refuses it: short answer");
  EXPECT_EQ(rig.error(link_answer("", ARPHRD_CAN, IFF_UP, NLMSG_ERROR)).text,
            kName + ": the system refuses it: the kernel does not describe it");
  rig.kernel.answer_error = EPERM;
  EXPECT_EQ(rig.error(whole).text, system_error(EPERM, kName).text);
  rig.kernel.ask_error = ENOMEM;
  EXPECT_EQ(rig.error(whole).text, system_error(ENOMEM, kName).text);
  rig.kernel.ask_socket_error = EMFILE;
  EXPECT_EQ(rig.error(whole).text, system_error(EMFILE, kName).text);
}

}  // namespace
}  // namespace ipos::tests
