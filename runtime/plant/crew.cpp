// One mutex, and a number that says for which work the threads were woken.
#include "runtime/plant/crew.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace ipos::runtime {

struct Crew::Hands {
  explicit Hands(size_t others) {
    try {
      for (size_t n = 0; n < others; ++n) threads.emplace_back([this] { serve(); });
    } catch (const std::system_error&) {  // there are no more, or none as in a browser: the others do their work
    }
  }
  ~Hands() {
    {
      const std::lock_guard lock(mutex);
      over = true;
    }
    wake.notify_all();
    for (std::thread& thread : threads) thread.join();
  }

  void take() {
    for (size_t n = next++; n < count; n = next++) (*work)(n);
  }

  void serve() {
    uint64_t seen = 0;
    std::unique_lock lock(mutex);
    for (;;) {
      wake.wait(lock, [&] { return over || round != seen; });
      if (over) return;
      seen = round;
      lock.unlock();
      take();
      lock.lock();
      if (--busy == 0) done.notify_one();
    }
  }

  void share(size_t pieces, const std::function<void(size_t n)>& wanted) {
    {
      const std::lock_guard lock(mutex);
      work = &wanted;
      count = pieces;
      next = 0;
      busy = threads.size();
      ++round;
    }
    wake.notify_all();
    take();
    std::unique_lock lock(mutex);
    done.wait(lock, [&] { return busy == 0; });
  }

  std::mutex mutex;
  std::condition_variable wake, done;
  const std::function<void(size_t n)>* work = nullptr;
  size_t count = 0;
  std::atomic<size_t> next = 0;
  uint64_t round = 0;
  size_t busy = 0;
  bool over = false;
  std::vector<std::thread> threads;
};

Crew::Crew(unsigned threads) : threads_(threads) {}
Crew::~Crew() = default;

void Crew::share(size_t count, const std::function<void(size_t n)>& work) {
  const size_t wanted = std::min<size_t>(threads_, count);
  if (wanted < 2) {
    for (size_t n = 0; n < count; ++n) work(n);
    return;
  }
  if (!hands_) hands_ = std::make_unique<Hands>(wanted - 1);
  hands_->share(count, work);
}

}  // namespace ipos::runtime
