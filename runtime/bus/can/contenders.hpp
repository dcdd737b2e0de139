// Who wants to send on a line: of each node with waiting frames what arbitration asks about it, ranked by the
// arbitration field of its first frame. So the winner is found without a look at the others.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "runtime/bus/node_id.hpp"

namespace ipos::runtime {

struct Contender {
  uint64_t ready = 0;        // can send from this bit on
  uint64_t first_ready = 0;  // the first of its queue can
  uint32_t key = 0;          // of that one; the lowest one wins
};

class Contenders {
 public:
  void grow(size_t nodes) {
    rows_.resize(nodes);
    ranks_.resize(2 * nodes);
  }

  bool empty() const { return first_ == end_; }
  const Contender& operator[](NodeId node) const { return rows_[node]; }

  // A node that did not wait has one frame now.
  void join(NodeId node, uint64_t ready, uint32_t key) {
    insert(rank(node, key));
    set(node, ready, ready, key);
  }
  void put(NodeId node, uint64_t ready, uint64_t first_ready, uint32_t key) {
    const Row& row = rows_[node];
    if (!row.waits || row.key != key) {
      if (row.waits) erase(rank(node, row.key));
      insert(rank(node, key));
    }
    set(node, ready, first_ready, key);
  }
  void remove(NodeId node) {
    if (!rows_[node].waits) return;
    rows_[node].waits = false;
    erase(rank(node, rows_[node].key));
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
  // All in order of attachment.
  template <typename Visit>
  void each(Visit visit) const {
    for (NodeId node = 0; node < rows_.size(); ++node)
      if (rows_[node].waits) visit(node);
  }

 private:
  struct Row : Contender {
    bool waits = false;
  };
  static constexpr int kKeyShift = 32;
  static uint64_t rank(NodeId node, uint32_t key) { return uint64_t{key} << kKeyShift | node; }

  void set(NodeId node, uint64_t ready, uint64_t first_ready, uint32_t key) {
    Row& row = rows_[node];
    row.ready = ready;
    row.first_ready = first_ready;
    row.key = key;
    row.waits = true;
    ready_by_ = std::max(ready_by_, first_ready);
  }
  void insert(uint64_t rank) {
    if (end_ != ranks_.size() && (empty() || ranks_[end_ - 1] < rank))
      ranks_[end_++] = rank;
    else
      insert_between(rank);
  }
  void insert_between(uint64_t rank);
  void erase(uint64_t rank) {
    if (ranks_[first_] == rank) {
      if (++first_ == end_) first_ = end_ = 0;
    } else {
      const auto place = std::lower_bound(at(first_), at(end_), rank);
      std::copy(place + 1, at(end_), place);
      --end_;
    }
  }
  std::vector<uint64_t>::iterator at(size_t n) { return ranks_.begin() + static_cast<ptrdiff_t>(n); }

  std::vector<Row> rows_;
  std::vector<uint64_t> ranks_;  // key and node, rising, from first_ to end_
  size_t first_ = 0;
  size_t end_ = 0;
  uint64_t ready_by_ = 0;  // the latest first_ready there was
};

inline void Contenders::insert_between(uint64_t rank) {
  if (end_ == ranks_.size()) {  // at least half of it is free
    std::copy(at(first_), at(end_), at(0));
    end_ -= std::exchange(first_, 0);
  }
  if (first_ > 0 && rank < ranks_[first_]) {
    ranks_[--first_] = rank;
    return;
  }
  const auto place = std::lower_bound(at(first_), at(end_), rank);
  std::copy_backward(place, at(end_), at(end_ + 1));
  *place = rank;
  ++end_;
}

}  // namespace ipos::runtime
