// The receiver of a UART on recorded levels, tick by tick, and the ends of transmissions on a line: what an ear sees,
// where a character begins and is read, who is told what.
#include "runtime/bus/rs485/levels.hpp"

#include <random>

#include "tests/runtime/bus/rs485/serial_rig.hpp"

namespace ipos::tests {
namespace {

// Levels as text: "0110".
std::vector<bool> levels(const std::string& text) {
  std::vector<bool> bits;
  for (const char c : text) bits.push_back(c == '1');
  return bits;
}
// 11 bits as text, from the start bit on (1053 1610 p. 26): 55h has four ones, so its parity bit is 0.
const std::string k55 = "01010101001";

std::string seen(const std::vector<Transmission>& line, const Ear& ear, Tick from, Tick until) {
  std::string text;
  for (Tick tick = from; tick < until; ++tick) text += level_at(line, ear, tick) ? '1' : '0';
  return text;
}

TEST(Levels, BitsOfBytes) {
  EXPECT_EQ(wire_bits(hex("55")), levels(k55));
  EXPECT_EQ(wire_bits(hex("55 01")), levels(k55 + "01000000011"));
  EXPECT_TRUE(wire_bits({}).empty());
}

TEST(Levels, AZeroOverrulesAOneAndAnEarIsDeafToItself) {
  const std::vector<Transmission> line = {{0, 10, 1, levels("0101")}, {1, 12, 2, levels("110")}};
  EXPECT_EQ(line[0].end(), 14U);
  EXPECT_EQ(line[1].end(), 18U);
  const Ear all{1, kNoNode};
  EXPECT_EQ(seen(line, all, 8, 20), "110101110011");
  EXPECT_EQ(seen(line, {1, 1}, 8, 20), "110111111111")
      << "while it sends it hears nothing, not even the other";
  EXPECT_EQ(seen(line, {1, 0}, 8, 20), "111111110011");
  EXPECT_EQ(seen(line, {1, 2}, 8, 20), "110101110011");
  // What nobody sends is no station's own.
  EXPECT_EQ(seen({{kNoNode, 10, 1, levels("00")}}, all, 9, 13), "1001");
}

TEST(Levels, AStartBitIsAFall) {
  const std::vector<Transmission> line = {{0, 10, 1, levels("0010")}};
  const Ear ear{1, kNoNode};
  EXPECT_EQ(next_start(line, ear, 0, 100), 10U);
  EXPECT_EQ(next_start(line, ear, 10, 100), 10U);
  EXPECT_EQ(next_start(line, ear, 11, 100), 13U) << "in the middle of a low level there is no fall";
  EXPECT_EQ(next_start(line, ear, 13, 100), 13U);
  EXPECT_EQ(next_start(line, ear, 14, 100), std::nullopt);
  EXPECT_EQ(next_start(line, ear, 0, 10), std::nullopt) << "up to the tick before";
  EXPECT_EQ(next_start(line, ear, 0, 11), 10U);
  // Before the first tick of all the line was at rest.
  EXPECT_EQ(next_start(std::vector<Transmission>{{0, 0, 1, levels("0")}}, ear, 0, 5), 0U);
  EXPECT_EQ(next_start({}, ear, 0, 5), std::nullopt);
}

constexpr Tick kWindow = 120;

std::optional<Tick> start_by_each_tick(const std::vector<Transmission>& line, const Ear& ear, Tick from,
                                       Tick until) {
  for (Tick tick = from; tick < until; ++tick)
    if (!level_at(line, ear, tick) && (tick == 0 || level_at(line, ear, tick - 1))) return tick;
  return std::nullopt;
}

// Up to three senders with different rates, at once and after each other, with gaps and without.
std::vector<Transmission> any_line(std::mt19937& random) {
  std::vector<Transmission> line;
  for (NodeId sender = 0; sender < 1 + random() % 3; ++sender) {
    constexpr uint32_t kBitTicks[] = {1, 6, 7, 13};
    Transmission& sent = line.emplace_back();
    sent.sender = sender;
    sent.begin = random() % 60;
    sent.bit_ticks = kBitTicks[random() % 4];
    const auto ones = static_cast<uint32_t>(random() % 4);
    for (auto n = random() % 12; n > 0; --n) sent.bits.push_back(random() % 4 < ones);
  }
  return line;
}

TEST(Levels, AStartBitIsFoundAsByALookAtEachTick) {
  std::mt19937 random(20260728);
  int found = 0;
  for (int n = 0; n < 400; ++n) {
    const std::vector<Transmission> line = any_line(random);
    const Ear ear{6, random() % 2 == 0 ? kNoNode : NodeId{0}};
    for (Tick from = 0; from < kWindow; ++from)
      for (const Tick until : {from, from + 1, from + random() % 20, kWindow}) {
        const auto start = next_start(line, ear, from, until);
        ASSERT_EQ(start, start_by_each_tick(line, ear, from, until)) << n << ", " << from << " to " << until;
        found += start.has_value();
      }
  }
  EXPECT_GT(found, 1000) << "most lines have start bits";
}

// A bit of 9.6 kbaud has six ticks and is read in its fourth; then the next start bit may come.
TEST(Levels, EachBitIsReadInItsMiddle) {
  std::vector<bool> ticks;
  for (const bool level : levels(k55)) ticks.insert(ticks.end(), 6, level);
  const Ear slow{6, kNoNode};
  for (size_t bit = 0; bit < 11; ++bit)
    for (size_t tick = 0; tick < 6; ++tick) {
      std::vector<bool> disturbed = ticks;
      disturbed[6 * bit + tick].flip();
      const Reading reading = read_character(std::vector<Transmission>{{0, 100, 1, disturbed}}, slow, 100);
      if (bit == 0 && tick == 3) {
        EXPECT_FALSE(reading.character.has_value()) << "a spike";
        EXPECT_EQ(reading.resume, 103U);
        continue;
      }
      EXPECT_EQ(reading.resume, 100U + 60 + 3 + 1);
      ASSERT_TRUE(reading.character);
      const bool hit = tick == 3;
      EXPECT_EQ(reading.character->data, hit && bit <= 8 ? 0x55 ^ 1U << (bit - 1) : 0x55U) << bit << tick;
      EXPECT_EQ(reading.character->parity_error, hit && bit <= 9);
      EXPECT_EQ(reading.character->framing_error, hit && bit == 10);
      EXPECT_EQ(reading.character->start, time_of(100));
      EXPECT_EQ(reading.character->end, time_of(166));
    }
  // At the fast rate a bit is one tick.
  const Reading fast = read_character(std::vector<Transmission>{{0, 100, 1, levels(k55)}}, {1, kNoNode}, 100);
  EXPECT_EQ(fast.character->data, 0x55);
  EXPECT_EQ(fast.character->end, time_of(111));
  EXPECT_EQ(fast.resume, 111U);
  EXPECT_EQ(character_ticks(slow), 66U);
}

// 57 600 ticks a second: the begin of each in whole nanoseconds, and back.
TEST(Levels, TicksAndTimes) {
  EXPECT_EQ(time_of(0), 0);
  EXPECT_EQ(time_of(1), 17'361);
  EXPECT_EQ(time_of(57'600), kSecond);
  EXPECT_EQ(time_of(3 * 57'600 + 2), 3 * kSecond + 34'722);
  EXPECT_EQ(tick_from(0), 0U);
  EXPECT_EQ(tick_from(1), 1U);
  EXPECT_EQ(tick_from(17'361), 1U);
  EXPECT_EQ(tick_from(17'362), 2U) << "the first one that does not begin before: 17361.1 ns";
  EXPECT_EQ(tick_from(kSecond), 57'600U);
  for (const uint32_t baud : {0U, 1200U, 9599U, 19'200U, 57'601U}) EXPECT_FALSE(is_serial_baud_rate(baud));
  EXPECT_TRUE(is_serial_baud_rate(9600) && is_serial_baud_rate(57'600));
  EXPECT_EQ(character_time(9600), 1'145'833);
  EXPECT_EQ(character_time(57'600), 190'972);
}

struct Wired {
  EventQueue queue;
  Rs485Line line{queue, 0, "x", 9600};
  Recorder recorder;
  HandNode a{line, "a"}, b{line, "b"}, c{line, "c"};
  Wired() { line.add_observer(recorder); }
  Bytes heard_by(const HandNode& node) const {
    Bytes bytes;
    for (const Character& character : node.characters) bytes.push_back(character.data);
    return bytes;
  }
};

TEST(SerialLine, WhatCannotBeSent) {
  Wired rig;
  EXPECT_FALSE(rig.a.port.send({})) << "nothing";
  EXPECT_TRUE(rig.a.port.send(hex("55")));
  EXPECT_FALSE(rig.a.port.send(hex("55"))) << "still sending";
  rig.queue.run_until(wire_time(1, 9600));
  EXPECT_EQ(rig.a.sent, std::vector{time_of(66)}) << "the last stop bit";
  EXPECT_TRUE(rig.a.port.send(hex("55")));
  rig.line.set_connected(0, false);
  EXPECT_FALSE(rig.a.port.send(hex("55")));
  rig.queue.run_until(kSecond);
  EXPECT_EQ(rig.a.sent.size(), 1U);
}

// break_off() lets the character on the wire end; before the first bit and behind a character there is none.
TEST(SerialLine, BrokenOffToTheBit) {
  for (const auto& [ticks, characters] :
       {std::pair<Tick, size_t>{0, 0}, {1, 1}, {65, 1}, {66, 1}, {67, 2}, {132, 2}}) {
    Wired rig;
    rig.a.send(hex("55 66 77"));
    rig.queue.run_until(time_of(ticks));
    rig.a.port.break_off();
    rig.a.port.break_off();
    rig.queue.run_until(kSecond);
    Bytes expected = hex("55 66");
    expected.resize(characters);
    EXPECT_EQ(rig.heard_by(rig.b), expected) << ticks;
    EXPECT_TRUE(rig.a.sent.empty()) << "it is not told";
    EXPECT_EQ(rig.line.load(kSecond).busy_bits, 11 * characters);
    EXPECT_TRUE(rig.a.port.send(hex("01"))) << "it may send again";
  }
}

TEST(SerialLine, ObserversKnowTheSenderOfACharacter) {
  struct Senders final : SerialObserver {
    void on_character(const Rs485Line&, NodeId sender, const Character& character) override {
      all.emplace_back(sender, character.data);
    }
    void on_serial_event(const Rs485Line&, const SerialEvent& event) override { events.push_back(event); }
    std::vector<std::pair<NodeId, uint8_t>> all;
    std::vector<SerialEvent> events;
  };
  Wired rig;
  Senders senders;
  rig.line.add_observer(senders);
  rig.a.send(hex("55"));
  rig.queue.run_until(time_of(66));
  rig.b.send(hex("66"));  // right behind the stop bit
  rig.queue.run_until(time_of(132));
  rig.c.send(hex("0F 0F"));
  rig.queue.run_until(time_of(132 + 66 + 6));  // in the second character
  rig.a.send(hex("FF"));
  rig.queue.run_until(kSecond);
  ASSERT_EQ(senders.all.size(), 4U);
  EXPECT_EQ(senders.all[0], (std::pair<NodeId, uint8_t>{0, 0x55}));
  EXPECT_EQ(senders.all[1], (std::pair<NodeId, uint8_t>{1, 0x66}));
  EXPECT_EQ(senders.all[2], (std::pair<NodeId, uint8_t>{2, 0x0F}));
  EXPECT_EQ(senders.all[3].first, kNoNode) << "two at once";
  ASSERT_EQ(senders.events.size(), 1U);
  EXPECT_EQ(senders.events[0].kind, SerialEventKind::Collision);
  EXPECT_EQ(senders.events[0].node, 0U);
  EXPECT_EQ(senders.events[0].other, 2U);
  EXPECT_EQ(senders.events[0].time, time_of(204));
  EXPECT_EQ(
      rig.recorder.texts,
      std::vector<std::string>{"x: a collides: another station sends at the same time (other station c)"});
}

// A station that changes its rate or is cut off loses the character it is hearing, and hears the next one.
TEST(SerialLine, AReceiverBeginsAnew) {
  for (const bool cut : {false, true})
    for (const bool at_once : {false, true}) {
      Wired rig;
      // From its second data bit on all of FEh is 1.
      rig.a.send(at_once ? hex("FE 7F") : hex("FE"));
      rig.queue.run_until(time_of(30));
      if (cut) {
        rig.line.set_connected(1, false);
        rig.line.set_connected(1, true);
      } else {
        rig.line.set_baud(1, 9600);
      }
      rig.queue.run_until(time_of(66));
      if (!at_once) rig.a.send(hex("7F"));
      rig.queue.run_until(kSecond);
      EXPECT_EQ(rig.heard_by(rig.b), hex("7F")) << cut << at_once;
      EXPECT_EQ(rig.heard_by(rig.c), hex("FE 7F"));
    }
  // One that is cut off hears nothing more, not even the character it was hearing.
  Wired rig;
  rig.a.send(hex("FE 7F"));
  rig.queue.run_until(time_of(30));
  rig.line.set_connected(1, false);
  rig.queue.run_until(kSecond);
  EXPECT_TRUE(rig.b.characters.empty());
}

// Whoever finds no start bit waits for none.
TEST(SerialLine, NothingWaitsOnAQuietLine) {
  Wired rig;
  EXPECT_EQ(rig.queue.pending(), 0U);
  rig.a.send(hex("55"));
  EXPECT_EQ(rig.queue.pending(), 4U) << "the end of it, two receivers and the observers";
  rig.line.set_connected(1, false);
  EXPECT_EQ(rig.queue.pending(), 3U);
  rig.queue.run_until(time_of(66));
  EXPECT_EQ(rig.queue.pending(), 0U);
  rig.line.set_connected(1, true);
  rig.line.set_baud(2, 57'600);
  EXPECT_EQ(rig.queue.pending(), 0U);
  rig.a.send(hex("55"));
  rig.line.set_connected(0, false);
  EXPECT_EQ(rig.queue.pending(), 0U) << "cut before its first bit";
}

// A low level shorter than half a bit is no start bit to anybody, and the next character is heard.
TEST(SerialLine, ASpikeIsNoCharacter) {
  for (const Tick ticks : {Tick{1}, Tick{3}, Tick{4}}) {
    Wired rig;
    HandNode fast(rig.line, "fast", 57'600);
    EXPECT_TRUE(rig.line.send_bits(fast.port.node(), std::vector<bool>(ticks, false)));
    rig.queue.run_until(time_of(100));
    const bool spike = ticks <= 3;
    EXPECT_EQ(rig.b.characters.size(), spike ? 0U : 1U) << ticks;
    EXPECT_EQ(rig.recorder.characters.size(), spike ? 0U : 1U) << ticks;
    EXPECT_EQ(rig.line.load(kSecond).frames, spike ? 0U : 1U);
    rig.a.send(hex("55"));
    rig.queue.run_until(kSecond);
    EXPECT_EQ(rig.heard_by(rig.b).back(), 0x55);
    EXPECT_EQ(rig.b.characters.size(), spike ? 1U : 2U);
  }
}

TEST(SerialLine, LoadOfPartsOfASecond) {
  Wired rig;
  rig.a.send(hex("55"));
  rig.queue.run_until(2 * kSecond);
  EXPECT_EQ(rig.line.load(0).elapsed_bits, 0U);
  EXPECT_EQ(rig.line.load(kSecond / 2).elapsed_bits, 4'800U);
  EXPECT_EQ(rig.line.load(kSecond / 2 - 1).elapsed_bits, 4'799U);
  EXPECT_EQ(rig.line.load(kSecond + kSecond / 4).elapsed_bits, 12'000U);
  EXPECT_EQ(rig.line.load(kSecond + kSecond / 4).busy_bits, 11U);
}

// Of two that collide each tick counts once, whoever ends first.
TEST(SerialLine, LoadOfCollisions) {
  const auto busy = [](Tick second, size_t bytes, Tick cut) {
    EventQueue queue;
    Rs485Line line(queue, 0, "x", 57'600);
    HandNode a(line, "a"), b(line, "b", 9600);
    b.send(Bytes(2, 0x55));  // 132 ticks
    queue.run_until(time_of(second));
    a.send(Bytes(bytes, 0x55));
    queue.run_until(time_of(cut));
    if (cut != 0) line.set_connected(b.port.node(), false);
    queue.run_until(kSecond);
    return line.load(kSecond).busy_bits;
  };
  EXPECT_EQ(busy(50, 1, 0), 132U) << "within the other one";
  EXPECT_EQ(busy(121, 1, 0), 132U) << "both end at once";
  EXPECT_EQ(busy(125, 1, 0), 136U) << "the second one ends later";
  EXPECT_EQ(busy(132, 1, 0), 143U) << "one behind the other";
  EXPECT_EQ(busy(0, 1, 0), 132U);
  // Cut off, the last whole bit counts: it ended before the other one.
  EXPECT_EQ(busy(20, 1, 35), 31U);
  EXPECT_EQ(busy(20, 1, 41), 36U);
}

TEST(SerialLine, WhatWillBeHeard) {
  Wired rig;
  rig.a.send(hex("55 66"));
  const std::vector<Character> upcoming = rig.line.upcoming(1);
  ASSERT_EQ(upcoming.size(), 2U);
  EXPECT_EQ(upcoming[0].data, 0x55);
  EXPECT_EQ(upcoming[1].data, 0x66);
  EXPECT_EQ(upcoming[1].end, time_of(132));
  EXPECT_TRUE(rig.line.upcoming(0).empty()) << "not its own";
  rig.queue.run_until(time_of(66));
  EXPECT_EQ(rig.line.upcoming(1).size(), 1U);
  rig.line.set_connected(2, false);
  EXPECT_TRUE(rig.line.upcoming(2).empty());
  rig.queue.run_until(kSecond);
  EXPECT_TRUE(rig.line.upcoming(1).empty());
}

TEST(SerialLine, WhoTakesNoPartIsToldInWords) {
  Wired rig;
  rig.line.set_baud(1, 57'600);
  rig.line.set_connected(2, false);
  rig.line.set_connected(2, true);
  rig.line.set_baud(1, 9600);
  EXPECT_EQ(
      rig.recorder.texts,
      (std::vector<std::string>{
          "x: b understands nobody here: its baud rate is not that of the line (57600 baud, line 9600 baud)",
          "x: c takes no part: it is not connected to the line"}));
  EXPECT_EQ(rig.line.node_count(), 3U);
  EXPECT_EQ(rig.line.node_name(2), "c");
  EXPECT_EQ(rig.line.node_baud(1), 9600U);
}

}  // namespace
}  // namespace ipos::tests
