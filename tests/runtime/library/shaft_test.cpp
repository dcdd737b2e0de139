// What acts on a shaft from outside: a torque, or the speed of a shaft that is driven. Torques against hand calculation
// with the default machine: 1.5 kW at 1400 rpm are 10.2314 Nm, friction is 5 % of that.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/runtime/library/opened_plant.hpp"

namespace ipos::tests {
namespace {

const char* const kTurning = R"(
[[station]]
name = "u"
unit = "mdxb"
[station.parameters]
P160 = "1000 rpm"
P601 = "ENABLE/RAP.STOP"
P602 = "NO FUNCTION"
P603 = "n11/n21"
P130 = "0.1 s"
[station.inputs]
DI00 = 1
DI01 = 1
DI02 = 1
DI04 = 1
[station.load]
)";
constexpr double kRated = 10.2314;

double torque(const OpenedPlant& plant) {
  return static_cast<double>(plant.value(plant.find("torque"))) / 1'000;
}

TEST(LibraryShaft, ALoadTorqueIsCarriedByTheMotor) {
  const OpenedPlant plant(kTurning);
  const uint32_t load = plant.find("load_torque");
  EXPECT_STREQ(plant.info(load).unit, "Nm");
  plant.run(1'000);
  EXPECT_NEAR(torque(plant), 5, 0.01);
  ASSERT_EQ(ipos_plant_write_text(plant.plant, load, "-4.5 Nm"), IPOS_PLANT_OK) << plant.message();
  plant.run(1'001);
  EXPECT_NEAR(torque(plant), 5 - 100 * 4.5 / kRated, 0.01) << "from the next millisecond on";
  EXPECT_EQ(plant.text(load), "-4.5000 Nm");
  EXPECT_EQ(ipos_plant_force(plant.plant, load, 60'000), IPOS_PLANT_OK) << plant.message();
  plant.run(1'010);
  EXPECT_NEAR(torque(plant), 5 + 100 * 6 / kRated, 0.01);
  EXPECT_EQ(ipos_plant_write(plant.plant, plant.find("shaft_speed"), 1), IPOS_PLANT_READ_ONLY);
  EXPECT_EQ(ipos_plant_power(plant.plant, 0, false), IPOS_PLANT_OK);
  plant.run(1'020);
  EXPECT_EQ(torque(plant), 0) << "without power there is none";
}

// A number counts in Nm. A pulse gives back what was there.
TEST(LibraryShaft, AStimulusOfThePlantFileSetsTheLoad) {
  const auto stimulus = [](const char* at, const std::string& rows) {
    return std::string("[[stimulus]]\nstation = \"u\"\nsignal = \"load_torque\"\nat = \"") + at + "\"\n" + rows;
  };
  const OpenedPlant plant(kTurning + stimulus("1s", "set = \"-4.5 Nm\"\n") + stimulus("1100ms", "pulse = 6\nfor = \"50ms\"\n") +
                          stimulus("1200ms", "set = 2.5\n") + stimulus("1300ms", "force = 1\n") + stimulus("1310ms", "set = 0\n") +
                          stimulus("1400ms", "release = true\n"));
  const auto carries = [&](int64_t at, double load) {
    plant.run(at);
    EXPECT_NEAR(torque(plant), 5 + 100 * load / kRated, 0.01) << at;
  };
  carries(999, 0);
  carries(1'002, -4.5);
  carries(1'140, 6);
  carries(1'160, -4.5);
  carries(1'250, 2.5);
  carries(1'390, 1);  // what is forced is written again in each millisecond
}

TEST(LibraryShaft, AStimulusSetsTheSpeedOfADrivenShaft) {
  const OpenedPlant plant(std::string(kTurning) + "driven = true\n[[stimulus]]\nstation = \"u\"\nsignal = \"shaft_speed\"\nat = \"0s\"\nset = \"999.5 rpm\"\n");
  plant.run(10);
  EXPECT_EQ(plant.value(plant.find("shaft_speed")), 999'500);
}

TEST(LibraryShaft, ADrivenShaftHasItsSpeedFromOutside) {
  const OpenedPlant plant(std::string(kTurning) + "driven = true\n");
  const uint32_t speed = plant.find("shaft_speed");
  EXPECT_EQ(ipos_plant_write(plant.plant, plant.find("load_torque"), 1), IPOS_PLANT_READ_ONLY);
  ASSERT_EQ(ipos_plant_write_text(plant.plant, speed, "999.5 rpm"), IPOS_PLANT_OK) << plant.message();
  plant.run(1'000);
  EXPECT_EQ(plant.value(speed), 999'500);
  EXPECT_GT(torque(plant), 5) << "it turns towards 1000 rpm, harder and harder";
  EXPECT_NEAR(static_cast<double>(plant.value(plant.find("shaft_angle"))) * 1e-6, 999.5 / 60 * 2 * std::numbers::pi, 0.1);
  ASSERT_EQ(ipos_plant_write(plant.plant, speed, 1'100'000), IPOS_PLANT_OK);
  plant.run(1'100);
  EXPECT_LT(torque(plant), -50);
}

TEST(LibraryShaft, ASavedStateHasIt) {
  for (const char* kind : {"", "driven = true\n"}) {
    const OpenedPlant plant(std::string(kTurning) + kind);
    const uint32_t put = plant.find(*kind == 0 ? "load_torque" : "shaft_speed");
    plant.run(500);
    for (int n = 1; n <= 50; ++n) {
      ASSERT_EQ(ipos_plant_write(plant.plant, put, 700 * n), IPOS_PLANT_OK);
      plant.run(500 + n);
    }
    size_t size = 0;
    EXPECT_EQ(ipos_plant_save(plant.plant, nullptr, &size), IPOS_PLANT_TOO_SMALL);
    std::vector<uint8_t> saved(size);
    ASSERT_EQ(ipos_plant_save(plant.plant, saved.data(), &size), IPOS_PLANT_OK);
    plant.run(600);
    const auto angle = plant.value(plant.find("shaft_angle"));
    EXPECT_EQ(ipos_plant_restore(plant.plant, saved.data(), saved.size()), IPOS_PLANT_OK) << plant.message();
    EXPECT_EQ(plant.value(put), 35'000);
    plant.run(600);
    EXPECT_EQ(plant.value(plant.find("shaft_angle")), angle);
  }
}

}  // namespace
}  // namespace ipos::tests
