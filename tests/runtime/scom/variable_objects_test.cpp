// _SBusCommDef and _SBusCommOn without a bus: results, limits and times of the objects. Expected values are
// those of 1053 1610 p. 51 to 61 and of IPOSplus p. 232 and 320.

#include <set>

#include "runtime/clock/random.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/scom/objects_rig.hpp"

namespace ipos::runtime {
namespace {

TEST_F(Objects, ResultIsTheFreeCapacityThatTheManualsPrint) {
  PROVES("SCOM-11");
  EXPECT_EQ(cyclic(1024, 100), 99);  // figures 36, 39, 40
  int32_t before = 99;
  for (int32_t id = 1025; id < 1030; ++id) {
    const int32_t result = cyclic(id, 10);
    EXPECT_LE(result, before);
    before = result;
  }
}
TEST_F(Objects, ResultOf120MillisecondsIs99) { EXPECT_EQ(cyclic(1025, 120), 99); }  // figure 37
TEST_F(Objects, ResultOf10MillisecondsIs96) { EXPECT_EQ(cyclic(1025, 10), 96); }    // IPOSplus p. 320

TEST_F(Objects, CycleTimes) {
  PROVES("SCOM-07");
  for (const int32_t cycle : {0, -1, 11, 15, 65'531, 65'540, INT32_MAX, INT32_MIN}) {
    EXPECT_EQ(cyclic(1024, cycle), kWrongCycleTime) << cycle;
    EXPECT_FALSE(why_.empty());
  }
  int32_t id = 1024;
  for (const int32_t cycle : {9, 10, 20, 65'530}) EXPECT_GE(cyclic(id++, cycle), 0) << cycle;
  EXPECT_GE(cyclic(id++, 1, 0, 0), 0);
  objects_.start(0);
  for (int64_t tick = 0; tick < 100; ++tick) objects_.tick(tick, h_);
  for (const Outbox::Sent& sent : outbox_.sent) EXPECT_LT(sent.frame.id, static_cast<uint32_t>(id));
}

TEST_F(Objects, Offsets) {
  PROVES("SCOM-08");
  EXPECT_GE(cyclic(1024, 5, 65'534), 0);
  EXPECT_GE(cyclic(1025, 10, 65'530), 0);
  EXPECT_GE(cyclic(1026, 50, 120), 0);
  EXPECT_EQ(cyclic(1027, 5, 65'535), kWrongCycleTime);
  EXPECT_EQ(cyclic(1027, 10, 65'534), kWrongCycleTime);
  EXPECT_EQ(cyclic(1027, 10, 5), kWrongCycleTime);
  EXPECT_EQ(cyclic(1027, 10, -10), kWrongCycleTime);
}

TEST_F(Objects, AtMostFiveFastAndTenSlowOnes) {
  PROVES("SCOM-09");
  for (int32_t n = 0; n < 5; ++n) EXPECT_GE(cyclic(1024 + n, 5, 0, 0), 0);
  EXPECT_EQ(cyclic(1040, 5, 0, 0), kTooManyObjects);
  for (int32_t n = 0; n < 10; ++n) EXPECT_GE(cyclic(1050 + n, 100), 0);
  EXPECT_EQ(cyclic(1041, 100), kTooManyObjects);
  objects_.start(0);
  objects_.tick(0, h_);
  EXPECT_EQ(outbox_.sent.size(), 15U);
}

TEST_F(ObjectsSlowBus, OverloadIsRefused) {
  PROVES("SCOM-10");
  // 135 bits every 2 ms are 67 500 of 87 500 bit/s: 22.8 % stay free; another one would be too much.
  EXPECT_EQ(cyclic(1024, 2), 22);
  EXPECT_EQ(cyclic(1025, 2), kBusOverload);
  EXPECT_EQ(cyclic(1025, 10), 7);  // 81 000 of 87 500
  objects_.start(0);
  objects_.tick(0, h_);
  EXPECT_EQ(outbox_.sent.size(), 2U);
}

// 70 % of 125 kBit/s are 87 500 bit/s. A frame has 55 + 10 n bits: 55 000 of one without data each ms and 32 500 of
// one with a byte every 2 ms are the budget to the bit.
TEST_F(ObjectsSlowBus, TheWholeBudgetMayBeUsed) {
  EXPECT_EQ(cyclic(1024, 1, 0, 0), 37);
  EXPECT_EQ(cyclic(1025, 2, 0, 1), 0) << "nothing is left, but it fits";
  EXPECT_EQ(cyclic(1026, 65'530, 0, 0), kBusOverload);
}

TEST_F(ObjectsM07, HasOnlySlowObjects) {
  EXPECT_EQ(cyclic(1024, 9), kWrongCycleTime);
  for (int32_t n = 0; n < 10; ++n) EXPECT_GE(cyclic(1024 + n, 10), 0);
  EXPECT_EQ(cyclic(1040, 10), kTooManyObjects);
}

TEST_F(ObjectsB, OffsetIsSmallerThanTheCycle) {
  EXPECT_EQ(cyclic(1024, 5, 5), kWrongCycleTime);
  EXPECT_GE(cyclic(1024, 5, 4, 0), 0);
  EXPECT_EQ(cyclic(1025, 50, 120), kWrongCycleTime);
  EXPECT_GE(cyclic(1025, 120, 50), 0);
}

// The seven numbers of p. 38 are closed and nothing else; the kinds of objects make no difference.
TEST_F(Objects, AnIdentifierMayBeUsedOnceInAUnit) {
  PROVES("VAR-04");
  for (const auto& [address, group] : {std::pair{0, 0}, {1, 2}, {63, 17}, {9, 63}}) {
    const std::set<int32_t> own = {8 * address + 3,   8 * address + 4,   8 * address + 5, 8 * group + 6,
                                   8 * address + 515, 8 * address + 516, 8 * group + 518};
    for (int32_t id = 0; id < 2048; ++id)
      for (const ObjectKind kind :
           {ObjectKind::TransmitCyclic, ObjectKind::TransmitAcyclic, ObjectKind::Receive}) {
        objects_.stop();
        objects_.set_profile({static_cast<uint8_t>(address), static_cast<uint8_t>(group), 2047});
        const int32_t cyclic_elements[] = {id, 100, 0, 8, 426, 12345};
        const int32_t elements[] = {id, 8, 426, 12345};
        if (kind == ObjectKind::TransmitCyclic)
          std::copy(std::begin(cyclic_elements), std::end(cyclic_elements), h_.begin() + 20);
        else
          std::copy(std::begin(elements), std::end(elements), h_.begin() + 20);
        why_.clear();
        EXPECT_TRUE(objects_.define(kind, 20, h_, why_));
        char number[16];
        std::snprintf(number, sizeof number, "%03Xh (%d)", static_cast<unsigned>(id), id);
        EXPECT_EQ(why_.starts_with(std::string("object number ") + number +
                                   " is an identifier of the unit's own MOVILINK telegrams"),
                  own.contains(id))
            << id << " at " << address << ", " << group << ": " << why_;
        if (kind == ObjectKind::TransmitCyclic) {
          EXPECT_EQ(h_[25] < 0, own.contains(id)) << id;
        }
        if (kind == ObjectKind::TransmitAcyclic) {
          EXPECT_EQ(h_[23], own.contains(id) ? 3 : 1) << id;
        }
      }
  }
}

// Sent and received by one unit: the second one is refused, in either order.
TEST_F(Objects, AnIdentifierIsSentOrReceivedByAUnit) {
  PROVES("VAR-04");
  EXPECT_GE(cyclic(1024, 100), 0);
  receive(1024);
  EXPECT_EQ(why_,
            "object 400h (1024) would be sent and received by this unit, which may use an identifier once; "
            "the second "
            "definition is not used");
  receive(1025);
  EXPECT_EQ(why_, "");
  EXPECT_LT(cyclic(1025, 100), 0);
  EXPECT_NE(why_.find("object 401h (1025) would be sent and received"), std::string::npos);
  objects_.start(0);
  EXPECT_FALSE(arrives(1024));
  EXPECT_TRUE(arrives(1025));
  objects_.tick(0, h_);
  ASSERT_EQ(outbox_.sent.size(), 1U);
  EXPECT_EQ(outbox_.sent[0].frame.id, 1024U);
  // An acyclic telegram is sent; its second use is told.
  std::copy_n(std::array<int32_t, 4>{1025, 8, 426, 0}.begin(), 4, h_.begin() + 10);
  why_.clear();
  EXPECT_TRUE(objects_.define(ObjectKind::TransmitAcyclic, 10, h_, why_));
  EXPECT_EQ(why_,
            "object 401h (1025) stands in two structures of this unit (H428 and H10), which may use an "
            "identifier once");
  EXPECT_EQ(h_[13], 1);
}

TEST_F(Objects, ObjectNumbersAndLengths) {
  PROVES("VAR-07");
  EXPECT_LT(cyclic(2048, 100), 0);
  EXPECT_LT(cyclic(-1, 100), 0);
  EXPECT_GE(cyclic(2047, 100), 0);
  for (const int32_t format : {9, 0x200, 0x109, -1}) {
    EXPECT_LT(cyclic(1024, 100, 0, format), 0) << format;
    EXPECT_FALSE(why_.empty());
  }
  for (int32_t n = 0; n <= 8; ++n) EXPECT_GE(cyclic(1100 + n, 100, 0, n % 2 == 0 ? n : 0x100 + n), 0);
  objects_.start(0);
  objects_.tick(0, h_);
  for (const Outbox::Sent& sent : outbox_.sent)
    if (sent.frame.id >= 1100 && sent.frame.id <= 1108) {
      EXPECT_EQ(sent.frame.length, sent.frame.id - 1100);
    }
}

TEST_F(Objects, DataPointerOutsideTheVariables) {
  const int32_t elements[] = {1024, 100, 0, 8, 511, 0};
  std::copy(std::begin(elements), std::end(elements), h_.begin() + 420);
  EXPECT_FALSE(objects_.define(ObjectKind::TransmitCyclic, 420, h_, why_));  // needs H511 and H512
  EXPECT_GE(cyclic(1024, 100, 0, 4, 511), 0);
  h_[424] = -1;
  h_[420] = 1025;
  EXPECT_FALSE(objects_.define(ObjectKind::TransmitCyclic, 420, h_, why_));
}

TEST_F(Objects, SendTimesFollowOffsetAndCycle) {
  PROVES("SCOM-13", "EX-28");
  EXPECT_GE(cyclic(1024, 50, 120), 0);
  objects_.start(0);
  EXPECT_EQ(send_times(300), (std::vector<int64_t>{120, 170, 220, 270}));  // figure 38
}

TEST_F(Objects, TimesCountFromTheStart) {
  cyclic(1024, 100);
  objects_.start(7);
  EXPECT_EQ(send_times(220), (std::vector<int64_t>{7, 107, 207}));
}

// Whatever was left out before: an object is due when whole cycles have passed since its first time.
TEST_F(ObjectsB, AMillisecondSendsWhatIsDueInIt) {
  struct Object {
    int32_t cycle, offset;
  };
  const std::vector<Object> objects = {{3, 0}, {7, 2}, {10, 0}, {50, 20}};
  Random random(1);
  int64_t tick = 0;
  for (int round = 0; round < 20; ++round) {
    size_t defined = 2;
    for (size_t n = 0; n < defined; ++n)
      ASSERT_GE(cyclic(1024 + static_cast<int32_t>(n), objects[n].cycle, objects[n].offset), 0);
    const int64_t start = tick + random.below(5);
    objects_.start(start);
    for (int step = 0; step < 200; ++step) {
      if (step % 60 == 59 && defined < objects.size()) {
        ASSERT_GE(
            cyclic(1024 + static_cast<int32_t>(defined), objects[defined].cycle, objects[defined].offset), 0);
        ++defined;
      }
      std::vector<uint64_t> due;
      for (size_t n = 0; n < defined; ++n) {
        const int64_t since = tick - start - objects[n].offset;
        if (since >= 0 && since % objects[n].cycle == 0) due.push_back(100 + n);
      }
      outbox_.sent.clear();
      const int64_t next = objects_.tick(tick, h_);
      std::vector<uint64_t> sent;
      for (const Outbox::Sent& frame : outbox_.sent) sent.push_back(frame.tag);
      EXPECT_EQ(sent, due) << tick << " started at " << start;
      EXPECT_GT(next, tick);
      tick = random.below(3) == 0 ? next : tick + 1 + random.below(4);
    }
    objects_.stop();
  }
}

TEST_F(Objects, SendsThePresentValues) {
  PROVES("SCOM-14");
  cyclic(1024, 10, 0, 4);
  objects_.start(0);
  h_[426] = 1;
  objects_.tick(0, h_);
  h_[426] = 2;
  objects_.tick(10, h_);
  ASSERT_EQ(outbox_.sent.size(), 2U);
  EXPECT_EQ(outbox_.sent[0].frame.data[3], 1);
  EXPECT_EQ(outbox_.sent[1].frame.data[3], 2);
}

TEST_F(Objects, NothingHappensBeforeTheStartAndAfterTheStop) {
  PROVES("SCOM-12");
  cyclic(1024, 10);
  receive(1025);
  EXPECT_TRUE(send_times(50).empty());
  EXPECT_FALSE(arrives(1025));
  EXPECT_EQ(h_[431], 0);
  objects_.start(0);
  EXPECT_TRUE(arrives(1025));
  EXPECT_EQ(h_[431], 0x11223344);
  EXPECT_EQ(h_[432], 0x55667788);
  objects_.stop();
  h_[431] = 0;
  EXPECT_FALSE(arrives(1025));
  EXPECT_EQ(h_[431], 0);
  EXPECT_TRUE(send_times(50).empty());
}

TEST_F(Objects, WrongLengthIsIgnoredWithAReason) {
  PROVES("VAR-13");
  receive(1025);
  objects_.start(0);
  EXPECT_FALSE(arrives(1025, 6));
  EXPECT_FALSE(why_.empty());
  EXPECT_EQ(h_[431], 0);
}

TEST_F(Objects, ThirtyTwoReceiveObjects) {
  PROVES("SCOM-15");
  for (int32_t n = 0; n < 32; ++n) {
    receive(1100 + n, 4, 100 + n);
    EXPECT_TRUE(why_.empty());
  }
  receive(1132, 4, 132);
  EXPECT_NE(why_.find("1132"), std::string::npos);
  objects_.start(0);
  for (uint32_t n = 0; n < 33; ++n) EXPECT_EQ(arrives(1100 + n, 4), n < 32);
  receive(1200);
  EXPECT_FALSE(why_.empty()) << "defined after the start";
}

TEST_F(Objects, AcyclicIsSentAtOnceAndReportsItsStatus) {
  PROVES("SCOM-17");
  const auto send = [&] {
    h_[10] = 1024;
    h_[11] = 8;
    h_[12] = 20;
    h_[13] = 0;
    h_[20] = 0x11223344;
    h_[21] = 0x55667788;
    return objects_.define(ObjectKind::TransmitAcyclic, 10, h_, why_);
  };
  EXPECT_TRUE(send());
  EXPECT_EQ(h_[13], 1);
  ASSERT_EQ(outbox_.sent.size(), 1U);
  EXPECT_EQ(outbox_.sent[0].frame.data,
            (std::array<uint8_t, 8>{0x55, 0x66, 0x77, 0x88, 0x11, 0x22, 0x33, 0x44}));
  objects_.on_sent(outbox_.sent[0].tag, h_);
  EXPECT_EQ(h_[13], 2);
  EXPECT_TRUE(send());
  objects_.on_not_sent(outbox_.sent[1].tag, h_);
  EXPECT_EQ(h_[13], 3);
  outbox_.status = SendStatus::NotActive;
  EXPECT_TRUE(send());
  EXPECT_EQ(h_[13], 3);
}

// It counts from the start, too, and does not wait for the objects that were there before.
TEST_F(Objects, AnObjectDefinedWhileOthersRunIsSentInItsOwnTime) {
  cyclic(1024, 1000);
  objects_.start(0);
  EXPECT_EQ(objects_.tick(0, h_), 1000);
  cyclic(1025, 10);
  outbox_.sent.clear();
  EXPECT_EQ(objects_.tick(5, h_), 10);
  EXPECT_TRUE(outbox_.sent.empty());
  EXPECT_EQ(objects_.tick(10, h_), 20);
  ASSERT_EQ(outbox_.sent.size(), 1U);
  EXPECT_EQ(outbox_.sent[0].frame.id, 1025U);
}

// SCOMST STOP: nothing is sent or received, the objects stay and can be started again. What still waits is taken back.
TEST_F(Objects, APauseKeepsTheObjects) {
  cyclic(1024, 10);
  cyclic(1025, 20);
  receive(1026);
  objects_.start(0);
  EXPECT_TRUE(objects_.started());
  EXPECT_EQ(objects_.tick(0, h_), 10);
  outbox_.withdrawn.clear();
  objects_.pause();
  EXPECT_FALSE(objects_.started());
  EXPECT_EQ(outbox_.withdrawn, (std::vector<uint64_t>{100, 101}));
  outbox_.sent.clear();
  EXPECT_EQ(objects_.tick(1, h_), INT64_MAX) << "nothing will be due, also not at 10";
  EXPECT_TRUE(send_times(50).empty());
  EXPECT_FALSE(arrives(1026));
  objects_.start(3);
  EXPECT_TRUE(objects_.started());
  EXPECT_EQ(send_times(35), (std::vector<int64_t>{3, 13, 23, 33}));
  EXPECT_EQ(outbox_.sent.size(), 6U) << "the second one at 3 and 23";
  EXPECT_TRUE(arrives(1026));
}

TEST_F(Objects, AStopTakesBackWhatStillWaits) {
  cyclic(1024, 10);
  cyclic(1025, 20);
  objects_.start(0);
  objects_.tick(0, h_);
  outbox_.withdrawn.clear();
  objects_.stop();
  EXPECT_FALSE(objects_.started());
  EXPECT_EQ(outbox_.withdrawn, (std::vector<uint64_t>{100, 101}));
  objects_.start(0);
  EXPECT_EQ(objects_.tick(0, h_), INT64_MAX) << "all objects are gone";
}

// A telegram that still waits for the bus is overtaken by the next one of its object.
TEST_F(Objects, AnObjectHasOneWaitingTelegram) {
  cyclic(1024, 10);
  cyclic(1025, 20);
  objects_.start(0);
  for (const int64_t tick : {0, 10}) objects_.tick(tick, h_);
  EXPECT_EQ(outbox_.withdrawn, (std::vector<uint64_t>{100, 101, 100}));
}

// Tags of cyclic objects say nothing to the program; a one-shot telegram that failed is taken back.
TEST_F(Objects, OnlyAOneShotTelegramHasAStatus) {
  cyclic(1024, 10);
  objects_.start(0);
  objects_.tick(0, h_);
  outbox_.withdrawn.clear();
  const std::vector<int32_t> before = h_;
  objects_.on_sent(100, h_);
  objects_.on_not_sent(100, h_);
  EXPECT_EQ(h_, before);
  EXPECT_TRUE(outbox_.withdrawn.empty());
  // The structure at H0 has the first of their tags.
  EXPECT_EQ(acyclic(1025, 0), 1);
  const uint64_t tag = outbox_.sent.back().tag;
  objects_.on_not_sent(tag, h_);
  EXPECT_EQ(h_[3], 3);
  EXPECT_EQ(outbox_.withdrawn, std::vector<uint64_t>{tag});
  EXPECT_EQ(acyclic(1025, 10, 4), 1);
  EXPECT_NE(outbox_.sent.back().tag, tag);
  objects_.on_sent(outbox_.sent.back().tag, h_);
  EXPECT_EQ(h_[13], 2);
  EXPECT_EQ(h_[3], 3) << "of the other structure";
}

TEST_F(Objects, AFrameOfAnotherLengthIsTold) {
  receive(1025, 8);
  receive(1026, 4);
  objects_.start(0);
  why_.clear();
  EXPECT_FALSE(arrives(1026, 6));
  EXPECT_EQ(why_,
            "object 402h (1026) came with 6 bytes, its receive object has 4; its variables stay as they are");
  why_.clear();
  EXPECT_FALSE(arrives(1027));
  EXPECT_EQ(why_, "") << "it is for nobody";
}

}  // namespace
}  // namespace ipos::runtime
