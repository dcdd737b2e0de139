// Units with quartzes of their own: `clock_ppm` of a station, and P887, with which the SYNC telegrams of a line hold their
// milliseconds together (MDX60B/61B chapter 5.4.7). Expected values are arithmetic: 1 ppm is a microsecond a second.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <span>

#include "tests/harness/proves.hpp"
#include "tests/runtime/plant/picture.hpp"
#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::kMicrosecond;
using runtime::kMillisecond;
using runtime::kSecond;
using runtime::Plant;
using runtime::Time;

constexpr uint32_t kSyncTelegram = 300, kTelegram = 1100;
constexpr int kPpm[] = {100, -100, 0};

// Units that send a variable each 10 ms, and a control that sends SYNC each 5 ms.
std::unique_ptr<Plant> make_units(std::span<const int> ppm, bool synchronized, const runtime::Execution& execution = {}) {
  std::string text = fmt::format(
      "[[bus]]\nname = 'can'\nkind = 'can'\nbaud = 1000000\n"
      "[[control]]\nname = 'clock'\nsbus = 'can'\nsync = {}\ncycle = '5ms'\n", kSyncTelegram);
  std::map<std::string, std::string> sources;
  for (size_t n = 0; n < ppm.size(); ++n) {
    text += fmt::format(
        "[[station]]\nname = 'u{0}'\nunit = 'mdxb'\nprogram = 'U{0}.IPC'\nsbus = 'can'\nclock_ppm = {1}\n"
        "[station.parameters]\nP881 = {2}\nP884 = '1000 kBaud'\nP885 = {3}\nP887 = {4}\n",
        n, ppm[n], n + 1, kSyncTelegram * 1000, synchronized ? 1 : 0);
    sources[fmt::format("U{}.IPC", n)] = fmt::format(
        "#include <constb.h>\nSCTRCYCL Tr; long n; main() {{ Tr.ObjectNo = {}; Tr.CycleTime = 10; Tr.Format = 4; "
        "Tr.DPointer = numof(n); _SBusCommDef(SCD_TRCYCL, Tr); _SBusCommOn(); while (1) n = n + 1; }}", kTelegram + n);
  }
  return make_plant(text, sources, std::nullopt, execution);
}

std::unique_ptr<Plant> make_three(bool synchronized, const runtime::Execution& execution = {}) {
  return make_units(kPpm, synchronized, execution);
}

// When the telegrams of each identifier were over.
class Heard final : public runtime::BusObserver {
 public:
  void on_message(const runtime::Bus& /*bus*/, const runtime::BusMessage& message) override {
    if (message.frame) ends[message.frame->id].push_back(message.end);
  }
  std::map<uint32_t, std::vector<Time>> ends;
};

// Each unit counts its own milliseconds: after a minute one is 6 ms ahead and one 6 ms behind. Between frames of others a telegram
// may have to wait: three of them and a SYNC, a seventh of a millisecond each at most at 1 MBaud.
TEST(Quartz, TelegramsRunAwayFromEachOther) {
  const auto plant = make_three(false);
  ASSERT_TRUE(plant);
  Heard heard;
  for (const auto& bus : plant->buses()) bus->add_observer(heard);
  plant->run_until(60 * kSecond);
  for (size_t n = 0; n < std::size(kPpm); ++n) {
    const std::vector<Time>& ends = heard.ends[kTelegram + static_cast<uint32_t>(n)];
    ASSERT_GT(ends.size(), 5'990U);
    for (size_t i = 0; i < ends.size(); ++i) {
      const Time expected = static_cast<Time>(i) * (10 * kMillisecond - 10 * kPpm[n]);
      ASSERT_LT(std::abs(ends[i] - ends[0] - expected), 600 * kMicrosecond) << "unit " << n << ", telegram " << i;
    }
  }
}

// With P887 each SYNC shifts the milliseconds towards their place behind it: after half a second (500 us in steps of 20 us, a SYNC each
// 5 ms) all units stand there, and stay, and none of them gains or loses a telegram in two minutes.
TEST(Quartz, SyncHoldsTheMillisecondsOfAllUnitsTogether) {
  PROVES("MDB-TOC-18");
  const auto plant = make_three(true);
  ASSERT_TRUE(plant);
  Heard heard;
  for (const auto& bus : plant->buses()) bus->add_observer(heard);
  plant->run_until(120 * kSecond);
  const std::vector<Time>& syncs = heard.ends[kSyncTelegram];
  ASSERT_EQ(syncs.size(), 24'000U);
  for (size_t n = 0; n < std::size(kPpm); ++n) {
    const std::vector<Time>& ends = heard.ends[kTelegram + static_cast<uint32_t>(n)];
    EXPECT_NEAR(static_cast<double>(ends.size()), 12'000, 1) << "unit " << n;
    for (const Time end : ends) {
      if (end < kSecond / 2) continue;
      const Time sync = *std::prev(std::upper_bound(syncs.begin(), syncs.end(), end));
      const Time phase = (end - sync) % kMillisecond;
      // A tick comes 250 us behind a SYNC and loses 0.5 us on the way to the next one; its telegram may wait for two others.
      ASSERT_GT(phase, 249 * kMicrosecond) << "unit " << n << " at " << end;
      ASSERT_LT(phase, 251 * kMicrosecond + 3 * 150 * kMicrosecond) << "unit " << n << " at " << end;
    }
  }
}

// Without P887 a SYNC shifts nothing, and an exact quartz has nothing to be shifted for but the place of its milliseconds.
TEST(Quartz, OnlyP887ShiftsThem) {
  for (const bool synchronized : {false, true}) {
    constexpr int kExact[] = {0};
    const auto plant = make_units(kExact, synchronized);
    ASSERT_TRUE(plant);
    Heard heard;
    for (const auto& bus : plant->buses()) bus->add_observer(heard);
    plant->run_until(2 * kSecond);
    const std::vector<Time>& ends = heard.ends[kTelegram];
    const Time moved = (ends.back() - ends.front()) % (10 * kMillisecond);
    // Stuffed bits of a frame are a few microseconds.
    EXPECT_EQ(std::min(moved, 10 * kMillisecond - moved) > 100 * kMicrosecond, synchronized) << moved;
  }
}

TEST(Quartz, ALazyRunIsTheSameAsInTurn) {
  for (const bool synchronized : {false, true}) {
    Watched expected(make_three(synchronized, in_turn())), plant(make_three(synchronized));
    for (Time now = 0; now < 3 * kSecond; now += 37'700'000) {
      expected.plant->run_until(now);
      plant.plant->run_until(now);
      ASSERT_NO_FATAL_FAILURE(expect_same(plant, expected, fmt::format("{} at {}", synchronized, now)));
    }
  }
}

}  // namespace
}  // namespace ipos::tests
