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

TEST(StationLoad, TakesBothEndsOfEveryRange) {
  const MachineData least = machine_of("inertia = 0\nfriction = 0\ntorque = -1000\nbrake = true\n");
  EXPECT_EQ(least.inertia, 0);
  EXPECT_EQ(least.friction, 0);
  EXPECT_EQ(least.load_torque, -1'000'000);
  EXPECT_TRUE(least.brake);
  const MachineData most = machine_of("inertia = 100000\nfriction = 1000\ntorque = 1000\n");
  EXPECT_EQ(most.inertia, 100'000);
  EXPECT_EQ(most.friction, 1'000'000);
  EXPECT_EQ(most.load_torque, 1'000'000);
  // To the nearest step: an inertia has whole percent, the others thousandths.
  const MachineData rounded = machine_of("inertia = 99.6\nfriction = 0.0006\ntorque = -0.0016\n");
  EXPECT_EQ(rounded.inertia, 100);
  EXPECT_EQ(rounded.friction, 1);
  EXPECT_EQ(rounded.load_torque, -2);
  EXPECT_EQ(machine_of("inertia = 99.4\n").inertia, 99);
}

TEST(StationLoad, WhatIsLeftOutIsTheDefault) {
  const MachineData machine = machine_of("torque = 40\n"), standard;
  EXPECT_EQ(machine.load_torque, 40'000);
  EXPECT_EQ(machine.inertia, standard.inertia);
  EXPECT_EQ(machine.friction, standard.friction);
  EXPECT_EQ(machine.brake, standard.brake);
}

TEST(StationLoad, TheShaftMayBeDrivenFromOutside) {
  EXPECT_FALSE(machine_of("torque = 1\n").driven);
  EXPECT_TRUE(machine_of("driven = true\n").driven);
}

}  // namespace
}  // namespace ipos::runtime
