// The page as `ipos serve` has it: with copies of the process, and the sources that it has compiled.
#pragma once

#include "tests/serve/page.hpp"
#include "tools/serve/channel.hpp"
#include "tools/serve/compiled_sources.hpp"
#include "tools/serve/forked_copies.hpp"

namespace ipos::tests {

struct ServedParts {
  tools::serve::SteadyClock clock;
  tools::serve::ForkedCopies copies{false};
  tools::serve::CompiledSources sources;
};

class ServedPage : private ServedParts, public Page {
 public:
  explicit ServedPage(tools::debug::MakePlant make) : Page(std::move(make), clock, copies, sources) {}
};

}  // namespace ipos::tests
