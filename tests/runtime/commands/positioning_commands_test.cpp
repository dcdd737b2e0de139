// GOA, GOR, GO0, ASTOP, TOUCHP, and what of GETSYS, SETSYS and SYSCALL belongs to positioning, keyword by keyword: what
// each orders, and who waits for what.
#include "runtime/commands/positioning_commands.hpp"

#include <gtest/gtest.h>

#include "tests/runtime/unit/program_rig.hpp"

namespace ipos::runtime {
namespace {

using tests::ProgramRig;
using vm::Opcode;

constexpr uint16_t kEnabledTerminals = 0b1011;  // DI00 /inhibit, DI01 CW, DI03 enable
constexpr uint16_t kCam = 1 << 2;               // DI02, where P601 says so

// The program of the rig is executed by a machine of its own, whose system commands can position.
struct AxisRig : ProgramRig {
  explicit AxisRig(const std::string& text, std::initializer_list<std::pair<const char*, int32_t>> more = {})
      : ProgramRig(text),
        service(milliseconds, drive, parameters, journal, "unit1", [](uint32_t) { return std::string(); }),
        positioning(service),
        positioning_services(services(server.memory())),
        axis_commands(with_positioning(), journal, "unit1", &image),
        program(machine.program(), axis_commands.host()) {
    server.connect_program(program);
    preset("P700", 13);
    preset("P323", 0);
    for (const auto& [number, value] : more) preset(number, value);
    drive.set_inputs(kEnabledTerminals);
    for (int n = 0; n < 3; ++n) go_on(0);
    program.start();
  }
  const ProgramServices& with_positioning() {
    positioning_services.positioning = &positioning;
    return positioning_services;
  }
  int32_t& v(size_t n) { return program.variables()[n]; }
  // A millisecond as in a unit, with so many commands of each task.
  void go_on(uint32_t rate = 20) {
    const auto h = program.variables();
    drive.tick(service.order(now, h, 0));
    service.observe();
    service.show(now, h);
    positioning.tick(program);
    vm::run_tick(program, vm::Rates{{rate, rate, rate}});
    now += kMillisecond;
  }
  void run_ms(int count) {
    while (count-- > 0) go_on();
  }
  std::optional<vm::HostReply> order(Opcode opcode, int32_t a, int32_t b = 0) {
    vm::Instruction command;
    command.opcode = opcode;
    command.operands = {a, b};
    return positioning.execute(program, 1, command);
  }
  bool referenced() { return service.positioner().referenced(); }

