// SBus telegrams of the manuals (1053 1610 chapters 4.3 and 5, MOVITRAC 07 chapter 4): octets of the rows sent to units of a plant,
// octets of the rows heard.
#include <set>

#include "tests/harness/proves.hpp"
#include "tests/runtime/manuals/talk.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kRead8318 = "31 00 20 7E 00 00 00 00";
const Texts kNothing;

// The unit of the samples: address 1, group 2, sync telegram 0.
std::string one(const std::string& parameters = "", const std::string& more = "") {
  return can_bus() + on_sbus("u", "md60a", "P813 = 1\nP814 = 2\n" + parameters, more);
}
std::string write_p130(int value, const std::string& management = "32") {
  return management + " 00 21 16 " + value_text(value);
}

struct Identifiers {
  int address;
  uint32_t po, pi, po_sync, request, response;
};

TEST(SbusRows, IdentifiersOfEachAddress) {
  PROVES("SBUS-02", "SBUS-03", "SBUS-04", "SBUS-06", "M07-SBUS-03", "M07-SBUS-04");
  const Identifiers printed[] = {{0, 3, 4, 5, 515, 516},
                                 {1, 11, 12, 13, 523, 524},
                                 {17, 139, 140, 141, 651, 652},
                                 {33, 267, 268, 269, 779, 780},
                                 {63, 507, 508, 509, 1019, 1020}};
  for (const char* unit : {"md60a", "mc07"})
    for (const Identifiers& row : printed) {
      const bool synchronous = std::string(unit) == "md60a";
      Talk talk(can_bus() + on_sbus("u", unit,
                                    "P813 = " + std::to_string(row.address) +
                                        (synchronous ? "\nP817 = 2000000\n" : "\n")));
      talk.pass(10 * kMs);
      const auto id_of_answer = [&](uint32_t id, const std::string& bytes) {
        const Texts answers = talk.ask(frame_text(id, bytes));
        return answers.size() == 1 ? static_cast<uint32_t>(std::stoul(answers[0])) : 0;
      };
      EXPECT_EQ(id_of_answer(row.po, "00 06 00 00 00 00"), row.pi) << unit << ' ' << row.address;
      EXPECT_EQ(id_of_answer(row.request, kRead8318), row.response) << unit << ' ' << row.address;
      EXPECT_EQ(talk.ask(frame_text(row.po_sync, "00 06 00 07 00 00")), kNothing);
      EXPECT_EQ(id_of_answer(2000, ""), synchronous ? row.pi : 0) << unit << ' ' << row.address;
      EXPECT_EQ(talk.value("u", "PO2"), synchronous ? 7 : 0);
    }
}

TEST(SbusRows, IdentifiersOfEachGroup) {
  PROVES("SBUS-05", "SBUS-08", "M07-SBUS-05");
  for (const char* unit : {"md60a", "mc07"})
    for (const auto& [group, po, request] : {std::tuple{0, 6U, 518U}, {2, 22U, 534U}, {63, 510U, 1022U}}) {
      Talk talk(can_bus() + on_sbus("u", unit, "P813 = 9\nP814 = " + std::to_string(group) + "\n"));
      talk.pass(10 * kMs);
      EXPECT_EQ(talk.ask(frame_text(po, "00 06 00 07 00 00")), kNothing);
      EXPECT_EQ(talk.value("u", "PO2"), 7) << unit << ' ' << group;
      EXPECT_EQ(talk.ask(frame_text(request, "32 00 21 45 00 0F 42 40")), kNothing);  // P302 := 1000 rpm
      EXPECT_EQ(talk.value("u", "P302"), 1'000'000) << unit << ' ' << group;
    }
}

