// A node at a sender that keeps what it is given, to the nanosecond: what it listens to and what is its own, tags, the
// order of a SYNC, answers that are due in another state, and supervision that is switched on, off and over.
#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "runtime/bus/canopen/node.hpp"
#include "tests/runtime/bus/canopen/fake_unit.hpp"

namespace ipos::tests {
namespace {

struct NodeSender final : FrameSender {
  explicit NodeSender(EventQueue& its_queue) : queue(its_queue) {}
  SendStatus send(const Frame& frame, uint64_t tag) override {
    sent.emplace_back(queue.now(), frame, tag);
    return SendStatus::Queued;
  }
  void withdraw(uint64_t tag) override {
    std::erase_if(sent, [tag](const auto& one) { return std::get<2>(one) == tag; });
  }
  void listen(uint32_t id) override { listened.insert(id); }
  EventQueue& queue;
  std::vector<std::tuple<Time, Frame, uint64_t>> sent;
  std::set<uint32_t> listened;
};
using SentFrames = std::vector<std::tuple<Time, Frame, uint64_t>>;

// A unit that keeps the order of what it is asked and told.
struct OrderedUnit final : canopen::Unit, ParameterServer {
  tl::expected<int32_t, ReturnCode> serve(Time, const ParameterRequest&) override { return 7; }
  void take_output(Time, const Words& words, uint16_t written) override {
    calls.push_back("output " + std::to_string(words[0]) + " " + std::to_string(written));
  }
  Words input(Time, uint16_t) override {
    calls.emplace_back("input");
    return {word};
  }
  UnitStatus status(Time) override { return state; }
  void synchronize(Time) override { calls.emplace_back("sync"); }
  void state_changed(Time, State to) override {
    calls.push_back("state " + std::to_string(static_cast<int>(to)));
  }
  void reset_node(Time) override { calls.emplace_back("reset"); }
  void partner_lost(Time now) override { calls.push_back("lost " + std::to_string(now / kMillisecond)); }
  void partner_back(Time now) override { calls.push_back("back " + std::to_string(now / kMillisecond)); }
  std::vector<std::string> take() { return std::exchange(calls, {}); }
  std::vector<std::string> calls;
  uint16_t word = 0;
  UnitStatus state;
};
using Calls = std::vector<std::string>;

struct NodeDesk final : NodeObserver {
  NodeDesk() {
    node.start(0);
    take();
    unit.take();
  }
  void on_ignored(Time, const Frame&, IgnoredMessage reason) override { ignored.push_back(reason); }
  bool give(const Frame& frame) { return node.on_frame(queue.now(), frame); }
  void run(Time span) { queue.run_until(queue.now() + span); }
  void to(NmtCommand command) { give(nmt_frame(command, 5)); }
  SentFrames take() { return std::exchange(sender.sent, {}); }
  std::vector<Frame> frames() {
    std::vector<Frame> all;
    for (const auto& one : take()) all.push_back(std::get<1>(one));
    return all;
  }
  // By SDO; its answer is taken away.
  void write(uint16_t index, uint8_t sub, uint32_t value, unsigned bytes) {
    give({0x605, 8, sdo::initiate(static_cast<uint8_t>(0x23 | (4 - bytes) << 2), {index, sub}, value)});
    run(2 * kMillisecond);
    ASSERT_FALSE(sender.sent.empty());
    EXPECT_EQ(std::get<1>(sender.sent.back()), (Frame{0x585, 8, sdo::initiate(0x60, {index, sub})}));
    sender.sent.pop_back();
  }
  Frame ask_life() { return {0x705, 1, {}, false, true}; }

