// Faults of a CAN line that end by hand, which frames a planted fault strikes, the latest frame of a tag, error counters
// by themselves, and every event of a line in words.
#include <gtest/gtest.h>

#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/bus/can/line.hpp"
#include "runtime/bus/can/transfer.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

struct Ear final : CanNode {
  void on_frame(Time now, const Frame& frame) override { heard.emplace_back(now, frame.id); }
  void on_sent(Time now, const Frame& frame, uint64_t tag) override {
    sent.push_back(now);
    last = {frame.id, tag};
  }
  void on_not_sent(Time, const Frame& frame, uint64_t, NotSent reason) override {
    failed.emplace_back(frame.id, reason);
  }
  std::vector<uint32_t> ids() const {
    std::vector<uint32_t> all;
    for (const auto& [time, id] : heard) all.push_back(id);
    return all;
  }
  std::vector<std::pair<Time, uint32_t>> heard;
  std::vector<Time> sent;
  std::pair<uint32_t, uint64_t> last;
  std::vector<std::pair<uint32_t, NotSent>> failed;
};

struct Told final : CanObserver {
  void on_frame(const CanLine&, const FrameRecord& record) override { frames.push_back(record); }
  void on_line_event(const CanLine& line, const LineEvent& event) override {
    texts.push_back(describe(line, event));
    times.push_back(event.time);
  }
  std::vector<std::string> take() { return std::exchange(texts, {}); }
  std::vector<FrameRecord> frames;
  std::vector<std::string> texts;
  std::vector<Time> times;
};

