// Adds up frames.
#include "runtime/bus/log/bus_load.hpp"

#include <algorithm>

#include "runtime/bus/can/frame_bits.hpp"

namespace ipos::runtime {
namespace {

// A log whose time jumps by days must not make a window for each second of them.
constexpr Time kLongestGap = 3600 * kSecond;
// Nor must many jumps together: after so many windows seconds without frames get none (ours).
constexpr size_t kMostWindows = 100'000;

}  // namespace

void LoadCount::add(const Frame& frame) {
  ++frames;
  const uint32_t bytes = frame.remote ? 0U : frame.length;
  data_bits += 8 * bytes;
  exact_bits += frame_bits(frame);
  worst_bits += worst_case_bits(bytes, frame.extended);
}

uint64_t LoadCount::percent_hundredths(uint64_t bits, uint32_t baud, Time span) {
  if (span <= 0) return 0;
  const uint64_t carried = static_cast<uint64_t>(span / kMicrosecond) * baud / 1'000'000;
  return carried == 0 ? 0 : (bits * 10'000 + carried / 2) / carried;
}

void BusLoad::add(Time time, const Frame& frame) {
  last_ = std::max(last_, time);
  if (windows_.empty()) {
    last_ = time;
    windows_.push_back({time, {}});
  }
  const Time gap = time - windows_.back().start;
  if (gap > kLongestGap || (gap >= kSecond && windows_.size() >= kMostWindows))
    windows_.push_back({time, {}});
  while (time - windows_.back().start >= kSecond) windows_.push_back({windows_.back().start + kSecond, {}});
  windows_.back().count.add(frame);
  identifiers_[{frame.id, frame.extended}].add(frame);
  total_.add(frame);
}

}  // namespace ipos::runtime