  EventQueue queue;
  NodeSender sender{queue};
  OrderedUnit unit;
  canopen::Node node{{queue, 1, sender, 10}, 5, mdxb(), {}, unit, unit, this};
  std::vector<IgnoredMessage> ignored;
};

// NMT, SYNC, its SDO and guarding, its first PDO each way; others as soon as it has them.
TEST(CanopenNodeDesk, ListensToWhatItMayBeSent) {
  NodeDesk desk;
  EXPECT_EQ(desk.sender.listened, (std::set<uint32_t>{0x000, 0x080, 0x185, 0x205, 0x605, 0x705}));
  desk.sender.listened.clear();
  desk.write(0x1401, 2, 255, 1);
  desk.write(0x1601, 1, 0x2000'0110, 4);
  desk.write(0x1601, 0, 1, 1);
  desk.write(0x1401, 1, 0x310, 4);
  desk.write(0x1A03, 1, 0x2001'0110, 4);
  desk.write(0x1A03, 0, 1, 1);
  desk.write(0x1803, 1, 0x491, 4);
  desk.write(0x1005, 0, 0x81, 4);
  desk.write(0x1016, 1, 0x0007'0064, 4);
  EXPECT_EQ(desk.sender.listened,
            (std::set<uint32_t>{0x000, 0x080, 0x081, 0x185, 0x205, 0x310, 0x491, 0x605, 0x705, 0x707}));
}

TEST(CanopenNodeDesk, WhichFramesAreItsOwn) {
  NodeDesk desk;
  desk.write(0x1016, 1, 0x0007'0064, 4);
  for (uint32_t id = 0; id < 0x800; ++id) {
    const bool mine = id == 0 || id == 0x080 || id == 0x205 || id == 0x605 || id == 0x707;
    EXPECT_EQ(desk.give({id, 8, {0x40, 0, 0x10}}), mine) << id;
    EXPECT_EQ(desk.give({id, 1, {}, false, true}), id == 0x705 || id == 0x185) << id;
    EXPECT_FALSE(desk.give({id, 8, {}, true, false})) << id;
    EXPECT_FALSE(desk.give({id, 8, {}, true, true})) << id;
  }
}

// Input data are sampled before what was received acts, and the unit hears of the SYNC behind both.
TEST(CanopenNodeDesk, OrderOfASync) {
  NodeDesk desk;
  desk.to(NmtCommand::Start);
  EXPECT_EQ(desk.unit.take(), Calls{"state 5"});
  desk.give({0x205, 6, {9, 0, 1, 0, 2, 0}});
  EXPECT_TRUE(desk.unit.take().empty());
  desk.give({0x080, 0});
  EXPECT_EQ(desk.unit.take(), (Calls{"input", "output 9 7", "sync"}));
  desk.to(NmtCommand::Start);  // it is operational already
  EXPECT_TRUE(desk.unit.take().empty());
  // What was received before another state does not act after it.
  desk.give({0x205, 6, {9, 0, 1, 0, 2, 0}});
  desk.to(NmtCommand::EnterPreOperational);
  desk.to(NmtCommand::Start);
  desk.give({0x080, 0});
  EXPECT_EQ(desk.unit.take(), (Calls{"state 127", "state 5", "input", "sync"}));
}

// Every transmit PDO has a tag of its own behind that of the node, so that only its latest frame waits.
TEST(CanopenNodeDesk, TagsOfPdosAndOfTheRest) {
  NodeDesk desk;
  for (uint16_t n = 0; n < 4; ++n) {
    const auto pdo = static_cast<uint16_t>(0x1800 + n);
    desk.write(pdo, 1, 0x8000'0185U + 0x100U * n, 4);
    desk.write(static_cast<uint16_t>(pdo + 0x200), 0, 0, 1);
    desk.write(static_cast<uint16_t>(pdo + 0x200), 1, 0x2001'0110, 4);
    desk.write(static_cast<uint16_t>(pdo + 0x200), 0, 1, 1);
    desk.write(pdo, 1, 0x185U + 0x100U * n, 4);
  }
  desk.to(NmtCommand::Start);
  desk.give({0x605, 8, {0x40, 0x00, 0x10}});
  desk.give(desk.ask_life());
  desk.run(2 * kMillisecond);
  desk.give({0x080, 0});
  desk.unit.word = 3;
  desk.give({0x080, 0});
  std::vector<std::pair<uint32_t, uint64_t>> tags;
  for (const auto& [time, frame, tag] : desk.take()) tags.emplace_back(frame.id, tag);
  EXPECT_EQ(tags, (std::vector<std::pair<uint32_t, uint64_t>>{
                      {0x705, 10}, {0x585, 10}, {0x185, 11}, {0x285, 12}, {0x385, 13}, {0x485, 14}}));
}

TEST(CanopenNodeDesk, AnSdoAnswerIsDueAfterItsDelay) {
  NodeDesk desk;
  desk.run(kMillisecond);
  desk.give({0x605, 8, {0x40, 0x00, 0x10}});
  desk.run(kSecond);
  EXPECT_EQ(desk.take(), (SentFrames{{3 * kMillisecond, Frame{0x585, 8, {0x43, 0x00, 0x10}}, 10}}));
  // Stopped meanwhile it does not answer, and has forgotten the transfer.
  desk.give({0x605, 8, {0x40, 0x08, 0x10}});
  desk.to(NmtCommand::Stop);
  desk.run(5 * kSecond);
  EXPECT_TRUE(desk.take().empty());
  desk.to(NmtCommand::EnterPreOperational);
  desk.give({0x605, 8, {0x60}});
  desk.run(5 * kSecond);
  EXPECT_EQ(desk.frames(), (std::vector<Frame>{{0x585, 8, {0x80, 0, 0, 0, 0x01, 0x00, 0x04, 0x05}}}));
}

TEST(CanopenNodeDesk, ATransferIsGivenUpASecondAfterItsLastRequest) {
  NodeDesk desk;
  desk.give({0x605, 8, {0x40, 0x08, 0x10}});
  desk.run(900 * kMillisecond);
  desk.give({0x605, 8, {0x60}});
  desk.run(999 * kMillisecond);
  EXPECT_EQ(desk.take().size(), 2U);
  desk.run(kMillisecond);
  EXPECT_EQ(desk.take(),
            (SentFrames{{1900 * kMillisecond, Frame{0x585, 8, {0x80, 0x08, 0x10, 0, 0, 0, 4, 5}}, 10}}));
  desk.run(5 * kSecond);
  EXPECT_TRUE(desk.take().empty());
  // One that has ended, has been refused, or was aborted by its client is not given up.
  for (const auto& last :
       {SdoBytes{0x07, 1, 2, 3, 4}, SdoBytes{0x17, 1, 2, 3, 4}, SdoBytes{0x80, 0x7E, 0x20}}) {
    desk.give({0x605, 8, {0x21, 0x7E, 0x20, 0x00, 4}});
    desk.run(10 * kMillisecond);
    desk.give({0x605, 8, last});
    desk.run(10 * kMillisecond);
    desk.take();
    desk.run(5 * kSecond);
    EXPECT_TRUE(desk.take().empty());
  }
  // Nor is one after a reset.
  desk.give({0x605, 8, {0x40, 0x08, 0x10}});
  desk.to(NmtCommand::ResetCommunication);
  desk.run(5 * kSecond);
  EXPECT_EQ(desk.frames(), (std::vector<Frame>{{0x705, 1, {0}}}));
}

TEST(CanopenNodeDesk, OutputsBySdoReachTheUnitOneByOne) {
  NodeDesk desk;
  desk.to(NmtCommand::Start);
  desk.unit.take();
  desk.write(0x2000, 1, 0x1234, 2);
  desk.write(0x2000, 10, 0x1234, 2);
  EXPECT_EQ(desk.unit.take(), (Calls{"output 4660 1", "output 0 512"}));
}

// A change of the settings of one PDO concerns that one alone.
TEST(CanopenNodeDesk, SettingsOfEachPdoTakeEffect) {
  for (uint16_t n = 0; n < 4; ++n) {
    NodeDesk desk;
    for (const uint16_t first : {uint16_t{0x1400}, uint16_t{0x1800}}) {
      const auto pdo = static_cast<uint16_t>(first + n);
      const auto map = static_cast<uint16_t>(pdo + 0x200);
      const uint32_t id = 0x5A0U + (first == 0x1800 ? 0x10U : 0U) - 0x100U;
      desk.write(pdo, 1, 0x8000'0000U | id, 4);
      desk.write(pdo, 2, 255, 1);
      desk.write(map, 0, 0, 1);
      desk.write(map, 1, first == 0x1400 ? 0x2000'0110 : 0x2001'0110, 4);
      desk.write(map, 0, 1, 1);
      desk.write(pdo, 1, id, 4);
    }
    desk.take();
    desk.unit.word = 0x0102;
    desk.to(NmtCommand::Start);
    EXPECT_EQ(desk.frames(), (std::vector<Frame>{{0x4B0, 2, {2, 1}}})) << n;
    desk.unit.take();
    EXPECT_TRUE(desk.give({0x4A0, 2, {3, 0}}));
    EXPECT_EQ(desk.unit.take(), Calls{"output 3 1"}) << n;
    // Its event timer, while it runs.
    desk.write(static_cast<uint16_t>(0x1800 + n), 5, 40, 2);
    desk.run(38 * kMillisecond - 1);
    EXPECT_TRUE(desk.take().empty());
    desk.run(1);
    EXPECT_EQ(desk.take().size(), 1U) << "40 ms after the write, 2 ms before its answer";
    desk.run(40 * kMillisecond);
    EXPECT_EQ(desk.take().size(), 1U);
    desk.write(static_cast<uint16_t>(0x1800 + n), 5, 0, 2);
    desk.run(kSecond);
    EXPECT_TRUE(desk.take().empty());
    EXPECT_EQ(desk.node.dictionary().value(0x2000, 1), 3U);
  }
}

TEST(CanopenNodeDesk, RemoteFramesByTypeAndState) {
  NodeDesk desk;
  const Frame asked{0x185, 6, {}, false, true};
  EXPECT_TRUE(desk.give(asked));
  EXPECT_EQ(desk.ignored, std::vector{IgnoredMessage::WrongState});
  desk.write(0x1800, 2, 252, 1);
  desk.to(NmtCommand::Start);
  desk.unit.word = 1;
  desk.give(asked);  // without a SYNC yet: what it is now
  desk.give({0x080, 0});
  desk.unit.word = 2;
  desk.give(asked);
  EXPECT_EQ(desk.frames().back(), (Frame{0x185, 6, {1}}));
  desk.write(0x1800, 2, 254, 1);
  desk.unit.word = 3;
  desk.give(asked);
  EXPECT_EQ(desk.frames().back(), (Frame{0x185, 6, {3}}));
  desk.write(0x1800, 2, 0, 1);
  desk.give(asked);
  EXPECT_TRUE(desk.take().empty()) << "it has its SYNC";
}

// --- guarding and heartbeat

TEST(CanopenErrorControl, ToggleAndBootUp) {
  NodeDesk desk;
  for (const uint8_t answer : {uint8_t{0x7F}, uint8_t{0xFF}, uint8_t{0x7F}, uint8_t{0xFF}, uint8_t{0x7F}}) {
    desk.give(desk.ask_life());
    EXPECT_EQ(desk.frames(), (std::vector<Frame>{{0x705, 1, {answer}}}));
  }
  desk.to(NmtCommand::ResetCommunication);
  desk.give(desk.ask_life());
  EXPECT_EQ(desk.frames(), (std::vector<Frame>{{0x705, 1, {0x00}}, {0x705, 1, {0x7F}}}));
}

TEST(CanopenErrorControl, GuardingThatIsMissedAndSwitchedOff) {
  NodeDesk desk;
  desk.write(0x100C, 0, 20, 2);
  desk.write(0x100D, 0, 2, 1);
  desk.queue.run_until(100 * kMillisecond);
  desk.give(desk.ask_life());
  desk.queue.run_until(140 * kMillisecond - 1);
  EXPECT_TRUE(desk.unit.take().empty());
  desk.write(0x100D, 0, 2, 1);  // the same setting changes nothing
  EXPECT_EQ(desk.unit.take(), Calls{"lost 140"});
  desk.write(0x100D, 0, 3, 1);
  EXPECT_TRUE(desk.unit.take().empty()) << "another time brings nobody back";
  desk.queue.run_until(200 * kMillisecond);
  desk.write(0x100D, 0, 0, 1);
  EXPECT_EQ(desk.unit.take(), Calls{"back 200"});
  // Another life time counts from the next request on.
  desk.write(0x100D, 0, 2, 1);
  desk.give(desk.ask_life());
  desk.write(0x100D, 0, 1, 1);
  desk.run(kSecond);
  EXPECT_TRUE(desk.unit.take().empty());
  // A reset ends it, too.
  desk.give(desk.ask_life());
  desk.run(20 * kMillisecond);
  EXPECT_EQ(desk.unit.take().size(), 1U);
  desk.take();
  desk.to(NmtCommand::ResetCommunication);
  EXPECT_EQ(desk.unit.take().front().substr(0, 4), "back");
}

TEST(CanopenErrorControl, HeartbeatBeginsAtOnce) {
  NodeDesk desk;
  desk.write(0x100C, 0, 20, 2);
  desk.queue.run_until(10 * kMillisecond);
  desk.give({0x605, 8, {0x2B, 0x17, 0x10, 0x00, 30}});
  EXPECT_EQ(desk.frames(), (std::vector<Frame>{{0x705, 1, {0x7F}}}));
  EXPECT_TRUE(desk.give(desk.ask_life()));
  EXPECT_EQ(desk.ignored, std::vector{IgnoredMessage::NotGuarded});
  desk.run(20 * kMillisecond);
  desk.take();
  desk.give({0x605, 8, {0x2B, 0x17, 0x10, 0x00, 30}});  // as it is: goes on
  desk.queue.run_until(40 * kMillisecond - 1);
  EXPECT_EQ(desk.frames(), (std::vector<Frame>{{0x585, 8, {0x60, 0x17, 0x10}}}));
  desk.queue.run_until(40 * kMillisecond);
  EXPECT_EQ(desk.frames(), (std::vector<Frame>{{0x705, 1, {0x7F}}}));
  desk.write(0x1017, 0, 0, 2);
  desk.run(kSecond);
  EXPECT_TRUE(desk.take().empty());
  desk.give(desk.ask_life());
  EXPECT_EQ(desk.frames(), (std::vector<Frame>{{0x705, 1, {0x7F}}}));
}

TEST(CanopenErrorControl, APartnerThatIsChangedOrMissed) {
  NodeDesk desk;
  desk.write(0x1016, 1, 0x0007'0032, 4);
  desk.queue.run_until(10 * kMillisecond);
  EXPECT_TRUE(desk.give({0x707, 1, {5}}));
  desk.queue.run_until(50 * kMillisecond);
  desk.give({0x605, 8, sdo::initiate(0x23, {0x1016, 1}, 0x0007'0032)});  // as it is
  desk.queue.run_until(60 * kMillisecond);
  EXPECT_EQ(desk.unit.take(), Calls{"lost 60"});
  desk.write(0x1016, 1, 0x0007'0064, 4);
  EXPECT_TRUE(desk.unit.take().empty()) << "it is still missed";
  desk.give({0x707, 1, {5}});
  EXPECT_EQ(desk.unit.take(), Calls{"back 62"});
  desk.write(0x1016, 1, 0x0008'0064, 4);  // another one: awaited from its first heartbeat on
  EXPECT_FALSE(desk.give({0x707, 1, {5}}));
  desk.run(kSecond);
  EXPECT_TRUE(desk.unit.take().empty());
  desk.give({0x708, 1, {5}});
  desk.run(kSecond);
  EXPECT_EQ(desk.unit.take().size(), 1U);
  // Node 0 is nobody, whatever the time.
  desk.write(0x1016, 1, 0x0000'0064, 4);
  EXPECT_EQ(desk.unit.take().size(), 1U);
  EXPECT_FALSE(desk.give({0x700, 1, {5}}));
}

TEST(CanopenErrorControl, TwoThatAreMissedAreOneLoss) {
  NodeDesk desk;
  desk.write(0x100C, 0, 20, 2);
  desk.write(0x100D, 0, 2, 1);
  desk.write(0x1016, 1, 0x0007'0032, 4);
  desk.queue.run_until(10 * kMillisecond);
  desk.give(desk.ask_life());
  desk.give({0x707, 1, {5}});
  desk.run(kSecond);
  EXPECT_EQ(desk.unit.take(), Calls{"lost 50"});
  desk.give({0x707, 1, {5}});
  EXPECT_TRUE(desk.unit.take().empty());
  desk.give(desk.ask_life());
  EXPECT_EQ(desk.unit.take(), Calls{"back 1010"});
}

// --- EMCY

Frame emcy(uint16_t code, uint8_t error_register, uint16_t status = 0) {
  return {0x085,
          8,
          {static_cast<uint8_t>(code), static_cast<uint8_t>(code >> 8), error_register, 0,
           static_cast<uint8_t>(status), static_cast<uint8_t>(status >> 8)}};
}

TEST(CanopenEmergency, TheNewestErrorStandsFirst) {
  NodeDesk desk;
  std::vector<uint32_t> expected;
  for (uint16_t n = 1; n <= 7; ++n) {
    desk.unit.state = {n, true, false};
    desk.node.unit_changed(desk.queue.now());
    desk.unit.state = {n, false, false};
    desk.node.unit_changed(desk.queue.now());
    expected.insert(expected.begin(), uint32_t{n} << 16 | 0xFF00);
    const size_t count = std::min<size_t>(n, 5);
    EXPECT_EQ(desk.node.dictionary().value(0x1003), count);
    for (uint8_t sub = 1; sub <= 5; ++sub)
      EXPECT_EQ(desk.node.dictionary().value(0x1003, sub), sub <= count ? expected[sub - 1U] : 0U) << n;
  }
  desk.write(0x1003, 0, 0, 1);
  for (uint8_t sub = 0; sub <= 5; ++sub) EXPECT_EQ(desk.node.dictionary().value(0x1003, sub), 0U);
}

// While it may not send, the sixteen newest messages wait (ours).
TEST(CanopenEmergency, SixteenWait) {
  NodeDesk desk;
  desk.to(NmtCommand::Stop);
  for (uint16_t n = 1; n <= 10; ++n)
    for (const bool fault : {true, false}) {
      desk.unit.state = {n, fault, false};
      desk.node.unit_changed(desk.queue.now());
    }
  desk.take();
  desk.to(NmtCommand::EnterPreOperational);
  const std::vector<Frame> told = desk.frames();
  ASSERT_EQ(told.size(), 16U);
  for (size_t n = 0; n < 16; ++n) {
    const auto status = static_cast<uint16_t>(n / 2 + 3);
    EXPECT_EQ(told[n], n % 2 == 0 ? emcy(0xFF00, 0x81, status) : emcy(0, 0, status));
  }
}

TEST(CanopenEmergency, AResetForgetsTheMessagesAndKeepsWhatIsWrong) {
  NodeDesk desk;
  desk.write(0x1015, 0, 100, 2);
  desk.unit.state = {1, true, false};
  desk.node.unit_changed(desk.queue.now());
  desk.unit.state = {1, true, true};
  desk.node.unit_changed(desk.queue.now());
  EXPECT_EQ(desk.frames(), std::vector{emcy(0xFF00, 0x81, 1)});
  desk.to(NmtCommand::ResetCommunication);
  EXPECT_EQ(desk.node.dictionary().value(0x1001), 0x85U);
  desk.run(kSecond);
  EXPECT_EQ(desk.frames(), (std::vector<Frame>{{0x705, 1, {0}}}));
  desk.unit.state = {1, false, true};
  desk.node.unit_changed(desk.queue.now());
  EXPECT_EQ(desk.frames(), std::vector{emcy(0, 0x05, 1)});
  EXPECT_EQ(desk.node.dictionary().value(0x1001), 0x05U);
}

TEST(CanopenEmergency, WhatIsSwitchedOffIsLost) {
  NodeDesk desk;
  desk.write(0x1015, 0, 100, 2);  // 10 ms
  const auto fault = [&](bool on) {
    desk.unit.state = {1, on, false};
    desk.node.unit_changed(desk.queue.now());
  };
  fault(true);
  fault(false);
  EXPECT_EQ(desk.frames(), std::vector{emcy(0xFF00, 0x81, 1)});
  desk.write(0x1014, 0, 0x8000'0085, 4);
  desk.run(kSecond);
  EXPECT_TRUE(desk.take().empty());
  desk.write(0x1014, 0, 0x0000'0095, 4);
  desk.run(kSecond);
  EXPECT_TRUE(desk.take().empty());
  fault(true);
  ASSERT_EQ(desk.sender.sent.size(), 1U);
  EXPECT_EQ(std::get<1>(desk.take()[0]).id, 0x095U);
  // A shorter inhibit time that is set meanwhile counts from the next message on.
  fault(false);
  const Time sent = desk.queue.now();
  desk.run(10 * kMillisecond - 1);
  EXPECT_TRUE(desk.take().empty());
  desk.run(1);
  ASSERT_EQ(desk.sender.sent.size(), 1U);
  EXPECT_EQ(std::get<0>(desk.take()[0]), sent + 10 * kMillisecond);
}

}  // namespace
}  // namespace ipos::tests
