// A CAN line alone as a bus simulation of FMI-LS-BUS 1.0: bytes are those of the tables of its chapter "CAN, CAN FD, CAN XL", times
// those of ISO 11898-1, counted by hand: bits of a frame from its start to the end of its last field, the pause of 3 behind it.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/fmi/event_mode.hpp"
#include "tests/fmi/functions.hpp"

namespace ipos::tests {
namespace {

std::string with_id(int code, int length, int id) {
  return bytes({code, 0, 0, 0, length, 0, 0, 0, id & 0xFF, id >> 8, 0, 0});
}
std::string transmit(int id, std::initializer_list<int> data) {
  const int length = static_cast<int>(data.size());
  return with_id(0x10, 16 + length, id) + bytes({0, 0, length, 0}) + bytes(data);
}
std::string confirm(int id) { return with_id(0x20, 12, id); }
std::string arbitration_lost(int id) { return with_id(0x30, 12, id); }
std::string bus_error(int id, int code, int flag, int is_sender) { return with_id(0x31, 15, id) + bytes({code, flag, is_sender}); }
std::string rate(int baud) {
  return bytes({0x40, 0, 0, 0, 13, 0, 0, 0, 1, baud & 0xFF, baud >> 8 & 0xFF, baud >> 16 & 0xFF, 0});
}
std::string behavior(int kind) { return bytes({0x40, 0, 0, 0, 10, 0, 0, 0, 4, kind}); }
std::string status(int kind) { return bytes({0x41, 0, 0, 0, 9, 0, 0, 0, kind}); }
constexpr int kBuffer = 1, kDiscard2 = 2;
constexpr int kActive = 1, kPassive = 2, kBusOff = 3;
constexpr int kPrimary = 1, kSecondary = 2;
constexpr int kBitError = 1, kAckError = 5;

const std::string kLine = R"([[bus]]
name = "sbus"
kind = "can"
baud = 500000
[[station]]
name = "u"
unit = "md60a"
sbus = "sbus"
)";
constexpr int64_t kBit = 2'000;  // ns

// An importer with as many nodes as the line has terminals; time goes from one tick of the line to the next.
class Line {
 public:
  explicit Line(uint32_t nodes, const std::string& more = "")
      : nodes_(nodes), resources_(kLine + more, "", {{}, {}, fmi::LineChoice{"sbus", nodes}}) {
    first_ = static_cast<uint32_t>(resources_.variables().all.size() + 1);
    c_ = resources_.make3(told, true);
    EXPECT_EQ(fmi3EnterInitializationMode(c_, false, 0, 0, false, 0), kOk);
    EXPECT_EQ(fmi3ExitInitializationMode(c_), kOk);
  }
  ~Line() { fmi3FreeInstance(c_); }

  uint32_t reference(uint32_t node, uint32_t member) const { return first_ + (node - 1) * 5 + member; }
  // In event mode. Nodes count from 1, as in the names.
  void give(uint32_t node, const std::string& operations) {
    give_operations(c_, reference(node, 2), reference(node, 0), operations);
  }
  void update() { update_states(c_); }
  struct Known {
    int64_t ns;
    int known;  // 0 not yet, 1 unchanged, 2 changed
    bool operator==(const Known&) const = default;
  };
  Known interval(uint32_t node) {
    const uint32_t clock = reference(node, 3);
    double seconds = 0;
    int known = -1;
    EXPECT_EQ(fmi3GetIntervalDecimal(c_, &clock, 1, &seconds, &known), kOk);
    return {std::llround(seconds * 1e9), known};
  }
  // The clocks of all nodes tick, and what they bring is there, by node.
  std::vector<std::string> fetch() {
    std::vector<std::string> all;
    for (uint32_t node = 1; node <= nodes_; ++node) {
      const uint32_t clock = reference(node, 3), data = reference(node, 1);
      const bool active = true;
      size_t size = 0;
      const uint8_t* out = nullptr;
      EXPECT_EQ(fmi3SetClock(c_, &clock, 1, &active), kOk);
      EXPECT_EQ(fmi3GetBinary(c_, &data, 1, &size, &out, 1), kOk);
      all.emplace_back(reinterpret_cast<const char*>(out), size);
    }
    return all;
  }
  void step(int64_t ns) {
    EXPECT_EQ(fmi3EnterStepMode(c_), kOk);
    bool event = false, ends = false, early = false;
    double reached = 0;
    EXPECT_EQ(fmi3DoStep(c_, static_cast<double>(now) * 1e-9, static_cast<double>(ns) * 1e-9, true, &event, &ends, &early, &reached), kOk);
    now += ns;
    EXPECT_EQ(fmi3EnterEventMode(c_), kOk);
  }
  // Until the line has something, at most a second; what it brings.
  std::vector<std::string> next() {
    for (int n = 0; n < 20; ++n) {
      update();
      const Known due = interval(1);
      if (due.known == 0) break;
      if (due.ns > 0) step(due.ns);
      const auto all = fetch();
      for (const std::string& one : all)
        if (!one.empty()) return all;
    }
    return std::vector<std::string>(nodes_);
  }
  double load() {
    const uint32_t load = resources_.reference("sbus.load");
    double value = -1;
    EXPECT_EQ(fmi3GetFloat64(c_, &load, 1, &value, 1), kOk);
    return value;
  }
  void* instance() { return c_; }

