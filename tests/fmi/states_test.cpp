// States of instances: kept, gone back to, as bytes, in another instance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/fmi/functions.hpp"

namespace ipos::tests {
namespace {

// What an instance is, to the last digit.
std::vector<double> values(const Resources& resources, void* c) {
  std::vector<double> all;
  for (size_t n = 0; n < resources.variables().all.size(); ++n) {
    const auto reference = static_cast<unsigned>(n + 1);
    double real = 0;
    int whole = 0;
    switch (resources.variables().all[n].type) {
      case fmi::Type::Real: EXPECT_EQ(fmi2GetReal(c, &reference, 1, &real), kOk); break;
      case fmi::Type::Boolean: EXPECT_EQ(fmi2GetBoolean(c, &reference, 1, &whole), kOk); break;
      default: EXPECT_EQ(fmi2GetInteger(c, &reference, 1, &whole), kOk); break;
    }
    all.push_back(real + whole);
  }
  return all;
}

class FmiStates : public ::testing::Test {
 protected:
  // Steps of a millisecond, with an input that comes and goes and a load that grows.
  void run(void* c, int from, int to) {
    const unsigned input = resources_.reference("u.DI01"), load = resources_.reference("u.load_torque");
    for (int ms = from; ms < to; ++ms) {
      const int on = ms / 70 % 2;
      const double torque = ms * 0.01;
      ASSERT_EQ(fmi2SetBoolean(c, &input, 1, &on), kOk);
      ASSERT_EQ(fmi2SetReal(c, &load, 1, &torque), kOk);
      ASSERT_EQ(fmi2DoStep(c, ms * 1e-3, 1e-3, 0), kOk) << told_.text;
    }
  }

  const Resources resources_{turning_with_program(), "long n; main() { while (1) { n = n + 1; _Wait(3); } }\n",
                             {{}, {"u.n"}}};
  Told told_;
};

TEST_F(FmiStates, GoingBackAndOnIsTheSame) {
  void* c = resources_.begin2(told_);
  void* state = nullptr;
  run(c, 0, 200);
  const auto then = values(resources_, c);
  ASSERT_EQ(fmi2GetFMUstate(c, &state), kOk);
  run(c, 200, 330);
  const auto end = values(resources_, c);
  EXPECT_NE(then, end);
  for (int n = 0; n < 2; ++n) {
    ASSERT_EQ(fmi2SetFMUstate(c, state), kOk) << told_.text;
    EXPECT_EQ(values(resources_, c), then);
    run(c, 200, 330);
    EXPECT_EQ(values(resources_, c), end);
  }
  EXPECT_EQ(fmi2GetFMUstate(c, &state), kOk) << "the same one takes another";
  EXPECT_EQ(fmi2FreeFMUstate(c, &state), kOk);
  EXPECT_EQ(state, nullptr);
  EXPECT_EQ(fmi2FreeFMUstate(c, &state), kOk);
  fmi2FreeInstance(c);
}

TEST_F(FmiStates, BytesGoIntoAnotherInstance) {
  void* one = resources_.begin2(told_);
  void* state = nullptr;
  run(one, 0, 150);
  ASSERT_EQ(fmi2GetFMUstate(one, &state), kOk);
  size_t size = 0;
  ASSERT_EQ(fmi2SerializedFMUstateSize(one, state, &size), kOk);
  std::vector<char> bytes(size);
  EXPECT_EQ(fmi2SerializeFMUstate(one, state, bytes.data(), size - 1), kError);
  ASSERT_EQ(fmi2SerializeFMUstate(one, state, bytes.data(), size), kOk);
  ASSERT_EQ(fmi2FreeFMUstate(one, &state), kOk);
  run(one, 150, 260);
  const auto end = values(resources_, one);
  fmi2FreeInstance(one);

  void* other = resources_.make2(told_);  // as it is at first
  ASSERT_EQ(fmi2DeSerializeFMUstate(other, bytes.data(), size, &state), kOk) << told_.text;
  ASSERT_EQ(fmi2SetFMUstate(other, state), kOk) << told_.text;
  ASSERT_EQ(fmi2FreeFMUstate(other, &state), kOk);
  run(other, 150, 260);
  EXPECT_EQ(values(resources_, other), end);
  for (size_t n = 0; n < size; n += 7) {
    auto wrong = bytes;
    wrong[n] ^= 0x20;
    EXPECT_EQ(fmi2DeSerializeFMUstate(other, wrong.data(), size, &state), kError) << n;
    EXPECT_EQ(fmi2DeSerializeFMUstate(other, bytes.data(), n, &state), kError) << n;
  }
  EXPECT_EQ(state, nullptr);
  fmi2FreeInstance(other);

  const Resources foreign(kTurning);
  void* third = foreign.begin2(told_);
  told_.text.clear();
  EXPECT_EQ(fmi2DeSerializeFMUstate(third, bytes.data(), size, &state), kError);
  EXPECT_TRUE(told_.has("saved by another FMU"));
  fmi2FreeInstance(third);
}

TEST_F(FmiStates, AreKeptInEveryState) {
  void* c = resources_.make2(told_);
  void* first = nullptr;
  void* init = nullptr;
  void* last = nullptr;
  ASSERT_EQ(fmi2GetFMUstate(c, &first), kOk);
  EXPECT_EQ(fmi2EnterInitializationMode(c), kOk);
  ASSERT_EQ(fmi2GetFMUstate(c, &init), kOk);
  EXPECT_EQ(fmi2ExitInitializationMode(c), kOk);
  run(c, 0, 20);
  EXPECT_EQ(fmi2Terminate(c), kOk);
  ASSERT_EQ(fmi2GetFMUstate(c, &last), kOk);
  EXPECT_EQ(fmi2SetFMUstate(c, init), kOk);
  EXPECT_EQ(fmi2EnterInitializationMode(c), kError);
  EXPECT_EQ(fmi2ExitInitializationMode(c), kOk);
  EXPECT_EQ(fmi2SetFMUstate(c, first), kOk);
  EXPECT_EQ(fmi2EnterInitializationMode(c), kOk);
  EXPECT_EQ(fmi2SetFMUstate(c, last), kOk);
  EXPECT_EQ(fmi2DoStep(c, 0.02, 1e-3, 0), kError);
  for (void* state : {first, init, last}) EXPECT_EQ(fmi2FreeFMUstate(c, &state), kOk);
  fmi2FreeInstance(c);
}

TEST_F(FmiStates, AfterAResetItIsAsNew) {
  void* c = resources_.begin2(told_);
  const auto first = values(resources_, c);
  run(c, 0, 90);
  const auto then = values(resources_, c);
  ASSERT_EQ(fmi2Reset(c), kOk);
  EXPECT_EQ(fmi2EnterInitializationMode(c), kOk);
  EXPECT_EQ(fmi2ExitInitializationMode(c), kOk);
  EXPECT_EQ(values(resources_, c), first);
  run(c, 0, 90);
  EXPECT_EQ(values(resources_, c), then);
  fmi2FreeInstance(c);
}

}  // namespace
}  // namespace ipos::tests
