// PO4 to PO10 and PI4 to PI10: over a DP card and over CANopen they go to the program and come from it. The words are
// those that the plant file's master sends; the program turns their order round.
#include "runtime/signals/find.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::kSecond;

const std::string kEcho = R"(
#include <const.h>
GSPODATA10 po;
SSPIDATA10 pi;
main() {
  while (1) {
    _GetSys(po, GS_PODATA10);
    pi.PI3 = po.PO3 + 1;
    pi.PI4 = po.PO10; pi.PI5 = po.PO9; pi.PI6 = po.PO8; pi.PI7 = po.PO7;
    pi.PI8 = po.PO6; pi.PI9 = po.PO5; pi.PI10 = po.PO4;
    _SetSys(SS_PIDATA10, pi);
  }
}
)";

const std::string kDp = R"(
[[bus]]
name = "dp"
kind = "profibus"
baud = 500000
[[station]]
name = "u"
unit = "mdxb"
option = "dfp"
program = "P.IPC"
profibus = "dp"
profibus_address = 9
[station.parameters]
P100 = 3
P101 = 2
P872 = 12
P875 = 9
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
[[control]]
name = "plc"
profibus = "dp"
[[control.slave]]
address = 9
cfg = "F9"
watchdog = "200ms"
po = [6, 1500, 3, 104, 105, 106, 107, 108, 109, 0xFFFE]
[[control.slave.change]]
at = "2s"
po = [6, 1500, 3, 204]
)";

const profibus::Octets& inputs_of(const runtime::Plant& plant) {
  return plant.all<runtime::ProfibusControl>()[0]->master().slave(0).inputs();
}
int word(const profibus::Octets& octets, size_t number) {  // PI1 is 1
  return octets[2 * number - 2] << 8 | octets[2 * number - 1];
}

TEST(FurtherWords, OverTheCardOfAMovidriveB) {
  PROVES("MDB-TOC-23");
  const auto plant = make_plant(kDp, {{"P.IPC", kEcho}});
  plant->run_until(kSecond);
  EXPECT_EQ(value(*plant, "po.PO1"), 6);
  EXPECT_EQ(value(*plant, "po.PO2"), 1500);
  EXPECT_EQ(value(*plant, "po.PO4"), 104);
  EXPECT_EQ(value(*plant, "po.PO9"), 109);
  EXPECT_EQ(value(*plant, "po.PO10"), -2) << "with sign, as PO1 to PO3";
  const profibus::Octets& inputs = inputs_of(*plant);
  EXPECT_EQ(word(inputs, 1), plant->stations()[0]->status_word_1()) << "P873 stands";
  EXPECT_EQ(word(inputs, 3), 4) << "P875 = IPOS PI-DATA";
  EXPECT_EQ(word(inputs, 4), 0xFFFE);
  for (int number = 5; number <= 10; ++number)
    EXPECT_EQ(word(inputs, static_cast<size_t>(number)), 114 - number);
  plant->run_until(3 * kSecond);
  EXPECT_EQ(word(inputs, 10), 204) << "new words";
  EXPECT_EQ(word(inputs, 4), 0xFFFE) << "what the change does not name stays";
}

// They have signals, which a drive without such a bus has not.
TEST(FurtherWords, AreSignals) {
  const auto plant = make_plant(kDp, {{"P.IPC", kEcho}});
  plant->run_until(kSecond);
  const auto signal = [&](const char* name) {
    const auto found = signals::find_signals(*plant, name);
    EXPECT_TRUE(found && found->size() == 1) << name;
    return found && !found->empty() ? found->front().read() : -1;
  };
  EXPECT_EQ(signal("u.PO10"), 0xFFFE);
  EXPECT_EQ(signal("u.PI10"), 104);
  EXPECT_EQ(signal("u.PI10.3"), 1) << "104 is 68h";
  const auto alone = make_station("main() { }");
  EXPECT_FALSE(signals::find_signals(*alone, "u.PO4"));
}

TEST(FurtherWords, GoWithThePower) {
  const auto plant = make_plant(kDp, {{"P.IPC", kEcho}});
  plant->run_until(kSecond);
  const auto& drive = plant->stations()[0]->drive().state();
  EXPECT_EQ(drive.further_po()[0], 104);
  plant->stations()[0]->power_off();
  plant->stations()[0]->power_on();
  EXPECT_EQ(drive.further_pi()[0], 0);
  EXPECT_EQ(drive.further_po()[0], 0);
}

TEST(FurtherWords, OverCanopen) {
  const auto plant = make_plant(R"(
[[bus]]
name = "can"
kind = "can"
baud = 500000
[[station]]
name = "u"
unit = "mdxb"
program = "P.IPC"
sbus = "can"
[station.parameters]
P880 = 1
P886 = 5
P100 = 10
P101 = 3
[[control]]
name = "plc"
kind = "canopen"
sbus = "can"
cycle = "5ms"
[[control.target]]
address = 5
po = [6, 1500, 0, 104, 105, 106, 107, 108, 109, 110]
[[control.target.pdo]]
number = 2
map = ["PO4", "PO5", "PO6", "PO10"]
[[control.target.pdo]]
number = 2
transmit = true
map = ["PI4", "PI10"]
)",
                                {{"P.IPC", kEcho}});
  plant->run_until(2 * kSecond);
  EXPECT_EQ(value(*plant, "po.PO2"), 1500);
  EXPECT_EQ(value(*plant, "po.PO4"), 104);
  EXPECT_EQ(value(*plant, "po.PO6"), 106);
  EXPECT_EQ(value(*plant, "po.PO7"), 0) << "in no PDO";
  EXPECT_EQ(value(*plant, "po.PO10"), 110);
  const auto& input = plant->all<runtime::CanopenControl>()[0]->master().report(0).input;
  EXPECT_EQ(input[3], 110);
  EXPECT_EQ(input[9], 104);
}

}  // namespace
}  // namespace ipos::tests