struct FaultBench {
  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  Told told;
  Ear ears[4];
  FaultBench() {
    line.add_observer(told);
    for (int n = 0; n < 4; ++n) line.attach("unit" + std::to_string(n + 1), 500'000, ears[n]);
  }
  void send(NodeId node, uint32_t id, uint64_t tag = 1) { line.send(node, {id, 2, {1, 2}}, tag); }
  void run(Time span) { queue.run_until(queue.now() + span); }
};
using Ids = std::vector<uint32_t>;
using Words = std::vector<std::string>;

LineFault planted(FaultKind kind, NodeId node = kNoNode) {
  LineFault fault;
  fault.kind = kind;
  fault.node = node;
  return fault;
}

// Of two alike both end; another kind, station, side or identifier, one that has not begun, and one with an end of its
// own stay.
TEST(LineRepair, EndsWhatIsMeant) {
  FaultBench t;
  LineFault of_all = planted(FaultKind::Drop), of_one = planted(FaultKind::Drop, 2),
            of_id = planted(FaultKind::Drop), later = planted(FaultKind::Drop),
            timed = planted(FaultKind::Drop);
  of_id.id = 100;
  later.from = kSecond;
  timed.until = 10 * kMillisecond;
  for (const LineFault& fault : {of_id, later}) t.line.plant(fault);
  t.run(kMillisecond);
  EXPECT_FALSE(t.line.repair(of_all));
  EXPECT_FALSE(t.line.repair(planted(FaultKind::Corrupt)));
  EXPECT_FALSE(t.line.repair(planted(FaultKind::Drop, 1)));
  EXPECT_FALSE(t.line.repair(later)) << "it has not begun, and without an identifier there is no other";
  t.line.plant(timed);
  EXPECT_FALSE(t.line.repair(timed)) << "it ends by itself";
  t.line.plant(of_all);
  t.line.plant(of_all);
  t.line.plant(of_one);
  t.send(0, 100);
  t.run(kMillisecond);
  EXPECT_TRUE(t.ears[1].heard.empty());
  EXPECT_TRUE(t.line.repair(of_all));
  EXPECT_FALSE(t.line.repair(of_all));
  EXPECT_TRUE(t.line.repair(of_id));
  t.run(10 * kMillisecond);  // timed has ended
  t.send(0, 100);
  t.run(kMillisecond);
  EXPECT_EQ(t.ears[1].ids(), Ids{100});
  EXPECT_TRUE(t.ears[2].heard.empty()) << "its own is still there";
  EXPECT_TRUE(t.line.repair(of_one));
  t.send(0, 100);
  t.run(kMillisecond);
  EXPECT_EQ(t.ears[2].ids(), Ids{100});
}

TEST(LineRepair, WiringIsSwitchedBack) {
  FaultBench t;
  LineFault behind = planted(FaultKind::Cut, 1);
  behind.behind = true;
  const LineFault own = planted(FaultKind::Cut, 1), swap = planted(FaultKind::Swap, 2);
  for (const LineFault& fault : {behind, own, swap}) t.line.plant(fault);
  t.run(kMillisecond);
  EXPECT_FALSE(t.line.is_active(1));
  EXPECT_FALSE(t.line.is_active(2));
  EXPECT_FALSE(t.line.is_reachable(0, 3));
  t.told.take();
  EXPECT_TRUE(t.line.repair(own));
  t.run(0);
  EXPECT_TRUE(t.line.is_active(1));
  EXPECT_TRUE(t.line.is_reachable(0, 1));
  EXPECT_FALSE(t.line.is_reachable(1, 3)) << "the line is still cut behind it";
  EXPECT_TRUE(t.line.repair(behind));
  t.run(0);
  EXPECT_TRUE(t.line.is_reachable(1, 3));
  EXPECT_TRUE(t.line.repair(swap));
  t.run(0);
  EXPECT_TRUE(t.line.is_active(2));
  EXPECT_EQ(t.told.take(),
            (Words{"sbus: planted fault 'cut' is over: unit2 is cut",
                   "sbus: planted fault 'cut' is over: the line is cut behind unit2",
                   "sbus: planted fault 'swap' is over: unit3 has high and low interchanged"}));
  t.send(0, 100);
  t.run(kMillisecond);
  for (int n = 1; n < 4; ++n) EXPECT_EQ(t.ears[n].ids(), Ids{100});
  // Two at a time: the line is sound again only without both.
  for (const FaultKind kind : {FaultKind::Short, FaultKind::Stuck}) {
    FaultBench two;
    LineFault first = planted(kind), second = planted(kind);
    first.until = 2 * kMillisecond;
    second.until = 4 * kMillisecond;
    two.line.plant(first);
    two.line.plant(second);
    two.run(kMicrosecond);
    two.send(0, 100);
    two.run(3 * kMillisecond);
    EXPECT_TRUE(two.ears[1].heard.empty());
    two.run(20 * kMillisecond);
    two.send(3, 101);
    two.run(kMillisecond);
    EXPECT_FALSE(two.ears[1].heard.empty());
  }
}

// The n-th frame with its identifier, from its time on and up to the other one, is struck.
TEST(LineFault, StrikesByNumberIdentifierAndTime) {
  const auto arrived = [](const LineFault& fault) {
    FaultBench t;
    t.line.plant(fault);
    for (uint32_t n = 0; n < 6; ++n) {
      t.queue.run_until(n * kMillisecond);
      t.send(0, n % 2 == 0 ? 100 : 200);
    }
    t.run(10 * kMillisecond);
    std::string text;
    for (size_t n = 0; n < 6; ++n) {
      bool heard = false;
      for (const auto& [time, id] : t.ears[1].heard) heard |= time / kMillisecond == static_cast<Time>(n);
      text += heard ? '-' : 'x';
    }
    return text;
  };
  LineFault fault = planted(FaultKind::Drop);
  EXPECT_EQ(arrived(fault), "xxxxxx");
  fault.per_mille = 0;
  EXPECT_EQ(arrived(fault), "------");
  fault.frame = 3;
  EXPECT_EQ(arrived(fault), "--x---") << "a number needs no chance";
  fault.id = 200;
  EXPECT_EQ(arrived(fault), "-----x");
  fault.frame = 4;
  EXPECT_EQ(arrived(fault), "------");
  fault = planted(FaultKind::Drop);
  fault.from = 2 * kMillisecond + 2 * kMicrosecond;  // the frame begins at the next bit, of 2 us
  fault.until = 4 * kMillisecond + 2 * kMicrosecond;
  EXPECT_EQ(arrived(fault), "--xx--");
  ++fault.from;
  ++fault.until;
  EXPECT_EQ(arrived(fault), "---xx-");
}

TEST(LineFault, TheFirstOnePlantedStrikes) {
  FaultBench t;
  LineFault drop = planted(FaultKind::Drop), corrupt = planted(FaultKind::Corrupt);
  drop.frame = corrupt.frame = 1;
  t.line.plant(drop);
  t.line.plant(corrupt);
  t.send(0, 100);
  t.run(kMillisecond);
  EXPECT_TRUE(t.ears[0].failed.empty());
  EXPECT_TRUE(t.ears[1].heard.empty());
  EXPECT_EQ(t.told.take(), Words{"sbus: planted fault 'drop': the line loses a frame behind the acknowledge, "
                                 "identifier 064h (100)"});
}

// A frame that is late comes to all, or to one station, and not to its sender.
TEST(LineFault, LateFramesOfAllAndOfOne) {
  for (const NodeId only : {kNoNode, NodeId{2}}) {
    FaultBench t;
    LineFault delay = planted(FaultKind::Delay, only);
    delay.lag = 3 * kMillisecond;
    t.line.plant(delay);
    t.send(0, 100);
    t.run(kMillisecond);
    t.send(0, 101);
    t.run(kMillisecond);
    EXPECT_EQ(t.ears[1].ids(), only == kNoNode ? Ids{} : (Ids{100, 101}));
    EXPECT_TRUE(t.ears[2].heard.empty());
    t.run(10 * kMillisecond);
    for (const int n : {1, 2, 3}) EXPECT_EQ(t.ears[n].ids(), (Ids{100, 101})) << n;
    EXPECT_TRUE(t.ears[0].heard.empty());
    EXPECT_EQ(t.ears[2].heard[0].first, t.told.frames[0].end + 3 * kMillisecond);
    EXPECT_EQ(t.ears[2].heard[1].first, t.told.frames[1].end + 3 * kMillisecond);
    EXPECT_EQ(t.ears[0].sent.size(), 2U) << "its sender knows nothing";
  }
}

// Who is error-passive and alone in seeing a disturbed bit makes no flag and gives no acknowledge: without another
// listener the sender finds that out in the slot, nine bits before the end of its frame, and sends its flag of 6 bits.
TEST(LineFault, APassiveListenerAloneIsNoListener) {
  for (const uint8_t length : {uint8_t{0}, uint8_t{3}, uint8_t{8}}) {
    const Frame frame{100, length, {1, 2, 3, 4, 5, 6, 7, 8}};
    const uint32_t bits = frame_bits(frame) - 3;  // to the end of the end of frame
    for (const bool others : {false, true}) {
      KnownFrames known;
      Transfer transfer;
      transfer.senders = {{0, canonical(frame), 0, true, false}};
      transfer.fault.kind = FaultKind::Corrupt;
      transfer.fault.node = 1;
      resolve(transfer, {true, others, true, false, others}, known);
      EXPECT_EQ(transfer.outcome, others ? Transfer::Outcome::Delivered : Transfer::Outcome::NoAcknowledge);
      EXPECT_EQ(transfer.end, others ? bits : bits - 9 + 1 + 6 + 8);
      EXPECT_EQ(transfer.bits, transfer.end + 3);
    }
    KnownFrames known;
    Transfer alone;
    alone.senders = {{0, canonical(frame), 0, true, false}};
    resolve(alone, {}, known);
    EXPECT_EQ(alone.outcome, Transfer::Outcome::NoAcknowledge);
    EXPECT_EQ(alone.end, bits - 9 + 1 + 6 + 8);
    // Without any dominant level not even the start of frame is seen: its flag begins at once.
    resolve(alone, {true, true}, known, true);
    EXPECT_EQ(alone.outcome, Transfer::Outcome::NoLevel);
    EXPECT_EQ(alone.end, 1U + 6 + 8);
    EXPECT_EQ(alone.bits, 1U + 6 + 8 + 3);
    // The last bit disturbed at the sender: all have the frame, and an overload flag follows.
    Transfer twice;
    twice.senders = {{0, canonical(frame), 0, true, false}};
    twice.fault.kind = FaultKind::Duplicate;
    resolve(twice, {true, true}, known);
    EXPECT_EQ(twice.outcome, Transfer::Outcome::Repeated);
    EXPECT_EQ(twice.end, bits);
    EXPECT_EQ(twice.bits, bits + 1 + 6 + 8 + 3);
  }
}

TEST(LineFault, WordsOfFaults) {
  for (const FaultType& type : kFaultTypes) EXPECT_EQ(find_fault_type(type.word), &type);
  EXPECT_EQ(find_fault_type("nothing"), nullptr);
  EXPECT_EQ(find_fault_type(""), nullptr);
  FaultBench t;
  LineFault corrupt = planted(FaultKind::Corrupt, 1);
  corrupt.frame = 1;
  t.line.plant(corrupt);
  LineFault wire = planted(FaultKind::Short);
  wire.from = kMillisecond;
  t.line.plant(wire);
  t.send(0, 0x7FF);
  t.run(2 * kMillisecond);
  EXPECT_EQ(
      t.told.take(),
      (Words{"sbus: planted fault 'corrupt': unit2 has a disturbed bit, identifier 7FFh (2047)",
             "sbus: planted fault 'short': the line has high and low short-circuited: no dominant level"}));
}

// Back from bus-off after 128 runs of 11 recessive bits (ISO 11898-1). Behind a frame there are 11 up to the end of the
// intermission; with 10 bits of rest more it is still one run a frame, and the last one ends with the intermission.
TEST(LineRepair, RunsOfRecessiveBitsAreCountedToTheBit) {
  FaultBench t;
  LineFault wire = planted(FaultKind::Short);
  wire.until = 1500 * kMicrosecond;
  t.line.plant(wire);
  t.run(kMicrosecond);
  t.send(0, 100);
  t.run(10 * kMillisecond);
  ASSERT_FALSE(t.line.is_active(0));
  t.told.take();
  t.told.times.clear();
  const Time bit = t.line.bit_time();
  const Time period = static_cast<Time>(frame_bits({200, 2, {1, 2}}) + 10) * bit;
  const Time base = 20 * kMillisecond;
  t.queue.run_until(base);
  t.line.recover(0);
  for (int n = 0; n < 200 && t.told.texts.empty(); ++n) {
    t.queue.run_until(base + n * period);
    if (t.told.texts.empty()) t.send(1, 200);
  }
  EXPECT_EQ(t.told.frames.size(), 128U);
  EXPECT_EQ(t.told.texts, Words{"sbus: unit1 is back on the line after bus-off"});
  EXPECT_EQ(t.told.times.at(0), t.told.frames.back().end + 3 * bit);
  EXPECT_TRUE(t.line.is_active(0));
}

// --- frames of one tag

TEST(CanLine, OnlyTheLatestFrameOfATagWaits) {
  FaultBench t;
  LinePort port(t.line, 0);
  port.send_latest({300, 0}, 7);
  port.send_latest({301, 0}, 7);
  port.send_latest({302, 0}, 8);
  port.send({303, 0}, 7);
  port.send_latest({304, 0}, 7);
  t.run(5 * kMillisecond);
  EXPECT_EQ(t.ears[1].ids(), (Ids{302, 304}));
  EXPECT_EQ(t.ears[0].last, (std::pair<uint32_t, uint64_t>{304, 7}));
  // One on the wire goes on.
  port.send_latest({300, 0}, 7);
  t.run(50 * kMicrosecond);
  port.send_latest({299, 0}, 7);
  t.run(5 * kMillisecond);
  EXPECT_EQ(t.ears[1].ids(), (Ids{302, 304, 300, 299}));
  EXPECT_EQ(port.send({2048, 0}, 1), SendStatus::InvalidFrame);
  EXPECT_EQ(port.node(), 0U);
}

// What is withdrawn while it is on the wire is not sent again when it fails.
TEST(CanLine, AWithdrawnFrameIsNotRepeated) {
  for (const bool withdrawn : {false, true}) {
    FaultBench t;
    LineFault corrupt = planted(FaultKind::Corrupt);
    corrupt.frame = 1;
    t.line.plant(corrupt);
    t.send(0, 100, 5);
    t.send(0, 200, 6);
    t.run(50 * kMicrosecond);
    if (withdrawn) t.line.withdraw(0, 5);
    t.line.withdraw(0, 99);
    t.run(5 * kMillisecond);
    EXPECT_EQ(t.ears[1].ids(), withdrawn ? Ids{200} : (Ids{100, 200}));
    ASSERT_EQ(t.ears[0].failed.size(), 1U);
    EXPECT_EQ(t.ears[0].failed[0], (std::pair{100U, NotSent::Corrupted}));
  }
}

// ISO 11898-1, fault confinement.
TEST(CanErrors, CountersAndStates) {
  ErrorCounters counters;
  EXPECT_TRUE(counters.untouched());
  counters.sent();
  counters.received();
  EXPECT_TRUE(counters.untouched()) << "not below 0";
  counters.send_failed();
  EXPECT_EQ(counters.transmit, 8U);
  EXPECT_FALSE(counters.untouched());
  counters.sent();
  EXPECT_EQ(counters.transmit, 7U);
  counters.receive_failed();
  EXPECT_EQ(counters.receive, 1U);
  counters.receive_failed(true);
  EXPECT_EQ(counters.receive, 10U);
  counters.received();
  EXPECT_EQ(counters.receive, 9U);
  const auto state = [](uint32_t transmit, uint32_t receive) {
    return ErrorCounters{transmit, receive}.state();
  };
  EXPECT_EQ(state(127, 127), ErrorState::Active);
  EXPECT_EQ(state(128, 0), ErrorState::Passive);
  EXPECT_EQ(state(0, 128), ErrorState::Passive);
  EXPECT_EQ(state(255, 255), ErrorState::Passive);
  EXPECT_EQ(state(256, 0), ErrorState::BusOff);
  counters = {0, 250};
  counters.receive_failed(true);
  EXPECT_EQ(counters.receive, 255U) << "it goes no higher";
  counters.received();
  EXPECT_EQ(counters.receive, 127U) << "back to error active at once";
  counters = {0, 128};
  counters.received();
  EXPECT_EQ(counters.receive, 127U);
  counters = {127, 0};
  counters.not_acknowledged();
  EXPECT_EQ(counters.transmit, 135U);
  counters.not_acknowledged();
  EXPECT_EQ(counters.transmit, 135U) << "a passive one does not count a missing acknowledge";
}

TEST(CanLine, EventsInWords) {
  FaultBench t;
  t.line.set_baud(3, 125'000);
  t.line.set_connected(2, false);
  EXPECT_EQ(t.told.take(),
            (Words{"sbus: unit4 takes no part: its baud rate is not that of the line (125 kbaud, line "
                   "500 kbaud)",
                   "sbus: unit3 takes no part: it is not connected to the line"}));
  t.line.set_connected(3, false);  // it would destroy the frames
  t.told.take();
  t.line.send(0, {11, 1, {0}}, 1);
  t.line.send(1, {11, 1, {0}}, 1);
  t.run(kMillisecond);
  EXPECT_EQ(t.told.take(), (Words{"sbus: unit1 gets no acknowledge: all stations that could give it send the same frame at "
                                  "the same time, identifier 00Bh (11), 2 stations from unit1 to unit2"}));
}

TEST(CanLine, CollisionsInWords) {
  FaultBench t;
  t.line.send(0, {11, 1, {0}}, 1);
  t.line.send(1, {11, 1, {0}}, 1);
  t.run(kMillisecond);
  EXPECT_EQ(t.told.take(),
            Words{"sbus: unit1 sends the same frame at the same time as another station, identifier 00Bh "
                  "(11), other station unit2"});
  t.line.send(0, {11, 1, {0}}, 1);
  t.line.send(1, {11, 1, {1}}, 1);
  t.run(100 * kMicrosecond);
  Words collisions = t.told.take();
  collisions.resize(2);
  const std::string begin =
      " collides: another station sends other data on the same identifier, identifier 00Bh (11), ";
  EXPECT_EQ(collisions, (Words{"sbus: unit1" + begin + "other station unit2",
                               "sbus: unit2" + begin + "other station unit1"}));
}

}  // namespace
}  // namespace ipos::tests
