// The PROFIBUS card of MOVIDRIVE A and B in a plant. Expected values come from the manuals' unit profile (0.2 rpm a
// digit, fault 28, P819 and P831) and from the closed form of the ramp.
#include "tests/runtime/bus/profibus/dp_plant_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;
using runtime::kSecond;

constexpr uint16_t kEnabled = 1 << 2;  // status word 1: PO data enabled
constexpr int kFieldbusTimeout = 28;

const std::string kLine = "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 500000\n";

std::string unit(const std::string& type = "mdxb", const std::string& more = "",
                 const std::string& parameters = "P100 = 3\nP101 = 2\n") {
  return kLine + "[[station]]\nname = \"b2\"\nunit = \"" + type +
         "\"\noption = \"dfp\"\nprofibus = \"dp\"\nprofibus_address = 9\n" + more + "[station.parameters]\n" +
         parameters + "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
}
std::string master(const std::string& slave, const std::string& more = "") {
  return "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 9\n" + slave + more;
}

TEST(DfpPlant, TenWordsOfAMovidriveB) {
  PROVES("MDB-TOC-23");
  DpPlant ten(unit() + master("cfg = \"F9\"\npo = [6, 1500, 0, 4, 5, 6, 7, 8, 9, 10]\n"));
  ten.run(3 * kSecond);
  EXPECT_EQ(ten.speed(), 300'000) << "1500 digits of 0.2 rpm";
  EXPECT_EQ(ten.master().slave(0).inputs().size(), 20U);
  EXPECT_EQ(ten.input(1), 1500);
  EXPECT_EQ(ten.input(0) & kEnabled, kEnabled);
  for (size_t word = 3; word < 10; ++word) EXPECT_EQ(ten.input(word), 0) << "there is no program";
  EXPECT_EQ(ten.station().profibus()->card().station().slave().diagnosis(ten.plant->now()).ident, 0x6003);
}

// The master falls silent at 2 s. P819 is its watchdog time; P831 decides: 0 nothing, 1 the fault is shown, 4 rapid stop with
// fault, 7 rapid stop with warning.
TEST(DfpPlant, TimeoutOfAMovidriveB) {
  PROVES("MDB-TOC-23");
  struct Row {
    int response, fault, speed;
  };
  for (const Row& row : {Row{0, 0, 300'000}, {1, 28, 300'000}, {4, 28, 0}, {7, 28, 0}}) {
    DpPlant silent(unit("mdxb", "", "P100 = 3\nP101 = 2\nP831 = " + std::to_string(row.response) + "\n") +
                   master("cfg = \"F1\"\nwatchdog = \"200ms\"\npo = [6, 1500]\n",
                          "[[control.command]]\nat = \"2s\"\ncommand = \"stop\"\n"));
    silent.run(2 * kSecond);
    EXPECT_EQ(silent.speed(), 300'000) << row.response;
    EXPECT_EQ(silent.value("819"), 200) << "ms";
    silent.run(2195 * kMillisecond);
    EXPECT_EQ(silent.fault(), 0) << row.response;
    silent.run(2215 * kMillisecond);
    EXPECT_EQ(silent.fault(), row.fault) << row.response;
    silent.run(5 * kSecond);
    EXPECT_EQ(silent.speed(), row.speed) << row.response;
  }
}

TEST(DfpPlant, AMovidriveAHasThreeWords) {
  DpPlant three(unit("md60a") + master("cfg = \"F2\"\npo = [6, 1500]\n"));
  three.run(3 * kSecond);
  EXPECT_EQ(three.speed(), 300'000);
  EXPECT_EQ(three.station().profibus()->card().station().slave().diagnosis(three.plant->now()).ident, 0x6000);
  DpPlant four(unit("md60a") + master("cfg = \"F3\"\nwatchdog = \"200ms\"\npo = [6, 1500]\n"));
  four.run(kSecond);
  EXPECT_EQ(four.speed(), 0);
  EXPECT_TRUE(four.told("refuses Chk_Cfg: not one of its configurations"));
}

// Ten octets are five words, or the channel and one: a first F3 before others decides.
TEST(DfpPlant, ConfigurationsAreToldApartByTheChannel) {
  DpPlant five(unit() + master("cfg = \"F4\"\npo = [6, 1500, 1, 2, 3]\n"));
  five.run(kSecond);
  EXPECT_EQ(five.input(1), 1500);
  DpPlant channel(unit() + master("cfg = \"F3 F0\"\nchannel = \"31 00 20 70 00 00 00 00\"\n"));
  channel.run(kSecond);
  EXPECT_EQ(channel.channel().substr(3), "00 20 70 00 00 00 00")
      << "mirrored: the handshake bit has not changed";
  DpPlant four(unit() + master("cfg = \"F3\"\npo = [6, 1500, 1, 2]\n"));
  four.run(kSecond);
  EXPECT_EQ(four.input(1), 1500);
}

// Index and value as MOVILINK has them: 8304 = 2070h is P870, 9 its factory setting (1053 1610 p. 82).
TEST(DfpPlant, TheChannelIsThatOfMovilink) {
  DpPlant bench(unit() + master("cfg = \"F3 F2\"\n"));
  bench.run(300 * kMillisecond);
  const std::string words = "00 00 00 00 00 00";
  EXPECT_EQ(bench.service("71 00 20 70 00 00 00 00", words), "71 00 20 70 00 00 00 09");
  EXPECT_EQ(bench.service("31 00 03 E9 00 00 00 00", words), "B1 00 03 E9 08 00 00 10") << "no index 1001";
  EXPECT_EQ(bench.service("72 00 21 98 00 00 07 D0", words), "F2 00 21 98 08 00 00 15") << "P881 goes to 63";
  // P302 = 8517 = 2145h in 1/1000 rpm: 1200 rpm.
  EXPECT_EQ(bench.service("32 00 21 45 00 12 4F 80", words), "32 00 21 45 00 12 4F 80");
  EXPECT_EQ(bench.value("302"), 1'200'000);
  // A wrong length has the code that MOVITRAC 31 and the gateway have for it (MOVITRAC 31 PROFIBUS, 5.2).
  EXPECT_EQ(bench.service("62 00 21 45 00 00 00 01", words), "E2 00 21 45 06 08 00 00") << "three octets";
  EXPECT_EQ(bench.service("03 00 21 45 00 00 00 01", words), "83 00 21 45 06 08 00 00")
      << "volatile, one octet";
  EXPECT_EQ(bench.service("7F 00 21 45 00 00 00 00", words), "FF 00 21 45 05 05 00 00") << "service 15";
  EXPECT_EQ(bench.value("302"), 1'200'000);
}

// The bits that a master sets by itself (MOVITRAC 31 PROFIBUS, 3.4.1), and what the configuration has wrong.
TEST(DfpPlant, AMasterTellsWhatItFindsOfItsSlaves) {
  DpPlant absent(unit() + master("cfg = \"F2\"\n", "[[control.slave]]\naddress = 10\nident = 0x6003\n"));
  absent.run(500 * kMillisecond);
  EXPECT_TRUE(absent.told("dp: master 1 configures a slave with the address 10, which no station has"));
  EXPECT_TRUE(absent.told("slave 10 does not answer (Station_Non_Existent)"));
  EXPECT_FALSE(absent.told("slave 9 "));
  runtime::ProfibusControl& plc = *absent.plant->all<runtime::ProfibusControl>()[0];
  EXPECT_TRUE(plc.view(10)->has(profibus::diag::kNonExistent));
  EXPECT_FALSE(plc.view(9)->has(profibus::diag::kNonExistent));
  EXPECT_EQ(plc.view(11), nullptr);
  // One that loses its power, and comes back.
  absent.plant->set_power("b2", false);
  absent.run_on(500 * kMillisecond);
  EXPECT_TRUE(absent.told("slave 9 does not answer (Station_Non_Existent)"));
  EXPECT_FALSE(absent.told("slave 9 answers now"));
  absent.plant->set_power("b2", true);
  absent.run_on(500 * kMillisecond);
  EXPECT_TRUE(absent.told("slave 9 answers now"));
  // Two masters of one slave.
  DpPlant two(unit() + master("cfg = \"F2\"\n") +
              "[[control]]\nname = \"plc2\"\nprofibus = \"dp\"\naddress = 2\n[[control.slave]]\naddress = "
              "9\ncfg = \"F2\"\n");
  two.run(2 * kSecond);
  EXPECT_TRUE(two.told("dp: masters 1 and 2 both configure the slave 9"));
  EXPECT_TRUE(two.told("slave 9 belongs to another master (Master_Lock)"));
}

TEST(DfpPlant, TimeoutIsThatOfTheMaster) {
  DpPlant watched(unit("mdxb", "", "P100 = 3\nP101 = 2\nP831 = 4\n") +
                  master("cfg = \"F1\"\nwatchdog = \"200ms\"\npo = [6, 1500]\n",
                         "[[control.command]]\nat = \"2s\"\ncommand = \"stop\"\n"));
  watched.run(2 * kSecond);
  EXPECT_EQ(watched.value("819"), 200) << "ms, from Set_Prm";
  EXPECT_EQ(watched.speed(), 300'000);
  watched.run(2195 * kMillisecond);
  EXPECT_EQ(watched.fault(), 0);
  watched.run(2215 * kMillisecond);
  EXPECT_EQ(watched.fault(), kFieldbusTimeout);
  watched.run(5 * kSecond);
  EXPECT_EQ(watched.speed(), 0) << "rapid stop";

  DpPlant off(unit() + master("cfg = \"F1\"\npo = [6, 1500]\n",
                              "[[control.command]]\nat = \"2s\"\ncommand = \"stop\"\n"));
  off.run(6 * kSecond);
  EXPECT_EQ(off.value("819"), 650'000) << "650 s is off";
  EXPECT_EQ(off.fault(), 0);
  EXPECT_EQ(off.speed(), 300'000);
}

TEST(DfpPlant, NoResponseKeepsTheLastWords) {
  DpPlant bench(unit("mdxb", "", "P100 = 3\nP101 = 2\nP831 = 0\n") +
                master("cfg = \"F1\"\nwatchdog = \"200ms\"\npo = [6, 1500]\n",
                       "[[control.command]]\nat = \"2s\"\ncommand = \"stop\"\n"));
  bench.run(6 * kSecond);
  EXPECT_EQ(bench.fault(), 0);
  EXPECT_EQ(bench.speed(), 300'000);
}

// In Sync mode no new words come, and yet the master is there.
TEST(DfpPlant, SyncModeIsNoSilence) {
  DpPlant bench(unit() + master("cfg = \"F1\"\nwatchdog = \"100ms\"\npo = [6, 1500]\n",
                                "[[control.slave.change]]\nat = \"1500ms\"\npo = [6, 3000]\n"
                                "[[control.command]]\nat = \"1s\"\ncommand = \"sync\"\n"
                                "[[control.command]]\nat = \"3s\"\ncommand = \"sync\"\n"));
  bench.run(2900 * kMillisecond);
  EXPECT_EQ(bench.fault(), 0);
  EXPECT_EQ(bench.speed(), 300'000) << "held by Sync";
  bench.run(5 * kSecond);
  EXPECT_EQ(bench.speed(), 600'000);
}

// P072, P091 to P093 are what the card says of itself.
TEST(DfpPlant, DisplaysOfTheCard) {
  DpPlant bench(unit() + master("cfg = \"F1\"\n"));
  bench.run(kSecond);
  EXPECT_EQ(bench.value("072"), 2) << "FIELDBUS";
  EXPECT_EQ(bench.value("091"), 5) << "PROFIBUS DP";
  EXPECT_EQ(bench.value("093"), 9);
}

TEST(DfpPlant, OneSlotForTheCardOrSbus2) {
  PROVES("MDB-PAR-01");
  const std::string can = "[[bus]]\nname = \"can2\"\nkind = \"can\"\n";
  EXPECT_EQ(errors_of(unit("mdxb", "sbus2 = \"can2\"\n") + can),
            "8: option 'dfp' and SBus 2 (option DFC11B) need the same slot of b2: there is one\n");
  EXPECT_EQ(errors_of(unit("mdxb", "sbus = \"can2\"\n") + can), "") << "SBus 1 is built in";
  EXPECT_EQ(errors_of(unit("mc07")), "8: option 'dfp' is for unit mdxb and md60a, not for mc07\n");
  // Two RS-485 interfaces beside it.
  EXPECT_EQ(errors_of(unit("mdxb", "rs485 = \"x\"\nrs485_xt = \"y\"\n") +
                      "[[bus]]\nname = \"x\"\nkind = \"rs485\"\nbaud = 9600\n"
                      "[[bus]]\nname = \"y\"\nkind = \"rs485\"\nbaud = 57600\n"),
            "");
}

TEST(DfpPlant, AddressByTheSwitchAndGroupsOfTheOthers) {
  PROVES("MDB-PAR-07");
  const stdlib::ParameterTable& table = stdlib::parameter_table(*stdlib::find_unit("mdxb"));
  for (const char* number :
       {"810", "811", "880", "881", "882", "883", "884", "885", "890", "891", "892", "893", "894", "895"})
    EXPECT_NE(table.find(number), nullptr) << number;
  EXPECT_EQ(table.find("780"), nullptr) << "P78x is of cards without a switch";
  DpPlant bench(unit() + master("cfg = \"F1\"\npo = [6, 1500]\n"));
  bench.run(3 * kSecond);
  EXPECT_EQ(bench.value("093"), 9) << "of the switch";
  EXPECT_EQ(bench.speed(), 300'000);
}

// Words of the program in both directions, where P872 and P875 say so.
TEST(DfpPlant, IposData) {
  DpPlant bench(unit("mdxb", "", "P100 = 3\nP101 = 2\nP872 = 12\nP875 = 9\n") +
                master("cfg = \"F2\"\npo = [6, 1500, 4711]\n"));
  bench.station().drive().state().set_ipos_pi({1, 2, 0xBEEF});
  bench.run(kSecond);
  EXPECT_EQ(bench.station().drive().state().po()[2], 4711) << "what GETSYS PO-DATA reads";
  EXPECT_EQ(bench.input(2), 0xBEEF);
}

TEST(DfpPlant, FieldbusWithoutACardIsTold) {
  DpPlant bench("[[station]]\nname = \"b2\"\nunit = \"mdxb\"\n[station.parameters]\nP100 = 3\nP101 = 2\n");
  EXPECT_TRUE(bench.told("P100 is FIELDBUS, but the station is on no PROFIBUS"));
  EXPECT_TRUE(bench.told("P101 is FIELDBUS, but the station is on no PROFIBUS"));
}

TEST(DfpPlant, ObstaclesAreTold) {
  DpPlant bench(unit("mdxb", "", "P100 = 0\n") + master("cfg = \"F1\"\npo = [6, 1500]\n"));
  bench.run(kSecond);
  EXPECT_TRUE(bench.told("the control word has no effect: P101"));
  EXPECT_TRUE(bench.told("the setpoints have no effect: P100"));
}

// Two units over X13: the slave follows its master, whatever its fieldbus says, and its parameters and inputs are there.
TEST(DfpPlant, ASlaveOfMasterSlaveHasParametersOnly) {
  PROVES("MDB-MS-11");
  DpPlant bench(
      kLine +
      "[[bus]]\nname = \"x\"\nkind = \"rs485\"\nbaud = 9600\n"
      "[[station]]\nname = \"follower\"\nunit = \"mdxb\"\noption = \"dfp\"\nprofibus = \"dp\"\n"
      "profibus_address = 9\nrs485 = \"x\"\n[station.parameters]\nP100 = 9\nP811 = 101\nP870 = 1\nP873 = 1\n"
      "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI02 = 1\nDI03 = 1\n"
      "[[station]]\nname = \"leader\"\nunit = \"mdxb\"\nrs485 = \"x\"\n[station.parameters]\nP750 = 1\n"
      "P811 = 101\n[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\nDI04 = 1\n" +
      master("cfg = \"F3 F2\"\npo = [0, 7500, 1234]\n"));
  bench.run(4 * kSecond);
  EXPECT_EQ(bench.speed(1), 150'000) << "n11 of the leader";
  EXPECT_EQ(bench.speed(0), 150'000) << "PO of the fieldbus would have stopped it";
  EXPECT_TRUE(bench.told("PO data over the fieldbus have no effect: the unit is a slave"));
  // The fixed inputs: status word 1, speed (150 rpm are 750 digits), IPOS PI.
  EXPECT_EQ(bench.input(0, 8), bench.station().status_word_1());
  EXPECT_EQ(bench.input(1, 8), 750);
  EXPECT_EQ(bench.service("71 00 20 70 00 00 00 00", "00 00 00 00 00 00"), "71 00 20 70 00 00 00 09")
      << "P870 reads as control word 1";
}

// The same three words over RS-485, SBus and PROFIBUS: P870 to P876 describe all of them.
TEST(DfpPlant, TheSameWordsOverEachInterface) {
  PROVES("MDB-PAR-06");
  const std::string words = "P870 = 1\nP871 = 9\nP872 = 8\nP873 = 1\nP874 = 6\nP875 = 2\n";
  struct Seen {
    int32_t speed;
    std::array<uint16_t, 3> inputs;
    bool operator==(const Seen&) const = default;
  };
  const auto inputs_of = [](DpPlant& bench) {
    const auto pi = bench.station().drive().state().pi();
    return std::array<uint16_t, 3>{pi[0], pi[1], pi[2]};
  };
  DpPlant dp(unit("mdxb", "", "P100 = 3\nP101 = 2\n" + words) +
             master("cfg = \"F2\"\npo = [1500, 6, 500]\n"));
  dp.run(3 * kSecond);
  DpPlant can(
      "[[bus]]\nname = \"can\"\nkind = \"can\"\n[[station]]\nname = \"b2\"\nunit = \"mdxb\"\nsbus = \"can\"\n"
      "[station.parameters]\nP100 = 10\nP101 = 3\nP881 = 7\n" +
      words +
      "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n[[control]]\nname = \"plc\"\nsbus = \"can\"\n"
      "[[control.target]]\naddress = 7\nevery = \"20ms\"\npo = [1500, 6, 500]\n");
  can.run(3 * kSecond);
  DpPlant serial(
      "[[bus]]\nname = \"x\"\nkind = \"rs485\"\nbaud = 9600\n[[station]]\nname = \"b2\"\nunit = \"mdxb\"\n"
      "rs485 = \"x\"\n[station.parameters]\nP100 = 2\nP101 = 1\nP810 = 1\n" +
      words + "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n");
  runtime::Bus& x = *serial.plant->find_bus("x");
  x.attach_hand();
  for (int n = 0; n < 60; ++n) {
    EXPECT_EQ(x.send("02 01 05 05 DC 00 06 01 F4 bcc"), std::nullopt);
    serial.run_on(50 * kMillisecond);
  }
  const Seen over_dp{dp.speed(), inputs_of(dp)}, over_can{can.speed(), inputs_of(can)},
      over_serial{serial.speed(), inputs_of(serial)};
  EXPECT_EQ(over_dp.speed, 300'000);
  EXPECT_TRUE(over_dp == over_can);
  EXPECT_TRUE(over_dp == over_serial) << over_serial.speed;
  EXPECT_EQ(dp.input(0), 1500) << "PI1 is the speed";
}

// Each interface with a time and a response of its own: 300 ms and a rapid stop over the one that is silent, and nothing of
// the others. Silence is that of a telegram that came once.
TEST(DfpPlant, EachInterfaceTripsItsOwnFault) {
  PROVES("MDB-PAR-05");
  struct Interface {
    const char* setpoint;
    const char* control;
    const char* delay;  // null: the master's watchdog
    const char* response;
    int fault;
    std::string station, buses, sender;
  };
  const std::string can = "[[bus]]\nname = \"can\"\nkind = \"can\"\n";
  const std::string plc =
      "[[control]]\nname = \"plc\"\nsbus = \"can\"\n[[control.target]]\naddress = 0\nevery = \"20ms\"\n"
      "po = [6, 1500]\n[[fault]]\nbus = \"can\"\nkind = \"cut\"\nstation = \"plc\"\nfrom = \"2s\"\n";
  const Interface interfaces[] = {
      {"2", "1", "812", "833", 43, "rs485 = \"x\"\n",
       "[[bus]]\nname = \"x\"\nkind = \"rs485\"\nbaud = 9600\n", ""},
      {"10", "3", "883", "836", 47, "sbus = \"can\"\n", can, plc},
      {"10", "3", "893", "837", 46, "sbus2 = \"can\"\n", can, plc},
      {"3", "2", nullptr, "831", 28, "option = \"dfp\"\nprofibus = \"dp\"\nprofibus_address = 9\n", kLine,
       master("cfg = \"F1\"\nwatchdog = \"300ms\"\npo = [6, 1500]\n",
              "[[control.command]]\nat = \"2s\"\ncommand = \"stop\"\n")}};
  for (const Interface& one : interfaces)
    for (const bool own_response : {true, false}) {
      std::string parameters = std::string("P100 = ") + one.setpoint + "\nP101 = " + one.control + "\n";
      if (one.delay != nullptr) parameters += std::string("P") + one.delay + " = 300\n";
      // The response of this interface, or of all the others, is a rapid stop with fault; else none.
      for (const char* response : {"833", "836", "837", "831"})
        parameters += std::string("P") + response + " = " +
                      ((std::string_view(response) == one.response) == own_response ? "4\n" : "0\n");
      DpPlant bench(one.buses + "[[station]]\nname = \"b2\"\nunit = \"mdxb\"\n" + one.station +
                    "[station.parameters]\n" + parameters +
                    "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n" + one.sender);
      if (one.fault == 43) {
        runtime::Bus& x = *bench.plant->find_bus("x");
        x.attach_hand();
        for (int n = 0; n < 40; ++n) {
          EXPECT_EQ(x.send("02 00 03 00 06 05 DC bcc"), std::nullopt);
          bench.run_on(50 * kMillisecond);
        }
      }
      bench.run(2 * kSecond);
      EXPECT_EQ(bench.speed(), 300'000) << one.fault;
      bench.run(2200 * kMillisecond);
      EXPECT_EQ(bench.fault(), 0) << one.fault << ": too early";
      bench.run(2350 * kMillisecond);
      EXPECT_EQ(bench.fault(), own_response ? one.fault : 0) << "response by P" << one.response;
      bench.run(5 * kSecond);
      EXPECT_EQ(bench.speed(), own_response ? 0 : 300'000) << one.fault;
    }
}

// Whatever way its milliseconds are executed, the same comes of it.
TEST(DfpPlant, InTurnOrNot) {
  const std::string text =
      unit() + master("cfg = \"F3 F9\"\nwatchdog = \"200ms\"\npo = [6, 1500]\n",
                      "[[control.slave.change]]\nat = \"700ms\"\nchannel = \"72 00 21 45 00 12 4F 80\"\n"
                      "[[control.command]]\nat = \"1500ms\"\ncommand = \"stop\"\n");
  DpPlant skipping(text), in_turn(text, runtime::Pace::InTurn);
  for (int n = 1; n <= 100; ++n) {
    skipping.run(n * 25 * kMillisecond);
    in_turn.run(n * 25 * kMillisecond);
    ASSERT_EQ(skipping.speed(), in_turn.speed()) << n;
    ASSERT_EQ(skipping.fault(), in_turn.fault()) << n;
    ASSERT_EQ(skipping.master().slave(0).inputs(), in_turn.master().slave(0).inputs()) << n;
  }
  EXPECT_EQ(skipping.fault(), kFieldbusTimeout);
}

}  // namespace
}  // namespace ipos::tests
