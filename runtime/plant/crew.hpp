// Threads that share numbered pieces of work, again and again. They wait in between.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace ipos::runtime {

class Crew {
 public:
  // The caller of share() is one of `threads`; the others start with the first work, as many of them as the system gives.
  explicit Crew(unsigned threads);
  ~Crew();

  // Each number below `count` once, in any order, and several at a time; it is all done then. The work throws nothing.
  void share(size_t count, const std::function<void(size_t n)>& work);

 private:
  struct Hands;
  unsigned threads_;
  std::unique_ptr<Hands> hands_;
};

}  // namespace ipos::runtime
