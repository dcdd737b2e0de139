// What may differ between two ticks of a drive at rest.
#include "runtime/drive/rest.hpp"

namespace ipos::runtime {
namespace {

template <class Member>
size_t offset_of(const Drive& drive, const Member& member) {
  return static_cast<size_t>(reinterpret_cast<const std::byte*>(&member) -
                             reinterpret_cast<const std::byte*>(&drive));
}

}  // namespace

void DriveRest::note(const Drive& drive) {
  before_.note(drive);
  parameters_ = drive.parameters_.changes();
}

uint64_t DriveRest::ticks(const Drive& drive) const {
  // A limit that is exceeded would show when it no longer is.
  const AxisState& shown = drive.axis_.state();
  if (shown.heat_sink > Drive::kOvertemperature || shown.motor_utilization >= Drive::kFullUtilization)
    return 0;
  if (drive.parameters_.changes() != parameters_) return 0;

  const size_t axis = offset_of(drive, drive.axis_), behind_axis = axis + sizeof drive.axis_;
  const size_t counter = offset_of(drive, drive.mains_ms_), behind_counter = counter + sizeof drive.mains_ms_;
  static_assert(std::is_trivially_copyable_v<Axis>);
  Axis cooled = drive.axis_;
  std::memcpy(static_cast<void*>(&cooled), before_.at(axis), sizeof cooled);
  cooled.cool(1);
  if (std::memcmp(&cooled, &drive.axis_, sizeof cooled) != 0) return 0;
  if (!before_.same(drive, 0, axis) || !before_.same(drive, behind_axis, counter) ||
      !before_.same(drive, behind_counter))
    return 0;
  return Drive::kMinuteMs - 1 - drive.mains_ms_;
}

void DriveRest::skip(Drive& drive, uint64_t ticks) {
  drive.mains_ms_ += static_cast<uint32_t>(ticks);
  drive.axis_.cool(ticks);
}

}  // namespace ipos::runtime
