// Variables that the unit looks at by itself, in its own time: data of cyclic telegrams, sources of variable
// interrupts, what cams work on. Their numbers stand in members of structures given to system functions.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "compiler/sema/context.hpp"

namespace ipos::compiler {

struct Watch {
  std::string who;  // "the SBus sends it"
  Span span;        // where the number is handed over
};

struct Watched {
  std::set<uint32_t> members;  // that hold such numbers, or numbers used at once
  std::unordered_map<uint32_t, Watch> variables;
  std::optional<Watch> anywhere;  // a number that is known at run time only
};

// `used`: functions that can run.
Watched find_watched(const Context& context, const std::vector<bool>& used);

}  // namespace ipos::compiler
