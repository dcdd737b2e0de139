// The path of the master, a straight line from telegram to telegram.
#include "runtime/positioning/follower.hpp"

namespace ipos::runtime {
namespace {

// Increments that a master may go before its count is brought back; 63 days at 6000 rpm.
constexpr int64_t kFar = int64_t{1} << 41;
// No axis is so fast; a gear may ask for any way.
constexpr Wide kFastest = Wide{1} << (32 + kFineBits);

}  // namespace

// The line leads to where the master will be at the next telegram if it goes on as in the last cycle; so the
// slave is behind by what it accelerates within a cycle, and nothing adds up.
void Follower::take(int32_t position) {
  const int64_t way = wrapped(int64_t{position} - last_);
  last_ = position;
  if (syncs_ == 0) {
    reported_ = position;
    path_ = from_ = to_ = fine(reported_);
  } else {
    reported_ += way;
    if (magnitude(reported_) >= kFar) {
      const int64_t change = wrapped(reported_) - reported_;
      reported_ += change;
      path_ += fine(change);
    }
    cycle_ = std::max(since_, 1);
    from_ = path_;
    to_ = fine(reported_ + way);
  }
  since_ = 0;
  if (syncs_ < kEnough) ++syncs_;
}

Wide Follower::scaled(Fine way, const MasterInputs& inputs) {
  const Wide product = Wide{way} * inputs.gear_slave;
  const Wide by = inputs.gear_master;
  const Wide whole_part = product / by;
  return product % by != 0 && (product < 0) != (by < 0) ? whole_part - 1 : whole_part;
}

void Follower::advance(const MasterInputs& inputs) {
  const Wide before = scaled(path_, inputs);
  ++since_;
  path_ = from_ + static_cast<Fine>(Wide{to_ - from_} * since_ / cycle_);
  step_ = static_cast<Fine>(std::clamp(scaled(path_, inputs) - before, -kFastest, kFastest));
  if (since_ <= kLost * cycle_ || syncs_ < 2) return;
  syncs_ = 0;
  step_ = 0;
}

}  // namespace ipos::runtime
