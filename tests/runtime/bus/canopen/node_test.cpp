// A node on a line: states, SDO, EMCY, guarding and heartbeat, frame by frame.
#include "runtime/bus/canopen/node.hpp"

#include <gtest/gtest.h>

#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/canopen/node_rig.hpp"

namespace ipos::tests {
namespace {

using Frames = std::vector<Frame>;

constexpr Frame kBootUp{0x705, 1, {0x00}};

TEST(CanopenNode, BootUp) {
  PROVES("MDB-TOC-07");
  NodeRig rig;
  EXPECT_EQ(rig.master.frames, Frames{kBootUp});
  EXPECT_EQ(rig.station.node.state(), State::PreOperational);
  EXPECT_EQ(rig.ask(remote(0x705, 1)), (Frames{{0x705, 1, {0x7F}}}));
  rig.nmt(NmtCommand::Start);
  EXPECT_EQ(rig.ask(remote(0x705, 1)), (Frames{{0x705, 1, {0x85}}}));
  rig.nmt(NmtCommand::Stop);
  EXPECT_EQ(rig.ask(remote(0x705, 1)), (Frames{{0x705, 1, {0x04}}}));
}

TEST(CanopenNode, CommandsMoveTheState) {
  PROVES("MDB-TOC-06");
  const std::pair<Frame, State> steps[] = {
      {{0x000, 2, {0x01, 5}}, State::Operational},    {{0x000, 2, {0x02, 5}}, State::Stopped},
      {{0x000, 2, {0x80, 5}}, State::PreOperational}, {{0x000, 2, {0x01, 0}}, State::Operational},
      {{0x000, 2, {0x80, 6}}, State::Operational},    {{0x000, 2, {0x02, 0}}, State::Stopped},
      {{0x000, 2, {0x01, 0}}, State::Operational},    {{0x000, 2, {0x82, 0}}, State::PreOperational},
      {{0x000, 2, {0x01, 5}}, State::Operational},    {{0x000, 2, {0x81, 5}}, State::PreOperational}};
  NodeRig rig;
  for (const auto& [frame, state] : steps) {
    const auto answer = rig.ask(frame);
    EXPECT_EQ(rig.station.node.state(), state);
    EXPECT_EQ(answer, frame.data[0] > 0x80 ? Frames{kBootUp} : Frames{});
  }
  EXPECT_EQ(rig.station.unit.resets, 1);
  EXPECT_TRUE(rig.station.ignored.empty());
  rig.ask({0x000, 1, {0x01}});
  rig.ask({0x000, 3, {0x01, 5, 0}});
  rig.ask({0x000, 2, {0x03, 5}});
  EXPECT_EQ(rig.station.node.state(), State::PreOperational);
  EXPECT_EQ(rig.station.ignored, (std::vector{IgnoredMessage::WrongLength, IgnoredMessage::WrongLength,
                                              IgnoredMessage::WrongCommand}));
}

TEST(CanopenNode, NodeZeroMovesAll) {
  PROVES("MDB-TOC-06");
  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  Hand master{line, "master"};
  Station a{queue, 1, line, 1}, b{queue, 2, line, 2};
  for (Station* station : {&a, &b}) station->node.start(0);
  queue.run_until(kMillisecond);
  master.port.send({0x000, 2, {0x01, 2}}, 0);
  queue.run_until(2 * kMillisecond);
  EXPECT_EQ(a.node.state(), State::PreOperational);
  EXPECT_EQ(b.node.state(), State::Operational);
  master.port.send({0x000, 2, {0x01, 0}}, 0);
  queue.run_until(3 * kMillisecond);
  EXPECT_EQ(a.node.state(), State::Operational);
  EXPECT_EQ(b.node.state(), State::Operational);
}

TEST(CanopenNode, ServicesByState) {
  PROVES("MDB-TOC-08");
  NodeRig rig;
  const Frame output{0x205, 6, {6, 0, 1, 0, 2, 0}};
  const Frame upload{0x605, 8, {0x40, 0x00, 0x18, 0x02}};
  const Frames answer{{0x585, 8, {0x4F, 0x00, 0x18, 0x02, 0x01}}};
  // Pre-operational: SDO, SYNC and EMCY, no PDO.
  EXPECT_EQ(rig.ask(upload), answer);
  rig.ask(output);
  EXPECT_TRUE(rig.sync().empty());
  EXPECT_TRUE(rig.station.unit.taken.empty());
  EXPECT_EQ(rig.station.unit.syncs.size(), 1U);
  EXPECT_EQ(rig.station.ignored, std::vector{IgnoredMessage::WrongState});
  // Operational: all.
  rig.nmt(NmtCommand::Start);
  EXPECT_EQ(rig.ask(upload), answer);
  rig.ask(output);
  EXPECT_EQ(rig.sync(), (Frames{{0x185, 6}}));
  EXPECT_EQ(rig.station.unit.outputs[0], 6);
  // Stopped: NMT and guarding only.
  rig.nmt(NmtCommand::Stop);
  rig.ask(output);
  EXPECT_TRUE(rig.sync().empty());
  EXPECT_TRUE(rig.ask(upload).empty());
  EXPECT_TRUE(rig.ask(remote(0x185, 6)).empty());
  EXPECT_EQ(rig.ask(remote(0x705, 1)).size(), 1U);
  EXPECT_EQ(rig.station.unit.taken.size(), 1U);
  rig.station.unit.state = {0x2B22, true, false};
  rig.clear();
  rig.station.node.unit_changed(rig.queue.now());
  rig.run(10 * kMillisecond);
  EXPECT_TRUE(rig.master.frames.empty());
  // What went wrong meanwhile is told when it may be (ours).
  EXPECT_EQ(rig.ask({0x000, 2, {0x80, 5}}), (Frames{{0x085, 8, {0x00, 0xFF, 0x81, 0x00, 0x22, 0x2B}}}));
}

TEST(CanopenNode, SdoOnTheLine) {
  PROVES("MDB-TOC-16");
  NodeRig rig;
  rig.clear();
  const Time asked = rig.queue.now();
  EXPECT_EQ(rig.ask({0x605, 8, {0x40, 0x7E, 0x20, 0x00}}),
            (Frames{{0x585, 8, {0x43, 0x7E, 0x20, 0x00, 0x40, 0x42, 0x0F, 0x00}}}));
  EXPECT_GT(rig.master.times[0], asked + 2 * kMillisecond);
  EXPECT_LT(rig.master.times[0], asked + 3 * kMillisecond);
  EXPECT_TRUE(rig.ask({0x605, 4, {0x40, 0x7E, 0x20, 0x00}}).empty());
  EXPECT_EQ(rig.station.ignored, std::vector{IgnoredMessage::WrongLength});
  // A client that leaves a transfer hears of it after a second.
  EXPECT_EQ(rig.ask({0x605, 8, {0x40, 0x08, 0x10, 0x00}}).size(), 1U);
  rig.clear();
  rig.run(900 * kMillisecond);
  EXPECT_TRUE(rig.master.frames.empty());
  rig.run(200 * kMillisecond);
  EXPECT_EQ(rig.master.frames, (Frames{{0x585, 8, {0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}}}));
}

TEST(CanopenNode, ResetRestoresTheObjects) {
  NodeRig rig;
  rig.write(0x1400, 2, 255, 1);
  rig.write(0x1014, 0, 0x8000'0085, 4);
  rig.write(0x1017, 0, 50, 2);
  rig.nmt(NmtCommand::ResetCommunication);
  EXPECT_EQ(rig.station.node.dictionary().value(0x1400, 2), 1U);
  EXPECT_EQ(rig.station.node.dictionary().value(0x1014), 0x85U);
  rig.clear();
  rig.run(200 * kMillisecond);
  EXPECT_TRUE(rig.master.frames.empty());  // no heartbeat any more
}

TEST(CanopenEmergency, OnceWhenItAppearsAndOnceWhenItIsGone) {
  PROVES("MDB-TOC-12");
  NodeRig rig;
  const auto after = [&](const UnitStatus& status) {
    rig.clear();
    rig.station.unit.state = status;
    for (int n = 0; n < 3; ++n) {
      rig.station.node.unit_changed(rig.queue.now());
      rig.run(kMillisecond);
    }
    return rig.master.frames;
  };
  EXPECT_TRUE(after({0x0202, false, false}).empty());
  EXPECT_EQ(after({0x2B22, true, false}), (Frames{{0x085, 8, {0x00, 0xFF, 0x81, 0x00, 0x22, 0x2B, 0, 0}}}));
  EXPECT_EQ(rig.station.node.dictionary().value(0x1001), 0x81U);
  EXPECT_EQ(after({0x2B22, true, true}), (Frames{{0x085, 8, {0x00, 0x31, 0x85, 0x00, 0, 0, 0, 0}}}));
  EXPECT_EQ(after({0x0202, false, true}), (Frames{{0x085, 8, {0x00, 0x00, 0x05, 0x00, 0x02, 0x02, 0, 0}}}));
  EXPECT_EQ(after({0x0202, false, false}), (Frames{{0x085, 8, {0, 0, 0, 0, 0, 0, 0, 0}}}));
  const ObjectDictionary& dictionary = rig.station.node.dictionary();
  EXPECT_EQ(dictionary.value(0x1003), 2U);
  EXPECT_EQ(dictionary.value(0x1003, 1), 0x0000'3100U);
  EXPECT_EQ(dictionary.value(0x1003, 2), 0x2B22'FF00U);
  rig.write(0x1003, 0, 0, 1);
  EXPECT_EQ(dictionary.value(0x1003), 0U);
  EXPECT_EQ(dictionary.value(0x1003, 2), 0U);
  // No more than five are kept.
  for (int n = 0; n < 7; ++n) {
    after({0x2B22, true, false});
    after({0x0202, false, false});
  }
  EXPECT_EQ(dictionary.value(0x1003), 5U);
}

TEST(CanopenEmergency, IdentifierAndInhibitTime) {
  PROVES("MDB-TOC-12");
  NodeRig rig;
  rig.write(0x1014, 0, 0x0000'0090, 4);
  rig.write(0x1015, 0, 200, 2);  // 20 ms
  rig.clear();
  const Time begin = rig.queue.now();
  for (const bool fault : {true, false, true}) {
    rig.station.unit.state.fault = fault;
    rig.station.node.unit_changed(rig.queue.now());
  }
  rig.run(100 * kMillisecond);
  ASSERT_EQ(rig.master.frames.size(), 3U);
  for (size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(rig.master.frames[n].id, 0x090U);
    EXPECT_NEAR(static_cast<double>(rig.master.times[n] - begin), static_cast<double>(n) * 20e6, 1e6);
  }
  rig.write(0x1014, 0, 0x8000'0090, 4);  // off
  rig.clear();
  rig.station.unit.state.fault = false;
  rig.station.node.unit_changed(rig.queue.now());
  rig.run(100 * kMillisecond);
  EXPECT_TRUE(rig.master.frames.empty());
}

TEST(CanopenGuarding, LifeTimeFromTheFirstRequest) {
  PROVES("MDB-TOC-12");
  NodeRig rig;
  // Answered also while the life time is 0; nothing is supervised then.
  EXPECT_EQ(rig.ask(remote(0x705, 1)), (Frames{{0x705, 1, {0x7F}}}));
  EXPECT_EQ(rig.ask(remote(0x705, 1)), (Frames{{0x705, 1, {0xFF}}}));
  rig.write(0x100C, 0, 20, 2);
  rig.write(0x100D, 0, 3, 1);
  rig.run(kSecond);
  EXPECT_TRUE(rig.station.unit.lost.empty());  // no request yet
  for (int n = 0; n < 10; ++n) EXPECT_EQ(rig.ask(remote(0x705, 1), 20 * kMillisecond).size(), 1U);
  EXPECT_TRUE(rig.station.unit.lost.empty());
  const Time last = rig.queue.now() - 20 * kMillisecond;
  rig.clear();
  rig.run(100 * kMillisecond);
  EXPECT_EQ(rig.master.frames, (Frames{{0x085, 8, {0x30, 0x81, 0x11, 0, 0, 0, 0, 0}}}));
  ASSERT_EQ(rig.station.unit.lost.size(), 1U);
  EXPECT_NEAR(static_cast<double>(rig.station.unit.lost[0] - last), 60e6, 1e6);
  // The next request ends it.
  const auto answer = rig.ask(remote(0x705, 1));
  ASSERT_EQ(answer.size(), 2U);
  EXPECT_EQ(rig.count(0x705), 1U);
  EXPECT_EQ(rig.count(0x085), 1U);
  EXPECT_EQ(rig.station.unit.back.size(), 1U);
}

TEST(CanopenHeartbeat, Produced) {
  PROVES("MDB-TOC-14");
  NodeRig rig;
  rig.write(0x1017, 0, 100, 2);
  EXPECT_TRUE(rig.ask(remote(0x705, 1), kMillisecond).empty());  // never both
  EXPECT_EQ(rig.station.ignored, std::vector{IgnoredMessage::NotGuarded});
  rig.clear();
  rig.run(kSecond);
  ASSERT_EQ(rig.master.frames.size(), 10U);
  for (size_t n = 0; n < 10; ++n) {
    EXPECT_EQ(rig.master.frames[n], (Frame{0x705, 1, {0x7F}}));
    if (n > 0) {
      EXPECT_EQ(rig.master.times[n] - rig.master.times[n - 1], 100 * kMillisecond);
    }
  }
  rig.nmt(NmtCommand::Start);
  rig.clear();
  rig.run(100 * kMillisecond);
  EXPECT_EQ(rig.master.frames, (Frames{{0x705, 1, {0x05}}}));
}

TEST(CanopenHeartbeat, Consumed) {
  PROVES("MDB-TOC-14");
  NodeRig rig;
  rig.write(0x1016, 1, 0x007F'0032, 4);  // node 127 within 50 ms
  rig.run(kSecond);
  EXPECT_TRUE(rig.station.unit.lost.empty());  // supervision begins with the first one
  for (int n = 0; n < 5; ++n) rig.ask({0x77F, 1, {0x05}}, 40 * kMillisecond);
  EXPECT_TRUE(rig.station.unit.lost.empty());
  rig.clear();
  rig.run(50 * kMillisecond);
  EXPECT_EQ(rig.master.frames, (Frames{{0x085, 8, {0x30, 0x81, 0x11}}}));
  EXPECT_EQ(rig.station.unit.lost.size(), 1U);
  EXPECT_EQ(rig.ask({0x77F, 1, {0x05}}), (Frames{{0x085, 8, {}}}));
  EXPECT_EQ(rig.station.unit.back.size(), 1U);
  // One that is no longer awaited is not missed either (ours).
  rig.run(100 * kMillisecond);
  EXPECT_EQ(rig.station.unit.lost.size(), 2U);
  rig.write(0x1016, 1, 0, 4);
  EXPECT_EQ(rig.station.unit.back.size(), 2U);
  rig.ask({0x77E, 1, {0x05}});  // another node is none of its business
  EXPECT_EQ(rig.station.foreign, 0);
}

// What waits to be sent when the communication is reset is not sent any more, of whatever kind it is: here the answer
// to a SYNC of each transmit PDO, and an EMCY.
TEST(CanopenNode, AResetWithdrawsWhatWaits) {
  NodeRig rig;
  for (uint16_t n = 1; n < 4; ++n) {
    rig.write(static_cast<uint16_t>(0x1A00 + n), 1, 0x2001'0110, 4);
    rig.write(static_cast<uint16_t>(0x1A00 + n), 0, 1, 1);
    rig.write(static_cast<uint16_t>(0x1800 + n), 1, 0x185U + 0x100U * n, 4);
  }
  rig.nmt(NmtCommand::Start);
  rig.sync(5 * kMillisecond);
  for (const uint32_t id : {0x185U, 0x285U, 0x385U, 0x485U}) EXPECT_EQ(rig.count(id), 1U) << id;
  rig.clear();
  const size_t syncs = rig.station.unit.syncs.size();
  rig.master.port.send({0x080, 0}, 0);
  while (rig.station.unit.syncs.size() == syncs) rig.run(rig.line.bit_time());
  rig.station.unit.state = {0x2B22, true, false};
  rig.station.node.unit_changed(rig.queue.now());
  rig.station.node.start(rig.queue.now());
  rig.run(10 * kMillisecond);
  EXPECT_EQ(rig.master.frames, Frames{kBootUp});
}

}  // namespace
}  // namespace ipos::tests