  PositioningService service;
  PositioningCommands positioning;
  ProgramServices positioning_services;
  SystemCommands axis_commands;
  vm::Machine program;
  Time now = 0;
};

TEST(TravelCommands, AbsoluteAndRelativeByVariableOrConstant) {
  struct Row {
    Opcode opcode;
    int32_t target;
  };
  for (const Row& row : {Row{Opcode::GoAbsH, 7'000}, Row{Opcode::GoAbsK, 120}, Row{Opcode::GoRelH, 12'000},
                         Row{Opcode::GoRelK, 5'120}})
    for (const int32_t waits : {0, 1}) {
      AxisRig rig("END\n");
      rig.order(Opcode::GoAbsK, 0, 5'000);
      EXPECT_EQ(rig.v(492), 5'000);
      rig.v(120) = 7'000;
      const auto reply = rig.order(row.opcode, waits, 120);
      ASSERT_TRUE(reply);
      EXPECT_EQ(reply->answer, waits == 1 ? vm::Answer::Wait : vm::Answer::Done);
      EXPECT_EQ(rig.v(492), row.target) << "H492 has it at once (IPOSplus p. 34)";
      EXPECT_EQ(rig.v(473) >> 19 & 1, 0);
    }
}

// A target that the program has written just before counts for a relative travel.
TEST(TravelCommands, ARelativeTravelIsOfTheWrittenTarget) {
  AxisRig rig("END\n");
  rig.v(492) = 30'000;
  rig.order(Opcode::GoRelK, 0, -1'000);
  EXPECT_EQ(rig.v(492), 29'000);
}

TEST(TravelCommands, OnlyWhoWaitsIsStopped) {
  AxisRig rig("GOA WAIT #8000\nSET H0 = 1\nM01 : ADD H1 + 1\nJMP M01\n");
  rig.run_ms(100);
  EXPECT_EQ(rig.v(0), 0);
  EXPECT_EQ(rig.program.task(1).state, vm::TaskState::Waiting);
  int ms = 0;
  for (; ms < 3000 && rig.v(0) == 0; ++ms) {
    EXPECT_EQ(rig.v(473) >> 19 & 1, 0) << "it waits until it is in position";
    rig.go_on();
  }
  EXPECT_EQ(rig.v(0), 1);
  EXPECT_NEAR(rig.v(511), 8'000, 51);  // P922 is 50
  AxisRig there("GOA WAIT #10\nSET H0 = 1\nEND\n");
  there.run_ms(1);
  EXPECT_EQ(there.v(0), 1) << "a target within the window is reached already";
}

TEST(TravelCommands, ACancelledWaitIsNotResumed) {
  for (const bool all : {false, true}) {
    AxisRig rig("GOA WAIT #3000\nSET H0 = 1\nEND\n");
    rig.run_ms(5);
    if (all)
      rig.positioning.cancel_all();
    else
      rig.positioning.cancel(1);
    rig.run_ms(3000);
    EXPECT_EQ(rig.v(511), 3'000);
    EXPECT_EQ(rig.v(0), 0);
  }
  AxisRig rig("GOA WAIT #3000\nSET H0 = 1\nEND\n");
  rig.run_ms(5);
  rig.positioning.cancel(2);
  rig.run_ms(3000);
  EXPECT_EQ(rig.v(0), 1) << "another context was cancelled";
}

// Bits of the keywords: 1 does not wait, 2 the cam alone, 4 only where not referenced; 8 RESET. Type 1 goes CCW to the
// end of the cam, here at -3000, with zero pulse on to that of the turn, -4096.
TEST(ReferenceCommands, EveryKeyword) {
  for (int32_t keyword = 0; keyword < 8; ++keyword)
    for (const bool before : {false, true}) {
      SCOPED_TRACE(testing::Message() << "keyword " << keyword << ", referenced before: " << before);
      AxisRig rig("END\n", {{"P903", before ? 5 : 1}, {"P601", 17}, {"P900", 0}});
      const auto shaft = [&] { return rig.drive.shaft_position(); };
      if (before) {
        rig.order(Opcode::Go0, 1);
        rig.run_ms(2);
        ASSERT_TRUE(rig.referenced());
        rig.preset("P903", 1);
        rig.run_ms(2);
      }
      const bool travels = !before || (keyword & 4) == 0;
      const auto reply = rig.order(Opcode::Go0, keyword);
      ASSERT_TRUE(reply);
      EXPECT_EQ(reply->answer == vm::Answer::Wait, travels && (keyword & 1) == 0);
      EXPECT_EQ(rig.service.positioner().referencing(), travels);
      EXPECT_EQ(rig.referenced(), !travels);
      EXPECT_EQ(rig.v(473) >> 20 & 1, travels ? 0 : 1);
      if (!travels) continue;
      for (int ms = 0; ms < 20'000 && !rig.referenced(); ++ms) {
        const bool cam = shaft() < -1'000 && shaft() > -3'000;
        rig.drive.set_inputs(static_cast<uint16_t>(kEnabledTerminals | (cam ? kCam : 0)));
        rig.go_on();
      }
      ASSERT_TRUE(rig.referenced());
      // The reference point has the number P900 = 0.
      const int32_t point = shaft() - rig.v(511);
      if ((keyword & 2) != 0)
        EXPECT_NEAR(point, -3'000, 30);
      else
        EXPECT_EQ(point, -4'096);
    }
}

TEST(ReferenceCommands, ResetEndsATravelAndTheReference) {
  AxisRig rig("END\n", {{"P903", 5}});
  EXPECT_EQ(rig.order(Opcode::Go0, 0)->answer, vm::Answer::Done) << "type 5 is there at once";
  EXPECT_TRUE(rig.referenced());
  EXPECT_EQ(rig.order(Opcode::Go0, 8)->answer, vm::Answer::Done);
  EXPECT_FALSE(rig.referenced());
  rig.preset("P903", 0);
  rig.run_ms(2);
  rig.order(Opcode::Go0, 1);
  rig.run_ms(200);
  EXPECT_TRUE(rig.service.positioner().referencing());
  rig.order(Opcode::Go0, 8);
  EXPECT_FALSE(rig.service.positioner().referencing());
  EXPECT_FALSE(rig.referenced());
}

TEST(StopCommands, EveryKeyword) {
  const auto command_after = [](AxisRig& rig, int32_t keyword) {
    EXPECT_EQ(rig.order(Opcode::AxisStop, keyword)->answer, vm::Answer::Done);
    rig.run_ms(2);
    return rig.drive.verdict().command;
  };
  AxisRig rig("END\n");
  rig.order(Opcode::GoAbsK, 0, 400'000);
  rig.run_ms(500);
  EXPECT_EQ(rig.drive.verdict().command, Command::Enable);
  EXPECT_EQ(command_after(rig, 0), Command::RapidStop);
  EXPECT_EQ(command_after(rig, 1), Command::HoldControl);
  EXPECT_EQ(command_after(rig, 3), Command::Enable);
  EXPECT_EQ(rig.v(492), 400'000);
  rig.run_ms(500);
  EXPECT_EQ(command_after(rig, 2), Command::Enable) << "a position stop locks nothing";
  EXPECT_LT(rig.v(492), 200'000) << "the target is where it stops";
  EXPECT_GT(rig.v(492), rig.v(511));
  EXPECT_EQ(command_after(rig, 4), Command::Enable) << "no keyword";
}

// A target written before a position stop is not forgotten: it is the stop that replaces it.
TEST(StopCommands, APositionStopReplacesTheWrittenTarget) {
  AxisRig rig("END\n");
  rig.v(492) = 100'000;
  rig.order(Opcode::AxisStop, 2);
  EXPECT_EQ(rig.v(492), 0);
  rig.run_ms(100);
  EXPECT_EQ(rig.v(511), 0);
}

TEST(TouchProbeCommands, EveryKeyword) {
  struct Row {
    bool rising, falling;
  };
  constexpr Row kRows[] = {{false, false}, {true, true}, {true, false}, {false, true}};
  for (int32_t keyword = 0; keyword < 8; ++keyword) {
    AxisRig rig("END\n");
    for (size_t n = 0; n < 2; ++n) rig.service.change_positioner().touch_probes().enable(n, n == 0, n == 1);
    EXPECT_EQ(rig.order(Opcode::TouchProbe, keyword)->answer, vm::Answer::Done);
    for (size_t n = 0; n < 2; ++n) {
      const bool meant = n == static_cast<size_t>(keyword / 4);
      const Row row = meant ? kRows[keyword % 4] : Row{n == 0, n == 1};
      const auto& probe = rig.service.positioner().touch_probes().probe(n);
      EXPECT_EQ(probe.rising, row.rising) << keyword << ", probe " << n + 1;
      EXPECT_EQ(probe.falling, row.falling) << keyword << ", probe " << n + 1;
    }
  }
}

TEST(TouchProbeCommands, SystemCallsFollowTheFirstProbe) {
  const char* text = R"(
      TOUCHP ENABLE 1 RISING
      TOUCHP ENABLE 2 RISING
M01 : SYSCALL TOUCHP1 , M02
      SYSCALL NOT TOUCHP1 , M03
      JMP M01
M02 : ADD H0 + 1
      RET
M03 : ADD H1 + 1
      RET
)";
  AxisRig rig(text);
  rig.run_ms(5);
  EXPECT_EQ(rig.v(0), 0);
  EXPECT_GT(rig.v(1), 0);
  EXPECT_FALSE(rig.positioning.touched());
  rig.drive.set_inputs(kEnabledTerminals & ~(1 << 3));  // DI03, the second probe
  rig.run_ms(2);
  rig.drive.set_inputs(kEnabledTerminals);
  rig.run_ms(2);
  EXPECT_EQ(rig.v(0), 0);
  rig.drive.set_inputs(kEnabledTerminals | kCam);  // DI02, the first one
  rig.run_ms(2);
  EXPECT_TRUE(rig.positioning.touched());
  const int32_t not_touched = rig.v(1);
  rig.run_ms(5);
  EXPECT_GT(rig.v(0), 0);
  EXPECT_EQ(rig.v(1), not_touched);
  // A unit that cannot position has no probes.
  for (const char* event : {"TOUCHP1", "NOT TOUCHP1"}) {
    ProgramRig none(std::string("SYSCALL ") + event + " , M01\nEND\nM01 : RET\n");
    none.run();
    EXPECT_EQ(none.machine.fault().number, 10);
  }
}

// Speeds in 0.1 rpm, ramps in ms, both as working values of P911 to P914.
TEST(PositioningValues, RampsAndSpeeds) {
  AxisRig rig("SETSYS POS.RAMP = H20\nSETSYS POS.SPEED = H30\nEND\n");
  rig.set(0, {});
  rig.v(20) = 1'234, rig.v(21) = 321, rig.v(30) = 10'005, rig.v(31) = 98;
  rig.run_ms(1);
  ASSERT_EQ(rig.program.fault().number, 0) << rig.program.fault().reason;
  EXPECT_EQ(rig.parameter("P911"), 1'234);
  EXPECT_EQ(rig.parameter("P912"), 321);
  EXPECT_EQ(rig.parameter("P913"), 1'000'500);
  EXPECT_EQ(rig.parameter("P914"), 9'800);
  for (const auto& [given, cw] :
       {std::pair{-1, 0}, {INT32_MIN, 0}, {INT32_MAX, 5'000'000}, {0, 0}, {42'949'673, 5'000'000}}) {
    AxisRig other("SETSYS POS.SPEED = H30\nEND\n");
    other.v(30) = given, other.v(31) = 10'000;
    other.run_ms(1);
    EXPECT_EQ(other.parameter("P913"), cw) << given;
    EXPECT_EQ(other.parameter("P914"), 1'000'000);
  }
}

// Two variables: the last structure begins at H1022.
TEST(PositioningValues, TheStructureEndsWithTheLastVariable) {
  for (const int32_t keyword : {9, 10})
    for (const int32_t at : {1'022, 1'023}) {
      AxisRig rig("END\n");
      rig.v(1'022) = rig.v(1'023) = 100;
      const auto reply = rig.order(Opcode::SetSys, keyword, at);
      ASSERT_TRUE(reply);
      EXPECT_EQ(reply->answer, at == 1'022 ? vm::Answer::Done : vm::Answer::Fault) << keyword;
      EXPECT_EQ(reply->fault, at == 1'022 ? 0 : vm::kFaultIllop);
    }
  AxisRig rig("END\n");
  for (const int32_t other : {0, 8, 11, 15})
    EXPECT_FALSE(PositioningCommands::has_value(Opcode::SetSys, other)) << other;
  for (const int32_t other : {0, 7, 9})
    EXPECT_FALSE(PositioningCommands::has_value(Opcode::GetSys, other)) << other;
}

// Bit 31 of the first element tells GSCAM_EXT from GSCAM (IPOSplus p. 86, 91).
TEST(CamCommands, BothKinds) {
  AxisRig rig("END\n");
  const int32_t standard[] = {511, 0, 300, 0, 0, 1, -10, 10};
  std::copy(std::begin(standard), std::end(standard), &rig.v(100));
  EXPECT_EQ(rig.order(Opcode::GetSys, 100, 8)->answer, vm::Answer::Done);
  EXPECT_EQ(rig.v(300), 1);
  EXPECT_FALSE(rig.service.extended_cams().runs());
  rig.v(100) = 4'000;  // no variable
  const auto bad = rig.order(Opcode::GetSys, 100, 8);
  EXPECT_EQ(bad->answer, vm::Answer::Fault);
  EXPECT_EQ(bad->fault, vm::kFaultIllop);
  rig.v(120) = INT32_MIN + 3;
  EXPECT_EQ(rig.order(Opcode::GetSys, 120, 8)->answer, vm::Answer::Done);
  EXPECT_TRUE(rig.service.extended_cams().runs());
}

}  // namespace
}  // namespace ipos::runtime
