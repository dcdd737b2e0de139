// A gateway from PROFIBUS to the SBus in a plant, with two MOVITRAC 07 behind it, and what faults on either side make of
// it. The process image is ours; words, speeds and return codes are those of the MOVITRAC 07 manual.
#include <set>

#include "runtime/signals/find.hpp"
#include "tests/runtime/bus/profibus/dp_plant_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;
using runtime::kSecond;
using runtime::Time;

const std::string kLines =
    "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 500000\n[[bus]]\nname = \"sbus\"\nkind = \"can\"\n";

std::string drive(const std::string& name, int address, const std::string& more = "") {
  return "[[station]]\nname = \"" + name +
         "\"\nunit = \"mc07\"\nsbus = \"sbus\"\n[station.parameters]\nP813 = " + std::to_string(address) +
         "\nP100 = 10\nP101 = 3\nP815 = \"200 ms\"\n" + more + "[station.inputs]\nDI01 = 1\nDI03 = 1\n";
}
std::string gateway(const std::string& more = "") {
  return "[[station]]\nname = \"gw\"\nunit = \"gateway\"\nprofibus = \"dp\"\nprofibus_address = 10\n"
         "sbus = \"sbus\"\n" +
         more;
}
std::string master(const std::string& more = "", const std::string& cfg = "F3 F2 F2") {
  return "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 10\ncfg = \"" + cfg +
         "\"\nwatchdog = \"200ms\"\npo = [6, 1500, 0, 6, 3000, 0]\n" + more;
}
// In the file the second address comes first.
std::string line(const std::string& more = "") {
  return kLines + drive("fan", 5) + drive("pump", 2) + gateway() + master(more);
}
const std::string kRun = "00 06 05 DC 00 00 00 06 0B B8 00 00";

constexpr size_t kFan = 0, kPump = 1;

std::string fault_of(const std::string& bus, const std::string& kind, const std::string& more) {
  return "[[fault]]\nbus = \"" + bus + "\"\nkind = \"" + kind + "\"\n" + more;
}

