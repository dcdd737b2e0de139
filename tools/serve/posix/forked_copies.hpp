// The copies of a host where there is fork(): sleeping ones to go back to, and one that runs again beside it. They share
// the memory of recordings, so that each does not keep one of its own.
#pragma once

#include "tools/serve/host/copies.hpp"

namespace ipos::tools::serve {

class ForkedCopies final : public Copies {
 public:
  explicit ForkedCopies(bool snapshots) : snapshots_(snapshots) {}
  std::unique_ptr<debug::Snapshots> snapshots() override;
  Memory memory(size_t bytes) override;
  void give_way() override;
  // The copy gives way to the process that it came from, and ends with it.
  std::unique_ptr<SecondRun> beside(const std::function<void()>& body) override;

 private:
  bool snapshots_;
};

}  // namespace ipos::tools::serve
