// Units of signals and of FMUs: the same quantity, and numbers from one into the other. The figures are those of SI.
#include <gtest/gtest.h>

#include "runtime/signals/physical_units.hpp"

namespace ipos::signals {
namespace {

double from_to(double value, std::string_view from, std::string_view to) {
  return converted(value, *find_physical_unit(from), *find_physical_unit(to));
}

TEST(FmuUnits, NumbersAreConverted) {
  EXPECT_NEAR(from_to(60, "rpm", "rad/s"), 6.283185307, 1e-8);
  EXPECT_NEAR(from_to(1, "rad/s", "rpm"), 9.549296586, 1e-8);
  EXPECT_NEAR(from_to(180, "deg", "rad"), 3.141592654, 1e-8);
  EXPECT_NEAR(from_to(4096, "Inc", "deg"), 360, 1e-9);
  EXPECT_NEAR(from_to(25, "°C", "K"), 298.15, 1e-9);
  EXPECT_NEAR(from_to(0, "K", "degC"), -273.15, 1e-9);
  EXPECT_NEAR(from_to(1, "kWh", "Nm"), 3.6e6, 1e-6);
  EXPECT_NEAR(from_to(2500, "mV", "V"), 2.5, 1e-12);
  EXPECT_NEAR(from_to(50, "%", "1"), 0.5, 1e-12);
  EXPECT_EQ(from_to(0.1, "N.m", "Nm"), 0.1);  // nothing is lost
}

TEST(FmuUnits, OnlyTheSameQuantityFits) {
  const auto fits = [](std::string_view one, std::string_view other) {
    return measure_the_same(*find_physical_unit(one), *find_physical_unit(other));
  };
  EXPECT_TRUE(fits("rpm", "Hz"));  // tools leave out the radian
  EXPECT_TRUE(fits("rad", "1"));
  EXPECT_TRUE(fits("Nm", "kWh"));
  EXPECT_FALSE(fits("V", "A"));
  EXPECT_FALSE(fits("m", "mm") && fits("m", "s"));
  EXPECT_FALSE(fits("Nm", "N"));
  EXPECT_EQ(find_physical_unit("furlong"), nullptr);
}

}  // namespace
}  // namespace ipos::signals