TEST(GatewayPlant, WordsInTheOrderOfTheAddresses) {
  DpPlant bench(line());
  bench.run(4 * kSecond);
  EXPECT_EQ(bench.speed(kPump), 300'000) << "address 2 has the first three words";
  EXPECT_EQ(bench.speed(kFan), 600'000);
  EXPECT_EQ(bench.input(1, 8), 1500);
  EXPECT_EQ(bench.input(4, 8), 3000);
  EXPECT_EQ(bench.input(0, 8), bench.station(kPump).status_word_1());
  EXPECT_EQ(bench.fault(kFan) + bench.fault(kPump), 0);
}

TEST(GatewayPlant, DrivesThatAreNamed) {
  DpPlant bench(
      kLines + drive("fan", 5) + drive("pump", 2) + gateway("drives = [5]\n") +
      master("", "F2").replace(master("", "F2").find("po ="), std::string::npos, "po = [6, 1500, 0]\n"));
  bench.run(4 * kSecond);
  EXPECT_EQ(bench.speed(kFan), 300'000);
  EXPECT_EQ(bench.speed(kPump), 0);
}

TEST(GatewayPlant, OneChannelReachesEachDrive) {
  DpPlant bench(line());
  bench.run(kSecond);
  // P813 = 8600 = 2198h: the SBus address itself. Byte 1 picks the drive.
  EXPECT_EQ(bench.service("71 02 21 98 00 00 00 00", kRun), "71 02 21 98 00 00 00 02");
  EXPECT_EQ(bench.service("31 05 21 98 00 00 00 00", kRun), "31 05 21 98 00 00 00 05");
  // P302 = 2145h := 1200.000 rpm.
  EXPECT_EQ(bench.service("72 05 21 45 00 12 4F 80", kRun), "72 05 21 45 00 12 4F 80");
  EXPECT_EQ(bench.value("302", kFan), 1'200'000);
  EXPECT_NE(bench.value("302", kPump), 1'200'000);
  EXPECT_EQ(bench.speed(kPump), 300'000) << "process data went on";
}

// Class 8 is of the drive, classes 1 to 7 of the gateway (M07-PAR-11).
TEST(GatewayPlant, ErrorClasses) {
  DpPlant bench(line());
  bench.run(kSecond);
  EXPECT_EQ(bench.service("71 02 00 01 00 00 00 00", kRun), "F1 02 00 01 08 00 00 10");
  EXPECT_EQ(bench.service("31 03 21 98 00 00 00 00", kRun), "B1 03 21 98 05 05 00 00")
      << "nobody has address 3";
  EXPECT_EQ(bench.service("4F 02 21 98 00 00 00 00", kRun), "FF 02 21 98 05 05 00 00") << "service 15";
  EXPECT_EQ(bench.service("22 02 21 45 00 00 00 01", kRun), "A2 02 21 45 06 08 00 00") << "three octets";
}

TEST(GatewayPlant, LosesItsInverter) {
  PROVES("M07-PAR-14");
  DpPlant bench(line(fault_of("sbus", "cut", "station = \"pump\"\nfrom = \"2s\"\nuntil = \"4s\"\n")));
  bench.run(1900 * kMillisecond);
  EXPECT_EQ(bench.service("71 02 21 98 00 00 00 00", kRun), "71 02 21 98 00 00 00 02");
  bench.run(2500 * kMillisecond);
  EXPECT_EQ(bench.service("31 02 21 98 00 00 00 00", kRun), "B1 02 21 98 06 02 00 00");
  EXPECT_EQ(bench.service("71 05 21 98 00 00 00 00", kRun), "71 05 21 98 00 00 00 05")
      << "the other is there";
  bench.run(4500 * kMillisecond);
  EXPECT_EQ(bench.service("31 02 21 98 00 00 00 00", kRun), "31 02 21 98 00 00 00 02") << "repeated: success";
}

TEST(GatewayPlant, DiagnosisOfALostDrive) {
  DpPlant bench(line(fault_of("sbus", "cut", "station = \"fan\"\nfrom = \"2s\"\nuntil = \"4s\"\n")));
  bench.run(1900 * kMillisecond);
  const auto diagnosis = [&] { return bench.gateway().dp().slave().diagnosis(bench.plant->now()).fault; };
  EXPECT_EQ(diagnosis(), std::nullopt);
  EXPECT_NE(bench.input(4, 8), 0);
  bench.run(2100 * kMillisecond);
  EXPECT_EQ(bench.input(3, 8), 0);
  EXPECT_EQ(bench.input(4, 8), 0);
  EXPECT_EQ(bench.input(1, 8), 1500) << "the other goes on";
  EXPECT_TRUE(bench.told("the drive with SBus address 5 does not answer"));
  bench.run(3 * kSecond);
  EXPECT_EQ(diagnosis(), 0b10) << "the second of the image";
  EXPECT_EQ(bench.fault(kFan), 47) << "its own P815";
  bench.run(5 * kSecond);
  EXPECT_EQ(diagnosis(), std::nullopt);
  EXPECT_TRUE(bench.told("the drive with SBus address 5 answers again"));
  EXPECT_EQ(bench.gateway().drives()[1].losses, 1U);
}

// Without its master the drives get control word 0; the SBus goes on, so that none has a timeout.
TEST(GatewayPlant, DpMasterGoneAndBack) {
  DpPlant bench(
      line("[[control.command]]\nat = \"2s\"\ncommand = \"stop\"\n"
           "[[control.command]]\nat = \"4s\"\ncommand = \"start\"\n"));
  bench.run(2 * kSecond);
  EXPECT_EQ(bench.speed(kFan), 600'000);
  bench.run(4 * kSecond);
  EXPECT_EQ(bench.speed(kFan), 0);
  EXPECT_EQ(bench.speed(kPump), 0);
  EXPECT_EQ(bench.fault(kFan) + bench.fault(kPump), 0);
  EXPECT_TRUE(bench.told("PROFIBUS: hears nothing from its master within the watchdog time"));
  bench.run(7 * kSecond);
  EXPECT_EQ(bench.speed(kFan), 600'000);
  EXPECT_EQ(bench.speed(kPump), 300'000);
}

// Off it is on neither line: the drives have their timeout (P815), the DP master finds nobody. On again everything is
// there, and the drives run once their fault is reset by bit 6 of the control word.
TEST(GatewayPlant, PowerOffAndOn) {
  DpPlant bench(line("[[control.slave.change]]\nat = \"7s\"\npo = [0x40, 0, 0, 0x40, 0, 0]\n"
                     "[[control.slave.change]]\nat = \"7500ms\"\npo = [6, 1500, 0, 6, 3000, 0]\n"));
  const auto frames = [&] { return bench.plant->find_bus("sbus")->load(bench.plant->now()).frames; };
  bench.run(2 * kSecond);
  EXPECT_EQ(bench.speed(kPump), 300'000);
  bench.plant->set_power("gw", false);
  bench.run(3 * kSecond);
  EXPECT_FALSE(bench.gateway().powered());
  EXPECT_FALSE(bench.gateway().exchanges());
  EXPECT_EQ(bench.fault(kPump), 47);
  EXPECT_EQ(bench.fault(kFan), 47);
  EXPECT_EQ(bench.speed(kPump), 0);
  const uint64_t before = frames();
  bench.run(4 * kSecond);
  EXPECT_EQ(frames(), before) << "nobody asks on the SBus";
  EXPECT_EQ(bench.gateway().lost(), 0) << "it watches nobody";
  bench.plant->set_power("gw", true);
  bench.run(6900 * kMillisecond);
  EXPECT_TRUE(bench.gateway().exchanges());
  EXPECT_GT(frames(), before);
  EXPECT_EQ(bench.input(0, 8), bench.station(kPump).status_word_1());
  EXPECT_EQ(bench.input(0, 8) >> 8, 47) << "their fault stands until it is reset";
  bench.run(11 * kSecond);
  EXPECT_EQ(bench.speed(kPump), 300'000);
  EXPECT_EQ(bench.speed(kFan), 600'000);
  EXPECT_EQ(bench.service("71 02 21 98 00 00 00 00", kRun), "71 02 21 98 00 00 00 02")
      << "the parameter channel begins anew";
}

// Each change is told, also of a station, and at its time; what changes nothing is not.
TEST(GatewayPlant, TheJournalTellsPower) {
  DpPlant bench(line(""));
  const auto set = [&](const char* name, Time at, bool on) {
    bench.run(at);
    bench.plant->set_power(name, on);
  };
  set("gw", kSecond, false);
  set("gw", 2 * kSecond, false);
  set("gw", 3 * kSecond, true);
  set("pump", 4 * kSecond, false);
  set("gw", 5 * kSecond, false);
  std::vector<std::string> told;
  for (const runtime::JournalEntry& entry : bench.plant->journal().entries())
    if (entry.text.find("the power is switched") != std::string::npos)
      told.push_back(std::to_string(entry.time / kSecond) + " " + entry.station + " " + entry.text);
  EXPECT_EQ(told, (std::vector<std::string>{"1 gw the power is switched off", "3 gw the power is switched on",
                                            "4 pump the power is switched off", "5 gw the power is switched off"}));
}

TEST(GatewayPlant, HasSignals) {
  DpPlant bench(line(fault_of("sbus", "cut", "station = \"fan\"\nfrom = \"3s\"\n") +
                     "[[expect]]\nstation = \"gw\"\nat = \"2s\"\nsignal = \"drive5.PI2\"\nequals = 3000\n"
                     "[[expect]]\nstation = \"gw\"\nat = \"4s\"\nsignal = \"lost.1\"\nequals = 1\n"));
  const auto value = [&](const std::string& name) {
    const auto found = signals::find_signals(*bench.plant, name);
    EXPECT_TRUE(found) << name;
    return found ? found->front().read() : -1;
  };
  EXPECT_EQ(value("gw.powered"), 1);
  EXPECT_EQ(value("gw.exchange"), 0) << "not yet";
  bench.run(2 * kSecond);
  EXPECT_EQ(value("gw.exchange"), 1);
  EXPECT_EQ(value("gw.drive2.PO1"), 6);
  EXPECT_EQ(value("gw.drive2.PO1.1"), 1) << "6 has bits 1 and 2";
  EXPECT_EQ(value("gw.drive2.PO2"), 1500);
  EXPECT_EQ(value("gw.drive5.PI2"), 3000) << "600 rpm";
  EXPECT_EQ(value("gw.lost"), 0);
  EXPECT_GT(value("gw.drive5.answered"), 150) << "every 10 ms";
  bench.run(4 * kSecond);
  EXPECT_EQ(value("gw.lost"), 0b10);
  EXPECT_EQ(value("gw.drive5.lost"), 1);
  EXPECT_EQ(value("gw.drive5.losses"), 1);
  EXPECT_EQ(value("gw.drive5.PI2"), 0);
  EXPECT_EQ(value("gw.error"), 0);
  bench.service("31 05 21 98 00 00 00 00", kRun);
  bench.service("71 05 21 98 00 00 00 00", kRun);
  EXPECT_EQ(value("gw.error"), 0x06020000) << "the drive is gone";
  EXPECT_EQ(signals::find_signals(*bench.plant, "gw.drive*.P?1")->size(), 4U);
  EXPECT_NE(signals::find_signals(*bench.plant, "gw.speed").error().find("gateway 'gw' has no signal 'speed'"),
            std::string::npos);
  ASSERT_EQ(bench.plant->results().size(), 2U);
  for (const auto& result : bench.plant->results()) EXPECT_TRUE(result.met) << result.actual;
}

// A third of all frames is lost on one side or the other: the drives keep their words, and nothing wrong arrives.
TEST(GatewayPlant, LostFrames) {
  for (const char* bus : {"dp", "sbus"}) {
    const bool dp = std::string(bus) == "dp";
    DpPlant bench(line(fault_of(bus, dp ? "lost" : "drop", "rate = 330\nseed = 7\nfrom = \"1s\"\n")));
    bench.run(2 * kSecond);
    std::set<int32_t> speeds;
    for (int n = 0; n < 200; ++n) {
      bench.run_on(10 * kMillisecond);
      speeds.insert(bench.speed(kFan));
    }
    EXPECT_EQ(speeds, std::set<int32_t>{600'000}) << bus;
    // A service whose telegram is lost may be repeated, with the other handshake bit.
    std::string answer = "-- ";
    for (int n = 0; n < 20 && answer.substr(3) != "02 21 98 00 00 00 02"; ++n) {
      const char* handshake = n % 2 == 0 ? "71" : "31";
      answer = bench.service(std::string(handshake) + " 02 21 98 00 00 00 00", kRun);
    }
    EXPECT_EQ(answer.substr(3), "02 21 98 00 00 00 02") << bus;
  }
}

TEST(GatewayPlant, WrongNumberOfDrives) {
  DpPlant bench(kLines + drive("fan", 5) + drive("pump", 2) + gateway() + master("", "F3 F2 F2 F2"));
  bench.run(kSecond);
  EXPECT_TRUE(bench.told("refuses Chk_Cfg"));
  EXPECT_EQ(bench.speed(kFan), 0);
}

TEST(GatewayPlant, ErrorsOfThePlantFile) {
  EXPECT_EQ(errors_of(kLines + gateway("program = \"A.IPC\"\n")),
            "14: unknown key 'program' in a [[station]] of unit gateway; known are name, unit, profibus, "
            "profibus_address, sbus, drives, terminator, profibus_terminator\n");
  EXPECT_NE(errors_of(kLines + "[[station]]\nname = \"gw\"\nunit = \"gateway\"\nsbus = \"sbus\"\n")
                .find("a [[station]] of unit gateway needs profibus = ..."),
            std::string::npos);
  EXPECT_NE(errors_of(kLines + gateway("drives = [5, 5, 64, 1, 2, 3, 4, 6, 7, 8, 9]\n"))
                .find("the address 5 stands twice"),
            std::string::npos);
  EXPECT_NE(errors_of(line() + "[[expect]]\nstation = \"gw\"\nat = \"1s\"\nstate = \"fault\"\nequals = 0\n")
                .find("'gw' is a gateway: it has no program, drive, inputs or parameters of its own"),
            std::string::npos);
  EXPECT_NE(errors_of("[[station]]\nname = \"x\"\nunit = \"mdx\"\n").find("mc07b, gateway"),
            std::string::npos);
}

TEST(GatewayPlant, InTurnOrNot) {
  const std::string text =
      line(fault_of("sbus", "cut", "station = \"fan\"\nfrom = \"1s\"\nuntil = \"2s\"\n") +
           fault_of("dp", "lost", "rate = 100\nseed = 3\n"));
  DpPlant skipping(text), in_turn(text, runtime::Pace::InTurn);
  for (int n = 1; n <= 100; ++n) {
    const Time end = n * 30 * kMillisecond;
    skipping.run(end);
    in_turn.run(end);
    for (const size_t drive : {kFan, kPump}) {
      ASSERT_EQ(skipping.speed(drive), in_turn.speed(drive)) << n;
      ASSERT_EQ(skipping.fault(drive), in_turn.fault(drive)) << n;
    }
    ASSERT_EQ(skipping.master().slave(0).inputs(), in_turn.master().slave(0).inputs()) << n;
  }
}

}  // namespace
}  // namespace ipos::tests
