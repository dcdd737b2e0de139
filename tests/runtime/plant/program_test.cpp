// Programs in a station: rates, tasks, interrupts from the drive, faults with place, response and reset.
#include <gtest/gtest.h>

#include "runtime/plant/actions.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::runtime {
namespace {

using tests::make_plant;
using tests::make_station;
using tests::ms;
using tests::told;
using tests::value;

// IPOSplus p. 44: P938 and P939 from 1/11 to 10/2 commands a millisecond, task 3 with 20 (ours).
TEST(Rates, AreExactToTheCommand) {
  const char* const program = R"(
long a, b, c;
t2() { while (1) b++; }
t3() { while (1) c++; }
main() { _SetTask2(T2_START, t2); _SetTask(T2_START, t3); while (1) a++; }
)";
  for (int extra = 0; extra <= 9; ++extra) {
    const auto plant = make_station(std::string("#include <constb.h>\n") + program,
                                    "[station.parameters]\nP938 = " + std::to_string(extra) + "\nP939 = 9\n");
    plant->run_until(ms(199));  // 200 ticks, 0 to 199 ms
    const vm::Machine& machine = *plant->stations()[0]->machine();
    EXPECT_EQ(machine.task(1).commands, 200U * static_cast<uint64_t>(extra + 1));
    const uint64_t second = static_cast<uint64_t>(9 - extra + 2);  // the rest of the nine, whatever P939 says
    const uint64_t ticks2 = extra == 0 ? 199 : 200;                // task 1 starts it with its first command
    EXPECT_GE(machine.task(2).commands, ticks2 * second);
    EXPECT_LE(machine.task(2).commands, 200 * second);
    EXPECT_GE(machine.task(3).commands, 198U * 20);
    // `while (1) a++;` is two commands a turn.
    EXPECT_EQ(value(*plant, "b"), static_cast<int32_t>((machine.task(2).commands + 1) / 2));
  }
  const auto plant = make_station("#include <constb.h>\nlong a; main() { while (1) a++; }",
                                  "[station.parameters]\nP938 = 2\nP939 = 3\n");
  EXPECT_EQ(plant->stations()[0]->drive().rates().commands, (std::array<uint32_t, 3>{3, 5, 20}));
}

TEST(ErrorInterrupt, RunsOnDriveFaults) {
  const auto plant = make_station(R"(
#include <constb.h>
long n, number, a;
error() { n++; _GetSys(number, GS_ERROR); }
main() { _SetInterrupt(SI_ERROR, error); while (1) a++; }
)",
                                  R"(
[station.parameters]
P600 = 11
P601 = 12
[station.inputs]
DI01 = 1
[[stimulus]]
station = "u"
at = "50ms"
input = "DI01"
pulse = 0
for = "3ms"
[[stimulus]]
station = "u"
at = "100ms"
input = "DI02"
pulse = 1
for = "3ms"
[[stimulus]]
station = "u"
at = "150ms"
input = "DI01"
pulse = 0
for = "3ms"
)");
  plant->run_until(ms(49));
  EXPECT_EQ(value(*plant, "n"), 0);
  plant->run_until(ms(52));
  EXPECT_EQ(value(*plant, "n"), 1);
  EXPECT_EQ(value(*plant, "number"), 26);
  EXPECT_TRUE(plant->has_fault());
  const int32_t before = value(*plant, "a");
  plant->run_until(ms(99));
  EXPECT_GT(value(*plant, "a"), before) << "a fault of the drive does not stop the program";
  plant->run_until(ms(140));
  EXPECT_FALSE(plant->has_fault());
  EXPECT_EQ(value(*plant, "n"), 1);
  plant->run_until(ms(160));
  EXPECT_EQ(value(*plant, "n"), 2);
}

