// Master/slave operation over the SBus in a plant: the rhythm of the group telegrams, and who must not follow
// them (1053 1610 p. 50).
#include <gtest/gtest.h>

#include "runtime/bus_plan/plan.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

const std::string kInputs = "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
constexpr uint32_t kGroupTelegram = 8 * 5 + 6;  // P814 = 5

// P100 = 10 and P101 = 3: both follow the SBus, if they follow anything there.
std::string unit(const std::string& name, int address, int p750) {
  return station_text(name, "P813 = " + std::to_string(address) +
                                "\nP814 = 5\nP100 = 10\nP101 = 3\nP301 = 0\nP750 = " + std::to_string(p750) +
                                "\n") +
         kInputs;
}

class Stranger final : public CanNode {
 public:
  explicit Stranger(CanLine& line) : port(line, line.attach("other", line.baud(), *this)) {}
  void on_frame(Time, const Frame&) override {}
  void on_sent(Time, const Frame&, uint64_t) override {}
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  LinePort port;
};

// Each millisecond of virtual time has one, and no frame is on the line but these.
TEST(MasterAndSlave, OneGroupTelegramEachMillisecond) {
  PROVES("MS-01");
  for (const uint32_t baud : {500'000U, 1'000'000U}) {
    const std::string rate = "P816 = " + std::string(baud == 500'000 ? "2" : "3") + "\n";
    PlantRig rig(bus_text(baud) + station_text("master", "P813 = 1\nP814 = 5\nP750 = 2\n" + rate) +
                 station_text("slave", "P813 = 2\nP814 = 5\nP100 = 8\n" + rate));
    rig.run_until(2 * kSecond);
    ASSERT_GE(rig.frames.size(), 1990U);
    const Time first = rig.frames[0].start / kMillisecond;
    EXPECT_LE(first, 5) << "from power-on";
    for (size_t n = 0; n < rig.frames.size(); ++n) {
      EXPECT_EQ(rig.frames[n].frame.id, kGroupTelegram);
      ASSERT_EQ(rig.frames[n].start / kMillisecond, first + static_cast<Time>(n));
    }
  }
}

// A stranger sends the group telegram: a unit of the group runs by it, the master of the group does not.
TEST(MasterAndSlave, TheMasterFollowsNoGroupTelegrams) {
  PROVES("MS-04");
  for (const bool master : {false, true}) {
    PlantRig rig(bus_text() + unit("master", 1, master ? 2 : 0) +
                 station_text("slave", "P813 = 2\nP814 = 5\nP100 = 8\n"));
    Stranger other(rig.get().all<runtime::CanBus>()[0]->line());
    for (int n = 1; n <= 200; ++n) {
      rig.run_until(n * 10 * kMillisecond - 3 * kMillisecond / 10);
      other.port.send(process_frame(kGroupTelegram, {6, 5000, 0}), 0);
    }
    const Drive& drive = rig.station(0).drive().state();
    EXPECT_EQ(drive.axis().speed > 500'000, !master) << drive.axis().speed;
    if (master) {
      EXPECT_EQ(drive.axis().speed, 0);
    }
    EXPECT_EQ(rig.says("identifier 02Eh (46) is sent by master and by other"), master ? 1U : 0U)
        << rig.journal();
  }
  // Two masters of one group in the plan.
  PlantRig two(bus_text() + unit("a", 1, 2) + unit("b", 2, 2) +
               station_text("slave", "P813 = 3\nP814 = 5\nP100 = 8\n"));
  const BusPlan plan = make_plan(two.get(), {});
  size_t found = 0;
  for (const Finding& finding : plan.findings)
    if (finding.kind == FindingKind::DoubleIdentifier) {
      ++found;
      EXPECT_EQ(finding.text.find("identifier 02Eh (46) is sent by a ("), 0U) << finding.text;
      EXPECT_NE(finding.text.find("and by b ("), std::string::npos) << finding.text;
    }
  EXPECT_EQ(found, 1U);
}

}  // namespace
}  // namespace ipos::tests
