// Variables that grow together: the number of an element that a loop moves by 3 where it moves its counter by 1 is bounded as the counter is.
#include <algorithm>

#include "compiler/analysis/values.hpp"

namespace ipos::compiler::analysis {
namespace {

constexpr size_t kMostTogether = 16;  // in one loop
constexpr int kMostWidened = 6;  // times, where a loop is entered with other beginnings

}  // namespace

Interval Values::Copy::bounds(const Interval& of_value) const {
  const int64_t one = factor * of_value.least, other = factor * of_value.most;
  return {std::min(one, other) + more.least, std::max(one, other) + more.most};
}

void Values::tighten(State& state) {
  for (const Copy& copy : state.copies) {
    const Interval bounds = copy.bounds(state.values[copy.of]);
    Interval& value = state.values[copy.copy];
    const Interval both{std::max(value.least, bounds.least), std::min(value.most, bounds.most)};
    if (!both.is_empty()) value = both;
  }
}

// What has gone on by the same, or a multiple of it, as what ends the loop: one of these had one value before, and has another one after the
// turn.
std::vector<Values::Copy> Values::growing_together(const Task& task, const State& before, const State& after) const {
  std::vector<Copy> found;
  for (const size_t copy : growing_) {
    const Interval &from = before.values[copy], &to = after.values[copy];
    const int64_t way = to.least - from.least;
    if (way == 0 || to.most - from.most != way || from.is_any() || is_shared_in(task, tracked_[copy])) continue;
    for (const size_t of : compared_) {
      const Interval &first = before.values[of], &next = after.values[of];
      const int64_t step = next.least - first.least;
      if (of == copy || step == 0 || first.least != first.most || next.least != next.most || way % step != 0 || is_shared_in(task, tracked_[of])) continue;
      const int64_t factor = way / step;
      if (found.size() < kMostTogether) found.push_back({copy, of, factor, {from.least - factor * first.least, from.most - factor * first.least}});
    }
  }
  return found;
}

// It is known of the state, or its values say so; what comes into a loop once more may begin elsewhere.
bool Values::holds(Copy& copy, const State& state, bool may_grow) {
  const auto joined_with = [&](const Interval& more) {
    const Interval both = joined(copy.more, more);
    if (both == copy.more) return true;
    if (!may_grow || ++copy.widened > kMostWidened) return false;
    copy.more = both;
    return true;
  };
  for (const Copy& known : state.copies)
    if (known.copy == copy.copy && known.of == copy.of && known.factor == copy.factor) return joined_with(known.more);
  const Interval &of = state.values[copy.of], &value = state.values[copy.copy];
  if (of.least != of.most || value.is_any()) return false;
  return joined_with({value.least - copy.factor * of.least, value.most - copy.factor * of.least});
}

}  // namespace ipos::compiler::analysis
