// A station that is silent or does not follow says why, in one line for each cause.
#include <gtest/gtest.h>

#include "runtime/bus_plan/plan.hpp"
#include "runtime/plant_file/serial_plan.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

const std::string kFollows = "P813 = 1\nP100 = 10\nP101 = 3\n";

std::string controlled(const std::string& parameters, const std::string& more = "") {
  return bus_text() + station_text("unit1", parameters) +
         "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n[[control.target]]\naddress = 1\npo = [6, 5000, "
         "0]\nevery = "
         "\"10ms\"\n" +
         more;
}

std::string why(const std::string& plant) {
  PlantRig rig(plant);
  rig.run_until(100 * kMillisecond);
  return rig.journal();
}

TEST(Silence, NothingToSayWhenAllIsSet) { EXPECT_EQ(why(controlled(kFollows)), ""); }

TEST(Silence, EachSettingThatIsMissing) {
  PROVES("SBUS-22");
  EXPECT_EQ(why(controlled("P813 = 1\nP101 = 3\n")),
            "unit1: the setpoints have no effect: P100 Setpoint source is BIPOL./FIX.SETPT, not SBus\n");
  EXPECT_EQ(why(controlled("P813 = 1\nP100 = 10\n")),
            "unit1: the control word has no effect: P101 Control signal source is TERMINALS, not SBus\n");
  EXPECT_EQ(why(controlled(kFollows + "P876 = 0\n")),
            "unit1: PO data have no effect: P876 PO data enable is OFF, not ON\n");
  // P870..P872 without a control word, and without a speed.
  EXPECT_EQ(
      why(controlled(kFollows + "P870 = 0\n")),
      "unit1: no PO word is a control word (P870..P872): the drive is enabled as if the bus had sent it\n");
  for (const auto& [parameters, finding] :
       {std::pair<std::string, std::string>{"P870 = 0\n", "no PO word of unit1 is a control word"},
        {"P871 = 0\n", "no PO word of unit1 is a speed"},
        {"", ""}}) {
    PlantRig rig(controlled(kFollows + parameters));
    std::string found;
    for (const Finding& one : make_plan(rig.get(), {}).findings) found += one.text + "\n";
    EXPECT_EQ(found.empty(), finding.empty()) << found;
    EXPECT_EQ(found.substr(0, finding.size()), finding);
  }
  // P813 missing, so 0.
  EXPECT_EQ(why(controlled("P100 = 10\nP101 = 3\n")),
            ": sbus: plc calls address 1, which no station has; there are 0 (unit1)\n");
  // P871: no word is the speed.
  PlantRig speedless(controlled(kFollows + "P871 = 0\n"));
  speedless.run_until(100 * kMillisecond);
  EXPECT_EQ(speedless.says("unit1: no PO word has the assignment SPEED or SPEED [%] (P870..P872)"), 1U);
  // P816: 250 kbaud on a line of 500.
  EXPECT_NE(why(controlled(kFollows + "P816 = 1\n"))
                .find(": sbus: unit1 takes no part: its baud rate is not that of the "
                      "line (250 kbaud, line 500 kbaud)\n"),
            std::string::npos);
}

