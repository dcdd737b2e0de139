// The positioning commands in programs: what waits and what does not, keywords, refusals with source line.
#include <gtest/gtest.h>

#include <filesystem>

#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"
#include "runtime/plant/plant.hpp"
#include "runtime/signals/variables.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;

// A program on a drive of its own, with 20 commands a millisecond for each task.
class ProgramRig {
 public:
  using Settings = std::vector<std::pair<std::string, int32_t>>;

  explicit ProgramRig(const std::string& text, const Settings& settings = {},
                      const std::string& unit = "mdxb") {
    const std::string source = "#include <constb.h>\n#include <iob.h>\n" + text;
    compiler::CompileOptions options;
    options.read_file = [](const std::string&) { return std::optional<std::string>(); };
    options.unit = stdlib::find_unit(unit);
    auto compiled = compiler::compile("P.IPC", "P.IPC", source, options);
    EXPECT_TRUE(compiled.image) << compiler::render_text(compiled.diagnostics.all(), *compiled.sources,
                                                         false);
    runtime::PlantFile file;
    runtime::StationConfig config;
    config.name = "p";
    config.unit = options.unit;
    config.program = "P.IPC";
    if (unit != "mc07")
      for (const auto& [number, value] : Settings{{"P700", 13}, {"P323", 0}, {"P903", 5}})
        config.parameters.push_back({number, value, {}});
    for (const auto& [number, value] : settings) config.parameters.push_back({number, value, {}});
    for (const int input : {0, 1, 3}) config.inputs.push_back({static_cast<uint8_t>(input), true, {}});
    file.stations.push_back(config);
    std::vector<std::optional<vm::Image>> programs;
    programs.emplace_back(std::move(*compiled.image));
    std::vector<runtime::PlantError> errors;
    plant_.emplace(std::move(file), std::move(programs), vm::Rates{{20, 20, 20}}, errors);
    for (const auto& error : errors) ADD_FAILURE() << error.text;
  }

  void run(int ms) { plant_->run_until(end_ += ms * kMillisecond); }
  int32_t operator[](const std::string& name) {
    const auto number = signals::find_variable(station(), name);
    EXPECT_TRUE(number) << name;
    return station().variable(*number);
  }
  runtime::Station& station() { return *plant_->stations()[0]; }
  runtime::Drive& drive() { return station().drive().state(); }
  bool said(const std::string& text) const {
    for (const auto& entry : plant_->journal().entries())
      if (entry.text.find(text) != std::string::npos) return true;
    return false;
  }

 private:
  std::optional<runtime::Plant> plant_;
  runtime::Time end_ = 0;
};

