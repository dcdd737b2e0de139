// The setpoint cascade against the law that the manuals print (1053 1610 p. 72; 11 MOVITRAC 07 chapters 6.4, 10.2),
// written here a second time in floating point: every source with every fixed setpoint, direction and sign.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "runtime/drive/setpoint.hpp"

namespace ipos::runtime {
namespace {

constexpr double kTenVolts = 10'000;

bool of_a_bus(int source) { return source == 2 || source == 3 || (source >= 8 && source <= 10); }

// What the source demands, before limits and without the direction of terminals. Quotients are cut towards 0 (ours).
double demand(const Settings& s, const ParameterSet& active, const ParameterSet& fixed_set,
              const SetpointInputs& in, int source) {
  const double fixed[] = {0, double(fixed_set.n1), double(fixed_set.n2), double(fixed_set.n3)};
  const double top = active.maximum_speed;
  const double ai1 = in.ai1_speed;
  if (of_a_bus(source)) return in.po_enabled && in.bus_accepted && in.bus_speed ? *in.bus_speed : 0;
  if (source == 6) return fixed[in.fixed] + ai1;
  if (source == 7)
    return std::trunc(fixed[in.fixed] * ai1 / (s.ai1_mode == 0 ? 3e6 : top));  // the share of 10 V
  if (in.fixed != 0) return fixed[in.fixed];
  switch (source) {
    case 4: return in.motor_pot;
    case 5: return in.motor_pot + ai1;
    case 11: return std::trunc(top * in.analog.frequency / (s.frequency_scale * 10.0));
    default: break;
  }
  const double ai2 = s.ai2_mode == 1 ? std::trunc(in.analog.ai2.millivolt * top / kTenVolts) : 0;
  return source == 1 && in.unipolar_is_amount ? std::abs(ai1 + ai2) : ai1 + ai2;
}

// CCW of the terminals, or of the motor potentiometer where it is the source; a bus has its sign alone.
bool turned(const SetpointInputs& in, int source) {
  if (of_a_bus(source)) return false;
  return in.ccw || (in.motor_pot_ccw && in.fixed == 0 && (source == 4 || source == 5));
}

// The amount between minimum and maximum; a demand of 0 has the direction CW, and a minimum above the maximum is
// the maximum.
double limited(double speed, double minimum, double maximum) {
  const double amount = std::min(std::max(std::abs(speed), minimum), maximum);
  return speed < 0 ? -amount : amount;
}

struct Case {
  Settings settings;
  ParameterSet active, other;
  SetpointInputs in;

