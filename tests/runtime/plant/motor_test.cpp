// [station.motor], unit_rating, control, brake, load and noise of the plant file: what they say as data, what they refuse, and
// what an owner sees of them in a run: rated current, speed under load, amperes, faults, analog outputs.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "runtime/motion/motor.hpp"
#include "runtime/signals/find.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/plant/plain_plant.hpp"
#include "tests/runtime/plant/plant_file_texts.hpp"

namespace ipos::runtime {
namespace {

using tests::PlainPlant;
using tests::expect_mistakes;
using tests::read_plant;

constexpr double kPi = 3.14159265358979323846;
const std::string kUnit = "[[station]]\nname = 'u'\nunit = 'mdxb'\n";
const std::string kPlate =
    "[station.motor]\npower = '1.5 kW'\nvoltage = '400 V'\nfrequency = '50 Hz'\ncurrent = '3.6 A'\nspeed = '1410 rpm'\n"
    "cos_phi = 0.78\ninertia = '34 kgcm2'\n";

MachineData motor_of(const std::string& text) { return read_plant(kUnit + text).stations.front().machine; }

TEST(StationMotor, ANameplateOrAType) {
  MachineData want;
  fit_motor(want, {1'500, 400, 50, 3.6, 1'410, 0.78, 0.0034});
  EXPECT_EQ(motor_of(kPlate), want);
  EXPECT_EQ(motor_of("[station.motor]\ntype = 'DT90L4'\n"), want);
  // What stands beside a type takes the place of its figure.
  fit_motor(want = {}, {1'500, 400, 50, 3.6, 1'400, 0.78, 0.0034});
  EXPECT_EQ(motor_of("[station.motor]\ntype = 'DT90L4'\nspeed = '1400 rpm'\n"), want);
  EXPECT_FALSE(read_plant(kUnit).stations.front().options.own_motor);
  EXPECT_TRUE(read_plant(kUnit + kPlate).stations.front().options.own_motor);
}

TEST(StationMotor, UnitRatingControlAndBrake) {
  EXPECT_EQ(motor_of(kPlate + "[station.unit_rating]\npower = '3 kW'\n").unit_current, 7'000);
  EXPECT_EQ(motor_of(kPlate + "[station.unit_rating]\ncurrent = '5.5 A'\n").unit_current, 5'500);
  EXPECT_TRUE(read_plant(kUnit + "control = 'real'\n").stations.front().options.real_control);
  EXPECT_FALSE(read_plant(kUnit + "control = 'ideal'\n").stations.front().options.real_control);
  const MachineData brake = motor_of("[station.brake]\nrelease = '100 ms'\napply = '0.15s'\n");
  EXPECT_EQ(brake.brake_release_ms, 100);
  EXPECT_EQ(brake.brake_apply_ms, 150);
}

TEST(StationMotor, LoadInNumbersAndInUnits) {
  const double torque = 1'500 / (2 * kPi * 1'410 / 60);
  const MachineData load = motor_of(kPlate +
                                      "[station.load]\ninertia = '0.0068 kgm2'\ntorque = '5 Nm'\nfriction = '0.5 Nm'\n"
                                      "torque_by = 'position'\nper_turn = 0.1\n");
  EXPECT_EQ(load.inertia, 200);
  EXPECT_NEAR(load.run_up_us, 0.0034 * 3 * 50 * kPi / torque * 1e6, 2);
  EXPECT_NEAR(load.load_torque, 5 / torque * 1e5, 1);
  EXPECT_NEAR(load.friction, 0.5 / torque * 1e5, 1);
  EXPECT_EQ(load.load_shape, LoadShape::ByPosition);
  EXPECT_EQ(load.load_turns, 100);
  EXPECT_NEAR(motor_of(kPlate + "[station.load]\ninertia = 200\n").run_up_us, load.run_up_us, 2);
  EXPECT_EQ(motor_of("[station.load]\ninertia = 200\n").run_up_us, 0);  // the ideal motor stays what it was
  const MachineData second = motor_of(
      "[station.load.second]\ninertia = '100 kgcm2'\nstiffness = '200 Nm/rad'\ndamping = '0.02 Nms/rad'\nbacklash = '1 deg'\n");
  EXPECT_NEAR(second.second_inertia, 0.01, 1e-12);
  EXPECT_EQ(second.stiffness, 200);
  EXPECT_EQ(second.damping, 0.02);
  EXPECT_NEAR(second.backlash, kPi / 180, 1e-12);
}

TEST(StationMotor, MistakesHaveTheirPlace) {
  expect_mistakes(
      kUnit,
      {
          {"[station.motor]\ntype = ^'DT1'\n", "unknown type 'DT1'; known are DT71D4, "},
          {"[station.motor]\n^colour = 1\ntype = 'DT90L4'\n", "unknown key 'colour' in [station.motor]"},
          {"[station.motor]\ntype = 'DT90L4'\npower = ^1.5\n", "power must be a text with its unit, such as \"1.5 kW\""},
          {"[station.motor]\ntype = 'DT90L4'\npower = ^'1.5 A'\n", "power must be a text with its unit, such as \"1.5 kW\", not '1.5 A'"},
          {"[station.motor]\ntype = 'DT90L4'\npower = ^'kW'\n", "power must be a text"},
          {"[station.motor]\ntype = 'DT90L4'\npower = ^'nan kW'\n", "power must be a text"},
          {"[station.motor]\ntype = 'DT90L4'\npower = ^'1e9 kW'\n", "power is 0.01 to 1000 kW"},
          {"[station.motor]\ntype = 'DT90L4'\nvoltage = ^'5 V'\n", "voltage is 50 to 1000 V"},
          {"[station.motor]\ntype = 'DT90L4'\nfrequency = ^'5 Hz'\n", "frequency is 10 to 400 Hz"},
          {"[station.motor]\ntype = 'DT90L4'\ncurrent = ^'0 A'\n", "current is 0.05 to 2000 A"},
          {"[station.motor]\ntype = 'DT90L4'\nspeed = ^'1500 rpm'\n", "speed is below the synchronous speed, 1500 rpm"},
          {"[station.motor]\ntype = 'DT90L4'\nspeed = ^'3100 rpm'\n", "speed is below the synchronous speed"},
          {"[station.motor]\ntype = 'DT90L4'\npower = ^'2.2 kW'\n", "power is more than voltage, current and cos_phi bring"},
          {"[station.motor]\ntype = 'DT90L4'\ncos_phi = ^1\n", "cos_phi must be a number, 0.1 to 0.99"},
          {"[station.unit_rating]\ncurrent = ^4\n", "current must be a text with its unit"},
          {"[station.unit_rating]\n^type = 1\n", "unknown key 'type' in [station.unit_rating]; known are power, current, type_code, series, size, service_code"},
          {"[station.unit_rating]\ntype_code = ^-1\n", "type_code is 0 to"},
          {"control = ^'good'\n", "unknown control 'good'; known are ideal, real"},
          {"control = ^1\n", "control must be a text in quotes"},
          {"noise = ^'20 %'\n", "noise is 0 to 10 %"},
          {"noise = ^0.2\n", "noise must be a text with its unit, such as \"0.2 %\""},
          {"[station.brake]\nrelease = ^'61 s'\n", "release is 0 to 60000 ms"},
          {"[station.brake]\nrelease = ^'soon'\n", "release must be a text with its unit, such as \"100 ms\", not 'soon'"},
          {"[station.brake]\n^torque = 1\n", "unknown key 'torque' in [station.brake]; known are release, apply"},
          {"[station.load]\ntorque = ^'200 Nm'\n", "torque is at most ten times the rated torque, 10.2 Nm"},
          {"[station.load]\ntorque = ^'2 N'\n", "torque must be a number, in %, or a text with its unit, such as \"5 Nm\", not '2 N'"},
          {"[station.load]\ninertia = ^'1e5 kgm2'\n", "inertia is too much for this motor"},
          {"[station.load]\ntorque_by = ^'day'\n", "unknown torque_by 'day'; known are constant, speed, position"},
          {"[station.load]\nper_turn = ^1\n", "per_turn needs torque_by = \"position\""},
          {"[station.load]\ntorque_by = 'position'\nper_turn = ^0\n", "per_turn must be a number, 0.001 to 1000"},
          {"[station.load.second]\ninertia = '1 kgm2'\nstiffness = ^5\n", "stiffness must be a text with its unit"},
          {"[station.load.second]\nstiffness = '5 Nm/rad'\ninertia = '1 kgm2'\n^mass = 1\n", "unknown key 'mass' in [station.load.second]"},
          {"control = 'real'\n[station.load]\ndriven = ^true\n", "driven = true goes without control = \"real\""},
      });
  const PlantFileResult missing = read_plant_file(kUnit + "[station.motor]\npower = '1.5 kW'\n[station.load.second]\n");
  ASSERT_EQ(missing.errors.size(), 6U);
  EXPECT_EQ(missing.errors[0].text, "[station.motor] needs current = ..., or type = \"...\"");
  EXPECT_EQ(missing.errors[4].text, "[station.load.second] needs inertia = ...");
}

// An owner's drive: n11 is 1000 rpm unless the parameters say another one, enabled by terminals.
struct Owner : PlainPlant {
  explicit Owner(const std::string& keys, const std::string& parameters = "")
      : PlainPlant(kUnit + keys.substr(0, keys.find('[')) + "[station.parameters]\nP130 = 1000\n" +
                   (parameters.find("P160") == std::string::npos ? "P160 = 1000000\n" : "") + parameters +
                   "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\nDI04 = 1\n" +
                   (keys.find('[') == std::string::npos ? "" : keys.substr(keys.find('[')))) {}
  double signal(const std::string& name) const {
    const auto found = signals::find_signals(*plant, "u." + name);
    EXPECT_TRUE(found && found->size() == 1) << name;
    return found && !found->empty() ? static_cast<double>(found->front().read()) * found->front().factor : 0;
  }
};

TEST(OwnersMachine, RatedCurrentSpeedAndAmperes) {
  const Owner plant("control = 'real'\n" + kPlate + "[station.unit_rating]\ncurrent = '5.5 A'\n[station.load]\ntorque = '10.159 Nm'\nfriction = 0\n");
  plant->run_until(5 * kSecond);
  EXPECT_EQ(plant.parameter("071"), 5'500);
  EXPECT_NEAR(plant.parameter("000"), 910'000, 100);       // rated slip
  EXPECT_NEAR(plant.parameter("002"), 33'333, 5);          // Hz of the setpoint
  EXPECT_NEAR(plant.parameter("009"), 3'600, 5);           // mA
  EXPECT_NEAR(plant.parameter("005"), 3.6 * 0.78 / 5.5 * 1e5, 50);
  EXPECT_NEAR(plant.signal("AO2"), 10 * 3.6 / 5.5 / 1.5, 0.01);  // factory setting: output current, 10 V = 150 %
  EXPECT_NEAR(plant.signal("AO1"), 10 * 910.0 / 3'000, 0.01);    // and the speed, 10 V = 3000 rpm
}

TEST(OwnersMachine, SlipCompensationByParameter) {
  const Owner plant("control = 'real'\n" + kPlate + "[station.load]\ntorque = 100\nfriction = 0\n", "P324 = 90000\n");
  plant->run_until(5 * kSecond);
  EXPECT_NEAR(plant.parameter("000"), 1'000'000, 200);
}

TEST(OwnersMachine, AStallIsF08) {
  const Owner plant("control = 'real'\n" + kPlate + "[station.load]\ntorque = 250\n", "P501 = 500\n");
  plant->run_until(5 * kSecond);
  EXPECT_EQ(plant.station().drive().state().fault(), 8);
}

TEST(OwnersMachine, TooMuchForLongIsF84) {
  const Owner plant("control = 'real'\n" + kPlate + "[station.unit_rating]\npower = '3 kW'\n[station.load]\ntorque = 130\n", "P340 = 1\n");
  plant->run_until(60 * 60 * kSecond);
  EXPECT_EQ(plant.station().drive().state().fault(), 84);
}

TEST(OwnersMachine, ATooSmallUnitIsF11) {
  const Owner plant("control = 'real'\n" + kPlate + "[station.unit_rating]\ncurrent = '2.8 A'\n[station.load]\ntorque = 105\nfriction = 0\n");
  plant->run_until(60 * 60 * kSecond);
  EXPECT_EQ(plant.station().drive().state().fault(), 11);
}

TEST(OwnersMachine, EnabledWhileItTurnsIsF01) {
  const auto fault = [](const std::string& mode) {
    const Owner plant("control = 'real'\n" + kPlate + "[station.load]\nbrake = false\n[[stimulus]]\nstation = 'u'\ninput = 'DI00'\n"
                      "pulse = 0\nfor = '20ms'\nat = '3s'\n", "P700 = " + mode + "\nP160 = 1400000\n");
    plant->run_until(4 * kSecond);
    return plant.station().drive().state().fault();
  };
  EXPECT_EQ(fault("0"), 1);
  EXPECT_EQ(fault("4"), 0);   // flying start
  EXPECT_EQ(fault("11"), 0);  // with encoder
}

TEST(OwnersMachine, AnalogOutputsByFunctionScalingAndMode) {
  PROVES("DRV-10");
  const Owner plant("", "P640 = 3\nP641 = 3000\nP642 = 3\nP643 = 2\nP644 = -1000\nP645 = 1\n");
  plant->run_until(3 * kSecond);
  EXPECT_NEAR(plant.signal("AO1_current"), 4 + 16 * 1.0, 0.01);  // 1000 rpm x 3 of 3000 rpm
  EXPECT_EQ(plant.signal("AO1"), 0);
  EXPECT_NEAR(plant.signal("AO2"), -10 / 3.0, 0.01);
  const Owner off("", "P640 = 0\nP645 = 0\n");
  off->run_until(3 * kSecond);
  EXPECT_EQ(off.signal("AO1"), 0);
  EXPECT_EQ(off.signal("AO2"), 0);
}

TEST(OwnersMachine, NoiseIsOfTheSeedAndWithinItsBound) {
  const auto speeds = [](const std::string& keys) {
    const Owner plant(keys);
    std::vector<int32_t> seen;
    for (int ms = 3'000; ms < 3'300; ++ms) {
      plant->run_until(ms * kMillisecond);
      seen.push_back(plant.parameter("000"));
    }
    return seen;
  };
  const std::vector<int32_t> noisy = speeds("noise = '0.2 %'\n");
  EXPECT_EQ(noisy, speeds("noise = '0.2 %'\n"));
  double mean = 0;
  for (const int32_t speed : noisy) {
    EXPECT_LE(std::abs(speed - 1'000'000), 3'000);  // of 1500 rpm
    mean += (speed - 1'000'000) / 300.0;
  }
  EXPECT_GT(std::set<int32_t>(noisy.begin(), noisy.end()).size(), 250U);
  EXPECT_LT(std::abs(mean), 400);
  EXPECT_EQ(speeds(""), std::vector<int32_t>(300, 1'000'000));
}

// The plant's seed moves all that goes by chance; without it, and with 0, the station's name alone is the seed.
TEST(OwnersMachine, ASeedGivesAnotherCourse) {
  const auto seeds = [](const std::string& head) {
    const PlantFile plant = read_plant(head + "[[bus]]\nname = 'b'\nkind = 'can'\n" + kUnit +
                                       "noise = '0.2 %'\nsbus = 'b'\n[[fault]]\nbus = 'b'\nkind = 'drop'\nrate = 10\nseed = 5\n");
    return std::pair(plant.stations.front().machine.noise_seed, plant.faults.front().fault.seed);
  };
  const auto plain = seeds("");
  EXPECT_EQ(plain.second, 5U);
  EXPECT_EQ(seeds("seed = 0\n"), plain);
  std::set<uint32_t> noise;
  for (int n = 0; n < 100; ++n) {
    const auto [of_noise, of_fault] = seeds("seed = " + std::to_string(n) + "\n");
    noise.insert(of_noise);
    EXPECT_EQ(of_fault, 5U + static_cast<uint64_t>(n));
  }
  EXPECT_EQ(noise.size(), 100U);
  EXPECT_EQ(read_plant_file("seed = -1\n" + kUnit).errors.size(), 1U);
  EXPECT_EQ(read_plant_file("seed = 'a'\n" + kUnit).errors.size(), 1U);
}

}  // namespace
}  // namespace ipos::runtime
