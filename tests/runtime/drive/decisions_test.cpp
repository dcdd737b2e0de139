// A drive that keeps its decisions, and goes on where nothing is to be decided, against one that decides
// everything anew every millisecond and before every question: the same random commands, inputs, telegrams,
// faults and parameter writes, compared after each of them.
#include <algorithm>
#include <random>

#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::Command;
using runtime::PositionControl;

// One drive of the pair.
struct Twin {
  Twin(std::string_view name, DriveOptions options, const MachineData& machine, bool decides_anew)
      : rig(name, options, machine), forgets(decides_anew) {}

  Drive& drive() {
    if (forgets) rig.drive.forget_decisions();
    return rig.drive;
  }
  void tick(const PositionControl& position) {
    if (!forgets && rig.drive.steady_left() != 0 && position == rig.drive.position_control()) {
      rig.drive.advance(1);
      ++gone_on;
      return;
    }
    const Drive::Moment before = drive().moment();
    const uint32_t changes = rig.drive.changes();
    rig.drive.tick(position);
    travelled += position.controls && rig.drive.follows() && rig.drive.changes() == changes ? 1 : 0;
    if (!forgets) rig.drive.hold_steady(rig.drive.steady_since(before));
  }

  DriveRig rig;
  bool forgets;
  uint32_t gone_on = 0;
  uint32_t travelled = 0;  // moved by positioning, with nothing to decide
};

// Some get hot within seconds, and their motors are too weak for some ramps.
MachineData machine_of(uint32_t seed) {
  if (seed % 2 == 0) return {};
  MachineData machine;
  machine.motor_heat_time_ms = 300;
  machine.heat_sink_time_ms = 500;
  machine.heat_sink_rise = 100;
  machine.rated_power = 1'000'000;
  machine.load_torque = seed % 4 == 1 ? 130'000 : 25'000;
  machine.braking_resistor = seed % 8 == 1;
  return machine;
}

class Pair {
 public:
  Pair(std::string_view name, DriveOptions options, uint32_t seed)
      : random_(seed),
        kept_(name, options, machine_of(seed), false),
        anew_(name, options, machine_of(seed), true) {
    for (const stdlib::Parameter* parameter : kept_.rig.parameters.table().by_index())
      indices_.push_back(parameter->index);
    // Motor protection and monitored links, a third of them with a bus that controls.
    const auto preset = [&](std::string_view number, int32_t value) {
      if (kept_.rig.parameters.table().find(number) == nullptr) return;
      both([&](Twin& twin) { twin.rig.set(number, value); });
    };
    preset("340", 1);
    for (const char* number : {"812", "815", "819"}) preset(number, static_cast<int32_t>(1 + below(20)) * 10);
    if (seed % 3 != 0) return;
    preset("100", seed % 2 == 0 ? 10 : 2);
    preset("101", seed % 2 == 0 ? 3 : 1);
  }

