// The PID controller against the closed form of each share.
#include "runtime/unit/pid_block.hpp"

#include <gtest/gtest.h>

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