TEST(ProgramFaults, ComeWithTheirPlaceAndEndByAReset) {
  const char* const program = R"(#include <constb.h>
#include <iob.h>
long starts, a, b;
main() {
  starts++;
  while (a < 20) a++;
  b = 7 / (a - 20);
}
)";
  struct Way {
    const char* name;
    const char* plant;
  };
  const Way ways[] = {
      {"input",
       "[station.parameters]\nP600 = 12\n[[stimulus]]\nstation = \"u\"\nat = \"200ms\"\ninput = "
       "\"DI01\"\nset = 1\n"},
      {"P840", "[[stimulus]]\nstation = \"u\"\nat = \"200ms\"\nparameter = \"P840\"\nset = 1\n"},
      {"auto reset", "[station.parameters]\nP841 = 1\nP842 = 3000\n"},
  };
  for (const Way& way : ways) {
    const auto plant = make_station(program, way.plant);
    plant->run_until(ms(150));
    EXPECT_EQ(value(*plant, "starts"), 1);
    EXPECT_EQ(plant->stations()[0]->fault(), 10);
    EXPECT_TRUE(plant->stations()[0]->error());
    EXPECT_TRUE(told(*plant, "F10 in task 1 at P.IPC:7:")) << way.name;
    EXPECT_TRUE(plant->programs_over());
    plant->run_until(ms(3300));
    EXPECT_EQ(value(*plant, "starts"), 2) << way.name << ": from the beginning, variables kept";
    EXPECT_TRUE(told(*plant, "starts anew")) << way.name;
  }
}

TEST(ProgramFaults, AResetByControlWordRestarts) {
  const auto plant =
      make_plant(R"(
[[bus]]
name = "sbus"
kind = "can"
[[station]]
name = "master"
unit = "md60a"
sbus = "sbus"
program = "MASTER.IPC"
[[station]]
name = "u"
unit = "md60a"
sbus = "sbus"
program = "P.IPC"
[station.parameters]
P813 = 1
P101 = 3
)",
                 {{"MASTER.IPC", R"(
#include <const.h>
MOVLNK m; MLDATA d;
main() {
  m.BusType = ML_BT_SBUS; m.Address = 1; m.Format = ML_FT_3; m.DPointer = numof(d);
  d.PO1 = 6; _MoviLink(m);
  _Wait(100);
  d.PO1 = 6 | 64; _MoviLink(m);
}
)"},
                  {"P.IPC", "#include <const.h>\nlong starts, z;\nmain() { starts++; z = 1 / z; }\n"}});
  plant->run_until(ms(90));
  EXPECT_EQ(value(*plant, "starts"), 1);
  plant->run_until(ms(300));
  EXPECT_EQ(value(*plant, "starts"), 2) << "and it fails again";
  EXPECT_EQ(plant->stations()[1]->fault(), 10);
}

TEST(ProgramFaults, InARoutineNameIt) {
  const auto plant = make_station(R"(#include <constb.h>
long z, a;
tick() {
  z = 5 % z;
}
main() { T0_Reload = 10; _SetInterrupt(SI_TIMER0, tick); while (1) a++; }
)");
  plant->run_until(ms(50));
  EXPECT_TRUE(told(*plant, "F10 in task 1 (interrupt TIMER 0) at P.IPC:4:"));
}

TEST(ProgramFaults, TooManyCallsAreF32) {
  const auto plant = make_station("#include <constb.h>\nlong a;\nf() { a++; f(); }\nmain() { f(); }\n");
  plant->run_until(ms(200));
  EXPECT_EQ(plant->stations()[0]->fault(), 32);
  EXPECT_EQ(value(*plant, "a"), 32);
}

TEST(ProgramFaults, WatchdogIsF41AndSwitchesOff) {
  const auto plant = make_station(R"(#include <constb.h>
long a;
main() {
  _WdOn(50);
  while (a < 100) { a++; WdogTimer = 50; }
  while (1) ;
}
)",
                                  "[station.parameters]\nP938 = 2\n");
  // 1 + 100 turns of 3 commands with 3 commands a ms: the last renewal is in the tick at 100 ms.
  plant->run_until(ms(149));
  EXPECT_EQ(plant->stations()[0]->fault(), 0);
  plant->run_until(ms(151));
  EXPECT_EQ(plant->stations()[0]->fault(), 41);
  EXPECT_TRUE(told(*plant, "F41 in task 1 at P.IPC:6:"));
  EXPECT_TRUE(plant->programs_over());
}

TEST(ProgramFaults, WatchdogOutlivesTheProgram) {
  const auto plant = make_station("#include <constb.h>\nmain() {\n  _WdOn(50);\n}\n");
  plant->run_until(ms(49));
  EXPECT_EQ(plant->stations()[0]->fault(), 0);
  plant->run_until(ms(60));
  EXPECT_EQ(plant->stations()[0]->fault(), 41);
  EXPECT_TRUE(told(*plant, "F41 in task 1 at P.IPC:"));
}

