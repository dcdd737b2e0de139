// The receiver by octets and by bit times: gaps, idle before requests, damaged characters, and that it gives
// back what was sent however the octets fall.
#include "runtime/bus/profibus/fdl_receiver.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "tests/runtime/bus/profibus/octets.hpp"

namespace ipos::tests {
namespace {

using runtime::Character;
using runtime::kMillisecond;
using runtime::kSecond;
using runtime::Time;

constexpr uint32_t kBaud = 500'000;
constexpr Time kBit = 2'000;  // nanoseconds at 500 kbaud

struct Bench {
  FdlReceiver receiver{strict_limits(kBaud)};
  Time now = kMillisecond;
  std::vector<Reception> heard;

  void feed(uint8_t data, bool parity_error = false, bool framing_error = false) {
    Character character;
    character.start = now;
    character.end = now += 11 * kBit;
    character.data = data;
    character.parity_error = parity_error;
    character.framing_error = framing_error;
    for (Reception& reception : receiver.take(character)) heard.push_back(std::move(reception));
  }
  void feed(const Octets& octets) {
    for (const uint8_t octet : octets) feed(octet);
  }
  void idle(Time bits) { now += bits * kBit; }

  // The errors heard, "-" for a frame.
  std::string errors() const {
    std::string text;
    for (const Reception& reception : heard) {
      if (!text.empty()) text += "; ";
      text += reception.frame ? "-" : frame_error_text(reception.frame.error());
    }
    return text;
  }
};

const Octets kRequest = hex("68 05 05 68 88 81 6D 3C 3E F0 16");
const Octets kAnswer = hex("68 0B 0B 68 81 88 08 3E 3C 02 05 00 FF 80 E0 F1 16");

TEST(FdlReceiver, RequestAnswerToken) {
  Bench bench;
  bench.feed(kRequest);
  bench.idle(11);
  bench.feed(kAnswer);
  bench.idle(33);
  bench.feed(hex("DC 02 01"));
  bench.idle(33);
  bench.feed(hex("10 03 02 49 4E 16"));
  bench.idle(11);
  bench.feed(hex("E5"));
  EXPECT_EQ(bench.errors(), "-; -; -; -; -");
  EXPECT_EQ(bench.heard[1].octets, kAnswer);
  EXPECT_EQ(bench.heard[0].start, kMillisecond);
  EXPECT_EQ(bench.heard[0].end, kMillisecond + 11 * 11 * kBit);
}

TEST(FdlReceiver, IdleBeforeARequest) {
  for (const auto& [bits, text] :
       {std::pair<Time, std::string>{32, "less than 33 idle bits before the frame"}, {33, "-"}, {34, "-"}})
    for (const Octets& frame : {kRequest, hex("DC 02 01"), hex("10 03 02 49 4E 16")}) {
      Bench bench;
      bench.feed(kAnswer);
      bench.idle(bits);
      bench.feed(frame);
      EXPECT_EQ(bench.errors(), "-; " + text) << bits;
    }
}

TEST(FdlReceiver, GapsBreakAFrame) {
  for (size_t at = 1; at < kRequest.size(); ++at)
    for (const auto& [bits, text] :
         {std::pair<Time, std::string>{0, "-"}, {1, "-"}, {2, "gap within the frame"}}) {
      Bench bench;
      bench.feed({kRequest.begin(), kRequest.begin() + static_cast<long>(at)});
      bench.idle(bits);
      bench.feed({kRequest.begin() + static_cast<long>(at), kRequest.end()});
      EXPECT_EQ(bench.errors(), text) << at << ' ' << bits;
      bench.idle(33);
      bench.feed(kRequest);
      EXPECT_EQ(bench.errors(), text + "; -");  // and the line is well again
    }
}

TEST(FdlReceiver, CutFrameEndsWithTheNextOne) {
  Bench bench;
  bench.feed(hex("68 05 05 68"));
  EXPECT_TRUE(bench.receiver.receiving());
  bench.idle(40);
  bench.feed(hex("E5"));
  EXPECT_EQ(bench.errors(), "gap within the frame; -");
}

TEST(FdlReceiver, DamagedCharacters) {
  for (size_t bad = 0; bad < kRequest.size(); ++bad)
    for (const bool framing : {false, true}) {
      Bench bench;
      for (size_t n = 0; n < kRequest.size(); ++n)
        bench.feed(kRequest[n], n == bad && !framing, n == bad && framing);
      EXPECT_EQ(bench.errors(), framing ? "character frame error" : "parity error");
      bench.idle(11);
      bench.feed(hex("E5"));  // nothing counts before the line has been idle
      EXPECT_EQ(bench.heard.size(), 1U);
      bench.idle(33);
      bench.feed(kRequest);
      EXPECT_EQ(bench.heard.size(), 2U);
      EXPECT_TRUE(bench.heard.back().frame.has_value());
    }
}

TEST(FdlReceiver, DoesNotWaitForALengthThatCannotBe) {
  Bench bench;
  bench.feed(hex("68 FF"));
  EXPECT_EQ(bench.errors(), "length octet out of range");
  EXPECT_FALSE(bench.receiver.receiving());
}

// Of a port the times are those of the arrival: lumps with no time between, and pauses of milliseconds.
TEST(FdlReceiver, LumpsFromAPort) {
  FdlReceiver receiver(kPortLimits);
  size_t frames = 0;
  Time now = 0;
  for (int n = 0; n < 3; ++n) {
    for (const Octets& octets : {kRequest, kAnswer, hex("E5"), hex("DC 02 01")}) {
      size_t at = 0;
      for (const uint8_t octet : octets) {
        if (++at == 4) now += 3 * kMillisecond;  // in two lumps
        Character character;
        character.start = character.end = now;
        character.data = octet;
        for (const Reception& reception : receiver.take(character)) frames += reception.frame.has_value();
      }
    }
  }
  EXPECT_EQ(frames, 12U);
}

RC_GTEST_PROP(FdlReceiverProperty, GivesBackWhatWasSentAfterAnyNoise, ()) {
  Bench bench;
  const Octets noise = *rc::gen::container<std::vector<uint8_t>>(rc::gen::arbitrary<uint8_t>());
  for (const uint8_t octet : noise) {
    bench.idle(*rc::gen::inRange(0, 40));
    bench.feed(octet, *rc::gen::inRange(0, 8) == 0, *rc::gen::inRange(0, 16) == 0);
  }
  for (const Reception& reception : bench.heard)
    if (reception.frame) RC_ASSERT(encode(*reception.frame) == reception.octets);
  bench.idle(33);
  bench.heard.clear();
  bench.feed(kRequest);
  RC_ASSERT(!bench.heard.empty());
  RC_ASSERT(bench.heard.back().frame.has_value());
  RC_ASSERT(bench.heard.back().octets == kRequest);
}

}  // namespace
}  // namespace ipos::tests
