// MOVIDRIVE B: both SBus lines, receive flags, second parameter channel, _SBusCommState; limits of each unit
// type.
#include <gtest/gtest.h>

#include "tests/harness/proves.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

std::string second_bus() { return "[[bus]]\nname = \"sbus2\"\nkind = \"can\"\nbaud = 500000\n"; }

std::string two_lines() {
  return bus_text() + second_bus() +
         station_text("both", "P881 = 1\nP891 = 7\n", "mdxb", "A.IPC", "sbus2 = \"sbus2\"\n") +
         station_text("first", "P881 = 2\n", "mdxb", "B.IPC") +
         "[[station]]\nname = \"second\"\nunit = \"mdxb\"\nsbus2 = \"sbus2\"\nprogram = \"C.IPC\"\n"
         "[station.parameters]\nP891 = 8\n";
}

// Sends 1024 with lData every 10 ms and receives 1025 into lGot, on SBus 1 or 2.
std::string talk(const std::string& bus, int send, int receive, int value) {
  return "SCTRCYCL Tr" + bus + "; SCREC Rec" + bus + "; long lData" + bus + ", lGot" + bus + ";\nDefine" +
         bus + "()\n{\n lData" + bus + " = " + std::to_string(value) + ";\n Tr" + bus +
         ".ObjectNo = SCD_SBUS" + bus + " + " + std::to_string(send) + "; Tr" + bus + ".CycleTime = 10; Tr" +
         bus + ".Offset = 0; Tr" + bus + ".Format = 4; Tr" + bus + ".DPointer = numof(lData" + bus +
         ");\n Rec" + bus + ".ObjectNo = SCD_SBUS" + bus + " + " + std::to_string(receive) + "; Rec" + bus +
         ".Format = 4; Rec" + bus + ".DPointer = numof(lGot" + bus + ");\n _SBusCommDef(SCD_TRCYCL, Tr" +
         bus + ");\n _SBusCommDef(SCD_REC, Rec" + bus + ");\n}\n";
}

const std::map<std::string, std::string> kSources = {
    {"A.IPC", "#include <constb.h>\n" + talk("1", 1024, 1025, 11) + talk("2", 1024, 1025, 22) +
                  "main() { Define1(); Define2(); _SBusCommOn(); while (1) {} }\n"},
    {"B.IPC", "#include <constb.h>\n" + talk("1", 1025, 1024, 33) +
                  "main() { Define1(); _SBusCommOn(); while (1) {} }\n"},
    {"C.IPC", "#include <constb.h>\n" + talk("2", 1025, 1024, 44) +
                  "main() { Define2(); _SBusCommOn(); while (1) {} }\n"}};

TEST(Sbus2, ObjectsGoToTheLineOfBit24) {
  PROVES("MDB-TOC-21");
  PlantRig rig(two_lines(), kSources);
  ASSERT_TRUE(rig.errors.empty()) << rig.errors[0];
  rig.run_until(100 * kMillisecond);
  EXPECT_EQ(rig.variable(0, "lGot1"), 33);
  EXPECT_EQ(rig.variable(0, "lGot2"), 44);
  EXPECT_EQ(rig.variable(1, "lGot1"), 11);
  EXPECT_EQ(rig.variable(2, "lGot2"), 22);
  EXPECT_GE(rig.variable(0, "Tr2.Result"), 0);
  EXPECT_EQ(rig.journal(), "");
}

TEST(Sbus2, ReceptionIsFlaggedInH522AndH523) {
  PlantRig rig(two_lines(), kSources);
  rig.run_until(100 * kMillisecond);
  EXPECT_EQ(rig.variable(0, "H522"), 1);
  EXPECT_EQ(rig.variable(0, "H523"), 1);
  EXPECT_EQ(rig.variable(1, "H522"), 1);
  EXPECT_EQ(rig.variable(1, "H523"), 0);
  EXPECT_EQ(rig.variable(2, "H523"), 1);
}

