// Who wants to send on a line: the nodes with waiting frames, ranked by the arbitration field of the first
// frame of each. So the winner is found without a look at the others.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "runtime/bus/line/node_id.hpp"

namespace ipos::runtime {

class Contenders {
 public:
  void grow(size_t nodes) {
    rank_of_.resize(nodes, kNoRank);
    ranks_.resize(2 * nodes);
  }

  bool empty() const { return first_ == end_; }

  // The first frame of its queue has this key, the lowest one wins, and can be sent from the bit `ready` on.
  void put(NodeId node, uint64_t ready, uint32_t key) {
    if (rank_of_[node] == rank(node, key)) {
      ready_by_ = std::max(ready_by_, ready);
    } else {
      remove(node);
      join(node, ready, key);
    }
  }
  void join(NodeId node, uint64_t ready, uint32_t key) {  // one that did not wait
    rank_of_[node] = rank(node, key);
    insert(rank(node, key));
    ready_by_ = std::max(ready_by_, ready);
  }
  void remove(NodeId node) {
    const uint64_t rank = std::exchange(rank_of_[node], kNoRank);
    if (rank != kNoRank) erase(rank);
  }

  // At this bit each of them can send the first frame of its queue.
  bool all_ready(uint64_t bit) const { return ready_by_ <= bit; }

  // The one whose first frame has the lowest key; kNoNode when another has the same one.
  NodeId only_first() const {
    const uint64_t rank = ranks_[first_];
    const bool alone = first_ + 1 == end_ || ranks_[first_ + 1] >> kKeyShift != rank >> kKeyShift;
    return alone ? static_cast<NodeId>(rank) : kNoNode;
  }
  // Those whose first frame has the lowest key, in order of attachment. There must be one.
  template <typename Visit>
  void each_first(Visit visit) const {
    const uint64_t lowest = ranks_[first_] >> kKeyShift;
    for (size_t n = first_; n < end_ && ranks_[n] >> kKeyShift == lowest; ++n)
      visit(static_cast<NodeId>(ranks_[n]));
  }
  // All of them, by rank.
  template <typename Visit>
  void each(Visit visit) const {
    for (size_t n = first_; n < end_; ++n) visit(static_cast<NodeId>(ranks_[n]));
  }

 private:
  static constexpr int kKeyShift = 32;
  static constexpr uint64_t kNoRank = ~uint64_t{0};  // of kNoNode
  static uint64_t rank(NodeId node, uint32_t key) { return uint64_t{key} << kKeyShift | node; }

  void insert(uint64_t rank) {
    if (end_ != ranks_.size() && (empty() || ranks_[end_ - 1] < rank))
      ranks_[end_++] = rank;
    else
      insert_between(rank);
  }
  void erase(uint64_t rank) {
    if (ranks_[first_] != rank)
      erase_between(rank);
    else if (++first_ == end_)
      first_ = end_ = 0;
  }
  void insert_between(uint64_t rank);
  void erase_between(uint64_t rank);
  std::vector<uint64_t>::iterator at(size_t n) { return ranks_.begin() + static_cast<ptrdiff_t>(n); }

  std::vector<uint64_t> rank_of_;  // by node: key and node; kNoRank: it does not wait
  std::vector<uint64_t> ranks_;    // of all that wait, rising, from first_ to end_
  size_t first_ = 0;
  size_t end_ = 0;
  uint64_t ready_by_ = 0;  // the latest `ready` there was
};

}  // namespace ipos::runtime
