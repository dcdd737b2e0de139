// Parts are kept by where they lie on the belt, so that moving it is one sum however many there are.
#include "runtime/plant/belt.hpp"

#include <algorithm>
#include <cmath>

namespace ipos::runtime {

Belt::Belt(const DrivenMachine& machine)
    : machine_(machine),
      length_(way_to(machine.travel->to)),
      part_length_(way_to(machine.travel->from + machine.part_length)),
      pitch_(machine.feed == 0 ? 0 : std::max<int64_t>(way_to(machine.travel->from + machine.feed), 1)) {
  for (const double front : machine.parts) parts_.push_back(way_to(front));
}

int64_t Belt::way_to(double place) const {
  return std::llround((place - machine_.travel->from) * kShaftTurn / std::abs(machine_.per_turn));
}

void Belt::move(int32_t shaft) {
  // The count wraps, the way does not.
  const auto way = static_cast<int32_t>(static_cast<uint32_t>(shaft) - static_cast<uint32_t>(shaft_.value_or(shaft)));
  shaft_ = shaft;
  moved_ += machine_.per_turn < 0 ? -int64_t{way} : int64_t{way};
  // A belt that went back brings its parts again, not new ones.
  for (; pitch_ != 0 && moved_ >= next_; next_ += pitch_) parts_.push_back(-next_);
  std::erase_if(parts_, [&](int64_t part) {
    const int64_t front = part + moved_;
    return front - part_length_ > length_ || front < -part_length_;
  });
}

bool Belt::covers(int64_t way) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](int64_t part) {
    return way <= part + moved_ && way >= part + moved_ - part_length_;
  });
}

std::vector<double> Belt::fronts() const {
  std::vector<double> fronts;
  for (const int64_t part : parts_)
    fronts.push_back(machine_.travel->from + static_cast<double>(part + moved_) * std::abs(machine_.per_turn) / kShaftTurn);
  return fronts;
}

}  // namespace ipos::runtime
