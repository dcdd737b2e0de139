// RS-485 telegrams of the manuals (1053 1610 chapter 4, MOVIDRIVE MDX60B/61B chapter 4.3): octets of the rows sent to units of a
// plant, octets of the rows heard.
#include "tests/harness/proves.hpp"
#include "tests/runtime/manuals/talk.hpp"

namespace ipos::tests {
namespace {

const Texts kNothing;
const std::string kExample = "02 01 05 00 06 3A 98 01 F4 57";
const std::string kRead8318 = "02 01 86 31 00 20 7E 00 00 00 00";
constexpr int64_t kCharacter = 11'000'000'000 / 9600;  // ns

std::string numbered(int address, const std::string& more = "") {
  return "P810 = " + std::to_string(address) + "\n" + more;
}
std::string one(const char* unit = "md60a", const std::string& more = "") {
  return serial_bus() + on_line("u", unit, numbered(1, more));
}
// The unit of the examples: it turns with 3000 rpm, as PO2 = 3A98h says, and shows status word, speed and nothing.
constexpr const char* kRunning = "P100 = 2\nP101 = 1\nP302 = 3000000\nP872 = 0\nP875 = 0\n";
std::string running(const char* unit, int address, const std::string& name = "u") {
  return on_line(name, unit, numbered(address, kRunning), kEnabled);
}
std::string hex_of(int value) { return word_text(value).substr(3); }

// What the units of a line have as process output words.
std::string words(const Talk& talk, const char* unit = "u") {
  std::string text;
  for (const char* name : {"PO1", "PO2", "PO3"})
    text += (text.empty() ? "" : " ") + word_text(static_cast<int>(talk.value(unit, name)));
  return text;
}

TEST(SerialRows, TheWorkedExample) {
  PROVES("RS485-01", "RS485-17", "EX-01", "MDB-RS485-15", "MDB-RS485-16", "MDB-RS485-28", "MDB-RS485-29");
  EXPECT_EQ(with_check("02 01 05 00 06 3A 98 01 F4"), kExample);
  for (const char* unit : {"md60a", "mdxb"}) {
    Talk talk(serial_bus() + running(unit, 1));
    for (int n = 0; n < 60; ++n) talk.serial_ask_raw(kExample);
    EXPECT_EQ(words(talk), "00 06 3A 98 01 F4");
    // 3000 rpm; state 4, enabled, ready, PO data on.
    EXPECT_EQ(talk.serial_ask_raw(kExample), Texts{"1D 01 05 04 07 3A 98 00 00 B8"}) << unit;
    // At 1000 rpm speed is read as 000F 4240h.
    for (int n = 0; n < 60; ++n) talk.serial_ask("02 01 05 00 06 13 88 00 00");
    EXPECT_EQ(talk.serial_ask_raw("02 01 86 31 00 20 7E 00 00 00 00 EA"),
              Texts{"1D 01 86 31 00 20 7E 00 0F 42 40 F8"});
  }
}

TEST(SerialRows, ReadAt1000Rpm) {
  PROVES("EX-09");
  Talk talk(serial_bus() + running("md60a", 1));
  for (int n = 0; n < 60; ++n) talk.serial_ask("02 01 05 00 06 13 88 00 00");
  EXPECT_EQ(talk.serial_ask_raw("02 01 86 31 00 20 7E 00 00 00 00 EA"),
            Texts{"1D 01 86 31 00 20 7E 00 0F 42 40 F8"});
}

// Any other octet in place of one makes it void.
TEST(SerialRows, EveryChangedOctetIsFound) {
  PROVES("EX-01", "RS485-17");
  for (size_t at = 0; at < 10; ++at)
    for (const int change : {0x01, 0x06, 0x80, 0xFF}) {
      Talk talk(one());
      Bytes bytes = bytes_of(kExample);
      bytes[at] = static_cast<uint8_t>(bytes[at] ^ change);
      EXPECT_EQ(talk.serial_ask_raw(text_of(bytes.data(), bytes.size())), kNothing) << at << ' ' << change;
      EXPECT_EQ(words(talk), "00 00 00 00 00 00");
      for (const HeardTelegram& heard : talk.telegrams()) EXPECT_FALSE(heard.valid) << at << ' ' << change;
    }
}

// EX-03, EX-04: enable, 50 %, ramp 3 s; a unit that is ready and not enabled, with speed in % and status word 2, whose high octet
// has the outputs DO10 to DO17: two of them are set to what holds.
TEST(SerialRows, SampleOfControlAndResponse) {
  PROVES("EX-03", "EX-04");
  Talk talk(
      serial_bus() +
      on_line(
          "u", "md60a",
          numbered(1, "P100 = 2\nP101 = 1\nP871 = 11\nP872 = 8\nP874 = 8\nP875 = 7\nP631 = 2\nP632 = 2\n"),
          "[station.inputs]\nDI00 = 1\nDI01 = 1\n"));
  EXPECT_EQ(talk.serial_ask_raw("02 01 85 00 06 20 00 0B B8 13"), Texts{"1D 01 85 02 06 00 00 06 06 9D"});
  EXPECT_EQ(words(talk), "00 06 20 00 0B B8");
}

TEST(SerialRows, HighOctetFirst) {
  PROVES("RS485-03", "RS485-16", "MDB-RS485-25", "MDB-RS485-26");
  Talk talk(one());
  // Type 4: the parameter channel in octets 4 to 11, then the three words.
  const Texts answer = talk.serial_ask("02 01 84 33 00 2A FD 00 0F 42 40 3A 98 11 22 33 44");
  ASSERT_EQ(answer.size(), 1U);
  EXPECT_EQ(answer[0].substr(0, 32), "1D 01 84 33 00 2A FD 00 0F 42 40");
  EXPECT_EQ(talk.value("u", "H5"), 1'000'000);
  EXPECT_EQ(words(talk), "3A 98 11 22 33 44");
  EXPECT_EQ(talk.serial_ask("02 01 86 31 00 2A FD 00 00 00 00"), Texts{"1D 01 86 31 00 2A FD 00 0F 42 40"});
}

// PDU octets and telegram octets as printed (p. 23-24).
struct TypeRow {
  int type, pdu, length;
};
constexpr TypeRow kTypes[] = {{0, 10, 14}, {1, 2, 6},  {2, 12, 16}, {3, 4, 8},
                              {4, 14, 18}, {5, 6, 10}, {6, 8, 12}};

std::string request(int address, int type, int pdu) {
  std::string text = "02 " + hex_of(address) + " " + hex_of(type);
  for (int n = 0; n < pdu; ++n) text += " 00";
  return text;
}

TEST(SerialRows, FourteenTypes) {
  PROVES("RS485-05", "RS485-15", "RS485-22", "MDB-RS485-15", "MDB-RS485-23", "MDB-RS485-24");
  for (const char* unit : {"md60a", "mdxb"}) {
    Talk talk(one(unit));
    for (const TypeRow& row : kTypes)
      for (const int acyclic : {0, 0x80}) {
        EXPECT_EQ(row.pdu + 4, row.length);
        const Texts answer = talk.serial_ask(request(1, row.type | acyclic, row.pdu));
        ASSERT_EQ(answer.size(), 1U) << unit << ' ' << row.type;
        EXPECT_EQ(answer[0].size(), static_cast<size_t>(row.length - 1) * 3 - 1) << "without block check";
        EXPECT_EQ(answer[0].substr(0, 8), "1D 01 " + hex_of(row.type | acyclic));
        // At least the pause of 3.44 ms before the answer, at most 50 ms.
        const auto& telegrams = talk.telegrams();
        ASSERT_EQ(telegrams.size(), 2U);
        EXPECT_GE(telegrams[1].start - telegrams[0].end, 3'440'000);
        EXPECT_LE(telegrams[1].start - telegrams[0].end, 50 * kMs);
      }
    for (int type = 0; type < 256; ++type)
      if ((type & 0x7F) > 6) {
        EXPECT_EQ(talk.serial_ask(request(1, type, 6)), kNothing) << type;
      }
  }
  Talk talk(serial_bus() + running("md60a", 1));
  EXPECT_EQ(talk.serial_ask(kRead8318).size(), 1U) << "86h is supported, too";
  talk.serial_ask("02 01 86 32 00 21 16 00 00 09 C4");
  EXPECT_EQ(talk.value("u", "P130"), 2500);
}

// A unit with P810 = 5 and P811 = 101, asked at every address.
TEST(SerialRows, EveryAddress) {
  PROVES("RS485-07", "MDB-RS485-17");
  for (const char* unit : {"md60a", "mdxb"}) {
    Talk talk(serial_bus() + on_line("u", unit, numbered(5, "P811 = 101\n")));
    for (int address = 0; address < 256; ++address) {
      const std::string word = word_text(address + 1);
      const Texts answers = talk.serial_ask("02 " + hex_of(address) + " 81 " + word);
      EXPECT_EQ(answers.size(), address == 5 || address == 254 ? 1U : 0U) << address;
      const bool reacts = address == 5 || address == 101 || address >= 254;
      EXPECT_EQ(talk.value("u", "PO1") == address + 1, reacts) << address;
    }
  }
}

TEST(SerialRows, EachAnswersItsOwnAddress) {
  PROVES("RS485-08", "MDB-RS485-16", "MDB-RS485-18");
  Talk talk(serial_bus() + on_line("a", "mdxb", numbered(1)) + on_line("b", "md60a", numbered(3)) +
            on_line("c", "mdxb", numbered(12)));
  for (const auto& [address, unit] : {std::pair{12, "c"}, {3, "b"}, {1, "a"}}) {
    const Texts answers = talk.serial_ask("02 " + hex_of(address) + " 05 00 06 3A 98 01 F4");
    ASSERT_EQ(answers.size(), 1U);
    EXPECT_EQ(answers[0].substr(0, 8), "1D " + hex_of(address) + " 05");
    EXPECT_EQ(words(talk, unit), "00 06 3A 98 01 F4");
  }
  EXPECT_EQ(talk.serial_ask("02 05 05 00 06 3A 98 01 F4"), kNothing);
}

TEST(SerialRows, Groups) {
  PROVES("RS485-09", "MDB-RS485-20");
  for (const char* type : {"md60a", "mdxb"}) {
    const char* names[] = {"a", "b", "c", "d", "e", "f"};
    std::string plant = serial_bus();
    for (int n = 0; n < 6; ++n)
      plant += on_line(names[n], type, numbered(n + 1, n < 4 ? "P811 = 101\n" : "P811 = 102\n"));
    Talk talk(plant);
    const auto p130 = [&](int n) { return talk.value(names[n], "P130"); };
    EXPECT_EQ(talk.serial_ask("02 65 86 32 00 21 16 00 00 09 C4"), kNothing);
    for (int n = 0; n < 6; ++n) EXPECT_EQ(p130(n), n < 4 ? 2500 : 2000);
    EXPECT_EQ(talk.serial_ask("02 66 06 72 00 21 16 00 00 0B B8"), kNothing);
    for (int n = 0; n < 6; ++n) EXPECT_EQ(p130(n), n < 4 ? 2500 : 3000);
    EXPECT_EQ(talk.serial_ask("02 65 05 00 06 07 D0 00 00"), kNothing);
    for (int n = 0; n < 6; ++n)
      EXPECT_EQ(words(talk, names[n]), n < 4 ? "00 06 07 D0 00 00" : "00 00 00 00 00 00");
    // A read gives nothing, a refused write neither; the journal has both.
    EXPECT_EQ(talk.serial_ask("02 65 86 31 00 20 7E 00 00 00 00"), kNothing);
    EXPECT_EQ(talk.serial_ask("02 65 86 32 00 20 7E 00 00 00 00"), kNothing);
    EXPECT_GE(talk.told("a group parameter telegram can only write"), 1);
    EXPECT_GE(talk.told("read access only"), 1);
  }
}

TEST(SerialRows, Group100IsNoGroup) {
  PROVES("MDB-RS485-19");
  Talk talk(one("mdxb", "P811 = 100\n"));
  EXPECT_EQ(talk.serial_ask("02 64 86 32 00 21 16 00 00 09 C4"), kNothing);
  EXPECT_EQ(talk.serial_ask("02 64 05 00 06 07 D0 00 00"), kNothing);
  EXPECT_EQ(talk.value("u", "P130"), 2000);
  EXPECT_EQ(words(talk), "00 00 00 00 00 00");
}

TEST(SerialRows, UniversalAddress) {
  PROVES("RS485-11", "MDB-RS485-21");
  Talk only(serial_bus() + on_line("u", "mdxb", numbered(47)));
  const Texts answer = only.serial_ask("02 FE 05 00 06 3A 98 01 F4");
  ASSERT_EQ(answer.size(), 1U);
  EXPECT_EQ(answer[0].substr(0, 8), "1D FE 05") << "the address of the request (ours)";
  Talk two(serial_bus() + on_line("u", "mdxb", numbered(1, "P873 = 0\n")) +
           on_line("v", "mdxb", numbered(2)));
  two.serial_ask_raw(with_check("02 FE 05 00 06 3A 98 01 F4"));
  EXPECT_GE(two.told("same time") + two.told("collision"), 1) << "their answers collide";
  for (size_t n = 1; n < two.telegrams().size(); ++n) EXPECT_FALSE(two.telegrams()[n].valid);
}

TEST(SerialRows, BroadcastReachesAll) {
  PROVES("RS485-13");
  Talk talk(serial_bus() + on_line("a", "md60a", numbered(1)) + on_line("b", "mdxb", numbered(2)) +
            on_line("c", "mc07", numbered(3)));
  EXPECT_EQ(talk.serial_ask("02 FF 05 00 06 3A 98 01 F4"), kNothing);
  for (const char* name : {"a", "b", "c"}) EXPECT_EQ(words(talk, name), "00 06 3A 98 01 F4");
}

// The start pause counts from the last octet that a station hears, here of an answer that somebody else's was.
TEST(SerialRows, StartPause) {
  PROVES("RS485-04", "MDB-RS485-09", "MDB-RS485-11");
  for (const bool fast : {false, true})
    for (const auto& [pause, answered] :
         {std::pair{3300, false}, {3420, false}, {3441, true}, {3500, true}}) {
      Talk talk(fast ? serial_bus("line", "baud = 57600\n") +
                           unit_on("rs485_xt = \"line\"\n", "u", "mdxb", numbered(1))
                     : one());
      talk.pass(10 * kMs);
      const std::string before = with_check("1D 02 05 00 00 00 00 00 00");
      const int64_t start = talk.now();
      talk.serial_send(before);
      talk.run_to(start + 10 * (fast ? 11'000'000'000 / 57'600 : kCharacter) + 200 * kUs);
      const auto heard = talk.serial_heard();
      ASSERT_EQ(heard.size(), 1U);
      talk.run_to(heard[0].end + pause * kUs);
      talk.serial_send(kExample);
      talk.pass(80 * kMs);
      EXPECT_EQ(words(talk), answered ? "00 06 3A 98 01 F4" : "00 00 00 00 00 00") << pause;
      EXPECT_EQ(talk.told("pause") > 0, !answered) << pause;
      // Octets begin at the ticks of the line, which are 17.4 us at most.
      const auto after = talk.serial_heard();
      ASSERT_FALSE(after.empty());
      EXPECT_NEAR(static_cast<double>(after[0].start - heard[0].end) / 1000, pause, 18);
      EXPECT_EQ(after[0].start - heard[0].end >= 3'440'000, answered) << pause;
    }
  // 02 and 1D in the user data split nothing.
  Talk talk(one());
  EXPECT_EQ(talk.serial_ask("02 01 05 02 02 1D 1D 02 1D").size(), 1U);
  EXPECT_EQ(words(talk), "02 02 1D 1D 02 1D");
}

// An octet more is sent `gap` after the end of the one before it.
void feed_with_gap(Talk& talk, const std::string& text, size_t at, int64_t gap,
                   int64_t character = kCharacter) {
  talk.pass(10 * kMs);
  talk.serial_heard();
  const int64_t start = talk.now();
  talk.serial_send(text.substr(0, 3 * at - 1));
  talk.run_to(start + character * static_cast<int64_t>(at) + gap);
  talk.serial_send(text.substr(3 * at));
  talk.pass(80 * kMs);
}

TEST(SerialRows, CharacterGap) {
  PROVES("RS485-20", "MDB-RS485-10", "MDB-RS485-11", "MDB-RS485-35");
  for (const bool fast : {false, true})
    for (size_t at = 1; at < 10; ++at)
      for (const auto& [gap, answered] : {std::pair{3400, true},
                                          {3420, true},
                                          {3432, false},
                                          {3440, false},
                                          {3500, false},
                                          {5000, false}}) {
        Talk talk(fast ? serial_bus("line", "baud = 57600\n") +
                             unit_on("rs485_xt = \"line\"\n", "u", "mdxb", numbered(1))
                       : one());
        feed_with_gap(talk, kExample, at, gap * kUs, fast ? 11'000'000'000 / 57'600 : kCharacter);
        EXPECT_EQ(words(talk), answered ? "00 06 3A 98 01 F4" : "00 00 00 00 00 00") << at << ' ' << gap;
        EXPECT_EQ(talk.told("character delay exceeded") > 0, !answered) << at << ' ' << gap;
      }
  // What comes behind a gap begins nothing, also with 02.
  Talk talk(one());
  feed_with_gap(talk, with_check("02 01 05 00 02 01 05 00 06"), 4, 3500 * kUs);
  EXPECT_EQ(words(talk), "00 00 00 00 00 00");
}

// The slave's side; the master's is below.
TEST(SerialRows, RequestAfterABrokenOne) {
  PROVES("RS485-06");
  for (const size_t sent : {1U, 4U, 9U}) {
    for (const auto& [pause, warned] : {std::pair{6000, 1}, {6900, 0}}) {
      Talk talk(one());
      feed_with_gap(talk, kExample.substr(0, 3 * sent) + kExample, sent, pause * kUs);
      EXPECT_EQ(words(talk), "00 06 3A 98 01 F4") << sent;
      EXPECT_EQ(talk.told("after a request that was broken off"), warned) << sent << ' ' << pause;
    }
  }
}

TEST(SerialRows, PauseAfterABroadcast) {
  PROVES("RS485-14", "MDB-RS485-22");
  for (const auto& [pause, warned] : {std::pair{24'000, 1}, {24'900, 1}, {25'100, 0}}) {
    Talk talk(one());
    talk.pass(10 * kMs);
    const int64_t start = talk.now();
    talk.serial_send(with_check("02 FF 05 00 06 07 D0 00 00"));
    talk.run_to(start + 10 * kCharacter + pause * kUs);
    talk.serial_send(kExample);
    talk.pass(80 * kMs);
    EXPECT_EQ(words(talk), "00 06 3A 98 01 F4");
    EXPECT_EQ(talk.told("after a broadcast"), warned) << pause;
  }
}

TEST(SerialRows, DirectionsAreNotMixedUp) {
  PROVES("RS485-02", "MDB-RS485-13");
  Talk talk(one("mdxb"));
  for (const char* text : {"1D 02 05 00 06 3A 98 01 F4", "1D 01 05 00 06 3A 98 01 F4"}) {
    EXPECT_EQ(talk.serial_ask(text), kNothing);
    EXPECT_EQ(words(talk), "00 00 00 00 00 00");
    EXPECT_EQ(talk.telegrams().at(0).words.substr(0, 8), "response");
  }
  EXPECT_EQ(talk.serial_ask("02 01 05 00 06 3A 98 01 F4").at(0).substr(0, 2), "1D");
  EXPECT_EQ(talk.telegrams().at(0).words.substr(0, 7), "request");
}

// MLK-04, MLK-09: cyclic types execute a service at each change of the handshake bit, which is 0 after power-on.
TEST(SerialRows, HandshakeRunsEachServiceOnce) {
  PROVES("MLK-04", "MLK-09", "EX-06");
  Talk talk(one());
  const auto ask = [&](const std::string& management, int value) {
    const std::string channel = management + " 00 21 16 " + value_text(value);
    EXPECT_EQ(talk.serial_ask("02 01 06 " + channel), Texts{"1D 01 06 " + channel});
  };
  for (int n = 0; n < 10; ++n) ask("32", 2500);
  EXPECT_EQ(talk.value("u", "P130"), 2000) << "not yet";
  for (int n = 0; n < 10; ++n) {
    for (int repeat = 0; repeat < 3; ++repeat) ask(n % 2 == 0 ? "72" : "32", 100 * n + 100);
    EXPECT_EQ(talk.value("u", "P130"), 100 * n + 100);
    talk.set("u", "P130", 10);  // what only takes in and returns the channel leaves it
    ask(n % 2 == 0 ? "72" : "32", 100 * n + 100);
    EXPECT_EQ(talk.value("u", "P130"), 10);
  }
  // A cyclic type with process data in the same way.
  talk.serial_ask("02 01 04 72 00 21 16 00 00 03 E8 00 06 00 00 00 00");
  EXPECT_EQ(talk.value("u", "P130"), 1000);
  talk.serial_ask("02 01 04 72 00 21 16 00 00 07 D0 00 06 00 00 00 00");
  EXPECT_EQ(talk.value("u", "P130"), 1000);
}

TEST(SerialRows, AcyclicTypesAlwaysRun) {
  PROVES("MLK-11");
  Talk talk(one());
  for (const int value : {1000, 1100, 1200}) {
    talk.set("u", "P130", value);
    EXPECT_EQ(talk.serial_ask("02 01 86 31 00 21 16 00 00 00 00"),
              Texts{"1D 01 86 31 00 21 16 " + value_text(value)});
  }
  EXPECT_EQ(talk.serial_ask("02 01 86 71 00 21 16 FF FF FF FF"), Texts{"1D 01 86 71 00 21 16 00 00 04 B0"});
}

TEST(SerialRows, TimesOnTheWire) {
  PROVES("RS485-19", "MDB-RS485-04", "MDB-RS485-34");
  Talk talk(serial_bus("x", "baud = 57600\n") + serial_bus() +
            unit_on("rs485 = \"line\"\nrs485_xt = \"x\"\n", "u", "mdxb", numbered(1)));
  ipos_plant_bus_info info{};
  EXPECT_EQ(ipos_plant_bus_at(talk.plant(), talk.bus("line"), &info), IPOS_PLANT_OK);
  EXPECT_EQ(info.baud, 9600U) << "where the plant names no other rate";
  for (const char* line : {"line", "x"})
    for (const auto& [type, characters, slow, fast] :
         {std::tuple{5, 10, 11'460, 1'910}, {6, 12, 13'750, 2'290}, {4, 18, 20'630, 3'440}}) {
      const std::string text = request(1, type, characters - 4);
      EXPECT_EQ(talk.serial_ask(text, line).size(), 1U);
      for (const HeardTelegram& heard : talk.telegrams())
        EXPECT_NEAR(static_cast<double>(heard.end - heard.start) / 1000,
                    line == std::string("x") ? fast : slow, 5);
    }
}

// What a [[fault]] of the plant has disturbed is not accepted: a parity bit turned round, one to three bits of any kind.
std::string fault(const std::string& kind, const std::string& more) {
  return "[[fault]]\nbus = \"line\"\nkind = \"" + kind + "\"\n" + more;
}
TEST(SerialRows, DisturbedBitsAreFound) {
  PROVES("RS485-18", "MDB-RS485-27");
  for (const char* kind : {"parity", "noise"})
    for (int seed = 1; seed <= 5; ++seed) {
      Talk talk(one() + fault(kind, "rate = 1000\nseed = " + std::to_string(seed) + "\nuntil = \"4s\"\n"));
      for (int n = 0; n < 40; ++n)
        EXPECT_EQ(talk.serial_ask_raw(kExample), kNothing) << kind << ' ' << seed << ' ' << n;
      EXPECT_EQ(words(talk), "00 00 00 00 00 00");
      talk.run_to(4000 * kMs);
      EXPECT_EQ(talk.serial_ask_raw(kExample).size(), 1U) << "the next one is heard";
    }
}

// Six faulty variants of the example: none is answered, the words stay. A station that is at another rate for a while finds no stop
// bit in the first octet.
TEST(SerialRows, SixErrorsAndNoAnswer) {
  PROVES("MDB-RS485-30", "RS485-19");
  const auto check = [](const std::string& planted, const std::string& words_told, const std::string& text,
                        size_t gap_at = 0) {
    Talk talk(one("mdxb") + planted);
    EXPECT_EQ(talk.serial_ask("02 01 05 00 02 11 11 22 22").size(), 1U);
    talk.run_to(490 * kMs);
    if (gap_at != 0)
      feed_with_gap(talk, text, gap_at, 4 * kMs);
    else
      EXPECT_EQ(talk.serial_ask_raw(text), kNothing) << words_told;
    EXPECT_EQ(words(talk), "00 02 11 11 22 22") << words_told;
    EXPECT_EQ(talk.told(words_told), 1) << words_told;
    talk.run_to(1000 * kMs);
    EXPECT_EQ(talk.serial_ask_raw(kExample).size(), 1U) << "afterwards all is well";
    EXPECT_EQ(words(talk), "00 06 3A 98 01 F4");
  };
  check(fault("parity", "frame = 3\n"), "parity error", kExample);
  check(fault("baud", "station = \"u\"\nfrom = \"400ms\"\nuntil = \"900ms\"\n"), "character frame error",
        kExample);
  check("", "character delay exceeded", kExample, 5);
  check("", "request to 2 is not for this unit", with_check("02 02 05 00 06 3A 98 01 F4"));
  check("", "PDU type incorrect", with_check("02 01 07 00 06 3A 98 01 F4"));
  check("", "BCC incorrect", "02 01 05 00 06 3A 98 01 F4 54");
}

TEST(SerialRows, ResponsesIn50Milliseconds) {
  PROVES("TIME-08", "MDB-RS485-12");
  const std::string program =
      "#include <constb.h>\nMOVLNK Ml; MLDATA Mld; long lDone;\nmain()\n{\n Ml.BusType = 2; Ml.Address = 1; "
      "Ml.Format = 134;"
      " Ml.Service = 1; Ml.Index = 8318; Ml.DPointer = numof(Mld); Ml.Result = 99;\n _MoviLink(Ml);\n lDone "
      "= 1;\n while (1) {}\n}\n";
  for (const auto& [delay, good] :
       {std::pair{49'000, true}, {49'900, true}, {50'100, false}, {51'000, false}}) {
    Talk talk(serial_bus() + unit_on("rs485 = \"line\"\nprogram = \"P.IPC\"\n", "m", "mdxb", numbered(9)),
              program);
    Texts requests;
    for (int n = 0; n < 2; ++n) {
      std::vector<HeardTelegram> heard;
      for (int ms = 0; ms < 400 && heard.empty(); ++ms) {
        talk.pass(100 * kUs);
        heard = talk.serial_heard();
      }
      if (heard.empty()) break;
      requests.push_back(heard[0].text);
      talk.run_to(heard[0].end + delay * kUs);
      talk.serial_send("1D 01 86 31 00 20 7E 00 0F 42 40 F8");
      talk.pass(20 * kMs);
      talk.serial_heard();
    }
    talk.pass(200 * kMs);
    EXPECT_EQ(talk.value("m", "Ml.Result") == 0, good) << delay;
    EXPECT_EQ(requests.size(), good ? 1U : 2U) << "repeated once";
    EXPECT_EQ(requests[0], "02 01 86 31 00 20 7E 00 00 00 00 EA");
    if (good) {
      EXPECT_EQ(talk.value("m", "Mld.ReadPar"), 1'000'000);
    }
  }
}

std::string movlnk(int address, int format, int value = 2500) {
  return "#include <const.h>\nMOVLNK Ml; MLDATA Mld; long lDone;\nmain()\n{\n Ml.BusType = 2; Ml.Address = " +
         std::to_string(address) + "; Ml.Format = " + std::to_string(format) +
         "; Ml.Service = 2; Ml.Index = 8470; Ml.DPointer = numof(Mld); Ml.Result = 99;\n Mld.WritePar = " +
         std::to_string(value) +
         "; Mld.PO1 = 6; Mld.PO2 = 5; Mld.PO3 = 4;\n _MoviLink(Ml);\n lDone = 1;\n while (1) {}\n}\n";
}

TEST(SerialRows, AddressesOfMovlnk) {
  PROVES("MOVLNK-05");
  const struct {
    int address;
    const char* reached;
  } rows[] = {{1, "x--"}, {99, "--x"}, {101, "xx-"}, {199, "--x"}, {255, "xxx"}};
  for (const int format : {6, 134})
    for (const auto& row : rows) {
      Talk talk(serial_bus() + unit_on("rs485 = \"line\"\nprogram = \"P.IPC\"\n", "m", "md60a", numbered(9)) +
                    on_line("a", "md60a", numbered(1, "P811 = 101\n")) +
                    on_line("b", "md60a", numbered(2, "P811 = 101\n")) +
                    on_line("c", "md60a", numbered(99, "P811 = 199\n")),
                movlnk(row.address, format));
      talk.pass(500 * kMs);
      EXPECT_EQ(talk.value("m", "Ml.Result"), 0) << row.address;
      std::string reached;
      for (const char* name : {"a", "b", "c"}) reached += talk.value(name, "P130") == 2500 ? 'x' : '-';
      EXPECT_EQ(reached, row.reached) << row.address << ' ' << format;
    }
  for (const int wrong : {200, 252, 256, -1}) {
    Talk talk(serial_bus() + unit_on("rs485 = \"line\"\nprogram = \"P.IPC\"\n", "m", "md60a", numbered(9)) +
                  on_line("a", "md60a", numbered(1)),
              movlnk(wrong, 6));
    talk.pass(500 * kMs);
    EXPECT_NE(talk.value("m", "Ml.Result"), 0) << wrong;
    EXPECT_TRUE(talk.serial_heard().empty()) << wrong;
  }
}

// The master's side of the pauses and directions: a program is the master, the library listens or answers.
std::string master(const std::string& calls) {
  return "#include <const.h>\nMOVLNK Ml; MLDATA Mld;\nmain()\n{\n Ml.BusType = 2; Ml.Address = 1; Ml.Format "
         "= 6; Ml.Service = 2; "
         "Ml.Index = 8470; Ml.DPointer = numof(Mld); Ml.Result = 99;\n Mld.PO1 = 6;\n " +
         calls + "\n while (1) {}\n}\n";
}
const std::string kMaster =
    serial_bus() + unit_on("rs485 = \"line\"\nprogram = \"P.IPC\"\n", "m", "mdxb", numbered(9));

TEST(SerialRows, AMasterPausesAfterABroadcast) {
  PROVES("RS485-14", "MDB-RS485-22");
  Talk talk(kMaster + on_line("a", "md60a", numbered(1)),
            master("Ml.Address = 255; Ml.Format = 129; _MoviLink(Ml); _MoviLink(Ml); _MoviLink(Ml); "
                   "Ml.Address = 1; _MoviLink(Ml);"));
  talk.pass(500 * kMs);
  const auto heard = talk.serial_heard();
  ASSERT_EQ(heard.size(), 5U) << "three broadcasts, a request and its answer";
  for (size_t n = 1; n < 4; ++n) EXPECT_GE(heard[n].start - heard[n - 1].end, 25 * kMs) << n;
  EXPECT_EQ(talk.value("a", "PO1"), 6);
}

TEST(SerialRows, AMasterTakesNoRequestForAResponse) {
  PROVES("RS485-02", "MDB-RS485-13");
  for (const bool response : {true, false}) {
    Talk talk(kMaster, master("Ml.Format = 134; Ml.Service = 1; Ml.Index = 8318; _MoviLink(Ml);"));
    for (int n = 0; n < 2; ++n) {
      for (int ms = 0; ms < 200 && talk.serial_heard().empty(); ++ms) talk.pass(kMs);
      talk.pass(5 * kMs);
      talk.serial_send(with_check((response ? "1D" : "02") + std::string(" 01 86 31 00 20 7E 00 0F 42 40")));
      talk.pass(20 * kMs);
      talk.serial_heard();
    }
    talk.pass(200 * kMs);
    EXPECT_EQ(talk.value("m", "Ml.Result") == 0, response);
  }
}

TEST(SerialRows, AMasterAsksTheOnlySlaveAt254) {
  PROVES("RS485-11", "MOVLNK-05");
  Talk talk(kMaster + on_line("a", "md60a", numbered(47)),
            master("Ml.Address = 254; Mld.WritePar = 2500; _MoviLink(Ml);"));
  talk.pass(300 * kMs);
  EXPECT_EQ(talk.value("m", "Ml.Result"), 0);
  EXPECT_EQ(talk.value("a", "P130"), 2500);
  // 253 is the own unit, and nothing goes over the line.
  Talk own(kMaster, master("Ml.Address = 253; Ml.Service = 1; Ml.Index = 8597; _MoviLink(Ml);"));
  own.pass(300 * kMs);
  EXPECT_EQ(own.value("m", "Ml.Result"), 0);
  EXPECT_EQ(own.value("m", "Mld.ReadPar"), 9);
  EXPECT_TRUE(own.serial_heard().empty());
}

// Management octets sent and received: prepared with the bit as it is, executed with its change.
TEST(SerialRows, HandshakeOfAMaster) {
  PROVES("EX-06");
  Talk talk(kMaster + on_line("a", "md60a", numbered(1)),
            master("Mld.WritePar = 2500; _MoviLink(Ml); Mld.WritePar = 2600; _MoviLink(Ml);"));
  talk.pass(800 * kMs);
  EXPECT_EQ(talk.value("a", "P130"), 2600);
  std::string pairs;
  for (const HeardTelegram& heard : talk.serial_heard())
    pairs += heard.text.substr(9, 2) + (heard.text.starts_with("02") ? "/" : " ");
  EXPECT_NE(pairs.find("32/32 72/72 72/72 32/32 "), std::string::npos) << pairs;
}

TEST(SerialRows, FormatsOfMovlnk) {
  PROVES("MOVLNK-06");
  for (const int acyclic : {0, 128})
    for (int format = 0; format <= 6; ++format) {
      Talk talk(serial_bus() + unit_on("rs485 = \"line\"\nprogram = \"P.IPC\"\n", "m", "md60a", numbered(9)) +
                    on_line("a", "md60a", numbered(1)),
                movlnk(1, format + acyclic));
      talk.pass(500 * kMs);
      EXPECT_EQ(talk.value("m", "Ml.Result"), 0) << format;
      const auto heard = talk.serial_heard();
      ASSERT_FALSE(heard.empty());
      for (const HeardTelegram& telegram : heard) {
        EXPECT_TRUE(telegram.valid);
        EXPECT_EQ(telegram.text.substr(6, 2), hex_of(format + acyclic));
      }
      EXPECT_EQ(talk.value("a", "P130"), format % 2 == 0 ? 2500 : 2000) << format;
      const int sent = format == 6 ? 0 : format / 2 + 1;
      for (int n = 0; n < 3; ++n) {
        const char* names[] = {"PO1", "PO2", "PO3"};
        EXPECT_EQ(talk.value("a", names[n]), n < sent ? 6 - n : 0) << format;
      }
    }
}

}  // namespace
}  // namespace ipos::tests