TEST(PositioningProgram, WaitingBlocksItsTaskOnly) {
  ProgramRig rig(R"(
long lStep, lCount, lThere;
Other() { while (1) { lCount++; _Wait(1); } }
main() {
  _SetTask2(T2_START, Other);
  lStep = 1;
  _GoAbs(GO_WAIT, 50000);
  lThere = ActPos_Mot;
  lStep = 2;
  _GoRel(GO_WAIT, -8000);
  lStep = 3;
}
)");
  rig.run(500);
  EXPECT_EQ(rig["lStep"], 1);
  EXPECT_GT(rig["lCount"], 200);
  rig.run(1000);
  EXPECT_GE(rig["lThere"], 49'950);
  rig.run(1000);
  EXPECT_EQ(rig["lStep"], 3);
  EXPECT_EQ(rig["H511"], 42'000);
  EXPECT_EQ(rig["H491"], 42'000);
}

TEST(PositioningProgram, NotWaitingGoesOnAtOnce) {
  ProgramRig rig(R"(
long lStep, lTarget, lNotYet;
main() {
  _GoAbs(GO_NOWAIT, 50000);
  lNotYet = !(StatusWord & 0x80000);    // cleared by the command
  _GoRel(GO_NOWAIT, -8000);
  lTarget = TargetPos;
  lStep = 1;
}
)");
  rig.run(1);
  EXPECT_EQ(rig["lStep"], 1);
  EXPECT_EQ(rig["lNotYet"], 1);
  EXPECT_EQ(rig["lTarget"], 42'000);
}

TEST(PositioningProgram, ADirectWriteShowsTheOldBitForAMillisecond) {
  ProgramRig rig(R"(
long lStale, lFresh;
main() {
  _Wait(10);
  TargetPos = 50000;
  lStale = (StatusWord >> 19) & 1;
  _Wait(2);
  lFresh = (StatusWord >> 19) & 1;
}
)");
  rig.run(20);
  EXPECT_EQ(rig["lStale"], 1);
  EXPECT_EQ(rig["lFresh"], 0);
}

// A sequence with waiting travels is stopped and started anew, while main travels itself: the wait of the
// stopped task must not end another wait of the new one.
TEST(PositioningProgram, AStoppedTaskLeavesNoWaitBehind) {
  ProgramRig rig(R"(
long lPart;
Sequence() {
  lPart = 1;
  _Wait(2000);
  lPart = 2;
  _GoAbs(GO_WAIT, 100000);
  lPart = 3;
  while (1) ;
}
main() {
  _Go0(GO0_U_W_CAM);
  _SetTask2(T2_START, Sequence);
  _Wait(2300);
  _AxisStop(AS_RSTOP);
  _SetTask2(T2_STOP, Sequence);
  _Wait(500);
  _AxisStop(AS_ENABLE);
  _SetTask2(T2_START, Sequence);
  _GoAbs(GO_WAIT, 5000);
  lPart += 10;
  while (1) ;
}
)",
                 {{"P136", 200}});
  rig.run(2250);
  EXPECT_EQ(rig["lPart"], 2);
  rig.run(500);
  EXPECT_EQ(rig["lPart"], 2);
  EXPECT_TRUE(rig.drive().axis().standing);
  rig.run(1000);
  EXPECT_EQ(rig["lPart"], 11) << "main is at 5000, the sequence waits its 2 s";
  EXPECT_EQ(rig["H511"], 5'000);
  rig.run(1100);
  EXPECT_EQ(rig["lPart"], 2) << "now it travels, the wait for 5000 is not its own";
  rig.run(2000);
  EXPECT_EQ(rig["lPart"], 3);
  EXPECT_EQ(rig["H511"], 100'000);
}

TEST(PositioningProgram, StopsAndGoesOn) {
  ProgramRig rig(R"(
long lDone;
main() {
  _SetTask2(T2_START, Watch);
  _GoAbs(GO_WAIT, 200000);
  lDone = 1;
}
Watch() {
  _Wait(700);
  _AxisStop(AS_HCTRL);
  _Wait(1500);
  _AxisStop(AS_ENABLE);
  while (1) ;
}
)");
  rig.run(1690);
  EXPECT_FALSE(rig.drive().axis().standing) << "1500 rpm on t11 of 2 s for 3000 rpm are 1 s";
  rig.run(20);
  EXPECT_TRUE(rig.drive().axis().standing);
  EXPECT_EQ(rig["lDone"], 0);
  rig.run(3000);
  EXPECT_EQ(rig["lDone"], 1);
  EXPECT_EQ(rig["H511"], 200'000);
}

TEST(PositioningProgram, PositionStop) {
  ProgramRig rig(R"(
long lTarget, lDone;
main() {
  _GoAbs(GO_NOWAIT, 200000);
  _Wait(700);
  _AxisStop(AS_PSTOP);
  lTarget = TargetPos;
  while (!(StatusWord & 0x80000)) ;
  lDone = 1;
}
)");
  rig.run(2000);
  EXPECT_EQ(rig["lDone"], 1);
  EXPECT_EQ(rig["H511"], rig["lTarget"]);
}

TEST(PositioningProgram, ReferenceTravelKeywords) {
  // Type 0: the next zero pulse CCW, 4096 increments away at 50 rpm.
  const ProgramRig::Settings type0{{"P903", 0}};
  ProgramRig wait("long l; main() { _Go0(GO0_U_W_ZP); l = 1; }", type0);
  ProgramRig no_wait("long l; main() { _Go0(GO0_U_NW_ZP); l = 1; }", type0);
  wait.run(500);
  no_wait.run(500);
  EXPECT_EQ(wait["l"], 0);
  EXPECT_EQ(no_wait["l"], 1);
  EXPECT_EQ(wait["H473"] >> 20 & 1, 0);
  wait.run(2000);
  EXPECT_EQ(wait["l"], 1);
  EXPECT_EQ(wait["H473"] >> 20 & 1, 1);

  ProgramRig conditional(R"(
long l, lAgain;
main() {
  _Go0(GO0_C_W_ZP);
  _GoAbs(GO_WAIT, 10000);
  l = ActPos_Mot;
  _Go0(GO0_C_W_ZP);
  lAgain = ActPos_Mot;
  _Go0(GO0_RESET);
  lAgain -= 5 * ((StatusWord >> 20) & 1);
}
)",
                         type0);
  conditional.run(5000);
  EXPECT_GE(conditional["l"], 9'950);
  EXPECT_NEAR(conditional["lAgain"], conditional["l"], 30) << "referenced: no second travel";
  EXPECT_EQ(conditional["H473"] >> 20 & 1, 0);
}

TEST(PositioningProgram, SetSystemValues) {
  ProgramRig rig(R"(
SSPOSRAMP r; SSPOSSPEED v; long lShape, lOn;
main() {
  r.Up = 1234; r.Down = 321; _SetSys(SS_POSRAMP, r);
  v.CW = 10005; v.CCW = 99; _SetSys(SS_POSSPEED, v);
  lShape = 2; _SetSys(SS_RAMPTYPE, lShape);
  lOn = 1; _SetSys(SS_OVERRIDE, lOn);
}
)");
  rig.run(10);
  const runtime::UnitInterface& server = rig.station().drive();
  EXPECT_EQ(server.value("911"), 1'234);
  EXPECT_EQ(server.value("912"), 321);
  EXPECT_EQ(server.value("913"), 1'000'500);
  EXPECT_EQ(server.value("914"), 9'900);
  EXPECT_EQ(server.value("916"), 2);
  EXPECT_EQ(server.value("930"), 1);
}

TEST(PositioningProgram, SetSystemValuesOutOfRange) {
  ProgramRig rig(R"(
SSPOSRAMP r; SSPOSSPEED v; long lShape;
main() {
  r.Up = 1; r.Down = 100000; _SetSys(SS_POSRAMP, r);
  v.CW = 2147483647; v.CCW = -5; _SetSys(SS_POSSPEED, v);
  lShape = 3; _SetSys(SS_RAMPTYPE, lShape);
}
)");
  rig.run(10);
  const runtime::UnitInterface& server = rig.station().drive();
  EXPECT_EQ(server.value("911"), 10);
  EXPECT_EQ(server.value("912"), 20'000);
  EXPECT_EQ(server.value("913"), 5'000'000);
  EXPECT_EQ(server.value("914"), 0);
  EXPECT_EQ(server.value("916"), 0);
  EXPECT_TRUE(rig.said("F77"));
}

TEST(PositioningProgram, TouchProbeStoresPositions) {
  ProgramRig rig(R"(
main() {
  _TouchProbe(TP_EN2_FE);
  _TouchProbe(TP_EN1_RE);
  _GoAbs(GO_NOWAIT, 100000);
  _Wait(600);
  _TouchProbe(TP_DIS1);
}
)",
                 {{"P601", 16}, {"P602", 16}, {"P603", 1}});
  const auto inputs = [&](unsigned probes) {
    const unsigned levels = 0b10011 | probes << 2;
    for (unsigned n = 0; n < 5; ++n)
      rig.station().inputs().line(n).set = static_cast<int32_t>(levels >> n & 1);
  };
  inputs(0b10);
  rig.run(500);
  const int32_t at = rig["H511"];
  EXPECT_GT(at, 10'000);
  inputs(0b01);
  rig.run(1);
  EXPECT_EQ(rig["H507"], at);
  EXPECT_EQ(rig["H505"], at);
  inputs(0b00);
  rig.run(200);
  inputs(0b01);
  rig.run(2);
  EXPECT_EQ(rig["H507"], at) << "disabled";
}

TEST(PositioningProgram, Cams) {
  ProgramRig rig(R"(
#pragma globals 300 399
GSCAM cam; GSCAM_EXT ext; CAM_OUTPUT out; long lBits, lExt;
main() {
  cam.SourceVar = 511; cam.DestVar = numof(lBits); cam.BitPosition = 4; cam.NumOfCam = 1;
  cam.PosL1 = 20000; cam.PosR1 = 30000;
  ext.CamState = 0x80000003; ext.CamSource = 0; ext.CamDestination = numof(lExt); ext.CamOutputs = 1;
  ext.CamData1 = numof(out);
  out.NumOfCam = 1; out.PosL1 = 20000; out.PosR1 = 30000;
  _GetSys(ext, GS_CAM);
  _GoAbs(GO_NOWAIT, 50000);
  while (1) _GetSys(cam, GS_CAM);
}
)");
  int seen = 0;
  for (int ms = 0; ms < 2000; ++ms) {
    rig.run(1);
    const bool inside = rig["H511"] >= 20'000 && rig["H511"] <= 30'000;
    ASSERT_EQ(rig["lBits"], inside ? 16 : 0) << rig["H511"];
    ASSERT_EQ(rig["lExt"], inside ? 1 : 0) << rig["H511"];
    seen += inside;
  }
  EXPECT_GT(seen, 50);
}

// An axis that turns at a constant speed is steady; what a cam then writes goes to the outputs all the
// same, a millisecond later.
TEST(PositioningProgram, CamsSwitchOutputsAtConstantSpeed) {
  ProgramRig rig(R"(
#pragma globals 300 399
GSCAM_EXT ext; CAM_OUTPUT out;
main() {
  ext.CamState = 0x80000003; ext.CamSource = 0; ext.CamDestination = 481; ext.CamOutShiftLeft = 1;
  ext.CamOutputs = 1; ext.CamData1 = numof(out);
  out.NumOfCam = 1; out.PosL1 = 40000; out.PosR1 = 50000;
  _GetSys(ext, GS_CAM);
}
)",
                 {{"P700", 0}, {"P130", 500}, {"P160", 300'000}, {"P620", 21}});
  rig.station().inputs().line(4).set = 1;
  int32_t ordered = 0;
  int seen = 0;
  for (int ms = 0; ms < 4000; ++ms) {
    rig.run(1);
    ASSERT_EQ(rig["H482"] & 2, ordered) << rig["H511"];
    ordered = rig["H481"] & 2;
    seen += ordered != 0;
  }
  EXPECT_GT(seen, 100);
}

TEST(PositioningProgram, ACamWithoutVariablesIsF10) {
  ProgramRig rig("GSCAM cam; main() { cam.SourceVar = 5000; _GetSys(cam, GS_CAM); }");
  rig.run(5);
  EXPECT_EQ(rig.drive().fault(), 10);
  EXPECT_TRUE(rig.said("GETSYS CAM"));
}

TEST(PositioningProgram, WhatIsRefusedNamesItsLine) {
  ProgramRig rig(R"(
main() {
  _Go0(GO0_U_W_CAM);
  _GoAbs(GO_NOWAIT, 70000);
}
)",
                 {{"P920", 50'000}, {"P921", -50'000}});
  rig.run(10);
  EXPECT_TRUE(rig.said("F78"));
  EXPECT_TRUE(rig.said("ordered at P.IPC:6:"));
}

// Orders of other kinds that come in the same millisecond do not take the blame.
TEST(PositioningProgram, AFaultNamesTheOrderThatCausedIt) {
  const std::string program = R"(
SSPOSRAMP r;
main() {
  r.Up = 100; r.Down = 100;
  _Go0(GO0_C_NW_CAM);
  _SetSys(SS_POSRAMP, r);
  _GoAbs(GO_NOWAIT, 5000);
}
)";
  ProgramRig no_mode(program, {{"P700", 0}});
  no_mode.run(10);
  EXPECT_TRUE(no_mode.said("F77: the axis cannot be positioned"));
  EXPECT_TRUE(no_mode.said("ordered at P.IPC:7:")) << "the reference travel";
  EXPECT_TRUE(no_mode.said("ordered at P.IPC:9:")) << "and the travel";
  EXPECT_FALSE(no_mode.said("ordered at P.IPC:8:")) << "a ramp is no travel";
  ProgramRig no_cam(program, {{"P903", 1}});
  no_cam.run(500);
  EXPECT_TRUE(no_cam.said("F39"));
  EXPECT_TRUE(no_cam.said("ordered at P.IPC:7:"));
  EXPECT_FALSE(no_cam.said("ordered at P.IPC:9:"));
}

TEST(PositioningProgram, WithoutEncoderThereAreNoTravels) {
  ProgramRig rig("main() { _GoAbs(GO_NOWAIT, 100); }", {}, "mc07");
  rig.run(5);
  EXPECT_EQ(rig.drive().fault(), 10);
}

TEST(PositioningProgram, TouchProbeRaisesItsInterrupt) {
  ProgramRig rig(R"(
long lEdges, lPlace, lBefore, lAfter;
Edge() { lEdges++; lPlace = TpPos1_Mot; }
No() { lBefore++; }
Yes() { lAfter++; }
main() {
  _SetInterrupt(SI_TOUCHP1, Edge);
  _TouchProbe(TP_EN1_RE);
  _SystemCall(SC_NTP1, No);
  _SystemCall(SC_TP1, Yes);
  _GoAbs(GO_NOWAIT, 200000);
  _Wait(500);
  _SystemCall(SC_NTP1, No);
  _SystemCall(SC_TP1, Yes);
  while (1) ;
}
)",
                 {{"P601", 16}});
  rig.run(300);
  EXPECT_EQ(rig["lEdges"], 0);
  const int32_t before = rig["H511"];
  rig.station().inputs().line(2).set = 1;
  rig.run(4);
  EXPECT_EQ(rig["lEdges"], 1);
  EXPECT_GE(rig["lPlace"], before);
  EXPECT_LE(rig["lPlace"], rig["H511"]);
  rig.station().inputs().line(2).set = 0;
  rig.run(300);
  EXPECT_EQ(rig["lEdges"], 1);
  EXPECT_EQ(rig["lBefore"], 1);
  EXPECT_EQ(rig["lAfter"], 1);
}

// Incremental encoders begin at 0 and the reference is lost; the absolute encoder knows where the shaft is.
TEST(PositioningProgram, PowerOffLosesTheReference) {
  const char* text = R"(
long lPosition;
main() {
  lPosition = ActPos_Abs;
  _Wait(200);
  _Go0(GO0_U_W_CAM);
  _GoAbs(GO_WAIT, 50000);
}
)";
  ProgramRig rig(text, {{"P900", 1000}});
  rig.run(150);
  EXPECT_EQ(rig["lPosition"], 0);
  rig.run(2000);
  EXPECT_EQ(rig["H511"], 50'000);
  EXPECT_EQ(rig["H509"], 49'000);
  EXPECT_NE(rig["H473"] & 1 << 20, 0);
  EXPECT_EQ(rig.drive().shaft_position(), 49'000);
  rig.station().power_off();
  rig.run(100);
  rig.station().power_on();
  rig.run(150);
  EXPECT_EQ(rig["H473"] & 1 << 20, 0);
  EXPECT_EQ(rig["H511"], 0);
  EXPECT_EQ(rig["H510"], 0);
  EXPECT_EQ(rig["H492"], 0);
  EXPECT_EQ(rig["lPosition"], 49'000);
  EXPECT_EQ(rig.drive().shaft_position(), 49'000);
  rig.run(2000);
  EXPECT_EQ(rig["H511"], 50'000);
  EXPECT_EQ(rig.drive().shaft_position(), 2 * 49'000);
}

// What the memory keeps holds no travel: with an absolute encoder the axis is where it was.
TEST(PositioningProgram, AnAbsoluteEncoderIsReferencedAtPowerOn) {
  ProgramRig rig(R"(
main() {
  _Wait(200);
  _GoAbs(GO_WAIT, 30000);
}
)",
                 {{"P941", 2}});
  rig.run(2000);
  EXPECT_EQ(rig["H509"], 30'000);
  rig.station().power_off();
  rig.run(100);
  rig.station().power_on();
  rig.run(150);
  EXPECT_NE(rig["H473"] & 1 << 20, 0);
  EXPECT_EQ(rig["H509"], 30'000);
  EXPECT_EQ(rig["H511"], 0);
  EXPECT_EQ(rig["H492"], 30'000) << "no target yet: it is where the axis is";
  EXPECT_TRUE(rig.drive().axis().standing);
}

}  // namespace
}  // namespace ipos::tests