// Every standard identifier, with the octets of process data and with those of a write: what the unit reacts to.
TEST(SbusRows, ReactsToItsOwnIdentifiersOnly) {
  PROVES("SBUS-01", "SBUS-09", "SYNC-03", "M07-SBUS-01", "M07-SBUS-02");
  const struct {
    const char* unit;
    const char* parameters;
    std::set<uint32_t> identifiers;
  } rows[] = {{"md60a", "P813 = 7\nP814 = 2\nP817 = 2047000\n", {22, 59, 61, 534, 571, 2047}},
              {"mc07", "P813 = 33\nP814 = 50\n", {267, 406, 779, 918}}};
  for (const auto& row : rows) {
    Talk talk(can_bus() + on_sbus("u", row.unit, row.parameters));
    talk.pass(10 * kMs);
    std::set<uint32_t> mine;
    for (uint32_t id = 0; id < 2048; ++id) {
      const auto before = std::pair(talk.value("u", "PO2"), talk.value("u", "P302"));
      const Texts to_words =
          talk.ask(frame_text(id, "00 06 " + word_text(static_cast<int>(id + 1)) + " 00 00"), 10 * kMs);
      const int64_t speed = 100'000 + 1000 * static_cast<int64_t>(id);
      const Texts to_write = talk.ask(frame_text(id, "32 00 21 45 " + value_text(speed)), 10 * kMs);
      const bool waits = id == 61 && before.first != talk.value("u", "PO2");
      EXPECT_FALSE(waits) << "synchronous words act at the sync telegram";
      if (!to_words.empty() || !to_write.empty() ||
          before != std::pair(talk.value("u", "PO2"), talk.value("u", "P302")))
        mine.insert(id);
    }
    // The words that 61 brought are there since 2047 came.
    if (row.identifiers.contains(2047)) {
      EXPECT_EQ(talk.value("u", "PO2"), 62);
      mine.insert(61);
    }
    EXPECT_EQ(mine, row.identifiers) << row.unit;
    // Telegrams are standard frames; an extended one is not heard as one, and the journal says so.
    ipos_plant_frame extended{};
    extended.id = row.unit == std::string("md60a") ? 59 : 267;
    extended.flags = IPOS_PLANT_EXTENDED;
    extended.length = 6;
    EXPECT_EQ(talk.ask(extended), kNothing);
    EXPECT_GE(talk.told("extended"), 1) << row.unit;
  }
}

// All 64 addresses at once on one line would be too many stations; each alone has its numbers between 3 and 1022.
TEST(SbusRows, MovilinkKeepsBit10Clear) {
  PROVES("M07-SBUS-01", "M07-SBUS-02", "M07-SBUS-06");
  for (int address = 0; address < 64; ++address) {
    Talk talk(can_bus() +
              on_sbus("u", "mc07",
                      "P813 = " + std::to_string(address) + "\nP814 = " + std::to_string(address) + "\n"));
    talk.pass(5 * kMs);
    const auto at = static_cast<uint32_t>(8 * address);
    const Texts pi = talk.ask(frame_text(at + 3, "00 06 00 01 00 00"), 5 * kMs);
    ASSERT_EQ(pi.size(), 1U) << address;
    EXPECT_EQ(std::stoul(pi[0]), at + 4) << address;
    EXPECT_EQ(talk.ask(frame_text(at + 6, "00 06 00 02 00 00"), 5 * kMs), kNothing) << "its group's";
    EXPECT_EQ(talk.value("u", "PO2"), 2);
    EXPECT_EQ(std::stoul(talk.ask(frame_text(at + 515, kRead8318), 5 * kMs).at(0)), at + 516);
  }
}

TEST(SbusRows, ReadAndRefusedWrite) {
  PROVES("EX-10", "EX-34", "MLK-05", "MLK-08", "MLK-13");
  Talk talk(one());
  talk.pass(10 * kMs);
  EXPECT_EQ(talk.ask(frame_text(523, kRead8318)), Texts{"524 # 31 00 20 7E 00 00 00 00"});
  EXPECT_EQ(talk.ask("523 # 32 00 20 7E 00 00 00 01"), Texts{"524 # B2 00 20 7E 08 00 00 12"});
  EXPECT_EQ(talk.ask("523 # 3F 00 20 7E 00 00 00 00"), Texts{"524 # BF 00 20 7E 05 05 00 00"});
  for (const int code : {0x39, 0x3A, 0x3B, 0x3C, 0x3D, 0x3E, 0x3F, 0x02, 0x12, 0x22, 0x03, 0x13, 0x23}) {
    const std::string low = word_text(code).substr(3);
    const std::string management = word_text(0xB0 | (code & 0x0F)).substr(3);
    EXPECT_EQ(talk.ask("523 # " + low + " 00 21 16 00 00 03 E8"),
              Texts{"524 # " + management + " 00 21 16 05 05 00 00"});
  }
  EXPECT_EQ(talk.value("u", "P130"), 2000) << "nothing was written";
}

