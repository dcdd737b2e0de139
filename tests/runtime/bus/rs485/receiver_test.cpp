// Pauses and gaps to the microsecond, and every reception error, at a slave that is given exact times.
#include "runtime/bus/movilink/serial_receiver.hpp"

#include "tests/runtime/bus/rs485/serial_rig.hpp"

namespace ipos::tests {
namespace {

const Bytes kExample = hex("02 01 05 00 06 3A 98 01 F4 57");
constexpr Time kLongPause = 10 * kMillisecond;

TEST(Receiver, StartPause) {
  PROVES("RS485-04", "MDB-RS485-09");
  for (const auto& [pause, answers] :
       {std::pair<int, size_t>{3300, 0}, {3430, 0}, {3439, 0}, {3440, 1}, {3500, 1}}) {
    SlaveBench bench({1});
    bench.feed(telegram("1D 02 05 00 00 00 00 00 00"), kLongPause);  // somebody's response before it
    bench.feed(kExample, pause * kMicrosecond);
    EXPECT_EQ(bench.answers().size(), answers) << pause;
    EXPECT_EQ(bench.unit.untouched(), answers == 0) << pause;
    EXPECT_EQ(bench.unit.rejected,
              answers == 0 ? std::vector{SerialError::Pause} : std::vector<SerialError>{});
  }
  // 02 and 1D in the user data split nothing, even after an almost forbidden gap.
  SlaveBench bench({1});
  bench.feed(telegram("02 01 05 02 02 1D 1D 02 1D"), kLongPause, 3, 3430 * kMicrosecond);
  EXPECT_EQ(bench.answers().size(), 1U);
  EXPECT_EQ(bench.unit.output, (ProcessWords{0x0202, 0x1D1D, 0x021D}));
}

TEST(Receiver, CharacterGap) {
  PROVES("RS485-20", "MDB-RS485-10", "MDB-RS485-11");
  for (const int baud : {9600, 57600})
    for (size_t at = 1; at < kExample.size(); ++at)
      for (const auto& [gap, answers] :
           {std::pair<int, size_t>{3400, 1}, {3430, 1}, {3431, 0}, {3440, 0}, {3500, 0}, {50000, 0}}) {
        SlaveBench bench({1});
        bench.feed(kExample, kLongPause, at, gap * kMicrosecond, baud);
        EXPECT_EQ(bench.answers().size(), answers) << at << ' ' << gap;
        EXPECT_EQ(bench.unit.untouched(), answers == 0);
        if (answers == 0) {
          EXPECT_EQ(bench.unit.rejected.front(), SerialError::Gap) << at << ' ' << gap;
        }
      }
  // A PDU byte 02 after a long gap begins a telegram that leads nowhere.
  SlaveBench bench({1});
  bench.feed(telegram("02 01 05 00 02 01 05 00 06"), kLongPause, 4, 3500 * kMicrosecond);
  EXPECT_TRUE(bench.answers().empty());
  EXPECT_EQ(bench.unit.rejected, std::vector{SerialError::Gap});
  EXPECT_EQ(serial_error_text(SerialError::Gap), "character delay exceeded");
  // At 57.6 kbaud the start pause is the same, too.
  for (const auto& [pause, answers] : {std::pair<int, size_t>{3430, 0}, {3440, 1}}) {
    SlaveBench fast({1});
    fast.feed(telegram("1D 02 05 00 00 00 00 00 00"), kLongPause, 99, 0, 57600);
    fast.feed(kExample, pause * kMicrosecond, 99, 0, 57600);
    EXPECT_EQ(fast.answers().size(), answers) << pause;
  }
}

TEST(Receiver, RequestAfterABrokenOne) {
  PROVES("RS485-06");
  for (const size_t sent : {1U, 4U, 9U}) {
    SlaveBench bench({1});
    bench.feed({kExample.begin(), kExample.begin() + static_cast<long>(sent)}, kLongPause);
    bench.feed(kExample, 6880 * kMicrosecond);
    EXPECT_EQ(bench.answers().size(), 1U) << sent;
    EXPECT_EQ(bench.unit.rejected, std::vector{SerialError::Gap});
  }
}

// The example, made faulty in one way each.
struct Faulty {
  SerialError error;
  std::string text;
  void (*feed)(SlaveBench&);
};

void feed_with_bit(SlaveBench& bench, size_t character, unsigned bit) {
  Time at = bench.quiet_since + kLongPause;
  for (size_t n = 0; n < kExample.size(); ++n) {
    uint16_t bits = wire_character(kExample[n]);
    if (n == character) bits = static_cast<uint16_t>(bits ^ 1U << bit);
    Character c = read_wire(bits);
    c.start = at;
    c.end = at += wire_time(1, 9600);
    bench.feed(c);
  }
}

const Faulty kFaults[] = {
    {SerialError::Parity, "parity error", [](SlaveBench& b) { feed_with_bit(b, 5, 9); }},
    {SerialError::Frame, "character frame error", [](SlaveBench& b) { feed_with_bit(b, 4, 10); }},
    {SerialError::Gap, "character delay exceeded",
     [](SlaveBench& b) { b.feed(kExample, kLongPause, 5, 4 * kMillisecond); }},
    {SerialError::Address, "address incorrect",
     [](SlaveBench& b) { b.feed(telegram("02 02 05 00 06 3A 98 01 F4"), kLongPause); }},
    {SerialError::Type, "PDU type incorrect",
     [](SlaveBench& b) { b.feed(telegram("02 01 07 00 06 3A 98 01 F4"), kLongPause); }},
    {SerialError::BlockCheck, "BCC incorrect",
     [](SlaveBench& b) { b.feed(hex("02 01 05 00 06 3A 98 01 F4 54"), kLongPause); }}};

TEST(Receiver, SixErrorsAndNoAnswer) {
  PROVES("MDB-RS485-30");
  for (const Faulty& fault : kFaults) {
    SlaveBench bench({1});
    bench.feed(telegram("02 01 05 00 02 11 11 22 22"), kLongPause);
    EXPECT_EQ(bench.answers().size(), 1U);
    fault.feed(bench);
    EXPECT_TRUE(bench.answers().empty()) << fault.text;
    EXPECT_EQ(bench.unit.output, (ProcessWords{0x0002, 0x1111, 0x2222})) << fault.text;
    EXPECT_EQ(bench.unit.rejected, std::vector{fault.error});
    EXPECT_EQ(serial_error_text(fault.error), fault.text);
    EXPECT_EQ(bench.slave.statistics().of(fault.error), 1U);
    // Afterwards all is well.
    bench.feed(kExample, kLongPause);
    EXPECT_EQ(bench.answers().size(), 1U) << fault.text;
  }
}

TEST(Receiver, UnknownTypesStayUnanswered) {
  for (const char* type : {"07", "7F", "87", "FF"}) {
    SlaveBench bench({1});
    bench.feed(telegram("02 01 " + std::string(type) + " 00 06 3A 98 01 F4"), kLongPause);
    EXPECT_TRUE(bench.answers().empty());
    EXPECT_TRUE(bench.unit.untouched());
    EXPECT_EQ(bench.unit.rejected, std::vector{SerialError::Type});
  }
}

TEST(Receiver, EightCounters) {
  PROVES("MDB-RS485-31");
  SlaveBench bench({1, 101, false, true});
  for (const Faulty& fault : kFaults) {
    fault.feed(bench);
    bench.answers();
  }
  bench.feed(telegram("02 65 05 00 06 07 D0 00 00"), kLongPause);  // the master's setpoint, then silence
  bench.queue.run_until(bench.queue.now() + kSecond);
  for (const SerialError error :
       {SerialError::Parity, SerialError::Frame, SerialError::Gap, SerialError::Address, SerialError::Type,
        SerialError::BlockCheck, SerialError::Timeout})
    EXPECT_EQ(bench.slave.statistics().of(error), 1U) << serial_error_text(error);
  EventQueue queue;
  Rs485Line line(queue, 1, "line1", 9600);
  RequestNode master(queue, 2, line, "master", {.repeats = 0});
  master.requester.start(0, {false, 1, kSetpointFormat, {}, {}}, master);
  queue.run_until(kSecond);
  EXPECT_EQ(master.requester.statistics().of(SerialError::NoResponse), 1U);
  EXPECT_EQ(bench.slave.statistics().of(SerialError::Pause), 0U);
}

TEST(Receiver, DirectionsAreNotMixedUp) {
  PROVES("RS485-02", "MDB-RS485-13");
  const SerialTelegram answer{true, 1, kSetpointFormat, {}, {0x0407, 0x3A98, 0}};
  const Bytes answer_bytes = telegram("1D 01 05 04 07 3A 98 00 00");
  EXPECT_EQ(text_of(encode(answer).span()), text_of(answer_bytes));
  EXPECT_EQ(*decode_serial(answer_bytes), answer);
  // Another slave's response, and one that looks like ours.
  for (const char* text : {"1D 02 05 00 06 3A 98 01 F4", "1D 01 05 00 06 3A 98 01 F4"}) {
    SlaveBench bench({1});
    bench.feed(telegram(text), kLongPause);
    EXPECT_TRUE(bench.answers().empty());
    EXPECT_TRUE(bench.unit.untouched());
  }
  // A master that hears a request where it waits for a response.
  EventQueue queue;
  Rs485Line line(queue, 1, "line1", 9600);
  RequestNode master(queue, 2, line, "master", {.repeats = 0});
  HandNode other(line, "other");
  master.requester.start(0, {false, 1, kSetpointFormat, {}, {}}, master);
  queue.run_until(wire_time(10, 9600) + 10 * kMillisecond);
  other.send(telegram("02 01 05 00 06 3A 98 01 F4"));
  queue.run_until(kSecond);
  EXPECT_EQ(master.ends, std::vector{RequestEnd::NoResponse});
  EXPECT_TRUE(master.responses.empty());
}

TEST(Receiver, MonitorDeadline) {
  SerialReceiver receiver;
  EXPECT_EQ(receiver.deadline(), kNever);
  EXPECT_FALSE(receiver.give_up().has_value());
  Character c = read_wire(wire_character(0x02));
  c.start = 1000;
  c.end = 2000;
  EXPECT_FALSE(receiver.take(c).has_value());
  EXPECT_EQ(receiver.deadline(), 2000 + 3'430'000);
  EXPECT_EQ(receiver.start(), 1000);
  const auto cut = receiver.give_up();
  ASSERT_TRUE(cut.has_value());
  EXPECT_EQ(cut->telegram.error(), SerialError::Gap);
  EXPECT_EQ(cut->bytes.size, 1);
}

// A receiver by itself: each byte one character of a millisecond, the first one at `at`.
std::vector<std::optional<Reception>> take_all(SerialReceiver& receiver, Time at, const Bytes& bytes) {
  std::vector<std::optional<Reception>> receptions;
  for (const uint8_t byte : bytes) {
    receptions.push_back(receiver.take({at, at + kMillisecond, byte, false, false}));
    at += kMillisecond;
  }
  return receptions;
}

TEST(Receiver, ATelegramHasItsTimesAndBytes) {
  SerialReceiver receiver;
  const Bytes bytes = telegram("02 01 01 00 01");
  const auto receptions = take_all(receiver, kSecond, bytes);
  for (size_t n = 0; n + 1 < receptions.size(); ++n) EXPECT_FALSE(receptions[n].has_value()) << n;
  ASSERT_TRUE(receptions.back());
  EXPECT_TRUE(receptions.back()->telegram.has_value());
  EXPECT_EQ(receptions.back()->start, kSecond);
  EXPECT_EQ(receptions.back()->end, kSecond + 6 * kMillisecond);
  EXPECT_EQ(text_of(receptions.back()->bytes.span()), text_of(bytes));
  EXPECT_FALSE(receiver.receiving());
  EXPECT_EQ(receiver.deadline(), kNever);
}

// After an error the rest is left until the next pause; a start character without one begins nothing.
TEST(Receiver, ErrorsAreToldOnceUntilTheNextPause) {
  SerialReceiver receiver;
  auto receptions = take_all(receiver, 0, hex("55 02 01 1D"));
  ASSERT_TRUE(receptions[0]);
  EXPECT_EQ(receptions[0]->telegram.error(), SerialError::Start);
  for (size_t n = 1; n < 4; ++n) EXPECT_FALSE(receptions[n].has_value()) << n;
  // A good telegram, and what follows it at once: a start character after too short a pause, then silence.
  const Time good = 4 * kMillisecond + kStartPause;
  EXPECT_TRUE(take_all(receiver, good, telegram("02 01 01 00 01")).back()->telegram.has_value());
  receptions = take_all(receiver, good + 6 * kMillisecond, hex("02 02 55"));
  ASSERT_TRUE(receptions[0]);
  EXPECT_EQ(receptions[0]->telegram.error(), SerialError::Pause);
  EXPECT_EQ(receptions[0]->bytes.size, 1);
  EXPECT_FALSE(receptions[1].has_value());
  EXPECT_FALSE(receptions[2].has_value());
  // After the pause it is told again.
  receptions = take_all(receiver, good + 9 * kMillisecond + kStartPause, hex("55 55"));
  ASSERT_TRUE(receptions[0]);
  EXPECT_EQ(receptions[0]->telegram.error(), SerialError::Start);
  EXPECT_FALSE(receptions[1].has_value());
  // A first character with an error of its own.
  SerialReceiver faulty;
  EXPECT_EQ(faulty.take({0, 1000, 0x02, true, false})->telegram.error(), SerialError::Parity);
  EXPECT_EQ(faulty.take({kSecond, kSecond + 1000, 0x55, true, true})->telegram.error(), SerialError::Frame);
}

// The character that comes after a gap voids the telegram before it; behind a whole pause it begins the next one.
TEST(Receiver, ACharacterAfterAGap) {
  for (const auto& [gap, begins] : {std::pair<Time, bool>{kCharacterGap + 1, false},
                                    {kStartPause - 1, false},
                                    {kStartPause, true},
                                    {kSecond, true}}) {
    SerialReceiver receiver;
    take_all(receiver, 0, hex("02 01"));
    const auto receptions = take_all(receiver, 2 * kMillisecond + gap, telegram("1D 01 01 00 01"));
    ASSERT_TRUE(receptions[0]) << gap;
    EXPECT_EQ(receptions[0]->telegram.error(), SerialError::Gap);
    EXPECT_EQ(text_of(receptions[0]->bytes.span()), "02 01");
    EXPECT_EQ(receptions[0]->start, 0);
    EXPECT_EQ(receptions[0]->end, 2 * kMillisecond);
    for (size_t n = 1; n < 5; ++n) EXPECT_FALSE(receptions[n].has_value()) << n;
    ASSERT_EQ(receptions[5].has_value(), begins) << gap;
    if (begins) {
      EXPECT_EQ(receptions[5]->start, 2 * kMillisecond + gap);
    }
  }
  SerialReceiver receiver;
  take_all(receiver, 0, hex("02 01"));
  EXPECT_TRUE(
      take_all(receiver, 2 * kMillisecond + kCharacterGap, hex("01 00 01 03")).back()->telegram.has_value());
}

TEST(Receiver, WhatItsOwnStationSendsIsNoPause) {
  for (const auto& [more, good] : {std::pair<Time, bool>{-1, false}, {0, true}}) {
    SerialReceiver receiver;
    receiver.occupied(kSecond);
    receiver.occupied(kMillisecond);  // does not end earlier for it
    const auto receptions = take_all(receiver, kSecond + kStartPause + more, telegram("02 01 01 00 01"));
    EXPECT_EQ(receptions[0].has_value(), !good);
    ASSERT_EQ(receptions[5].has_value(), good);
    if (!good) {
      EXPECT_EQ(receptions[0]->telegram.error(), SerialError::Pause);
    }
  }
  // A telegram under way is gone, and so is an error before it.
  SerialReceiver receiver;
  take_all(receiver, 0, hex("02 01"));
  EXPECT_TRUE(receiver.receiving());
  receiver.occupied(5 * kMillisecond);
  EXPECT_FALSE(receiver.receiving());
  EXPECT_EQ(receiver.deadline(), kNever);
  EXPECT_EQ(take_all(receiver, 6 * kMillisecond, hex("55"))[0]->telegram.error(), SerialError::Start);
  receiver.occupied(8 * kMillisecond);
  EXPECT_EQ(take_all(receiver, 9 * kMillisecond, hex("02"))[0]->telegram.error(), SerialError::Pause);
  // Given up, the rest is left until the next pause.
  SerialReceiver stopped;
  take_all(stopped, 0, hex("02 01"));
  EXPECT_TRUE(stopped.give_up().has_value());
  EXPECT_FALSE(take_all(stopped, 3 * kMillisecond, hex("55"))[0].has_value());
}

}  // namespace
}  // namespace ipos::tests
