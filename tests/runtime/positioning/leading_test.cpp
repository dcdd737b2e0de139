// Travels that are led for several milliseconds at once (runtime/services/lead.cpp): all that ticks change is what it is where each
// of them is done by itself. That one is the expected value.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <random>

#include "tests/runtime/pace/law.hpp"
#include "tests/runtime/positioning/rig.hpp"

namespace ipos::tests {
namespace {

using runtime::Ticks;

// A parameter, and what it may be.
struct Choice {
  const char* number;
  int32_t first, last, step;
};
// Ramps and speeds that need more torque than there is, windows and delays that end on the way, references on both sides of it.
constexpr Choice kChoices[] = {
    {"302", 400'000, 1'500'000, 200}, {"303", 20'000, 150'000, 1'000},   {"910", 100, 3'000, 10},
    {"911", 10, 1'500, 10},           {"912", 10, 1'500, 10},            {"913", 10'000, 3'000'000, 200},
    {"914", 10'000, 3'000'000, 200},  {"915", 50'000, 110'000, 10},      {"916", 0, 1, 1},
    {"922", 0, 400, 1},               {"923", 2'000, 60'000, 1},           {"400", 10'000, 1'500'000, 200},
    {"402", 0, 300, 100},             {"420", 1'000, 300'000, 1'000},    {"421", 0, 100, 100},
    {"430", 10'000, 140'000, 1'000},  {"432", 0, 100, 100},              {"500", 0, 3, 1},
    {"501", 0, 300, 10},              {"620", 0, 14, 1},                 {"621", 0, 14, 1},
};

// Two axes with the same history: one is led where that is possible, the other ticks all the time.
class TravelTwins {
 public:
  TravelTwins(uint64_t seed, const runtime::MachineData& machine) : random_(seed), led_({}, "md60a", machine), plain_({}, "md60a", machine) {
    for (const Choice& choice : kChoices)
      if (below(3) == 0) choose(choice);
  }

  void change() {
    if (below(2) == 0) recover();
    switch (below(12)) {
      case 0:
      case 1:
      case 2:
      case 3: return go(below(120'001) - 60'000);
      case 4: return go(led_.h[511] + below(2'001) - 1'000);
      case 5: return choose(kChoices[static_cast<size_t>(below(std::size(kChoices)))]);
      case 6: return inputs(below(3) == 0 ? 0b0011 : kEnabled);
      case 7: {
        const int32_t torque = below(400'001) - 200'000;
        return both([&](Rig& rig) { rig.drive.set_load_torque(torque); });
      }
      case 8: {
        const auto levels = static_cast<uint16_t>(below(8));
        return both([&](Rig& rig) { rig.drive.set_ipos_outputs(levels); });
      }
      case 9: return both([](Rig& rig) { rig.positioner().stop_here(); });
      case 10: return both([](Rig& rig) { rig.drive.set_mains(false); });
      default: return;
    }
  }

  Ticks stretch() { return 1 + static_cast<Ticks>(below(300)); }

  void run(Ticks ticks) {
    plain_.run(static_cast<int>(ticks));
    while (ticks != 0) {
      const Ticks led = lead(ticks);
      if (led == 0) led_.tick();
      ticks -= std::max<Ticks>(led, 1);
    }
  }

  ::testing::AssertionResult same() const {
    const auto led = led_.drive.moment(), plain = plain_.drive.moment();
    if (!(led.state == plain.state)) return ::testing::AssertionFailure() << "the state of the drives";
    if (!(led.situation == plain.situation)) return ::testing::AssertionFailure() << "their situation";
    if (!led_.service.has_left(runtime::PositioningService::Left(plain_.service)))
      return ::testing::AssertionFailure() << "positioning";
    if (led_.h != plain_.h) return ::testing::AssertionFailure() << "the variables";
    if (led_.drive.status_word_1() != plain_.drive.status_word_1()) return ::testing::AssertionFailure() << "the status word";
    return ::testing::AssertionSuccess() << "after " << led_.ms << " ms";
  }
  uint64_t led_ticks() const { return led_ticks_; }
  uint64_t limited() const { return limited_; }

 private:
  // As Unit::move_on() and show_moved() do it.
  Ticks lead(Ticks most) {
    if (!led_.service.goes_on(led_.h)) return 0;
    const Ticks done = led_.service.lead_on(0, std::min<Ticks>(most, 1 + static_cast<Ticks>(below(31))));
    if (done == 0) return 0;
    led_.now += static_cast<runtime::Time>(done - 1) * runtime::kMillisecond;
    led_.service.show(led_.now, led_.h);
    led_.now += runtime::kMillisecond;
    led_.ms += static_cast<int>(done);
    led_ticks_ += done;
    if (led_.drive.current_limited()) ++limited_;
    return done;
  }

  int32_t below(uint64_t end) { return static_cast<int32_t>(random_() % end); }
  void recover() {
    inputs(kEnabled);
    both([](Rig& rig) {
      rig.drive.set_mains(true);
      rig.drive.reset_fault();
    });
  }
  template <class Act>
  void both(Act act) {
    act(led_);
    act(plain_);
  }
  void go(int32_t target) {
    both([&](Rig& rig) { rig.go(target); });
  }
  void inputs(uint16_t levels) {
    both([&](Rig& rig) { rig.drive.set_inputs(levels); });
  }
  void choose(const Choice& choice) {
    const int32_t value = choice.first + choice.step * below(static_cast<uint64_t>((choice.last - choice.first) / choice.step) + 1);
    both([&](Rig& rig) { rig.set(choice.number, value); });
  }

  std::mt19937_64 random_;
  Rig led_, plain_;
  uint64_t led_ticks_ = 0, limited_ = 0;
};

// The last ones are hot soon, and have no chopper.
runtime::MachineData machine_of(uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto below = [&](int32_t end) { return static_cast<int32_t>(random() % static_cast<uint64_t>(end)); };
  runtime::MachineData machine;
  machine.inertia = below(800);
  machine.friction = below(30'000);
  machine.load_torque = below(3) == 0 ? below(100'000) - 50'000 : 0;
  if (seed % 3 == 0) {
    machine.motor_heat_time_ms = 1 + below(20'000);
    machine.heat_sink_time_ms = 1 + below(20'000);
    machine.heat_sink_rise = 50 + below(150);
    machine.braking_resistor = below(2) == 0;
  }
  return machine;
}

TEST(Leading, IsTheSameAsTickByTick) {
  constexpr uint64_t kSeeds = 40;
  uint64_t led = 0, limited = 0, all = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    TravelTwins twins(seed, machine_of(seed));
    for (uint32_t step = 0; step < 4 * law_steps() / kSeeds;) {
      twins.change();
      const Ticks ticks = twins.stretch();
      twins.run(ticks);
      step += ticks;
      all += ticks;
      ASSERT_TRUE(twins.same()) << "seed " << seed << ", step " << step;
    }
    led += twins.led_ticks();
    limited += twins.limited();
  }
  EXPECT_GT(led, all / 20) << "of " << all;
  EXPECT_GT(limited, all / 10'000) << "times at the current limit";
}

}  // namespace
}  // namespace ipos::tests
