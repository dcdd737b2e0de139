// The search of a reference travel, level by level: where it goes, how fast, when it turns round, and which end of the
// switch it takes (docs/inside/positioning.md; the types are those of 1053 1610 p. 83).
#include <gtest/gtest.h>

#include "runtime/positioning/reference_travel.hpp"

namespace ipos::runtime {
namespace {

using Outcome = ReferenceTravel::Outcome;
using SearchOrder = ReferenceTravel::Order;

// By type: where it searches, and in which direction it leaves the switch.
struct Type {
  int type, to, leave;
  bool limit;  // its switch is the limit switch of that side, else the cam
  bool turns;  // at a limit switch
};
constexpr Type kTypes[] = {{1, -1, -1, false, true}, {2, 1, 1, false, true},   {3, 1, -1, true, false},
                           {4, -1, 1, true, false},  {6, 1, -1, false, false}, {7, -1, 1, false, false}};

struct Search {
  ReferenceTravel travel;
  ReferenceInputs in;
  const Type& type;

  explicit Search(const Type& of, bool zero_pulse = false) : type(of) {
    in.has_cam = in.has_limits = true;
    travel.start(type.type, zero_pulse);
  }
  bool& limit(int way) { return way > 0 ? in.limit_cw : in.limit_ccw; }
  bool& its_switch() { return type.limit ? limit(type.to) : in.cam; }
  void expect_moving(int way, bool fast) {
    ASSERT_EQ(travel.tick(in), Outcome::Moving);
    EXPECT_EQ(travel.order(), (SearchOrder{way, fast}));
    EXPECT_TRUE(travel.active());
  }
};

TEST(ReferenceSearch, FindsTheEndOfItsSwitch) {
  for (const Type& type : kTypes) {
    SCOPED_TRACE(type.type);
    Search search(type);
    EXPECT_TRUE(search.travel.moves());
    for (int n = 0; n < 3; ++n) search.expect_moving(type.to, true);
    search.its_switch() = true;
    search.in.way = type.to;
    search.expect_moving(type.leave, false);
    if (type.leave != type.to) {
      // Still braking it may pass the switch: that end is not the one.
      search.its_switch() = false;
      search.expect_moving(type.leave, false);
      search.in.way = 0;
      search.expect_moving(type.leave, false);
      search.in.way = type.leave;
      search.expect_moving(type.leave, false);
    }
    search.its_switch() = true;
    search.in.way = type.leave;
    search.expect_moving(type.leave, false);
    search.its_switch() = false;
    search.in.position = -4'711;
    EXPECT_EQ(search.travel.tick(search.in), Outcome::Found);
    EXPECT_EQ(search.travel.found(), -4'711);
    EXPECT_FALSE(search.travel.active());
  }
}

TEST(ReferenceSearch, GoesOnToTheZeroPulse) {
  for (const Type& type : kTypes) {
    SCOPED_TRACE(type.type);
    Search search(type, true);
    search.its_switch() = true;
    search.in.way = type.leave;
    search.expect_moving(type.leave, false);
    search.its_switch() = false;
    search.in.zero_pulse_cw = search.in.zero_pulse_ccw =
        1;  // in the millisecond of the edge it is not yet wanted
    search.expect_moving(type.leave, false);
    search.in.zero_pulse_cw = search.in.zero_pulse_ccw = std::nullopt;
    search.expect_moving(type.leave, false);
    (type.leave > 0 ? search.in.zero_pulse_ccw : search.in.zero_pulse_cw) = 7;  // passed the other way
    search.expect_moving(type.leave, false);
    (type.leave > 0 ? search.in.zero_pulse_cw : search.in.zero_pulse_ccw) = 8'192;
    EXPECT_EQ(search.travel.tick(search.in), Outcome::Found);
    EXPECT_EQ(search.travel.found(), 8'192);
  }
}

// Types 1 and 2 turn round once; the limit switch of the way it goes counts, not that behind it.
TEST(ReferenceSearch, TurnsAtALimitSwitchOnce) {
  for (const Type& type : kTypes) {
    if (type.limit) continue;
    SCOPED_TRACE(type.type);
    Search search(type);
    search.limit(-type.to) = true;  // it began there
    search.expect_moving(type.to, true);
    search.limit(-type.to) = false;
    search.limit(type.to) = true;
    if (!type.turns) {
      EXPECT_EQ(search.travel.tick(search.in), Outcome::CamMissing);
      continue;
    }
    search.expect_moving(-type.to, true);
    search.expect_moving(-type.to, true);  // it is still there
    search.limit(type.to) = false;
    search.expect_moving(-type.to, true);
    search.limit(-type.to) = true;
    EXPECT_EQ(search.travel.tick(search.in), Outcome::CamMissing);
  }
}

// A limit switch in the way that leads off the switch, or to the zero pulse, is the end.
TEST(ReferenceSearch, ALimitSwitchAheadIsTheEnd) {
  for (const Type& type : kTypes) {
    if (type.limit) continue;
    for (const bool at_pulse : {false, true}) {
      SCOPED_TRACE(type.type);
      Search search(type, at_pulse);
      search.its_switch() = true;
      search.in.way = type.leave;
      search.expect_moving(type.leave, false);
      search.its_switch() = !at_pulse;
      search.expect_moving(type.leave, false);
      search.limit(-type.leave) = true;
      search.expect_moving(type.leave, false);
      search.limit(type.leave) = true;
      EXPECT_EQ(search.travel.tick(search.in), Outcome::CamMissing);
    }
  }
}

TEST(ReferenceSearch, InputsThatItNeedsHaveToBeThere) {
  for (const Type& type : kTypes) {
    Search without_cam(type), without_limits(type);
    without_cam.in.has_cam = false;
    without_limits.in.has_limits = false;
    EXPECT_EQ(without_cam.travel.tick(without_cam.in), type.limit ? Outcome::Moving : Outcome::CamMissing);
    EXPECT_EQ(without_limits.travel.tick(without_limits.in),
              type.limit ? Outcome::LimitsMissing : Outcome::Moving);
  }
}

// Type 0 goes CCW to the next zero pulse; 5 takes the place where it is; what is no type is 0.
TEST(ReferenceSearch, WithoutASwitch) {
  for (const int type : {0, -1, 8, 1'000}) {
    ReferenceTravel travel;
    travel.start(type, false);
    EXPECT_EQ(travel.type(), 0);
    EXPECT_TRUE(travel.moves());
    ReferenceInputs in;
    in.zero_pulse_cw = 3;
    EXPECT_EQ(travel.tick(in), Outcome::Moving);
    EXPECT_EQ(travel.order(), (SearchOrder{-1, false}));
    in.limit_cw = true;
    EXPECT_EQ(travel.tick(in), Outcome::Moving);
    in.limit_ccw = true;
    EXPECT_EQ(travel.tick(in), Outcome::CamMissing);
    in.zero_pulse_ccw = -4'096;
    EXPECT_EQ(travel.tick(in), Outcome::Found);
    EXPECT_EQ(travel.found(), -4'096);
  }
  ReferenceTravel stays;
  stays.start(5, true);
  EXPECT_FALSE(stays.moves());
  ReferenceInputs in;
  in.position = 77;
  EXPECT_EQ(stays.tick(in), Outcome::Found);
  EXPECT_EQ(stays.found(), 77);
}

}  // namespace
}  // namespace ipos::runtime
