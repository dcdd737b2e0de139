// Threads that take numbers.
#include "tools/testing/workers.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace ipos::tools::testing {

void share_work(size_t count, unsigned jobs, const std::function<void(size_t n)>& work) {
  std::atomic<size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  // An exception, say of a listener when nothing can be written, would end the program in a thread.
  const auto take = [&] {
    try {
      for (size_t n = next++; n < count; n = next++) work(n);
    } catch (...) {
      next = count;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> workers;
    for (size_t n = 1; n < std::min<size_t>(std::max(jobs, 1U), count); ++n) workers.emplace_back(take);
    take();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace ipos::tools::testing
