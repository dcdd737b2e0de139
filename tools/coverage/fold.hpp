// From counts of commands to coverage of the source they come from, by the line table of the image.
#pragma once

#include <cstdint>
#include <span>

#include "tools/coverage/coverage.hpp"
#include "vm/image/image.hpp"

namespace ipos::tools::coverage {

struct CommandCount {
  uint64_t executed = 0;
  uint64_t passed = 0;   // went on with the command after it
  uint64_t entered = 0;  // was called here, or started here as a task or an interrupt
};

// `counts`: one for each code word, of which those where a command begins matter. Code without a place in the
// line table is left out.
Coverage fold(const vm::Image& image, std::span<const CommandCount> counts);

}  // namespace ipos::tools::coverage