// The control word of the program on MOVITRAC 07 (its manual, figure 19).
TEST(ControlWord, OfTheProgramRestrictsTheDrive) {
  PROVES("M07-CW-26");
  const struct {
    const char* word;
    int status;  // high byte of status word 1
  } rows[] = {{"0", 4}, {"1 << 30", 1}, {"1 << 1", 2}, {"1 << 11", 26}};
  for (const auto& row : rows) {
    const auto plant =
        make_station("#include <const.h>\nmain() { _Wait(500); ControlWord = " + std::string(row.word) +
                         "; while (1) ; }\n",
                     "[station.inputs]\nDI01 = 1\nDI03 = 1\n", "mc07");
    plant->run_until(ms(490));
    EXPECT_EQ(plant->stations()[0]->status_word_1() >> 8, 4);
    plant->run_until(ms(510));
    EXPECT_EQ(plant->stations()[0]->status_word_1() >> 8, row.status) << row.word;
  }
}

// The block of a MOVIDRIVE B works by itself: in mode 2 its output is the setpoint (IPOSplus p. 38).
TEST(PidOfAProgram, WorksInEveryMillisecond) {
  const auto plant = make_station(R"(#include <constb.h>
long n;
main() { PID_Mode = 2; while (n < 10) { n++; PID_Command = 100 * n; _Wait(2); } while (1) ; }
)");
  plant->run_until(ms(200));
  EXPECT_EQ(value(*plant, "n"), 10);
  EXPECT_EQ(value(*plant, "IPOS_Setp"), 1'000);
}

// A timer interrupt every 10 ms: 99 times in the ticks up to 999 ms, see docs/inside/cycle.md.
TEST(Timer0, InterruptsEveryReloadMilliseconds) {
  const auto plant = make_station(R"(#include <constb.h>
long n, a;
tick() { n++; }
main() { T0_Reload = 10; _SetInterrupt(SI_TIMER0, tick); while (1) a++; }
)",
                                  "[station.parameters]\nP938 = 3\n");
  plant->run_until(ms(999));
  EXPECT_EQ(value(*plant, "n"), 99);
}

// Bits 8..15 of control word 2 have no function on MOVITRAC 07 and are the program's.
TEST(ProcessData, ControlWord2CarriesDataForTheProgram) {
  PROVES("M07-CW-24");
  const auto plant = make_plant(R"(
[[bus]]
name = "sbus"
kind = "can"
[[station]]
name = "unit1"
unit = "mc07"
sbus = "sbus"
program = "DATA.IPC"
[station.parameters]
P813 = 1
P100 = "SBus"
P101 = "SBus"
P301 = "0 rpm"
P870 = 10
[station.inputs]
DI01 = 1
DI03 = 1
[[control]]
name = "plc"
sbus = "sbus"
[[control.target]]
address = 1
po = [0xA506, 5000, 0]
every = "10ms"
)",
                                {{"DATA.IPC", R"(
#include <const.h>
GSPODATA3 po;
long high;
main() { while (1) { _GetSys(po, GS_PODATA); high = (po.PO1 >> 8) & 255; } }
)"}});
  plant->run_until(ms(3000));
  EXPECT_EQ(value(*plant, "high", "unit1"), 0xA5);
  EXPECT_EQ(value(*plant, "po.PO1", "unit1") & 0xFFFF, 0xA506);
  EXPECT_EQ(plant->stations()[0]->status_word_1(), 0x0407) << "enabled by the low byte";
  EXPECT_EQ(plant->stations()[0]->drive().value("000"), 1'000'000);
}

// MOVLNK to the own unit (address 253) with process data: why they do nothing is told without any frame.
TEST(ProcessData, ToTheOwnUnitTellWhyTheyHaveNoEffect) {
  const auto plant = make_station(R"(
#include <const.h>
MOVLNK m; MLDATA d;
main() {
  m.BusType = ML_BT_SBUS; m.Address = 253; m.Format = ML_FT_3; m.DPointer = numof(d);
  d.PO1 = 6; _MoviLink(m);
  while (1) ;
}
)",
                                  "");
  plant->run_until(ms(20));
  EXPECT_EQ(value(*plant, "m.Result"), 0);
  EXPECT_TRUE(told(*plant, "the control word has no effect: P101"));
}

