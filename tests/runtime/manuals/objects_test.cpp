// Variable telegrams of the manuals (1053 1610 chapter 5.3, MOVITRAC 07 chapter 5.2): a program defines objects as the test says, the
// library sends and hears the frames.
#include <set>

#include "tests/harness/proves.hpp"
#include "tests/runtime/manuals/talk.hpp"

namespace ipos::tests {
namespace {

constexpr int kWrong = -1, kTooMany = -2, kOverload = -3;

// Carries out one order of the test at a time.
constexpr const char* kOrders =
    "#include <const.h>\nSCTRCYCL Tr; SCREC Rec; SCTRACYCL Ac; long lOrder, lFirst;\nmain()\n{\n while (1)\n "
    "{\n"
    "  if (lOrder == 1) { _SBusCommDef(SCD_TRCYCL, Tr); lOrder = 0; }\n"
    "  if (lOrder == 2) { _SBusCommDef(SCD_REC, Rec); lOrder = 0; }\n"
    "  if (lOrder == 3) { _SBusCommDef(SCD_TRACYCL, Ac); lFirst = Ac.Result; lOrder = 0; }\n"
    "  if (lOrder == 4) { _SBusCommOn(); lOrder = 0; }\n }\n}\n";

class Objects {
 public:
  explicit Objects(const char* unit = "md60a", const std::string& parameters = "P813 = 0\nP814 = 0\n",
                   const std::string& more = "", uint32_t baud = 500'000, uint32_t commands_a_ms = 0,
                   bool alone = false)
      : talk(can_bus("baud = " + std::to_string(baud) + "\n") +
                 unit_on("sbus = \"sbus\"\nprogram = \"P.IPC\"\n", "u", unit, parameters) + more,
             kOrders, commands_a_ms) {
    // Somebody who acknowledges, unless the unit is to be alone.
    if (!alone) {
      EXPECT_EQ(ipos_plant_join(talk.plant(), talk.bus("sbus")), IPOS_PLANT_OK);
    }
    talk.pass(5 * kMs);
  }
  void order(int number) {
    talk.set("u", "lOrder", number);
    for (int n = 0; n < 400 && talk.value("u", "lOrder") != 0; ++n) talk.pass(kMs);
    EXPECT_EQ(talk.value("u", "lOrder"), 0);
  }
  // The result of SCD_TRCYCL.
  int64_t cyclic(int64_t object, int64_t cycle, int64_t offset = 0, int64_t format = 8, int64_t data = 300) {
    const std::pair<const char*, int64_t> members[] = {{"Tr.ObjectNo", object}, {"Tr.CycleTime", cycle},
                                                       {"Tr.Offset", offset},   {"Tr.Format", format},
                                                       {"Tr.DPointer", data},   {"Tr.Result", 12345}};
    for (const auto& [name, value] : members) talk.set("u", name, value);
    order(1);
    return talk.value("u", "Tr.Result");
  }
  void receive(int64_t object, int64_t format = 8, int64_t data = 310) {
    talk.set("u", "Rec.ObjectNo", object);
    talk.set("u", "Rec.Format", format);
    talk.set("u", "Rec.DPointer", data);
    order(2);
  }
  int64_t acyclic(int64_t object, int64_t format = 8, int64_t data = 300) {
    talk.set("u", "Ac.ObjectNo", object);
    talk.set("u", "Ac.Format", format);
    talk.set("u", "Ac.DPointer", data);
    talk.set("u", "Ac.Result", 12345);
    order(3);
    return talk.value("u", "lFirst");
  }
  void start() {
    talk.heard();
    order(4);
  }
  void variable(int number, int64_t value) { talk.set("u", ("H" + std::to_string(number)).c_str(), value); }
  int64_t variable(int number) { return talk.value("u", ("H" + std::to_string(number)).c_str()); }
  Talk talk;
};

TEST(ObjectRows, ResultIsTheFreeCapacity) {
  PROVES("SCOM-11");
  Objects objects;
  EXPECT_EQ(objects.cyclic(1024, 100), 99);  // figures 36, 39, 40
  EXPECT_TRUE(objects.talk.heard().empty()) << "before _SBusCommOn";
  int64_t before = 99;
  for (int64_t id = 1025; id < 1030; ++id) {
    const int64_t result = objects.cyclic(id, 10);
    EXPECT_LE(result, before);
    EXPECT_GE(result, 0);
    before = result;
  }
}

TEST(ObjectRows, CycleTimes) {
  PROVES("SCOM-07");
  Objects objects;
  for (const int64_t cycle : {int64_t{0}, int64_t{-1}, int64_t{11}, int64_t{15}, int64_t{65'531},
                              int64_t{65'540}, int64_t{INT32_MAX}, int64_t{INT32_MIN}})
    EXPECT_EQ(objects.cyclic(1100, cycle, 0, 0), kWrong) << cycle;
  int64_t id = 1024;
  for (const int64_t cycle : {1, 9, 10, 20, 65'530}) EXPECT_GE(objects.cyclic(id++, cycle, 0, 0), 0) << cycle;
  objects.start();
  objects.talk.pass(100 * kMs);
  const auto frames = objects.talk.heard();
  EXPECT_GE(frames.size(), 100U);
  for (const HeardFrame& frame : frames) EXPECT_LT(std::stoul(frame.text), 1100U) << "the refused one";
}

TEST(ObjectRows, Offsets) {
  PROVES("SCOM-08");
  Objects objects;
  int64_t id = 1024;
  for (const auto& [cycle, offset, good] : {std::tuple{5, 65'534, true},
                                            {10, 65'530, true},
                                            {50, 120, true},
                                            {5, 65'535, false},
                                            {10, 65'534, false},
                                            {10, 5, false},
                                            {10, -10, false},
                                            {5, -1, false}}) {
    const int64_t result = objects.cyclic(id++, cycle, offset, 0);
    EXPECT_EQ(result >= 0, good) << cycle << ' ' << offset;
    if (!good) {
      EXPECT_EQ(result, kWrong);
    }
  }
}

TEST(ObjectRows, AtMostFiveFastAndTenSlowOnes) {
  PROVES("SCOM-09");
  Objects objects;
  for (int n = 0; n < 5; ++n) EXPECT_GE(objects.cyclic(1024 + n, 5, 0, 0), 0);
  EXPECT_EQ(objects.cyclic(1040, 5, 0, 0), kTooMany);
  for (int n = 0; n < 10; ++n) EXPECT_GE(objects.cyclic(1050 + n, 100, 0, 0), 0);
  EXPECT_EQ(objects.cyclic(1041, 100, 0, 0), kTooMany);
  objects.start();
  objects.talk.pass(120 * kMs);
  std::set<uint32_t> sent;
  for (const HeardFrame& frame : objects.talk.heard())
    sent.insert(static_cast<uint32_t>(std::stoul(frame.text)));
  EXPECT_EQ(sent.size(), 15U) << "those accepted before go on";
  EXPECT_FALSE(sent.contains(1040) || sent.contains(1041));
}

// 70 % of 125 kbit/s are 87 500; a frame of 8 octets has 135 bits at most: 67 500 of one every 2 ms, and 22 % are left.
TEST(ObjectRows, OverloadIsRefused) {
  PROVES("SCOM-10");
  Objects objects("md60a", "P813 = 0\nP816 = 0\n", "", 125'000);
  EXPECT_EQ(objects.cyclic(1024, 2), 22);
  EXPECT_EQ(objects.cyclic(1025, 2), kOverload);
  EXPECT_EQ(objects.cyclic(1026, 10), 7) << "81 000 of 87 500";
  objects.start();
  objects.talk.pass(50 * kMs);
  std::set<uint32_t> sent;
  for (const HeardFrame& frame : objects.talk.heard())
    sent.insert(static_cast<uint32_t>(std::stoul(frame.text)));
  EXPECT_EQ(sent, (std::set<uint32_t>{1024, 1026}));
}

TEST(ObjectRows, NothingBeforeTheStartAndAfterTheStop) {
  PROVES("SCOM-12", "M07-SCOM-24");
  for (const char* unit : {"md60a", "mc07"}) {
    Objects objects(unit);
    EXPECT_GE(objects.cyclic(1024, 10), 0);
    objects.receive(1025);
    objects.talk.send("1025 # 55 66 77 88 11 22 33 44");
    objects.talk.pass(50 * kMs);
    EXPECT_TRUE(objects.talk.heard().empty());
    EXPECT_EQ(objects.variable(310), 0);
    objects.start();
    objects.talk.send("1025 # 55 66 77 88 11 22 33 44");
    objects.talk.send("1026 # 01 02 03 04 05 06 07 08");
    objects.talk.pass(50 * kMs);
    EXPECT_GE(objects.talk.heard().size(), 4U);
    EXPECT_EQ(objects.variable(310), 0x1122'3344);
    EXPECT_EQ(objects.variable(311), 0x5566'7788);
    EXPECT_EQ(ipos_plant_program(objects.talk.plant(), 0, IPOS_PLANT_PROGRAM_STOP), IPOS_PLANT_OK);
    objects.talk.pass(20 * kMs);
    objects.talk.heard();
    objects.talk.send("1025 # 00 00 00 01 00 00 00 02");
    objects.talk.pass(100 * kMs);
    EXPECT_TRUE(objects.talk.heard().empty()) << unit;
    EXPECT_EQ(objects.variable(310), 0x1122'3344) << unit;
  }
}

// Figure 38: cycle 50 ms, offset 120 ms; counted from an object without offset that begins with the start.
TEST(ObjectRows, SendTimesFollowOffsetAndCycle) {
  PROVES("SCOM-13", "EX-28", "M07-SCOM-29");
  for (const char* unit : {"md60a", "mc07"}) {
    Objects objects(unit);
    EXPECT_GE(objects.cyclic(1024, 100, 0), 0);
    EXPECT_GE(objects.cyclic(1025, 50, 120), 0);
    objects.start();
    std::vector<int64_t> first, second;
    objects.talk.pass(301 * kMs);
    int64_t begin = -1;
    for (const HeardFrame& frame : objects.talk.heard()) {
      if (begin < 0) begin = frame.time / kMs;
      const int64_t ms = frame.time / kMs - begin;
      if (ms > 300) continue;
      (frame.text.starts_with("1024") ? first : second).push_back(ms);
    }
    EXPECT_EQ(first, (std::vector<int64_t>{0, 100, 200, 300})) << unit;
    EXPECT_EQ(second, (std::vector<int64_t>{120, 170, 220, 270})) << unit;
  }
}

TEST(ObjectRows, SendsThePresentValues) {
  PROVES("SCOM-14");
  Objects objects;
  EXPECT_GE(objects.cyclic(1024, 10, 0, 4), 0);
  objects.start();
  for (const int value : {1, 2, 77}) {
    objects.variable(300, value);
    objects.talk.heard();
    objects.talk.pass(10 * kMs);
    const auto frames = objects.talk.heard();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].text, "1024 # " + value_text(value));
  }
}

TEST(ObjectRows, ThirtyTwoReceiveObjects) {
  PROVES("SCOM-15");
  Objects objects;
  for (int n = 0; n < 33; ++n) objects.receive(1100 + n, 4, 100 + n);
  EXPECT_GE(objects.talk.told("1132"), 1) << "the one too many is named";
  objects.start();
  for (int n = 0; n < 33; ++n)
    objects.talk.send(frame_text(static_cast<uint32_t>(1100 + n), value_text(n + 1)));
  objects.talk.pass(50 * kMs);
  for (int n = 0; n < 33; ++n) EXPECT_EQ(objects.variable(100 + n), n < 32 ? n + 1 : 0) << n;
}

TEST(ObjectRows, OneShotTelegramAndItsStatus) {
  PROVES("SCOM-17");
  Objects good("md60a", "P813 = 0\n", "", 500'000, 40);  // the next command comes before the frame has gone
  good.variable(300, 0x1122'3344);
  good.variable(301, 0x5566'7788);
  EXPECT_EQ(good.acyclic(1024), 1) << "under way";
  good.talk.pass(5 * kMs);
  EXPECT_EQ(good.talk.value("u", "Ac.Result"), 2) << "sent";
  EXPECT_EQ(good.talk.heard().at(0).text, "1024 # 55 66 77 88 11 22 33 44");
  for (const bool alone : {true, false}) {
    Objects bad("md60a", "P813 = 0\n",
                alone ? "" : "[[fault]]\nbus = \"sbus\"\nkind = \"short\"\nuntil = \"1s\"\n", 500'000, 0,
                alone);
    bad.acyclic(1024);
    bad.talk.pass(100 * kMs);
    EXPECT_EQ(bad.talk.value("u", "Ac.Result"), 3) << "failed";
  }
}

TEST(ObjectRows, IdentifiersAreUsedOnce) {
  PROVES("VAR-04");
  for (const auto& [address, group] : {std::pair{0, 0}, {9, 63}}) {
    Objects objects("md60a",
                    "P813 = " + std::to_string(address) + "\nP814 = " + std::to_string(group) + "\n");
    const int own[] = {8 * address + 3,   8 * address + 4,   8 * address + 5, 8 * group + 6,
                       8 * address + 515, 8 * address + 516, 8 * group + 518};
    int told = 0;
    for (const int id : own) {
      EXPECT_LT(objects.cyclic(id, 100), 0) << id;
      objects.receive(id);
      EXPECT_EQ(objects.acyclic(id), 3) << id;
      EXPECT_GT(objects.talk.told("is an identifier of the unit's own MOVILINK telegrams"), told) << id;
      told = objects.talk.told("is an identifier of the unit's own MOVILINK telegrams");
    }
    // Their neighbours are free.
    EXPECT_GE(objects.cyclic(8 * address + 7, 100), 0);
    EXPECT_GE(objects.cyclic(1024, 100), 0);
    EXPECT_LT(objects.cyclic(1024, 100), 0) << "used twice";
    objects.receive(1024);
    EXPECT_GE(objects.talk.told("would be sent and received by this unit"), 1);
  }
}

// The low octets of 55667788 11223344h, whose high half is the second variable: highest first in MOTOROLA format, lowest first
// in INTEL format (100h); 8 of them are those that the manuals print.
std::string octets(int length, bool intel) {
  const uint64_t value = 0x5566'7788'1122'3344;
  Bytes bytes;
  for (int n = 0; n < length; ++n)
    bytes.push_back(static_cast<uint8_t>(value >> 8 * (intel ? n : length - 1 - n)));
  return text_of(bytes.data(), bytes.size());
}

TEST(ObjectRows, FormatsAndOctets) {
  PROVES("VAR-07", "VAR-08", "VAR-12", "M07-SCOM-22", "M07-SCOM-23", "M07-SCOM-27", "M07-SCOM-28");
  EXPECT_EQ(octets(8, false), "55 66 77 88 11 22 33 44");
  EXPECT_EQ(octets(8, true), "44 33 22 11 88 77 66 55");
  for (const char* unit : {"md60a", "mc07"})
    for (const bool intel : {false, true}) {
      Objects objects(unit);
      objects.variable(300, 0x1122'3344);
      objects.variable(301, 0x5566'7788);
      for (const int wrong : {9, 0x200, 0x109, -1})
        EXPECT_LT(objects.cyclic(1200, 100, 0, wrong), 0) << wrong;
      for (int n = 0; n <= 8; ++n) objects.receive(1300 + n, (intel ? 0x100 : 0) + n, 100 + 2 * n);
      for (int n = 0; n <= 8; ++n) EXPECT_GE(objects.cyclic(1100 + n, 100, 0, (intel ? 0x100 : 0) + n), 0);
      for (int n = 0; n <= 8; ++n)
        for (int half = 0; half < 2; ++half) objects.variable(100 + 2 * n + half, -1);
      objects.start();
      objects.talk.pass(20 * kMs);
      const auto frames = objects.talk.heard();
      ASSERT_EQ(frames.size(), 9U) << unit;
      for (int n = 0; n <= 8; ++n) {
        EXPECT_EQ(frames[static_cast<size_t>(n)].text,
                  frame_text(static_cast<uint32_t>(1100 + n), octets(n, intel)))
            << unit << ' ' << n;
        objects.talk.send(frame_text(static_cast<uint32_t>(1300 + n), octets(n, intel)));
      }
      objects.talk.pass(20 * kMs);
      for (int n = 1; n <= 8; ++n) {
        const uint64_t low = 0x5566'7788'1122'3344 & (n == 8 ? UINT64_MAX : (uint64_t{1} << 8 * n) - 1);
        EXPECT_EQ(static_cast<uint32_t>(objects.variable(100 + 2 * n)), static_cast<uint32_t>(low))
            << unit << ' ' << n;
        // The second variable takes part from the fifth octet on.
        EXPECT_EQ(static_cast<uint32_t>(objects.variable(101 + 2 * n)),
                  n > 4 ? static_cast<uint32_t>(low >> 32) : UINT32_MAX)
            << unit << ' ' << n;
      }
    }
}

TEST(ObjectRows, AFrameOfAnotherLengthIsIgnored) {
  PROVES("VAR-13");
  Objects objects;
  objects.receive(1025);
  objects.receive(1026, 3, 320);
  objects.start();
  objects.variable(310, 5);
  objects.variable(320, -1);
  objects.variable(321, -1);
  objects.talk.send("1025 # 01 02 03 04 05 06");
  objects.talk.send("1026 # 01 02 03");
  objects.talk.pass(10 * kMs);
  EXPECT_EQ(objects.variable(310), 5);
  EXPECT_GE(objects.talk.told("object 401h (1025) came with 6 bytes"), 1);
  EXPECT_EQ(objects.variable(320), 0x01'0203) << "the missing octet is 0";
  EXPECT_EQ(objects.variable(321), -1) << "not covered";
}

TEST(ObjectRows, ObjectsOfMovitrac07) {
  PROVES("M07-SCOM-18", "M07-SCOM-19", "M07-SCOM-20");
  Objects objects("mc07");
  for (const int64_t cycle : {15, 5, 0, 65'540}) EXPECT_EQ(objects.cyclic(1024, cycle), kWrong);
  EXPECT_EQ(objects.cyclic(1024, 10, 15), kWrong);
  for (int n = 0; n < 10; ++n) {
    const int64_t result = objects.cyclic(1024 + n,
                                          n == 0   ? 10
                                          : n == 1 ? 65'530
                                                   : 100,
                                          n == 1 ? 65'530 : 0, n % 2 == 0 ? 8 : 0x108);
    EXPECT_GE(result, 0);
    EXPECT_LE(result, 100);
  }
  EXPECT_EQ(objects.cyclic(1040, 100), kTooMany);
  for (int n = 0; n < 32; ++n) objects.receive(1100 + n, 4, 100 + n);
  EXPECT_EQ(objects.talk.told("1131"), 0);
  objects.receive(1132, 4, 132);
  EXPECT_GE(objects.talk.told("1132"), 1);
  // 13 500 bit/s of each, 87 500 may be used.
  Objects slow("mc07", "P813 = 0\nP816 = 0\n", "", 125'000);
  for (int n = 0; n < 6; ++n) EXPECT_GE(slow.cyclic(1024 + n, 10), 0);
  EXPECT_EQ(slow.cyclic(1030, 10), kOverload);
}

// --- spellings

std::string program(const std::string& command, const std::string& format, const std::string& cycle) {
  return "#include <const.h>\nSCTRCYCL TrCycl; long lTrDataLow, lTrDataHigh; SCREC Rec; SCTRACYCL "
         "Ac;\nmain()\n{\n"
         " TrCycl.ObjectNo = 1024; TrCycl." +
         cycle + " = 10; TrCycl.Offset = 0; TrCycl." + format +
         " = 8; "
         "TrCycl.DPointer = numof(lTrDataLow);\n Rec.ObjectNo = 1025; Rec.Format = 8; Rec.DPointer = "
         "numof(lTrDataLow);\n"
         " Ac.ObjectNo = 1026; Ac.Format = 8; Ac.DPointer = numof(lTrDataLow);\n " +
         command + "(SCD_TRCYCL, TrCycl);\n " + command + "(SCD_REC, Rec);\n " + command +
         "(SCD_TRACYCL, Ac);\n _SBusCommOn();\n while (1) {}\n}\n";
}
const std::string kTwo = can_bus() +
                         unit_on("sbus = \"sbus\"\nprogram = \"P.IPC\"\n", "u", "md60a", "P813 = 0\n") +
                         on_sbus("v", "md60a", "P813 = 1\n");

// One number over everything that has happened in half a second.
uint64_t hash_of(const std::string& text) {
  const OpenedPlant plant(kTwo, text);
  plant.run(500);
  uint64_t hash = 0;
  EXPECT_EQ(ipos_plant_trace_hash(plant.plant, &hash), IPOS_PLANT_OK) << plant.message();
  EXPECT_FALSE(plant.frames().empty());
  return hash;
}

TEST(ObjectRows, NamesAndSpellings) {
  PROVES("SCOM-01", "SCOM-06", "M07-SCOM-33");
  const uint64_t printed = hash_of(program("_SBusCommDef", "Format", "CycleTime"));
  EXPECT_EQ(hash_of(program("_SBusComDef", "Format", "CycleTime")), printed);
  EXPECT_EQ(hash_of(program("_SBusCommDef", "Len", "CycleTime")), printed);
  EXPECT_EQ(hash_of(program("_SBusCommDef", "Format", "Cycletime")), printed);
}

TEST(ObjectRows, KindsAndStructures) {
  PROVES("SCOM-02", "SCOM-03");
  Talk talk(kTwo, program("_SBusCommDef", "Format", "CycleTime"));
  talk.pass(50 * kMs);
  // TrCycl is at H420, the data behind its six variables at H426.
  EXPECT_EQ(talk.value("u", "H420"), 1024);
  EXPECT_EQ(talk.value("u", "TrCycl.DPointer"), 426);
  talk.set("u", "H426", 0x1122'3344);
  talk.set("u", "H427", 0x5566'7788);
  talk.heard();
  talk.pass(10 * kMs);
  EXPECT_EQ(talk.heard().at(0).text, "1024 # 55 66 77 88 11 22 33 44");
  EXPECT_EQ(talk.value("u", "Ac.Result"), 2) << "all three kinds were carried out";
  talk.send("1025 # 00 00 00 02 00 00 00 01");
  talk.pass(5 * kMs);
  EXPECT_EQ(talk.value("u", "H426"), 1);
  for (const char* wrong : {"SCD_NONE", "7", "0"}) {
    std::string text = program("_SBusCommDef", "Format", "CycleTime");
    text.replace(text.find("SCD_TRCYCL"), 10, wrong);
    const OwnFolder folder;
    folder.write("P.IPC", text);
    const std::string path = folder.path();
    ipos_plant_source source{};
    source.text = kTwo.c_str();
    source.folder = path.c_str();
    ipos_plant* plant = nullptr;
    EXPECT_EQ(ipos_plant_open(&source, &plant), IPOS_PLANT_BAD_PLANT) << wrong;
    EXPECT_GE(ipos_plant_mistakes(plant), 1U) << wrong;
    EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
  }
}

}  // namespace
}  // namespace ipos::tests