// MLK-02: service codes; SBUS-18: bit 6 waits for the sync telegram.
TEST(SbusRows, EveryManagementByte) {
  PROVES("MLK-02", "MLK-03", "SBUS-18");
  Talk talk(one());
  talk.pass(10 * kMs);
  for (int code = 0; code < 256; ++code) {
    talk.set("u", "P130", 2000);
    const int service = code % 16;
    const bool writes = service == 2 || service == 3;
    const bool good = service <= 8 && (!writes || code / 16 % 4 == 3);
    const std::string low = word_text(code).substr(3);
    const Texts at_once = talk.ask("523 # " + low + " 00 21 16 00 00 0B B8", 5 * kMs);
    const Texts at_sync = talk.ask("0 #", 5 * kMs);
    const bool synchronous = (code & 0x40) != 0;
    const Texts& answer = synchronous ? at_sync : at_once;
    ASSERT_EQ(answer.size(), 1U) << code;
    EXPECT_TRUE((synchronous ? at_once : at_sync).empty()) << code;
    const std::string management = word_text((good ? 0x30 : 0xB0) | (code & 0x4F)).substr(3);
    EXPECT_EQ(answer[0].substr(0, 17), "524 # " + management + " 00 21 16") << code;
    EXPECT_EQ(talk.value("u", "P130"), good && writes ? 3000 : 2000) << code;
    if (!good) {
      EXPECT_EQ(answer[0].substr(18), "05 05 00 00") << code;
    }
  }
}

TEST(SbusRows, ParameterChannel) {
  PROVES("MLK-01", "MLK-07", "MLK-12");
  Talk talk(one());
  talk.pass(10 * kMs);
  EXPECT_EQ(talk.ask("523 # 32 00 21 16 00 00 0B B8"), Texts{"524 # 32 00 21 16 00 00 0B B8"});
  EXPECT_EQ(talk.value("u", "P130"), 3000) << "the last octet is the least one";
  // A negative value, FF FF FF FF for -1: in a variable, H5.
  EXPECT_EQ(talk.ask("523 # 33 00 2A FD FF FF FF FF"), Texts{"524 # 33 00 2A FD FF FF FF FF"});
  EXPECT_EQ(talk.value("u", "H5"), -1);
  EXPECT_EQ(talk.ask("523 # 31 00 2A FD 00 00 00 00"), Texts{"524 # 31 00 2A FD FF FF FF FF"});
  // The reserved octet is 0 in every answer, and what a request has there does not count (ours).
  EXPECT_EQ(talk.ask("523 # 31 55 21 16 00 00 00 00"), Texts{"524 # 31 00 21 16 00 00 0B B8"});
  // Data and length of a read do not count.
  EXPECT_EQ(talk.ask("523 # 01 00 21 16 FF FF FF FF"), Texts{"524 # 31 00 21 16 00 00 0B B8"});
}

// EX-14: the drive turns with 1000 rpm; the three PI words are those of the sample, from a program.
TEST(SbusRows, FramesOfTheSample) {
  PROVES("EX-14");
  Talk talk(can_bus() + unit_on("sbus = \"sbus\"\nprogram = \"P.IPC\"\n", "u", "md60a",
                                "P813 = 1\nP100 = 10\nP101 = 3\nP872 = 5\nP873 = 9\nP874 = 9\nP875 = 9\n",
                                kEnabled),
            "#include <const.h>\nSSPIDATA3 Pi;\nmain() { Pi.PI1 = 7; Pi.PI2 = 5011; Pi.PI3 = 0;"
            " while (1) { _SetSys(SS_PIDATA, Pi); } }\n");
  for (int n = 0; n < 300; ++n) talk.ask("11 # 00 06 13 88 3A 98", 10 * kMs);
  EXPECT_EQ(talk.ask("11 # 00 06 13 88 3A 98"), Texts{"12 # 00 07 13 93 00 00"});
  EXPECT_EQ(talk.ask("523 # 31 00 20 7E 00 00 00 00"), Texts{"524 # 31 00 20 7E 00 0F 42 40"});
}

