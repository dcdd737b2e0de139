// The bridge between a simulated RS-485 line and a serial port: pauses and gaps by times of arrival, parity
// errors, telegrams in one piece, echo and late adapters.
#include <gtest/gtest.h>

#include "runtime/os_port/serial_bridge.hpp"
#include "tests/runtime/bus/rs485/serial_rig.hpp"
#include "tests/runtime/os_port/bytes_in_memory.hpp"
#include "tests/runtime/os_port/port_rig.hpp"

namespace ipos::tests {
namespace {

constexpr Time kCharacter = wire_time(1, 9600);

struct Rig {
  explicit Rig(bool paced = true, Time latency = 0, Time slack = 0) {
    port.paced = paced;
    port.late = latency;
    bridge.emplace(queue, 9, line, port, slack);
    line.add_observer(recorder);
  }
  // The bytes of a telegram, each complete a character time after the one before; the first one at `at`.
  void arrive(Time at, const Bytes& bytes) {
    for (const uint8_t byte : bytes) {
      port.incoming.push_back({at, byte, false});
      at += kCharacter;
    }
  }
  void run(Time until) {
    while (clock.now() < until) {
      clock.advance(std::min(kMillisecond / 4, until - clock.now()));
      ASSERT_TRUE(bridge->collect(0));
      queue.run_until(clock.now());
    }
  }
  bool noted(const std::string& words) {
    for (const std::string& text : bridge->take_notes())
      if (text.find(words) != std::string::npos) return true;
    return false;
  }

