// How what comes from outside (inputs, telegrams, what a command asks of the unit) leads to what a program puts out: by values and
// by decisions, through variables that keep them from one turn of a loop to the next and from one task to another one. It tells after
// how many turns all has followed; or at which line nothing bounds that.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/analysis/values.hpp"
#include "vm/image/image.hpp"

namespace ipos::compiler {

struct InfluencePath {
  bool depends = false;                // something from outside leads there
  std::string because;                 // why nothing bounds the turns; empty: they are bounded
  std::vector<uint8_t> tasks;          // that have a part in it, in rising order
  std::array<uint64_t, 4> turns{};     // of each task on the longest way; with the turn that has just looked when something comes
  uint64_t ms = 0;                     // of these turns
};

class Influence {
 public:
  // `turn_ms`: of tasks 1 to 3 at their number, 0 where it is not known. `variables`: how many the unit has.
  Influence(const vm::Image& image, uint32_t variables, const std::array<uint64_t, 4>& turn_ms);
  ~Influence();

  // The task has one endless loop. A task without one decides nothing again and again.
  bool has_turn(uint8_t task) const;

  // From anything that comes from outside to these variables.
  InfluencePath into(const analysis::Span& sink) const;
  // From these variables, which a telegram writes, to other ones. `together`: what it brings comes at once.
  InfluencePath between(const analysis::Span& source, const analysis::Span& sink, bool together) const;
  // The same to outputs: variables that the unit follows, and orders to it.
  InfluencePath to_outputs(const analysis::Span& source, bool together) const;

 private:
  struct Program;
  std::unique_ptr<Program> program_;
};

}  // namespace ipos::compiler
