// Status words, process data, faults and display values of a drive that stands.
#include "runtime/drive/drive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

#include "tests/harness/proves.hpp"
#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::runtime {
namespace {

using Words = Drive::Words;
constexpr auto kWrite = ParameterService::Write;

struct Unit {
  explicit Unit(std::string_view name) : parameters(tests::unit(name)), state(parameters) {}
  void set(uint16_t index, int32_t value) { EXPECT_TRUE(parameters.preset(index, value)) << index; }
  void po(const Words& words) { state.take_po(PoSource::Sbus, words); }
  void run_ms(int ms) {
    for (int i = 0; i < ms; ++i) state.tick();
  }
  ParameterStore parameters;
  Drive state;
};

// Figure 33 of 1053 1610: PI1 = 514 with factory settings and DI00 = 1.
TEST(Drive, FactoryStateIsFigure33) {
  Unit unit("md60a");
  unit.state.set_inputs(1);
  EXPECT_EQ(unit.state.status_word_1(), 0x0202);
  EXPECT_EQ(unit.state.pi(), (Words{514, 0, 0}));
  EXPECT_EQ(unit.state.condition(), UnitCondition::NoEnable);
}

TEST(Drive, OpenInhibitTerminal) {
  Unit unit("md60a");
  EXPECT_EQ(unit.state.status_word_1(), 0x0102);
  EXPECT_TRUE(unit.parameters.execute(kWrite, 8461, 10));  // R parameter under inhibit
  unit.state.set_inputs(1);
  EXPECT_FALSE(unit.parameters.execute(kWrite, 8461, 0));
  EXPECT_EQ(unit.parameters.value(8461), 10);
}

TEST(Drive, StatusIndexIsStatusWord) {
  PROVES("PAR-28", "M07-SW-12");
  for (const char* name : {"md60a", "mc07"}) {
    Unit unit(name);
    for (const uint16_t inputs : std::initializer_list<uint16_t>{0, 1, 0xFFFF})
      for (const uint8_t fault : std::initializer_list<uint8_t>{0, 47}) {
        unit.state.set_inputs(inputs);
        fault ? unit.state.raise_fault(fault) : unit.state.reset_fault();
        EXPECT_EQ(unit.parameters.value(8310) & 0xFFFF, unit.state.pi()[0]) << name;
      }
  }
}

TEST(Drive, InputImage) {
  Unit unit("md60a");
  unit.state.set_inputs(0b101);
  EXPECT_EQ(unit.parameters.value(8334), 5);
  unit.state.set_inputs(0x8100);
  EXPECT_EQ(unit.parameters.value(8334), 0);
  EXPECT_EQ(unit.parameters.value(8348), 0x81);
  Unit m07("mc07");
  m07.state.set_inputs(0b1001);
  EXPECT_EQ(m07.parameters.value(8334), 8);  // DI03; there is no DI00
}

TEST(Drive, ProcessDataEnabled) {
  PROVES("M07-SW-03");
  for (const int32_t p876 : {0, 1})
    for (const auto& [p100, p101] : {std::pair{1, 0}, {10, 0}, {1, 3}, {2, 1}, {10, 3}}) {
      Unit unit("mc07");
      unit.set(8622, p876);
      unit.set(8461, p100);
      unit.set(8462, p101);
      const bool want = p876 == 1 && (p100 != 1 || p101 != 0);
      EXPECT_EQ((unit.state.status_word_1() & 4) != 0, want) << p876 << " " << p100 << " " << p101;
    }
}

TEST(Drive, ProcessDataAreShown) {
  for (const char* name : {"md60a", "mc07"}) {
    Unit unit(name);
    unit.state.set_inputs(1);
    unit.set(8622, 0);  // even when they are not taken over
    unit.po({0x0006, 0x1388, 0x3A98});
    EXPECT_EQ(unit.parameters.value(8455), 6);
    EXPECT_EQ(unit.parameters.value(8456), 5000);
    EXPECT_EQ(unit.parameters.value(8457), 15000);
    EXPECT_EQ(unit.parameters.value(8458), 514);
    EXPECT_EQ(unit.parameters.value(8459), 0);
    for (uint16_t index = 8455; index <= 8460; ++index)
      EXPECT_EQ(unit.parameters.execute(kWrite, index, 1).error(), stdlib::return_codes::kReadOnly);
    // A telegram with fewer words leaves the others.
    const uint16_t one[] = {7};
    unit.state.take_po(PoSource::Rs485, one);
    EXPECT_EQ(unit.state.po(), (Words{7, 5000, 15000}));
  }
}

TEST(Drive, PiAssignments) {
  PROVES("M07-PD-17");
  for (const char* name : {"md60a", "mc07"}) {
    Unit unit(name);
    unit.state.set_inputs(1);
    unit.state.set_ipos_pi({11, 22, 33});
    for (const auto& [assignment, want] :
         {std::pair{0, 0}, {1, 0}, {2, 0}, {3, 0}, {6, 0x0202}, {8, 0}, {9, 33}, {10, 0}}) {
      unit.set(8309, assignment);
      EXPECT_EQ(unit.state.pi()[2], want) << name << " " << assignment;
    }
    // P872 = NO FUNCTION: whatever PO3 holds, even the pattern of an inhibit, changes nothing.
    unit.set(8462, 3);
    unit.po({0x0006, 0, 0});
    const uint16_t before = unit.state.status_word_1();
    for (const uint16_t word : std::initializer_list<uint16_t>{0x0001, 0x0040, 0xFFFF}) {
      unit.po({0x0006, 0, word});
      EXPECT_EQ(unit.state.status_word_1(), before) << name;
    }
  }
  Unit unit("md60a");
  unit.state.set_inputs(1);
  unit.set(8309, 7);
  EXPECT_EQ(unit.state.pi()[2] & 0xFF, 0x02) << "the low byte of every status word is the same block";
}

TEST(Drive, ControlWordInhibit) {
  Unit unit("md60a");
  unit.state.set_inputs(1);
  unit.po({0x0001, 0, 0});
  EXPECT_EQ(unit.state.status_word_1(), 0x0202) << "P101 = TERMINALS";
  unit.set(8462, 3);
  unit.po({0x0001, 0, 0});
  EXPECT_EQ(unit.state.status_word_1(), 0x0106);
  EXPECT_TRUE(unit.parameters.execute(kWrite, 8461, 10)) << "inhibit by bus counts for R parameters";
  unit.po({0x0006, 0, 0});
  EXPECT_EQ(unit.state.status_word_1(), 0x0206);
  const uint16_t inhibit[] = {1};
  unit.state.take_po(PoSource::Rs485, inhibit);
  EXPECT_EQ(unit.state.status_word_1(), 0x0206) << "not the source of P101";
  unit.po({0x0001, 0, 0});
  unit.set(8622, 0);
  EXPECT_EQ(unit.state.status_word_1(), 0x0202) << "P876 = OFF";
}

TEST(Drive, FaultAndReset) {
  PROVES("M07-CW-05", "M07-SW-08");
  Unit unit("mc07");
  unit.set(8462, 3);
  unit.po({0x0046, 0, 0});  // bit 6 = 1 from before the fault
  unit.state.raise_fault(1);
  EXPECT_EQ(unit.state.status_word_1(), 0x0124);  // overcurrent, not ready, PO data enabled
  unit.po({0x0046, 0, 0});
  EXPECT_EQ(unit.state.fault(), 1);
  unit.po({0x0006, 0, 0});
  EXPECT_EQ(unit.state.fault(), 1);
  unit.po({0x0046, 0, 0});
  EXPECT_EQ(unit.state.fault(), 0);
  EXPECT_EQ(unit.state.status_word_1(), 0x0206);
  unit.state.raise_fault(1);
  unit.state.raise_fault(47);
  EXPECT_EQ(unit.state.fault(), 1) << "the first fault stays shown";
  EXPECT_TRUE(unit.parameters.execute(kWrite, 8617, 1));  // P840
  EXPECT_EQ(unit.state.fault(), 0);
  EXPECT_EQ(unit.parameters.value(8617), 0);
}

TEST(Drive, ErrorMemory) {
  Unit unit("md60a");
  unit.state.set_inputs(0x0203);  // DI00, DI01, DI11
  unit.parameters.set_display(8328, 540);
  unit.state.raise_fault(26);
  unit.state.reset_fault();
  unit.state.set_inputs(0);
  unit.parameters.set_display(8328, 560);
  unit.state.raise_fault(11);
  const auto at = [&](int index) { return unit.parameters.value(static_cast<uint16_t>(index)); };
  EXPECT_EQ(at(8366), 11);
  EXPECT_EQ(at(8367), 26);
  EXPECT_EQ(at(8368), 0);
  EXPECT_EQ(at(8371), 0);
  EXPECT_EQ(at(8372), 3);
  EXPECT_EQ(at(8377), 2);
  EXPECT_EQ(at(8392) & 0xFF00, 26 << 8);
  EXPECT_EQ(at(8426), 560);
  EXPECT_EQ(at(8427), 540);
  for (int index = 8411; index <= 8414; ++index)
    EXPECT_TRUE(unit.parameters.execute(ParameterService::Read, static_cast<uint16_t>(index)));
  EXPECT_EQ(unit.parameters.execute(ParameterService::Read, 8415).error(),
            stdlib::return_codes::kNotImplemented);
  // Five entries; the sixth fault drops the oldest.
  for (uint8_t fault = 1; fault <= 4; ++fault) {
    unit.state.reset_fault();
    unit.state.raise_fault(fault);
  }
  EXPECT_EQ(at(8370), 11);
  unit.parameters.power_cycle();
  EXPECT_EQ(at(8366), 4) << "the error memory survives power-off";
  EXPECT_TRUE(unit.parameters.execute(kWrite, 8596, 1));  // P804
  for (int index = 8366; index <= 8450; ++index) EXPECT_EQ(at(index), 0) << index;
}

// Every field of p. 69-71 against the display of the same quantity at the moment of the fault: the drive runs
// in its first parameter set, then in the second one.
TEST(Drive, ErrorMemoryHoldsAllValuesOfTheMoment) {
  PROVES("PAR-40");
  tests::DriveRig rig("md60a", {}, MachineData{});
  rig.set("P601", 7);  // DI02 = PAR. SWITCHOVER
  rig.set("P620", 2);  // DO01 and DO10 = READY
  rig.set("P630", 2);
  rig.bus_control();
  rig.input("DI11", true);
  rig.po({6, 5000, 0});
  rig.run_ms(60'000);  // the motor warms up
  // Index of the field t-0 and the display with the same quantity: P036, P048, P053, P068, P010, P014, P000,
  // P004, P005, P008, P015, P016, P006, P007.
  const std::pair<uint16_t, uint16_t> fields[] = {
      {8371, 8334}, {8376, 8348}, {8381, 8349}, {8386, 8360}, {8391, 8310}, {8396, 8327}, {8401, 8318},
      {8406, 8321}, {8411, 8322}, {8421, 8325}, {8426, 8328}, {8431, 8329}, {8441, 8323}, {8446, 8324}};
  struct Moment {
    std::map<uint16_t, int32_t> shown;  // by field
    int32_t utilization = 0;
  };
  const auto fault = [&](uint8_t number, int32_t minutes) {
    rig.parameters.set_display(8328, minutes);
    rig.parameters.set_display(8329, minutes - 7);
    Moment moment;
    for (const auto& [field, display] : fields) moment.shown[field] = rig.parameters.value(display);
    moment.utilization = rig.drive.axis().utilization;
    rig.drive.raise_fault(number);
    // The status of the moment has the fault: its number in the high byte, bit 5.
    moment.shown[8391] = rig.parameters.value(8310);
    EXPECT_EQ(moment.shown[8391] >> 8, number);
    EXPECT_NE(moment.shown[8391] & 0x20, 0);
    return moment;
  };
  const Moment first = fault(26, 540);
  rig.run_ms(5000);
  rig.drive.reset_fault();
  rig.input("DI00", false);
  rig.run_ms(100);
  rig.input("DI02", true);  // the sets change over without enable
  rig.run_ms(100);
  rig.input("DI00", true);
  rig.input("DI11", false);
  rig.input("DI12", true);
  rig.po({6, 2500, 0});
  rig.run_ms(60'000);
  const Moment second = fault(11, 560);
  const auto at = [&](int index) { return rig.parameters.value(static_cast<uint16_t>(index)); };
  EXPECT_EQ(at(8366), 11);
  EXPECT_EQ(at(8367), 26);
  for (const auto& [field, display] : fields) {
    EXPECT_EQ(at(field), second.shown.at(field)) << field;
    EXPECT_EQ(at(field + 1), first.shown.at(field)) << field + 1;
    EXPECT_EQ(at(field + 2), 0) << field + 2;
    EXPECT_NE(at(field) | at(field + 1), 0) << field << " shows nothing";
  }
  EXPECT_EQ(at(8416), second.utilization);
  EXPECT_EQ(at(8417), first.utilization);
  EXPECT_NE(at(8416), 0);
  EXPECT_NE(at(8441), at(8442)) << "motor 1 runs in the first set only";
  // 8415 is in the pattern, but the manual gives no such index.
  for (int index = 8411; index <= 8414; ++index)
    EXPECT_TRUE(rig.parameters.execute(ParameterService::Read, static_cast<uint16_t>(index)));
  EXPECT_EQ(rig.parameters.execute(ParameterService::Read, 8415).error().packed(), 0x08000011U);
}

TEST(Drive, FactorySettingTakesItsTime) {
  PROVES("M07-SW-02");
  for (const auto& [name, running] : {std::pair{"md60a", 0x0800}, {"mc07", 0x0500}}) {
    Unit unit(name);
    unit.set(8600, 5);
    EXPECT_TRUE(unit.parameters.execute(kWrite, 8594, 1));
    unit.run_ms(1);
    EXPECT_EQ(unit.state.status_word_1(), running) << name;
    unit.run_ms(5000);
    EXPECT_NE(unit.state.status_word_1() & 2, 0) << name;
    EXPECT_EQ(unit.parameters.value(8600), 0);
    unit.state.raise_fault(47);
    EXPECT_EQ(unit.state.status_word_1() & 2, 0) << name;
    unit.state.reset_fault();
    EXPECT_NE(unit.state.status_word_1() & 2, 0) << name;
  }
}

// 2 s (docs/inside/drive.md), and the same again the next time.
TEST(Drive, FactorySettingTakesTwoSeconds) {
  for (const char* name : {"md60a", "mc07", "mdxb"}) {
    Unit unit(name);
    for (int times = 0; times < 2; ++times) {
      unit.run_ms(700);
      EXPECT_TRUE(unit.parameters.execute(kWrite, 8594, 1));
      int ms = 0;
      for (; ms < 5000 && unit.state.condition() == UnitCondition::FactorySetting; ++ms) unit.run_ms(1);
      EXPECT_EQ(ms, 2000) << name;
    }
  }
}

TEST(Drive, OperatingHours) {
  PROVES("PAR-25");
  Unit unit("md60a");
  unit.run_ms(2 * 3600 * 1000);
  EXPECT_EQ(unit.parameters.value(8328), 120);
  EXPECT_EQ(stdlib::parameter_text(*unit.parameters.table().find("P015"), 120), "2.000 h");
  EXPECT_EQ(stdlib::parameter_text(*unit.parameters.table().find("P017"), 36), "1.000 kWh");
}

// A digit of P017 is 1/36 kWh, 100 000 Ws: it counts in the millisecond behind the one in which it is full. With a light
// load no Ws is left out on the way.
TEST(Drive, EnergyCountsWholeDigits) {
  MachineData machine = tests::light_machine();
  machine.load_torque = 20'000;
  machine.rated_power = 3'000;
  tests::DriveRig rig("md60a", {}, machine);
  rig.enable_terminals();
  rig.ai1(10'000);
  const uint16_t shown = rig.index("P017");
  int64_t drawn = 0;
  int digits = 0, most = 0;
  for (int ms = 0; digits < 2 && ms < 1'000'000; ++ms) {
    rig.run_ms(1);
    ASSERT_EQ(rig.parameters.value(shown), drawn / 100'000) << drawn << " Ws";
    const int64_t before = std::exchange(drawn, rig.drive.axis().energy);
    most = std::max(most, static_cast<int>(drawn - before));
    digits += drawn / 100'000 != before / 100'000;
  }
  EXPECT_EQ(digits, 2);
  EXPECT_EQ(most, 1);
}

// Positioning is for the modes of P700 with IPOS (1053 1610 p. 80) and the first set of parameters.
TEST(Drive, PositionsInModesWithIpos) {
  for (const char* name : {"md60a", "mdxb", "mc07"}) {
    tests::DriveRig rig(name);
    const auto& modes = rig.parameters.table().find("P700")->texts;
    ASSERT_FALSE(modes.empty());
    bool positions = false;
    for (const auto& mode : modes) {
      if (!rig.parameters.preset(rig.index("P700"), mode.value)) continue;
      const bool wanted = mode.text.find("IPOS") != std::string_view::npos;
      EXPECT_EQ(rig.drive.can_position(), wanted) << name << ": " << mode.text;
      if (!wanted) continue;
      positions = true;
      rig.set("P600", 7);  // DI01: switches to the second set
      rig.input("DI01", true);
      rig.run_ms(2);
      EXPECT_FALSE(rig.drive.can_position()) << name << ": " << mode.text;
      rig.input("DI01", false);
      rig.run_ms(2);
      EXPECT_TRUE(rig.drive.can_position());
    }
    EXPECT_EQ(positions, name != std::string_view("mc07"));
  }
}

#ifndef IPOS_DRIVE_IN_A_PLANT  // where a station is switched off and on by its power, not by this call
// Behind a power cycle a drive is as one that is new, whatever it was: latches, edges, potentiometer, controller, faults,
// resets that are made by itself, words of the bus and of the program. Only its counters and its error memory go on.
TEST(Drive, PowerOnIsANewDrive) {
  for (const char* name : {"md60a", "mc07", "mdxb"})
    for (int life = 0; life < 12; ++life) {
      SCOPED_TRACE(testing::Message() << name << ", life " << life);
      const bool m07 = name == std::string_view("mc07");
      tests::DriveRig used(name), fresh(name);
      for (tests::DriveRig* rig : {&used, &fresh}) {
        constexpr int32_t kSources[] = {4, 10, 1};  // motor potentiometer, SBus, unipolar
        rig->set("P100", kSources[life % 3]);
        rig->set("P101", life % 3 == 1 ? 3 : m07 && life % 2 == 0 ? 4 : 0);
        rig->set("P602", 9);   // DI03: motor potentiometer up
        rig->set("P603", 12);  // DI04: reset
        // AUTO RESET, PI controller, stop function and filter, where the unit has them.
        for (const auto& [number, value] : {std::pair{"P841", life % 4 == 3 ? 1 : 0},
                                            {"P250", life % 4 == 1 ? 1 : 0},
                                            {"P720", 1},
                                            {"P251", 5},
                                            {"P252", 20},
                                            {"P115", 20'000}})
          if (rig->parameters.table().find(number) != nullptr) rig->set(number, value);
      }
      // A life with everything that can be left behind.
      for (const char* input : {"DI00", "DI01", "DI03", "DI04"}) used.input(input, true);
      used.ai1(6'000);
      used.run_ms(50);
      used.po({0x46, 3000, 7});
      used.drive.set_ipos_pi({1, 2, 3});
      used.drive.set_ipos_outputs(0xFFFF);
      used.drive.set_ipos_control_word(1U << (life % 5));
      used.run_ms(400);
      used.drive.set_fault_response(39, FaultResponse::Display);
      used.drive.raise_fault(life % 2 == 0 ? 39 : 47);
      used.run_ms(30);
      used.drive.set_position(12'345);
      used.silence();
      // The power is cut in a fault and comes back with open terminals, or while it runs and is enabled all the time.
      if (life % 2 == 0) {
        for (const char* input : {"DI00", "DI01", "DI03"}) used.input(input, false);
      } else {
        used.drive.reset_fault();
        used.ai1(1'000);
        used.potentiometer(900);
        used.run_ms(60);
      }
      used.input("DI04", life % 2 == 0);
      used.drive.set_analog({});
      used.parameters.power_cycle();
      used.drive.power_cycle();
      fresh.drive.set_inputs(used.drive.inputs());

      const auto compare = [&](int ms) {
        ASSERT_EQ(used.status(), fresh.status()) << ms;
        ASSERT_EQ(used.drive.fault(), fresh.drive.fault()) << ms;
        ASSERT_EQ(used.drive.setpoint().speed, fresh.drive.setpoint().speed) << ms;
        ASSERT_EQ(used.drive.verdict().reason, fresh.drive.verdict().reason) << ms;
        ASSERT_EQ(used.drive.pi(), fresh.drive.pi()) << ms;
        ASSERT_EQ(used.drive.po(), fresh.drive.po()) << ms;
        ASSERT_EQ(used.drive.outputs(), fresh.drive.outputs()) << ms;
        ASSERT_EQ(used.drive.axis() == fresh.drive.axis(), true) << ms;
        ASSERT_EQ(used.drive.display(), fresh.drive.display()) << ms;
      };
      const uint32_t resets = used.drive.resets() - fresh.drive.resets();
      for (int ms = 0; ms < 400; ++ms) {
        for (tests::DriveRig* rig : {&used, &fresh}) {
          if (ms == 5) rig->drive.raise_fault(39);
          if (ms == 40) rig->drive.reset_fault();
          if (ms == 50) rig->drive.set_inputs(0b1011);
          if (ms == 60) rig->ai1(4'000);
          if (ms == 80) rig->drive.take_po(PoSource::Sbus, Words{0x46, 2000, 0});
          if (ms == 200) rig->drive.raise_fault(47);
          if (ms == 210) rig->drive.take_po(PoSource::Sbus, Words{0x06, 2000, 0});
          if (ms == 220) rig->drive.take_po(PoSource::Sbus, Words{0x46, 2000, 0});
          if (ms == 240) rig->drive.set_inputs(0b11011);
          rig->run_ms(1);
        }
        compare(ms);
        ASSERT_EQ(used.drive.resets() - fresh.drive.resets(), resets) << ms;
        if (HasFatalFailure()) return;
      }
    }
}
#endif

TEST(Drive, LimitSwitches) {
  Unit unit("md60a");
  unit.set(8337, 14);  // DI03 = /LIM. SWITCH CW
  unit.set(8347, 15);  // DI17 = /LIM. SWITCH CCW
  unit.state.set_inputs(1);
  EXPECT_EQ(unit.state.status_word_1(), 0x02C2);
  unit.state.set_inputs(1 | 1 << 3);
  EXPECT_EQ(unit.state.status_word_1(), 0x0282);
  unit.state.set_inputs(1 | 1 << 3 | 1 << 15);
  EXPECT_EQ(unit.state.status_word_1(), 0x0202);
}

TEST(Drive, ReservedBitsOfMovitrac07) {
  PROVES("M07-SW-05");
  Unit unit("mc07");
  for (const uint16_t inputs : std::initializer_list<uint16_t>{0, 0x3E})
    for (const uint8_t fault : std::initializer_list<uint8_t>{0, 47})
      for (const uint16_t word : std::initializer_list<uint16_t>{0x0000, 0x0001, 0x0006, 0xFFFF}) {
        unit.set(8462, 3);
        unit.state.set_inputs(inputs);
        unit.po({word, word, word});
        unit.state.reset_fault();
        if (fault) unit.state.raise_fault(fault);
        EXPECT_EQ(unit.state.status_word_1() & 0b1101'1000, 0) << inputs << fault << word;
      }
}

}  // namespace
}  // namespace ipos::runtime