  Told told;
  int64_t now = 0;  // ns

 private:
  uint32_t nodes_;
  Resources resources_;
  uint32_t first_ = 0;
  void* c_ = nullptr;
};

using All = std::vector<std::string>;

// A frame of 69 bits with the identifier 123h and three bytes: it begins at the first bit behind its request.
TEST(FmiLine, AFrameTakesItsTimeAndIsConfirmed) {
  Line line(3);
  EXPECT_EQ(line.interval(1), (Line::Known{0, 0})) << "nobody has sent";
  line.give(1, transmit(0x123, {0x11, 0x22, 0x33}));
  line.update();
  EXPECT_EQ(line.interval(2), (Line::Known{70 * kBit, 2}));
  EXPECT_EQ(line.interval(2), (Line::Known{70 * kBit, 1})) << "unchanged";
  EXPECT_EQ(line.next(), (All{confirm(0x123), transmit(0x123, {0x11, 0x22, 0x33}), transmit(0x123, {0x11, 0x22, 0x33})}));
  EXPECT_EQ(line.now, 70 * kBit);
  line.update();
  EXPECT_EQ(line.interval(1), (Line::Known{0, 0})) << "not yet known again";
  EXPECT_EQ(line.told.text, "");
}

// The lowest identifier wins. Node 2 wants to be buffered, which is the default, node 3 to be told.
TEST(FmiLine, WhoLosesTheArbitrationIsBufferedOrTold) {
  Line line(3);
  line.give(3, behavior(kDiscard2) + transmit(0x200, {2}));
  line.give(2, transmit(0x300, {3}));
  line.give(1, transmit(0x100, {1}));
  EXPECT_EQ(line.next(), (All{confirm(0x100), transmit(0x100, {1}), arbitration_lost(0x200) + transmit(0x100, {1})}));
  EXPECT_EQ(line.now, (1 + 55) * kBit);
  EXPECT_EQ(line.next(), (All{transmit(0x300, {3}), confirm(0x300), transmit(0x300, {3})})) << "200h is given up";
  EXPECT_EQ(line.now, (1 + 55 + 3 + 55) * kBit);
  // Who comes while another one is on the line has not lost.
  line.give(1, transmit(0x300, {3}));
  line.update();
  line.step(10 * kBit);
  line.give(3, transmit(0x200, {2}));
  EXPECT_EQ(line.next(), (All{confirm(0x300), transmit(0x300, {3}), transmit(0x300, {3})}));
  EXPECT_EQ(line.next(), (All{transmit(0x200, {2}), transmit(0x200, {2}), confirm(0x200)}));
  // Told otherwise it is buffered.
  line.give(3, behavior(kBuffer) + transmit(0x200, {2}));
  line.give(1, transmit(0x100, {1}));
  EXPECT_EQ(line.next(), (All{confirm(0x100), transmit(0x100, {1}), transmit(0x100, {1})}));
  EXPECT_EQ(line.next(), (All{transmit(0x200, {2}), transmit(0x200, {2}), confirm(0x200)}));
  EXPECT_EQ(line.told.text, "");
}

// The first frame is disturbed: everybody hears of it, once with its sender's mark and flag, and it is for the sender to repeat it.
TEST(FmiLine, ABusErrorIsToldToAll) {
  Line line(3, "[[fault]]\nbus = \"sbus\"\nkind = \"corrupt\"\nframe = 1\n");
  line.give(2, transmit(0x100, {1}));
  EXPECT_EQ(line.next(), (All{bus_error(0x100, kBitError, kSecondary, 0), bus_error(0x100, kBitError, kPrimary, 1),
                              bus_error(0x100, kBitError, kSecondary, 0)}));
  EXPECT_LT(line.now, 100 * kBit);
  EXPECT_EQ(line.next(), All(3)) << "nobody has repeated it";
  line.give(2, transmit(0x100, {1}));
  EXPECT_EQ(line.next(), (All{transmit(0x100, {1}), confirm(0x100), transmit(0x100, {1})}));
  EXPECT_EQ(line.told.text, "");
}

// The line does not count for a node: it is error active until it says something else, whatever has happened.
TEST(FmiLine, ErrorsDoNotTakeANodeOff) {
  Line line(2, "[[fault]]\nbus = \"sbus\"\nkind = \"corrupt\"\n");
  for (int n = 0; n < 100; ++n) {
    line.give(1, transmit(0x100, {1}));
    ASSERT_EQ(line.next(), (All{bus_error(0x100, kBitError, kPrimary, 1), bus_error(0x100, kBitError, kSecondary, 0)})) << n;
  }
  EXPECT_EQ(line.told.text, "");
}

TEST(FmiLine, ANodeThatIsOffDoesNotHear) {
  Line line(3);
  line.give(2, status(kBusOff));
  line.give(1, transmit(0x100, {1}));
  EXPECT_EQ(line.next(), (All{confirm(0x100), "", transmit(0x100, {1})}));
}

// Without anybody else there is no confirmation.
TEST(FmiLine, StatusIsWhatTheNodeTells) {
  Line line(3);
  line.give(2, status(kBusOff));
  line.give(3, status(kBusOff));
  line.update();
  line.give(1, transmit(0x100, {1}));
  EXPECT_EQ(line.next(), (All{bus_error(0x100, kAckError, kPrimary, 1), "", ""}));
  line.give(2, transmit(0x200, {2}));
  EXPECT_EQ(line.next(), All(3));
  EXPECT_TRUE(line.told.has("sbus.node2: 200h is not sent: it takes no part")) << line.told.text;
  line.give(2, status(kActive));
  line.update();
  line.give(1, transmit(0x100, {1}));
  EXPECT_EQ(line.next(), (All{confirm(0x100), transmit(0x100, {1}), ""}));
}

// An error-passive node pauses 8 bits behind its own frame: an error-active one with less urgent things comes first.
TEST(FmiLine, ErrorActiveNodesArePreferred) {
  for (const bool passive : {false, true}) {
    Line line(2);
    line.give(1, status(passive ? kPassive : kActive));
    line.update();
    line.give(1, transmit(0x10, {1}) + transmit(0x11, {1}));
    line.update();
    line.step(10 * kBit);
    line.give(2, transmit(0x700, {}));
    EXPECT_EQ(line.next(), (All{confirm(0x10), transmit(0x10, {1})}));
    const All urgent{confirm(0x11), transmit(0x11, {1})}, other{transmit(0x700, {}), confirm(0x700)};
    EXPECT_EQ(line.next(), passive ? other : urgent);
    EXPECT_EQ(line.next(), passive ? urgent : other);
    EXPECT_EQ(line.now, (1 + 56 + 3 + 55 + 3 + 47) * kBit) << "what comes first takes no longer";
  }
}

TEST(FmiLine, AWakeupGoesToTheOthersAtOnce) {
  Line line(3);
  const std::string wakeup = bytes({0x42, 0, 0, 0, 8, 0, 0, 0});
  line.give(2, wakeup);
  line.update();
  EXPECT_EQ(line.interval(1), (Line::Known{0, 2}));
  EXPECT_EQ(line.fetch(), (All{wakeup, "", wakeup}));
}

// Unknown codes, wrong lengths and values come back; what only a line tells, and answers, do nothing.
TEST(FmiLine, WhatCannotBeReadIsAnswered) {
  Line line(2);
  const std::string fd = with_id(0x11, 18, 0x100) + bytes({0, 0, 0, 1, 0, 5});
  const std::string eight_and_one = with_id(0x10, 25, 0x100) + bytes({0, 0, 9, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  for (const std::string& wrong : {bytes({0x99, 0, 0, 0, 8, 0, 0, 0}), fd, eight_and_one, behavior(3), status(4), status(0), rate(0),
                                   bytes({0x41, 0, 0, 0, 8, 0, 0, 0}), bytes({0x42, 0, 0, 0, 9, 0, 0, 0, 0})}) {
    line.give(1, wrong);
    line.update();
    const auto size = static_cast<int>(wrong.size());
    EXPECT_EQ(line.fetch(), (All{bytes({1, 0, 0, 0, 10 + size, 0, 0, 0, size, 0}) + wrong, ""})) << size;
    line.update();
  }
  EXPECT_TRUE(line.told.has("sbus.node1: an operation of 8 bytes cannot be read")) << line.told.text;
  line.told.text.clear();
  for (const std::string& idle : {confirm(1), arbitration_lost(1), bus_error(1, 1, 1, 1), bytes({1, 0, 0, 0, 10, 0, 0, 0, 0, 0})}) {
    line.give(1, idle);
    line.update();
    EXPECT_EQ(line.fetch(), All(2));
  }
  EXPECT_EQ(line.told.text, "");
}

// All nodes tell the rate; the plant's is for who tells none. 100 kbit/s is a bit of 10 us.
TEST(FmiLine, TheRateIsThatOfTheNodes) {
  Line line(3);
  line.give(1, rate(100'000));
  line.give(2, rate(100'000));
  line.update();
  line.give(1, transmit(0x100, {1}));
  EXPECT_EQ(line.next(), (All{confirm(0x100), transmit(0x100, {1}), transmit(0x100, {1})}));
  EXPECT_EQ(line.now, (1 + 55) * 10'000);
  line.give(2, rate(250'000));
  line.update();
  line.give(1, transmit(0x100, {1}));
  EXPECT_EQ(line.next(), (All{confirm(0x100), "", transmit(0x100, {1})})) << "another rate takes no part";
  line.give(2, rate(100'000));
  line.update();
  line.give(2, transmit(0x200, {2}));
  EXPECT_EQ(line.next(), (All{transmit(0x200, {2}), confirm(0x200), transmit(0x200, {2})}));
}

// 20 frames of 55 bits with their pauses in a second at 500 kbit/s; the line counts whole percent.
TEST(FmiLine, TheLoadIsThatOfTheBits) {
  Line line(2);
  for (int n = 0; n < 1'000; ++n) {
    line.give(1, transmit(0x100, {1}));
    line.update();
    line.step(1'000'000);
    line.fetch();
  }
  EXPECT_EQ(line.load(), 1'000 * 58 * 100 / 500'000);
}

TEST(FmiLine, AStateGoesOnInTheMiddleOfAFrame) {
  Line line(2);
  line.give(1, status(kPassive) + transmit(0x10, {1}) + transmit(0x11, {1}));
  line.give(2, behavior(kDiscard2));
  line.update();
  line.step(10 * kBit);
  line.give(2, transmit(0x700, {}) + transmit(0x701, {}));
  line.update();
  void* state = nullptr;
  ASSERT_EQ(fmi3GetFMUState(line.instance(), &state), kOk);
  const int64_t then = line.now;
  std::vector<All> first, again;
  for (int n = 0; n < 4; ++n) first.push_back(line.next());
  ASSERT_EQ(fmi3SetFMUState(line.instance(), state), kOk) << line.told.text;
  line.now = then;
  for (int n = 0; n < 4; ++n) again.push_back(line.next());
  EXPECT_EQ(first, again);
  // The passive node pauses, so 700h comes before 11h, to which 701h loses.
  EXPECT_EQ(first[1], (All{transmit(0x700, {}), confirm(0x700)}));
  EXPECT_EQ(first[2], (All{confirm(0x11), arbitration_lost(0x701) + transmit(0x11, {1})}));
  EXPECT_EQ(first[3], All(2));
  EXPECT_EQ(fmi3FreeFMUState(line.instance(), &state), kOk);
}

// Importers set their inputs in each turn of an event, and a clock that was active is not in the next one.
TEST(FmiLine, AClockIsActiveUntilTheEndOfTheEvent) {
  Line line(2);
  line.give(1, transmit(0x100, {1}));
  const uint32_t clock = line.reference(1, 2);
  const bool inactive = false;
  EXPECT_EQ(fmi3SetClock(line.instance(), &clock, 1, &inactive), kOk);
  EXPECT_EQ(line.next(), (All{confirm(0x100), transmit(0x100, {1})}));
}

TEST(FmiLine, MembersAreThoseOfABusSimulation) {
  Line line(2);
  for (uint32_t member = 0; member < 5; ++member) {
    const uint32_t reference = line.reference(2, member);
    bool value = false;
    double seconds = 0;
    uint64_t counter = 0, resolution = 0;
    int known = 0;
    EXPECT_EQ(fmi3GetClock(line.instance(), &reference, 1, &value), kError) << "countdowns are set";
    EXPECT_EQ(fmi3SetClock(line.instance(), &reference, 1, &value), member == 2 || member == 3 ? kOk : kError) << member;
    EXPECT_EQ(fmi3GetIntervalDecimal(line.instance(), &reference, 1, &seconds, &known), member == 3 ? kOk : kError) << member;
    EXPECT_EQ(fmi3GetIntervalFraction(line.instance(), &reference, 1, &counter, &resolution, &known), member == 3 ? kOk : kError);
    EXPECT_EQ(fmi3GetBoolean(line.instance(), &reference, 1, &value, 1), member == 4 ? kOk : kError) << member;
    EXPECT_EQ(value, member == 4) << "it notifies";
    EXPECT_EQ(fmi3SetBoolean(line.instance(), &reference, 1, &value, 1), kError);
  }
}

}  // namespace
}  // namespace ipos::tests
