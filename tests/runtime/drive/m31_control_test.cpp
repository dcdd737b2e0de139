// MOVITRAC 31 at its terminals: 41 is CW/STOP, P600 and P601 give 42 and 43 their functions (MOVITRAC 31 PROFIBUS,
// 2.9). The codes are those of stdlib/parameters/mc31.tsv; level bits 0, 1 and 2 are terminals 41, 42 and 43.
#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

constexpr int kNoFunction = 0, kEnableStop = 1, kCcwStop = 2, kFaultReset = 3;  // P600, P601
constexpr const char* kTerminal41 = "DI00";

struct M31Terminal {
  const char* parameter;
  const char* other;
  const char* input;
};
constexpr M31Terminal kM31Terminals[] = {{"P600", "P601", "DI01"}, {"P601", "P600", "DI02"}};

struct M31Rig : DriveRig {
  // The other terminal has no function, as in figure 10.
  M31Rig(const M31Terminal& terminal, int function) : DriveRig("mc31") {
    set(terminal.other, kNoFunction);
    set(terminal.parameter, function);
    ai1(10'000);
  }
  void go_on() {
    run_ms(1000);
    settle();
  }
};

TEST(M31Control, TerminalWithoutFunctionDoesNothing) {
  for (const M31Terminal& terminal : kM31Terminals) {
    M31Rig rig(terminal, kNoFunction);
    rig.go_on();
    EXPECT_EQ(rig.rpm(), 0);
    rig.input(kTerminal41, true);
    rig.go_on();
    EXPECT_GT(rig.rpm(), 0) << "terminal 41 alone enables";
    const double speed = rig.rpm();
    rig.input(terminal.input, true);
    rig.go_on();
    EXPECT_EQ(rig.rpm(), speed) << terminal.parameter;
  }
}

// There is no minimum speed (ours): a setpoint of 0 is 0, and small ones are what they are.
TEST(M31Control, SmallSetpointsAreNotRaised) {
  for (const int32_t millivolt : {0, 1, 5, 100}) {
    M31Rig rig(kM31Terminals[0], kNoFunction);
    rig.ai1(millivolt);
    rig.input(kTerminal41, true);
    rig.run_ms(10);
    EXPECT_EQ(rig.drive.setpoint().speed, rig.drive.setpoint().requested) << millivolt;
    EXPECT_EQ(rig.drive.setpoint().speed == 0, millivolt == 0) << millivolt;
    EXPECT_EQ(rig.drive.setpoint().note, SetpointNote::None);
  }
}

TEST(M31Control, EnableAtEitherTerminal) {
  for (const M31Terminal& terminal : kM31Terminals) {
    M31Rig rig(terminal, kEnableStop);
    rig.input(kTerminal41, true);
    rig.go_on();
    EXPECT_EQ(rig.rpm(), 0) << terminal.parameter;
    rig.input(terminal.input, true);
    rig.go_on();
    EXPECT_GT(rig.rpm(), 0) << terminal.parameter;
    rig.input(terminal.input, false);
    rig.go_on();
    EXPECT_EQ(rig.rpm(), 0) << terminal.parameter;
  }
}

TEST(M31Control, CcwAtEitherTerminal) {
  for (const M31Terminal& terminal : kM31Terminals) {
    M31Rig rig(terminal, kCcwStop);
    rig.input(terminal.input, true);
    rig.go_on();
    EXPECT_LT(rig.rpm(), 0) << terminal.parameter;
    rig.input(kTerminal41, true);
    rig.go_on();
    EXPECT_EQ(rig.rpm(), 0) << "both directions are a stop";
    rig.input(terminal.input, false);
    rig.go_on();
    EXPECT_GT(rig.rpm(), 0) << terminal.parameter;
  }
}

TEST(M31Control, ResetAtEitherTerminal) {
  for (const M31Terminal& terminal : kM31Terminals)
    for (const int function : {kNoFunction, kFaultReset}) {
      M31Rig rig(terminal, function);
      rig.run_ms(1);
      rig.drive.raise_fault(41);
      rig.run_ms(1);
      EXPECT_EQ(rig.drive.fault(), 41);
      rig.input(terminal.input, true);
      rig.run_ms(1);
      EXPECT_EQ(rig.drive.fault(), function == kFaultReset ? 0 : 41) << terminal.parameter;
    }
}

// It has no parameter for a brake: 200 ms, which MOVIDRIVE has in P732 as delivered (runtime/drive/settings.def).
TEST(M31Control, TheBrakeIsInBeforeTheOutputStageGoesOff) {
  M31Rig rig(kM31Terminals[0], kNoFunction);
  rig.input(kTerminal41, true);
  rig.go_on();
  rig.input(kTerminal41, false);
  rig.ms_until_standing();
  EXPECT_TRUE(rig.stage());
  EXPECT_TRUE(rig.brake_released());
  EXPECT_EQ(rig.ms_until([&] { return !rig.brake_released(); }), 1) << "in the millisecond after";
  EXPECT_EQ(rig.ms_until([&] { return !rig.stage(); }), 200);
}

}  // namespace
}  // namespace ipos::tests
