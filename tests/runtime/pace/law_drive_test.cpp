// The law for the drive: all that a tick of it changes.
#include <algorithm>
#include <random>
#include <utility>

#include "tests/runtime/drive/drive_rig.hpp"
#include "tests/runtime/pace/law.hpp"

namespace ipos::tests {
namespace {

using runtime::Ticks;

// Two drives with the same history: one advances where it is steady, the other ticks all the time. All that
// ticks change is the same after each stretch.
class Twins {
 public:
  Twins(const char* name, uint64_t seed) : random_(seed), one_(name), other_(name) {}

  void change() {
    const auto word = static_cast<uint16_t>(random_());
    const int32_t value = below(2'000'001) - 1'000'000;
    switch (below(10)) {
      case 0:
      case 1: both([&](Drive& drive) { drive.set_inputs(below_ % 4 != 0 ? 0x0B : word); }); break;
      case 2: {
        auto analog = one_.drive.analog();
        analog.ai1 = {value / 100, 0};
        both([&](Drive& drive) { drive.set_analog(analog); });
        break;
      }
      case 3: {
        const Words words{static_cast<uint16_t>(below_ % 4 != 0 ? 6 : word), word, word};
        both([&](Drive& drive) { drive.take_po(PoSource::Sbus, words); });
        break;
      }
      case 4: both([&](Drive& drive) { drive.set_ipos_outputs(word); }); break;
      case 5:
        both([&](Drive& drive) { drive.set_ipos_control_word(below_ % 2 != 0 ? 0 : 1U << word % 32); });
        break;
      case 6:
        position_.controls = below_ % 2 != 0;
        position_.speed = value;
        position_.in_position = word % 2 != 0;
        break;
      case 7: both([&](Drive& drive) { drive.raise_fault(static_cast<uint8_t>(word % 100)); }); break;
      case 8:
      case 9: both([](Drive& drive) { drive.reset_fault(); }); break;
    }
  }
  void set(const char* number, int32_t value) {
    one_.set(number, value);
    other_.set(number, value);
  }
  void run(uint32_t ticks) {
    for (; ticks != 0; --ticks) other_.drive.tick(position_);
  }
  // How many of them were advanced.
  uint32_t advance(uint32_t ticks) {
    uint32_t advanced = 0;
    for (uint32_t left = ticks; left != 0;) {
      const bool same = position_ == one_.drive.position_control();
      if (const Ticks steady = std::min(same ? one_.drive.steady_left() : 0, left); steady != 0) {
        one_.drive.advance(steady);
        advanced += steady;
        left -= steady;
        continue;
      }
      const Drive::Moment before = one_.drive.moment();
      one_.drive.tick(position_);
      one_.drive.hold_steady(one_.drive.steady_since(before));
      --left;
    }
    return advanced;
  }
  bool same() const {
    const Drive::Moment one = one_.drive.moment(), other = other_.drive.moment();
    return one.state == other.state && one.situation == other.situation;
  }
  uint32_t stretch() { return 1 + static_cast<uint32_t>(below(400)); }

 private:
  int32_t below(uint32_t end) {
    below_ = static_cast<uint32_t>(random_() >> 32);
    return static_cast<int32_t>(below_ % end);
  }
  template <class Act>
  void both(Act act) {
    act(one_.drive);
    act(other_.drive);
  }

  std::mt19937_64 random_;
  uint32_t below_ = 0;
  DriveRig one_, other_;
  runtime::PositionControl position_;
};

TEST(Law, DriveState) {
  constexpr int kTorqueControl = 12;
  const std::pair<const char*, int> kinds[] = {
      {"mdxb", 0}, {"md60a", 0}, {"mc07", 0}, {"mdxb", 0}, {"mdxb", kTorqueControl}};
  for (const auto& [name, mode] : kinds) {
    static uint64_t seed = 0;
    Twins twins(name, ++seed);
    if (mode != 0) twins.set("P700", mode);
    if (mode != 0) twins.set("P871", 2);  // CURRENT
    uint32_t advanced = 0;
    for (uint32_t step = 0; step < law_steps();) {
      twins.change();
      const uint32_t ticks = twins.stretch();
      advanced += twins.advance(ticks);
      twins.run(ticks);
      step += ticks;
      ASSERT_TRUE(twins.same()) << name << ", seed " << seed << ", " << step;
    }
    EXPECT_GT(advanced, law_steps() / 20) << name;
  }
}

}  // namespace
}  // namespace ipos::tests