// P876 in a plant with a controller: the telegrams are answered and shown, the drive does not follow.
TEST(Silence, PoDataAreNotEnabled) {
  PROVES("PD-05");
  const std::string inputs = "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
  for (const char* unit : {"md60a", "mc07"})
    for (const char* p876 : {"", "P876 = 1\n", "P876 = 0\n"}) {
      const bool on = std::string(p876) != "P876 = 0\n";
      PlantRig rig(
          bus_text() + station_text("unit1", kFollows + "P301 = 0\n" + p876, unit) + inputs +
          "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n[[control.target]]\naddress = 1\npo = [6, 5000, "
          "15000]\nevery = \"10ms\"\n");
      rig.run_until(3 * kSecond);
      const Drive& drive = rig.station(0).drive().state();
      EXPECT_EQ(rig.with(11).size(), 300U);
      EXPECT_GE(rig.with(12).size(), 299U) << "PI to each PO";
      EXPECT_EQ((rig.with(12).back().frame.data[1] & 4) != 0, on) << "status word bit 2";
      auto& parameters = rig.station(0).drive().parameters();
      EXPECT_EQ(parameters.value(8455), 6);
      EXPECT_EQ(parameters.value(8456), 5000);
      EXPECT_EQ(parameters.value(8457), 15000);
      EXPECT_NEAR(drive.axis().speed, on ? 1'000'000 : 0, 3'000) << unit << " " << p876;
      EXPECT_EQ(drive.axis().output_stage, on) << unit << " " << p876;
    }
}

TEST(Silence, WrongBaudRate) {
  PROVES("DIAG-03", "M07-SBUS-09");
  const std::string call =
      "#include <const.h>\nMOVLNK Ml; MLDATA Mld; long n;\nmain() { Ml.BusType = 5; Ml.Address = 1; "
      "Ml.Format = 6; "
      "Ml.Service = 1; Ml.Index = 8318; Ml.DPointer = numof(Mld); _MoviLink(Ml); n = 1; while (1) {} }\n";
  for (const char* unit : {"md60a", "mc07"}) {
    PlantRig rig(bus_text() + station_text("master", "P813 = 0\n", unit, "A.IPC") +
                     station_text("slave", "P813 = 1\nP816 = 1\n", unit),
                 {{"A.IPC", call}});
    rig.run_until(200 * kMillisecond);
    EXPECT_EQ(rig.variable(0, "Ml.Result"), 0x06020000);
    EXPECT_EQ(rig.variable(0, "n"), 1);
    EXPECT_EQ(
        rig.says("slave takes no part: its baud rate is not that of the line (250 kbaud, line 500 kbaud)"),
        1U);
    EXPECT_TRUE(rig.frames.empty());
  }
}

TEST(Silence, DoubleAddress) {
  const std::string plant = bus_text() + station_text("a", "P813 = 1\n") + station_text("b", "P813 = 1\n");
  EXPECT_EQ(why(plant),
            ": sbus: a and b both have SBus address 1: both answer to it, and their answers collide\n");
}

TEST(Silence, CutCable) {
  PlantRig rig(controlled(kFollows, fault_text("cut", "station = \"unit1\"\nfrom = \"50ms\"\n")));
  rig.run_until(100 * kMillisecond);
  EXPECT_EQ(rig.says("sbus: planted fault 'cut': unit1 is cut"), 1U);
  EXPECT_EQ(rig.says("sbus: unit1 takes no part: it is not connected to the line"), 1U);
  EXPECT_EQ(rig.says("sbus: plc gets no acknowledge: no other station on the line"), 1U);
  EXPECT_LT(rig.with(12).back().end, 50 * kMillisecond);
}

TEST(Silence, SwappedWires) {
  PROVES("DIAG-02");
  PlantRig rig(
      controlled(kFollows, station_text("unit2", "P813 = 2\n") +
                               "[[control]]\nname = \"plc2\"\nsbus = \"sbus\"\n[[control.target]]\naddress = "
                               "2\nevery = \"10ms\"\n" +
                               fault_text("swap", "station = \"unit2\"\n")));
  rig.run_until(100 * kMillisecond);
  EXPECT_EQ(rig.says("sbus: planted fault 'swap': unit2 has high and low interchanged"), 1U);
  EXPECT_EQ(rig.with(12).size(), 10U);  // the others go on
  EXPECT_TRUE(rig.with(20).empty());
}

// The symptoms of 1053 1610 p. 64 and MOVITRAC 07 chapter 7.1 in a run. What disturbs a line, on one that works without it:
// a control with ten telegrams in 100 ms.
struct Disturbed {
  size_t answers;
  size_t told;  // of the disturbance
};
Disturbed disturbed(const std::string& bus, const std::string& first, const std::string& last, const std::string& cause) {
  PlantRig rig(bus_text(500'000, bus) +
               "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n" + first +
               "[[control.target]]\naddress = 1\npo = [6, 5000, 0]\nevery = \"10ms\"\n" +
               station_text("unit1", kFollows, "md60a", "", last));
  rig.run_until(100 * kMillisecond);
  return {rig.with(12).size(), rig.says("sbus: " + cause)};
}

TEST(Silence, ALineThatIsTooLong) {
  PROVES("DIAG-05", "M07-SBUS-24");
  const auto of = [](const std::string& metres, uint32_t share) {
    return disturbed("length = " + metres + "\n", "", "",
                     share == 0 ? "the line is longer"
                                : "the line is longer than 80 m: " + std::to_string(share) + " of 1000 frames are disturbed");
  };
  EXPECT_EQ(of("80", 0).answers, 10U);
  EXPECT_EQ(of("80", 0).told, 0U);
  // (length - 80) / 80, rounded down: between good and dead a choice of ours.
  EXPECT_EQ(of("81", 12).told, 1U);
  EXPECT_EQ(of("100", 250).told, 1U);
  for (const char* dead : {"160", "300"}) {
    EXPECT_EQ(of(dead, 1000).told, 1U) << dead;
    EXPECT_EQ(of(dead, 1000).answers, 0U) << dead;
  }
}

TEST(Silence, TerminatingResistorsThatAreMissing) {
  PROVES("DIAG-05", "M07-SBUS-24");
  const std::string on = "terminator = true\n", off = "terminator = false\n";
  EXPECT_EQ(disturbed("", on, on, "").answers, 10U);
  EXPECT_EQ(disturbed("", on, on, "a terminating resistor").told, 0U);
  EXPECT_EQ(disturbed("", on, off, "a terminating resistor is not where it must be: 500 of 1000").told, 1U);
  const Disturbed none = disturbed("", off, off, "2 terminating resistors are not where they must be: 1000 of 1000");
  EXPECT_EQ(none.told, 1U);
  EXPECT_EQ(none.answers, 0U);
}

// The unit at another rate destroys what the control sends to the other one until it is error passive, and the journal says
// why. How many frames that takes is in strangers_test.cpp.
TEST(Silence, AnotherRateDisturbsTheOthers) {
  PROVES("DIAG-03", "M07-SBUS-09", "M07-SBUS-24");
  PlantRig rig(controlled(kFollows, station_text("unit2", "P813 = 2\nP816 = 1\n")));
  rig.run_until(200 * kMillisecond);
  EXPECT_EQ(rig.says("sbus: unit2 destroys the frames of all with its error flags: it hears them at another rate"), 1U);
  EXPECT_EQ(rig.says("sbus: unit2 is error passive"), 1U);
  EXPECT_FALSE(rig.with(12).empty()) << "an error-passive station disturbs nobody by hearing (ISO 11898-1)";
}

// A moment: the rate is another one for a while.
TEST(Silence, AnotherRateForAWhile) {
  PlantRig rig(controlled(kFollows, fault_text("baud", "station = \"unit1\"\nbaud = 250000\nfrom = \"50ms\"\nuntil = \"100ms\"\n")));
  rig.run_until(300 * kMillisecond);
  EXPECT_EQ(rig.says("sbus: planted fault 'baud': unit1 has another baud rate (250 kbaud, line 500 kbaud)"), 1U);
  for (const FrameRecord& answer : rig.with(12))
    EXPECT_TRUE(answer.end < 50 * kMillisecond || answer.start > 100 * kMillisecond);
  EXPECT_GT(rig.with(12).back().end, 280 * kMillisecond);
}

TEST(Silence, WrongAddress) {
  PROVES("DIAG-06");
  const std::string call =
      "#include <const.h>\nMOVLNK Ml; MLDATA Mld;\nmain() { Ml.BusType = 5; Ml.Address = 2; Ml.Format = 6; "
      "Ml.Service = 1; Ml.Index = 8318; Ml.DPointer = numof(Mld); _MoviLink(Ml); while (1) {} }\n";
  PlantRig rig(bus_text() + station_text("master", "P813 = 0\n", "md60a", "A.IPC") +
                   station_text("slave", "P813 = 3\n"),
               {{"A.IPC", call}});
  rig.run_until(200 * kMillisecond);
  EXPECT_EQ(rig.variable(0, "Ml.Result"), 0x06020000);
  EXPECT_EQ(rig.says("sbus: master calls address 2, which no station has; there are 0 (master), 3 (slave)"),
            1U);
}

// Settings that are not simulated: the journal of the unit, and the plan where they are a matter of the bus.
TEST(Silence, SettingsThatAreNotSimulated) {
  const std::string settings = kFollows + "P138 = 1\nP871 = 7\nP872 = 1\n";
  EXPECT_EQ(
      why(controlled(settings)),
      "unit1: P871 Setpoint description PO2 is SLIP: the shaft has no slip: P094..P096 show the word only\n"
      "unit1: P138 Ramp limit is YES: the ramps are not limited\n");
  PlantRig rig(controlled(settings));
  std::string found;
  for (const Finding& one : make_plan(rig.get(), {}).findings)
    if (one.kind == FindingKind::NotSimulated) found += one.line + ": " + one.text + "\n";
  EXPECT_EQ(
      found,
      "sbus: unit1: P871 Setpoint description PO2 is SLIP: the shaft has no slip: P094..P096 show the word "
      "only\n");
  // A write over the bus tells it, too, once.
  PlantRig written(bus_text() + station_text("unit1", kFollows));
  written.run_until(10 * kMillisecond);
  for (int n = 0; n < 2; ++n) {
    ASSERT_TRUE(written.station(0).drive().serve(written.get().now(), {Service::Write, 8794, 0, 1}));
    for (const std::string& text : written.station(0).drive().take_obstacles())
      EXPECT_EQ(text, "P138 Ramp limit is YES: the ramps are not limited") << n;
  }
}

// MOVLNK over a bus the unit cannot have, has without a connection, or has and we do not simulate.
TEST(Silence, BusTypesOfMovlnk) {
  for (const stdlib::UnitType& unit : stdlib::unit_types()) {
    if (unit.tasks == 0) continue;
    const SerialInterfaces serial = serial_interfaces(unit);
    const bool newer = unit.family == stdlib::Family::MovidriveB;
    const bool older_small = unit.family == stdlib::Family::Movitrac07;
    for (int type = 0; type <= 9; ++type) {
      PlantRig rig(bus_text() + station_text("u", "", std::string(unit.name), "A.IPC"),
                   {{"A.IPC", "#include <const.h>\nMOVLNK Ml; MLDATA Mld;\nmain() { Ml.BusType = " +
                                  std::to_string(type) +
                                  "; Ml.Address = 1; Ml.Format = 6; Ml.Service = 1; Ml.Index = 8318; "
                                  "Ml.DPointer = numof(Mld); _MoviLink(Ml); while (1) {} }\n"}});
      rig.run_until(200 * kMillisecond);
      std::string reason = "bus type " + std::to_string(type) + " is none of ";
      if ((type == 1 && serial.xt) || (type == 2 && serial.x13) || (type == 8 && newer))
        reason = "the station is not connected to ";
      if (type == 5) reason = "MOVLNK to address 1: no answer";
      if (type == 3 && newer)
        reason = "bus type 3 is the fieldbus, whose card is a slave: it only answers its master";
      if (type == 6 && older_small) reason = "MOVLNK to address 1: no answer";  // CANopen nodes
      EXPECT_EQ(rig.says(reason), 1U) << unit.name << " " << type << "\n" << rig.journal();
      EXPECT_EQ(rig.variable(0, "Ml.Result"), reason.starts_with("bus type") ? 0x05050000 : 0x06020000)
          << unit.name << " " << type;
    }
  }
}

// A subindex needs a unit that has some.
TEST(Silence, SubindexOfMovlnk) {
  for (const char* unit : {"md60a", "compact", "mc07", "mdxb"})
    for (const int address : {1, 253}) {
      PlantRig rig(bus_text() + station_text("u", "", unit, "A.IPC") + station_text("v", "P813 = 1\n"),
                   {{"A.IPC",
                     "#include <const.h>\nMOVLNK Ml; MLDATA Mld;\nmain() { Ml.BusType = 5; "
                     "Ml.Address = " +
                         std::to_string(address) +
                         "; Ml.Format = 6; Ml.Service = 1; Ml.Index = 65536 + 8318; Ml.DPointer = "
                         "numof(Mld); _MoviLink(Ml); while (1) {} }\n"}});
      rig.run_until(100 * kMillisecond);
      const bool subindices = std::string_view(unit) == "mdxb";
      EXPECT_EQ(rig.variable(0, "Ml.Result"), subindices ? 0 : 0x05050000) << unit;
      EXPECT_EQ(rig.says("has no subindices, so Index 73854 cannot be sent"), subindices ? 0U : 1U) << unit;
      EXPECT_EQ(rig.with(523).size(), subindices && address == 1 ? 1U : 0U) << unit;
      EXPECT_EQ(rig.says("v: byte 1 of the parameter channel is reserved"), rig.with(523).size());
    }
}

TEST(Silence, CanopenProtocol) {
  PlantRig rig(bus_text() + station_text("u", "P880 = 1\nP886 = 9\n", "mdxb"));
  rig.run_until(10 * kMillisecond);
  ASSERT_NE(rig.station(0).canopen(1), nullptr);  // not silent, but a node
  EXPECT_EQ(rig.station(0).canopen(1)->canopen()->dictionary().node(), 9);
}

}  // namespace
}  // namespace ipos::tests
