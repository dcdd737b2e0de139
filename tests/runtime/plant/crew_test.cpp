// Threads that share work: each number once in each round, however many threads there are.
#include "runtime/plant/crew.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace ipos::runtime {
namespace {

TEST(Crew, DoesEachNumberOnceInEachRound) {
  for (const unsigned threads : {0U, 1U, 2U, 5U}) {
    Crew crew(threads);
    for (size_t round = 0; round < 200; ++round) {
      const size_t count = round % 7;
      std::vector<std::atomic<int>> done(count);
      crew.share(count, [&](size_t n) { ++done.at(n); });
      for (size_t n = 0; n < count; ++n) EXPECT_EQ(done[n], 1) << threads << " threads, round " << round;
    }
  }
}

}  // namespace
}  // namespace ipos::runtime
