// Reference travels of all types on a machine with cam, limit switches and zero pulses at known places.
#include <gtest/gtest.h>

#include "tests/runtime/positioning/rig.hpp"

namespace ipos::tests {
namespace {

// Inputs: DI02 reference cam, DI04 /limit switch CW, DI05 /limit switch CCW.
struct Machine {
  int64_t cam_left = -30'000, cam_right = -22'000;
  int64_t limit_ccw = -90'000, limit_cw = 80'000;

  uint16_t levels(int64_t at) const {
    uint16_t bits = kEnabled & ~(1 << 2);
    if (at >= cam_left && at <= cam_right) bits |= 1 << 2;
    if (at < limit_cw) bits |= 1 << 4;
    if (at > limit_ccw) bits |= 1 << 5;
    return bits;
  }
};

struct ReferenceRig : Rig {
  ReferenceRig(int32_t type, const Machine& m, Settings more = {})
      : Rig({{"903", type},
             {"601", 17},
             {"603", 14},
             {"604", 15},
             {"901", 600'000},
             {"902", 60'000},
             {"900", 500},
             {"911", 200},
             {"912", 200}}),
        machine(m) {
    for (const auto& [number, value] : more) set(number, value);
    levels = [this](int64_t at) { return machine.levels(at); };
    drive.reset_fault();  // the rig began with both limit switches at 0
    run(2);
  }
  // Runs to the end; the mechanical place that has the number of P900 now.
  int64_t reference(bool zero_pulse) {
    positioner().start_reference(false, zero_pulse);
    run_until([&] { return !positioner().referencing() && arrived(); });
    EXPECT_TRUE(referenced());
    return mechanical - h[511] + 500;
  }
  Machine machine;
};

// P902 = 60 rpm are 4.1 increments a millisecond: the edge is seen in the millisecond after it.
constexpr int64_t kEdge = 9;

// First zero pulse, a multiple of 4096, beyond an edge.
int64_t pulse_below(int64_t at) { return at - (at % 4096 + 4096) % 4096; }
int64_t pulse_above(int64_t at) { return -pulse_below(-at); }

TEST(ReferenceTravel, Type0ZeroPulseCcw) {
  for (const int64_t start : {0, 10, 4095, 4096, 5000}) {
    ReferenceRig rig(0, {});
    rig.go(static_cast<int32_t>(start));
    rig.run_to_target();
    EXPECT_EQ(rig.reference(false), start % 4096 == 0 ? start - 4096 : pulse_below(start))
        << "from " << start;
  }
}

// Type, where it starts, the edge it finds and the direction in which it is left.
struct Case {
  int32_t type;
  int32_t start;
  int64_t edge;
  int way;
};

TEST(ReferenceTravel, EveryTypeFindsItsEdge) {
  const Machine m;
  const Machine at_cw{70'000, 85'000, -90'000, 80'000};     // cam flush with the CW limit switch
  const Machine at_ccw{-95'000, -80'000, -90'000, 80'000};  // with the CCW one
  struct Row {
    Machine machine;
    Case c;
  };
  const Row rows[] = {
      {m, {1, 0, m.cam_left, -1}},        // from the right
      {m, {1, -60'000, m.cam_left, -1}},  // from the left: turns at the limit switch
      {m, {1, -25'000, m.cam_left, -1}},  // from the cam
      {m, {2, 0, m.cam_right, 1}},        // turns at the limit switch
      {m, {2, -60'000, m.cam_right, 1}},     {m, {2, -25'000, m.cam_right, 1}},
      {m, {3, 0, m.limit_cw, -1}},           {m, {4, 0, m.limit_ccw, 1}},
      {at_cw, {6, 0, at_cw.cam_left, -1}},   {at_cw, {6, 75'000, at_cw.cam_left, -1}},
      {at_ccw, {7, 0, at_ccw.cam_right, 1}}, {at_ccw, {7, -85'000, at_ccw.cam_right, 1}},
  };
  for (const auto& [machine, c] : rows)
    for (const bool zero_pulse : {false, true}) {
      SCOPED_TRACE(testing::Message()
                   << "type " << c.type << " from " << c.start << (zero_pulse ? " ZP" : " CAM"));
      ReferenceRig rig(c.type, machine);
      rig.go(c.start);
      rig.run_to_target();
      const int64_t found = rig.reference(zero_pulse);
      if (zero_pulse)
        EXPECT_EQ(found, c.way > 0 ? pulse_above(c.edge) : pulse_below(c.edge));
      else
        EXPECT_NEAR(static_cast<double>(found), static_cast<double>(c.edge), kEdge);
      EXPECT_EQ(rig.drive.fault(), 0);
      EXPECT_EQ(rig.drive.axis().position, rig.h[511]) << "the axis counts as H511 does";
      EXPECT_EQ(rig.h[492], rig.h[511]) << "the target is where it stopped";
      rig.go(500 + c.way * 3'000);
      rig.run_to_target();
      EXPECT_EQ(rig.mechanical, found + c.way * 3'000);
    }
}

// The brake way from P901 is longer than this cam: the axis comes back over it and leaves it at its left edge, the
// second time as the first.
TEST(ReferenceTravel, AShortCamThatIsOverrunIsFoundEachTime) {
  Machine machine;
  machine.cam_right = machine.cam_left + 300;
  ReferenceRig rig(1, machine);
  for (int times = 0; times < 3; ++times) {
    SCOPED_TRACE(times);
    rig.go(static_cast<int32_t>(-60'000 - rig.mechanical + rig.h[511]));
    rig.run_to_target();
    ASSERT_EQ(rig.mechanical, -60'000);
    EXPECT_NEAR(static_cast<double>(rig.reference(false)), static_cast<double>(machine.cam_left), kEdge);
  }
}

TEST(ReferenceTravel, Type5TakesThePlaceItIsAtWithoutEnable) {
  Rig rig({{"903", 5}, {"900", -700}});
  rig.go(10'000);
  rig.run_to_target();
  rig.drive.set_inputs(0);
  rig.run(300);
  EXPECT_FALSE(rig.referenced());
  rig.positioner().start_reference(false, true);
  rig.tick();
  EXPECT_TRUE(rig.referenced());
  EXPECT_EQ(rig.h[511], -700);
  EXPECT_EQ(rig.h[492], -700);
  EXPECT_EQ(rig.h[498], -700);
  EXPECT_EQ(rig.drive.axis().position, -700);
}

TEST(ReferenceTravel, SpeedsAreThoseOfP901AndP902) {
  ReferenceRig rig(1, {});
  rig.positioner().start_reference(false, false);
  rig.run(300);
  EXPECT_NEAR(rig.drive.axis().speed, -600'000, 3'000);
  rig.run_until([&] { return (rig.drive.inputs() & 1 << 2) != 0; });
  rig.run(400);
  EXPECT_NEAR(rig.drive.axis().speed, -60'000, 1'000);
}

TEST(ReferenceTravel, ConditionalOnlyOnce) {
  Rig rig({{"903", 5}});
  rig.positioner().start_reference(true, false);
  EXPECT_TRUE(rig.positioner().referenced());
  rig.go(8'000);
  rig.run_to_target();
  rig.positioner().start_reference(true, false);
  rig.run(2);
  EXPECT_EQ(rig.h[511], 8'000);
  rig.positioner().start_reference(false, false);
  rig.run(2);
  EXPECT_EQ(rig.h[511], 0);
}

TEST(ReferenceTravel, ResetEndsItAndForgetsTheReference) {
  ReferenceRig rig(1, {});
  rig.reference(false);
  rig.positioner().end_reference();
  rig.tick();
  EXPECT_FALSE(rig.referenced());
  rig.positioner().start_reference(false, false);
  rig.run(50);
  EXPECT_FALSE(rig.in_position());
  rig.positioner().end_reference();
  rig.run_to_target();
  EXPECT_FALSE(rig.referenced());
  EXPECT_FALSE(rig.positioner().referencing());
}

TEST(ReferenceTravel, NoCamIsF39) {
  for (const int32_t type : {1, 2, 6, 7}) {
    ReferenceRig rig(type, {0, -1, -20'000, 20'000});  // a cam that is nowhere
    rig.positioner().start_reference(false, false);
    rig.run_until([&] { return rig.drive.fault() != 0; });
    EXPECT_EQ(rig.drive.fault(), 39) << type;
    EXPECT_FALSE(rig.referenced());
    Rig without_input({{"903", type}});
    without_input.positioner().start_reference(false, false);
    without_input.run(3);
    EXPECT_EQ(without_input.drive.fault(), 39) << type;
  }
  // A zero pulse behind the limit switch.
  ReferenceRig rig(0, {0, 0, -50, 20'000});
  rig.positioner().start_reference(false, true);
  rig.run_until([&] { return rig.drive.fault() == 39; });
}

// The end of the cam, or the zero pulse behind it, lies behind the limit switch.
TEST(ReferenceTravel, ALimitSwitchBeforeTheReferencePointIsF39) {
  const auto fails = [](int32_t type, const Machine& machine, bool zero_pulse, int32_t start) {
    SCOPED_TRACE(testing::Message() << "type " << type << (zero_pulse ? " ZP" : " CAM"));
    ReferenceRig rig(type, machine);
    rig.go(start);
    rig.run_to_target();
    rig.positioner().start_reference(false, zero_pulse);
    rig.run_until([&] { return rig.drive.fault() != 0; }, 10'000);
    EXPECT_EQ(rig.drive.fault(), 39);
    EXPECT_FALSE(rig.referenced());
    return rig.mechanical;
  };
  // A limit switch is seen in the millisecond after it, and P902 goes 4.1 increments in one.
  for (const int32_t type : {1, 6})
    EXPECT_NEAR(static_cast<double>(fails(type, {-9'000, 9'000, -2'000, 2'000}, false, 0)), -2'000, 50);
  for (const int32_t type : {2, 7})
    EXPECT_NEAR(static_cast<double>(fails(type, {-9'000, 9'000, -2'000, 2'000}, false, 0)), 2'000, 50);
  // The edge is at 7000 increments, the zero pulse at 8192.
  for (const int32_t type : {1, 6})
    EXPECT_NEAR(static_cast<double>(fails(type, {-7'000, 9'000, -7'500, 9'000}, true, 0)), -7'500, 50);
  for (const int32_t type : {2, 7})
    EXPECT_NEAR(static_cast<double>(fails(type, {-9'000, 7'000, -9'000, 7'500}, true, 0)), 7'500, 50);
}

TEST(ReferenceTravel, NoLimitSwitchesIsF27) {
  for (const int32_t type : {3, 4}) {
    Rig rig({{"903", type}});
    rig.positioner().start_reference(false, false);
    rig.run(3);
    EXPECT_EQ(rig.drive.fault(), 27);
  }
}

TEST(ReferenceTravel, OtherTypeOnTheWayIsF39) {
  ReferenceRig rig(1, {});
  rig.positioner().start_reference(false, false);
  rig.run(50);
  rig.service.set_parameter("903", 2);
  rig.run(2);
  EXPECT_EQ(rig.drive.fault(), 39);
}

TEST(ReferenceTravel, InterruptedItBeginsAnew) {
  ReferenceRig rig(2, {});
  rig.positioner().start_reference(false, false);
  rig.run(1'500);
  rig.levels = [&](int64_t at) { return static_cast<uint16_t>(rig.machine.levels(at) & ~(1 << 3)); };
  rig.run(500);
  EXPECT_TRUE(rig.positioner().referencing());
  EXPECT_FALSE(rig.referenced());
  rig.levels = [&](int64_t at) { return rig.machine.levels(at); };
  rig.run_until([&] { return !rig.positioner().referencing() && rig.arrived(); });
  EXPECT_NEAR(static_cast<double>(rig.mechanical - rig.h[511] + 500), -22'000, kEdge);
}

// Turned round at the limit switch and then interrupted: anew means in the direction of its type first, and again
// to the zero pulse.
TEST(ReferenceTravel, InterruptedBehindTheTurnItBeginsAnew) {
  const Machine m;
  struct Row {
    int32_t type, start, interrupted;
    int way;
    int64_t edge;
  };
  for (const Row& row : {Row{2, 70'000, 40'000, 1, m.cam_right}, Row{1, -80'000, -60'000, -1, m.cam_left}}) {
    SCOPED_TRACE(row.type);
    ReferenceRig rig(row.type, m);
    rig.go(row.start);
    rig.run_to_target();
    rig.positioner().start_reference(false, true);
    rig.run_until([&] {
      return row.way * rig.drive.axis().speed < 0 && row.way * (rig.mechanical - row.interrupted) < 0;
    });
    rig.levels = [&](int64_t at) { return static_cast<uint16_t>(rig.machine.levels(at) & ~(1 << 3)); };
    rig.run(500);
    EXPECT_TRUE(rig.drive.axis().standing);
    rig.levels = [&](int64_t at) { return rig.machine.levels(at); };
    rig.run(400);
    EXPECT_NEAR(rig.drive.axis().speed, row.way * 600'000, 3'000);
    rig.run_until([&] { return !rig.positioner().referencing() && rig.arrived(); });
    EXPECT_EQ(rig.mechanical - rig.h[511] + 500, row.way > 0 ? pulse_above(row.edge) : pulse_below(row.edge));
    EXPECT_EQ(rig.drive.fault(), 0);
  }
}

// Also where a fault of its own has interrupted it.
TEST(ReferenceTravel, BehindF39ItBeginsAnewWithTheReset) {
  ReferenceRig rig(1, {0, -1, -20'000, 20'000});  // a cam that is nowhere
  rig.positioner().start_reference(false, false);
  rig.run_until([&] { return rig.drive.fault() == 39; });
  rig.run(500);
  EXPECT_TRUE(rig.drive.axis().standing);
  rig.machine = {};
  rig.drive.reset_fault();
  rig.run_until([&] { return rig.referenced() && rig.arrived(); });
  EXPECT_NEAR(static_cast<double>(rig.mechanical - rig.h[511] + 500), -30'000, kEdge);
  EXPECT_EQ(rig.drive.fault(), 0);
}

TEST(ReferenceTravel, OrdersWaitForItsEnd) {
  ReferenceRig rig(1, {});
  rig.positioner().start_reference(false, false);
  rig.run(20);
  rig.go(10'000);
  rig.go_by(500);
  EXPECT_TRUE(rig.positioner().referencing());
  rig.run_until([&] { return rig.arrived(); });
  EXPECT_EQ(rig.h[511], 10'500);
  EXPECT_NEAR(static_cast<double>(rig.mechanical), -30'000 + 10'000, kEdge);
}

TEST(ReferenceTravel, StartedByAnInput) {
  Rig rig({{"903", 5}, {"602", 18}, {"603", 1}, {"900", 77}});
  rig.drive.set_inputs(0b10011);
  rig.run(3);
  EXPECT_FALSE(rig.referenced());
  rig.drive.set_inputs(0b11011);
  rig.run(3);
  EXPECT_TRUE(rig.referenced());
  EXPECT_EQ(rig.h[511], 77);
}

TEST(ReferenceTravel, OfTheExternalEncoder) {
  ReferenceRig rig(1, {}, {{"941", 1}, {"942", 2}, {"943", 1}});
  rig.run(2);
  rig.positioner().start_reference(false, false);
  rig.run_until([&] { return !rig.positioner().referencing() && rig.arrived_external(); });
  EXPECT_NEAR(static_cast<double>(rig.mechanical) / 2 - rig.h[510] + 500, -15'000, kEdge);
}

}  // namespace
}  // namespace ipos::tests
