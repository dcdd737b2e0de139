// Chapters that the manual of MDX60B/61B names and other manuals print (rows MDB-TOC): the same vectors on a MOVIDRIVE B.
#include <gtest/gtest.h>

#include "runtime/signals/variables.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

const std::string kEnabled = "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";

std::string serial_line(const std::string& name, int baud) {
  return "[[bus]]\nname = \"" + name + "\"\nkind = \"rs485\"\nbaud = " + std::to_string(baud) + "\n";
}

// One call a bus: reads P302 (8517), writes it, reads it again.
std::string calls() {
  std::string text =
      "#include <constb.h>\n#pragma globals 340 399\nMOVLNK Ml; MLDATA Mld; long lBefore[9]; long lAfter[9]; "
      "long lResult[9]; "
      "long nType;\n"
      "Call()\n{\n Ml.BusType = nType; Ml.Service = 1; _MoviLink(Ml); lBefore[nType] = "
      "Mld.ReadPar;\n"
      " lResult[nType] = Ml.Result;\n Ml.Service = 2; Mld.WritePar = 1000000 + nType * 1000; _MoviLink(Ml);\n"
      " Ml.Service = 1; _MoviLink(Ml); lAfter[nType] = Mld.ReadPar;\n}\n"
      "main()\n{\n Ml.Address = 1; Ml.Format = 134; Ml.Index = 8517; Ml.DPointer = numof(Mld);\n";
  for (const int type : {1, 2, 5, 8}) text += " nType = " + std::to_string(type) + "; Call();\n";
  return text + " while (1) {}\n}\n";
}

TEST(MdxChapters, MovlnkOverEachBus) {
  PROVES("MDB-TOC-01");
  const std::string lines = "rs485 = \"a\"\nrs485_xt = \"b\"\nsbus2 = \"sbus2\"\n";
  PlantRig rig(bus_text() + "[[bus]]\nname = \"sbus2\"\nkind = \"can\"\nbaud = 500000\n" +
                   serial_line("a", 9600) + serial_line("b", 57600) +
                   station_text("caller", "P881 = 2\nP891 = 2\n", "mdxb", "A.IPC", lines) +
                   station_text("called", "P810 = 1\nP881 = 1\nP891 = 1\n", "mdxb", "", lines),
               {{"A.IPC", calls()}});
  rig.run_until(3 * kSecond);
  int32_t before = 1'500'000;  // factory setting
  for (const int type : {1, 2, 5, 8}) {
    const auto element = [&](const char* array) {
      return rig.station(0).variable(*signals::find_variable(rig.station(0), array) + static_cast<uint32_t>(type));
    };
    EXPECT_EQ(element("lResult"), 0) << type;
    EXPECT_EQ(element("lBefore"), before) << type;
    before = 1'000'000 + 1000 * type;
    EXPECT_EQ(element("lAfter"), before) << type;
  }
}

