// The manual's samples in plants that carry them out: MOVLNK of p. 48, monitored and unmonitored requests,
// the same parameter coding on both buses, terminals beside the bus, master/slave operation by P750 and P751.
#include "runtime/bus_plan/plan.hpp"
#include "stdlib/parameters.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/rs485/serial_rig.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

const std::string kInputs = "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
const std::string kSerialBus = "[[bus]]\nname = \"line1\"\nkind = \"rs485\"\n";

class CanHand final : public CanNode {
 public:
  CanHand(CanLine& line, const std::string& name) : port(line, line.attach(name, line.baud(), *this)) {}
  void on_frame(Time, const Frame& frame) override {
    frames.push_back(frame);
    if (answer) answer(frame);
  }
  void on_sent(Time, const Frame&, uint64_t) override {}
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}

  LinePort port;
  std::vector<Frame> frames;
  std::function<void(const Frame&)> answer;
};

// 1053 1610 p. 48: the variables of the structures at H20.
constexpr const char* kMovlnkSample = R"(#include <const.h>
MOVLNK Ml;
main()
{
  Ml.BusType = 5; Ml.Address = 1; Ml.Format = 4; Ml.Service = 1; Ml.Index = 8318; Ml.DPointer = 20;
  H20 = 0; H21 = 77; H22 = 6; H23 = 5000; H24 = 15000; H25 = 77; H26 = 77; H27 = 77;
  while (1) { _MoviLink(Ml); }
}
)";

