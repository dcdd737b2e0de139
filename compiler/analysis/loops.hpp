// The loops of a function, as parts of its graph that go round: each with one command at which it begins, or none.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "compiler/analysis/graph.hpp"
#include "compiler/analysis/values.hpp"

namespace ipos::compiler::analysis {

// The parts of these commands that are strongly connected, so that none leads back to one before it. Ways to `head` do not count.
std::vector<std::vector<size_t>> parts_in_order(const Graph& graph, const std::vector<size_t>& commands, size_t head);

// One that is left after a known number of turns.
struct Turns {
  uint64_t most = 0;  // whole ones, back to the beginning
  size_t exit = 0;    // the comparison that ends it
};

// `loop` goes round at `head`. Counts up or down by a constant, compared with what stays as it is meanwhile.
std::optional<Turns> turns_of(const Graph& graph, const Values& values, const std::vector<size_t>& loop, size_t head);

}  // namespace ipos::compiler::analysis
