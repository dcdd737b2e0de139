// A travel between two events: the positioner leads the drive for several milliseconds. Nothing is concluded of them in advance
// but what they have in common; each is calculated as every other one, and the first in which more could happen is left to the plain way.
#include "runtime/drive/drive_following.hpp"
#include "runtime/positioning/positioner_leading.hpp"
#include "runtime/services/positioning_service.hpp"

namespace ipos::runtime {

Ticks PositioningService::lead_on(uint32_t syncs, Ticks most) {
  if (!had_only_moved() || !Positioner::Leading::possible(positioner_)) return 0;
  Positioner::Leading leading(positioner_);
  most = drive_.following_ticks(ordered_, leading.left(most));
  if (most == 0) return 0;
  Drive::Following drive(drive_);
  Ticks done = 0;
  while (done != most) {
    const Positioner::Leading::Place place = leading.next();
    const int32_t speed = leading.speed(place);
    if (!drive.go(speed)) break;
    ++done;
    ordered_.speed = speed;
    if (!leading.observe(place, drive.position()) || !drive.goes_on()) break;
  }
  if (done == 0) return 0;  // nothing has changed
  syncs_ = syncs;
  leading.finish();
  drive.finish(ordered_, done);
  return done;
}

}  // namespace ipos::runtime
