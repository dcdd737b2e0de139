// What a command reads of the variables, by name or through a pointer; Values::written_by is what it writes.
#pragma once

#include <vector>

#include "compiler/analysis/graph.hpp"
#include "compiler/analysis/values.hpp"

namespace ipos::compiler::analysis {

std::vector<Span> read_by(const Graph& graph, const Values& values, size_t command);

}  // namespace ipos::compiler::analysis