  Case() {
    active.n1 = 150'000, active.n2 = -750'000, active.n3 = 1'234'567;
    other.n1 = 500'000, other.n2 = 20'000, other.n3 = -1'600'001;
    active.minimum_speed = 60'000;
    active.maximum_speed = 1'500'000;
    in.analog.ai2.millivolt = -2500;
    in.analog.frequency = 3'210;
    in.bus_speed = -321'000;
    in.bus_accepted = true;
    in.motor_pot = 432'100;
  }
};

void expect_law(const Case& c) {
  const bool master = c.settings.setpoint_source == 8 || c.settings.setpoint_source == 9;
  const int source = master && c.in.slave_free_run ? 0 : c.settings.setpoint_source;
  const double wanted = demand(c.settings, c.active, c.in.other_set ? c.other : c.active, c.in, source);
  const double maximum = c.in.maximum_speed
                             ? std::clamp<double>(*c.in.maximum_speed, 0, c.active.maximum_speed)
                             : c.active.maximum_speed;
  const int way = turned(c.in, source) ? -1 : 1;
  const Setpoint got = select_setpoint(c.settings, c.active, c.other, c.in);
  ASSERT_EQ(got.requested, way * wanted);
  ASSERT_EQ(got.speed, way * limited(wanted, c.active.minimum_speed, maximum));
}

TEST(SetpointLaw, EverySourceFixedSetpointDirectionAndSign) {
  int cases = 0;
  for (int source = 0; source <= 11; ++source)
    for (int fixed = 0; fixed <= 3; ++fixed)
      for (const int32_t ai1 : {-2'000'000, -750'000, -1, 0, 1, 60'000, 749'999, 1'500'000})
        for (const int32_t mode : {0, 1, 5})
          for (unsigned bits = 0; bits < 1U << 7; ++bits) {
            Case c;
            c.settings.setpoint_source = source;
            c.settings.ai1_mode = mode;
            c.in.fixed = fixed;
            c.in.ai1_speed = ai1;
            c.in.other_set = (bits & 1) != 0;
            c.in.ccw = (bits & 2) != 0;
            c.in.motor_pot_ccw = (bits & 4) != 0;
            c.in.slave_free_run = (bits & 8) != 0;
            c.in.unipolar_is_amount = (bits & 16) != 0;
            c.settings.ai2_mode = (bits & 32) != 0 ? 1 : 0;
            if ((bits & 64) != 0) c.in.maximum_speed = 700'000;
            SCOPED_TRACE(testing::Message() << "P100 = " << source << ", fixed " << fixed << ", AI1 " << ai1
                                            << ", P112 = " << mode << ", bits " << bits);
            expect_law(c);
            if (::testing::Test::HasFatalFailure()) return;
            ++cases;
          }
  EXPECT_EQ(cases, 12 * 4 * 8 * 3 * 128);
}

TEST(SetpointLaw, BusSpeedsOfBothSignsAndWhatKeepsThemAway) {
  for (const int source : {2, 3, 8, 9, 10})
    for (const int32_t sent : {-2'000'000, -1'500'000, -60'001, -60'000, -1, 0, 1, 59'999, 60'000, 1'500'001})
      for (unsigned bits = 0; bits < 8; ++bits) {
        Case c;
        c.settings.setpoint_source = source;
        c.in.bus_speed = sent;
        c.in.ccw = (bits & 1) != 0;
        c.in.bus_accepted = (bits & 2) != 0;
        c.in.po_enabled = (bits & 4) != 0;
        SCOPED_TRACE(testing::Message() << "P100 = " << source << ", " << sent << ", bits " << bits);
        expect_law(c);
      }
}

// The potentiometer of MOVITRAC 07 is added to all but codes 6 and 7, the motor potentiometer, and, with P121 = 2
// or an older firmware, to no fixed setpoint (table 3).
TEST(SetpointLaw, BuiltInPotentiometerIsAddedWhereTheTableSaysSo) {
  for (int source = 0; source <= 11; ++source)
    for (int added = 0; added <= 2; ++added)
      for (int fixed = 0; fixed <= 1; ++fixed)
        for (const bool newer : {false, true}) {
          Case c;
          c.settings.setpoint_source = source;
          c.settings.potentiometer_added = added;
          c.in.fixed = fixed;
          c.in.fixed_plus_potentiometer = newer;
          const Setpoint without = select_setpoint(c.settings, c.active, c.other, c.in);
          c.in.analog.potentiometer = 300;
          const Setpoint with = select_setpoint(c.settings, c.active, c.other, c.in);
          const bool fixed_counts = fixed != 0 && !of_a_bus(source);
          const bool adds =
              added != 0 && source != 6 && source != 7 && (fixed_counts ? newer && added != 2 : source != 4);
          EXPECT_EQ(with.requested - without.requested, adds ? 450'000 : 0)
              << source << ", P121 = " << added << ", fixed " << fixed << ", newer " << newer;
        }
}

TEST(SetpointLaw, LimitsOfTheAmount) {
  ParameterSet set;
  for (const int32_t minimum : {0, 1, 60'000, 900'000, 1'500'000})
    for (const int32_t maximum : {0, 1, 60'000, 899'999, 900'000, 1'500'000})
      for (const int32_t speed :
           {0, 1, 59'999, 60'000, 60'001, 899'999, 900'000, 900'001, 1'499'999, 1'500'001})
        for (const int sign : {1, -1}) {
          set.minimum_speed = minimum;
          EXPECT_EQ(limit_setpoint(set, sign * speed, maximum), limited(sign * speed, minimum, maximum))
              << sign * speed << " between " << minimum << " and " << maximum;
        }
  EXPECT_EQ(limit_setpoint(set, INT32_MIN, 1'500'000), -1'500'000);
}

// An edge of the window is beyond a limit only when it is really outside: at P301 and P302 themselves it is not. The
// maximum holds also where no edge is within both.
TEST(SetpointLaw, SkipWindowNextToTheLimits) {
  ParameterSet set;
  set.skip_center = 600'000;
  set.skip_width = 200'000;
  for (const int32_t minimum : {0, 499'999, 500'000, 500'001})
    for (const int32_t maximum : {699'999, 700'000, 700'001, 1'500'000})
      for (int32_t speed = 499'999; speed <= 700'001; ++speed) {
        if (speed == 500'003 || speed == 600'003) speed += 99'994;
        set.minimum_speed = minimum;
        const bool inside = speed > 500'000 && speed < 700'000;
        const bool up = maximum >= 700'000 && (speed >= 600'000 || minimum > 500'000);
        const int32_t want = !inside ? speed : up ? 700'000 : 500'000;
        ASSERT_EQ(leave_skip_window(set, speed, maximum), want)
            << speed << ", " << minimum << ", " << maximum;
        ASSERT_EQ(leave_skip_window(set, -speed, maximum), -want)
            << speed << ", " << minimum << ", " << maximum;
      }
}

// P112 to P114 and P110, both signs: 10 V, 20 mA and 4 mA are where the characteristics say.
TEST(SetpointLaw, CharacteristicsOfTheAnalogInput) {
  for (const int32_t scale : {1000, 500, -2000})
    for (const int32_t offset : {0, 250})
      for (int32_t millivolt = -10'000; millivolt <= 10'000; millivolt += 1'250)
        for (int32_t mode = 0; mode <= 6; ++mode) {
          Case c;
          c.settings.ai1_mode = mode;
          c.settings.ai1_scale = scale;
          c.settings.ai1_offset = offset;
          c.settings.ai1_voltage_offset = 2'000;
          c.settings.ai1_speed_offset = 300'000;
          AnalogInputs analog;
          analog.ai1.millivolt = millivolt;
          analog.ai1.microampere = std::abs(millivolt) * 2;
          const double u = (millivolt + offset) / kTenVolts, i = std::abs(millivolt) / kTenVolts;
          const double top = c.active.maximum_speed;
          const double share = (u - 0.2) / 0.8;
          const double speeds[] = {u * 3e6,
                                   u * top,
                                   share * top,
                                   3e5 + u * (top - 3e5),
                                   3e5 + share * (top - 3e5),
                                   i * top,
                                   std::max((i * 20 - 4) / 16, 0.0) * top};
          EXPECT_NEAR(ai1_speed(c.settings, c.active, analog), speeds[mode] * scale / 1000, 3)
              << "P112 = " << mode << ", " << millivolt << " mV, P110 " << scale << ", P111 " << offset;
        }
}

}  // namespace
}  // namespace ipos::runtime