TEST(Sbus2, MovlnkWithBusType8) {
  const std::string program =
      "#include <constb.h>\nMOVLNK Ml; MLDATA Mld; long lFirst;\nmain()\n{\n Ml.Format = 6; Ml.Service = 1; "
      "Ml.Index = "
      "8600; Ml.DPointer = numof(Mld); Ml.BusType = 5; Ml.Address = 2; _MoviLink(Ml);\n lFirst = "
      "Mld.ReadPar; "
      "Ml.BusType = 8; Ml.Address = 8; Ml.Index = 8932; _MoviLink(Ml);\n while (1) {}\n}\n";
  std::map<std::string, std::string> sources = kSources;
  sources["A.IPC"] = program;
  PlantRig rig(two_lines(), sources);
  rig.run_until(100 * kMillisecond);
  EXPECT_EQ(rig.variable(0, "Ml.Result"), 0);
  EXPECT_EQ(rig.variable(0, "lFirst"), 2);       // P881 of "first"
  EXPECT_EQ(rig.variable(0, "Mld.ReadPar"), 8);  // P891 of "second"
}

TEST(Sbus2, OnlyMovidriveBHasIt) {
  PlantRig rig(bus_text() + second_bus() + station_text("a", "", "md60a", "", "sbus2 = \"sbus2\"\n"));
  ASSERT_EQ(rig.errors.size(), 1U);
  EXPECT_NE(rig.errors[0].find("unit md60a has no SBus 2"), std::string::npos);
  // Objects for SBus 2 of a unit that is not on it are refused.
  PlantRig alone(
      bus_text() + station_text("a", "P881 = 1\n", "mdxb", "C.IPC") + station_text("b", "P881 = 2\n", "mdxb"),
      kSources);
  alone.run_until(50 * kMillisecond);
  EXPECT_TRUE(alone.frames.empty());
  EXPECT_EQ(alone.variable(0, "Tr2.Result"), -1);
  EXPECT_EQ(alone.says("a: object 401h (1025) is for SBus 2, which the station is not on"), 1U);
}

