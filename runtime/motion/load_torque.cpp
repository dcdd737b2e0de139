// A square and a sine.
#include "runtime/motion/load_torque.hpp"

#include <algorithm>

namespace ipos::runtime {
namespace {

constexpr int kBits = 20;
constexpr int64_t kOne = int64_t{1} << kBits;

}  // namespace

// The series to the ninth power within a quarter of a turn: wrong by less than 4 of 2^20.
int64_t sine(uint32_t angle) {
  constexpr int64_t kHalfPi = 1'647'099;  // x 2^20
  const auto part = static_cast<int64_t>(angle & 0x3FFFFFFF);
  const bool mirrored = (angle & 0x40000000) != 0;
  const int64_t quarter = (mirrored ? 0x40000000 - part : part) >> (30 - kBits);
  const int64_t x = quarter * kHalfPi >> kBits, square = x * x >> kBits;
  int64_t sum = kOne;
  for (const int64_t divisor : {72, 42, 20, 6}) sum = kOne - (square * sum >> kBits) / divisor;
  const int64_t value = x * sum >> kBits;
  return (angle & 0x80000000) != 0 ? -value : value;
}

int64_t load_torque(const MachineData& machine, FineSpeed speed, int32_t place) {
  if (machine.load_shape == LoadShape::Constant) return machine.load_torque;
  if (machine.load_shape == LoadShape::ByPosition) {
    constexpr int64_t kIncrement = int64_t{1} << 20;  // of 2^32 a turn of the motor
    const auto angle = static_cast<uint32_t>(int64_t{place} * kIncrement / 1'000 * machine.load_turns);
    return machine.load_torque * sine(angle) >> kBits;
  }
  constexpr int64_t kTimesRated = 30;  // where the square ends
  const int64_t rated = std::max(1, machine.rated_speed - machine.rated_slip);
  const int64_t share = std::clamp<int64_t>(whole_speed(speed) * kOne / rated, -kTimesRated * kOne, kTimesRated * kOne);
  const int64_t square = (share < 0 ? -share : share) * share >> kBits;
  return std::clamp<int64_t>(machine.load_torque * square >> kBits, -kTopTorque, kTopTorque);
}

}  // namespace ipos::runtime
