// The simulated line: character times, rates, collisions, echo, cuts, faults and load. Expected times are
// bits divided by the rate.
#include "runtime/bus/rs485/line.hpp"

#include <functional>

#include "runtime/bus/log/serial_log.hpp"
#include "runtime/bus/movilink/line_check.hpp"
#include "tests/runtime/bus/rs485/serial_rig.hpp"

#include <sstream>

namespace ipos::tests {
namespace {

const Bytes kExample = hex("02 01 05 00 06 3A 98 01 F4 57");

struct Pair {
  explicit Pair(uint32_t baud = 9600) : line(queue, 7, "line1", baud) { line.add_observer(recorder); }
  EventQueue queue;
  Rs485Line line;
  Recorder recorder;
  HandNode a{line, "a"};
  HandNode b{line, "b"};
};

Bytes data_of(const std::vector<Character>& characters) {
  Bytes bytes;
  for (const Character& c : characters) bytes.push_back(c.data);
  return bytes;
}

TEST(SerialLine, CharacterTimes) {
  PROVES("RS485-19", "MDB-RS485-34");
  struct Row {
    int baud;
    int characters;
    Time microseconds;  // as printed, rounded to 10 us
  };
  for (const Row& row : {Row{9600, 10, 11'460},
                         {9600, 12, 13'750},
                         {9600, 18, 20'630},
                         {57600, 10, 1'910},
                         {57600, 12, 2'290},
                         {57600, 18, 3'440}}) {
    Pair pair(static_cast<uint32_t>(row.baud));
    pair.a.send(Bytes(static_cast<size_t>(row.characters), 0x55));
    pair.queue.run_until(kSecond);
    ASSERT_EQ(pair.b.characters.size(), static_cast<size_t>(row.characters));
    EXPECT_EQ(pair.b.characters.front().start, 0);
    EXPECT_NEAR(static_cast<double>(pair.b.characters.back().end) / 1000,
                static_cast<double>(row.microseconds), 5);
    EXPECT_EQ(pair.b.characters.back().end, wire_time(row.characters, row.baud));
    EXPECT_EQ(pair.a.sent, std::vector<Time>{wire_time(row.characters, row.baud)});
  }
  // A character that begins in the middle of a tick waits for the next one: at most 17.4 us.
  for (int n = 0; n < 100; ++n) {
    Pair pair;
    const Time when = 123'457 * n;
    pair.queue.run_until(when);
    pair.a.send({0x02});
    pair.queue.run_until(when + kSecond);
    EXPECT_GE(pair.b.characters[0].start, when);
    EXPECT_LT(pair.b.characters[0].start - when, 17'362);
  }
}

TEST(SerialLine, AFramingErrorVoidsATelegram) {
  PROVES("RS485-19");
  struct Flip final : SerialFaults {
    size_t bit;
    explicit Flip(size_t n) : bit(n) {}
    void disturb(NodeId, std::vector<bool>& bits) override { bits[bit] = !bits[bit]; }
  };
  for (size_t character = 0; character < 10; ++character) {
    Pair pair;
    SlaveNode slave(pair.queue, 1, pair.line, "slave", {1});
    Flip flip(11 * character + 10);
    pair.line.set_faults(&flip);
    pair.a.send(kExample);
    pair.queue.run_until(kSecond);
    EXPECT_TRUE(slave.unit.untouched()) << character;
    ASSERT_FALSE(slave.unit.rejected.empty());
    EXPECT_EQ(slave.unit.rejected.front(), SerialError::Frame) << character;
  }
}

TEST(SerialLine, HalfDuplexAndEcho) {
  Pair pair;
  pair.a.send(kExample);
  EXPECT_FALSE(pair.a.port.send(kExample)) << "still sending";
  EXPECT_FALSE(pair.b.port.send({})) << "nothing";
  pair.queue.run_until(kSecond);
  EXPECT_TRUE(pair.a.characters.empty());
  EXPECT_EQ(data_of(pair.b.characters), kExample);
  EXPECT_EQ(pair.recorder.heard.at(0).sender, pair.a.port.node());
  pair.line.set_echo(pair.a.port.node(), true);
  pair.a.send(kExample);
  pair.queue.run_until(2 * kSecond);
  EXPECT_EQ(data_of(pair.a.characters), kExample);
  // An echo makes no difference to master and slave.
  EventQueue queue;
  Rs485Line line(queue, 1, "echo", 9600);
  RequestNode master(queue, 2, line, "master");
  SlaveNode slave(queue, 3, line, "slave", {1});
  line.set_echo(master.port.node(), true);
  line.set_echo(slave.port.node(), true);
  for (int n = 0; n < 5; ++n) {
    master.requester.start(queue.now(), {false, 1, kSetpointFormat, {}, {6, 1, 2}}, master);
    queue.run_until(queue.now() + 100 * kMillisecond);
  }
  EXPECT_EQ(master.ends, std::vector<RequestEnd>(5, RequestEnd::Answered));
  EXPECT_EQ(slave.unit.channels.size(), 5U);
  EXPECT_TRUE(slave.unit.rejected.empty());
}

// Bit by bit: what two overlapping characters become, computed with its own small receiver.
TEST(SerialLine, CollisionIsTheAndOfTheBits) {
  for (int first = 0; first < 256; first += 7)
    for (int second = 0; second < 256; second += 5) {
      Pair pair;
      HandNode c(pair.line, "c");
      pair.a.send({static_cast<uint8_t>(first)});
      pair.b.send({static_cast<uint8_t>(second)});
      pair.queue.run_until(kSecond);
      const auto even = [](int v) { return __builtin_popcount(static_cast<unsigned>(v)) % 2; };
      ASSERT_EQ(c.characters.size(), 1U);
      EXPECT_EQ(c.characters[0].data, first & second);
      EXPECT_EQ(c.characters[0].parity_error, (even(first) & even(second)) != even(first & second));
      EXPECT_FALSE(c.characters[0].framing_error);
      ASSERT_EQ(pair.recorder.events.size(), 1U);
      EXPECT_EQ(pair.recorder.events[0].kind, SerialEventKind::Collision);
      EXPECT_EQ(pair.recorder.texts[0],
                "line1: b collides: another station sends at the same time (other station a)");
    }
}

TEST(SerialLine, TelegramsThatOverlapAreGarbage) {
  for (int shift = 1; shift < 110; ++shift) {
    Pair pair;
    HandNode c(pair.line, "c");
    pair.a.send(kExample);
    pair.queue.run_until(shift * kSecond / 9600);
    pair.b.send(telegram("02 02 05 FF 06 11 22 33 44"));
    pair.queue.run_until(kSecond);
    for (const Reception& reception : c.receptions) EXPECT_FALSE(reception.telegram.has_value()) << shift;
    EXPECT_FALSE(c.receptions.empty());
  }
}

TEST(SerialLine, AnotherRateIsGarbageAndSaidOnce) {
  EventQueue queue;
  Rs485Line line(queue, 1, "line1", 9600);
  Recorder recorder;
  line.add_observer(recorder);
  HandNode slow(line, "slow");
  HandNode fast(line, "fast", 57600);
  HandNode slow2(line, "slow2");
  HandNode fast2(line, "fast2", 57600);
  EXPECT_EQ(
      recorder.texts,
      (std::vector<std::string>{
          "line1: fast understands nobody here: its baud rate is not that of the line (57600 baud, line "
          "9600 baud)",
          "line1: fast2 understands nobody here: its baud rate is not that of the line (57600 baud, line "
          "9600 baud)"}));
  slow.send(kExample);
  queue.run_until(kSecond);
  fast.send(kExample);
  queue.run_until(2 * kSecond);
  EXPECT_EQ(data_of(slow2.characters).size() > 10, true)
      << "the slow one hears the fast as a few odd characters";
  EXPECT_EQ(Bytes(slow2.characters.size(), 0).size(), slow2.characters.size());
  ASSERT_GE(slow2.receptions.size(), 2U);
  EXPECT_TRUE(slow2.receptions[0].telegram.has_value());
  for (size_t n = 1; n < slow2.receptions.size(); ++n) EXPECT_FALSE(slow2.receptions[n].telegram.has_value());
  size_t good = 0;
  for (const Reception& reception : fast2.receptions) good += reception.telegram.has_value();
  EXPECT_EQ(good, 1U) << "stations of one rate understand each other on any line";
  // The rate is changed while the line runs.
  line.set_baud(fast.port.node(), 9600);
  fast.characters.clear();
  slow.send(kExample);
  queue.run_until(3 * kSecond);
  EXPECT_EQ(data_of(fast.characters), kExample);
  EXPECT_EQ(recorder.texts.size(), 2U);
}

TEST(SerialLine, CutInTheMiddle) {
  Pair pair;
  HandNode c(pair.line, "c");
  pair.a.send(kExample);
  pair.queue.run_until(wire_time(4, 9600) + 300 * kMicrosecond);
  pair.line.set_connected(pair.a.port.node(), false);
  EXPECT_FALSE(pair.a.port.send(kExample));
  pair.queue.run_until(20 * kMillisecond);
  EXPECT_LE(pair.b.characters.size(), 5U);
  EXPECT_TRUE(pair.a.sent.empty());
  pair.b.send(kExample);
  pair.queue.run_until(kSecond);
  EXPECT_TRUE(pair.a.characters.empty());
  EXPECT_EQ(data_of(c.characters).size(), pair.b.characters.size() + 10);
  pair.line.set_connected(pair.a.port.node(), true);
  pair.b.send(kExample);
  pair.queue.run_until(2 * kSecond);
  EXPECT_EQ(data_of(pair.a.characters), kExample);
  EXPECT_EQ(pair.recorder.texts,
            std::vector<std::string>{"line1: a takes no part: it is not connected to the line"});
}

TEST(SerialLine, BrokenOffAfterTheCharacterOnTheWire) {
  for (int sent_bits = 1; sent_bits < 110; ++sent_bits) {
    Pair pair;
    pair.a.send(kExample);
    pair.queue.run_until(sent_bits * kSecond / 9600);
    pair.a.port.break_off();
    pair.queue.run_until(kSecond);
    const size_t whole = static_cast<size_t>((sent_bits + 10) / 11);
    EXPECT_EQ(data_of(pair.b.characters),
              Bytes(kExample.begin(), kExample.begin() + static_cast<long>(whole)))
        << sent_bits;
    EXPECT_TRUE(pair.a.sent.empty());
    pair.a.send(kExample);
    pair.queue.run_until(2 * kSecond);
    EXPECT_EQ(pair.b.receptions.back().telegram.has_value(), true);
  }
}

TEST(SerialLine, AGatewayThatSplitsATelegram) {
  PROVES("MDB-RS485-35");
  struct Split final : SerialFaults {
    void disturb(NodeId, std::vector<bool>& bits) override {
      bits.insert(bits.begin() + 55, 48, true);  // 48 bits of 9600 baud are 5 ms
    }
  };
  Pair pair;
  SlaveNode slave(pair.queue, 1, pair.line, "slave", {1});
  Split split;
  pair.line.set_faults(&split);
  pair.a.send(kExample);
  pair.queue.run_until(kSecond);
  EXPECT_TRUE(slave.unit.untouched());
  EXPECT_EQ(slave.unit.rejected, std::vector{SerialError::Gap});
  EXPECT_EQ(pair.recorder.heard.at(0).reception.telegram.error(), SerialError::Gap);
}

TEST(SerialLine, Load) {
  Pair pair;
  for (int n = 0; n < 40; ++n) {  // 40 telegrams of 110 bits in one second of 9600
    pair.a.send(kExample);
    pair.queue.run_until((n + 1) * 25 * kMillisecond);
  }
  const LineLoad load = pair.line.load(kSecond);
  EXPECT_EQ(load.busy_bits, 4400U);
  EXPECT_EQ(load.elapsed_bits, 9600U);
  EXPECT_EQ(load.percent, 45U);
  EXPECT_EQ(load.window_percent, 45U);
  EXPECT_EQ(load.frames, 400U);
  // Two at once count once.
  Pair both;
  both.a.send(kExample);
  both.queue.run_until(5 * kSecond / 9600);
  both.b.send(kExample);
  both.queue.run_until(kSecond);
  EXPECT_EQ(both.line.load(kSecond).busy_bits, 115U);
}

TEST(LineChecker, PausesAfterBroadcastAndAbort) {
  PROVES("RS485-06", "RS485-14");
  struct Told {
    std::vector<std::string> texts;
    LineCheck check{[this](Time, std::string text) { texts.push_back(std::move(text)); }};
  };
  for (const auto& [pause, findings] : {std::pair<int, size_t>{24'000, 1}, {24'900, 1}, {25'020, 0}}) {
    Pair pair;
    Told told;
    pair.line.add_observer(told.check);
    pair.a.send(telegram("02 FF 05 00 06 3A 98 01 F4"));
    pair.queue.run_until(wire_time(10, 9600) + pause * kMicrosecond);
    pair.a.send(kExample);
    pair.queue.run_until(kSecond);
    EXPECT_EQ(told.texts.size(), findings) << pause;
    if (findings == 1) {
      EXPECT_NE(told.texts[0].find("after a broadcast, at least 25000 us"), std::string::npos)
          << told.texts[0];
    }
    EXPECT_EQ(told.check.telegrams(), 2U);
  }
  for (const auto& [pause, findings] : {std::pair<int, size_t>{6'000, 1}, {6'900, 0}}) {
    Pair pair;
    Told told;
    pair.line.add_observer(told.check);
    pair.a.send({kExample.begin(), kExample.begin() + 4});
    pair.queue.run_until(wire_time(4, 9600) + pause * kMicrosecond);
    pair.a.send(kExample);
    pair.queue.run_until(kSecond);
    EXPECT_EQ(told.texts.size(), findings) << pause;
    if (findings == 1) {
      EXPECT_NE(told.texts[0].find("broken off, at least 6880 us"), std::string::npos);
    }
  }
}

TEST(LineChecker, TwoMasters) {
  Pair pair;
  std::vector<std::string> texts;
  LineCheck check([&](Time, std::string text) { texts.push_back(std::move(text)); });
  pair.line.add_observer(check);
  pair.a.send(kExample);
  pair.queue.run_until(kSecond);
  pair.b.send(telegram("1D 01 05 00 06 3A 98 01 F4"));
  pair.queue.run_until(2 * kSecond);
  EXPECT_TRUE(texts.empty()) << "a response makes no master";
  pair.b.send(kExample);
  pair.queue.run_until(3 * kSecond);
  EXPECT_EQ(texts, std::vector<std::string>{
                       "line1: a and b are both masters; only one may be active (1053 1610 p. 47)"});
}

TEST(SerialLog, OneTelegramALine) {
  Pair pair;
  std::ostringstream text;
  SerialLog log(text);
  pair.line.add_observer(log);
  pair.queue.run_until(kSecond);
  pair.a.send(kExample);
  pair.queue.run_until(2 * kSecond);
  pair.b.send(hex("1D 01 05 00 00"));
  pair.queue.run_until(3 * kSecond);
  log.finish();
  EXPECT_EQ(
      text.str(),
      "1.000000 1.011458 line1 02 01 05 00 06 3A 98 01 F4 57 | request to 1, 3PD cyclic, PO 0006 3A98 01F4\n"
      "2.000000 2.005729 line1 1D 01 05 00 00 | void: character delay exceeded\n");
}

// One station leaves the line at 1 for three characters between two of its own; another one sends one meanwhile. Its
// start bit comes before the one that was known, so it is heard, and then the second of the first station.
TEST(SerialLine, ACharacterInThePauseOfAnother) {
  Pair pair;
  HandNode third(pair.line, "third");
  std::vector<bool> bits;
  const auto put = [&](uint8_t byte) {
    for (int n = 0; n < 11; ++n) bits.push_back((wire_character(byte) >> n & 1) != 0);
  };
  put(0x11);
  bits.insert(bits.end(), 33, true);
  put(0x22);
  EXPECT_TRUE(pair.line.send_bits(pair.a.port.node(), bits));
  const Time meanwhile = 2 * wire_time(1, 9600);
  pair.queue.run_until(meanwhile);
  pair.b.send({0x33});
  pair.queue.run_until(kSecond);
  EXPECT_EQ(data_of(third.characters), hex("11 33 22"));
  EXPECT_EQ(data_of(pair.recorder.characters), hex("11 33 22"));
  ASSERT_EQ(third.characters.size(), 3U);
  EXPECT_NEAR(static_cast<double>(third.characters[1].start), static_cast<double>(meanwhile), 17'362);
  EXPECT_EQ(third.characters[2].end, wire_time(5, 9600));
  EXPECT_FALSE(third.characters[1].parity_error || third.characters[1].framing_error);
}

// Who begins to observe hears who takes no part; those that know it do not hear it again.
TEST(SerialLine, AnObserverThatComesLater) {
  EventQueue queue;
  Rs485Line line(queue, 7, "line1", 9600);
  Recorder first, second;
  line.add_observer(first);
  const HandNode slow(line, "slow");
  const HandNode fast(line, "fast", 57600);
  line.set_connected(slow.port.node(), false);
  const std::vector<std::string> texts = first.texts;
  ASSERT_EQ(texts.size(), 2U);
  line.add_observer(second);
  EXPECT_EQ(second.texts, (std::vector<std::string>{texts[1], texts[0]})) << "in the order of the stations";
  EXPECT_EQ(first.texts, texts);
  line.set_baud(fast.port.node(), 57600);
  EXPECT_EQ(first.texts.size(), 3U);
  EXPECT_EQ(second.texts.size(), 3U);
}

}  // namespace
}  // namespace ipos::tests