  ManualClock clock{0};
  EventQueue queue;
  Rs485Line line{queue, 0, "line1", 9'600};
  SlaveNode slave{queue, 1, line, "unit1", {1, 101}};
  BytesInMemory port{clock};
  std::optional<SerialBridge> bridge;
  Recorder recorder;
};

const Bytes kRequest = telegram("02 01 86 31 00 20 7E 00 00 00 00");  // read 8318

TEST(SerialBridge, ARequestFromThePortIsAnsweredInOnePiece) {
  Rig rig;
  rig.arrive(10 * kMillisecond, kRequest);
  rig.run(100 * kMillisecond);
  ASSERT_EQ(rig.port.sent.size(), 1U) << "no gap can come into it";
  EXPECT_EQ(text_of(rig.port.sent[0].bytes), "1D 01 86 31 00 20 7E 00 0F 42 40 F8");
  // At the port: pause of 3.44 ms kept, and well within the 50 ms of a master (1053 1610 p. 19, 27).
  const Time request_end = 10 * kMillisecond + 11 * kCharacter;
  EXPECT_GE(rig.port.sent[0].at - request_end, 3'440 * kMicrosecond);
  EXPECT_LE(rig.port.sent[0].at - request_end, 10 * kMillisecond);
  EXPECT_EQ(rig.recorder.heard.size(), 2U) << "and it does not come back";
}

TEST(SerialBridge, APseudoTerminalGetsEachCharacterAtItsTime) {
  Rig rig(false);
  rig.arrive(10 * kMillisecond, kRequest);
  rig.run(100 * kMillisecond);
  ASSERT_EQ(rig.port.sent.size(), 12U);
  for (size_t n = 1; n < 12; ++n) {
    EXPECT_EQ(rig.port.sent[n].bytes.size(), 1U);
    EXPECT_NEAR(static_cast<double>(rig.port.sent[n].at - rig.port.sent[n - 1].at), 1.1458e6, 0.3e6);
  }
}

TEST(SerialBridge, BytesThatComeAtOnceTakeTheirTimeOnTheLine) {
  Rig rig;
  for (const uint8_t byte : kRequest) rig.port.incoming.push_back({10 * kMillisecond, byte, false});
  rig.run(100 * kMillisecond);
  ASSERT_EQ(rig.recorder.heard.size(), 2U);
  const Reception& request = rig.recorder.heard[0].reception;
  EXPECT_NEAR(static_cast<double>(request.end - request.start), 12 * 11e9 / 9600, 2e5);
}

// 1053 1610 p. 19: the pause before SD1; MDX60B/61B p. 18: the gap within a telegram.
TEST(SerialBridge, PausesAndGapsAreThoseOfTheArrival) {
  const auto answers_with = [](Time pause, size_t gap_at, Time gap) {
    Rig rig;
    // A request to another unit, then ours after `pause`.
    const Bytes other = telegram("02 07 81 00 00");
    rig.arrive(10 * kMillisecond, other);
    Time at = 10 * kMillisecond + static_cast<Time>(other.size()) * kCharacter + pause;
    for (size_t n = 0; n < kRequest.size(); ++n, at += kCharacter) {
      if (n == gap_at) at += gap;
      rig.port.incoming.push_back({at, kRequest[n], false});
    }
    rig.run(200 * kMillisecond);
    return !rig.port.sent.empty();
  };
  EXPECT_TRUE(answers_with(3'500 * kMicrosecond, 0, 0));
  EXPECT_FALSE(answers_with(3'300 * kMicrosecond, 0, 0));
  EXPECT_TRUE(answers_with(10 * kMillisecond, 5, 3'400 * kMicrosecond));
  EXPECT_FALSE(answers_with(10 * kMillisecond, 5, 3'500 * kMicrosecond));
}

// An adapter with a 16 ms timer: the telegram comes in two groups, the second one late.
TEST(SerialBridge, ALateAdapterDoesNotTearTelegrams) {
  for (const Time latency : {Time{0}, 16 * kMillisecond}) {
    Rig rig(true, latency);
    Time at = 20 * kMillisecond;
    for (size_t n = 0; n < kRequest.size(); ++n, at += kCharacter) {
      if (n == 8) at += 12 * kMillisecond;
      rig.port.incoming.push_back({at, kRequest[n], false});
    }
    rig.run(200 * kMillisecond);
    EXPECT_EQ(!rig.port.sent.empty(), latency > 0);
  }
}

TEST(SerialBridge, BadBytesAreParityErrorsOnTheLine) {
  Rig rig;
  rig.arrive(10 * kMillisecond, kRequest);
  rig.port.incoming[4].bad = true;
  rig.run(100 * kMillisecond);
  EXPECT_TRUE(rig.port.sent.empty());
  EXPECT_EQ(rig.slave.unit.rejected, std::vector<SerialError>{SerialError::Parity});
  EXPECT_EQ(rig.bridge->bad_bytes(), 1U);
}

TEST(SerialBridge, AnEchoIsLeftOut) {
  Rig rig;
  rig.arrive(10 * kMillisecond, kRequest);
  rig.run(50 * kMillisecond);
  ASSERT_EQ(rig.port.sent.size(), 1U);
  rig.arrive(rig.clock.now(), rig.port.sent[0].bytes);
  rig.run(80 * kMillisecond);
  EXPECT_EQ(rig.bridge->echoed_bytes(), 12U);
  EXPECT_EQ(rig.recorder.heard.size(), 2U);
  EXPECT_TRUE(rig.noted("hears itself"));
  rig.arrive(90 * kMillisecond, kRequest);  // and it goes on
  rig.run(150 * kMillisecond);
  EXPECT_EQ(rig.port.sent.size(), 2U);
}

// Noise that by chance is what an echo would begin with is no echo: no message, and the answer is heard.
TEST(SerialBridge, NoiseIsNoEcho) {
  for (const uint8_t noise : Bytes{0x1D, 0x55}) {
    Rig rig;
    rig.arrive(10 * kMillisecond, kRequest);
    rig.run(50 * kMillisecond);
    ASSERT_EQ(rig.port.sent.size(), 1U);
    rig.arrive(rig.clock.now(), {noise, 0xAA, 0xAA});
    rig.run(150 * kMillisecond);
    EXPECT_FALSE(rig.noted("hears itself"));
    rig.arrive(rig.clock.now(), kRequest);
    rig.run(250 * kMillisecond);
    EXPECT_EQ(rig.port.sent.size(), 2U);
  }
}

// An echo comes when its bytes have gone out, at most 32 ms and the adapter's latency later.
TEST(SerialBridge, AnEchoHasItsTime) {
  for (const Time latency : {Time{0}, 16 * kMillisecond})
    for (const size_t size : {size_t{1}, size_t{3}})
      for (const bool late : {false, true}) {
        Rig rig(true, latency);
        HandNode hand(rig.line, "hand");
        const Bytes bytes(size, 0x41);
        hand.send(bytes);
        rig.run(10 * kMillisecond);
        ASSERT_EQ(rig.port.sent.size(), 1U);
        EXPECT_EQ(rig.port.sent[0].bytes, bytes);
        ASSERT_EQ(rig.recorder.characters.size(), size);
        // The first character has been heard then, and the telegram goes out as a whole.
        const Time end = rig.recorder.characters[0].end + static_cast<Time>(size) * kCharacter + latency +
                         32 * kMillisecond;
        rig.port.incoming.push_back({end + (late ? 1 : 0), 0x41, false});
        rig.run(150 * kMillisecond);
        EXPECT_EQ(rig.bridge->echoed_bytes(), late ? 0U : 1U);
        EXPECT_EQ(rig.recorder.characters.size(), size + (late ? 1U : 0U));
      }
}

// The first byte that is another one, or a bad one, ends an echo; a telegram as a whole is told as one.
TEST(SerialBridge, AnEchoIsWhatWentOut) {
  struct Row {
    Bytes back;
    bool bad;  // the last of them
    uint64_t echoed;
    bool told;
  };
  for (const Row& row :
       {Row{{1, 2, 3}, false, 3, true}, Row{{1, 2}, false, 2, false}, Row{{1, 9, 2, 3}, false, 1, false},
        Row{{9, 1, 2, 3}, false, 0, false}, Row{{1, 2, 3}, true, 2, false}, Row{{1, 2, 3, 1}, false, 3, true},
        Row{{2, 3}, false, 0, false}}) {
    Rig rig;
    HandNode hand(rig.line, "hand");
    hand.send({1, 2, 3});
    rig.run(10 * kMillisecond);
    rig.arrive(12 * kMillisecond, row.back);
    rig.port.incoming.back().bad = row.bad;
    rig.run(60 * kMillisecond);
    SCOPED_TRACE(text_of(row.back));
    EXPECT_EQ(rig.bridge->echoed_bytes(), row.echoed);
    EXPECT_EQ(rig.recorder.characters.size(), 3 + row.back.size() - row.echoed);
    EXPECT_EQ(rig.bridge->bad_bytes(), row.bad ? 1U : 0U);
    EXPECT_EQ(rig.bridge->take_notes(),
              row.told ? std::vector<std::string>{"serial: the adapter hears itself: its echo "
                                                  "is left out"}
                       : std::vector<std::string>{});
  }
}

// A port has no way to send a character with an error, so it is left out: the telegram is void outside, too.
TEST(SerialBridge, DisturbedCharactersAreLeftOut) {
  struct : SerialFaults {
    void disturb(NodeId, std::vector<bool>& bits) override {
      constexpr size_t kParity = 9, kStop = 10, kCharacterBits = 11;
      bits[kCharacterBits + (framing ? kStop : kParity)].flip();
    }
    bool framing = false;
  } faults;
  for (const bool framing : {false, true})
    for (const bool paced : {true, false}) {
      Rig rig(paced);
      HandNode hand(rig.line, "hand");
      faults.framing = framing;
      rig.line.set_faults(&faults);
      hand.send({0x41, 0x42});
      rig.run(20 * kMillisecond);
      Bytes all;
      for (const auto& part : rig.port.sent) all.insert(all.end(), part.bytes.begin(), part.bytes.end());
      EXPECT_EQ(text_of(all), "41") << framing << paced;
      EXPECT_EQ(
          rig.bridge->take_notes(),
          std::vector<std::string>{"serial: disturbed characters of the simulated line are not passed on"});
    }
}

// Bytes for a line that it is not connected to are counted, and the next ones have their turn.
TEST(SerialBridge, WhatTheLineDoesNotTakeIsCounted) {
  Rig rig;
  constexpr NodeId kBridge = 1;  // behind the slave
  ASSERT_EQ(rig.line.node_name(kBridge), "serial");
  rig.line.set_connected(kBridge, false);
  rig.arrive(5 * kMillisecond, {1, 2, 3});
  rig.run(20 * kMillisecond);
  EXPECT_EQ(std::as_const(*rig.bridge).counts().undelivered, 3U);
  EXPECT_EQ(rig.bridge->waiting(), 0U);
  EXPECT_TRUE(rig.recorder.characters.empty());
}

// What has gone out in one piece is disturbed later by a second station: that cannot be taken back, and is told.
TEST(SerialBridge, ACollisionBehindTheFirstCharacterIsTold) {
  for (const bool collides : {false, true}) {
    Rig rig;
    HandNode first(rig.line, "first"), second(rig.line, "second");
    first.send(Bytes(8, 0x55));
    rig.run(3 * kMillisecond);
    ASSERT_EQ(rig.port.sent.size(), 1U);
    EXPECT_EQ(rig.port.sent[0].bytes, Bytes(8, 0x55));
    if (collides) second.send(Bytes(2, 0x00));
    rig.run(20 * kMillisecond);
    EXPECT_EQ(rig.noted("serial: telegrams that collide on the simulated line have gone out in part"), collides);
  }
}

// The first byte of a telegram goes on the line as late as an adapter may be, or as the host is given: the longer of
// both. A port gives a byte when it is complete.
TEST(SerialBridge, ATelegramBeginsAsLateAsItMayCome) {
  for (const Time latency : {Time{0}, 5 * kMillisecond, 16 * kMillisecond})
    for (const Time slack : {Time{0}, 8 * kMillisecond}) {
      Rig rig(true, latency, slack);
      rig.arrive(10 * kMillisecond, {0x55, 0x56});
      rig.run(60 * kMillisecond);
      ASSERT_EQ(rig.recorder.characters.size(), 2U);
      const Time begin = 10 * kMillisecond + std::max(latency, slack);
      EXPECT_NEAR(static_cast<double>(rig.recorder.characters[0].start), static_cast<double>(begin), 110e3)
          << "a bit";
    }
}

// Two units answer 254 at once: what collides is not passed on as if it were good.
TEST(SerialBridge, CollisionsOfAnswersGoOutAsVoidTelegrams) {
  Rig rig;
  SlaveNode second(rig.queue, 2, rig.line, "unit2", {2, 101});
  second.unit.parameters[8318] = 5;
  rig.arrive(10 * kMillisecond, telegram("02 FE 86 31 00 20 7E 00 00 00 00"));
  rig.run(200 * kMillisecond);
  Bytes all;
  for (const auto& part : rig.port.sent) all.insert(all.end(), part.bytes.begin(), part.bytes.end());
  EXPECT_FALSE(decode_serial(all).has_value()) << text_of(all);
}

TEST(SerialBridge, TakesAsManyBytesAsItHasRoomFor) {
  Rig rig;
  for (int n = 0; n < 4'097; ++n) rig.port.incoming.push_back({0, 0x55, false});
  EXPECT_TRUE(rig.bridge->collect(0));
  EXPECT_EQ(rig.bridge->waiting(), 4'096U);
  EXPECT_EQ(rig.port.incoming.size(), 1U);
  EXPECT_TRUE(
      rig.noted("serial: 4096 bytes wait for the simulated line: they come faster than its 9600 baud"));
}

TEST(SerialBridge, LateIsWhatIsBeforeNow) {
  Rig rig;
  rig.run(10 * kMillisecond);
  for (const auto& [epoch, late, worst] :
       {std::tuple(0, 0U, 0), std::tuple(1, 1U, 1), std::tuple(7, 2U, 7), std::tuple(3, 3U, 7)}) {
    rig.port.incoming.push_back({10 * kMillisecond, 0x55, false});
    EXPECT_TRUE(rig.bridge->collect(epoch));
    EXPECT_EQ(
        std::pair(std::as_const(*rig.bridge).counts().late, std::as_const(*rig.bridge).counts().worst_late),
        std::pair(uint64_t{late}, Time{worst}));
  }
}

}  // namespace
}  // namespace ipos::tests
