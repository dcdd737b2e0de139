// What seldom happens to the ranking: a node joins in front of others, or one that is not the first leaves.
#include "runtime/bus/can/contenders.hpp"

#include <cassert>

namespace ipos::runtime {

void Contenders::insert_between(uint64_t rank) {
  if (end_ == ranks_.size()) {  // at least half of it is free
    std::copy(at(first_), at(end_), at(0));
    end_ -= std::exchange(first_, 0);
  }
  assert(end_ < ranks_.size());
  if (first_ > 0 && rank < ranks_[first_]) {
    ranks_[--first_] = rank;
    return;
  }
  const auto place = std::upper_bound(at(first_), at(end_), rank);
  std::copy_backward(place, at(end_), at(end_ + 1));
  *place = rank;
  ++end_;
}

void Contenders::erase_between(uint64_t rank) {
  const auto place = std::lower_bound(at(first_), at(end_), rank);
  assert(place != at(end_) && *place == rank);
  std::copy(place + 1, at(end_), place);
  --end_;
}

}  // namespace ipos::runtime
