// The checks of a running SBus, fed with telegrams of exact times: who sends, who answers, and what is told once.
#include "runtime/bus/movilink/sbus_check.hpp"

#include <gtest/gtest.h>

#include "runtime/bus/movilink/process_data.hpp"
#include "tests/runtime/bus/hand.hpp"

namespace ipos::tests {
namespace {

struct CheckBench final : SbusCheckClient {
  explicit CheckBench(bool units_outside = false) : check(*this, units_outside) {}
  void on_sbus_finding(Time now, std::string text) override {
    times.push_back(now);
    texts.push_back(std::move(text));
  }
  void slave(const Hand& station, SlaveSettings settings) {
    check.add_slave(0, line, station.port.node(), settings);
  }
  // A telegram of 100 us.
  void feed(Time start, const Hand& sender, const Frame& frame) {
    check.on_frame(line, {frame, sender.port.node(), start, start + 100 * kMicrosecond, 50});
  }
  void feed(Time start, const Hand& sender, uint32_t id) { feed(start, sender, Frame{id, 8}); }
  std::vector<std::string> told() { return std::exchange(texts, {}); }

  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  Hand a{line, "a"}, b{line, "b"}, c{line, "c"};
  SbusCheck check;
  std::vector<std::string> texts;
  std::vector<Time> times;
};
using Told = std::vector<std::string>;

TEST(SbusCheck, EverySecondSenderIsToldOnce) {
  CheckBench bench;
  for (int n = 0; n < 2; ++n) {
    bench.feed(1000, bench.a, 1024);
    bench.feed(2000, bench.b, 1024);
    bench.feed(3000, bench.c, 1024);
    bench.feed(4000, bench.c, 1025);
  }
  EXPECT_EQ(bench.told(),
            (Told{"sbus: identifier 400h (1024) is sent by a and by b; an identifier may have one sender",
                  "sbus: identifier 400h (1024) is sent by a and by c; an identifier may have one sender"}));
  EXPECT_EQ(bench.times[0], 2000 + 100 * kMicrosecond) << "at the end of the telegram";
  bench.feed(0, bench.a, 1025);
  EXPECT_EQ(bench.told(),
            Told{"sbus: identifier 401h (1025) is sent by c and by a; an identifier may have one sender"});
  // Identifiers of 29 bits and remote frames belong to others.
  bench.feed(0, bench.a, Frame{1026, 8, {}, true, false});
  bench.feed(0, bench.b, Frame{1026, 8, {}, true, false});
  bench.feed(0, bench.a, Frame{1026, 8, {}, false, true});
  bench.feed(0, bench.b, Frame{1026, 8, {}, false, true});
  bench.feed(0, bench.c, 1026);
  EXPECT_TRUE(bench.told().empty());
}

TEST(SbusCheck, AddressesOfTwoUnits) {
  CheckBench bench;
  bench.slave(bench.a, {3, 2, 0});
  bench.slave(bench.b, {4, 2, 0});
  EXPECT_TRUE(bench.told().empty()) << "a group may have several members";
  bench.slave(bench.c, {3, 1, 0});
  EXPECT_EQ(bench.told(),
            Told{"sbus: a and c both have SBus address 3: both answer to it, and their answers collide"});
}

// 1053 1610 p. 38: 8 a + 3, 5 and 515, 517 call a unit, 8 g + 6 and 518 a group.
TEST(SbusCheck, EveryTelegramToNobodyIsToldOnce) {
  CheckBench empty;
  empty.feed(0, empty.a, 11);
  EXPECT_TRUE(empty.told().empty()) << "a line without slaves has no addresses";
  CheckBench bench;
  bench.slave(bench.a, {3, 9, 0});
  bench.slave(bench.b, {4, 8, 0});
  const std::string address = "sbus: c calls address 5, which no station has; there are 3 (a), 4 (b)";
  const std::string group = "sbus: c calls group address 5, which no station has; there are 9 (a), 8 (b)";
  for (const uint32_t id : {43U, 45U, 46U, 555U, 557U, 558U})
    for (int n = 0; n < 2; ++n) {
      bench.feed(n * kSecond, bench.c, id);
      const Told expected = n != 0 ? Told{} : Told{id % 8 == 6 ? group : address};
      EXPECT_EQ(bench.told(), expected) << id;
    }
  // Answers of nobody, and calls that reach somebody.
  Time at = 10 * kSecond;
  for (const uint32_t id :
       {44U, 556U, 559U, 27U, 29U, 35U, 37U, 70U, 78U, 539U, 541U, 547U, 549U, 582U, 590U}) {
    at += kSecond;
    bench.feed(at, bench.c, id);
    EXPECT_TRUE(bench.told().empty()) << id;
  }
  CheckBench outside(true);
  outside.slave(outside.a, {3, 9, 0});
  outside.feed(0, outside.c, 43);
  EXPECT_TRUE(outside.told().empty());
}

const std::string kMastersAB =
    "sbus: a and b are masters at the same time; only one may be active in the network";

// MOVLNK needs the line for itself from its request to the answer (1053 1610 p. 47), for at most 50 ms (ours).
TEST(SbusCheck, AMasterIsBusyUntilItsAnswer) {
  struct Row {
    uint32_t request, answer, other;
    bool answered;  // a telegram that gets no answer keeps nobody from sending
  };
  const Row rows[] = {{11, 12, 19, true},  {523, 524, 531, true}, {525, 527, 533, true}, {11, 12, 531, true},
                      {13, 12, 19, false}, {22, 12, 19, false},   {534, 524, 19, false}, {12, 12, 19, false}};
  for (const Row& row : rows) {
    CheckBench bench;
    bench.feed(0, bench.a, row.request);
    bench.feed(kMillisecond, bench.b, row.other);
    EXPECT_EQ(bench.told(), row.answered ? Told{kMastersAB} : Told{}) << row.request;
    CheckBench good;
    good.feed(0, good.a, row.request);
    good.feed(kMillisecond, good.c, row.answer);
    good.feed(2 * kMillisecond, good.b, row.other);
    EXPECT_TRUE(row.answer == row.request || good.told().empty()) << row.request;
    CheckBench wrong;  // the answer of another unit
    wrong.feed(0, wrong.a, row.request);
    wrong.feed(kMillisecond, wrong.c, row.answer + 40);
    wrong.feed(2 * kMillisecond, wrong.b, row.other);
    EXPECT_EQ(wrong.told(), row.answered ? Told{kMastersAB} : Told{}) << row.request;
  }
  // What only gets no answer does not disturb either.
  CheckBench bench;
  bench.feed(0, bench.a, 523);
  for (const uint32_t id : {13U, 22U, 534U, 1024U, 524U}) bench.feed(kMillisecond, bench.b, id);
  EXPECT_TRUE(bench.told().empty());
}

TEST(SbusCheck, AMasterIsBusyForFiftyMilliseconds) {
  for (const Time later : {Time{-1}, Time{0}, Time{1}}) {
    CheckBench bench;
    bench.feed(0, bench.a, 523);
    bench.feed(50 * kMillisecond + later, bench.b, 531);  // both last as long
    EXPECT_EQ(bench.told(), later == 1 ? Told{} : Told{kMastersAB});
  }
}

TEST(SbusCheck, EveryPairOfMastersIsToldOnce) {
  CheckBench bench;
  bench.feed(0, bench.a, 523);
  bench.feed(1000, bench.a, 539);  // its own second request
  EXPECT_TRUE(bench.told().empty());
  bench.feed(2000, bench.b, 531);
  EXPECT_EQ(bench.told(), Told{kMastersAB}) << "once, though two exchanges are open";
  bench.feed(kSecond, bench.b, 531);
  bench.feed(kSecond + 1000, bench.a, 523);
  EXPECT_TRUE(bench.told().empty()) << "the same two";
  bench.feed(kSecond + 2000, bench.c, 547);
  EXPECT_EQ(bench.told(),
            (Told{"sbus: b and c are masters at the same time; only one may be active in the network",
                  "sbus: a and c are masters at the same time; only one may be active in the network"}));
}

// PO-sync belongs between 1.5 and 4.5 ms after the sync telegram (1053 1610 p. 39, in the wider reading).
TEST(SbusCheck, WindowOfPoSync) {
  for (const auto& [at, good] : {std::pair<Time, bool>{1'499'999, false},
                                 {1'500'000, true},
                                 {3'000'000, true},
                                 {4'500'000, true},
                                 {4'500'001, false}})
    for (const Time begin : {Time{0}, 7 * kSecond}) {
      CheckBench bench;
      bench.slave(bench.a, {1, 0, 128});
      bench.feed(begin, bench.c, 128);
      bench.feed(begin + at, bench.c, 13);
      const Told told = bench.told();
      ASSERT_EQ(told.size(), good ? 0U : 1U) << at;
      if (!good) {
        EXPECT_EQ(told[0],
                  at < 2'000'000
                      ? "sbus: synchronous PO telegram 00Dh (13) of c starts 1.500 ms after the sync "
                        "telegram; it belongs between 1.5 and 4.5 ms"
                      : "sbus: synchronous PO telegram 00Dh (13) of c starts 4.500 ms after the sync "
                        "telegram; it belongs between 1.5 and 4.5 ms");
      }
    }
}

TEST(SbusCheck, TheLastSyncTelegramOfTheUnitCounts) {
  CheckBench bench;
  SlaveSettings other{2, 0, 129};
  bench.slave(bench.a, {1, 0, 128});
  bench.slave(bench.b, other);
  bench.feed(0, bench.c, 13);
  EXPECT_TRUE(bench.told().empty()) << "no sync telegram yet";
  bench.feed(kMillisecond, bench.c, 128);
  bench.feed(6 * kMillisecond, bench.c, 128);
  bench.feed(9 * kMillisecond, bench.c, 129);
  bench.feed(9 * kMillisecond, bench.c, 13);
  EXPECT_TRUE(bench.told().empty()) << "3 ms after its own";
  bench.feed(9 * kMillisecond, bench.c, 11);  // other PO may come at any time
  EXPECT_TRUE(bench.told().empty());
  bench.feed(9 * kMillisecond, bench.c, 21);
  EXPECT_EQ(bench.told(),
            Told{"sbus: synchronous PO telegram 015h (21) of c starts 0.000 ms after the sync telegram; "
                 "it belongs between 1.5 and 4.5 ms"});
  bench.feed(9 * kMillisecond, bench.c, 21);
  EXPECT_TRUE(bench.told().empty()) << "once";
}

// The sync telegram may have an identifier of the profile, and a unit without one is watched for nothing.
TEST(SbusCheck, SyncIdentifiersOfEveryKind) {
  CheckBench bench;
  bench.slave(bench.a, {1, 0, 300});
  bench.feed(0, bench.c, 300);
  bench.feed(kMillisecond, bench.c, 13);
  EXPECT_EQ(bench.told().size(), 1U);
  CheckBench m07;
  SlaveSettings settings{1, 0, 128};
  settings.synchronous = false;
  m07.slave(m07.a, settings);
  m07.feed(0, m07.c, 128);
  m07.feed(kMillisecond, m07.c, 13);
  EXPECT_TRUE(m07.told().empty());
  CheckBench last;  // 2047 is the highest one; a number beyond is no identifier
  last.slave(last.a, {1, 0, 2047});
  last.slave(last.b, {2, 0, 2048});
  last.feed(0, last.c, 2047);
  last.feed(5 * kMillisecond, last.c, 2047);
  last.feed(8 * kMillisecond, last.c, 13);
  EXPECT_TRUE(last.told().empty());
}

}  // namespace
}  // namespace ipos::tests