  void step() {
    const uint32_t orders = below(3);
    for (uint32_t n = 0; n < orders; ++n) order();
    compare();
    if (below(200) == 0) {  // minutes are counted
      for (uint32_t n = 30'000 + below(60'000); n > 0; --n) {
        kept_.tick(position_);
        anew_.tick(position_);
      }
      compare();
    }
    const uint32_t ticks = below(8) == 0 ? 1 + below(300) : 1 + below(4);
    for (uint32_t n = 0; n < ticks; ++n) {
      if (position_.controls && below(3) != 0) travel();
      kept_.tick(position_);
      anew_.tick(position_);
      compare();
      if (::testing::Test::HasFailure()) return;
    }
  }

  uint32_t moved() const { return moved_; }
  uint32_t gone_on() const { return kept_.gone_on; }
  uint32_t travelled() const { return kept_.travelled; }
  uint32_t heard_again() const { return heard_again_; }

 private:
  uint32_t below(uint32_t limit) { return static_cast<uint32_t>(random_()) % limit; }
  template <typename Act>
  void both(Act act) {
    act(kept_);
    act(anew_);
  }

  // A speed not far from the last one, rarely one that is more than the motor can follow.
  void travel() {
    const int32_t most = below(40) == 0 ? 1'000'000 : 20'000;
    const int32_t change = static_cast<int32_t>(below(static_cast<uint32_t>(2 * most))) - most;
    position_.speed = std::clamp(position_.speed + change, -3'000'000, 3'000'000);
    if (below(8) == 0) position_.in_position = !position_.in_position;
    if (below(40) == 0) position_.referenced = !position_.referenced;
  }

  void order() {
    switch (below(16)) {
      case 0:
      case 1:
      case 2: {  // mostly what lets it run
        const auto bit = static_cast<uint16_t>(1U << below(16));
        const auto levels = static_cast<uint16_t>(below(3) == 0   ? kept_.drive().inputs() ^ bit
                                                  : below(2) == 0 ? 0x0B
                                                                  : 0x0B | bit);
        both([&](Twin& twin) { twin.drive().set_inputs(levels); });
        break;
      }
      case 3: {
        runtime::AnalogInputs analog;
        analog.ai1 = {static_cast<int32_t>(below(20'001)) - 10'000, static_cast<int32_t>(below(20'001))};
        analog.ai2 = {static_cast<int32_t>(below(20'001)) - 10'000, static_cast<int32_t>(below(20'001))};
        analog.frequency = static_cast<int32_t>(below(30'000));
        analog.potentiometer = static_cast<int32_t>(below(1001));
        both([&](Twin& twin) { twin.drive().set_analog(analog); });
        break;
      }
      case 4:
      case 5:
      case 6: {
        static constexpr PoSource kSources[] = {PoSource::Rs485, PoSource::Fieldbus, PoSource::Sbus,
                                                PoSource::Sbus2};
        const PoSource source = kSources[below(4)];
        Words& words = words_;  // at times the same again
        if (below(2) == 0)
          for (uint16_t& word : words) word = static_cast<uint16_t>(random_());
        if (below(4) == 0) words[0] = static_cast<uint16_t>(6U | (below(4) == 0 ? 1U << below(16) : 0U));
        const bool cyclic = below(3) != 0;
        if (below(6) == 0)
          both([&](Twin& twin) { twin.drive().take_request(source); });
        else
          for (uint32_t again = below(3); again < 3; ++again) take_po(source, words, cyclic);
        break;
      }
      case 7: {
        const uint32_t word = below(2) == 0 ? 0 : 1U << below(32);
        both([&](Twin& twin) { twin.drive().set_ipos_control_word(word); });
        break;
      }
      case 8: {
        const auto levels = static_cast<uint16_t>(random_());
        both([&](Twin& twin) { twin.drive().set_ipos_outputs(levels); });
        break;
      }
      case 9: {
        position_.controls = below(4) == 0;
        position_.speed = static_cast<int32_t>(below(3'000'001)) - 1'500'000;
        position_.halt = static_cast<Command>(below(12) == 0 ? below(6) : 5);
        position_.in_position = below(2) == 0;
        position_.referenced = below(2) == 0;
        break;
      }
      case 10: {
        const auto number = static_cast<uint8_t>(below(100));
        if (below(4) == 0)
          both([&](Twin& twin) {
            twin.drive().set_fault_response(number, FaultResponse{static_cast<uint8_t>(number % 8)});
          });
        else
          both([&](Twin& twin) { twin.drive().raise_fault(number); });
        break;
      }
      case 11: both([](Twin& twin) { twin.drive().reset_fault(); }); break;
      case 12:
        if (below(20) == 0)
          both([](Twin& twin) {
            twin.rig.parameters.power_cycle();
            twin.drive().power_cycle();
          });
        break;
      case 13: {
        const auto counter = static_cast<int32_t>(random_());
        both([&](Twin& twin) { twin.drive().set_position(counter); });
        break;
      }
      default: write();
    }
  }

  // A legal value of any parameter, past the access or over the channel, or whatever number.
  void write() {
    static constexpr const char* kFavourites[] = {
        "100", "101", "110", "115", "120", "130", "131", "136", "301", "302", "303", "340", "350", "500",
        "501", "600", "601", "602", "603", "604", "620", "621", "700", "720", "730", "812", "815", "819",
        "841", "870", "871", "872", "876", "250", "121", "122", "830", "836", "837", "893", "802"};
    const auto& table = kept_.rig.parameters.table();
    const stdlib::Parameter* parameter = table.find(indices_[below(static_cast<uint32_t>(indices_.size()))]);
    if (below(4) != 0)
      if (const auto* row = table.find(kFavourites[below(std::size(kFavourites))])) parameter = row;
    if (parameter == nullptr) return;
    int64_t value = static_cast<int32_t>(random_());
    if (!parameter->texts.empty() && below(2) == 0)
      value = parameter->texts[below(static_cast<uint32_t>(parameter->texts.size()))].value;
    else if (!parameter->ranges.empty() && below(8) != 0) {
      const auto& range = parameter->ranges[below(static_cast<uint32_t>(parameter->ranges.size()))];
      const int64_t steps = (range.maximum - range.minimum) / range.step;
      value = range.minimum + range.step * static_cast<int64_t>(random_() % static_cast<uint64_t>(steps + 1));
    }
    const auto number = static_cast<int32_t>(value);
    const uint16_t index = parameter->index;
    switch (below(4)) {
      case 0: both([&](Twin& twin) { twin.drive(), twin.rig.parameters.preset(index, number); }); break;
      case 1: both([&](Twin& twin) { twin.drive(), twin.rig.parameters.set_working(index, number); }); break;
      default: {
        int codes[2] = {};
        int n = 0;
        both([&](Twin& twin) {
          twin.drive();
          const auto reply = twin.rig.parameters.execute(ParameterService::WriteVolatile, index, number);
          codes[n++] = reply ? 0 : reply.error().additional;
        });
        EXPECT_EQ(codes[0], codes[1]) << "write of index " << index;
      }
    }
  }

  void compare() {
    Drive& a = kept_.drive();
    EXPECT_TRUE(a.axis() == anew_.drive().axis());
    EXPECT_EQ(a.outputs(), anew_.drive().outputs());
    EXPECT_EQ(a.setpoint().speed, anew_.drive().setpoint().speed);
    EXPECT_EQ(a.setpoint().requested, anew_.drive().setpoint().requested);
    EXPECT_EQ(a.setpoint().note, anew_.drive().setpoint().note);
    EXPECT_EQ(a.fault(), anew_.drive().fault());
    EXPECT_EQ(a.resets(), anew_.drive().resets());
    EXPECT_EQ(a.verdict().command, anew_.drive().verdict().command);
    EXPECT_EQ(a.verdict().reason, anew_.drive().verdict().reason);
    EXPECT_EQ(a.display(), anew_.drive().display());
    EXPECT_EQ(a.ready(), anew_.drive().ready());
    EXPECT_EQ(a.status_word_1(), anew_.drive().status_word_1());
    EXPECT_EQ(a.status_word_2(), anew_.drive().status_word_2());
    EXPECT_EQ(a.pi(), anew_.drive().pi());
    EXPECT_EQ(a.reserved_control_bits(), anew_.drive().reserved_control_bits());
    EXPECT_EQ(a.bus_position(), anew_.drive().bus_position());
    EXPECT_EQ(a.can_position(), anew_.drive().can_position());
    EXPECT_EQ(a.follows(), anew_.drive().follows());
    EXPECT_EQ(a.po_data_enabled(), anew_.drive().po_data_enabled());
    const runtime::Terminals &ours = a.terminals(), &theirs = anew_.drive().terminals();
    for (unsigned f = 0; f < 33; ++f) {
      const auto function = static_cast<runtime::InputFunction>(f);
      EXPECT_EQ(ours.on(function), theirs.on(function));
      EXPECT_EQ(ours.off(function), theirs.off(function));
    }
    for (const char* counter : {"015", "016", "017"})
      if (kept_.rig.parameters.table().find(counter) != nullptr) {
        EXPECT_EQ(kept_.rig.value(counter), anew_.rig.value(counter)) << counter;
      }
    moved_ += a.axis().speed != 0 ? 1 : 0;
  }

  // Where the words bring nothing new, nothing that is decided changes, nor what is known of the next ticks: that the one drive
  // only hears them again is the same as that the other one takes them.
  void take_po(PoSource source, const Words& words, bool cyclic) {
    Drive& drive = kept_.drive();
    const uint32_t changes = drive.changes();
    const auto left = drive.steady_left();
    if (cyclic && drive.hear_again(source, words)) {
      ++heard_again_;
      EXPECT_EQ(drive.changes(), changes);
      EXPECT_EQ(drive.steady_left(), left);
    } else {
      drive.take_po(source, words, cyclic);
    }
    anew_.drive().take_po(source, words, cyclic);
    EXPECT_EQ(drive.po(), anew_.drive().po());
  }

  std::mt19937 random_;
  Twin kept_;
  Twin anew_;
  PositionControl position_;
  Words words_{};
  std::vector<uint16_t> indices_;
  uint32_t moved_ = 0;
  uint32_t heard_again_ = 0;
};

class KeptDecisions : public ::testing::TestWithParam<const char*> {};

TEST_P(KeptDecisions, EqualDecisionsMadeAnew) {
  uint32_t moved = 0, gone_on = 0, travelled = 0, heard_again = 0;
  for (uint32_t seed = 1; seed <= 12 && !HasFailure(); ++seed) {
    DriveOptions options;
    options.start_up_ms = seed % 3 == 0 ? 50 : 0;
    Pair pair(GetParam(), options, seed);
    for (int step = 0; step < 600 && !HasFailure(); ++step) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", step " << step);
      pair.step();
    }
    moved += pair.moved();
    gone_on += pair.gone_on();
    travelled += pair.travelled();
    heard_again += pair.heard_again();
  }
  std::printf("%u ticks gone on, %u travelled\n", gone_on, travelled);
  EXPECT_GT(moved, 10'000U) << "the random orders should let the axis move";
  EXPECT_GT(travelled, 1'000U) << "and positioning, too";
  EXPECT_GT(heard_again, 100U) << "and telegrams come that bring nothing new";
}

// What gets too hot at a constant speed is told in the millisecond in which it does.
TEST(Steady, HeatIsToldInItsMillisecond) {
  struct Case {
    int32_t heat_sink_rise, load;
    uint8_t fault;
  };
  for (const Case& c : {Case{10, 130'000, 84}, Case{120, 60'000, 11}}) {
    MachineData machine;
    machine.motor_heat_time_ms = 5'000;
    machine.heat_sink_time_ms = 5'000;
    machine.heat_sink_rise = c.heat_sink_rise;
    machine.load_torque = c.load;
    Twin kept("mdxb", {}, machine, false), anew("mdxb", {}, machine, true);
    for (Twin* twin : {&kept, &anew}) {
      twin->rig.set("340", 1);
      twin->rig.set("160", 500'000);
      twin->drive().set_inputs(0x1B);
    }
    int ms = 0;
    for (; ms < 60'000 && anew.drive().fault() == 0; ++ms) {
      kept.tick({});
      anew.tick({});
      ASSERT_EQ(kept.drive().fault(), anew.drive().fault()) << "after " << ms << " ms";
    }
    EXPECT_EQ(anew.drive().fault(), c.fault) << "after " << ms << " ms";
  }
}

// Ticks that only travel count the time at the current limit, too: P500, P501. The load is more than the
// motor holds, so the axis is dragged down while positioning orders more and more.
TEST(Travel, TheTimeAtTheCurrentLimitIsCounted) {
  for (const int32_t mode : {0, 1, 2, 3}) {
    MachineData machine;
    machine.load_torque = 200'000;
    Twin kept("mdxb", {}, machine, false), anew("mdxb", {}, machine, true);
    for (Twin* twin : {&kept, &anew}) {
      twin->rig.set("500", mode);
      twin->rig.set("501", 300);
      twin->rig.set("700", 13);
      twin->drive().set_inputs(0x1B);
    }
    PositionControl position;
    position.controls = true;
    int ms = 0;
    for (; ms < 2000 && anew.drive().fault() == 0; ++ms) {
      position.speed += 500;
      kept.tick(position);
      anew.tick(position);
      ASSERT_EQ(kept.drive().fault(), anew.drive().fault()) << "mode " << mode << " after " << ms << " ms";
    }
    EXPECT_EQ(anew.drive().fault(), mode == 2 || mode == 3 ? 8 : 0) << "mode " << mode;
    EXPECT_GT(kept.travelled, 100U) << "mode " << mode;
  }
}

INSTANTIATE_TEST_SUITE_P(Units, KeptDecisions, ::testing::Values("mdxb", "md60a", "mc07"));

}  // namespace
}  // namespace ipos::tests