std::string three(const std::string& unit, const std::string& group) {
  return can_bus() + on_sbus("a", unit, "P813 = 5\n" + group) + on_sbus("b", unit, "P813 = 6\n" + group) +
         on_sbus("c", unit, "P813 = 7\n" + group) + on_sbus("d", unit, "P813 = 8\nP814 = 3\n");
}
constexpr const char* kGroup[] = {"a", "b", "c"};

TEST(SbusRows, GroupTelegramsAreTakenInSilence) {
  PROVES("PD-03", "SBUS-20", "M07-SBUS-16", "M07-SBUS-18");
  for (const char* unit : {"md60a", "mc07"})
    for (const auto& [group, po, request] : {std::tuple{2, 22U, 534U}, {50, 406U, 918U}}) {
      Talk talk(three(unit, "P814 = " + std::to_string(group) + "\n"));
      talk.pass(10 * kMs);
      EXPECT_EQ(talk.ask(frame_text(po, "00 06 00 64 00 C8")), kNothing);
      EXPECT_EQ(talk.ask(frame_text(request, "32 00 21 45 00 0F 42 40")), kNothing);
      for (const char* name : kGroup) {
        EXPECT_EQ(talk.value(name, "PO1"), 6);
        EXPECT_EQ(talk.value(name, "PO2"), 100);
        EXPECT_EQ(talk.value(name, "PO3"), 200);
        EXPECT_EQ(talk.value(name, "P302"), 1'000'000);
      }
      EXPECT_EQ(talk.value("d", "PO2"), 0);
      EXPECT_EQ(talk.value("d", "P302"), 1'500'000);
      // A read does nothing, a refused write says why in the journal only.
      EXPECT_EQ(talk.ask(frame_text(request, "31 00 21 45 00 00 00 01")), kNothing);
      EXPECT_EQ(talk.ask(frame_text(request, "32 00 20 7E 00 00 00 01")), kNothing);
      for (const char* name : kGroup) EXPECT_EQ(talk.value(name, "P302"), 1'000'000);
      EXPECT_GE(talk.told("read access only"), 1);
    }
}

TEST(SbusRows, AsynchronousOutputIsAnsweredWithinOneMillisecond) {
  PROVES("SYNC-09");
  Talk talk(one());
  talk.pass(10 * kMs);
  for (int64_t offset = 0; offset < 4 * kMs; offset += 137 * kUs) {
    talk.pass(offset);
    ASSERT_EQ(talk.ask("11 # 00 06 00 00 00 00", 5 * kMs).size(), 1U);
    EXPECT_LE(talk.last()[0].time - talk.sent(), kMs);
  }
}

TEST(SbusRows, SynchronousRequestsWaitForTheSyncTelegram) {
  PROVES("SYNC-04", "SYNC-05", "SYNC-06");
  Talk talk(one());
  talk.pass(10 * kMs);
  EXPECT_EQ(talk.ask("0 #", 2200 * kUs), kNothing);
  EXPECT_EQ(talk.ask(frame_text(523, write_p130(2500, "72")), 2 * kMs), kNothing);
  EXPECT_EQ(talk.value("u", "P130"), 2500) << "done on reception";
  EXPECT_EQ(talk.ask("11 # 00 06 00 00 00 00", 800 * kUs).size(), 1U) << "process data go on";
  EXPECT_EQ(talk.ask("0 #", 5 * kMs), Texts{frame_text(524, write_p130(2500, "72"))});
  EXPECT_LE(talk.last()[0].time - talk.sent(), kMs);
  EXPECT_EQ(talk.ask("0 #"), kNothing) << "once";
  EXPECT_EQ(talk.ask("523 # 71 00 20 7E 00 00 00 00", 1000 * kMs), kNothing) << "no sync telegram, no answer";
  EXPECT_EQ(talk.ask("0 #").size(), 1U);
}

