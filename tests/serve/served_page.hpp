// The page as `ipos serve` has it: with copies of the process, and the files that belong to it.
#pragma once

#include "tests/serve/page.hpp"
#include "tools/serve/channel.hpp"
#include "tools/serve/posix/forked_copies.hpp"
#include "tools/serve/plant_files.hpp"

namespace ipos::tests {

struct ServedParts {
  explicit ServedParts(bool copied) : copies(copied ? std::make_unique<tools::serve::ForkedCopies>(false) : std::make_unique<tools::serve::Copies>()) {}
  tools::serve::SteadyClock clock;
  std::unique_ptr<tools::serve::Copies> copies;
  tools::serve::PlantFiles files{"plant.toml", {}};
};

class ServedPage : private ServedParts, public Page {
 public:
  // Without copies of the process it is that of a browser's worker.
  explicit ServedPage(tools::debug::MakePlant make, bool copied = true)
      : ServedParts(copied), Page(std::move(make), clock, *copies, files) {}
};

}  // namespace ipos::tests
