// The time that onlookers of a real-time run have, on a clock of the test.
#include "tools/debug/onlooker_share.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace ipos::tools::debug {
namespace {

using namespace std::chrono_literals;
using Duration = OnlookerShare::Time::duration;

struct Spent {
  Duration all{}, in_looks{};
  int looks = 0;
};

// A run that comes by each 50 us, for as long as it is told; a look takes what `takes` says of its number.
Spent run_for(Duration time, const std::function<Duration(int)>& takes) {
  OnlookerShare share;
  Spent spent;
  const OnlookerShare::Time begin{};
  OnlookerShare::Time now = begin;
  while (now - begin < time) {
    if (share.is_due(now)) {
      const Duration look = takes(spent.looks++);
      share.looked(now, now + look);
      spent.in_looks += look;
      now += look;
    }
    now += 50us;
  }
  spent.all = now - begin;
  return spent;
}

TEST(OnlookerShare, IsATenthHoweverLongAnAnswerTakes) {
  for (const Duration look : {Duration{201us}, Duration{1ms}, Duration{7ms}, Duration{100ms}}) {
    const Spent spent = run_for(20s, [&](int) { return look; });
    // The last look may end with the time.
    EXPECT_LE(10 * (spent.in_looks - look), spent.all) << look.count();
    EXPECT_GE(spent.in_looks * 11, spent.all) << look.count() << ": it is not kept from what it may have";
  }
}

TEST(OnlookerShare, LongAnswersAmongShortOnes) {
  const Spent spent = run_for(20s, [](int look) { return look % 7 == 0 ? Duration{30ms} : Duration{look % 3 * 100us}; });
  EXPECT_LE(10 * (spent.in_looks - Duration{30ms}), spent.all);
}

// Of nobody who asks the run notices a look each 2 ms; after a long answer it goes on with that.
TEST(OnlookerShare, IdleLooks) {
  const Spent spent = run_for(10s, [](int) { return Duration{10us}; });
  EXPECT_GE(spent.looks, 10'000 / 3);
  EXPECT_LE(spent.looks, 10'000 / 2 + 1);
  OnlookerShare share;
  const OnlookerShare::Time begin{};
  EXPECT_TRUE(share.is_due(begin));
  share.looked(begin, begin + 5ms);
  EXPECT_FALSE(share.is_due(begin + 49ms));
  EXPECT_TRUE(share.is_due(begin + 50ms));
  share.looked(begin + 50ms, begin + 50ms);
  EXPECT_FALSE(share.is_due(begin + 51ms));
  EXPECT_TRUE(share.is_due(begin + 52ms));
}

}  // namespace
}  // namespace ipos::tools::debug