// The follower runs as its master on CAN 1 does; the cable breaks, and P883 with P836 decide.
TEST(MdxChapters, MasterSlaveOverCan1) {
  PROVES("MDB-TOC-20");
  for (const int response : {0, 4}) {
    PlantRig rig(
        bus_text() + station_text("leader", "P881 = 1\nP882 = 5\nP750 = 2\nP160 = 600000\n", "mdxb") +
        kEnabled + "DI04 = 1\n" +
        station_text("follower",
                     "P881 = 2\nP882 = 5\nP100 = 8\nP883 = 100\nP836 = " + std::to_string(response) + "\n",
                     "mdxb") +
        "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI02 = 1\nDI03 = 1\n" +
        "[[fault]]\nbus = \"sbus\"\nkind = \"cut\"\nstation = \"leader\"\nfrom = \"3s\"\n");
    rig.run_until(3 * kSecond);
    EXPECT_EQ(rig.station(0).drive().state().speed(), 600'000);
    EXPECT_NEAR(rig.station(1).drive().state().speed(), 600'000, 200) << "a digit";
    rig.run_until(3090 * kMillisecond);
    EXPECT_EQ(rig.station(1).fault(), 0);
    rig.run_until(3110 * kMillisecond);
    EXPECT_EQ(rig.station(1).fault(), response == 0 ? 0 : 47);
    rig.run_until(6 * kSecond);
    EXPECT_NEAR(rig.station(1).drive().state().speed(), response == 0 ? 600'000 : 0, 200);
  }
}

// Unit states as MOVITRAC 07 has them, and the fault number in their place: F43 is 2Bh.
TEST(MdxChapters, StatesAndFaultsInStatusWord1) {
  PROVES("MDB-TOC-26");
  PlantRig rig(serial_line("a", 9600) + "[[station]]\nname = \"b\"\nunit = \"mdxb\"\nrs485 = \"a\"\n" +
               "[station.parameters]\nP100 = 2\nP101 = 1\nP812 = 200\nP833 = 4\nP810 = 1\n" + kEnabled);
  Bus& line = *rig.get().find_bus("a");
  line.attach_hand();
  const auto send = [&](const std::string& words) {
    EXPECT_EQ(line.send("02 01 03 " + words + " bcc"), std::nullopt);
    rig.run_until(rig.get().now() + 100 * kMillisecond);
    return rig.station(0).status_word_1() >> 8;
  };
  EXPECT_EQ(send("00 01 00 00"), 1) << "controller inhibit";
  EXPECT_EQ(send("00 00 00 00"), 2) << "no enable";
  EXPECT_EQ(send("00 06 13 88"), 4) << "enable";
  rig.run_until(rig.get().now() + kSecond);
  EXPECT_EQ(rig.station(0).status_word_1() >> 8, 0x2B);
  EXPECT_NE(rig.station(0).status_word_1() & 1 << 5, 0);
  EXPECT_EQ(rig.station(0).fault(), 43);
}

// Control word 2 and status words 2 and 3 have in their low bytes what MOVITRAC 07 prints of the first ones; of the rest the
// journal says that no manual read prints it.
TEST(MdxChapters, ControlAndStatusWordsOfTheProfile) {
  PROVES("MDB-TOC-25");
  for (const auto& [control, status] : {std::pair(9, 6), {10, 7}, {10, 11}}) {
    SCOPED_TRACE(status);
    PlantRig rig(serial_line("a", 9600) + "[[station]]\nname = \"b\"\nunit = \"mdxb\"\nrs485 = \"a\"\n" +
                 "[station.parameters]\nP100 = 2\nP101 = 1\nP810 = 1\nP301 = 0\nP870 = " + std::to_string(control) +
                 "\nP871 = 1\nP873 = " + std::to_string(status) + "\nP874 = 1\n" + kEnabled);
    Bus& line = *rig.get().find_bus("a");
    line.attach_hand();
    const auto send = [&](const std::string& words, int ms = 100) {
      EXPECT_EQ(line.send("02 01 03 " + words + " bcc"), std::nullopt);
      rig.run_until(rig.get().now() + ms * kMillisecond);
      return rig.station(0).drive().value("097") & 0xFF;
    };
    const auto rpm = [&] { return std::as_const(rig.station(0)).drive().value("000") / 1'000.0; };
    EXPECT_EQ(send("00 00 00 00"), 0x06) << "rapid stop: ready, process data enabled";
    EXPECT_EQ(send("00 06 13 88", 2'000), 0x07) << "enable";
    EXPECT_NEAR(rpm(), 1'000, 1);
    send("00 04 13 88", 3'000);
    EXPECT_EQ(rpm(), 0) << "rapid stop";
    send("00 06 13 88", 2'000);
    EXPECT_NEAR(rpm(), 1'000, 1);
    send("00 02 13 88", 3'000);
    EXPECT_EQ(rpm(), 0) << "stop";
    EXPECT_EQ(send("00 01 13 88"), 0x06) << "controller inhibit";
    rig.station(0).drive().state().raise_fault(26);
    EXPECT_EQ(send("00 00 00 00"), 0x24) << "fault, not ready";
    EXPECT_EQ(send("00 40 00 00"), 0x06) << "reset";
    EXPECT_EQ(rig.says("no manual read prints the bits of control word 2"), control == 10 ? 1U : 0U);
    EXPECT_EQ(rig.says("no manual read prints the bits of status word 2"), status == 7 ? 1U : 0U);
    EXPECT_EQ(rig.says("no manual read prints the bits of status word 3"), status == 11 ? 1U : 0U);
  }
}

// P130 (8470 = 2116h) is written: each service is a write of the EEPROM.
TEST(MdxChapters, CyclicChannelRunsOncePerToggle) {
  PROVES("MDB-TOC-27");
  PlantRig rig(bus_text() + serial_line("a", 9600) +
               station_text("b", "P810 = 1\n", "mdxb", "", "rs485 = \"a\"\n"));
  Bus& line = *rig.get().find_bus("a");
  line.attach_hand();
  const auto writes = [&] { return rig.station(0).drive().parameters().eeprom_writes(8470); };
  int value = 100;
  const auto send = [&](const std::string& type, const std::string& management, bool words) {
    value += 10;
    char data[12];
    std::snprintf(data, sizeof data, "%02X %02X", value >> 8, value & 0xFF);
    EXPECT_EQ(line.send("02 01 " + type + " " + management + " 00 21 16 00 00 " + data +
                        (words ? " 00 00 00 00 00 00" : "") + " bcc"),
              std::nullopt);
    rig.run_until(rig.get().now() + 100 * kMillisecond);
  };
  const auto start = writes();
  for (int n = 0; n < 5; ++n) send("04", "72", true);
  EXPECT_EQ(writes(), start + 1) << "the handshake bit changed once";
  send("04", "32", true);
  EXPECT_EQ(writes(), start + 2);
  for (int n = 0; n < 5; ++n) send("86", "32", false);
  EXPECT_EQ(writes(), start + 7) << "each telegram is a service";
  EXPECT_EQ(rig.station(0).drive().value("130"), value);
  // Return codes in the answers, bit 7 of the management byte set (1053 1610 p. 46): index 1001 does not exist, class 8 and
  // additional code 10h; P000 can only be read, 12h.
  struct Answers final : BusObserver {
    void on_message(const Bus&, const BusMessage& message) override { last = message.text; }
    std::string last;
  } answers;
  line.add_observer(answers);
  for (const auto& [asked, answered] :
       {std::pair{"31 00 03 E9 00 00 00 00", "B1 00 03 E9 08 00 00 10"}, {"32 00 20 7E 00 00 00 01", "B2 00 20 7E 08 00 00 12"},
        {"31 00 21 16 00 00 00 00", "31 00 21 16 00 00"}}) {
    EXPECT_EQ(line.send(std::string("02 01 86 ") + asked + " bcc"), std::nullopt);
    rig.run_until(rig.get().now() + 100 * kMillisecond);
    EXPECT_EQ(answers.last.substr(0, 9 + std::string_view(answered).size()), std::string("1D 01 86 ") + answered) << asked;
  }
  EXPECT_EQ(rig.says("refused"), 2U) << rig.journal();
}

}  // namespace
}  // namespace ipos::tests
