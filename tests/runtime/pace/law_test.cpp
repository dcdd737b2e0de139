// Every part against the law: what advance(n) does at once is what n of its ticks do.
#include "tests/runtime/pace/law.hpp"

#include "runtime/drive/link_watch.hpp"
#include "runtime/drive/outputs.hpp"
#include "runtime/motion/axis.hpp"
#include "tests/runtime/motion/order_mix.hpp"

namespace ipos::tests {
namespace {

using runtime::Axis;
using runtime::AxisOrder;
using runtime::LinkWatch;
using runtime::PowerSection;
using runtime::ReferenceSignal;
using runtime::Ticks;

constexpr uint32_t kSteps = 250'000;  // with each of four seeds

TEST(Law, Axis) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    std::mt19937_64 machines(seed);
    AxisOrder order;
    ASSERT_NO_FATAL_FAILURE(expect_law(
        Axis(draw_machine(machines, Taste::Plausible)), seed, kSteps,
        [&](Axis& axis, std::mt19937_64& random) {
          order = draw_order(random, Taste::Plausible);
          if (random() % 8 == 0) axis.set_position(static_cast<int32_t>(random()));
        },
        [&](Axis& axis) { axis.tick(order); }));
  }
}

TEST(Law, PowerSection) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    std::mt19937_64 machines(seed);
    PowerSection::Load load{};
    ASSERT_NO_FATAL_FAILURE(expect_law(
        PowerSection(runtime::within_limits(draw_machine(machines, Taste::Plausible))), seed, kSteps,
        [&](PowerSection&, std::mt19937_64& random) {
          load.supply = static_cast<runtime::Supply>(random() % 4);
          load.speed = static_cast<int32_t>(random() % 6'000'000) - 3'000'000;
          load.torque = static_cast<int64_t>(random() % 300'000) - 150'000;
          load.current_limit = static_cast<int32_t>(random() % 200'000);
          load.direct_current = static_cast<int32_t>(random() % 50'000);
        },
        [&](PowerSection& power) { power.step(load); }));
  }
}

TEST(Law, LinkWatch) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    LinkWatch::Rules rules;
    ASSERT_NO_FATAL_FAILURE(expect_law(
        LinkWatch(), seed, kSteps,
        [&](LinkWatch& link, std::mt19937_64& random) {
          switch (random() % 8) {
            case 0: rules.delay_ms = static_cast<int32_t>(random() % 5 * 150); break;
            case 1: rules.supervised = random() % 2 != 0; break;
            case 2: rules.without_first = random() % 2 != 0; break;
            case 3: link.forget(); break;
            case 4: link.on_request(); break;
            default: link.on_process_data(random() % 4 != 0);
          }
        },
        [&](LinkWatch& link) { link.tick(rules); }));
  }
}

// A signal with its delay.
struct Delayed {
  ReferenceSignal signal;
  int32_t delay_ms = 0;

  void advance(Ticks ticks) { signal.go_on(static_cast<int32_t>(ticks)); }
  Ticks bound() const { return static_cast<Ticks>(signal.ticks_left(delay_ms)); }
  bool operator==(const Delayed&) const = default;
};

TEST(Law, ReferenceSignal) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    bool above = false, below = false;
    ASSERT_NO_FATAL_FAILURE(expect_law(
        Delayed(), seed, kSteps,
        [&](Delayed& part, std::mt19937_64& random) {
          above = random() % 3 == 0;
          below = !above && random() % 2 == 0;
          if (random() % 4 == 0) part = {{}, static_cast<int32_t>(random() % 500)};
        },
        [&](Delayed& part) { part.signal.tick(above, below, part.delay_ms); }));
  }
}

}  // namespace
}  // namespace ipos::tests
