// Sets of values that a variable may have at a place of the program, each set once and known by its number: what the
// analysis of constants (constant_flow.hpp) joins and compares.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <unordered_map>
#include <vector>

#include "compiler/source/source.hpp"

namespace ipos::compiler {

// A constant and where the program assigns it. No place: the 0 of a variable that nothing has been assigned to.
struct KnownValue {
  int32_t value;
  Span span;

  bool assigned() const { return span.begin.valid(); }
};

class KnownValues {
 public:
  using Set = uint32_t;
  static constexpr Set kAny = 0;  // nothing is known
  static constexpr size_t kMost = 4;

  KnownValues() : sets_(1), table_(1024, kAny) {}

  Set of(KnownValue known) { return number_of({{known}, 1}); }
  Set join(Set a, Set b);
  // In rising order of values and places; empty for kAny. They stay where they are.
  std::span<const KnownValue> values(Set set) const { return {sets_[set].known.data(), sets_[set].count}; }
  // The only value of a set.
  const KnownValue* only(Set set) const;

 private:
  struct Members {
    std::array<KnownValue, kMost> known;
    size_t count = 0;
  };

  Set number_of(const Members& members);
  size_t place_of(const Members& members) const;

  std::deque<Members> sets_;
  std::vector<Set> table_;  // by hash, each in the first free place behind its own; kAny: free. At least half of it is
  std::unordered_map<uint64_t, Set> joined_;
};

}  // namespace ipos::compiler