// A slave copies its PO data to its PI data; the echo goes out in its PI telegram.
TEST(ProcessData, OfTheProgramAreEchoed) {
  PROVES("PD-12");
  const auto plant = make_plant(R"(
[[bus]]
name = "sbus"
kind = "can"
[[station]]
name = "master"
unit = "md60a"
sbus = "sbus"
program = "MASTER.IPC"
[[station]]
name = "slave"
unit = "md60a"
sbus = "sbus"
program = "SLAVE.IPC"
[station.parameters]
P813 = 1
P870 = 12
P871 = 12
P872 = 12
P873 = 9
P874 = 9
P875 = 9
)",
                                {{"MASTER.IPC", R"(
#include <const.h>
MOVLNK m; MLDATA d;
main() {
  m.BusType = ML_BT_SBUS; m.Address = 1; m.Format = ML_FT_3; m.DPointer = numof(d);
  d.PO1 = 4660; d.PO2 = -2; d.PO3 = 1;
  while (1) { _MoviLink(m); _Wait(20); }
}
)"},
                                 {"SLAVE.IPC", R"(
#include <const.h>
GSPODATA3 po; SSPIDATA3 pi;
main() {
  while (1) {
    _GetSys(po, GS_PODATA);
    pi.PI1 = po.PO1; pi.PI2 = po.PO2; pi.PI3 = po.PO3;
    _SetSys(SS_PIDATA, pi);
  }
}
)"}});
  plant->run_until(ms(200));
  EXPECT_EQ(value(*plant, "d.PI1", "master"), 4660);
  EXPECT_EQ(value(*plant, "d.PI2", "master"), -2);
  EXPECT_EQ(value(*plant, "d.PI3", "master"), 1);
  EXPECT_EQ(plant->stations()[1]->drive().state().axis().speed, 0) << "the words have no effect on the drive";
}

// Task 2 is stopped in a MOVLNK that nobody answers; started again it waits for its own time.
TEST(Tasks, StoppedInAnExchangeStartCleanly) {
  const auto plant = make_plant(R"(
[[bus]]
name = "sbus"
kind = "can"
[[station]]
name = "u"
unit = "md60a"
sbus = "sbus"
program = "P.IPC"
)",
                                {{"P.IPC", R"(
#include <const.h>
MOVLNK m; MLDATA d; long runs, ends;
ask() { _MoviLink(m); ends = 99; }
rest() { runs++; _Wait(100); ends++; }
main() {
  m.BusType = ML_BT_SBUS; m.Address = 5; m.Format = ML_FT_PAR3; m.Service = ML_S_RD; m.Index = 8318;
  m.DPointer = numof(d);
  _SetTask2(T2_START, ask);
  _Wait(20);
  _SetTask2(T2_STOP, ask);
  _SetTask2(T2_START, rest);
}
)"}},
                                vm::Rates{{20, 20, 20}});
  plant->run_until(ms(110));  // the exchange has timed out meanwhile
  EXPECT_EQ(value(*plant, "runs"), 1);
  EXPECT_EQ(value(*plant, "ends"), 0);
  plant->run_until(ms(130));
  EXPECT_EQ(value(*plant, "ends"), 1);
}

// After the next power-on the SBus is one of CANopen: nobody of the program finds the port that is gone.
TEST(Power, AnSbusThatBecomesCanopenIsGoneForTheProgram) {
  const auto plant = make_plant(
      "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nbaud = 500000\n"
      "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nsbus = \"sbus\"\nprogram = \"P.IPC\"\n",
      {{"P.IPC", R"(
#include <constb.h>
MOVLNK m; MLDATA d; SCTRCYCL t; long result;
main() {
  m.BusType = ML_BT_SBUS; m.Address = 5; m.Format = ML_FT_PAR3; m.Service = ML_S_RD; m.Index = 8318;
  m.DPointer = numof(d);
  if (H100 == 0) {
    t.ObjectNo = 1100; t.CycleTime = 10; t.Format = 4; t.DPointer = numof(d);
    _SBusCommDef(SCD_TRCYCL, t); _SBusCommOn();
  }
  _MoviLink(m); result = m.Result; while (1) ;
}
)"}},
      vm::Rates{{20, 20, 20}});
  ASSERT_TRUE(plant);
  Station& station = *plant->stations()[0];
  plant->run_until(ms(200));
  EXPECT_EQ(station.sbus(1)->objects().definitions().size(), 1U);
  ParameterStore& parameters = station.drive().parameters();
  ASSERT_TRUE(parameters.execute(ParameterService::Write, parameters.table().find("880")->index, 1));
  ASSERT_TRUE(parameters.execute(ParameterService::Write, 11'100, 1));
  station.power_off();
  plant->run_until(ms(300));
  station.power_on();
  plant->run_until(ms(500));
  EXPECT_EQ(station.sbus(1), nullptr);
  EXPECT_TRUE(told(*plant, "the station is not connected to"));
  EXPECT_NE(value(*plant, "result"), 0);
  station.stop_program();
  plant->run_until(ms(600));
  EXPECT_TRUE(station.program_over());
}

// Of a hand: to start what runs is refused, to begin anew is not.
TEST(ProgramOrders, StartStopAndRestart) {
  const auto plant = make_station("#include <constb.h>\nlong n;\nmain() { while (1) n = n + 1; }\n");
  Station& station = *plant->stations()[0];
  plant->run_until(ms(20));
  EXPECT_GT(value(*plant, "n"), 5);
  EXPECT_EQ(PlantActions::order(station, ProgramOrder::Start), "the program runs already");
  EXPECT_EQ(PlantActions::order(station, ProgramOrder::Stop), std::nullopt);
  EXPECT_TRUE(station.program_over());
  const int32_t stopped = value(*plant, "n");
  plant->run_until(ms(40));
  EXPECT_EQ(value(*plant, "n"), stopped);
  EXPECT_EQ(PlantActions::order(station, ProgramOrder::Start), std::nullopt);
  EXPECT_FALSE(station.program_over());
  plant->run_until(ms(60));
  EXPECT_NE(value(*plant, "n"), stopped);
  EXPECT_EQ(PlantActions::order(station, ProgramOrder::Restart), std::nullopt);
  EXPECT_FALSE(station.program_over());
}

// MOVLNK over X13 (bus type 2), XT (1), SBus 1 (5) and SBus 2 (8) of a unit that was off meanwhile.
TEST(Power, MovlnkGoesOverEveryInterfaceAgain) {
  for (const int type : {1, 2, 5, 8}) {
    const auto plant = make_plant(R"(
[[bus]]
name = "can"
kind = "can"
[[bus]]
name = "can2"
kind = "can"
[[bus]]
name = "rs"
kind = "rs485"
[[bus]]
name = "xt"
kind = "rs485"
[[station]]
name = "u"
unit = "mdxb"
program = "P.IPC"
sbus = "can"
sbus2 = "can2"
rs485 = "rs"
rs485_xt = "xt"
s13 = true
[station.parameters]
P881 = 1
P891 = 1
[[station]]
name = "v"
unit = "mdxb"
sbus = "can"
sbus2 = "can2"
rs485 = "rs"
[station.parameters]
P810 = 5
P881 = 5
P891 = 5
[[station]]
name = "w"
unit = "mc07"
rs485 = "xt"
[station.parameters]
P810 = 5
)",
                                  {{"P.IPC", "#include <constb.h>\nMOVLNK m; MLDATA d; long good;\nmain() {\n"
                                             "  m.BusType = " + std::to_string(type) +
                                                 "; m.Address = 5; m.Format = ML_FT_PAR3; m.Service = ML_S_RD; "
                                                 "m.Index = 8318; m.DPointer = numof(d);\n"
                                                 "  while (1) { _MoviLink(m); if (m.Result == 0) good = good + 1; }\n}\n"}});
    ASSERT_TRUE(plant);
    for (int round = 0; round < 3; ++round) {
      plant->run_until(plant->now() + ms(600));
      EXPECT_GT(value(*plant, "good"), 2) << "bus type " << type << ", round " << round;
      plant->set_power("u", false);
      plant->run_until(plant->now() + ms(100));
      plant->set_power("u", true);
      plant->run_until(plant->now() + ms(1));
      EXPECT_EQ(value(*plant, "good"), 0);
    }
  }
}

}  // namespace
}  // namespace ipos::runtime
