// The parameter channel of a MOVITRAC 31 in a plant, cycle by cycle, from the line (MOVITRAC 31 PROFIBUS, 3.7 and chapter 5). Octets
// are those that the manual prints, and arithmetic on its words: P120 has the fieldbus index 1025 = 0401h, 9.50 s is 00 00 09 50.
#include <cstdio>

#include "runtime/station/dp_slaves.hpp"
#include "tests/runtime/bus/profibus/hand_rig.hpp"

namespace ipos::tests {
namespace {

struct ChannelPlant : HandPlant {
  explicit ChannelPlant(const std::string& parameters = "", const std::string& more = "")
      : HandPlant(dp_line() + mc31_station(parameters) + more) {
    start("F3 F0", prm_data(kNoWatchdog));
  }
  uint32_t stored() { return station().drive().parameters().eeprom_writes(25); }  // how often P120 was
  // By the hand of somebody at the unit, past the bus.
  void set_ramp(int32_t hundredths) { EXPECT_FALSE(station().drive().set_parameter("P120", hundredths)); }
};

TEST(DpPar, Layout) {
  PROVES("DP-PAR-01", "DP-PAR-02");
  ChannelPlant bench;
  bench.shown("dp.8.request_service");  // from now on it is looked at
  // Management, reserve, index high and low, data with the highest octet first, to the right.
  EXPECT_EQ(bench.service("71 00 04 01 00 00 00 00"), "71 00 04 01 00 00 01 00") << "1.00 s";
  EXPECT_EQ(bench.service("31 00 04 01 00 00 00 00"), "31 00 04 01 00 00 01 00");
  EXPECT_EQ(bench.service("72 00 04 01 00 12 34 56"), "72 00 04 01 00 12 34 56");
  EXPECT_EQ(bench.value("120"), 123456);
  // 72h: write, four octets, handshake 1, no error.
  EXPECT_EQ(bench.shown("dp.8.request_service"), "2");
  EXPECT_EQ(bench.shown("dp.8.request_index"), "1025");
  EXPECT_EQ(bench.shown("dp.8.answer_failed"), "0");
  EXPECT_EQ(bench.service("31 00 FF FF 00 00 00 00").substr(0, 2), "B1") << "the same bits, handshake 0, with an error";
  EXPECT_EQ(bench.shown("dp.8.request_service"), "1");
  EXPECT_EQ(bench.shown("dp.8.request_index"), "65535");
  EXPECT_EQ(bench.shown("dp.8.answer_failed"), "1");
}

TEST(DpPar, OnlyReadAndWrite) {
  PROVES("DP-PAR-03", "DP-PAR-10");
  ChannelPlant bench;
  bool bit = true;
  for (int service = 0; service < 16; ++service) {
    if (service == 1 || service == 2) continue;  // bit 3 is reserved, 0
    char asked[32], refused[32];
    std::snprintf(asked, sizeof asked, "%02X 00 04 01", (bit ? 0x70 : 0x30) | service);
    std::snprintf(refused, sizeof refused, "%02X 00 04 01", (bit ? 0xF0 : 0xB0) | service);
    EXPECT_EQ(bench.service(std::string(asked) + " 00 00 09 50"), std::string(refused) + " 05 05 00 00");
    bit = !bit;
  }
  EXPECT_EQ(bench.value("120"), 100);
  EXPECT_EQ(bench.service("45 00 04 01 00 00 00 00"), "C5 00 04 01 05 05 00 00");
  EXPECT_EQ(bench.service("05 00 04 01 00 00 00 00"), "85 00 04 01 05 05 00 00");
}

TEST(DpPar, RunsWhenTheHandshakeChanges) {
  PROVES("DP-PAR-04");
  ChannelPlant bench;
  for (int cycle = 0; cycle < 500; ++cycle) bench.channel("72 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.value("120"), 950);
  bench.set_ramp(123);
  const uint32_t before = bench.stored();
  for (int cycle = 0; cycle < 500; ++cycle) bench.channel("72 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.value("120"), 123) << "the same frame does nothing";
  EXPECT_EQ(bench.stored(), before);
  for (int cycle = 0; cycle < 1000; ++cycle) bench.channel("32 00 04 01 00 00 08 50");
  EXPECT_EQ(bench.value("120"), 850);
  EXPECT_EQ(bench.stored(), before + 1) << "one more";
}

TEST(DpPar, OldHandshakeUntilItIsDone) {
  PROVES("DP-PAR-05");
  ChannelPlant bench;
  int waited = 0;
  std::string answer = bench.channel("72 00 04 01 00 00 09 50");
  for (; answer.substr(0, 2) == "32" && waited < 100; ++waited) answer = bench.channel("72 00 04 01 00 00 09 50");
  EXPECT_GT(waited, 0);
  EXPECT_EQ(answer, "72 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.value("120"), 950);
  for (int n = 0; n < 20; ++n) EXPECT_EQ(bench.channel("72 00 04 01 00 00 09 50"), answer);
}

TEST(DpPar, MirrorsWhileItIsPrepared) {
  PROVES("DP-PAR-06");
  ChannelPlant bench;
  EXPECT_EQ(bench.channel("32 00 04 01 00 00 09 50"), "32 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.channel("32 00 04 02 12 34 56 78"), "32 00 04 02 12 34 56 78");
  EXPECT_EQ(bench.channel("01 00 00 00 00 00 00 01"), "01 00 00 00 00 00 00 01");
  for (int n = 0; n < 50; ++n) bench.channel("32 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.value("120"), 100) << "nothing was written";
}

TEST(DpPar, ReadTakesAnyLength) {
  PROVES("DP-PAR-07", "DP-PAR-12");
  ChannelPlant bench;
  EXPECT_EQ(bench.service("00 00 04 01 00 00 00 00"), "00 00 04 01 00 00 00 00");
  EXPECT_EQ(bench.service("41 00 04 01 DE AD BE EF"), "41 00 04 01 00 00 01 00") << "data of the request mean nothing";
  EXPECT_EQ(bench.service("01 00 04 01 00 00 00 00"), "01 00 04 01 00 00 01 00");
  for (const char* code : {"51", "21", "61", "31", "71", "11"})
    EXPECT_EQ(bench.service(std::string(code) + " 00 04 01 FF FF FF FF").substr(3), "00 04 01 00 00 01 00") << code;
  EXPECT_EQ(bench.service("02 00 04 01 00 00 09 50").substr(0, 2), "02") << "the handshake has not changed: 11 to 02";
  EXPECT_EQ(bench.service("42 00 04 01 00 00 09 50"), "C2 00 04 01 06 08 00 00");
  EXPECT_EQ(bench.service("02 00 04 01 00 00 09 50"), "82 00 04 01 06 08 00 00");
  EXPECT_EQ(bench.value("120"), 100);
}

TEST(DpPar, TwoWrites) {
  PROVES("DP-PAR-08");
  ChannelPlant bench;
  EXPECT_EQ(bench.service("72 00 04 01 00 00 09 50"), "72 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.value("120"), 950);
  EXPECT_EQ(bench.service("32 00 04 01 00 00 10 00"), "32 00 04 01 00 00 10 00");
  EXPECT_EQ(bench.value("120"), 1000);
}

TEST(DpPar, Refusals) {
  PROVES("DP-PAR-09", "DP-PAR-11", "DP-PAR-16");
  ChannelPlant bench;
  // 1018 = 03FAh is P073, read only; 1025 takes 2000.00 s at most.
  EXPECT_EQ(bench.service("72 00 03 FA 00 00 00 05"), "F2 00 03 FA 08 00 00 12");
  EXPECT_EQ(bench.service("32 00 03 FA 00 00 00 05"), "B2 00 03 FA 08 00 00 12");
  EXPECT_EQ(bench.service("72 00 04 01 99 99 99 99"), "F2 00 04 01 08 00 00 15");
  EXPECT_EQ(bench.service("22 00 04 01 00 00 09 50"), "A2 00 04 01 06 08 00 00") << "lengths other than 4";
  EXPECT_EQ(bench.service("42 00 04 01 00 00 09 50"), "C2 00 04 01 06 08 00 00");
  EXPECT_EQ(bench.service("02 00 04 01 00 00 09 50"), "82 00 04 01 06 08 00 00");
  EXPECT_EQ(bench.service("52 00 04 01 00 00 09 50"), "D2 00 04 01 06 08 00 00");
  EXPECT_EQ(bench.value("120"), 100);
  EXPECT_EQ(bench.service("32 00 04 01 00 00 09 5A"), "B2 00 04 01 08 00 00 1D") << "no digit";
  for (const char* data : {"A0 00 00 00", "00 0B 00 00", "00 00 C0 00", "00 00 0F 50"}) {
    EXPECT_EQ(bench.service("72 00 04 01 " + std::string(data)).substr(12, 2), "08") << data;
    bench.service("31 00 04 01 00 00 00 00");
  }
  EXPECT_EQ(bench.value("120"), 100) << "unchanged";
}

// Over both the index of the list is higher by 1000, and the octets are the same.
TEST(DpPar, TheIndexOfTheFieldbus) {
  PROVES("DP-PAR-14");
  ChannelPlant bench;
  EXPECT_EQ(bench.service("72 00 04 01 00 00 09 50"), "72 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.value("120"), 950);
  EXPECT_EQ(bench.service("31 00 00 19 00 00 00 00"), "B1 00 00 19 08 00 00 10") << "25, the index of the list";
  EXPECT_EQ(bench.service("71 00 04 01 00 00 00 00").substr(12), "00 00 09 50");
  // FMS of the same plant, with a master of DP and the value from the file.
  DpPlant mixed(dp_line() + mc31_station("P120 = \"9.5 s\"\n") + dp_master("") +
                "[[control]]\nname = \"vis\"\nkind = \"fms\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\n"
                "[[control.slave.request]]\nat = \"1s\"\nread = 1025\n");
  mixed.run(2 * kSecond);
  EXPECT_TRUE(mixed.told("slave 8, connection 7, Read 1025: 00 00 09 50"));
}

TEST(DpPar, DigitsAndNumbers) {
  PROVES("DP-PAR-15");
  ChannelPlant bench("P120 = \"9.5 s\"\n");
  EXPECT_EQ(bench.service("71 00 04 01 00 00 00 00"), "71 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.service("32 00 04 01 00 12 34 56"), "32 00 04 01 00 12 34 56");
  EXPECT_EQ(bench.value("120"), 123456) << "1234.56 s";
  // The position (1200 = 04B0h) is a plain 32-bit number: what the shaft has turned.
  EXPECT_EQ(bench.service("72 00 04 01 00 00 01 00"), "72 00 04 01 00 00 01 00");
  bench.start("F3 F1", prm_data(kNoWatchdog));
  bench.exchange("40 00 00 00 00 00 00 00 00 06 05 DC");
  bench.run_on(8 * kSecond);
  bench.exchange("40 00 00 00 00 00 00 00 00 00 00 00");
  bench.run_on(5 * kSecond);
  ASSERT_EQ(bench.speed(), 0);
  const int32_t position = bench.station().drive().state().axis().position;
  EXPECT_GT(position, 0xFFFF);
  char octets[16];
  const auto word = static_cast<uint32_t>(position);
  std::snprintf(octets, sizeof octets, "%02X %02X %02X %02X", word >> 24, word >> 16 & 255, word >> 8 & 255, word & 255);
  EXPECT_EQ(bench.service("31 00 04 B0 00 00 00 00", "00 00 00 00"), "31 00 04 B0 " + std::string(octets));
}

TEST(DpPar, BesideTheProcessData) {
  PROVES("DP-PAR-17");
  HandPlant bench(dp_line() + mc31_station());
  bench.start("F3 F2", prm_data(kNoWatchdog));
  const std::string words = " 00 06 05 DC 03 E8";
  for (int n = 0; n < 2000; ++n) bench.exchange("00 00 00 00 00 00 00 00" + words);
  bench.run_on(2 * kSecond);
  ASSERT_EQ(bench.speed(), 300'000) << "1500 x 0.2 rpm";
  int written = 0;
  for (int n = 0; n < 40; ++n) {
    const std::string channel = std::string(n / 20 == 0 ? "72" : "32") + (n / 20 == 0 ? " 00 04 01 00 00 09 50" : " 00 04 01 00 00 08 50");
    const std::string answer = bench.exchange(channel + words);
    EXPECT_EQ(answer.substr(3 + 24, 11), "04 07 05 DC") << "both in each cycle";
    EXPECT_EQ(bench.outputs().substr(24), words.substr(1));
    EXPECT_EQ(bench.speed(), 300'000) << "motion is not disturbed";
    written += bench.value("120") == 950;
    bench.run_on(2 * kMillisecond);
  }
  EXPECT_GT(written, 0);
  EXPECT_EQ(bench.value("120"), 850);
}

}  // namespace
}  // namespace ipos::tests
