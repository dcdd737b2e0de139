// Sets of values that a variable may have at a place of the program, each set once and known by its number: what the
// analysis of constants (constant_flow.hpp) joins and compares.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
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

  KnownValues() : sets_(1) {}

  Set of(KnownValue known) { return add({known}); }
  Set join(Set a, Set b);
  // In rising order of values and places; empty for kAny.
  const std::vector<KnownValue>& values(Set set) const { return sets_[set]; }
  // The only value of a set.
  const KnownValue* only(Set set) const;

 private:
  using Key = std::vector<std::pair<int32_t, uint32_t>>;

  Set add(std::vector<KnownValue> values);

  std::vector<std::vector<KnownValue>> sets_;
  std::map<Key, Set> numbers_;
  std::unordered_map<uint64_t, Set> joined_;
};

}  // namespace ipos::compiler