TEST(SbusRows, SynchronousOutputTakesEffectAtTheSyncTelegram) {
  PROVES("SYNC-08", "SYNC-10");
  Talk talk(one() + on_sbus("v", "md60a", "P813 = 3\n"));
  talk.pass(10 * kMs);
  EXPECT_EQ(talk.ask("0 #", 3 * kMs), kNothing);
  EXPECT_EQ(talk.ask("29 # 00 06 00 09 00 00", 500 * kUs), kNothing);
  EXPECT_EQ(talk.ask("13 # 00 06 00 01 00 00", 500 * kUs), kNothing);
  EXPECT_EQ(talk.ask("13 # 00 06 00 02 00 00", kMs), kNothing);
  EXPECT_EQ(talk.value("u", "PO2"), 0);
  EXPECT_EQ(talk.value("v", "PO2"), 0);
  // Any length and content of the sync telegram (ours).
  const Texts answers = talk.ask("0 # 01 02 03 04 05 06 07 08", kMs);
  ASSERT_EQ(answers.size(), 2U) << "in the first millisecond";
  EXPECT_EQ(std::stoul(answers[0]), 12U);
  EXPECT_EQ(std::stoul(answers[1]), 28U);
  EXPECT_EQ(talk.value("u", "PO2"), 2) << "the last one counts";
  EXPECT_EQ(talk.value("v", "PO2"), 9);
}

TEST(SbusRows, TheSyncIdentifierMovesNothingElse) {
  PROVES("SYNC-03", "SBUS-21");
  for (const char* sync : {"0", "128000", "2047000"}) {
    Talk talk(one("P817 = " + std::string(sync) + "\n"));
    talk.pass(10 * kMs);
    EXPECT_EQ(talk.ask(frame_text(523, kRead8318)), Texts{"524 # 31 00 20 7E 00 00 00 00"}) << sync;
    EXPECT_EQ(talk.ask("523 # 71 00 20 7E 00 00 00 00"), kNothing);
    EXPECT_EQ(talk.ask(frame_text(static_cast<uint32_t>(std::stoul(sync) / 1000), "")).size(), 1U) << sync;
  }
}

TEST(SbusRows, SyncOfAMasterControl) {
  PROVES("SYNC-01", "SYNC-07");
  std::string plant = can_bus();
  for (int n = 1; n <= 3; ++n)
    plant += on_sbus("u" + std::to_string(n), "md60a", "P813 = " + std::to_string(n) + "\n");
  plant += "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\nsync = 0\ncycle = \"5ms\"\n";
  for (int n = 1; n <= 3; ++n)
    plant += "[[control.target]]\naddress = " + std::to_string(n) + "\npo = [6, " + std::to_string(100 * n) +
             ", 0]\n";
  Talk talk(plant);
  talk.run_to(499 * kMs);
  int syncs = 0, outputs = 0;
  for (const HeardFrame& frame : talk.heard()) {
    if (frame.text == "0 #") {
      EXPECT_EQ(frame.sender, "plc");
      EXPECT_GE(frame.time, 5 * kMs * syncs) << syncs;
      EXPECT_LT(frame.time, 5 * kMs * syncs + kMs) << syncs;
      ++syncs;
    } else if (frame.sender == "plc") {
      EXPECT_GE(frame.time % (5 * kMs), 2500 * kUs) << frame.text;
      EXPECT_LE(frame.time % (5 * kMs), 4500 * kUs) << frame.text;
      ++outputs;
    } else {
      EXPECT_LT(frame.time % (5 * kMs), kMs + 500 * kUs)
          << frame.text << ": PI words after the sync telegram";
    }
  }
  EXPECT_EQ(syncs, 100) << "every 5 ms, and nobody answers it";
  EXPECT_EQ(outputs, 300);
  for (int n = 1; n <= 3; ++n) EXPECT_EQ(talk.value(("u" + std::to_string(n)).c_str(), "PO2"), 100 * n);
  EXPECT_EQ(talk.told("synchronous PO telegram"), 0);
  // Outside of 1.5 to 4.5 ms of the cycle the journal warns.
  for (const auto& [at, warned] :
       {std::pair{1200 * kUs, 1}, {1700 * kUs, 0}, {4100 * kUs, 0}, {4800 * kUs, 1}}) {
    Talk other(one());
    other.run_to(10 * kMs);
    other.send("0 #");
    other.run_to(10 * kMs + at);
    other.send("13 # 00 06 00 00 00 00");
    other.pass(10 * kMs);
    EXPECT_EQ(other.told("synchronous PO telegram 00Dh (13)"), warned) << at;
  }
}

