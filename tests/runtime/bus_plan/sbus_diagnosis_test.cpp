// What goes wrong on an SBus and how the units show it: no process data, a cable that is not there, and the
// words a short MOVLNK format leaves out. The master control is the control mode of the manual's bus monitor.
#include <gtest/gtest.h>

#include "tests/harness/proves.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

// Enabled by terminals, led by the SBus.
constexpr const char* kEnabled = "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
std::string follower(const std::string& name, const std::string& parameters,
                     const std::string& unit = "md60a") {
  return station_text(name, "P813 = 1\nP100 = 10\nP101 = 3\nP323 = 0\nP301 = 0\n" + parameters, unit) +
         kEnabled;
}
std::string m07_follower(const std::string& parameters) {
  return station_text("unit1", "P813 = 1\nP100 = 10\nP101 = 3\nP301 = 0\n" + parameters, "mc07") + kEnabled;
}

// Repeats a MOVLNK.
std::string caller(const std::string& setup, const std::string& every = "50") {
  return "#include <const.h>\nMOVLNK Ml; MLDATA Mld; long lCalls, lResult;\nmain()\n{\n Ml.BusType = 5; "
         "Ml.Address = 1;"
         " Ml.DPointer = numof(Mld);\n " +
         setup + "\n while (1) { _MoviLink(Ml); lResult = Ml.Result; lCalls++; _Wait(" + every + "); }\n}\n";
}

std::string control(const std::string& target) {
  return "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n[[control.target]]\n" + target;
}

TEST(SbusDiagnosis, OnlyProcessDataForTheUnitKeepTheMonitoringQuiet) {
  PROVES("TIME-11");
  const std::string unit = follower("unit1", "P814 = 7\nP815 = 200\nP817 = 128000\n");
  const std::string other = station_text("unit2", "P813 = 2\n");
  const std::string ask = "Ml.Format = 6; Ml.Service = 1; Ml.Index = 8318;";
  // The unit has heard process data at first; then everything but its own falls silent.
  const std::string first = "Ml.Format = 5; Mld.PO1 = 6; _MoviLink(Ml); ";
  const std::string master = station_text("master", "P813 = 0\n", "md60a", "A.IPC");
  for (const auto& [what, setup, quiet] : {std::tuple{"parameter telegrams", first + ask, false},
                                           {"PO of another unit", first + "Ml.Address = 2;", false},
                                           {"PO of another group", first + "Ml.Address = 108;", false},
                                           {"its PO", std::string("Ml.Format = 5; Mld.PO1 = 6;"), true},
                                           {"PO of its group", first + "Ml.Address = 107;", true}}) {
    PlantRig rig(bus_text() + master + unit + other, {{"A.IPC", caller(setup)}});
    rig.run_until(100 * kMillisecond);
    EXPECT_EQ(rig.station(1).fault(), 0) << what;
    rig.run_until(1500 * kMillisecond);
    EXPECT_EQ(rig.station(1).fault(), quiet ? 0 : 47) << what;
    EXPECT_GT(rig.variable(0, "lCalls"), 20) << what;
  }
  // PO-sync of a master control.
  PlantRig sync(bus_text() + unit +
                "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\nsync = 128\n[[control.target]]\naddress = "
                "1\npo = [6]\n");
  sync.run_until(1500 * kMillisecond);
  EXPECT_FALSE(sync.with(13).empty());
  EXPECT_EQ(sync.station(0).fault(), 0);
}

