// Calls in a wrong state, null pointers, wrong references and types: each is an error with a text, and the instance goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/fmi/functions.hpp"

namespace ipos::tests {
namespace {

class FmiCalls : public ::testing::Test {
 protected:
  const Resources resources_{kTurning};
  Told told_;
};

TEST_F(FmiCalls, AnInstanceIsMadeOnlyOfWhatBelongsToIt) {
  const Fmi2Callbacks callbacks{Told::fmi2, nullptr, nullptr, nullptr, &told_};
  EXPECT_EQ(fmi2Instantiate("a", 1, "{other}", resources_.uri().c_str(), &callbacks, 0, 0), nullptr);
  EXPECT_TRUE(told_.has("another FMU")) << told_.text;
  EXPECT_EQ(fmi2Instantiate("a", 0, resources_.token().c_str(), resources_.uri().c_str(), &callbacks, 0, 0), nullptr);
  EXPECT_TRUE(told_.has("co-simulation"));
  EXPECT_EQ(fmi2Instantiate("", 1, resources_.token().c_str(), resources_.uri().c_str(), &callbacks, 0, 0), nullptr);
  EXPECT_EQ(fmi2Instantiate(nullptr, 1, resources_.token().c_str(), resources_.uri().c_str(), &callbacks, 0, 0), nullptr);
  EXPECT_EQ(fmi2Instantiate("a", 1, nullptr, resources_.uri().c_str(), &callbacks, 0, 0), nullptr);
  EXPECT_EQ(fmi2Instantiate("a", 1, resources_.token().c_str(), nullptr, &callbacks, 0, 0), nullptr);
  EXPECT_EQ(fmi2Instantiate("a", 1, resources_.token().c_str(), "file:///nowhere", &callbacks, 0, 0), nullptr);
  EXPECT_TRUE(told_.has("there is no such file"));
  EXPECT_EQ(fmi2Instantiate("a", 1, resources_.token().c_str(), "http://nowhere", nullptr, 0, 0), nullptr);
  EXPECT_EQ(fmi3InstantiateCoSimulation("a", "", "", false, false, false, false, nullptr, 0, nullptr, nullptr, nullptr), nullptr);
}

TEST_F(FmiCalls, TwoAreOnlyAllowedInTheirState) {
  void* c = resources_.make2(told_);
  const auto refused = [&](int status, const char* name) {
    EXPECT_EQ(status, kError) << name;
    EXPECT_TRUE(told_.has(std::string("fmi2") + name + " is not allowed here")) << name << ": " << told_.text;
    told_.text.clear();
  };
  double real = 0;
  int whole = 0;
  const char* text = nullptr;
  refused(fmi2ExitInitializationMode(c), "ExitInitializationMode");
  refused(fmi2DoStep(c, 0, 1e-3, 0), "DoStep");
  refused(fmi2Terminate(c), "Terminate");
  refused(fmi2GetStatus(c, 0, &whole), "GetStatus");
  EXPECT_EQ(fmi2SetupExperiment(c, 0, 0, 0, 0, 0), kOk);
  EXPECT_EQ(fmi2EnterInitializationMode(c), kOk);
  refused(fmi2EnterInitializationMode(c), "EnterInitializationMode");
  refused(fmi2SetupExperiment(c, 0, 0, 0, 0, 0), "SetupExperiment");
  refused(fmi2DoStep(c, 0, 1e-3, 0), "DoStep");
  EXPECT_EQ(fmi2ExitInitializationMode(c), kOk);
  EXPECT_EQ(fmi2DoStep(c, 0, 1e-3, 0), kOk);
  refused(fmi2CancelStep(c), "CancelStep");
  EXPECT_EQ(fmi2GetRealStatus(c, 2, &real), kOk);
  EXPECT_EQ(real, 1e-3);
  EXPECT_EQ(fmi2GetRealStatus(c, 0, &real), kDiscard);
  EXPECT_EQ(fmi2GetStatus(c, 0, &whole), kOk);
  EXPECT_EQ(fmi2GetBooleanStatus(c, 3, &whole), kOk);
  EXPECT_EQ(fmi2GetIntegerStatus(c, 0, &whole), kDiscard);
  EXPECT_EQ(fmi2GetStringStatus(c, 1, &text), kOk);
  EXPECT_EQ(fmi2Terminate(c), kOk);
  refused(fmi2DoStep(c, 1e-3, 1e-3, 0), "DoStep");
  const unsigned input = resources_.reference("u.DI01");
  refused(fmi2SetBoolean(c, &input, 1, &whole), "Set");
  EXPECT_EQ(fmi2GetBoolean(c, &input, 1, &whole), kOk) << "of what has ended the values stay";
  EXPECT_EQ(fmi2Reset(c), kOk);
  EXPECT_EQ(fmi2EnterInitializationMode(c), kOk);
  fmi2FreeInstance(c);
}

TEST_F(FmiCalls, ThreeAreOnlyAllowedInTheirState) {
  void* c = resources_.make3(told_, true);
  bool flags[5] = {};
  double next = 0, reached = 0;
  const auto update = [&] { return fmi3UpdateDiscreteStates(c, &flags[0], &flags[1], &flags[2], &flags[3], &flags[4], &next); };
  const auto step = [&](double from, double length) {
    return fmi3DoStep(c, from, length, true, &flags[0], &flags[1], &flags[2], &reached);
  };
  EXPECT_EQ(step(0, 1), kError);
  EXPECT_EQ(update(), kError);
  EXPECT_EQ(fmi3EnterConfigurationMode(c), kError);
  EXPECT_EQ(fmi3EnterInitializationMode(c, false, 0, 5, false, 0), kOk);
  EXPECT_EQ(fmi3EnterEventMode(c), kError);
  EXPECT_EQ(fmi3ExitInitializationMode(c), kOk);
  EXPECT_EQ(step(5, 1), kError) << "it is in event mode first";
  EXPECT_EQ(update(), kOk);
  EXPECT_FALSE(flags[0] || flags[1] || flags[2] || flags[3] || flags[4]);
  EXPECT_EQ(fmi3EnterStepMode(c), kOk);
  EXPECT_EQ(fmi3GetClock(c, nullptr, 0, nullptr), kError) << "clocks are of event mode";
  EXPECT_EQ(step(5, 1e-3), kOk);
  EXPECT_EQ(reached, 5.001);
  EXPECT_EQ(fmi3EnterEventMode(c), kOk);
  EXPECT_EQ(fmi3Terminate(c), kOk);
  EXPECT_EQ(fmi3Reset(c), kOk);
  fmi3FreeInstance(c);
  c = resources_.begin3(told_);
  told_.text.clear();
  EXPECT_EQ(fmi3EnterEventMode(c), kError);
  EXPECT_TRUE(told_.has("without event mode"));
  fmi3FreeInstance(c);
}

TEST_F(FmiCalls, NullPointersAreTold) {
  void* c = resources_.begin2(told_);
  const unsigned real = resources_.reference("u.speed");
  EXPECT_EQ(fmi2GetReal(c, nullptr, 1, nullptr), kError);
  EXPECT_EQ(fmi2GetReal(c, &real, 1, nullptr), kError);
  EXPECT_EQ(fmi2SetReal(c, nullptr, 1, nullptr), kError);
  EXPECT_EQ(fmi2GetString(c, &real, 1, nullptr), kError);
  EXPECT_EQ(fmi2GetReal(c, nullptr, 0, nullptr), kOk) << "nothing is asked for";
  EXPECT_EQ(fmi2GetFMUstate(c, nullptr), kError);
  EXPECT_EQ(fmi2SetFMUstate(c, nullptr), kError);
  EXPECT_EQ(fmi2FreeFMUstate(c, nullptr), kOk);
  EXPECT_EQ(fmi2SerializedFMUstateSize(c, nullptr, nullptr), kError);
  EXPECT_EQ(fmi2SerializeFMUstate(c, nullptr, nullptr, 0), kError);
  EXPECT_EQ(fmi2DeSerializeFMUstate(c, nullptr, 0, nullptr), kError);
  EXPECT_EQ(fmi2SetDebugLogging(c, 1, 1, nullptr), kError);
  EXPECT_EQ(fmi2GetStatus(c, 0, nullptr), kError);
  EXPECT_EQ(fmi2GetRealStatus(c, 2, nullptr), kError);
  EXPECT_TRUE(told_.has("a pointer is null"));
  fmi2FreeInstance(c);
  fmi2FreeInstance(nullptr);
  EXPECT_EQ(fmi2DoStep(nullptr, 0, 1, 0), kError);
  EXPECT_EQ(fmi2GetReal(nullptr, &real, 1, nullptr), kError);
  c = resources_.begin3(told_);
  EXPECT_EQ(fmi3DoStep(c, 0, 1, false, nullptr, nullptr, nullptr, nullptr), kError);
  EXPECT_EQ(fmi3GetFloat64(c, &real, 1, nullptr, 1), kError);
  fmi3FreeInstance(c);
  EXPECT_EQ(fmi3Terminate(nullptr), kError);
}

TEST_F(FmiCalls, ReferencesAndTypesAreChecked) {
  void* c = resources_.begin2(told_);
  const auto count = static_cast<unsigned>(resources_.variables().all.size());
  const unsigned speed = resources_.reference("u.speed"), input = resources_.reference("u.DI01"), beyond = count + 1, time = 0;
  double real = 1;
  int whole = 1;
  EXPECT_EQ(fmi2GetReal(c, &beyond, 1, &real), kError);
  EXPECT_TRUE(told_.has("no variable has the value reference " + std::to_string(beyond)));
  EXPECT_EQ(fmi2GetReal(c, &input, 1, &real), kError);
  EXPECT_TRUE(told_.has("u.DI01 is of another type"));
  EXPECT_EQ(fmi2GetInteger(c, &speed, 1, &whole), kError);
  EXPECT_EQ(fmi2SetReal(c, &speed, 1, &real), kError);
  EXPECT_TRUE(told_.has("u.speed cannot be set"));
  EXPECT_EQ(fmi2SetReal(c, &time, 1, &real), kError);
  EXPECT_EQ(fmi2GetReal(c, &time, 1, &real), kOk);
  EXPECT_EQ(real, 0);
  const char* text = nullptr;
  EXPECT_EQ(fmi2GetString(c, &speed, 1, &text), kError);
  EXPECT_EQ(fmi2SetString(c, &speed, 1, &text), kError);
  EXPECT_EQ(fmi2GetString(c, nullptr, 0, nullptr), kOk);
  // None of several is set when one is wrong.
  const unsigned both[] = {input, speed};
  const int on[] = {1, 1};
  EXPECT_EQ(fmi2SetBoolean(c, both, 2, on), kError);
  EXPECT_EQ(fmi2GetBoolean(c, &input, 1, &whole), kOk);
  EXPECT_EQ(whole, 0);
  fmi2FreeInstance(c);
  c = resources_.begin3(told_);
  double two[2];
  EXPECT_EQ(fmi3GetFloat64(c, &speed, 1, two, 2), kError);
  EXPECT_TRUE(told_.has("not as many values"));
  fmi3FreeInstance(c);
}

TEST_F(FmiCalls, ValuesThatAUnitRefusesAreDiscarded) {
  void* c = resources_.begin2(told_);
  const unsigned ramp = resources_.reference("u.P130"), level = resources_.reference("u.AI1"), load = resources_.reference("u.load_torque");
  const auto set = [&](unsigned reference, double value) { return fmi2SetReal(c, &reference, 1, &value); };
  const auto get = [&](unsigned reference) {
    double value = -1;
    EXPECT_EQ(fmi2GetReal(c, &reference, 1, &value), kOk);
    return value;
  };
  EXPECT_EQ(set(ramp, 5000), kDiscard);
  EXPECT_TRUE(told_.has("u.P130 := 5000: P130 Ramp t11 UP CW")) << told_.text;
  EXPECT_EQ(get(ramp), 1);
  EXPECT_EQ(set(ramp, 2.5), kOk);
  EXPECT_EQ(get(ramp), 2.5);
  for (const double wrong : {10.5, -11.0, double{NAN}, double{INFINITY}, 1e300}) EXPECT_EQ(set(level, wrong), kDiscard) << wrong;
  EXPECT_EQ(set(level, -10), kOk);
  EXPECT_EQ(get(level), -10);
  for (const double wrong : {double{NAN}, -double{INFINITY}, 1e12}) EXPECT_EQ(set(load, wrong), kDiscard) << wrong;
  const unsigned source = resources_.reference("u.P100");
  const int strange = 9999;
  EXPECT_EQ(fmi2SetInteger(c, &source, 1, &strange), kDiscard);
  fmi2FreeInstance(c);
}

// Importers set every input before each step, also the line of an analog input that is not used.
TEST_F(FmiCalls, SettingWhatIsThereAlreadyChangesNothing) {
  void* c = resources_.begin2(told_);
  const unsigned lines[] = {resources_.reference("u.AI1"), resources_.reference("u.AI1_current")};
  const double values[] = {5, 0};
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(fmi2SetReal(c, lines, 2, values), kOk);
    EXPECT_EQ(fmi2DoStep(c, n * 1e-3, 1e-3, 1), kOk);
    double read[2];
    EXPECT_EQ(fmi2GetReal(c, lines, 2, read), kOk);
    EXPECT_EQ(read[0], 5);
    EXPECT_EQ(read[1], 0);
  }
  fmi2FreeInstance(c);
}

TEST_F(FmiCalls, TheJournalIsToldToWhoAsksForIt) {
  void* c = resources_.begin2(told_);
  const char* journal[] = {"journal"};
  const char* other[] = {"noise"};
  EXPECT_EQ(fmi2SetDebugLogging(c, 1, 1, other), kError);
  EXPECT_EQ(fmi2SetDebugLogging(c, 1, 1, journal), kOk);
  told_.text.clear();
  EXPECT_EQ(fmi2DoStep(c, 0, 0.1, 1), kOk);
  EXPECT_TRUE(told_.has("u: ")) << told_.text;
  EXPECT_EQ(fmi2SetDebugLogging(c, 0, 0, nullptr), kOk);
  fmi2FreeInstance(c);
}

TEST_F(FmiCalls, APercentSignIsNoFormat) {
  void* c = resources_.make2(told_);
  const char* strange[] = {"100%s"};
  EXPECT_EQ(fmi2SetDebugLogging(c, 1, 1, strange), kError);
  EXPECT_TRUE(told_.has("100%%s")) << told_.text;
  fmi2FreeInstance(c);
}

TEST_F(FmiCalls, StepsAreLookedAt) {
  void* c = resources_.begin2(told_);
  EXPECT_EQ(fmi2DoStep(c, 0, 0, 1), kError);
  EXPECT_EQ(fmi2DoStep(c, 0, -1, 1), kError);
  EXPECT_EQ(fmi2DoStep(c, 0, NAN, 1), kError);
  EXPECT_EQ(fmi2DoStep(c, NAN, 1, 1), kError);
  EXPECT_EQ(fmi2DoStep(c, 0, INFINITY, 1), kError);
  EXPECT_EQ(fmi2DoStep(c, 0, 1e10, 1), kError);
  EXPECT_EQ(fmi2DoStep(c, 0.5, 1e-3, 1), kError);
  EXPECT_TRUE(told_.has("the communication point is 0.5 s, but the instance stands at 0 s")) << told_.text;
  EXPECT_EQ(fmi2DoStep(c, 0, 1e-3, 1), kOk);
  fmi2FreeInstance(c);
}

}  // namespace
}  // namespace ipos::tests