// The slave set up as in the sample, until its speed is reached: 1000 rpm in both words.
void expect_sample(const std::string& unit) {
  PlantRig rig(
      bus_text() + station_text("master", "P813 = 0\n", unit, "A.IPC") +
          station_text("slave",
                       "P813 = 1\nP100 = 10\nP101 = 3\nP870 = 9\nP871 = 1\nP872 = 5\nP873 = 6\nP874 = 1\n"
                       "P875 = 0\n",
                       unit) +
          kInputs,
      {{"A.IPC", kMovlnkSample}});
  rig.run_until(3 * kSecond);
  EXPECT_EQ(rig.variable(0, "Ml.Result"), 0);
  EXPECT_NEAR(rig.station(1).drive().state().axis().speed, 1'000'000, 3'000);
  EXPECT_NEAR(rig.variable(0, "H21"), 1'000'000, 3'000);
  EXPECT_NEAR(rig.variable(0, "H26"), 5000, 15);
  EXPECT_EQ(rig.variable(0, "H25") & 7, 7) << "output stage on, ready, PO data enabled";
  EXPECT_EQ(rig.variable(0, "H27"), 0);
  ASSERT_GE(rig.frames.size(), 100U);
  for (size_t n = 0; n < 100; ++n)
    EXPECT_EQ(rig.ids()[n], (std::array<uint32_t, 4>{523, 524, 11, 12})[n % 4]);
}

TEST(ProfileSamples, MovlnkReadsSpeedAndProcessData) {
  PROVES("EX-11");
  // A stub slave with exactly the values of the sample: they fill H20 to H27.
  PlantRig stubbed(bus_text() + station_text("master", "P813 = 0\n", "md60a", "A.IPC"),
                   {{"A.IPC", kMovlnkSample}});
  CanHand stub(stubbed.get().all<runtime::CanBus>()[0]->line(), "stub");
  stub.answer = [&stub](const Frame& frame) {
    if (frame.id == 523)
      stub.port.send({524, 8, {0x31, 0, 0x20, 0x7E, 0, 0x0F, 0x42, 0x40}, false, false}, 0);
    if (frame.id == 11) stub.port.send(process_frame(12, {7, 5011, 0}), 0);
  };
  stubbed.run_until(50 * kMillisecond);
  const std::map<std::string, int32_t> sample = {{"H20", 0},    {"H21", 1'000'000}, {"H22", 6},
                                                 {"H23", 5000}, {"H24", 15000},     {"H25", 7},
                                                 {"H26", 5011}, {"H27", 0}};
  for (const auto& [name, value] : sample) EXPECT_EQ(stubbed.variable(0, name), value) << name;
  ASSERT_GE(stub.frames.size(), 2U);
  EXPECT_EQ(stub.frames[0], (Frame{523, 8, {0x31, 0, 0x20, 0x7E}, false, false}));
  EXPECT_EQ(stub.frames[1], process_frame(11, {6, 5000, 15000}));
  expect_sample("md60a");
}

// Chapter 5.1 of the MOVITRAC 07 manual has the same sample.
TEST(ProfileSamples, MovlnkOnMovitrac07) {
  PROVES("M07-SCOM-08");
  expect_sample("mc07");
}

TEST(ProfileSamples, TheAcyclicFormIsNotMonitored) {
  PROVES("EX-05");
  const Bytes acyclic = telegram("02 01 85 00 06 20 00 0B B8");
  const Bytes cyclic = telegram("02 01 05 00 06 20 00 0B B8");
  EXPECT_EQ(cyclic.back(), 0x93);
  EXPECT_EQ(acyclic[2], 0x85);
  PlantRig rig(kSerialBus +
               "[[station]]\nname = \"unit\"\nunit = \"md60a\"\nrs485 = \"line1\"\n[station.parameters]\n"
               "P810 = 1\nP812 = 500\n");
  HandNode hand(rig.get().all<runtime::SerialBus>()[0]->line(), "hand");
  rig.run_until(10 * kMillisecond);
  hand.send(acyclic);
  rig.run_until(5 * kSecond);
  ASSERT_EQ(hand.receptions.size(), 1U) << "answered";
  EXPECT_EQ(rig.station(0).fault(), 0);
  for (int n = 0; n < 5; ++n) {
    hand.send(cyclic);
    rig.run_until(rig.get().now() + 400 * kMillisecond);
    EXPECT_EQ(rig.station(0).fault(), 0) << n;
  }
  EXPECT_EQ(hand.receptions.size(), 6U);
  rig.run_until(rig.get().now() + 200 * kMillisecond);
  EXPECT_EQ(rig.station(0).fault(), 43);
}

// Every service, good and bad indices and values: the eight bytes of the parameter channel are the same.
TEST(ProfileSamples, ParametersAreCodedAlikeOnBothBuses) {
  PROVES("SBUS-19");
  const std::string plant = bus_text() + kSerialBus +
                            station_text("unit", "P810 = 1\nP813 = 1\n", "md60a", "", "rs485 = \"line1\"\n");
  PlantRig over_can(plant), over_serial(plant);
  CanHand can(over_can.get().all<runtime::CanBus>()[0]->line(), "hand");
  HandNode serial(over_serial.get().all<runtime::SerialBus>()[0]->line(), "hand");
  over_can.run_until(10 * kMillisecond);
  over_serial.run_until(10 * kMillisecond);
  size_t refused = 0;
  for (uint8_t length = 0; length < 4; ++length)
    for (uint8_t service = 0; service < 16; ++service)
      for (const auto& [index, value] : {std::pair{8470, 3000},
                                         {8470, -10},
                                         {8470, 2'000'010},
                                         {8318, 1},
                                         {8415, 1},
                                         {11005, 123456},
                                         {8461, 2}}) {
        const auto data = static_cast<uint32_t>(value);
        std::array<uint8_t, 8> channel{static_cast<uint8_t>(length << 4 | service),
                                       0,
                                       static_cast<uint8_t>(index >> 8),
                                       static_cast<uint8_t>(index & 0xFF),
                                       static_cast<uint8_t>(data >> 24),
                                       static_cast<uint8_t>(data >> 16),
                                       static_cast<uint8_t>(data >> 8),
                                       static_cast<uint8_t>(data)};
        can.frames.clear();
        can.port.send({523, 8, channel, false, false}, 0);
        over_can.run_until(over_can.get().now() + 20 * kMillisecond);
        Bytes request = {0x02, 0x01, 0x86};
        request.insert(request.end(), channel.begin(), channel.end());
        serial.receptions.clear();
        serial.send(with_check(request));
        over_serial.run_until(over_serial.get().now() + 100 * kMillisecond);
        ASSERT_EQ(can.frames.size(), 1U);
        ASSERT_EQ(serial.receptions.size(), 1U);
        ASSERT_EQ(can.frames[0].id, 524U);
        const auto answer = serial.receptions[0].bytes.span().subspan(3, 8);
        for (size_t n = 0; n < 8; ++n)
          EXPECT_EQ(can.frames[0].data[n], answer[n]) << "byte " << n << " service " << int{service}
                                                      << " length " << int{length} << " index " << index;
        refused += (answer[0] & 0x80) != 0 ? 1 : 0;
        // A write with another length code than 4 bytes, and services 9 to 15: class 5, code 5.
        if (service >= 9 || (length != 3 && (service == 2 || service == 3))) {
          EXPECT_EQ(text_of(answer.subspan(4)), "05 05 00 00") << int{service} << " " << int{length};
        }
      }
  EXPECT_GT(refused, 100U);
}

// 1053 1610 p. 34, figure 22, at the master: two tasks that write to one slave by cyclic telegrams, all the
// time. Only one job is under way, and the bit of the requests changes only when the last response had it
// back.
TEST(ProfileSamples, TheNextServiceWaitsForTheAcknowledgement) {
  PROVES("MLK-10");  // the slave: SerialSlave.OldBitUntilTheServiceIsDone
  const std::string program =
      "#include <const.h>\nMOVLNK A; MLDATA Da; MOVLNK B; MLDATA Db; long n, m;\n"
      "Second()\n{\n while (1) { _MoviLink(B); m++; }\n}\nmain()\n{\n"
      " A.BusType = ML_BT_S1; A.Address = 1; A.Format = 6; A.Service = 3; A.DPointer = numof(Da); A.Index = "
      "8470;\n"
      " B.BusType = ML_BT_S1; B.Address = 1; B.Format = 6; B.Service = 3; B.DPointer = numof(Db); B.Index = "
      "8471;\n"
      " Da.WritePar = 2500; Db.WritePar = 2600;\n _SetTask2(T2_START, Second);\n"
      " while (1) { _MoviLink(A); n++; }\n}\n";
  PlantRig rig(
      kSerialBus +
          "[[station]]\nname = \"master\"\nunit = \"md60a\"\nrs485 = \"line1\"\nprogram = \"A.IPC\"\n"
          "[[station]]\nname = \"slave\"\nunit = \"md60a\"\nrs485 = \"line1\"\n[station.parameters]\nP810 = "
          "1\n",
      {{"A.IPC", program}});
  Recorder recorder;
  rig.get().all<runtime::SerialBus>()[0]->line().add_observer(recorder);
  rig.run_until(5 * kSecond);
  EXPECT_GT(rig.variable(0, "n"), 10);
  EXPECT_GT(rig.variable(0, "m"), 10);
  EXPECT_EQ(rig.station(1).drive().parameters().value(8470), 2500);
  EXPECT_EQ(rig.station(1).drive().parameters().value(8471), 2600);
  constexpr uint8_t kHandshakeBit = 0x40;
  std::optional<uint8_t> sent, received;  // the bit
  std::optional<uint16_t> under_way;      // index of the service
  size_t toggles = 0;
  for (const Heard& heard : recorder.heard) {
    ASSERT_TRUE(heard.reception.telegram);
    const auto bytes = heard.reception.bytes.span();
    const uint8_t bit = bytes[3] & kHandshakeBit;
    const auto index = static_cast<uint16_t>(bytes[5] << 8 | bytes[6]);
    if (bytes[0] == kRequestStart) {
      if (sent && bit != *sent) {
        ++toggles;
        EXPECT_EQ(received, sent) << "the bit of the last request has come back";
        under_way = index;
      }
      if (under_way && sent && received != sent) {
        EXPECT_EQ(index, *under_way) << "no other service before the acknowledgement";
      }
      sent = bit;
    } else {
      received = bit;
    }
  }
  EXPECT_GT(toggles, 20U);
}

TEST(ProfileSamples, TerminalsKeepTheirFunction) {
  PROVES("SBUS-23");
  PlantRig rig(
      bus_text() + station_text("unit", "P813 = 1\nP100 = 10\nP101 = 3\n") + kInputs +
      "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n[[control.target]]\naddress = 1\npo = [6, 5000, 0]\n"
      "every = \"10ms\"\n[[stimulus]]\nstation = \"unit\"\nat = \"2s\"\ninput = \"DI00\"\nset = 0\n");
  const Drive& drive = rig.get().stations()[0]->drive().state();
  rig.run_until(2 * kSecond - kMillisecond);
  EXPECT_NEAR(drive.axis().speed, 1'000'000, 3'000);
  EXPECT_TRUE(drive.axis().output_stage);
  rig.run_until(2 * kSecond + 2 * kMillisecond);
  EXPECT_FALSE(drive.axis().output_stage) << "at once";
  EXPECT_EQ(rig.station(0).status_word_1() >> 8, 1) << "controller inhibit, though the bus goes on with 6";
  rig.run_until(3 * kSecond);
  EXPECT_EQ(rig.with(11).back().frame, process_frame(11, {6, 5000, 0}));
  EXPECT_FALSE(drive.axis().output_stage);
}

// Chapters 2 and 5.1 of the MOVITRAC 07 manual: standard units are slaves only.
TEST(ProfileSamples, StandardMovitrac07RunsNoProgram) {
  PROVES("M07-SBUS-23");
  const auto plant = [](const std::string& key) {
    return bus_text() + station_text("master", "P813 = 0\n", "mc07", "A.IPC", key) +
           station_text("slave", "P813 = 1\n", "mc07", "", "logodrive = false\n");
  };
  PlantRig runs(plant("logodrive = true\n"), {{"A.IPC", kMovlnkSample}});
  runs.run_until(100 * kMillisecond);
  EXPECT_EQ(runs.variable(0, "Ml.Result"), 0) << "the standard unit answers as slave";
  const PlantRig rejected(plant("logodrive = false\n"), {{"A.IPC", kMovlnkSample}});
  ASSERT_EQ(rejected.errors.size(), 1U);
  EXPECT_NE(rejected.errors[0].find(
                "a standard MOVITRAC 07 (logodrive = false) is a slave only and runs no program"),
            std::string::npos)
      << rejected.errors[0];
  const PlantRig other(bus_text() + station_text("u", "", "md60a", "", "logodrive = false\n"));
  ASSERT_EQ(other.errors.size(), 1U);
  EXPECT_NE(other.errors[0].find("logodrive is of mc07"), std::string::npos);
}

// Chapter 6.3: bits 8 to 15 of control word 2 are free for the program.
TEST(ProfileSamples, ControlWord2CarriesBitsForTheProgram) {
  PROVES("M07-CW-24");
  PlantRig rig(
      bus_text() + station_text("unit", "P813 = 1\nP100 = 10\nP101 = 3\nP870 = 10\n", "mc07", "A.IPC") +
          kInputs +
          "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n[[control.target]]\naddress = 1\n"
          "po = [0xA506, 5000, 0]\nevery = \"10ms\"\n",
      {{"A.IPC",
        "#include <const.h>\nGSPODATA3 Po; long lWord, lHigh;\nmain()\n{\n _Wait(100);\n _GetSys(Po, "
        "GS_PODATA);\n lWord = Po.PO1 & 0xFFFF;\n lHigh = (Po.PO1 >> 8) & 0xFF;\n while (1) {}\n}\n"}});
  rig.run_until(3 * kSecond);
  EXPECT_EQ(rig.variable(0, "lWord"), 0xA506);
  EXPECT_EQ(rig.variable(0, "lHigh"), 0xA5);
  const Drive& drive = rig.station(0).drive().state();
  EXPECT_EQ(rig.station(0).status_word_1() >> 8, 4) << "enabled by the low byte";
  EXPECT_NEAR(drive.axis().speed, 1'000'000, 3'000) << "the free bits change nothing";
  EXPECT_EQ(drive.reserved_control_bits(), 0);
  EXPECT_EQ(drive.fault(), 0);
}

// A master that a control runs up to 1000 rpm, a slave on SBus with P751.
std::string master_and_slave(int p750, int p751) {
  return bus_text() + kSerialBus +
         station_text(
             "master",
             "P813 = 1\nP814 = 5\nP811 = 105\nP100 = 10\nP101 = 3\nP750 = " + std::to_string(p750) + "\n",
             "md60a", "", "rs485 = \"line1\"\n") +
         kInputs +
         station_text("slave", "P813 = 2\nP814 = 5\nP100 = 8\nP101 = 3\nP301 = 0\nP751 = " +
                                   std::to_string(p751) + "\n") +
         kInputs +
         "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n[[control.target]]\naddress = 1\npo = [6, 5000, 0]\n"
         "every = \"10ms\"\n";
}

std::string in_torque_control(std::string plant) {
  return plant.insert(plant.find("P100 = 8\n"), "P700 = 12\n");
}

// Where it is sent, and what: the speed of the master, or the current it needs. That takes an equal machine through the
// same run-up: 30 % torque for 1.5 rpm a millisecond, 5 % for the friction behind it.
TEST(ProfileSamples, P750SelectsWhatIsSentAndWhere) {
  PROVES("MS-05", "MDB-MS-01");
  for (int p750 = 0; p750 <= 9; ++p750) {
    const std::string plant = master_and_slave(p750, 1000);
    PlantRig rig(p750 > 3 ? in_torque_control(plant) : plant);
    Recorder serial;
    rig.get().all<runtime::SerialBus>()[0]->line().add_observer(serial);
    rig.run_until(2 * kSecond);
    // 1, 4, 7 RS-485; 2, 5, 8 SBus; 3, 6, 9 both.
    const bool over_serial = p750 != 0 && p750 % 3 != 2;
    const bool over_sbus = p750 != 0 && p750 % 3 != 1;
    EXPECT_EQ(rig.with(8 * 5 + 6).size() > 1900, over_sbus) << p750;
    EXPECT_EQ(rig.with(8 * 5 + 6).empty(), !over_sbus) << p750;
    EXPECT_EQ(serial.heard.size() > 10, over_serial) << p750;
    for (const Heard& heard : serial.heard) EXPECT_EQ(heard.text().substr(0, 8), "02 69 05") << "group 105";
    const Drive& slave = rig.station(1).drive().state();
    EXPECT_NEAR(slave.axis().speed, over_sbus ? 1'000'000 : 0, p750 <= 3 ? 5'000 : 20'000) << p750;
    if (!over_sbus) continue;
    const ProcessWords last = *process_words(rig.with(8 * 5 + 6).back().frame);
    EXPECT_EQ(last[0], 6) << "enable";
    EXPECT_EQ(last[1], p750 <= 3 ? 5000 : 40) << "5 % of the rated torque are 4.0 % of IN";
  }
}

// P751 is the part of the load that a slave bears.
TEST(ProfileSamples, LoadShareWithItsFactor) {
  for (const int p751 : {250, 500, 2000}) {
    PlantRig rig(in_torque_control(master_and_slave(8, p751)));
    rig.run_until(500 * kMillisecond);
    const int32_t master = rig.station(0).drive().state().axis().active_current;
    EXPECT_NEAR(master, 24'000, 100) << "30 % torque in the run-up";
    EXPECT_NEAR(rig.station(1).drive().state().axis().active_current, master / 1000.0 * p751, 200) << p751;
  }
}

// Nothing in a group telegram says what its setpoint is: the planner compares both ends.
TEST(ProfileSamples, TorqueForASpeedIsFound) {
  const auto finding = [](const std::string& plant) {
    PlantRig rig(plant);
    for (const Finding& found : make_plan(rig.get(), {}).findings)
      if (found.kind == FindingKind::MasterSlave) return found.text;
    return std::string();
  };
  EXPECT_EQ(finding(master_and_slave(5, 1000)),
            "master sends a torque (P750), which slave takes for a speed (P700)");
  EXPECT_EQ(finding(in_torque_control(master_and_slave(2, 1000))),
            "master sends a speed (P750), which slave takes for a torque (P700)");
  EXPECT_EQ(finding(in_torque_control(master_and_slave(5, 1000))), "");
  EXPECT_EQ(finding(master_and_slave(2, 1000)), "");
}

// Master/slave operation is one of X13 and SBus 1: no other bus can be chosen, and a group telegram on SBus 2 is not
// followed.
TEST(ProfileSamples, NoMasterAndSlaveElsewhere) {
  PROVES("MDB-PAR-04");
  const stdlib::ParameterTable& table = stdlib::parameter_table(*stdlib::find_unit("mdxb"));
  for (const char* number : {"P750", "P100"})
    for (const stdlib::ValueText& row : table.find(number)->texts) {
      const std::string_view text = row.text;
      const bool leads = std::string_view(number) == "P750" || text.find("MASTER") != std::string_view::npos;
      for (const char* other : {"XT", "FIELDBUS", "SBus 2", "SBus2"})
        EXPECT_FALSE(leads && text.find(other) != std::string_view::npos) << number << " " << text;
    }
  for (const int sbus : {1, 2}) {
    const std::string group = sbus == 1 ? "P882 = 5\n" : "P892 = 5\n";
    PlantRig rig(bus_text() + "[[station]]\nname = \"slave\"\nunit = \"mdxb\"\n" +
                 (sbus == 1 ? "sbus" : "sbus2") + " = \"sbus\"\n[station.parameters]\nP100 = 8\nP301 = 0\n" + group +
                 kInputs +
                 "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n[[control.target]]\ngroup = 5\npo = [6, 5000, 0]\n"
                 "every = \"10ms\"\n");
    rig.run_until(3 * kSecond);
    EXPECT_NEAR(rig.station(0).drive().state().axis().speed, sbus == 1 ? 1'000'000 : 0, 5'000) << sbus;
  }
}

// PO3 is the program's on both sides: the master's fills it, the slave's reads it (MDX60B/61B p. 29).
TEST(ProfileSamples, Po3OfTheMasterComesFromItsProgram) {
  PROVES("MS-07", "MDB-MS-04");
  const std::string fill =
      "#include <const.h>\nSSPIDATA3 Pi; \nmain()\n{\n Pi.PI1 = 1; Pi.PI2 = 2; Pi.PI3 = 0x1234;\n "
      "_SetSys(SS_PIDATA, Pi);\n while (1) {}\n}\n";
  const std::string read =
      "#include <const.h>\nGSPODATA3 Po; long l3;\nmain()\n{\n while (1)\n {\n  _GetSys(Po, GS_PODATA);\n  "
      "l3 = Po.PO3;\n }\n}\n";
  PlantRig rig(bus_text() + kSerialBus +
                   station_text("master", "P813 = 1\nP814 = 5\nP811 = 105\nP750 = 3\n", "md60a", "A.IPC",
                                "rs485 = \"line1\"\n") +
                   station_text("slave", "P813 = 2\nP814 = 5\nP100 = 8\n", "md60a", "B.IPC"),
               {{"A.IPC", fill}, {"B.IPC", read}});
  Recorder serial;
  rig.get().all<runtime::SerialBus>()[0]->line().add_observer(serial);
  rig.run_until(100 * kMillisecond);
  // Control word 1, speed, IPOS PO-data.
  EXPECT_EQ(*process_words(rig.with(8 * 5 + 6).back().frame), (ProcessWords{1, 0, 0x1234}));
  EXPECT_EQ(rig.variable(1, "l3"), 0x1234);
  ASSERT_FALSE(serial.heard.empty());
  EXPECT_EQ(serial.heard.back().text().substr(0, 26), "02 69 05 00 01 00 00 12 34");
}

TEST(ProfileSamples, P751ScalesTheSlave) {
  PROVES("MS-06");
  for (const int p751 : {1000, 500, -1000, -500, 1250, 0}) {
    PlantRig rig(master_and_slave(2, p751));
    rig.run_until(3 * kSecond);
    const auto& slave = rig.station(1).drive().state().axis();
    EXPECT_NEAR(rig.station(0).drive().state().axis().speed, 1'000'000, 3'000);
    EXPECT_NEAR(slave.speed, p751 * 1000, 5'000) << p751;
    EXPECT_EQ(slave.position < 0, p751 < 0) << p751;
  }
  // -10000 to 10000.
  UnitInterface drive(*stdlib::find_unit("md60a"));
  for (const int good : {-10'000, 10'000}) EXPECT_FALSE(drive.set_parameter("P751", good).has_value());
  for (const int bad : {-10'001, 10'001}) EXPECT_TRUE(drive.set_parameter("P751", bad).has_value());
}

}  // namespace
}  // namespace ipos::tests