TEST(SbusDiagnosis, MissingCable) {
  PROVES("DIAG-01");
  const std::string master = station_text("master", "P813 = 0\n", "md60a", "A.IPC");
  const std::string call =
      caller("Ml.Format = 4; Ml.Service = 1; Ml.Index = 8318; Mld.PO1 = 6; Mld.PO2 = 2500;", "20");
  PlantRig rig(bus_text() + master + follower("unit1", "P815 = 200\n") +
                   fault_text("cut", "station = \"unit1\"\nfrom = \"1s\"\n"),
               {{"A.IPC", call}});
  rig.run_until(990 * kMillisecond);
  EXPECT_EQ(rig.variable(0, "lResult"), 0);
  EXPECT_EQ(rig.station(1).fault(), 0);
  EXPECT_GT(rig.station(1).drive().state().axis().speed, 0);
  rig.run_until(2 * kSecond);
  EXPECT_NE(rig.variable(0, "lResult"), 0);
  EXPECT_EQ(rig.station(1).fault(), 47);
  EXPECT_EQ(rig.says("unit1 takes no part: it is not connected to the line"), 1U);
  // Cut from the beginning: no process data ever, so the display shows t.
  PlantRig never(bus_text() + master + follower("unit1", "P815 = 200\n") +
                     fault_text("cut", "station = \"unit1\"\nfrom = \"0s\"\n"),
                 {{"A.IPC", call}});
  never.run_until(kSecond);
  EXPECT_NE(never.variable(0, "lResult"), 0);
  EXPECT_EQ(never.station(1).drive().state().display(), 't');
  EXPECT_EQ(never.says("unit1 takes no part: it is not connected to the line"), 1U);
}

TEST(SbusDiagnosis, ShortFormatsSendThreeWords) {
  PROVES("PD-10");
  for (const auto& [format, words] : {std::pair{1, 1}, {3, 2}, {5, 3}, {0, 1}, {2, 2}, {4, 3}}) {
    const std::string setup =
        "Ml.Service = 1; Ml.Index = 8318; Mld.PO1 = 6; Mld.PO2 = 1234; Mld.PO3 = 4321; "
        "Mld.PI1 = 91; Mld.PI2 = 92; Mld.PI3 = 93; Ml.Format = " +
        std::to_string(format) + ";";
    PlantRig rig(bus_text() + station_text("master", "P813 = 0\n", "md60a", "A.IPC") +
                     follower("unit1", "P874 = 6\nP875 = 6\n"),
                 {{"A.IPC", caller(setup)}});
    rig.run_until(60 * kMillisecond);
    ASSERT_FALSE(rig.with(11).empty()) << format;
    const Frame po = rig.with(11)[0].frame;
    EXPECT_EQ(po.length, 6);
    const std::array<int, 3> sent = {6, 1234, 4321};
    for (int n = 0; n < 3; ++n) {
      const auto at = static_cast<size_t>(2 * n);
      EXPECT_EQ(po.data[at] << 8 | po.data[at + 1], n < words ? sent[static_cast<size_t>(n)] : 0) << format;
      const int32_t pi = rig.variable(0, "Mld.PI" + std::to_string(n + 1));
      if (n < words)
        EXPECT_EQ(pi & 0x22, 0x02) << format << " a status word of a unit without fault";
      else
        EXPECT_EQ(pi, 91 + n) << format;
    }
  }
}

// Control mode presets the words, the drive runs; observing puts nothing on the line.
TEST(BusMonitor, ControlsOrObserves) {
  PROVES("M07-MON-10");
  PlantRig controlled(bus_text() + m07_follower("") +
                      control("address = 1\npo = [6, 0x07D0, 0]\nevery = \"10ms\"\n"));
  controlled.run_until(3 * kSecond);
  EXPECT_EQ(controlled.station(0).drive().parameters().value(8318), 400'000) << "P000, 1/1000 rpm";
  ASSERT_FALSE(controlled.with(11).empty());
  EXPECT_EQ(controlled.with(11).back().frame.data[3], 0xD0);
  // The observer of the same line: the frames of a unit that is asked by another one, and none of its own.
  PlantRig observed(bus_text() + station_text("master", "P813 = 0\n", "md60a", "A.IPC") + m07_follower(""),
                    {{"A.IPC", caller("Ml.Format = 6; Ml.Service = 1; Ml.Index = 8318;")}});
  observed.run_until(kSecond);
  EXPECT_FALSE(observed.frames.empty());
  for (const uint32_t id : observed.ids()) EXPECT_TRUE(id == 523 || id == 524) << id;
  EXPECT_EQ(observed.station(1).drive().parameters().value(8318), 0);
}

}  // namespace
}  // namespace ipos::tests
