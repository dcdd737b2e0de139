// Cyclic and acyclic requests at whole units, and what MOVIDRIVE B says about them: telegram by telegram over
// a simulated line.
#include "tests/runtime/bus/rs485/serial_plant_rig.hpp"

#include "stdlib/parameters.hpp"

namespace ipos::tests {
namespace {

std::string unit(const std::string& type, const std::string& parameters) {
  return bus("l") + station("a", type, "rs485 = \"l\"\n", "P810 = 1\n" + parameters);
}

// 1053 1610 p. 35: the sample telegram is acyclic, its cyclic form has TYP 05.
TEST(SerialMonitoring, SampleTelegramCyclicAndAcyclic) {
  PROVES("EX-05");
  EXPECT_EQ(text_of(telegram("02 01 85 00 06 20 00 0B B8")), "02 01 85 00 06 20 00 0B B8 13");
  EXPECT_EQ(text_of(telegram("02 01 05 00 06 20 00 0B B8")), "02 01 05 00 06 20 00 0B B8 93");
  PlantRun run(unit("md60a", "P812 = 500\n"));
  for (int n = 0; n < 5; ++n) {
    EXPECT_EQ(run.ask(0, "02 01 85 00 06 20 00 0B B8").size(), 1U);
    run.run(kSecond);
    EXPECT_EQ(run.station(0).fault(), 0);
  }
  EXPECT_EQ(run.ask(0, "02 01 05 00 06 20 00 0B B8").size(), 1U);
  run.run(300 * kMillisecond);
  EXPECT_EQ(run.station(0).fault(), 0);
  run.run(300 * kMillisecond);
  EXPECT_EQ(run.station(0).fault(), 43);
}

TEST(SerialMonitoring, OnlyCyclicRequestsFeedIt) {
  PROVES("MDB-RS485-32");
  PlantRun run(unit("mdxb", "P812 = 1000\n"));
  // ask() takes 110 ms, so an acyclic request comes about every 100 ms.
  for (int n = 0; n < 30; ++n) run.ask(0, "02 01 85 00 06 20 00 0B B8");
  EXPECT_EQ(run.station(0).fault(), 0) << "acyclic only: never";
  run.ask(0, "02 01 05 00 06 20 00 0B B8");
  const Time cyclic = run.recorders[0]->heard.front().reception.end;
  while (run.plant->now() < cyclic + 880 * kMillisecond) run.ask(0, "02 01 85 00 06 20 00 0B B8");
  run.plant->run_until(cyclic + 999 * kMillisecond);
  EXPECT_EQ(run.station(0).fault(), 0);
  run.plant->run_until(cyclic + 1002 * kMillisecond);
  EXPECT_EQ(run.station(0).fault(), 43);
}

TEST(SerialMonitoring, AcyclicServicesBetweenCyclicTelegrams) {
  PROVES("MDB-RS485-33");
  PlantRun run(unit("mdxb", "P812 = 300\n"));
  for (int n = 0; n < 20; ++n) {
    EXPECT_EQ(run.ask(0, "02 01 05 00 06 20 00 0B B8").size(), 1U);
    const auto read = run.ask(0, "02 01 86 31 00 21 16 00 00 00 00");
    ASSERT_EQ(read.size(), 1U);
    EXPECT_EQ(read[0].substr(0, 35), "1D 01 86 31 00 21 16 00 00 07 D0 4B") << "P130 is 2000";
    EXPECT_EQ(run.value(0, 8456), 0x2000) << "the setpoint stays";
    EXPECT_EQ(run.station(0).fault(), 0);
  }
  // The channel of the cyclic type itself: handshake bit 0 prepares, 1 hands over.
  EXPECT_EQ(run.ask(0, "02 01 04 32 00 21 16 00 00 0B B8 00 06 20 00 0B B8").size(), 1U);
  run.ask(0, "02 01 04 72 00 21 16 00 00 0B B8 00 06 20 00 0B B8");
  EXPECT_EQ(run.value(0, 8470), 3000);
}

TEST(SerialMonitoring, EveryAnswerBeginsWith1D) {
  PROVES("MDB-RS485-14");
  PlantRun run(unit("mdxb", ""));
  const std::string channel = "31 00 21 16 00 00 00 00 ";
  const std::string words[] = {"00 06", "00 06 20 00", "00 06 20 00 0B B8"};
  for (const int cyclic : {0x00, 0x80})
    for (int type = 0; type <= 6; ++type) {
      char head[16];
      std::snprintf(head, sizeof head, "02 01 %02X ", static_cast<unsigned>(cyclic | type));
      std::string pdu = type % 2 == 0 ? channel : "";
      if (type < 6) pdu += words[type / 2];
      const auto heard = run.ask(0, head + pdu);
      ASSERT_EQ(heard.size(), 1U) << head;
      EXPECT_EQ(heard[0].substr(0, 5), "1D 01") << head;
    }
}

// Fault number 43 = 2Bh stands in the high byte of status word 1 (MDX60B/61B section 4.4.1).
TEST(SerialMonitoring, TimeoutIsFault43InTheStatusWord) {
  PROVES("MDB-PAR-18");
  PlantRun run(unit("mdxb", "P812 = 500\nP833 = 2\n"));
  run.ask(0, "02 01 05 00 06 20 00 0B B8");
  run.run(kSecond);
  const auto heard = run.ask(0, "02 01 81 00 00");
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard[0].substr(0, 11), "1D 01 81 2B");
  EXPECT_NE(std::stoi(heard[0].substr(12, 2), nullptr, 16) & 0x20, 0) << "bit 5: fault";
}

// The timeout of P812 is an error of the interface that the cyclic requests came through, and the end of the
// run tells how often each error came.
TEST(SerialMonitoring, TimeoutIsCounted) {
  PlantRun run(unit("mdxb", "P812 = 500\nP833 = 7\n"));
  run.ask(0, "02 01 05 00 06 20 00 0B B8");
  run.run(2 * kSecond);
  run.ask(0, "02 01 05 00 06 20 00 0B B8");
  run.run(2 * kSecond);
  EXPECT_TRUE(run.station(0).store_memory());
  EXPECT_TRUE(run.told("errors so far: RS-485 timeout 2"));
  // Acyclic requests are not monitored.
  PlantRun quiet(unit("mdxb", "P812 = 500\n"));
  quiet.ask(0, "02 01 85 00 06 20 00 0B B8");
  quiet.run(2 * kSecond);
  EXPECT_TRUE(quiet.station(0).store_memory());
  EXPECT_FALSE(quiet.told("errors so far"));
}

TEST(SerialMonitoring, MonitoringBeginsWithTheFirstCyclicRequest) {
  PROVES("MDB-PAR-11");
  const PlantRun fresh(unit("mdxb", ""));
  EXPECT_EQ(fresh.plant->stations()[0]->drive().value("812"), 0);
  UnitInterface drive(*stdlib::find_unit("mdxb"));
  EXPECT_FALSE(drive.set_parameter("P812", 650'000).has_value());
  EXPECT_TRUE(drive.set_parameter("P812", 650'010).has_value());
  PlantRun run(unit("mdxb", "P812 = 2000\n"));
  run.run(10 * kSecond);
  EXPECT_EQ(run.station(0).fault(), 0) << "without any cyclic frame";
  run.ask(0, "02 01 05 00 06 20 00 0B B8");
  const Time cyclic = run.recorders[0]->heard.front().reception.end;
  run.plant->run_until(cyclic + 1999 * kMillisecond);
  EXPECT_EQ(run.station(0).fault(), 0);
  run.plant->run_until(cyclic + 2002 * kMillisecond);
  EXPECT_EQ(run.station(0).fault(), 43);
}

// A hand turns S13 while the plant runs: the telegram before is answered at 57.6, the next one at 9.6 kbaud.
TEST(SerialMonitoring, SwitchS13ActsAtOnce) {
  PROVES("MDB-RS485-03");
  PlantRun run(bus("x", "baud = 57600\n") + station("a", "mdxb", "rs485_xt = \"x\"\n", "P810 = 1\n"));
  Rs485Line& line = run.plant->all<runtime::SerialBus>()[0]->line();
  HandNode slow(line, "slow", 9'600);
  EXPECT_EQ(line.node_baud(0), 57'600U) << "factory setting";
  EXPECT_EQ(run.ask(0, "02 01 81 00 00").size(), 1U);
  EXPECT_EQ(run.station(0).switch_value(runtime::StationSwitch::S13), 0);
  EXPECT_EQ(run.station(0).set_switch(runtime::StationSwitch::S13, 1), std::nullopt);
  EXPECT_EQ(run.station(0).switch_value(runtime::StationSwitch::S13), 1);
  slow.receptions.clear();
  slow.send(telegram("02 01 81 00 00"));
  run.run(100 * kMillisecond);
  ASSERT_EQ(slow.receptions.size(), 1U);
  ASSERT_TRUE(slow.receptions[0].telegram);
  EXPECT_TRUE(slow.receptions[0].telegram->response);
  EXPECT_NEAR(static_cast<double>(slow.receptions[0].end - slow.receptions[0].start), 6 * 11e9 / 9600, 2);
}

// 1053 1610 p. 32: 3000 with quantity 4 and conversion -3 is 3 s; P131 is the ramp down, clockwise.
TEST(SerialMonitoring, RampOfTheExample) {
  PROVES("EX-07");
  const stdlib::Parameter* row = stdlib::parameter_table(*stdlib::find_unit("md60a")).find(uint16_t{8471});
  ASSERT_NE(row, nullptr);
  EXPECT_EQ(row->name, "Ramp t11 DOWN CW");
  EXPECT_EQ(row->number, "131");
  EXPECT_EQ(row->quantity, 4);
  EXPECT_EQ(row->conversion, -3);
  EXPECT_EQ(stdlib::parameter_text(*row, 3000), "3.000 s");
  PlantRun run(unit("md60a",
                    "P100 = 2\nP101 = 1\nP301 = 0\nP130 = 500\nP323 = 0\n"
                    "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n"));
  EXPECT_EQ(run.ask(0, "02 01 86 32 00 21 17 00 00 0B B8").at(0).substr(0, 11), "1D 01 86 32");
  EXPECT_EQ(run.value(0, 8471), 3000);
  const auto rpm = [&] { return run.value(0, 8318) / 1000; };  // P000, 0.001 rpm
  run.ask(0, "02 01 85 00 06 13 88 00 00");                    // 5000 digits: 1000 rpm
  run.run(3 * kSecond);
  ASSERT_NEAR(rpm(), 1000, 5);
  run.hands[0]->send(telegram("02 01 85 00 06 00 00 00 00"));
  run.run(wire_time(10, 9600));
  // 3 s for 3000 rpm: 1000 rpm fall within 1 s.
  run.run(250 * kMillisecond);
  EXPECT_NEAR(rpm(), 750, 15);
  run.run(500 * kMillisecond);
  EXPECT_NEAR(rpm(), 250, 15);
}

const std::string kFollower =
    "P100 = 9\nP811 = 101\nP301 = 0\nP130 = 100\nP323 = 0\nP136 = 500\nP137 = 1500\n";

// MDX60B/61B section 4.4.1: the stop after 500 ms is that of the emergency ramp P137.
TEST(SerialMonitoring, LostMasterStopsOnTheEmergencyRamp) {
  PROVES("MDB-MS-07");
  PlantRun run(unit("mdxb", kFollower + "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n"));
  const auto rpm = [&] { return run.value(0, 8318) / 1000; };
  Time last = 0;
  for (int n = 0; n < 10; ++n) {
    run.hands[0]->send(telegram("02 65 05 00 06 13 88 00 00"));
    run.run(100 * kMillisecond);
    last = run.hands[0]->sent.back();
  }
  ASSERT_NEAR(rpm(), 1000, 10);
  run.plant->run_until(last + 500 * kMillisecond);
  EXPECT_NEAR(rpm(), 1000, 10);
  // 1.5 s for 3000 rpm: 500 rpm within 250 ms; on P136 it would stand after 167 ms.
  run.plant->run_until(last + 750 * kMillisecond);
  EXPECT_NEAR(rpm(), 500, 20);
  EXPECT_EQ(run.station(0).fault(), 43);
  run.run(kSecond);
  EXPECT_EQ(rpm(), 0);
}

TEST(SerialMonitoring, AFollowerNeedsItsTerminals) {
  PROVES("MDB-MS-10");
  const std::string levels[] = {"DI00 = 1\nDI01 = 1\nDI03 = 1\n", "DI00 = 0\nDI01 = 1\nDI03 = 1\n",
                                "DI00 = 1\nDI01 = 0\nDI03 = 1\n", "DI00 = 1\nDI01 = 1\nDI03 = 0\n"};
  for (size_t n = 0; n < std::size(levels); ++n) {
    PlantRun run(unit("mdxb", kFollower + "[station.inputs]\n" + levels[n]));
    for (int k = 0; k < 10; ++k) {
      run.hands[0]->send(telegram("02 65 05 00 06 13 88 00 00"));
      run.run(100 * kMillisecond);
    }
    const int32_t rpm = run.value(0, 8318) / 1000;
    EXPECT_NEAR(rpm, n == 0 ? 1000 : 0, 10) << levels[n];
    // Controller inhibit is condition 1 (1053 1610 p. 41).
    if (n == 1) {
      EXPECT_EQ(run.value(0, 8310) >> 8 & 0xFF, 1);
    }
  }
}

}  // namespace
}  // namespace ipos::tests