TEST(SbusRows, ThreeWordsEachWayAndOnlyOnRequest) {
  PROVES("M07-SBUS-14", "M07-SBUS-15", "M07-SBUS-17", "M07-PD-20");
  Talk talk(can_bus() + on_sbus("u", "mc07", "P813 = 33\n"));
  EXPECT_EQ(talk.answers(1000 * kMs), kNothing) << "no PI without PO";
  for (int n = 0; n < 10; ++n) {
    const Texts answer = talk.ask("267 # 00 06 07 D0 00 00");
    ASSERT_EQ(answer.size(), 1U);
    EXPECT_EQ(answer[0].substr(0, 5), "268 #");
    EXPECT_EQ(answer[0].size(), std::string("268 # 00 00 00 00 00 00").size());
    EXPECT_GT(talk.last()[0].time, talk.sent());
  }
  EXPECT_EQ(talk.value("u", "PO1"), 6) << "high octet first";
  EXPECT_EQ(talk.value("u", "PO2"), 2000);
  for (const char* other : {"267 #", "267 # 00 07", "267 # 00 07 00 01 00", "267 # 00 07 00 01 00 00 00",
                            "267 # 00 07 00 01 00 00 00 00"})
    EXPECT_EQ(talk.ask(other), kNothing) << other;
  EXPECT_EQ(talk.value("u", "PO1"), 6);
  const Texts response = talk.ask(frame_text(779, kRead8318));
  ASSERT_EQ(response.size(), 1U);
  EXPECT_EQ(response[0], "780 # 31 00 20 7E 00 00 00 00");
}

TEST(SbusRows, SingleAndGroupNumbersMayCoincide) {
  PROVES("M07-SBUS-06");
  Talk talk(can_bus() + on_sbus("u", "mc07", "P813 = 5\nP814 = 5\n"));
  talk.pass(10 * kMs);
  EXPECT_EQ(talk.ask("43 # 00 06 00 01 00 00").size(), 1U);
  EXPECT_EQ(talk.value("u", "PO2"), 1);
  EXPECT_EQ(talk.ask("46 # 00 06 00 02 00 00"), kNothing);
  EXPECT_EQ(talk.value("u", "PO2"), 2);
}

// Program of a master with one MOVLNK, address and format from the test.
std::string movlnk(int address, int format, int index = 8470, int service = 2) {
  return "#include <const.h>\nMOVLNK Ml; MLDATA Mld; long lDone;\nmain()\n{\n Ml.BusType = 5; Ml.Address = " +
         std::to_string(address) + "; Ml.Format = " + std::to_string(format) +
         "; Ml.Service = " + std::to_string(service) + "; Ml.Index = " + std::to_string(index) +
         "; Ml.DPointer = numof(Mld); Ml.Result = 99;\n Mld.WritePar = 2500; Mld.PO1 = 6; Mld.PO2 = -3750;\n"
         " _MoviLink(Ml);\n lDone = 1;\n while (1) {}\n}\n";
}
struct Movlnk {
  Movlnk(const std::string& slave, const std::string& program)
      : talk(can_bus() + unit_on("sbus = \"sbus\"\nprogram = \"P.IPC\"\n", "m", "md60a", "P813 = 0\n") +
                 on_sbus("u", "md60a", slave),
             program) {
    talk.pass(200 * kMs);
    for (const HeardFrame& frame : talk.heard()) frames.push_back(frame.text);
  }
  int64_t result() const { return talk.value("m", "Ml.Result"); }
  Talk talk;
  Texts frames;
};

