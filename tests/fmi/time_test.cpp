// Steps of any size, the start of time, faults that end a step early, and many instances at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

#include "tests/fmi/functions.hpp"

namespace ipos::tests {
namespace {

class FmiTime : public ::testing::Test {
 protected:
  double real(void* c, const char* name) {
    const unsigned reference = resources_.reference(name);
    double value = NAN;
    EXPECT_EQ(fmi2GetReal(c, &reference, 1, &value), kOk);
    return value;
  }
  void set(void* c, const char* name, int on) {
    const unsigned reference = resources_.reference(name);
    EXPECT_EQ(fmi2SetBoolean(c, &reference, 1, &on), kOk);
  }

  const Resources resources_{kTurning};
  Told told_;
};

// P130 is a second for 3000 rpm, so a millisecond is 3 rpm; the brake needs no time to open.
TEST_F(FmiTime, WhatIsSetActsInTheMillisecondThatBegins) {
  void* c = resources_.begin2(told_);
  ASSERT_EQ(fmi2DoStep(c, 0, 0.5, 1), kOk);
  set(c, "u.DI01", 1);
  std::vector<double> speeds;
  for (int n = 0; n < 500; ++n) {
    ASSERT_EQ(fmi2DoStep(c, 0.5 + n * 1e-3, 1e-3, 1), kOk) << told_.text;
    speeds.push_back(real(c, "u.shaft_speed") * 60 / (2 * std::numbers::pi));
  }
  const auto first = static_cast<size_t>(std::find_if(speeds.begin(), speeds.end(), [](double v) { return v > 0; }) - speeds.begin());
  const runtime::PlantFile file = runtime::read_plant_file(kTurning + "[[stimulus]]\nstation = \"u\"\nat = \"501ms\"\ninput = \"DI01\"\nset = 1\n").plant;
  std::vector<runtime::PlantError> errors;
  runtime::Plant plant(file, {std::nullopt}, {}, errors);
  for (size_t n = 0; n < speeds.size(); ++n) {
    plant.run_until(static_cast<runtime::Time>(501 + n) * runtime::kMillisecond);
    EXPECT_NEAR(plant.stations()[0]->drive().state().speed() / 1000.0, speeds[n], 1e-9) << n;
  }
  EXPECT_GT(first, 0U) << "the brake opens first";
  EXPECT_NEAR(speeds.back(), 1000, 1e-6);
  fmi2FreeInstance(c);
}

TEST_F(FmiTime, TheSizeOfStepsDoesNotMatter) {
  std::vector<double> ends;
  for (const double step : {1e-3, 1e-2, 0.3e-3, 0.7e-3, 0.1e-3, 1.0 / 3 * 1e-3, 0.0123, 0.5}) {
    void* c = resources_.begin2(told_);
    set(c, "u.DI01", 1);
    double time = 0;
    for (; time + step < 0.5 - 1e-9; time += step) ASSERT_EQ(fmi2DoStep(c, time, step, 1), kOk) << step << told_.text;
    ASSERT_EQ(fmi2DoStep(c, time, 0.5 - time, 1), kOk) << step;
    ends.push_back(real(c, "u.shaft_angle"));
    EXPECT_EQ(ends.back(), ends.front()) << step;
    double now = 0;
    EXPECT_EQ(fmi2GetRealStatus(c, 2, &now), kOk);
    EXPECT_NEAR(now, 0.5, 1e-12);
    fmi2FreeInstance(c);
  }
  EXPECT_GT(ends.front(), 10);
}

// A sum of doubles that is a little below a full millisecond means that.
TEST_F(FmiTime, RoundingOfAnImporterDoesNotMatter) {
  for (const double error : {-5e-9, 5e-9}) {
    void* c = resources_.begin2(told_);
    set(c, "u.DI01", 1);
    ASSERT_EQ(fmi2DoStep(c, 0, 0.25 + error, 1), kOk);
    const double angle = real(c, "u.shaft_angle");
    void* exact = resources_.begin2(told_);
    set(exact, "u.DI01", 1);
    ASSERT_EQ(fmi2DoStep(exact, 0, 0.25, 1), kOk);
    EXPECT_EQ(angle, real(exact, "u.shaft_angle")) << error;
    fmi2FreeInstance(c);
    fmi2FreeInstance(exact);
  }
}

TEST_F(FmiTime, ItMayBeginAnywhere) {
  void* c = resources_.make2(told_);
  EXPECT_EQ(fmi2SetupExperiment(c, 0, 0, -3.5, 0, 0), kOk);
  EXPECT_EQ(fmi2EnterInitializationMode(c), kOk);
  EXPECT_EQ(fmi2ExitInitializationMode(c), kOk);
  EXPECT_EQ(real(c, "u.speed"), 0);
  EXPECT_EQ(fmi2DoStep(c, 0, 1e-3, 1), kError);
  EXPECT_EQ(fmi2DoStep(c, -3.5, 1, 1), kOk);
  fmi2FreeInstance(c);
  c = resources_.make2(told_);
  EXPECT_EQ(fmi2SetupExperiment(c, 0, 0, NAN, 0, 0), kError);
  fmi2FreeInstance(c);
}

TEST(FmiEarly, AFaultEndsTheStepForWhoAsksForIt) {
  std::string plant = kTurning + "DI03 = 1\n[[stimulus]]\nstation = \"u\"\nat = \"123ms\"\ninput = \"DI03\"\nset = 0\n";
  plant.replace(plant.find("NO FUNCTION"), 11, "/EXT. ERROR");
  const Resources resources(plant);
  Told told;
  for (const bool early : {true, false}) {
    void* c = resources.begin3(told, early, early);
    bool event = false, ends = false, returned = false;
    double reached = 0;
    const unsigned fault = resources.reference("u.fault");
    ASSERT_EQ(fmi3DoStep(c, 0, 1, true, &event, &ends, &returned, &reached), kOk);
    int64_t number = 0;
    ASSERT_EQ(fmi3GetInt64(c, &fault, 1, &number, 1), kOk);
    EXPECT_EQ(number, 26);
    EXPECT_EQ(returned, early);
    EXPECT_EQ(event, early);
    EXPECT_FALSE(ends);
    if (!early) {
      EXPECT_EQ(reached, 1);
    } else {
      EXPECT_NEAR(reached, 0.123, 1e-12);
      EXPECT_EQ(fmi3EnterEventMode(c), kOk);
      EXPECT_EQ(fmi3EnterStepMode(c), kOk);
      ASSERT_EQ(fmi3DoStep(c, reached, 1 - reached, true, &event, &ends, &returned, &reached), kOk);
      EXPECT_FALSE(returned) << "each fault once";
    }
    fmi3FreeInstance(c);
  }
}

TEST(FmiThreads, AHundredInstancesKnowNothingOfEachOther) {
  const Resources resources(kTurning);
  const unsigned input = resources.reference("u.DI01"), angle = resources.reference("u.shaft_angle");
  std::vector<double> ends(100);
  std::vector<Told> told(ends.size());
  std::vector<std::thread> threads;
  for (size_t thread = 0; thread < 4; ++thread)
    threads.emplace_back([&, thread] {
      std::vector<void*> instances;
      for (size_t n = thread; n < ends.size(); n += 4) instances.push_back(resources.make3(told[n]));
      size_t each = thread;
      for (void* c : instances) {
        fmi3EnterInitializationMode(c, false, 0, 0, false, 0);
        fmi3ExitInitializationMode(c);
      }
      for (int ms = 0; ms < 200; ++ms) {
        each = thread;
        for (void* c : instances) {
          const bool on = ms >= static_cast<int>(each % 10);
          bool event = false, ends_now = false, early = false;
          double reached = 0;
          fmi3SetBoolean(c, &input, 1, &on, 1);
          fmi3DoStep(c, ms * 1e-3, 1e-3, true, &event, &ends_now, &early, &reached);
          each += 4;
        }
      }
      each = thread;
      for (void* c : instances) {
        fmi3GetFloat64(c, &angle, 1, &ends[each], 1);
        fmi3FreeInstance(c);
        each += 4;
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (size_t n = 0; n < ends.size(); ++n) {
    EXPECT_EQ(told[n].text, "") << n;
    EXPECT_EQ(ends[n], ends[n % 10]) << n;
    EXPECT_GT(ends[n], 0) << n;
  }
  EXPECT_GT(ends[0], ends[9]);
}

}  // namespace
}  // namespace ipos::tests
