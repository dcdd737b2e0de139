// A message that came several times for one thing that is written once is told once, with a note that counts the others.
#pragma once

#include <span>
#include <vector>

#include "compiler/diag/diag.hpp"

namespace ipos::compiler {

// The first of some that are the same, by its number in `all`, and those that came in places of their own: further uses of a
// macro, each place once. The others came in the same place.
struct Repeats {
  size_t first = 0;
  size_t more = 0;  // all but the first
  std::vector<size_t> elsewhere{};
};

// In the order of the first ones.
std::vector<Repeats> repeats_of(std::span<const Diagnostic> all, const SourceMap& map);

std::vector<Diagnostic> each_once(std::span<const Diagnostic> all, const SourceMap& map);

}  // namespace ipos::compiler
