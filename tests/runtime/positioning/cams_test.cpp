// Cam controllers (IPOSplus p. 86, 91).
#include "runtime/positioning/cams.hpp"

#include <gtest/gtest.h>

#include <array>

namespace ipos::runtime {
namespace {

struct Variables {
  std::array<int32_t, 512> h{};
  CamSources sources;
  void put(size_t first, std::initializer_list<int32_t> values) {
    std::copy(values.begin(), values.end(), &h[first]);
  }
};

TEST(StandardCam, SetsItsBitInsideItsWindows) {
  for (const int32_t polarity : {0, 1}) {
    Variables v;
    // Source H511, no dead time, bit 3 of H481, two of four windows.
    v.put(100, {511, 0, 481, 3, polarity, 2, 10, 20, 30, 40, 50, 60, 70, 80});
    v.h[481] = 0b1'0001;
    for (int32_t position = 0; position <= 100; ++position) {
      v.h[511] = position;
      ASSERT_TRUE(run_standard_cam(100, v.h, v.sources));
      const bool inside = (position >= 10 && position <= 20) || (position >= 30 && position <= 40);
      ASSERT_EQ(v.h[481], 0b1'0001 | (inside != (polarity == 1) ? 0b1000 : 0)) << position;
    }
  }
}

TEST(StandardCam, LeftMustBeBelowRight) {
  Variables v;
  v.put(100, {511, 0, 481, 0, 0, 2, 20, 10, 30, 30});
  for (const int32_t position : {5, 15, 30}) {
    v.h[511] = position;
    run_standard_cam(100, v.h, v.sources);
    EXPECT_EQ(v.h[481], 0);
  }
}

// 0.1 ms a digit: at 50 increments a ms, 4 ms early are 200 increments.
TEST(StandardCam, SwitchesEarly) {
  Variables v;
  v.put(100, {511, 40, 481, 0, 0, 1, 1'000, 2'000});
  int32_t on = 0, off = 0;
  for (int32_t position = 0; position < 3'000; position += 50) {
    v.h[511] = position;
    v.sources.tick(v.h);
    run_standard_cam(100, v.h, v.sources);
    if (v.h[481] == 1 && on == 0) on = position;
    if (v.h[481] == 0 && on != 0 && off == 0) off = position;
  }
  EXPECT_EQ(on, 800);
  EXPECT_EQ(off, 1'850);
}

TEST(StandardCam, RefusesWhatIsNoVariable) {
  Variables v;
  v.put(100, {512, 0, 481, 0, 0, 1, 0, 10});
  EXPECT_FALSE(run_standard_cam(100, v.h, v.sources));
  v.put(100, {511, 0, -1});
  EXPECT_FALSE(run_standard_cam(100, v.h, v.sources));
  EXPECT_FALSE(run_standard_cam(500, v.h, v.sources)) << "the structure ends behind the variables";
}

// Eight variables are watched, each with its change since the millisecond before. A ninth counts as at rest; a
// variable that is watched again takes no second place.
TEST(CamSources, WatchEightVariables) {
  Variables v;
  for (uint32_t n = 0; n < 9; ++n) v.h[300 + n] = static_cast<int32_t>(n) * 1'000;
  v.h[300] = INT32_MAX;
  for (int times = 0; times < 2; ++times)
    for (uint32_t n = 0; n < 9; ++n) v.sources.watch(300 + n, v.h);
  v.h[300] = INT32_MIN;  // one further: the count wraps
  for (uint32_t n = 1; n < 9; ++n) v.h[300 + n] += n % 2 == 0 ? static_cast<int32_t>(n) : -7;
  v.sources.tick(v.h);
  EXPECT_EQ(v.sources.change(300), 1);
  for (uint32_t n = 1; n < 8; ++n)
    EXPECT_EQ(v.sources.change(300 + n), n % 2 == 0 ? static_cast<int32_t>(n) : -7) << n;
  EXPECT_EQ(v.sources.change(308), 0) << "the ninth";
  EXPECT_EQ(v.sources.change(400), 0) << "never watched";
  v.sources.tick(v.h);
  for (uint32_t n = 0; n < 8; ++n) EXPECT_EQ(v.sources.change(300 + n), 0) << "at rest now";
}

// GSCAM has 14 elements, GSCAM_EXT 16, CAM_OUTPUT 10 (IPOSplus p. 86, 91): they may end with the last variable.
TEST(CamStructures, EndWithTheLastVariable) {
  Variables v;
  v.put(498, {300, 0, 200, 0, 0, 1, 0, 10});
  EXPECT_TRUE(run_standard_cam(498, v.h, v.sources));
  EXPECT_EQ(v.h[200], 1);
  EXPECT_FALSE(run_standard_cam(499, v.h, v.sources));
  EXPECT_FALSE(run_standard_cam(UINT32_MAX, v.h, v.sources));
  ExtendedCams cams;
  EXPECT_FALSE(cams.start(497, v.h, v.sources));
  EXPECT_FALSE(cams.start(UINT32_MAX, v.h, v.sources));
  EXPECT_TRUE(cams.start(496, v.h, v.sources));

  for (const int32_t output : {502, 503}) {
    Variables last;
    ExtendedCams one;
    last.put(100, {INT32_MIN + 3, 0, 0, 0, 0, INT32_MIN + 300, 200, 1, output});
    last.put(static_cast<size_t>(output), {0, 1, 0, 10});
    ASSERT_TRUE(one.start(100, last.h, last.sources));
    EXPECT_EQ(one.tick(last.h, last.sources, {true, 0}), output == 502);
    EXPECT_EQ(last.h[200], output == 502 ? 1 : 0);
    EXPECT_EQ(one.runs(), output == 502) << "else it is stopped";
  }
}

// Four controllers; one that is started again is the same.
TEST(ExtendedCam, FourOfThemRun) {
  Variables v;
  ExtendedCams cams;
  for (int times = 0; times < 5; ++times) EXPECT_TRUE(cams.start(100, v.h, v.sources));
  for (const uint32_t structure : {120U, 140U, 160U}) EXPECT_TRUE(cams.start(structure, v.h, v.sources));
  EXPECT_FALSE(cams.start(180, v.h, v.sources));
  for (const uint32_t structure : {100U, 120U, 140U, 160U})
    EXPECT_TRUE(cams.start(structure, v.h, v.sources));
}

constexpr int32_t bits(uint32_t value) { return static_cast<int32_t>(value); }

struct Extended : Variables {
  static constexpr uint32_t kStructure = 100, kData = 130;

  // Eight outputs; number n is on in n x 100 .. n x 100 + 50.
  explicit Extended(uint32_t state, int32_t count = 8) {
    put(kStructure, {bits(state), 0, 4, 0, 0, 0, 200, count});
    for (int32_t n = 0; n < 8; ++n) {
      const size_t data = kData + static_cast<size_t>(n) * 10;
      h[kStructure + 8 + static_cast<size_t>(n)] = static_cast<int32_t>(data);
      put(data, {0, 1, n * 100, n * 100 + 50});
    }
    EXPECT_TRUE(cams.start(kStructure, h, sources));
  }
  int32_t at(int32_t position, uint64_t ms = 0, bool referenced = true) {
    h[511] = position;
    EXPECT_TRUE(cams.tick(h, sources, {referenced, ms}));
    return h[200];
  }
  ExtendedCams cams;
};

TEST(ExtendedCam, ShiftsItsOutputs) {
  Extended cam(0x8000'0003);
  cam.h[200] = bits(0xF000'000F);
  EXPECT_EQ(cam.at(20), bits(0xF000'001F)) << "bits that are no outputs stay";
  EXPECT_EQ(cam.at(320), bits(0xF000'008F));
  EXPECT_EQ(cam.at(720), bits(0xF000'080F));
  EXPECT_EQ(cam.at(70), bits(0xF000'000F));
}

TEST(ExtendedCam, States) {
  Extended cam(0x8000'0002);
  EXPECT_EQ(cam.at(20, 0, false), 0);
  EXPECT_EQ(cam.at(20), 1 << 4);
  cam.h[100] = bits(0x8000'0000);
  EXPECT_EQ(cam.at(70), 1 << 4) << "inactive: the outputs keep their state";
  cam.h[100] = bits(0x8000'0001);
  EXPECT_EQ(cam.at(20), 0) << "all off";
  cam.h[100] = 3;
  EXPECT_EQ(cam.at(20), 0) << "without bit 31 nothing is done";
  cam.h[100] = bits(0x8000'0003);
  EXPECT_EQ(cam.at(20, 0, false), 1 << 4);
}

TEST(ExtendedCam, OutputsBehindTheirNumberAreLeftAlone) {
  Extended cam(0x8000'0003, 2);
  EXPECT_EQ(cam.at(120), 1 << 5);
  EXPECT_EQ(cam.at(220), 0) << "the third is not in use";
  cam.h[200] = 1 << 6;
  EXPECT_EQ(cam.at(20), (1 << 6) | (1 << 4)) << "nor is its bit";
  Extended none(0x8000'0003, 0);
  EXPECT_EQ(none.at(20), 0);
}

TEST(ExtendedCam, ForceOffWinsOverForceOn) {
  Extended cam(0x8000'0003);
  cam.h[103] = 0b110;
  cam.h[104] = 0b011;
  EXPECT_EQ(cam.at(20), 0b100 << 4);
}

TEST(ExtendedCam, FourOutputsAMillisecondTheOthersEveryFour) {
  Extended cam(0x8000'0003);
  cam.at(20, 0);
  for (uint64_t ms = 1; ms < 4; ++ms) {
    EXPECT_EQ(cam.at(120, ms), 1 << 5);
    EXPECT_EQ(cam.at(520, ms), 0) << "output 5 waits";
  }
  EXPECT_EQ(cam.at(520, 4), 1 << 9);
}

// Each output by itself: 0 to 3 in every millisecond, 4 to 7 in every fourth.
TEST(ExtendedCam, EachOutputAtItsRate) {
  for (int32_t output = 0; output < 8; ++output)
    for (uint64_t ms = 1; ms <= 8; ++ms) {
      Extended cam(0x8000'0003);
      cam.at(70, 0);
      const bool shows = output < 4 || ms % 4 == 0;
      EXPECT_EQ(cam.at(output * 100 + 20, ms), shows ? 1 << (4 + output) : 0) << output << " at " << ms << " ms";
    }
}

// With bit 31 CamSource is the number of a variable, whatever it is; without it there are three encoders (p. 91).
TEST(ExtendedCam, EveryVariableMayBeTheSource) {
  for (size_t n = 220; n < 512; ++n) {
    Extended cam(0x8000'0003, 1);
    cam.h.fill(60);  // beside the window
    const Extended fresh(0x8000'0003, 1);
    std::copy_n(fresh.h.begin(), 220, cam.h.begin());
    cam.h[105] = bits(static_cast<uint32_t>(0x8000'0000 + n));
    cam.h[n] = 20;
    EXPECT_TRUE(cam.cams.tick(cam.h, cam.sources, {true, 0}));
    EXPECT_EQ(cam.h[200], 1 << 4) << n;
  }
  for (const uint32_t none : {3U, 511U, 0x7FFF'FFFFU, 0x8000'0200U, 0xC000'0000U, 0xFFFF'FFFFU}) {
    Extended cam(0x8000'0003, 1);
    cam.h[105] = bits(none);
    EXPECT_FALSE(cam.cams.tick(cam.h, cam.sources, {true, 0})) << none;
  }
}

// CamSource 0, 1 and 2 are the encoders of the motor H511, the external H510 and the absolute one H509 (p. 91).
TEST(ExtendedCam, EncodersAreSources) {
  for (const int32_t source : {0, 1, 2}) {
    Extended cam(0x8000'0003, 1);
    cam.h[105] = source;
    for (const size_t encoder : {509U, 510U, 511U}) cam.h[encoder] = 999;
    cam.h[static_cast<size_t>(511 - source)] = 20;
    EXPECT_TRUE(cam.cams.tick(cam.h, cam.sources, {true, 0}));
    EXPECT_EQ(cam.h[200], 1 << 4) << source;
  }
}

// The bit of GSCAM is one of 32, and its destination any variable (p. 86).
TEST(StandardCam, EveryBitOfEveryDestination) {
  for (int32_t bit = 0; bit < 32; ++bit)
    for (const int32_t destination : {0, 1, 99, 120, 511})
      for (const uint32_t before : {0U, 0x5A5A'5A5AU, 0xFFFF'FFFFU}) {
        Variables v;
        v.put(100, {300, 0, destination, bit, 0, 1, 10, 20});
        for (const int32_t position : {9, 10, 20, 21}) {
          v.h[300] = position;
          v.h[static_cast<size_t>(destination)] = static_cast<int32_t>(before);
          ASSERT_TRUE(run_standard_cam(100, v.h, v.sources));
          const uint32_t mask = 1U << bit;
          const uint32_t want = position == 10 || position == 20 ? before | mask : before & ~mask;
          ASSERT_EQ(static_cast<uint32_t>(v.h[static_cast<size_t>(destination)]), want) << bit << destination;
        }
      }
}

TEST(ExtendedCam, SourcesAndDeadTime) {
  Extended cam(0x8000'0003, 1);
  cam.h[105] = 1;
  cam.h[510] = 20;
  EXPECT_EQ(cam.at(999), 1 << 4);
  cam.h[105] = bits(0x8000'0000 + 300);
  cam.h[300] = 60;
  EXPECT_EQ(cam.at(999), 0);
  cam.h[300] = 30;
  EXPECT_EQ(cam.at(999), 1 << 4);
  cam.h[105] = 3;  // the virtual encoder is not simulated
  EXPECT_FALSE(cam.cams.tick(cam.h, cam.sources, {true, 0}));
}

}  // namespace
}  // namespace ipos::runtime
