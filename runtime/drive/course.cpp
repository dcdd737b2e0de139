// What may differ between two ticks of a drive on its course, and for how many more it may.
#include "runtime/drive/course.hpp"

#include <algorithm>

namespace ipos::runtime {
namespace {

template <class Member>
size_t offset_of(const Drive& drive, const Member& member) {
  return static_cast<size_t>(reinterpret_cast<const std::byte*>(&member) -
                             reinterpret_cast<const std::byte*>(&drive));
}

template <class T>
bool same_bytes(const T& a, const T& b) {
  return std::memcmp(static_cast<const void*>(&a), static_cast<const void*>(&b), sizeof(T)) == 0;
}

}  // namespace

// Byte by byte, as what lies between the members is compared, too.
template <class Member>
Member DriveCourse::noted(const Drive& drive, const Member& member) const {
  static_assert(std::is_trivially_copyable_v<Member>);
  Member copy = member;
  std::memcpy(static_cast<void*>(&copy), before_.at(offset_of(drive, member)), sizeof(Member));
  return copy;
}

uint32_t DriveCourse::ticks(const Drive& drive) const {
  // A limit that is, or will be, exceeded shows when it is.
  const Axis& axis = drive.axis_;
  axis.state();  // nothing is left to be computed later
  if (axis.heat_sink_ahead() > Drive::kOvertemperature ||
      axis.motor_utilization_ahead() >= Drive::kFullUtilization)
    return 0;
  if (!drive.calm_ || drive.now_.changed() || drive.settings_version_ != drive.parameters_.changes())
    return 0;

  Axis moved = noted(drive, axis);
  moved.go_on(1);
  moved.state();
  if (!same_bytes(moved, axis)) return 0;
  auto watches = noted(drive, drive.watches_);
  for (size_t n = 0; n < watches.size(); ++n) watches[n].go_on(drive.decisions_.links[n], 1);
  if (!same_bytes(watches, drive.watches_)) return 0;

  struct Part {
    size_t begin, end;
  };
  const auto part = [&](const auto& member) {
    const size_t begin = offset_of(drive, member);
    return Part{begin, begin + sizeof member};
  };
  std::array parts{part(drive.axis_), part(drive.watches_), part(drive.mains_ms_), part(drive.enabled_ms_),
                   part(drive.counted_energy_)};
  std::ranges::sort(parts, {}, &Part::begin);
  size_t begin = 0;
  for (const Part& moving : parts) {
    if (!before_.same(drive, begin, moving.begin)) return 0;
    begin = moving.end;
  }
  if (!before_.same(drive, begin)) return 0;

  // Up to what counting leads to: a digit of P015, P016, P017, a telegram that is missed.
  uint64_t ticks = Drive::kMinuteMs - 1 - std::max(drive.mains_ms_, drive.enabled_ms_);
  const int64_t energy = Drive::kEnergyDigit - 1 - (axis.state().energy - drive.counted_energy_);
  ticks = std::min(ticks, static_cast<uint64_t>(std::max<int64_t>(energy, 0) / axis.energy_ahead()));
  for (size_t n = 0; n < watches.size(); ++n)
    ticks = std::min(ticks, drive.watches_[n].ticks_left(drive.decisions_.links[n]));
  return static_cast<uint32_t>(ticks);
}

}  // namespace ipos::runtime
