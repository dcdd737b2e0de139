// [station.load] of the plant file in the units of the motion layer.
#include <gtest/gtest.h>

#include "runtime/plant_file/plant_file.hpp"

namespace ipos::runtime {
namespace {

MachineData machine_of(const std::string& load) {
  const PlantFileResult result =
      read_plant_file("[[station]]\nname = \"u\"\nunit = \"md60a\"\n[station.load]\n" + load);
  EXPECT_TRUE(result.errors.empty()) << result.errors.front().text;
  return result.plant.stations.front().machine;
}

TEST(StationLoad, PercentToThousandths) {
  const MachineData machine = machine_of(
      "inertia = 250\nfriction = 2.5\ntorque = -12.345\nbrake = false\nbraking_resistor = false\n");
  EXPECT_EQ(machine.inertia, 250);
  EXPECT_EQ(machine.friction, 2'500);
  EXPECT_EQ(machine.load_torque, -12'345);
  EXPECT_FALSE(machine.brake);
  EXPECT_FALSE(machine.braking_resistor);
}

TEST(StationLoad, WhatIsLeftOutIsTheDefault) {
  const MachineData machine = machine_of("torque = 40\n"), standard;
  EXPECT_EQ(machine.load_torque, 40'000);
  EXPECT_EQ(machine.inertia, standard.inertia);
  EXPECT_EQ(machine.friction, standard.friction);
  EXPECT_EQ(machine.brake, standard.brake);
}

}  // namespace
}  // namespace ipos::runtime
