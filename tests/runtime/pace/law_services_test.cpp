// The law for positioner, timers and PID block.
#include "tests/runtime/pace/law.hpp"

#include <array>

#include "runtime/positioning/positioner.hpp"
#include "runtime/services/pid_block.hpp"
#include "runtime/services/timers.hpp"
#include "stdlib/system_variables.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::tests {
namespace {

using runtime::Ticks;

// A positioner on a shaft that turns evenly, driven by somebody else or standing.
struct Turning {
  runtime::Positioner positioner;
  int32_t counter = 0;
  int32_t step = 0;                   // increments a millisecond
  inline static uint64_t turned = 0;  // ms of steps that were advanced several at a time

  void observe() {
    counter = runtime::wrapped(int64_t{counter} + step);
    positioner.observe(counter);
  }
  void advance(Ticks ticks) {
    if (ticks == 0) return;
    if (ticks > 1 && step != 0) turned += ticks;
    const int32_t before = runtime::wrapped(counter + int64_t{step} * (ticks - 1));
    counter = runtime::wrapped(int64_t{before} + step);
    positioner.advance(before, counter);
  }
  Ticks bound() const { return positioner.bound(); }
  bool operator==(const Turning&) const = default;
};

TEST(Law, Positioner) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    runtime::PositioningSettings settings;
    runtime::PositioningInputs in;
    Turning axis;
    axis.positioner.power_on(settings, 0);
    ASSERT_NO_FATAL_FAILURE(expect_law(
        axis, seed, law_steps(),
        [&](Turning& part, std::mt19937_64& random) {
          const auto below = [&](uint64_t end) { return static_cast<int32_t>(random() % end); };
          in.possible = random() % 4 == 0;
          in.following = in.possible && random() % 2 == 0;
          in.speed = below(100'000);
          in.levels = static_cast<uint16_t>(random());
          in.limit_cw = random() % 8 == 0;
          in.reference_start = random() % 8 == 0;
          in.override_permille = below(1501);
          in.modulo_control = static_cast<uint32_t>(random() % 4);
          if (random() % 4 == 0) {
            part.step = random() % 2 == 0 ? 0 : below(20'001) - 10'000;
            settings.source = below(3);
            settings.factor_numerator = 1 + below(3);
            settings.factor_denominator = 1 + below(3);
            settings.modulo = below(4);
            settings.modulo_numerator = 1 + below(20);
            settings.modulo_resolution = 1 + below(4096);
            settings.absolute_inverted = below(2);
            settings.reference_type = below(8);
            part.positioner.take_over(settings);
          }
          switch (random() % 8) {
            case 0: part.positioner.write_target(below(200'000) - 100'000); break;
            case 1: part.positioner.start_reference(random() % 2 == 0, random() % 2 == 0); break;
            case 2: part.positioner.end_reference(); break;
            case 3: part.positioner.stop_here(); break;
            case 4: part.positioner.touch_probes().enable(random() % 2, true, random() % 2 == 0); break;
            case 5: part.positioner.set_modulo_turns(below(100)); break;
            case 6: part.positioner.write_modulo_target(below(1 << 20)); break;
            default: part.positioner.halt(static_cast<runtime::Halt>(random() % 3));
          }
        },
        [&](Turning& part) {
          part.positioner.tick(in);
          part.positioner.take_events();
          if (const auto counter = part.positioner.take_motor_counter()) part.counter = *counter;
          part.observe();
        }));
  }
  EXPECT_GT(Turning::turned, law_steps() / 20);
}

TEST(Law, Timers) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    Ticks silent = 0;  // ticks in which nothing may be reported
    ASSERT_NO_FATAL_FAILURE(expect_law(
        runtime::Timers::Counts(), seed, law_steps(),
        [&](runtime::Timers::Counts& timers, std::mt19937_64& random) {
          for (int32_t* timer :
               {&timers.timer_0, &timers.timer_1, &timers.timer_2, &timers.reload, &timers.watchdog})
            if (random() % 3 == 0) *timer = static_cast<int32_t>(random() % 500) - 50;
          timers.watched = random() % 2 == 0;
          silent = 0;
        },
        [&](runtime::Timers::Counts& timers) {
          const runtime::Timers::Counts before = timers;
          const auto expired = timers.tick();
          ASSERT_TRUE(silent == 0 || (!expired.timer_0 && !expired.watchdog));
          silent = runtime::steady_ticks(before, timers);
        }));
  }
}

// The block with the variables it reads and writes.
struct Controlled {
  runtime::PidBlock block;
  std::array<int32_t, 600> h{};

  void advance(Ticks ticks) { block.advance(ticks); }
  Ticks bound() const { return block.bound(); }
  bool operator==(const Controlled&) const = default;
};

TEST(Law, PidBlock) {
  using stdlib::system_variable;
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    runtime::ParameterStore parameters(*stdlib::find_unit("mdxb"));
    const auto preset = [&](const char* number, int32_t value) {
      ASSERT_TRUE(parameters.preset(parameters.table().find(number)->index, value)) << number;
    };
    preset("276", 100);
    preset("264", 5);
    preset("265", 3);
    ASSERT_NO_FATAL_FAILURE(expect_law(
        Controlled{runtime::PidBlock(parameters)}, seed, law_steps(),
        [&](Controlled& part, std::mt19937_64& random) {
          part.h[100] = static_cast<int32_t>(random() % 2001) - 1000;
          part.h[system_variable("PID_Mode")] = static_cast<int32_t>(random() % 3);
          part.h[system_variable("PID_K_p")] = static_cast<int32_t>(random() % 4) * 8'000;
          part.h[system_variable("PID_Command")] = random() % 4 == 0 ? part.h[100] : 500;
          part.h[system_variable("PID_SetpMax")] = static_cast<int32_t>(random() % 10'000);
        },
        [](Controlled& part) { part.block.tick(part.h); }));
  }
}

}  // namespace
}  // namespace ipos::tests
