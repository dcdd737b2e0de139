// A message that came several times for one thing that is written once is told once, with a note that counts the others.
#pragma once

#include <span>
#include <vector>

#include "compiler/diag/diag.hpp"

namespace ipos::compiler {

std::vector<Diagnostic> each_once(std::span<const Diagnostic> all, const SourceMap& map);

}  // namespace ipos::compiler
