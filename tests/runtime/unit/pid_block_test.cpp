// The PID controller against the closed form of each share.
#include "runtime/services/pid_block.hpp"

#include <gtest/gtest.h>

#include <array>
#include <tuple>

#include "tests/runtime/unit/program_rig.hpp"

namespace ipos::runtime {
namespace {

class Pid : public testing::Test {
 protected:
  Pid() : rig_("M01 : JMP M01\n") {
    rig_.preset("P276", 100);
    rig_.tick(2);
    rig_.h("PID_Mode") = 1;
  }
  int32_t& actual() { return rig_.h(100); }
  int32_t output() { return rig_.h("IPOS_Setp"); }
  tests::ProgramRig rig_;
};

TEST_F(Pid, ProportionalAndFeedForward) {
  rig_.h("PID_K_p") = 1500;
  rig_.h("PID_Command") = 1000;
  rig_.h("PID_Feedf") = 7;
  actual() = 400;
  rig_.tick(2);
  EXPECT_EQ(rig_.h("PID_Outp_P"), 900);  // 1.5 x 600
  EXPECT_EQ(output(), 907);
  EXPECT_EQ(rig_.h("PID_Status"), 1 << 3) << "no I share";
}

// I(n) = Kp x e x n ms / Tn: Kp 1, e 100, Tn 200 ms gives 100 after 200 ms.
TEST_F(Pid, Integral) {
  rig_.preset("P264", 200);
  rig_.h("PID_Command") = 100;
  for (int ms = 0; ms < 200; ++ms) rig_.tick(2);
  EXPECT_EQ(rig_.h("PID_Outp_I"), 100 * 65'536);
  EXPECT_EQ(output(), 200);
  EXPECT_EQ(rig_.h("PID_Status"), 0);
}

// D = Kp x Tv x change of e in a ms.
TEST_F(Pid, Derivative) {
  rig_.preset("P265", 10);
  rig_.h("PID_SetpMin") = -7500;
  rig_.tick(2);
  EXPECT_EQ(rig_.h("PID_Outp_D"), 0) << "switching on is no change";
  actual() = -3;
  rig_.tick(2);
  EXPECT_EQ(rig_.h("PID_Outp_D"), 30);
  EXPECT_EQ(output(), 33);
  actual() = 2;
  rig_.tick(2);
  EXPECT_EQ(rig_.h("PID_Outp_D"), -50);
}

TEST_F(Pid, LimitsAndTheirBits) {
  rig_.preset("P264", 1);
  rig_.h("PID_K_p") = 32'000;
  rig_.h("PID_Command") = INT32_MAX;
  actual() = INT32_MIN;
  for (int ms = 0; ms < 10; ++ms) rig_.tick(2);
  EXPECT_EQ(output(), 7500);
  EXPECT_EQ(rig_.h("PID_Status"), 1 << 2 | 1 << 4 | 1 << 6 | 1 << 7);
  rig_.h("PID_SetpMax") = -10'000;  // below the lower limit: that one counts
  rig_.h("PID_SetpMin") = -100;
  rig_.tick(2);
  EXPECT_EQ(output(), -100);
}

// Each share is limited to 32000 both ways, and so is their sum; each limit has its bit (IPOSplus p. 39).
TEST_F(Pid, EveryLimitHasItsBitAndBothSigns) {
  constexpr int32_t kP = 1 << 2, kNoI = 1 << 3, kI = 1 << 4, kD = 1 << 5, kSum = 1 << 6, kOutput = 1 << 7;
  for (const int sign : {1, -1}) {
    struct Row {
      int32_t integral_ms, derivative_ms, error, p, i, d, output, status;
    };
    // Kp is 1: P is the error, I adds error / Tn each ms, D is Tv times the change of the error in a ms.
    const Row rows[] = {{0, 0, 32'000, 32'000, 0, 0, 32'000, kNoI},
                        {0, 0, 32'001, 32'000, 0, 0, 32'000, kNoI | kP},
                        {1, 0, 16'000, 16'000, 32'000, 0, 32'000, kSum},
                        {1, 0, 16'001, 16'001, 32'000, 0, 32'000, kI | kSum},
                        {0, 10, 1'600, 1'600, 0, 16'000, 17'600, kNoI},
                        {0, 10, 3'200, 3'200, 0, 32'000, 32'000, kNoI | kSum},
                        {0, 10, 3'201, 3'201, 0, 32'000, 32'000, kNoI | kD | kSum}};
    for (const Row& row : rows) {
      SCOPED_TRACE(testing::Message() << row.error << ", sign " << sign);
      std::array<int32_t, 600> h{};
      const auto v = [&](std::string_view name) -> int32_t& {
        return h[stdlib::find_system_variable(name)->number];
      };
      rig_.preset("P264", row.integral_ms);
      rig_.preset("P265", row.derivative_ms);
      PidBlock block(rig_.parameters);
      v("PID_Mode") = 1;
      v("PID_K_p") = 1'000;
      v("PID_SetpMin") = -50'000;
      v("PID_SetpMax") = 50'000;
      // The error comes in the second millisecond, so that it is a change; with an integral it stays for two.
      block.tick(h);
      v("PID_Command") = sign * row.error;
      block.tick(h);
      if (row.integral_ms != 0) block.tick(h);
      EXPECT_EQ(v("PID_Outp_P"), sign * row.p);
      EXPECT_EQ(v("PID_Outp_I"), sign * row.i * 65'536);
      EXPECT_EQ(v("PID_Outp_D"), sign * row.d);
      EXPECT_EQ(v("IPOS_Setp"), sign * row.output);
      EXPECT_EQ(v("PID_Status"), row.status);
      v("PID_Feedf") = sign * 50'000;
      block.tick(h);
      EXPECT_EQ(v("IPOS_Setp"), sign * 50'000);
      EXPECT_NE(v("PID_Status") & kOutput, 0);
    }
  }
}

// Kp is 0 to 32.000; what is below counts as 0, what is above as 32.
TEST_F(Pid, TheGainIsWithinItsRange) {
  for (const auto& [gain, p] : {std::pair{INT32_MIN, 0},
                                {-1, 0},
                                {0, 0},
                                {1, 1},
                                {32'000, 32'000},
                                {32'001, 32'000},
                                {INT32_MAX, 32'000}}) {
    std::array<int32_t, 600> h{};
    const auto v = [&](std::string_view name) -> int32_t& {
      return h[stdlib::find_system_variable(name)->number];
    };
    PidBlock block(rig_.parameters);
    v("PID_Mode") = 1;
    v("PID_K_p") = gain;
    v("PID_SetpMax") = 50'000;
    v("PID_Command") = 1'000;
    block.tick(h);
    EXPECT_EQ(v("PID_Outp_P"), p) << gain;
    EXPECT_EQ(v("IPOS_Setp"), p) << gain;
  }
}

// What is below 1/65536 is not lost between the milliseconds, and nothing of a control before is left when it is
// switched on again.
TEST_F(Pid, TheIntegralBeginsAnewWithTheControl) {
  rig_.preset("P264", 300);
  rig_.preset("P265", 5);
  rig_.h("PID_Command") = 1;
  for (int ms = 0; ms < 300; ++ms) rig_.tick(2);
  EXPECT_NEAR(rig_.h("PID_Outp_I"), 65'536, 300) << "1 in Tn";
  EXPECT_LE(rig_.h("PID_Outp_I"), 65'536);
  for (const int32_t other : {0, 2, 3}) {
    rig_.h("PID_Mode") = 1;
    rig_.tick(2);
    EXPECT_GT(rig_.h("PID_Outp_I"), 0);
    rig_.h("PID_Mode") = other;
    rig_.tick(2);
    rig_.h("PID_Command") = 1'000;
    rig_.h("PID_Mode") = 1;
    rig_.tick(2);
    EXPECT_EQ(rig_.h("PID_Outp_I"), 1'000 * 65'536 / 300) << "of this millisecond alone, from mode " << other;
    EXPECT_EQ(rig_.h("PID_Outp_D"), 0) << "switching on is no change";
    rig_.h("PID_Command") = 1;
  }
}

// The same limits hold for the step response; H524 is the setpoint with the feed-forward.
TEST_F(Pid, TheStepResponseIsLimitedToo) {
  rig_.h("PID_Mode") = 2;
  rig_.h("PID_Feedf") = 100;
  for (const auto& [command, within, limited] :
       {std::tuple{7'400, 7'500, false}, {7'401, 7'500, true}, {-100, 0, false}, {-101, 0, true}}) {
    rig_.h("PID_Command") = command;
    rig_.tick(2);
    EXPECT_EQ(output(), within) << command;
    EXPECT_EQ(rig_.h("PID_Status"), limited ? 1 << 7 : 0) << command;
  }
}

TEST_F(Pid, StepResponseAndOff) {
  rig_.h("PID_Mode") = 2;
  rig_.h("PID_Command") = 1234;
  rig_.tick(2);
  EXPECT_EQ(output(), 1234);
  rig_.h("PID_Mode") = 0;
  rig_.h("IPOS_Setp") = 55;  // the program's own
  rig_.tick(2);
  EXPECT_EQ(output(), 55);
}

}  // namespace
}  // namespace ipos::runtime
