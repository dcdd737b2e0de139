// RS-485 in a plant: what cannot be wired, what is told, both interfaces of a unit, keypad and master/slave
// operation.
#include "runtime/plant_file/serial_plan.hpp"
#include "tests/runtime/bus/rs485/serial_plant_rig.hpp"

namespace ipos::tests {
namespace {

std::vector<std::string> errors_of(const std::string& text) {
  goes_through(kPlantFile);
  std::vector<std::string> texts;
  for (const PlantError& error : read_plant_file(text).errors)
    texts.push_back(std::to_string(error.place.line) + ":" + std::to_string(error.place.column) + " " +
                    error.text);
  return texts;
}

void refuses(const std::string& text, const std::string& words) {
  const auto errors = errors_of(text);
  ASSERT_EQ(errors.size(), 1U) << words << (errors.size() > 1 ? errors[1] : "");
  EXPECT_NE(errors[0].find(words), std::string::npos) << errors[0];
}
void accepts(const std::string& text) {
  const auto errors = errors_of(text);
  EXPECT_TRUE(errors.empty()) << errors[0];
}

std::string many(int count, const std::string& unit, const std::string& key, const std::string& more = "") {
  std::string text;
  for (int n = 0; n < count; ++n)
    text += station("u" + std::to_string(n), unit, key + " = \"line1\"\n" + more,
                    "P810 = " + std::to_string(n) + "\n");
  return text;
}

TEST(SerialPlan, StationsOnALine) {
  PROVES("RS485-23");
  accepts(bus("line1") + many(31, "md60a", "rs485"));
  refuses(bus("line1") + many(32, "md60a", "rs485"), "one master and 31 slaves");
  accepts(bus("line1") + many(16, "compact", "rs485_xt", "uss21a = true\n"));
  refuses(bus("line1") + many(17, "compact", "rs485_xt", "uss21a = true\n"), "count as 34");
  // Two masters of slave setpoints; two that call are in RequestsOfTwoMasters.
  const PlantRun two(bus("line1") +
                     station("a", "md60a", "rs485 = \"line1\"\n", "P810 = 1\nP811 = 101\nP750 = 1\n") +
                     station("b", "md60a", "rs485 = \"line1\"\n", "P810 = 2\nP811 = 101\nP750 = 4\n"));
  EXPECT_TRUE(two.told("a and b are both masters (P750)"));
}

// P811 is index 8598 (2196h): 100 from the works; 99 is below the minimum (class 8, 16h), 200 above the maximum (15h).
TEST(SerialPlant, GroupAddressOfAMovidriveB) {
  PROVES("MDB-PAR-10");
  PlantRun run(bus("l") + station("a", "mdxb", "rs485 = \"l\"\n", "P810 = 1\n"));
  const auto ask = [&](const std::string& channel) {
    const auto heard = run.ask(0, "02 01 86 " + channel);
    EXPECT_EQ(heard.size(), 1U) << channel;
    return heard.empty() ? "" : heard[0].substr(9, 23);
  };
  EXPECT_EQ(ask("31 00 21 96 00 00 00 00"), "31 00 21 96 00 00 00 64");
  EXPECT_EQ(ask("32 00 21 96 00 00 00 63"), "B2 00 21 96 08 00 00 16");
  EXPECT_EQ(ask("32 00 21 96 00 00 00 C8"), "B2 00 21 96 08 00 00 15");
  for (const char* good : {"C7", "64"})
    EXPECT_EQ(ask(std::string("32 00 21 96 00 00 00 ") + good), std::string("32 00 21 96 00 00 00 ") + good);
}

TEST(SerialPlan, LengthOfALine) {
  PROVES("RS485-24");
  const std::string units =
      station("a", "md60a", "rs485 = \"l\"\n") + station("b", "md60a", "rs485 = \"l\"\n", "P810 = 1\n");
  EXPECT_FALSE(PlantRun(bus("l", "length = 200\n") + units).told("m of cable"));
  EXPECT_TRUE(PlantRun(bus("l", "length = 201\n") + units).told("l: 201 m of cable, a RS-485 line may have 200 m"));
  refuses(bus("l", "length = 0\n") + units, "in metres");
}

TEST(SerialPlan, Rs232ConnectsTwo) {
  PROVES("RS485-25");
  const std::string line = "[[bus]]\nname = \"pc\"\nkind = \"rs232\"\n";
  const std::string slave = station("a", "md60a", "rs485_xt = \"pc\"\nuss21a = true\n");
  const std::string other = station("b", "md60a", "rs485_xt = \"pc\"\nuss21a = true\n", "P810 = 1\n");
  EXPECT_FALSE(PlantRun(line + "length = 5\n" + slave).told("m of cable"));
  refuses(line + slave + other, "one master and one slave");
  EXPECT_TRUE(PlantRun(line + "length = 6\n" + slave).told("pc: 6 m of cable, a RS-232 line may have 5 m"));
  refuses(line + "baud = 57600\n" + slave, "RS-232 has 9600 baud");
}

// In a log of lines a blank ends the name.
TEST(SerialPlan, TheNameOfALineIsOneWord) {
  refuses(bus("a b"), "the name of a bus is one word");
  for (const char* hidden : {"\\t", "\\r", "\\n", "\\u0000", "\\u001F", "\\u007F"})
    EXPECT_FALSE(errors_of(bus(std::string("a") + hidden + "b")).empty()) << hidden;
  accepts(bus("a_b!\u00E4~") + station("a", "md60a", ""));
  const PlantRun run(station("left axis", "md60a", "keypad = true\n"));
  EXPECT_EQ(run.plant->all<runtime::SerialBus>().at(0)->line().name(), "left_axis.keypad");
}

TEST(SerialPlan, Uss21aAndKeypad) {
  PROVES("RS485-26");
  refuses(bus("l") + station("a", "compact", "rs485_xt = \"l\"\n"), "needs uss21a");
  refuses(bus("l") + station("a", "compact", "rs485 = \"l\"\n"), "no RS-485 terminals");
  accepts(bus("l") + station("a", "compact", "rs485_xt = \"l\"\nuss21a = true\n"));
  refuses(station("a", "md60a", "uss21a = true\nkeypad = true\n"), "excludes");
  refuses(station("a", "compact", "uss21a = true\nkeypad = true\n"), "excludes");
  refuses(station("a", "mdxb", "uss21a = true\n"), "takes no USS21A");
  refuses(bus("l") + station("a", "mc07", "rs485_xt = \"l\"\n"), "no XT or TERMINAL socket");
  refuses(station("a", "mc07", "keypad = true\n"), "no socket for a keypad");
  refuses(station("a", "md60a", "s13 = true\n"), "no DIP switch S13");
  refuses(station("a", "md60a", "keypad = 1\n"), "true or false");
}

TEST(SerialPlan, MovidriveB) {
  PROVES("MDB-RS485-05", "MDB-RS485-06");
  // What `ipos bus plan` refuses (other_lines_test.cpp has its codes), and a run tells.
  const auto wrong = [](const std::string& text) {
    const PlantFile file = read_plant_file(text).plant;
    const auto found = serial_cable_findings(file, file.buses.at(0));
    return found.size() == 1 ? found[0].text : std::to_string(found.size());
  };
  accepts(bus("line1", "length = 200\n") + many(31, "mdxb", "rs485"));
  EXPECT_EQ(wrong(bus("line1", "length = 200\n") + many(31, "mdxb", "rs485")), "0");
  refuses(bus("line1") + many(33, "mdxb", "rs485"), "one master and 31 slaves");
  EXPECT_EQ(wrong(bus("line1", "length = 201\n") + many(2, "mdxb", "rs485")), "201 m of cable, a RS-485 line may have 200 m");
  const std::string unit = station("a", "mdxb", "rs485_xt = \"x\"\n");
  EXPECT_EQ(wrong(bus("x", "length = 3\n") + unit), "0");
  EXPECT_EQ(wrong(bus("x", "length = 3.5\n") + unit), "3.500 m of cable, a line at XT of MOVIDRIVE B may have 3 m");
  EXPECT_EQ(wrong(bus("x", "length = 5\nshielded = true\n") + unit), "0");
  EXPECT_EQ(wrong(bus("x", "length = 5.1\nshielded = true\n") + unit),
            "5.100 m of cable, a shielded line at XT of MOVIDRIVE B may have 5 m");
  EXPECT_EQ(wrong(bus("line1", "terminated = true\n") + many(2, "mdxb", "rs485")),
            "the units have terminating resistors; connect no others");
  refuses(bus("line1") + many(3, "mdxb", "rs485_xt"), "one master and one slave");
  refuses(bus("x") + station("a", "mdxb", "rs485_xt = \"x\"\nkeypad = true\n"), "excludes rs485_xt");
  // The cable: 100 to 150 ohm, at most 40 pF/m; 1053 1610 p. 14-15 prints the same for the older units.
  for (const char* type : {"mdxb", "md60a", "mc07"}) {
    for (const int ohm : {100, 120, 150})
      accepts(bus("line1", "impedance = " + std::to_string(ohm) + "\ncapacitance = 40\n") +
              many(2, type, "rs485"));
    for (const int ohm : {1, 90, 99, 151})
      refuses(bus("line1", "impedance = " + std::to_string(ohm) + "\n") + many(2, type, "rs485"),
              "1:1 'line1': cable of " + std::to_string(ohm) + " ohm; a RS-485 line needs 100 to 150 ohm");
    refuses(bus("line1", "capacitance = 41\n") + many(2, type, "rs485"),
            "'line1': cable of 41 pF/m; a RS-485 line may have 40 pF/m");
  }
}

TEST(SerialPlan, KeysLeadToSerialLines) {
  const std::string can = "[[bus]]\nname = \"c\"\nkind = \"can\"\n";
  refuses(can + station("a", "md60a", "rs485 = \"c\"\n"), "7:9 bus 'c' is an SBus, not a serial line");
  refuses(bus("l") + station("a", "md60a", "sbus = \"l\"\n"), "bus 'l' is a serial line");
  refuses(station("a", "md60a", "rs485 = \"l\"\n"), "there is no bus 'l'");
  refuses(bus("l", "baud = 19200\n") + station("a", "md60a", "rs485 = \"l\"\n"),
          "9600 or 57600 baud, not 19200");
  refuses(bus("l") + station("a", "mdxb", "rs485 = \"l\"\nrs485_xt = \"l\"\n"), "same line");
}

TEST(SerialPlan, RatesOfTheInterfaces) {
  const PlantFileResult file = read_plant_file(bus("l") + station("a", "mdxb", "rs485 = \"l\"\n"));
  EXPECT_EQ(file.plant.buses.at(0).baud, 9600U);
  EXPECT_EQ(kX13Baud, 9600U);
}

TEST(SerialPlan, AddressesAndMasterSlave) {
  PROVES("MDB-PAR-09", "MDB-PAR-14");
  const PlantRun fresh(bus("l") + station("a", "mdxb", "rs485 = \"l\"\n") +
                       station("b", "mdxb", "rs485 = \"l\"\n"));
  EXPECT_EQ(fresh.plant->stations()[0]->drive().value("810"), 0);
  EXPECT_TRUE(fresh.told("a and b both have address P810 = 0"));
  const PlantRun slave(bus("l") +
                       station("a", "mdxb", "rs485 = \"l\"\n", "P100 = 9\nP750 = 1\nP811 = 101\n"));
  EXPECT_TRUE(slave.told("must have P750 = 0"));
  const PlantRun good(bus("l") + station("a", "mdxb", "rs485 = \"l\"\n", "P100 = 9\nP811 = 101\n"));
  EXPECT_TRUE(good.plant->journal().entries().empty());
  const PlantRun xt(bus("l") +
                    station("a", "mdxb", "rs485_xt = \"l\"\ns13 = true\n", "P100 = 9\nP811 = 101\n"));
  EXPECT_TRUE(xt.told("needs X13"));
}

TEST(SerialPlant, GroupAddressesOfAUnit) {
  PROVES("RS485-10");
  UnitInterface drive(*stdlib::find_unit("md60a"));
  EXPECT_EQ(drive.value("811"), 100);
  for (const int good : {100, 101, 150, 199})
    EXPECT_FALSE(drive.set_parameter("P811", good).has_value()) << good;
  for (const int bad : {99, 200}) EXPECT_TRUE(drive.set_parameter("P811", bad).has_value()) << bad;
  PlantRun run(bus("l") + station("a", "md60a", "rs485 = \"l\"\n", "P810 = 1\n"));
  EXPECT_TRUE(run.ask(0, "02 64 86 32 00 21 16 00 00 09 C4").empty());
  EXPECT_EQ(run.value(0, 8470), 2000);
  run.ask(0, "02 FF 86 32 00 21 16 00 00 09 C4");
  EXPECT_EQ(run.value(0, 8470), 2500);
  // A new address counts from the next millisecond on.
  run.ask(0, "02 01 86 32 00 21 95 00 00 00 07");  // P810 := 7
  EXPECT_EQ(run.ask(0, "02 07 81 00 00").size(), 1U);
  EXPECT_TRUE(run.ask(0, "02 01 81 00 00").empty());
}

TEST(SerialPlant, WordsThatAreNotSentKeepTheirValue) {
  PROVES("PD-11");
  PlantRun run(bus("l") + station("a", "md60a", "rs485 = \"l\"\n", "P810 = 1\n"));
  run.ask(0, "02 01 05 00 06 13 88 3A 98");
  EXPECT_EQ(run.ask(0, "02 01 01 00 02").at(0).size(), 6U * 3 - 1) << "one word";
  EXPECT_EQ(run.value(0, 8455), 2);
  EXPECT_EQ(run.value(0, 8456), 5000);
  EXPECT_EQ(run.value(0, 8457), 15000);
}

const std::string kTwoPorts = bus("x", "baud = 57600\n") + bus("l") +
                              station("a", "mdxb", "rs485 = \"l\"\nrs485_xt = \"x\"\n", "P810 = 1\n");

TEST(SerialPlant, RatesOfXtAndX13) {
  PROVES("MDB-RS485-02");
  PlantRun run(kTwoPorts);
  EXPECT_EQ(run.ask(0, "02 01 81 00 00").size(), 1U) << "XT at 57.6";
  const auto& heard = run.recorders[0]->heard;
  EXPECT_NEAR(static_cast<double>(heard[1].reception.end - heard[1].reception.start), 6 * 11e9 / 57600, 2);
  EXPECT_EQ(run.ask(1, "02 01 81 00 00").size(), 1U) << "X13 at 9.6";
  EXPECT_NEAR(static_cast<double>(run.recorders[1]->heard[1].reception.end -
                                  run.recorders[1]->heard[1].reception.start),
              6 * 11e9 / 9600, 2);
  // XT at 9.6 by S13; X13 does not understand 57.6.
  PlantRun slow(bus("x") + bus("l", "baud = 57600\n") +
                station("a", "mdxb", "rs485 = \"l\"\nrs485_xt = \"x\"\ns13 = true\n", "P810 = 1\n"));
  EXPECT_EQ(slow.ask(0, "02 01 81 00 00").size(), 1U);
  EXPECT_TRUE(slow.ask(1, "02 01 81 00 00").empty());
  EXPECT_TRUE(
      slow.told("a understands nobody here: its baud rate is not that of the line (9600 baud, line 57600"));
}

TEST(SerialPlant, PortsAreSeparate) {
  PROVES("MDB-RS485-07");
  PlantRun run(kTwoPorts);
  run.recorders[1]->clear();
  run.ask(0, "02 01 05 00 06 3A 98 01 F4");
  EXPECT_TRUE(run.recorders[1]->characters.empty());
  run.recorders[0]->clear();
  run.ask(1, "02 02 05 00 06 3A 98 01 F4");
  run.ask(1, "02 01 86 31 00 20 7E 00 00 00 00");
  EXPECT_TRUE(run.recorders[0]->characters.empty());
}

TEST(SerialPlant, BothInterfacesFeedOneMonitoring) {
  PROVES("TIME-06");
  PlantRun run(bus("x", "baud = 57600\n") + bus("l") +
               station("a", "mdxb", "rs485 = \"l\"\nrs485_xt = \"x\"\n", "P810 = 1\nP812 = 500\n"));
  const auto fault = [&] { return run.station(0).fault(); };
  run.ask(0, "02 01 81 00 00");
  run.ask(1, "02 01 86 31 00 20 7E 00 00 00 00");
  run.run(1 * kSecond);
  EXPECT_EQ(fault(), 0) << "acyclic requests are not monitored";
  for (int n = 0; n < 6; ++n) {
    run.ask(static_cast<size_t>(n % 2), "02 01 05 00 06 3A 98 01 F4");
    run.run(300 * kMillisecond);
    EXPECT_EQ(fault(), 0) << n;
  }
  for (int n = 0; n < 3; ++n) {  // one of two masters goes on
    run.ask(0, "02 01 05 00 06 3A 98 01 F4");
    run.run(300 * kMillisecond);
    EXPECT_EQ(fault(), 0) << n;
  }
  run.run(300 * kMillisecond);
  EXPECT_EQ(fault(), 43);
}

TEST(SerialPlant, SaysWhyProcessDataHaveNoEffect) {
  const std::string po = "02 01 05 00 06 3A 98 01 F4";
  PlantRun deaf(bus("l") + station("a", "md60a", "rs485 = \"l\"\n", "P810 = 1\n"));
  deaf.ask(0, po);
  EXPECT_TRUE(
      deaf.told("the control word has no effect: P101 Control signal source is TERMINALS, not RS-485"));
  EXPECT_TRUE(
      deaf.told("the setpoints have no effect: P100 Setpoint source is BIPOL./FIX.SETPT, not RS-485"));
  PlantRun off(bus("l") +
               station("a", "md60a", "rs485 = \"l\"\n", "P810 = 1\nP100 = 2\nP101 = 1\nP876 = 0\n"));
  off.ask(0, po);
  EXPECT_TRUE(off.told("PO data have no effect: P876 PO data enable is OFF, not ON"));
  PlantRun good(bus("l") + station("a", "md60a", "rs485 = \"l\"\n", "P810 = 1\nP100 = 2\nP101 = 1\n"));
  good.ask(0, po);
  EXPECT_FALSE(good.told("no effect"));
}

// A unit with P812 = 500 ms on X13 that is asked every 110 ms.
TEST(SerialPlant, OnlyValidCyclicRequestsAreMonitored) {
  PROVES("TIME-02");
  const std::string cyclic = "02 01 05 00 06 3A 98 01 F4";
  const std::string acyclic = "02 01 86 31 00 20 7E 00 00 00 00";
  const auto unit = [] {
    return bus("l") + station("a", "md60a", "rs485 = \"l\"\n", "P810 = 1\nP812 = 500\n");
  };
  const auto repeat = [](PlantRun& run, const std::string& text, int times) {
    for (int n = 0; n < times; ++n) run.ask(0, text);
  };
  PlantRun never(unit());
  repeat(never, acyclic, 10);
  never.run(5 * kSecond);
  EXPECT_EQ(never.station(0).fault(), 0) << "acyclic ones start nothing";

  PlantRun once(unit());
  EXPECT_EQ(once.ask(0, cyclic).size(), 1U);
  repeat(once, acyclic, 3);
  EXPECT_EQ(once.station(0).fault(), 0);
  repeat(once, acyclic, 3);
  EXPECT_EQ(once.station(0).fault(), 43) << "nor do they restart it";

  PlantRun broken(unit());
  broken.ask(0, cyclic);
  Bytes wrong = telegram(cyclic);
  wrong.back() ^= 1;
  for (int n = 0; n < 6; ++n) {
    broken.run(100 * kMillisecond);
    broken.hands[0]->send(wrong);
  }
  EXPECT_EQ(broken.station(0).fault(), 43) << "wrong block check";

  PlantRun broadcast(unit());
  const std::string to_all = "02 FF 05 00 06 3A 98 01 F4";
  broadcast.ask(0, cyclic);
  repeat(broadcast, to_all, 20);
  EXPECT_EQ(broadcast.station(0).fault(), 0);
  broadcast.run(600 * kMillisecond);
  EXPECT_EQ(broadcast.station(0).fault(), 43);
}

TEST(SerialPlant, KeypadKeepsTheMonitoringAlive) {
  PROVES("TIME-07", "MDB-PAR-17");
  for (const bool keypad : {true, false}) {
    PlantRun run(bus("l") + station("a", "md60a",
                                    keypad ? "rs485 = \"l\"\nkeypad = true\n" : "rs485 = \"l\"\n",
                                    "P810 = 1\nP812 = 1000\n"));
    EXPECT_EQ(run.told("P812 does not monitor the other RS-485 interface"), keypad);
    run.ask(0, "02 01 05 00 06 3A 98 01 F4");
    run.run(5 * kSecond);  // the master on X13 has stopped
    EXPECT_EQ(run.station(0).fault(), keypad ? 0 : 43);
  }
  const PlantRun quiet(station("a", "md60a", "keypad = true\n", "P812 = 1000\n"));
  EXPECT_TRUE(quiet.plant->journal().entries().empty()) << "nothing else to monitor";
}

const std::string kMasterSlave =
    bus("l") + station("m", "mdxb", "rs485 = \"l\"\nrs485_xt = \"x\"\n", "P810 = 1\nP811 = 101\nP750 = 1\n") +
    bus("x", "baud = 57600\n");

TEST(SerialPlant, MasterOfSetpointsAnswersOnXtOnly) {
  PROVES("MDB-MS-08");
  PlantRun run(kMasterSlave);
  run.run(100 * kMillisecond);
  const auto& setpoints = run.recorders[0]->heard;
  ASSERT_GE(setpoints.size(), 4U);
  for (const Heard& heard : setpoints) EXPECT_EQ(heard.text().substr(0, 8), "02 65 05");
  EXPECT_EQ(run.ask(1, "02 01 81 00 00").size(), 1U) << "XT";
  // Between two setpoints on X13: a request that is heard but not answered, as P750 says.
  for (int n = 0; n < 20; ++n) {
    run.run(37 * kMillisecond);
    run.hands[0]->port.send(telegram("02 01 81 00 00"));
  }
  run.run(100 * kMillisecond);
  for (const Heard& heard : run.recorders[0]->heard)
    if (heard.reception.telegram) {
      EXPECT_FALSE(heard.reception.telegram->response);
    }
  EXPECT_TRUE(run.told("answers no other master"));
}

TEST(SerialPlant, SlaveFollowsItsGroupOnly) {
  PROVES("MDB-MS-05");
  for (const auto& [group, follows] : {std::pair<int, bool>{101, true}, {102, false}}) {
    PlantRun run(bus("l") +
                 station("s", "mdxb", "rs485 = \"l\"\n",
                         "P810 = 2\nP100 = 9\nP811 = " + std::to_string(group) + "\n") +
                 station("m", "mdxb", "rs485 = \"l\"\n", "P810 = 1\nP811 = 101\nP750 = 1\n"));
    EXPECT_EQ(run.told("different group addresses P811"), !follows);
    run.run(kSecond);
    run.plant->all<runtime::SerialBus>()[0]->line().set_connected(1, false);
    run.run(kSecond);
    EXPECT_EQ(run.station(0).fault(), follows ? 43 : 0) << "only who follows misses the master";
  }
  // 100 is no group: the master sends nothing, and both are told.
  PlantRun none(bus("l") + station("s", "mdxb", "rs485 = \"l\"\n", "P810 = 2\nP100 = 9\n") +
                station("m", "mdxb", "rs485 = \"l\"\n", "P810 = 1\nP750 = 1\n"));
  EXPECT_TRUE(none.told("P811 above 100"));
  none.run(kSecond);
  EXPECT_TRUE(none.recorders[0]->characters.empty());
}

TEST(SerialPlant, ConnectionCheckAfter500Milliseconds) {
  PROVES("MDB-MS-06");
  for (const char* p812 : {"0", "200", "650000"}) {
    PlantRun run(bus("l") + station("s", "mdxb", "rs485 = \"l\"\n",
                                    "P810 = 2\nP100 = 9\nP811 = 101\nP812 = " + std::string(p812) + "\n"));
    run.run(2 * kSecond);
    EXPECT_EQ(run.station(0).fault(), 0) << "before the first telegram nothing is missed";
    run.hands[0]->send(telegram("02 65 05 00 06 07 D0 00 00"));
    run.run(100 * kMillisecond);
    const Time last = run.recorders[0]->heard.back().reception.end;
    run.plant->run_until(last + 499 * kMillisecond);
    EXPECT_EQ(run.station(0).fault(), 0) << p812;
    run.plant->run_until(last + 501 * kMillisecond);
    EXPECT_EQ(run.station(0).fault(), 43) << p812;
    // Telegrams every 499 ms keep it up.
    PlantRun steady(bus("l") + station("s", "mdxb", "rs485 = \"l\"\n", "P100 = 9\nP811 = 101\n"));
    for (int n = 0; n < 10; ++n) {
      steady.hands[0]->send(telegram("02 65 05 00 06 07 D0 00 00"));
      steady.run(499 * kMillisecond);
    }
    EXPECT_EQ(steady.station(0).fault(), 0);
  }
}

TEST(SerialPlant, RequestsOfTwoMasters) {
  PlantRun run(bus("l") + station("a", "md60a", "rs485 = \"l\"\n", "P810 = 1\n"));
  HandNode second(run.plant->all<runtime::SerialBus>()[0]->line(), "second");
  run.ask(0, "02 01 81 00 00");
  second.send(telegram("02 01 81 00 00"));
  run.run(100 * kMillisecond);
  EXPECT_TRUE(run.told("hand and second are both masters"));
}

TEST(SerialPlant, RatesOfTheCanInterfaces) {
  UnitInterface drive(*stdlib::find_unit("mdxb"));
  for (const char* parameter : {"P884", "P894"}) {
    for (int code = 0; code <= 3; ++code) EXPECT_FALSE(drive.set_parameter(parameter, code).has_value());
    for (const int code : {-1, 4, 500}) EXPECT_TRUE(drive.set_parameter(parameter, code).has_value());
    const stdlib::Parameter* row = drive.parameters().table().find(parameter);
    std::string rates;
    for (const auto& text : row->texts) rates += std::string(text.text) + " ";
    EXPECT_EQ(rates, "125 250 500 1000 ");
  }
  for (const char* parameter : {"P880", "P890"})
    for (int code = -1; code <= 2; ++code)
      EXPECT_EQ(drive.set_parameter(parameter, code).has_value(), code != 0 && code != 1) << code;
}

TEST(SerialPlant, ReasonsAreTold) {
  PlantRun run(bus("l") + station("a", "md60a", "rs485 = \"l\"\n", "P810 = 1\n"));
  run.ask(0, "02 05 81 00 00");
  EXPECT_TRUE(run.told("RS-485 X13: request to 5 is not for this unit: it has P810 = 1 and P811 = 100"));
  run.ask(0, "02 01 87 00 00");
  EXPECT_TRUE(run.told("RS-485 X13: telegram not accepted: PDU type incorrect"));
  run.ask(0, "02 01 86 32 00 20 7E 00 00 00 01");
  EXPECT_TRUE(run.told("RS-485 X13: refused"));
  run.ask(0, "02 FF 86 31 00 20 7E 00 00 00 01");
  EXPECT_TRUE(run.told("a group parameter telegram can only write"));
}

}  // namespace
}  // namespace ipos::tests