TEST(SbusRows, AddressesOfMovlnk) {
  PROVES("MOVLNK-04", "SBUS-10");
  Movlnk group("P813 = 1\nP814 = 2\n", movlnk(102, 5));
  EXPECT_EQ(group.result(), 0);
  EXPECT_EQ(group.frames, Texts{"22 # 00 06 F1 5A 00 00"});
  for (const int wrong : {64, 99, 164}) {
    const Movlnk none("P813 = 1\n", movlnk(wrong, 5));
    EXPECT_NE(none.result(), 0) << wrong;
    EXPECT_NE(none.result(), 99) << wrong;
    EXPECT_TRUE(none.frames.empty());
  }
  // Group 63: 1022, above the 1020 of the technical data.
  const Movlnk last("P813 = 1\nP814 = 63\n", movlnk(163, 6));
  EXPECT_EQ(last.frames, Texts{"1022 # 32 00 21 16 00 00 09 C4"});
  EXPECT_EQ(last.talk.value("u", "P130"), 2500);
}

TEST(SbusRows, FormatsOfMovlnk) {
  PROVES("MOVLNK-12", "MOVLNK-16");
  const Movlnk words("P813 = 1\nP873 = 9\n", movlnk(1, 5, 12'345));
  EXPECT_EQ(words.result(), 0);
  ASSERT_EQ(words.frames.size(), 2U);
  EXPECT_EQ(words.frames[0], "11 # 00 06 F1 5A 00 00") << "PO2 = -3750 is F15Ah";
  EXPECT_EQ(words.frames[1].substr(0, 4), "12 #");
  const Movlnk parameter("P813 = 1\n", movlnk(1, 6));
  EXPECT_EQ(parameter.frames, (Texts{"523 # 32 00 21 16 00 00 09 C4", "524 # 32 00 21 16 00 00 09 C4"}));
  EXPECT_EQ(parameter.talk.value("u", "P130"), 2500);
  // PI words come back with their sign (ours).
  Talk talk(can_bus() + unit_on("sbus = \"sbus\"\nprogram = \"P.IPC\"\n", "m", "md60a", "P813 = 0\n"),
            movlnk(1, 5));
  for (int ms = 0; ms < 20 && talk.answers(kMs).empty(); ++ms) {
  }
  talk.send("12 # 02 02 F1 5A 00 01");
  talk.pass(10 * kMs);
  EXPECT_EQ(talk.value("m", "Mld.PI1"), 0x0202);
  EXPECT_EQ(talk.value("m", "Mld.PI2"), -3750);
  EXPECT_EQ(talk.value("m", "Mld.PI3"), 1);
}

TEST(SbusRows, MasterOfSetpointsSendsGroupTelegrams) {
  PROVES("MS-02");
  Talk talk(can_bus() + on_sbus("m", "md60a", "P813 = 1\nP814 = 2\nP750 = 2\n") +
            on_sbus("s", "md60a", "P813 = 2\nP814 = 2\nP100 = 8\n"));
  talk.run_to(100 * kMs);
  const std::vector<HeardFrame> frames = talk.heard();
  EXPECT_GE(frames.size(), 95U);
  for (const HeardFrame& frame : frames) {
    EXPECT_EQ(std::stoul(frame.text), 22U) << frame.text;
    EXPECT_EQ(frame.sender, "m");
  }
}

TEST(SbusRows, TwoSendersOfOneIdentifierCollide) {
  PROVES("DIAG-04");
  const std::string program =
      "#include <const.h>\nSCTRCYCL Tr; long lData;\nmain() { Tr.ObjectNo = 1024; Tr.CycleTime = 10;"
      " Tr.Offset = 0; Tr.Format = 4; Tr.DPointer = numof(lData); _SBusCommDef(SCD_TRCYCL, Tr); "
      "_SBusCommOn(); while (1) { lData = H10; } }\n";
  Talk talk(can_bus() + unit_on("sbus = \"sbus\"\nprogram = \"P.IPC\"\n", "a", "md60a", "P813 = 1\n") +
                unit_on("sbus = \"sbus\"\nprogram = \"P.IPC\"\n", "b", "md60a", "P813 = 2\n"),
            program);
  talk.set("a", "H10", 0x11);
  talk.set("b", "H10", 0x44);
  talk.pass(100 * kMs);
  EXPECT_GE(talk.told("a and b"), 1) << "both are named";
}

}  // namespace
}  // namespace ipos::tests