TEST(Sbus2, SecondParameterChannel) {
  PROVES("MDB-TOC-04");
  class Hand final : public CanNode {
   public:
    void on_frame(Time, const Frame& frame) override { frames.push_back(frame); }
    void on_sent(Time, const Frame&, uint64_t) override {}
    void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
    std::vector<Frame> frames;
  } hand;
  for (const bool on : {false, true}) {
    PlantRig rig(bus_text() +
                 station_text("a", std::string("P881 = 1\nP882 = 2\n") + (on ? "P889 = 1\n" : ""), "mdxb"));
    CanLine& line = rig.plant->all<runtime::CanBus>()[0]->line();
    LinePort port(line, line.attach("hand", 500'000, hand));
    const auto ask = [&](const Frame& frame) {
      hand.frames.clear();
      port.send(frame, 0);
      rig.run_until(rig.plant->now() + 10 * kMillisecond);
      return hand.frames;
    };
    const Frame request{525, 8, {0x31, 0, 0x21, 0x98}, false, false};  // 8600
    if (on)
      EXPECT_EQ(ask(request),
                (std::vector<Frame>{{527, 8, {0x31, 0, 0x21, 0x98, 0, 0, 0, 1}, false, false}}));
    else
      EXPECT_TRUE(ask(request).empty());
    // The identifiers and lengths of the older units hold.
    EXPECT_EQ(ask({523, 8, {0x31, 0, 0x21, 0x98}, false, false}),
              (std::vector<Frame>{{524, 8, {0x31, 0, 0x21, 0x98, 0, 0, 0, 1}, false, false}}));
    const std::vector<Frame> input = ask(process_frame(11, {6, 0, 0}));
    ASSERT_EQ(input.size(), 1U);
    EXPECT_EQ(input[0].id, 12U);
    EXPECT_EQ(input[0].length, 6);
    EXPECT_TRUE(ask(process_frame(22, {6, 7, 0})).empty());
    EXPECT_EQ(rig.station(0).drive().state().po()[1], 7);
  }
}

// Addresses, groups, rates and timeouts of both ports by the numbers the manual names; each port by its own.
TEST(Sbus2, ParametersOfBothPorts) {
  PROVES("MDB-TOC-03", "MDB-PAR-03");
  const auto& table = stdlib::parameter_table(*stdlib::find_unit("mdxb"));
  for (const auto& [number, word] : {std::pair{"88", "SBus 1"}, {"89", "SBus 2"}})
    for (const auto& [digit, name] : {std::pair{"0", "Protocol"},
                                      {"1", "Address"},
                                      {"2", "Group address"},
                                      {"3", "Timeout delay"},
                                      {"4", "Baud rate"}}) {
      const stdlib::Parameter* row = table.find(std::string(number) + digit);
      ASSERT_NE(row, nullptr) << number << digit;
      EXPECT_EQ(row->name, std::string(name) + " " + word);
    }
  EXPECT_EQ(table.find("836")->name, "Response SBus 1 TIMEOUT");
  EXPECT_EQ(table.find("837")->name, "Response SBus 2 TIMEOUT");

  class Hand final : public CanNode {
   public:
    explicit Hand(CanLine& line) : port(line, line.attach("hand", line.baud(), *this)) {}
    void on_frame(Time, const Frame& frame) override { frames.push_back(frame); }
    void on_sent(Time, const Frame&, uint64_t) override {}
    void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
    LinePort port;
    std::vector<Frame> frames;
  };
  constexpr uint32_t kRates[] = {125'000, 250'000, 500'000, 1'000'000};
  const auto lines = [](uint32_t first, uint32_t second) {
    return bus_text(first) + "[[bus]]\nname = \"sbus2\"\nkind = \"can\"\nbaud = " + std::to_string(second) +
           "\n";
  };
  // A code is the rate of its port: the unit answers on a line of that rate and on no other.
  for (int code = 0; code < 4; ++code)
    for (int line = 0; line < 4; ++line) {
      PlantRig rig(lines(kRates[line], kRates[3 - line]) +
                   station_text("a",
                                "P881 = 1\nP891 = 7\nP884 = " + std::to_string(code) +
                                    "\nP894 = " + std::to_string(code) + "\n",
                                "mdxb", "", "sbus2 = \"sbus2\"\n"));
      Hand first(rig.get().all<runtime::CanBus>()[0]->line()), second(rig.get().all<runtime::CanBus>()[1]->line());
      rig.run_until(10 * kMillisecond);
      first.port.send({8 * 1 + 515, 8, {0x31, 0, 0x21, 0x98}, false, false}, 0);
      second.port.send({8 * 7 + 515, 8, {0x31, 0, 0x21, 0x98}, false, false}, 0);
      rig.run_until(40 * kMillisecond);
      EXPECT_EQ(first.frames.size(), code == line ? 1U : 0U) << code << " " << line;
      EXPECT_EQ(second.frames.size(), code == 3 - line ? 1U : 0U) << code << " " << line;
    }
  // A port with CANopen is no MOVILINK port; the other one goes on.
  for (const bool first_port : {true, false}) {
    PlantRig rig(
        lines(500'000, 500'000) +
        station_text("a", std::string("P881 = 1\nP891 = 7\n") + (first_port ? "P880 = 1\n" : "P890 = 1\n"),
                     "mdxb", "", "sbus2 = \"sbus2\"\n"));
    EXPECT_EQ(rig.station(0).sbus(first_port ? 1 : 2), nullptr);
    EXPECT_NE(rig.station(0).canopen(first_port ? 1 : 2), nullptr);
    Hand open(rig.get().all<runtime::CanBus>()[first_port ? 1 : 0]->line());
    rig.run_until(10 * kMillisecond);
    open.port.send({8U * (first_port ? 7 : 1) + 515, 8, {0x31, 0, 0x21, 0x98}, false, false}, 0);
    rig.run_until(40 * kMillisecond);
    EXPECT_EQ(open.frames.size(), 1U);
  }
}

TEST(Sbus2, CommStateStopsAndStartsTheObjects) {
  const std::string program =
      "#include <constb.h>\n" + talk("1", 1024, 1025, 1) +
      "long lState;\nmain()\n{\n Define1();\n _SBusCommState(SCS_STARTALL, lState);\n _Wait(50);\n"
      " _SBusCommState(SCS_STOPALL, lState);\n _Wait(50);\n "
      "_SBusCommState(SCS_STARTALL, lState);\n while (1) {}\n}\n";
  PlantRig rig(bus_text() + station_text("a", "P881 = 1\n", "mdxb", "A.IPC") +
                   station_text("b", "P881 = 2\n", "mdxb", "B.IPC"),
               {{"A.IPC", program}, {"B.IPC", kSources.at("B.IPC")}});
  rig.run_until(70 * kMillisecond);
  EXPECT_EQ(rig.variable(0, "lState"), 0);
  const size_t before = rig.with(1024).size();
  EXPECT_GE(before, 5U);
  rig.run_until(90 * kMillisecond);
  EXPECT_EQ(rig.with(1024).size(), before);
  rig.run_until(200 * kMillisecond);
  EXPECT_EQ(rig.variable(0, "lState"), 1);
  EXPECT_GE(rig.with(1024).size(), before + 8);
}

TEST(UnitLimits, ObjectsOfMovitrac07) {
  PROVES("M07-SCOM-18", "M07-SCOM-19", "M07-SCOM-20", "M07-SCOM-22", "M07-SCOM-23", "M07-SCOM-24",
         "M07-SCOM-29");
  struct Outbox final : FrameSender {
    SendStatus send(const Frame& frame, uint64_t) override {
      frames.push_back(frame);
      return SendStatus::Queued;
    }
    void withdraw(uint64_t) override {}
    std::vector<Frame> frames;
  } outbox;
  const stdlib::UnitType& unit = *stdlib::find_unit("mc07");
  std::vector<int32_t> h(unit.variables);
  std::string why;
  const auto cyclic = [&](VariableObjects& objects, int32_t id, int32_t cycle, int32_t offset,
                          int32_t format) {
    const int32_t elements[] = {id, cycle, offset, format, 426, 0};
    std::copy(std::begin(elements), std::end(elements), h.begin() + 420);
    EXPECT_TRUE(objects.define(ObjectKind::TransmitCyclic, 420, h, why));
    return h[425];
  };
  VariableObjects objects(unit, 500'000, outbox, 100);
  for (const int32_t cycle : {15, 5, 0, 65'540})
    EXPECT_EQ(cyclic(objects, 1024, cycle, 0, 8), kWrongCycleTime);
  EXPECT_EQ(cyclic(objects, 1024, 10, 15, 8), kWrongCycleTime);
  for (const int32_t format : {9, 0x200, 0x109}) EXPECT_LT(cyclic(objects, 1024, 10, 0, format), 0);
  for (int32_t n = 0; n < 10; ++n) {
    const int32_t result = cyclic(objects, 1024 + n, 100, 0, n % 2 == 0 ? 8 : 0x108);
    EXPECT_GE(result, 0);
    EXPECT_LE(result, 100);
  }
  EXPECT_EQ(cyclic(objects, 1040, 100, 0, 8), kTooManyObjects);
  VariableObjects slow(unit, 125'000, outbox, 100);
  int32_t result = 0;
  for (int32_t n = 0; n < 10 && result >= 0; ++n) result = cyclic(slow, 1024 + n, 10, 0, 8);
  EXPECT_EQ(result, kBusOverload);  // 13 500 bit/s each, 87 500 planned
  const auto receive = [&](VariableObjects& of, int32_t id, int32_t format, int32_t data) {
    h[428] = id;
    h[429] = format;
    h[430] = data;
    why.clear();
    EXPECT_TRUE(of.define(ObjectKind::Receive, 428, h, why));
    return why.empty();
  };
  for (int32_t n = 0; n < 32; ++n) EXPECT_TRUE(receive(objects, 1100 + n, n == 0 ? 4 : 8, 100 + 2 * n));
  EXPECT_FALSE(receive(objects, 1200, 8, 300));
  objects.start(0);
  // Length 4 writes one variable only; other identifiers write nothing.
  h[101] = 99;
  EXPECT_TRUE(objects.on_frame({1100, 4, {0, 0, 0, 5}, false, false}, h, why));
  EXPECT_EQ(h[100], 5);
  EXPECT_EQ(h[101], 99);
  EXPECT_FALSE(objects.on_frame({1300, 4, {0, 0, 0, 6}, false, false}, h, why));
  // Unit 1: 1024 every 100 ms; unit 2: 1025 every 50 ms with an offset of 120 ms.
  for (const auto& [cycle, offset] : {std::pair{100, 0}, std::pair{50, 120}}) {
    VariableObjects one(unit, 500'000, outbox, 100);
    EXPECT_GE(cyclic(one, 1024, cycle, offset, 8), 0);
    one.start(0);
    std::vector<int64_t> times;
    for (int64_t tick = 0; tick < 301; ++tick) {
      outbox.frames.clear();
      one.tick(tick, h);
      if (!outbox.frames.empty()) times.push_back(tick);
    }
    EXPECT_EQ(times, cycle == 100 ? (std::vector<int64_t>{0, 100, 200, 300})
                                  : (std::vector<int64_t>{120, 170, 220, 270}));
  }
}

TEST(UnitLimits, MovitracSendsFromTheStartToTheStopOfTheProgram) {
  PROVES("M07-SCOM-21");
  const std::string program =
      "#include <const.h>\nSCTRCYCL Tr; long lData, lMore, lZero;\nmain()\n{\n Tr.ObjectNo = 1024; "
      "Tr.CycleTime = 10; "
      "Tr.Offset = 0; Tr.Format = 8; Tr.DPointer = numof(lData);\n _SBusCommDef(SCD_TRCYCL, Tr);\n "
      "_Wait(50);\n "
      "_SBusCommOn();\n _Wait(100);\n lData = lData / lZero;\n}\n";  // F10 stops the program
  PlantRig rig(
      bus_text() + station_text("a", "P813 = 1\n", "mc07", "A.IPC") + station_text("b", "P813 = 2\n", "mc07"),
      {{"A.IPC", program}});
  rig.run_until(40 * kMillisecond);
  EXPECT_TRUE(rig.frames.empty());
  rig.run_until(kSecond);
  EXPECT_EQ(rig.station(0).fault(), 10);
  ASSERT_GE(rig.frames.size(), 10U);
  EXPECT_LT(rig.frames.back().end, 175 * kMillisecond);
}

TEST(UnitLimits, ObjectsOfMovidriveB) {
  struct Outbox final : FrameSender {
    SendStatus send(const Frame&, uint64_t) override { return SendStatus::Queued; }
    void withdraw(uint64_t) override {}
  } outbox;
  const stdlib::UnitType& unit = *stdlib::find_unit("mdxb");
  std::vector<int32_t> h(unit.variables);
  std::string why;
  for (const int sbus : {1, 2}) {
    VariableObjects objects(unit, 1'000'000, outbox, 100, sbus);
    const int32_t bit = sbus == 2 ? kSbus2Object : 0;
    for (int32_t n = 0; n < 16; ++n) {
      const int32_t elements[] = {bit + 1024 + n, 9, 0, 0, 426, 0};
      std::copy(std::begin(elements), std::end(elements), h.begin() + 420);
      EXPECT_TRUE(objects.define(ObjectKind::TransmitCyclic, 420, h, why));
      EXPECT_EQ(h[425] >= 0, n < 15) << n;
    }
    for (int32_t n = 0; n < 32; ++n) {
      h[428] = bit + 1100 + n;
      h[429] = 4;
      h[430] = 100 + n;
      EXPECT_TRUE(objects.define(ObjectKind::Receive, 428, h, why));
    }
    objects.start(0);
    const size_t flags = sbus == 1 ? 522 : 523;
    h[522] = h[523] = 0;
    EXPECT_TRUE(objects.on_frame({1131, 4, {}, false, false}, h, why));
    EXPECT_TRUE(objects.on_frame({1103, 4, {}, false, false}, h, why));
    EXPECT_EQ(static_cast<uint32_t>(h[flags]), 0x80000008U);
    EXPECT_EQ(h[522 + 523 - flags], 0);
    h[flags] = 0;  // cleared by the program
    EXPECT_TRUE(objects.on_frame({1100, 4, {}, false, false}, h, why));
    EXPECT_EQ(h[flags], 1);
  }
}

}  // namespace
}  // namespace ipos::tests
