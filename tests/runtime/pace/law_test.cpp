// The law for what moves and shows: axis, power section, link watch, reference signals, outputs.
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

TEST(Law, Axis) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    std::mt19937_64 machines(seed);
    AxisOrder order;
    ASSERT_NO_FATAL_FAILURE(expect_law(
        Axis(draw_machine(machines, Taste::Plausible)), seed, law_steps(),
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
        PowerSection(runtime::within_limits(draw_machine(machines, Taste::Plausible))), seed, law_steps(),
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
        LinkWatch(), seed, law_steps(),
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

  void advance(Ticks ticks) { signal.advance(ticks); }
  Ticks bound() const { return signal.bound(delay_ms); }
  bool operator==(const Delayed&) const = default;
};

TEST(Law, ReferenceSignal) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    bool above = false, below = false;
    ASSERT_NO_FATAL_FAILURE(expect_law(
        Delayed(), seed, law_steps(),
        [&](Delayed& part, std::mt19937_64& random) {
          above = random() % 3 == 0;
          below = !above && random() % 2 == 0;
          if (random() % 4 == 0) part = {{}, static_cast<int32_t>(random() % 500)};
        },
        [&](Delayed& part) { part.signal.tick(above, below, part.delay_ms); }));
  }
}

TEST(Law, Outputs) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    runtime::Settings settings;
    for (uint8_t function = 9; function <= 13; ++function)  // all reference signals
      settings.outputs[function - 1] = function;
    runtime::OutputInputs in;
    bool known = false;  // settings of the last tick
    ASSERT_NO_FATAL_FAILURE(expect_law(
        runtime::Outputs(), seed, law_steps(),
        [&](runtime::Outputs&, std::mt19937_64& random) {
          const auto below = [&](uint64_t end) { return static_cast<int32_t>(random() % end); };
          in.speed = below(161) - 80;
          in.current = below(161) - 80;
          in.setpoint = below(121) - 60;
          in.current_limit = below(60);
          in.flags = static_cast<uint32_t>(random() % 2048);
          in.ipos_outputs = static_cast<uint16_t>(random());
          known = random() % 4 != 0;
          if (known) return;
          settings.speed_delay = below(500);
          settings.window_delay = below(500);
          settings.compare_delay = below(500);
          settings.current_delay = below(500);
          settings.limit_delay = below(500);
          settings.speed_reference = below(60);
          settings.window_center = below(60);
          settings.window_width = below(40);
          settings.compare_hysteresis = below(30);
          settings.current_reference = below(60);
        },
        [&](runtime::Outputs& outputs) {
          if (!known || !outputs.go_on(in)) outputs.tick(settings, in);
          known = true;
        }));
  }
}

}  // namespace
}  // namespace ipos::tests
