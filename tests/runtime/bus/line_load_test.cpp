// The load of a line second by second, against a count of every occupied unit.
#include "runtime/bus/line/line_load.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace ipos::tests {
namespace {

using runtime::LineLoad;
using runtime::LoadMeter;

constexpr uint64_t kRate = 50;  // units a second

// Which units are occupied, one by one.
class CountedUnits {
 public:
  void add(uint64_t begin, uint64_t count) {
    for (uint64_t n = begin; n < begin + count; ++n) ++seconds_.at(n / kRate);
    busy_ += count;
  }
  LineLoad load(uint64_t elapsed) const {
    LineLoad out;
    out.busy_bits = busy_;
    out.elapsed_bits = elapsed;
    out.percent = elapsed == 0 ? 0 : static_cast<uint32_t>(busy_ * 100 / elapsed);
    const uint64_t complete = elapsed / kRate;
    if (complete > 0) out.window_percent = share(seconds_.at(complete - 1));
    for (uint64_t n = 0; n < complete; ++n)
      out.peak_window_percent = std::max(out.peak_window_percent, share(seconds_.at(n)));
    return out;
  }

 private:
  static uint32_t share(uint64_t busy) { return static_cast<uint32_t>(busy * 100 / kRate); }
  std::vector<uint64_t> seconds_ = std::vector<uint64_t>(64);
  uint64_t busy_ = 0;
};

void expect_same(const LoadMeter& meter, const CountedUnits& counted, uint64_t elapsed) {
  const LineLoad found = meter.load(elapsed);
  const LineLoad expected = counted.load(elapsed);
  EXPECT_EQ(found.busy_bits, expected.busy_bits) << elapsed;
  EXPECT_EQ(found.elapsed_bits, elapsed);
  EXPECT_EQ(found.percent, expected.percent) << elapsed;
  EXPECT_EQ(found.window_percent, expected.window_percent) << elapsed;
  EXPECT_EQ(found.peak_window_percent, expected.peak_window_percent) << elapsed;
  EXPECT_EQ(found.frames, 0U);
}

using Frames = std::vector<std::pair<uint64_t, uint64_t>>;

// Asked from the begin of each frame to three seconds behind the last, a frame being counted as it begins: its end,
// with the intermission, may lie in the next second.
void expect_counted(const Frames& frames) {
  LoadMeter meter(kRate);
  CountedUnits counted;
  expect_same(meter, counted, 0);
  expect_same(meter, counted, 130);
  for (size_t n = 0; n < frames.size(); ++n) {
    meter.add(frames[n].first, frames[n].second);
    counted.add(frames[n].first, frames[n].second);
    const uint64_t until = n + 1 < frames.size() ? frames[n + 1].first : frames[n].first + 4 * kRate;
    for (uint64_t now = frames[n].first; now <= until; ++now) expect_same(meter, counted, now);
  }
}

TEST(LineLoad, CountsEverySecond) {
  expect_counted({});
  expect_counted({{0, 1}});
  expect_counted({{0, 50}});
  expect_counted({{49, 1}});
  expect_counted({{10, 20}, {60, 40}, {100, 10}});
  expect_counted({{10, 20}, {110, 30}});
  expect_counted({{10, 40}, {160, 30}, {310, 10}});
  expect_counted({{0, 50}, {50, 50}, {100, 50}, {150, 49}});
}

TEST(LineLoad, KnowsTheSecondBeforeWhileAFrameReachesIntoTheNext) {
  expect_counted({{40, 20}});
  expect_counted({{0, 25}, {60, 10}, {95, 10}});
  expect_counted({{0, 45}, {45, 10}, {90, 20}, {145, 10}, {195, 6}});
  expect_counted({{0, 45}, {149, 2}, {199, 30}});
  expect_counted({{20, 10}, {99, 2}, {249, 2}, {299, 50}});
  expect_counted({{20, 10}, {149, 50}});
  expect_counted({{1, 49}, {149, 50}});
}

TEST(LineLoad, OfFramesOfEveryLengthAtEveryPlace) {
  for (uint64_t length = 1; length <= 43; length += 7)
    for (uint64_t first = 0; first < 50; first += 11)
      for (uint64_t pause = 0; pause <= 150; pause += 29) {
        Frames frames;
        for (uint64_t at = first; at < 400; at += length + pause) frames.emplace_back(at, length);
        expect_counted(frames);
      }
}

}  // namespace
}  // namespace ipos::tests
