// A set of the nodes of one line, visited in order of attachment, and which of them want which identifiers.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "runtime/bus/line/node_id.hpp"

namespace ipos::runtime {

class NodeSet {
 public:
  static constexpr NodeId kWordBits = 64;

  void grow(size_t nodes) { words_.resize((nodes + kWordBits - 1) / kWordBits); }
  void put(NodeId node, bool in) {
    const uint64_t bit = uint64_t{1} << (node % kWordBits);
    uint64_t& word = words_[node / kWordBits];
    word = in ? word | bit : word & ~bit;
  }
  // The nodes of word `n` of a set.
  template <typename Visit>
  static void each_bit(uint64_t word, size_t n, Visit& visit) {
    for (; word != 0; word &= word - 1)
      visit(static_cast<NodeId>(n * kWordBits + static_cast<size_t>(std::countr_zero(word))));
  }
  std::span<const uint64_t> words() const { return words_; }

 private:
  std::vector<uint64_t> words_;
};

// Which nodes want which standard identifiers. All want everything until they are closed. Most identifiers are wanted by the same
// nodes: they share the first row, and the others have a row of their own.
class AcceptanceFilter {
 public:
  static constexpr size_t kIdentifiers = 2048;

  void grow(size_t nodes) {
    const size_t width = (nodes + NodeSet::kWordBits - 1) / NodeSet::kWordBits;
    if (width != width_) {
      const size_t rows = width_ == 0 ? 1 : words_.size() / width_;
      std::vector<uint64_t> words(width * rows, 0);
      for (size_t row = 0; row < rows; ++row)
        for (size_t n = 0; n < width_; ++n) words[row * width + n] = words_[row * width_ + n];
      words_ = std::move(words);
      width_ = width;
    }
    each_word_of(nodes - 1, [bit = bit_of(nodes - 1)](uint64_t& word) { word |= bit; });
  }
  void close(NodeId node) {
    each_word_of(node, [bit = bit_of(node)](uint64_t& word) { word &= ~bit; });
  }
  void open(NodeId node, uint32_t id) {
    if (row_of_[id] == 0) {
      row_of_[id] = static_cast<uint16_t>(words_.size() / width_);
      words_.resize(words_.size() + width_);
      std::copy_n(words_.begin(), width_, words_.end() - static_cast<std::ptrdiff_t>(width_));
    }
    words_[row_of_[id] * width_ + node / NodeSet::kWordBits] |= bit_of(node);
  }
  std::span<const uint64_t> takers(uint32_t id) const { return {words_.data() + row_of_[id] * width_, width_}; }

 private:
  // In every row.
  template <typename Change>
  void each_word_of(size_t node, Change change) {
    for (size_t at = node / NodeSet::kWordBits; at < words_.size(); at += width_) change(words_[at]);
  }
  static uint64_t bit_of(size_t node) { return uint64_t{1} << (node % NodeSet::kWordBits); }
  size_t width_ = 0;
  std::array<uint16_t, kIdentifiers> row_of_{};  // of each identifier
  std::vector<uint64_t> words_;                  // for each row the words of a set
};

}  // namespace ipos::runtime
