// SocketCAN over a kernel in memory: how the socket is opened, frames both ways, a full queue, an interface that goes
// down, and time stamps (Documentation/networking/can.rst and timestamping.rst of Linux). Real interfaces are in
// tests/realbus.
#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/net_tstamp.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <deque>

#include "tests/runtime/os_port/link_answer.hpp"
#include "tests/runtime/os_port/port_rig.hpp"

namespace ipos::tests {
namespace {

const std::string kPort(KernelInMemory::kInterface);
using Notes = std::vector<std::string>;

struct SocketRig {
  KernelInMemory kernel;
  ManualClock clock;

  SocketRig() { kernel.link = link_answer(link_info("vcan", "")); }
  CanPortResult open(uint32_t baud = 500'000) { return open_can_port(kPort, baud, clock); }
  std::unique_ptr<CanPort> opened() {
    CanPortResult port = open();
    EXPECT_TRUE(port) << (port ? "" : port.error().text);
    return port ? std::move(*port) : nullptr;
  }
  // The next arrival; the kernel has one.
  CanArrival take(CanPort& port, const CanPacket& packet) {
    kernel.packets.push_back(packet);
    const auto got = port.receive();
    EXPECT_TRUE(got && *got);
    return got && *got ? **got : CanArrival{};
  }
};

can_frame raw(uint32_t id, const std::vector<uint8_t>& data = {}) {
  can_frame made{};
  made.can_id = id;
  made.can_dlc = static_cast<uint8_t>(data.size());
  std::copy(data.begin(), data.end(), std::begin(made.data));
  return made;
}

std::vector<uint32_t> ids(const std::vector<can_frame>& frames) {
  std::vector<uint32_t> all;
  for (const can_frame& one : frames) all.push_back(one.can_id);
  return all;
}
using Ids = std::vector<uint32_t>;

// --- opening

TEST(SocketCan, IsARawSocketWithErrorsAndStamps) {
  SocketRig rig;
  const auto port = rig.opened();
  EXPECT_EQ(rig.kernel.socket_type, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC);
  EXPECT_EQ(rig.kernel.socket_protocol, CAN_RAW);
  EXPECT_EQ(rig.kernel.bound.can_family, AF_CAN);
  EXPECT_EQ(rig.kernel.bound.can_ifindex, KernelInMemory::kIndex);
  const auto option = [&](int level, int number) {
    int value = -1;
    const std::string& bytes = rig.kernel.options[{level, number}];
    if (bytes.size() == sizeof value) std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  };
  EXPECT_EQ(option(SOL_CAN_RAW, CAN_RAW_ERR_FILTER), 0x1FFFFFFF) << "all classes";
  for (const int stamp : {SOF_TIMESTAMPING_RX_SOFTWARE, SOF_TIMESTAMPING_SOFTWARE,
                          SOF_TIMESTAMPING_RX_HARDWARE, SOF_TIMESTAMPING_RAW_HARDWARE})
    EXPECT_NE(option(SOL_SOCKET, SO_TIMESTAMPING) & stamp, 0) << stamp;
  EXPECT_EQ(option(SOL_SOCKET, SO_RXQ_OVFL), 1);
  EXPECT_EQ(option(SOL_SOCKET, SO_RCVBUF), 1'048'576);
  EXPECT_EQ(port->name(), kPort);
  EXPECT_EQ(port->absence(), "");
  EXPECT_EQ(port->waiting(), 0U);
  const PortNeeds needs = port->needs();
  EXPECT_EQ(std::tuple(needs.descriptor, needs.output, needs.wake),
            std::tuple(rig.kernel.can(), false, kNever));
}

TEST(SocketCan, NamesAreAtMostFifteenLong) {
  SocketRig rig;
  EXPECT_EQ(open_can_port("not-of-15-chars", 500'000, rig.clock).error().fault, PortFault::NoSuchInterface);
  EXPECT_EQ(open_can_port("not-of-16-chars!", 500'000, rig.clock).error().fault, PortFault::BadName);
}

TEST(SocketCan, TheRateIsThatOfTheInterface) {
  SocketRig rig;
  rig.kernel.link = link_answer(link_info("can", bit_timing(250'000)));
  EXPECT_EQ(rig.open(500'000).error().text,
            kPort + ": the interface has another bit rate than the bus: 250000 instead of 500000 bit/s");
  EXPECT_EQ(rig.open(250'001).error().fault, PortFault::WrongBitRate);
  const auto port = rig.open(250'000);
  ASSERT_TRUE(port);
  EXPECT_EQ((*port)->take_notes(), Notes{});
  for (const char* kind : {"can", "slcan", ""}) {
    rig.kernel.link = link_answer(link_info(kind, ""));
    EXPECT_EQ(rig.opened()->take_notes(),
              Notes{"the system does not know its bit rate; the bus has 500000 bit/s"})
        << kind;
  }
  for (const char* kind : {"vcan", "vxcan"}) {
    rig.kernel.link = link_answer(link_info(kind, ""));
    EXPECT_EQ(rig.opened()->take_notes(), Notes{}) << kind << " has none";
  }
}

TEST(SocketCan, WhatTheSystemRefusesIsSaid) {
  SocketRig rig;
  for (const int error : {EAFNOSUPPORT, EPROTONOSUPPORT}) {
    rig.kernel.socket_error = error;
    EXPECT_EQ(rig.open().error().text, kPort + ": this kernel has no CAN sockets (modules can and can-raw)");
  }
  for (const int error : {EPERM, EMFILE}) {
    rig.kernel.socket_error = error;
    EXPECT_EQ(rig.open().error().text, system_error(error, kPort).text);
  }
  rig.kernel.socket_error = 0;
  const std::pair<int, int> options[] = {{SOL_CAN_RAW, CAN_RAW_ERR_FILTER},
                                         {SOL_SOCKET, SO_TIMESTAMPING},
                                         {SOL_SOCKET, SO_RXQ_OVFL},
                                         {SOL_SOCKET, SO_RCVBUF}};
  for (const auto& option : options) {
    rig.kernel.option_errors = {{option, ENOPROTOOPT}};
    const auto port = rig.open();
    ASSERT_FALSE(port) << option.first << ' ' << option.second;
    EXPECT_EQ(port.error().text, system_error(ENOPROTOOPT, kPort).text);
  }
  rig.kernel.option_errors.clear();
  rig.kernel.bind_error = ENODEV;
  EXPECT_EQ(rig.open().error().text, system_error(ENODEV, kPort).text);
  rig.kernel.link = link_answer("", ARPHRD_CAN, 0);
  EXPECT_EQ(rig.open().error().fault, PortFault::Down);
}

// --- frames

TEST(SocketCan, FramesAreThoseOfTheKernel) {
  SocketRig rig;
  const auto port = rig.opened();
  const std::tuple<Frame, uint32_t, std::vector<uint8_t>> rows[] = {
      {{0x123, 2, {0xAB, 0xCD}}, 0x123, {0xAB, 0xCD}},
      {{0x7FF, 0}, 0x7FF, {}},
      {{0, 8, {1, 2, 3, 4, 5, 6, 7, 8}}, 0, {1, 2, 3, 4, 5, 6, 7, 8}},
      {{0x123, 1, {9}, true}, 0x80000123, {9}},
      {{0x1FFFFFFF, 0, {}, true}, 0x9FFFFFFF, {}},
      {{0x321, 0, {}, false, true}, 0x40000321, {}},
      {{0x10000000, 0, {}, true, true}, 0xD0000000, {}}};
  for (const auto& [frame, id, data] : rows) {
    rig.kernel.written.clear();
    port->send(frame);
    ASSERT_EQ(rig.kernel.written.size(), 1U);
    const can_frame& sent = rig.kernel.written[0];
    EXPECT_EQ(sent.can_id, id);
    EXPECT_EQ(std::vector<uint8_t>(sent.data, sent.data + sent.can_dlc), data);
    CanPacket packet;
    packet.frame = raw(id, data);
    EXPECT_EQ(rig.take(*port, packet).frame, frame) << id;
  }
  EXPECT_EQ(port->counts().sent, std::size(rows));
  EXPECT_EQ(port->counts().received, std::size(rows));
  EXPECT_EQ(port->waiting(), 0U);
}

// A length above 8 stands for 8 (ISO 11898-1); what stands behind the length is nobody's, and a remote frame has no data.
// Of a standard frame the identifier has 11 bits.
TEST(SocketCan, OnlyWhatIsOnTheWireIsTaken) {
  SocketRig rig;
  const auto port = rig.opened();
  CanPacket packet;
  packet.frame = raw(0x123, {1, 2, 3, 4, 5, 6, 7, 8});
  packet.frame.can_dlc = 15;
  EXPECT_EQ(rig.take(*port, packet).frame, (Frame{0x123, 8, {1, 2, 3, 4, 5, 6, 7, 8}}));
  packet.frame.can_dlc = 3;
  EXPECT_EQ(rig.take(*port, packet).frame, (Frame{0x123, 3, {1, 2, 3}}));
  packet.frame.can_id = 0x40000000 | 0x1F123;
  EXPECT_EQ(rig.take(*port, packet).frame, (Frame{0x723 & 0x123, 3, {}, false, true}));
}

TEST(SocketCan, ErrorFramesAreNoFrames) {
  SocketRig rig;
  const auto port = rig.opened();
  CanPacket packet;
  packet.frame = raw(CAN_ERR_FLAG | CAN_ERR_ACK | CAN_ERR_CRTL, {0, 0x20, 3, 4, 5, 6, 7, 8});
  const CanArrival arrival = rig.take(*port, packet);
  ASSERT_TRUE(arrival.error);
  EXPECT_EQ(arrival.error->classes, 0x24U);
  EXPECT_EQ(std::vector<int>(arrival.error->data.begin(), arrival.error->data.end()),
            (std::vector<int>{0, 0x20, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(port->counts().received, 0U);
  packet.frame = raw(0x100);
  EXPECT_FALSE(rig.take(*port, packet).error);
  EXPECT_EQ(port->counts().received, 1U);
}

// --- when the system takes none

// Nobody tells when there is room again: after a millisecond the first one is tried again, and then all of them.
TEST(SocketCan, AFullQueueIsTriedAgain) {
  for (const int full : {ENOBUFS, EAGAIN}) {
    SocketRig rig;
    const auto port = rig.opened();
    rig.kernel.refusals = {full};
    port->send(frame(1));
    port->send(frame(2));
    EXPECT_EQ(rig.kernel.attempts, 1) << "not with each frame";
    EXPECT_EQ(port->waiting(), 2U);
    EXPECT_EQ(port->counts().waited, 1U);
    EXPECT_EQ(port->needs().wake, rig.clock.now() + kMillisecond);
    rig.clock.advance(kMillisecond - 1);
    ASSERT_TRUE(port->flush());
    EXPECT_EQ(rig.kernel.attempts, 1);
    rig.clock.advance(1);
    rig.kernel.refusals = {0, full};
    ASSERT_TRUE(port->flush());
    EXPECT_EQ(ids(rig.kernel.written), Ids{1});
    EXPECT_EQ(port->counts().waited, 2U);
    EXPECT_EQ(port->needs().wake, rig.clock.now() + kMillisecond);
    rig.clock.advance(kMillisecond);
    ASSERT_TRUE(port->flush());
    EXPECT_EQ(ids(rig.kernel.written), (Ids{1, 2}));
    EXPECT_EQ(port->needs().wake, kNever);
    port->send(frame(3));
    EXPECT_EQ(ids(rig.kernel.written), (Ids{1, 2, 3})) << "at once again";
    const PortCounts& counts = port->counts();
    EXPECT_EQ(std::tuple(counts.sent, counts.waited, counts.lost_out), std::tuple(3U, 2U, 0U));
    EXPECT_EQ(port->take_notes(), Notes{});
  }
}

TEST(SocketCan, WhatFindsTheQueueFullIsLost) {
  SocketRig rig;
  const auto port = rig.opened();
  rig.kernel.refusals = {ENOBUFS};
  for (uint32_t n = 0; n < kCanPortQueue; ++n) port->send(frame(n));
  EXPECT_EQ(port->waiting(), kCanPortQueue);
  EXPECT_EQ(port->counts().lost_out, 0U);
  EXPECT_EQ(port->take_notes(), Notes{});
  port->send(frame(9));
  port->send(frame(9));
  EXPECT_EQ(port->counts().lost_out, 2U);
  EXPECT_EQ(
      port->take_notes(),
      Notes{
          "frames are lost: 1024 wait to be sent and the system takes none; is there another station on the "
          "bus, and the same bit rate?"});
  rig.clock.advance(kMillisecond);
  ASSERT_TRUE(port->flush());
  ASSERT_EQ(rig.kernel.written.size(), kCanPortQueue);
  for (uint32_t n = 0; n < kCanPortQueue; ++n) EXPECT_EQ(rig.kernel.written[n].can_id, n);
}

TEST(SocketCan, ASignalInBetweenIsNothing) {
  SocketRig rig;
  const auto port = rig.opened();
  rig.kernel.refusals = {EINTR, EINTR};
  port->send(frame(1));
  EXPECT_EQ(ids(rig.kernel.written), Ids{1});
  EXPECT_EQ(port->counts().waited, 0U);
  CanPacket signal;
  signal.error = EINTR;
  rig.kernel.packets = {signal, signal};
  CanPacket packet;
  packet.frame = raw(5);
  EXPECT_EQ(rig.take(*port, packet).frame.id, 5U);
}

TEST(SocketCan, AFrameThatIsRefusedIsLostAlone) {
  SocketRig rig;
  const auto port = rig.opened();
  rig.kernel.refusals = {ENOBUFS};
  port->send(frame(1));
  port->send(frame(2));
  rig.clock.advance(kMillisecond);
  rig.kernel.refusals = {EINVAL};
  ASSERT_TRUE(port->flush());
  EXPECT_EQ(ids(rig.kernel.written), Ids{2});
  EXPECT_EQ(std::tuple(port->counts().sent, port->counts().lost_out), std::tuple(1U, 1U));
  EXPECT_EQ(port->take_notes(), Notes{std::string("a frame is refused: ") + std::strerror(EINVAL)});
}

TEST(SocketCan, AnInterfaceThatHasGoneIsAnError) {
  for (const int error : {ENODEV, ENXIO}) {
    SocketRig rig;
    const auto port = rig.opened();
    rig.kernel.refusals = {error, error};
    port->send(frame(1));
    const auto flushed = port->flush();
    ASSERT_FALSE(flushed);
    EXPECT_EQ(flushed.error().text, system_error(error, kPort).text);
    CanPacket packet;
    packet.error = error;
    rig.kernel.packets = {packet};
    const auto got = port->receive();
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().text, system_error(error, kPort).text);
  }
}

// --- down and up again

// The socket does not tell that its interface is up again: it is asked every 200 ms.
TEST(SocketCan, AnInterfaceThatIsDownIsAskedFor) {
  for (const bool by_sending : {false, true}) {
    SocketRig rig;
    const auto port = rig.opened();
    if (by_sending) {
      rig.kernel.refusals = {ENOBUFS};
      port->send(frame(1));
      port->send(frame(2));
      rig.clock.advance(kMillisecond);
      rig.kernel.refusals = {ENETDOWN};
      ASSERT_TRUE(port->flush());
      EXPECT_EQ(port->waiting(), 0U);
      EXPECT_EQ(port->counts().lost_out, 2U);
      EXPECT_EQ(port->take_notes(), Notes{"the interface is down: frames to it are lost"});
    } else {
      CanPacket packet;
      packet.error = ENETDOWN;
      rig.kernel.packets = {packet};
      const auto got = port->receive();
      ASSERT_TRUE(got);
      EXPECT_FALSE(*got);
      EXPECT_EQ(port->take_notes(), Notes{"the interface has been set down"});
    }
    EXPECT_EQ(port->absence(), "the interface is down");
    const Time pause = 200 * kMillisecond;
    for (const int asked : {0, 1}) {  // it is still down
      rig.kernel.flags = IFF_RUNNING;
      rig.clock.advance(pause - 1);
      ASSERT_TRUE(port->flush());
      EXPECT_EQ(rig.kernel.flags_asked, asked);
      rig.clock.advance(1);
      ASSERT_TRUE(port->flush());
      EXPECT_EQ(rig.kernel.flags_asked, asked + 1);
      EXPECT_EQ(port->absence(), "the interface is down");
    }
    EXPECT_EQ(rig.kernel.asked_flags_of, kPort);
    rig.kernel.flags = IFF_UP;
    rig.clock.advance(pause);
    ASSERT_TRUE(port->flush());
    EXPECT_EQ(port->absence(), "");
    rig.clock.advance(pause);
    ASSERT_TRUE(port->flush());
    EXPECT_EQ(rig.kernel.flags_asked, 3) << "nobody asks while it is up";
    port->send(frame(3));
    EXPECT_EQ(ids(rig.kernel.written), Ids{3});
  }
}

TEST(SocketCan, AnInterfaceThatCannotBeAskedForHasGone) {
  SocketRig rig;
  const auto port = rig.opened();
  rig.kernel.refusals = {ENETDOWN};
  port->send(frame(1));
  rig.kernel.flags_error = ENODEV;
  rig.clock.advance(200 * kMillisecond);
  const auto flushed = port->flush();
  ASSERT_FALSE(flushed);
  EXPECT_EQ(flushed.error().text, system_error(ENODEV, kPort).text);
}

TEST(SocketCan, WithoutAFrameThereIsNone) {
  SocketRig rig;
  const auto port = rig.opened();
  const auto got = port->receive();
  ASSERT_TRUE(got);
  EXPECT_FALSE(*got);
  EXPECT_EQ(port->take_notes(), Notes{});
  CanPacket packet;
  packet.error = ENOMEM;
  rig.kernel.packets = {packet};
  EXPECT_EQ(port->receive().error().text, system_error(ENOMEM, kPort).text);
}

// --- losses and times

// The kernel counts what is lost since the socket was opened, and says it with the next frame.
TEST(SocketCan, WhatCameTooFastIsCounted) {
  SocketRig rig;
  const auto port = rig.opened();
  CanPacket packet;
  for (const auto& [lost, sum] :
       {std::pair(0U, 0U), std::pair(3U, 3U), std::pair(3U, 3U), std::pair(10U, 10U)}) {
    packet.lost = lost;
    packet.level = SOL_CAN_RAW;  // the same number of another level is something else
    rig.take(*port, packet);
    EXPECT_EQ(port->counts().lost_in, sum);
    if (lost == 0) {
      EXPECT_EQ(port->take_notes(), Notes{});
    }
  }
  packet.lost.reset();
  rig.take(*port, packet);
  EXPECT_EQ(port->counts().lost_in, 10U);
  EXPECT_EQ(port->take_notes(), Notes{"frames from it are lost: they came faster than they were read"});
}

// The kernel's stamp is of the clock that may be set, so its age counts. The clock of the test stands at 1000 s, and the
// other one 5 s later.
TEST(SocketCan, AFrameCameWhenItsStampSays) {
  constexpr Time kWall = 1'005 * kSecond, kNow = 1'000 * kSecond;
  const auto at = [](Time stamp, bool stamped = true) {
    SocketRig rig;
    const auto port = rig.opened();
    CanPacket packet;
    packet.software = stamp;
    packet.stamped = stamped;
    packet.level = SOL_CAN_RAW;
    return rig.take(*port, packet).at;
  };
  EXPECT_EQ(at(kWall - 123'456'789), kNow - 123'456'789);
  EXPECT_EQ(at(kWall), kNow);
  EXPECT_EQ(at(kWall - 1), kNow - 1);
  EXPECT_EQ(at(kWall + 1), kNow) << "of the future: the clock was set back";
  EXPECT_EQ(at(kWall - kSecond), kNow - kSecond);
  EXPECT_EQ(at(kWall - kSecond - 1), kNow) << "too old: the clock was set on";
  EXPECT_EQ(at(0), kNow);
  EXPECT_EQ(at(0, false), kNow) << "no stamp at all";
}

TEST(SocketCan, ArrivalsDoNotGoBack) {
  SocketRig rig;
  const auto port = rig.opened();
  CanPacket packet;
  packet.software = rig.clock.wall() - 10;
  const Time first = rig.take(*port, packet).at;
  EXPECT_EQ(first, rig.clock.now() - 10);
  packet.software -= 5;
  EXPECT_EQ(rig.take(*port, packet).at, first);
  packet.software += 6;
  EXPECT_EQ(rig.take(*port, packet).at, first + 1);
}

TEST(SocketCan, AControllersOwnTimeIsPassedOn) {
  SocketRig rig;
  const auto port = rig.opened();
  CanPacket packet;
  packet.level = SOL_CAN_RAW;
  EXPECT_EQ(rig.take(*port, packet).device_time, std::nullopt);
  for (const Time own : {Time{1}, Time{999'999'999}, 12 * kSecond + 345}) {
    packet.hardware = own;
    EXPECT_EQ(rig.take(*port, packet).device_time, own);
  }
}

// A clock whose readings a test gives; the last one of each goes on for ever, `step` later each time.
class ReadClock final : public RealClock {
 public:
  Time now() override { return take(nows, last_now_); }
  Time wall() override {
    ++walls_read;
    return take(walls, last_wall_);
  }
  void wait(Time, std::span<const PortNeeds>) override {}
  std::deque<Time> nows, walls;
  Time step = 0;
  int walls_read = 0;

 private:
  Time take(std::deque<Time>& readings, Time& last) {
    if (readings.empty()) return last += step;
    last = readings.front();
    readings.pop_front();
    return last;
  }
  Time last_now_ = 0, last_wall_ = 0;
};

// Both clocks have to be read at the same moment: a host that pauses in between would make the frame too old. After a
// pause of more than 0.1 ms they are read again, four times at most.
TEST(SocketCan, APauseBetweenTheClocksIsNoAge) {
  constexpr Time kLongest = 100 * kMicrosecond, kBegin = 50 * kSecond;
  for (const Time pause : {Time{0}, kLongest, kLongest + 1, kSecond / 2}) {
    SocketRig rig;
    ReadClock clock;
    const auto port = open_can_port(kPort, 500'000, clock);
    ASSERT_TRUE(port);
    // The pause lies in front of the first reading of the other clock.
    const Time wall = 70 * kSecond;
    clock.nows = {kBegin, kBegin + pause};
    clock.walls = {wall + pause};
    CanPacket packet;
    packet.software = wall - 5'000;
    const Time at = rig.take(**port, packet).at;
    const bool again = pause > kLongest;
    EXPECT_EQ(clock.walls_read, again ? 2 : 1) << pause;
    EXPECT_EQ(at, again ? kBegin - 5'000 : kBegin - pause - 5'000) << pause;
  }
  SocketRig rig;
  ReadClock clock;
  clock.step = kMillisecond;
  const auto port = open_can_port(kPort, 500'000, clock);
  ASSERT_TRUE(port);
  rig.take(**port, {});
  EXPECT_EQ(clock.walls_read, 5);
}

}  // namespace
}  // namespace ipos::tests
