// The slave: addresses, groups, answers and their times, parameter channel with and without handshake.
#include "runtime/bus/movilink/serial_slave.hpp"

#include "tests/runtime/bus/rs485/serial_rig.hpp"

namespace ipos::tests {
namespace {

// A line with a hand-driven master and some units.
struct Bus {
  EventQueue queue;
  Rs485Line line{queue, 99, "line1", 9600};
  Recorder recorder;
  HandNode hand{line, "master"};
  std::vector<std::unique_ptr<SlaveNode>> units;

  Bus() { line.add_observer(recorder); }
  SlaveNode& add(SerialSlaveSettings settings, SerialSlaveTiming timing = {}) {
    const auto source = static_cast<uint32_t>(units.size() + 1);
    units.push_back(
        std::make_unique<SlaveNode>(queue, source, line, "unit" + std::to_string(source), settings, timing));
    return *units.back();
  }
  // Sends a request after a long pause; the telegrams heard until 80 ms later, without the request.
  std::vector<std::string> ask(const std::string& text) {
    queue.run_until(queue.now() + 20 * kMillisecond);
    recorder.clear();
    hand.receptions.clear();
    hand.send(telegram(text));
    queue.run_until(queue.now() + 80 * kMillisecond);
    std::vector<std::string> heard = recorder.all();
    EXPECT_FALSE(heard.empty());
    heard.erase(heard.begin());
    return heard;
  }
};

const std::vector<std::string> kNothing;

TEST(SerialSlave, EachAnswersItsOwnAddress) {
  PROVES("RS485-08", "MDB-RS485-16", "MDB-RS485-18");
  Bus bus;
  for (const uint8_t address : std::initializer_list<uint8_t>{1, 3, 12}) bus.add({address});
  for (const char* address : {"0C", "03", "01"}) {
    const auto heard = bus.ask("02 " + std::string(address) + " 05 00 06 3A 98 01 F4");
    ASSERT_EQ(heard.size(), 1U);
    EXPECT_EQ(heard[0], text_of(telegram("1D " + std::string(address) + " 05 04 07 3A 98 00 00")));
    EXPECT_EQ(bus.recorder.heard[1].reception.telegram->address, hex(address)[0]);
  }
  for (const auto& unit : bus.units) EXPECT_EQ(unit->unit.channels.size(), 1U);
  EXPECT_EQ(bus.ask("02 05 05 00 06 3A 98 01 F4"), kNothing);
}

TEST(SerialSlave, PauseBeforeTheResponse) {
  PROVES("RS485-05");
  Bus bus;
  bus.add({1});
  for (int type = 0; type <= 6; ++type)
    for (const int acyclic : {0, 0x80}) {
      const SerialBytes request = encode(SerialTelegram{false, 1, *telegram_format(type | acyclic), {}, {}});
      bus.ask(text_of(request.span().first(request.size - 1U)));
      ASSERT_EQ(bus.recorder.heard.size(), 2U);
      const Time pause = bus.recorder.heard[1].reception.start - bus.recorder.heard[0].reception.end;
      EXPECT_GE(pause, 3'440'000);
      EXPECT_LE(pause, 50'000'000);
    }
}

TEST(SerialSlave, EveryTypeIsAnswered) {
  PROVES("RS485-22");
  Bus bus;
  SlaveNode& unit = bus.add({1});
  for (int type = 0; type <= 6; ++type)
    for (const int acyclic : {0, 0x80}) {
      const SerialBytes request = encode(SerialTelegram{false, 1, *telegram_format(type | acyclic), {}, {}});
      EXPECT_EQ(bus.ask(text_of(request.span().first(request.size - 1U))).size(), 1U);
    }
  EXPECT_EQ(bus.ask("02 01 86 31 00 20 7E 00 00 00 00"),
            std::vector<std::string>{"1D 01 86 31 00 20 7E 00 0F 42 40 F8"});
  bus.ask("02 01 86 32 00 21 16 00 00 09 C4");
  EXPECT_EQ(unit.unit.parameters[8470], 2500);
}

TEST(SerialSlave, ReadOfADriveAt1000Rpm) {
  PROVES("EX-09");
  Bus bus;
  bus.add({1});
  EXPECT_EQ(text_of(telegram("02 01 86 31 00 20 7E 00 00 00 00")), "02 01 86 31 00 20 7E 00 00 00 00 EA");
  EXPECT_EQ(bus.ask("02 01 86 31 00 20 7E 00 00 00 00"),
            std::vector<std::string>{"1D 01 86 31 00 20 7E 00 0F 42 40 F8"});
}

TEST(SerialSlave, Groups) {
  PROVES("RS485-09", "MDB-RS485-20");
  Bus bus;
  for (const uint8_t address : std::initializer_list<uint8_t>{1, 2, 3, 4}) bus.add({address, 101});
  for (const uint8_t address : std::initializer_list<uint8_t>{5, 6}) bus.add({address, 102});
  // Write P130 := 2500 to group 101, in an acyclic and by the handshake in a cyclic telegram; then setpoints.
  EXPECT_EQ(bus.ask("02 65 86 32 00 21 16 00 00 09 C4"), kNothing);
  for (size_t n = 0; n < 6; ++n) EXPECT_EQ(bus.units[n]->unit.parameters[8470], n < 4 ? 2500 : 2000);
  EXPECT_EQ(bus.ask("02 66 06 72 00 21 16 00 00 0B B8"), kNothing);
  for (size_t n = 0; n < 6; ++n) EXPECT_EQ(bus.units[n]->unit.parameters[8470], n < 4 ? 2500 : 3000);
  EXPECT_EQ(bus.ask("02 65 05 00 06 07 D0 00 00"), kNothing);
  for (size_t n = 0; n < 6; ++n)
    EXPECT_EQ(bus.units[n]->unit.output, n < 4 ? (ProcessWords{6, 2000, 0}) : ProcessWords{});
  // A read gives nothing, and a refused write says why to those who ask.
  const size_t before = bus.units[0]->unit.requests.size();
  EXPECT_EQ(bus.ask("02 65 86 31 00 20 7E 00 00 00 00"), kNothing);
  EXPECT_EQ(bus.units[0]->unit.requests.size(), before);
  EXPECT_EQ(bus.units[0]->unit.ignored.back(), Ignored::GroupService);
  EXPECT_EQ(bus.ask("02 65 86 32 00 20 7E 00 00 00 00"), kNothing);
  EXPECT_EQ(bus.units[3]->unit.ignored.back(), Ignored::GroupRefused);
  EXPECT_EQ(bus.units[3]->unit.last_code, return_codes::kReadOnly);
}

TEST(SerialSlave, Group100IsNoGroup) {
  PROVES("MDB-RS485-19");
  Bus bus;
  SlaveNode& unit = bus.add({1, 100});
  EXPECT_EQ(bus.ask("02 64 86 32 00 21 16 00 00 09 C4"), kNothing);
  EXPECT_EQ(bus.ask("02 64 05 00 06 07 D0 00 00"), kNothing);
  EXPECT_TRUE(unit.unit.untouched());
  EXPECT_EQ(unit.unit.parameters[8470], 2000);
}

TEST(SerialSlave, UniversalAddress) {
  PROVES("RS485-11", "MDB-RS485-21");
  Bus one;
  one.add({47});
  EXPECT_EQ(one.ask("02 FE 05 00 06 3A 98 01 F4"),
            std::vector{text_of(telegram("1D FE 05 04 07 3A 98 00 00"))});
  EXPECT_TRUE(one.recorder.events.empty());
  Bus two;
  two.add({1});
  two.add({2}).unit.inputs = {0x0202, 0x1388, 0x55AA};
  two.ask("02 FE 05 00 06 3A 98 01 F4");
  ASSERT_EQ(two.recorder.events.size(), 1U);
  EXPECT_EQ(two.recorder.events[0].kind, SerialEventKind::Collision);
  for (const Reception& reception : two.hand.receptions) EXPECT_FALSE(reception.telegram.has_value());
  EXPECT_FALSE(two.hand.receptions.empty());
  // A master takes an answer with 254 and one with the unit's own address.
  for (const char* address : {"FE", "11", "63", "64", "FF"}) {
    EventQueue queue;
    Rs485Line line(queue, 1, "line1", 9600);
    RequestNode master(queue, 2, line, "master", {.repeats = 0});
    HandNode slave(line, "slave");
    master.requester.start(0, {false, 254, kSetpointFormat, {}, {}}, master);
    queue.run_until(wire_time(10, 9600) + 5 * kMillisecond);
    slave.send(telegram("1D " + std::string(address) + " 05 00 06 3A 98 01 F4"));
    queue.run_until(kSecond);
    const bool good = hex(address)[0] == 254 || hex(address)[0] <= 99;
    EXPECT_EQ(master.ends, std::vector{good ? RequestEnd::Answered : RequestEnd::NoResponse}) << address;
  }
}

TEST(SerialSlave, BroadcastReachesAllAndIsNotAnswered) {
  PROVES("RS485-13");
  Bus bus;
  for (const uint8_t address : std::initializer_list<uint8_t>{1, 2, 3}) bus.add({address});
  EXPECT_EQ(bus.ask("02 FF 05 00 06 3A 98 01 F4"), kNothing);
  for (const auto& unit : bus.units) {
    EXPECT_EQ(unit->unit.output, (ProcessWords{6, 0x3A98, 0x01F4}));
    EXPECT_EQ(unit->unit.channels, std::vector{OutputChannel::Group});
    EXPECT_EQ(unit->unit.cyclic.size(), 1U);
  }
}

TEST(SerialSlave, LocalAddressFromTheLineIsNotAnswered) {
  PROVES("RS485-12");
  Bus bus;
  SlaveNode& unit = bus.add({1});
  EXPECT_EQ(bus.ask("02 FD 86 31 00 20 7E 00 00 00 00"), kNothing);
  EXPECT_TRUE(unit.unit.untouched());
  EXPECT_EQ(unit.unit.rejected, std::vector{SerialError::Address});
}

TEST(SerialSlave, ShorterTypesLeaveTheOtherWords) {
  Bus bus;
  SlaveNode& unit = bus.add({1});
  bus.ask("02 01 05 00 06 3A 98 01 F4");
  EXPECT_EQ(bus.ask("02 01 01 00 02"), std::vector{text_of(telegram("1D 01 01 04 07"))});
  EXPECT_EQ(unit.unit.output, (ProcessWords{2, 0x3A98, 0x01F4}));
}

TEST(SerialSlave, CyclicRequestsAreTold) {
  Bus bus;
  SlaveNode& unit = bus.add({1, 101});
  bus.ask("02 01 85 00 06 3A 98 01 F4");
  bus.ask("02 01 86 31 00 20 7E 00 00 00 00");
  EXPECT_TRUE(unit.unit.cyclic.empty()) << "acyclic requests are not monitored";
  bus.ask("02 01 05 00 06 3A 98 01 F4");
  const Time end = bus.recorder.heard[0].reception.end;
  EXPECT_EQ(unit.unit.cyclic, std::vector{end});
  bus.ask("02 01 06 30 00 00 00 00 00 00 00");
  bus.ask("02 65 01 00 06");
  bus.ask("02 FF 03 00 06 00 00");
  EXPECT_EQ(unit.unit.cyclic.size(), 4U);
  bus.ask("02 02 05 00 06 3A 98 01 F4");
  bus.ask("1D 01 05 00 06 3A 98 01 F4");
  EXPECT_EQ(unit.unit.cyclic.size(), 4U);
}

std::string channel(const std::string& management, const std::string& rest = "00 21 16 00 00 09 C4") {
  return "02 01 06 " + management + " " + rest;
}

TEST(SerialSlave, HandshakeRunsEachServiceOnce) {
  PROVES("MLK-04", "MLK-09");
  Bus bus;
  SlaveNode& unit = bus.add({1});
  // A fresh unit: bit 0 is not executed, bit 1 is.
  for (int n = 0; n < 10; ++n) {
    EXPECT_EQ(bus.ask(channel("32")), std::vector{text_of(telegram("1D 01 06 32 00 21 16 00 00 09 C4"))});
  }
  EXPECT_TRUE(unit.unit.requests.empty());
  EXPECT_EQ(unit.unit.parameters[8470], 2000);
  for (int n = 0; n < 10; ++n) {
    char low[4];
    std::snprintf(low, sizeof low, "%02X", n);
    const std::string value = "00 21 16 00 00 00 " + std::string(low);
    const std::string management = n % 2 == 0 ? "72" : "32";
    for (int repeat = 0; repeat < 3; ++repeat)
      EXPECT_EQ(bus.ask(channel(management, value)),
                std::vector{text_of(telegram("1D 01 06 " + management + " " + value))});
    EXPECT_EQ(unit.unit.requests.size(), static_cast<size_t>(n + 1));
    EXPECT_EQ(unit.unit.parameters[8470], n);
  }
  // A cyclic type with process data in the same way.
  bus.ask("02 01 04 72 00 21 16 00 00 00 63 00 06 00 00 00 00");
  bus.ask("02 01 04 72 00 21 16 00 00 00 64 00 06 00 00 00 00");
  EXPECT_EQ(unit.unit.parameters[8470], 0x63);
}

TEST(SerialSlave, OldBitUntilTheServiceIsDone) {
  PROVES("EX-06", "MLK-10");
  Bus bus;
  SlaveNode& unit = bus.add({1}, {4 * kMillisecond, 150 * kMillisecond});
  const auto answer = [&](const std::string& management) {
    const auto heard = bus.ask(channel(management));
    return heard.empty() ? "" : heard[0].substr(9, 2);
  };
  EXPECT_EQ(answer("32"), "32");  // preparing
  EXPECT_EQ(answer("72"), "32");  // being processed; a request takes 100 ms here
  EXPECT_EQ(answer("72"), "32");
  EXPECT_EQ(answer("72"), "72");  // done
  EXPECT_EQ(answer("72"), "72");
  EXPECT_EQ(unit.unit.requests.size(), 1U);
  EXPECT_EQ(answer("32"), "72");  // the next job goes back to 32
  EXPECT_EQ(answer("32"), "72");
  EXPECT_EQ(answer("32"), "32");
  EXPECT_EQ(unit.unit.requests.size(), 2U);
  // Status and data are valid in the acknowledgement only.
  const std::string read_only = "00 20 7E 00 00 00 01";
  EXPECT_EQ(bus.ask(channel("72", read_only)), std::vector{text_of(telegram("1D 01 06 32 " + read_only))});
  EXPECT_EQ(bus.ask(channel("72", read_only)), std::vector{text_of(telegram("1D 01 06 32 " + read_only))});
  EXPECT_EQ(bus.ask(channel("72", read_only)),
            std::vector{text_of(telegram("1D 01 06 F2 00 20 7E 08 00 00 12"))});
}

TEST(SerialSlave, AcyclicTypesAlwaysRun) {
  PROVES("MLK-11");
  Bus bus;
  SlaveNode& unit = bus.add({1});
  for (const int value : {11, 22, 33}) {
    unit.unit.parameters[8470] = value;
    char low[4];
    std::snprintf(low, sizeof low, "%02X", value);
    EXPECT_EQ(bus.ask("02 01 86 31 00 21 16 00 00 00 00"),
              std::vector{text_of(telegram("1D 01 86 31 00 21 16 00 00 00 " + std::string(low)))});
  }
  EXPECT_EQ(bus.ask("02 01 86 71 00 20 7E FF FF FF FF"),
            std::vector{text_of(telegram("1D 01 86 71 00 20 7E 00 0F 42 40"))});
}

TEST(SerialSlave, AMasterOfSetpointsAnswersNobodyHere) {
  Bus bus;
  SlaveNode& unit = bus.add({1, 101, true});
  EXPECT_EQ(bus.ask("02 01 05 00 06 3A 98 01 F4"), kNothing);
  EXPECT_EQ(bus.ask("02 01 86 31 00 20 7E 00 00 00 00"), kNothing);
  EXPECT_TRUE(unit.unit.untouched());
  EXPECT_EQ(unit.unit.ignored, (std::vector{Ignored::MasterHere, Ignored::MasterHere}));
}

TEST(SerialSlave, ConnectionToTheMaster) {
  SlaveBench bench({1, 101, false, true});
  bench.feed(telegram("02 65 05 00 06 07 D0 00 00"), 10 * kMillisecond);
  const Time end = bench.queue.now();
  EXPECT_EQ(bench.unit.setpoint, (ProcessWords{6, 2000, 0}));
  EXPECT_TRUE(bench.unit.untouched()) << "not as process data of a controller";
  bench.queue.run_until(end + 499 * kMillisecond);
  EXPECT_TRUE(bench.unit.lost.empty());
  bench.queue.run_until(end + 501 * kMillisecond);
  EXPECT_EQ(bench.unit.lost, std::vector{end + 500 * kMillisecond});
  bench.queue.run_until(end + 5 * kSecond);
  EXPECT_EQ(bench.unit.lost.size(), 1U) << "once";
  // Other telegrams do not keep the connection alive; a parameter telegram is served as always.
  bench.quiet_since = bench.queue.now();
  bench.feed(telegram("02 65 05 00 06 07 D0 00 00"), 0);
  for (int n = 0; n < 7; ++n) {
    bench.feed(telegram("02 01 86 31 00 20 7E 00 00 00 00"), 10 * kMillisecond);
    EXPECT_EQ(bench.answers().size(), 1U);
  }
  EXPECT_EQ(bench.unit.lost.size(), 2U);
}

// Only the cyclic telegram of three words to its group is the master's setpoint (MDX60B/61B p. 29); all others are what
// they are to any slave.
TEST(SerialSlave, WhatIsNotTheMastersSetpoint) {
  struct Row {
    const char* request;
    bool setpoint;
    size_t answers;
  };
  const Row rows[] = {{"02 65 05 00 06 07 D0 00 09", true, 0},  {"02 65 85 00 06 07 D0 00 09", false, 0},
                      {"02 65 03 00 06 07 D0", false, 0},       {"02 01 05 00 06 07 D0 00 09", false, 1},
                      {"02 FF 05 00 06 07 D0 00 09", false, 0}, {"02 FE 05 00 06 07 D0 00 09", false, 1}};
  for (const Row& row : rows)
    for (const bool follows : {true, false}) {
      SlaveBench bench({1, 101, false, follows});
      bench.feed(telegram(row.request), 10 * kMillisecond);
      const bool setpoint = row.setpoint && follows;
      EXPECT_EQ(bench.unit.setpoints.size(), setpoint ? 1U : 0U) << row.request;
      EXPECT_EQ(bench.unit.channels.size(), setpoint ? 0U : 1U) << row.request;
      EXPECT_EQ(bench.answers().size(), row.answers) << row.request;
      bench.queue.run_until(kSecond);
      EXPECT_EQ(bench.unit.lost.size(), setpoint ? 1U : 0U) << row.request;
      EXPECT_EQ(bench.slave.statistics().of(SerialError::Timeout), setpoint ? 1U : 0U);
      // The timeout of P812 is counted where a cyclic request was heard that is no setpoint.
      bench.slave.count_timeout();
      const bool cyclic = !setpoint && (hex(row.request)[2] & 0x80) == 0;
      EXPECT_EQ(bench.slave.statistics().of(SerialError::Timeout), setpoint || cyclic ? 1U : 0U)
          << row.request;
    }
  // Who follows no more by then has lost nobody.
  SlaveBench bench({1, 101, false, true});
  bench.feed(telegram("02 65 05 00 06 07 D0 00 00"), 10 * kMillisecond);
  bench.slave.configure({1, 101, false, false});
  bench.queue.run_until(kSecond);
  EXPECT_TRUE(bench.unit.lost.empty());
  EXPECT_EQ(bench.slave.statistics().of(SerialError::Timeout), 0U);
}

TEST(SerialSlave, AnAnswerComesAfterItsDelayAndTakesTheInputOfThatMoment) {
  SlaveBench bench({1}, {7 * kMillisecond, 0});
  bench.feed(telegram("02 01 05 00 06 07 D0 00 00"), 10 * kMillisecond);
  const Time end = bench.queue.now();
  bench.queue.run_until(end + 7 * kMillisecond - 1);
  EXPECT_TRUE(bench.wire.sent.empty());
  bench.unit.inputs = {1, 2, 3};
  bench.queue.run_until(end + 7 * kMillisecond);
  EXPECT_EQ(bench.wire.sent, std::vector<Bytes>{telegram("1D 01 05 00 01 00 02 00 03")});
  EXPECT_EQ(bench.wire.times, std::vector{end + 7 * kMillisecond});
  // The master has not waited: one answer, to the second request.
  SlaveBench hasty({1}, {20 * kMillisecond, 0});
  hasty.feed(telegram("02 01 05 00 06 07 D0 00 00"), 10 * kMillisecond);
  hasty.feed(telegram("02 01 81 00 02"), 4 * kMillisecond);
  const Time second = hasty.queue.now();
  hasty.queue.run_until(kSecond);
  EXPECT_EQ(hasty.wire.sent, std::vector<Bytes>{telegram("1D 01 81 04 07")});
  EXPECT_EQ(hasty.wire.times, std::vector{second + 20 * kMillisecond});
}

// What cannot be done for a group is told; to a single address it is the answer that says so.
TEST(SerialSlave, ReasonsInGroupsAndAnswersElsewhere) {
  struct Row {
    const char* channel;
    std::vector<Ignored> group;
  };
  const Row rows[] = {{"70 00 21 16 00 00 00 01", {}},
                      {"71 00 21 16 00 00 00 01", {Ignored::GroupService}},
                      {"7F 00 21 16 00 00 00 01", {Ignored::GroupService}},
                      {"72 00 21 16 00 00 00 01", {}},
                      {"73 00 20 7E 00 00 00 01", {Ignored::GroupRefused}},
                      {"62 00 21 16 00 00 00 01", {Ignored::GroupRefused}}};
  for (const Row& row : rows)
    for (const char* type : {" 06 ", " 86 "}) {
      SlaveBench group({1, 101});
      group.feed(telegram("02 65" + std::string(type) + row.channel), 10 * kMillisecond);
      EXPECT_EQ(group.unit.ignored, row.group) << row.channel << type;
      EXPECT_TRUE(group.answers().empty());
      // A repeated cyclic request is not carried out again.
      group.feed(telegram("02 65" + std::string(type) + row.channel), 10 * kMillisecond);
      const bool again = std::string(type) == " 86 " || row.group == std::vector{Ignored::GroupService};
      EXPECT_EQ(group.unit.ignored.size(), row.group.size() * (again ? 2 : 1)) << row.channel << type;
      SlaveBench single({1, 101});
      single.feed(telegram("02 01" + std::string(type) + row.channel), 10 * kMillisecond);
      EXPECT_TRUE(single.unit.ignored.empty());
      EXPECT_EQ(single.answers().size(), 1U);
    }
  // An acyclic write to the group leaves the answer of a single request alone.
  SlaveBench bench({1, 101}, {30 * kMillisecond, 0});
  bench.feed(telegram("02 01 86 31 00 21 16 00 00 00 00"), 10 * kMillisecond);
  bench.feed(telegram("02 65 86 32 00 20 7E 00 00 00 01"), 4 * kMillisecond);
  EXPECT_EQ(bench.answers(), std::vector<Bytes>{telegram("1D 01 86 31 00 21 16 00 00 07 D0")});
}

TEST(SerialSlave, ItsOwnEchoIsNoRequest) {
  SlaveBench bench({1});
  bench.slave.on_sent(kSecond);
  Time at = kSecond - 3 * kMillisecond;
  for (const uint8_t byte : hex("02 01 01")) {
    bench.slave.on_character(at + kMillisecond, {at, at + kMillisecond, byte, false, false});
    at += kMillisecond;
  }
  EXPECT_TRUE(bench.unit.rejected.empty());
  // From its end on it hears again, after a pause.
  bench.quiet_since = kSecond;
  bench.feed(telegram("02 01 01 00 06"), kStartPause);
  EXPECT_EQ(bench.answers().size(), 1U);
  EXPECT_TRUE(bench.unit.rejected.empty());
}

}  // namespace
}  // namespace ipos::tests
