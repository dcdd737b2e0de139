// Slave_Diag of a MOVITRAC 31 in a plant, octet by octet from the line, and what masters make of it (MOVITRAC 31 PROFIBUS, 3.2 and 3.4).
// Octets are those that the manual prints, and the bits of its tables: octet 1 has Not_Supported 10h, Prm_Fault 40h, Cfg_Fault 04h,
// Ext_Diag 08h, Station_Not_Ready 02h; octet 2 Prm_Req 01h, Stat_Diag 02h, WD_On 08h, and 04h always.
#include "tests/runtime/bus/profibus/hand_rig.hpp"

namespace ipos::tests {
namespace {

const std::string kLongWatchdog = "88 FF 01";  // 2.55 s
constexpr Time kRefresh = 800 * kMillisecond;  // of the unit diagnosis

// What `drive_fault` and `reset` of a step do.
void trip(HandPlant& bench, uint8_t fault) { bench.station().drive().state().raise_fault(fault); }
void reset(HandPlant& bench) { bench.station().drive().state().reset_fault(); }
// Exchanges for as long as a refresh may take.
void go_on(HandPlant& bench, const std::string& outputs = "00 00", uint8_t master = 1) {
  for (const Time end = bench.plant->now() + kRefresh + 20 * kMillisecond; bench.plant->now() < end; bench.run_on(20 * kMillisecond))
    bench.exchange(outputs, master);
}

TEST(DpDiag, WholeFrames) {
  PROVES("DP-DIAG-02", "DP-DIAG-03", "DP-DIAG-09", "DP-DIAG-15", "DP-DIAG-22");
  HandPlant bench(dp_line() + mc31_station());
  bench.shown("dp.8.fault");  // from now on it is looked at
  EXPECT_EQ(bench.ask(2, 60), "08 02 05 00 FF 31 00") << "after power-on, in an answer of low priority";
  bench.start("F0", prm_data(kLongWatchdog), 2);
  EXPECT_EQ(bench.diag(2), "00 0C 00 02 31 00") << "in data exchange with watchdog, master 2";
  trip(bench, 47);
  go_on(bench, "00 00", 2);
  EXPECT_EQ(bench.inputs(2).substr(0, 2), "2F") << "47 in status word 1";
  EXPECT_EQ(bench.diag(2), "08 0C 00 02 31 00 02 2F") << "Ext_Diag; two octets: the length with itself, the fault";
  EXPECT_EQ(bench.shown("dp.8.fault"), "47");
  EXPECT_EQ(hex(bench.diag(2)).size(), 8U);
  reset(bench);
  go_on(bench, "00 00", 2);
  EXPECT_EQ(bench.diag(2), "00 0C 00 02 31 00") << "six octets again";
  trip(bench, 11);
  go_on(bench, "00 00", 2);
  EXPECT_EQ(bench.diag(2), "08 0C 00 02 31 00 02 0B");
  HandPlant quiet(dp_line() + mc31_station());
  quiet.start("F0", prm_data(kNoWatchdog), 2);
  EXPECT_EQ(quiet.diag(2), "00 04 00 02 31 00") << "WD_On is off without watchdog";
}

TEST(DpDiag, IdentNumbers) {
  PROVES("DP-DIAG-21", "DP-ID-01", "DP-ID-02");
  HandPlant bench(dp_line() + mc31_station());
  EXPECT_EQ(bench.diag().substr(12), "31 00");
  for (int ident = 0; ident < 0x10000; ident += 0x11) {  // 3100h is not among them
    bench.ask(1, 61, prm_data(kNoWatchdog, text_of(Octets{static_cast<uint8_t>(ident >> 8), static_cast<uint8_t>(ident)})));
    ASSERT_EQ(bench.diag(), "42 05 00 FF 31 00") << ident;
  }
  bench.start("F0", prm_data(kNoWatchdog, "31 00"));
  EXPECT_EQ(bench.diag(), "00 04 00 01 31 00");
  HandPlant small(dp_line() + mc31_station("", "", "inv", 8, "size0"));
  EXPECT_EQ(small.diag(), "02 05 00 FF 31 11");
  small.ask(1, 61, prm_data(kNoWatchdog, "31 00"));
  EXPECT_EQ(small.diag(), "42 05 00 FF 31 11");
  small.start("F0", prm_data(kNoWatchdog, "31 11"));
  EXPECT_EQ(small.diag(), "00 04 00 01 31 11");
}

TEST(DpDiag, BadParameters) {
  PROVES("DP-DIAG-06");
  HandPlant bench(dp_line() + mc31_station());
  for (const char* wrong : {"88 14 01 0B 31 01 00", "88 14 01 0B 31 00", "88 14 01 0B 31 00 00 00", ""}) {
    EXPECT_EQ(bench.ask(1, 61, wrong), "E5") << "acknowledged like a good one";
    EXPECT_EQ(bench.diag(), "42 05 00 FF 31 00") << wrong;
    EXPECT_EQ(bench.ask(1, 61, prm_data()), "E5");
    EXPECT_EQ(bench.diag(), "02 0C 00 01 31 00") << "a good one: the bit is 0";
  }
  EXPECT_TRUE(bench.told("refuses Set_Prm: another ident number (Prm_Fault)"));
  EXPECT_TRUE(bench.told("refuses Set_Prm: not 7 octets"));
}

TEST(DpDiag, NotSupported) {
  PROVES("DP-DIAG-08", "DP-ID-05");
  HandPlant bench(dp_line() + mc31_station());
  EXPECT_EQ(bench.ask(1, 55, "05 31 00 00"), "RS") << "Set_Slave_Add";
  EXPECT_EQ(bench.diag(), "12 05 00 FF 31 00");
  EXPECT_TRUE(bench.told("its address is set by switches only (Not_Supported)"));
  bench.ask(1, 61, prm_data());
  EXPECT_EQ(bench.diag(), "02 0C 00 01 31 00");
  for (const int address : {0, 125}) {
    HandPlant there(dp_line() + mc31_station("", "", "inv", address), static_cast<uint8_t>(address));
    EXPECT_EQ(there.diag(2), "02 05 00 FF 31 00") << address;
  }
  for (const int address : {126, 127}) {
    HandPlant none(dp_line() + mc31_station("", "", "inv", address), static_cast<uint8_t>(address));
    EXPECT_EQ(none.ask(1, 60), "-") << address;
    EXPECT_EQ(none.shown("inv.BUS_FAULT_rate"), "0.5 Hz") << address;
  }
}

// Each diagnosis that went over the line, in all that happens here: of the octets 1 to 3 the bits that are reserved or a master's own.
TEST(DpDiag, BitsThatNeverChange) {
  PROVES("DP-DIAG-16", "DP-DIAG-19");
  HandPlant bench(dp_line() + mc31_station());
  int seen = 0;
  const auto check = [&] {
    const Octets octets = hex(bench.diag());
    EXPECT_EQ(octets[0] & 0xA1, 0) << "Master_Lock, Invalid_Slave_Response, Station_Non_Existent";
    EXPECT_EQ(octets[1] & 0xC4, 0x04) << "bit 2 is 1, bits 6 and 7 are 0";
    EXPECT_EQ(octets[2], 0x00);
    ++seen;
  };
  check();
  for (const char* prm : {"80 00 00 0B 31 01 00", "80 00 00 0B", "B0 00 00 0B 31 00 00", "00 00 00 1E 31 00 00", "FF FF FF FF FF FF FF"}) {
    bench.ask(1, 61, prm);
    check();
  }
  for (const char* cfg : {"F3", "F0", "F1"}) {
    bench.start(cfg, prm_data(kModes));
    check();
  }
  for (const auto command : std::initializer_list<uint8_t>{0x20, 0x08, 0x02, 0x00, 0x10, 0x04}) {
    bench.control(command);
    check();
  }
  trip(bench, 47);
  go_on(bench, "00 00 00 00");
  check();
  bench.ask(1, 55, "05 31 00 00");
  check();
  EXPECT_EQ(seen, 17);
}

// While Stat_Diag is set the master asks for diagnosis in place of data.
TEST(DpDiag, StaticDiagnosis) {
  PROVES("DP-DIAG-17");
  DpPlant bench(dp_line() + mc31_station() + dp_master("po = [6, 1500]\n", "[[control.slave.change]]\nat = \"2100ms\"\npo = [6, 3000]\n") +
                "[[fault]]\nbus = \"dp\"\nkind = \"diagnosis\"\nstation = \"inv\"\nfrom = \"2s\"\nuntil = \"3s\"\n");
  bench.shown("dp.8.status2");  // from now on it is looked at
  bench.run(2 * kSecond);
  EXPECT_EQ(bench.shown("dp.8.status2"), "4");
  bench.run_on(50 * kMillisecond);
  const uint64_t exchanges = bench.master().slave(0).exchanges();
  bench.run_on(900 * kMillisecond);
  EXPECT_EQ(bench.master().slave(0).exchanges(), exchanges) << "no data";
  EXPECT_EQ(bench.shown("dp.8.status2"), "6") << "it is asked, and says so";
  EXPECT_TRUE(bench.told("has no valid data for a while")) << "the journal";
  EXPECT_EQ(bench.speed(), 300'000) << "3000 digits have not arrived";
  bench.run(5 * kSecond);
  EXPECT_EQ(bench.shown("dp.8.status2"), "4");
  EXPECT_GT(bench.master().slave(0).exchanges(), exchanges + 100);
  EXPECT_EQ(bench.speed(), 600'000);
}

// The plan of the master has the two types the other way round.
TEST(DpDiag, SwappedSlavesOfTwoTypes) {
  PROVES("DP-ID-04");
  const auto plant = [](const char* of_8, const char* of_9) {
    return std::make_unique<DpPlant>(
        dp_line() + mc31_station("", "", "small", 8, "size0") + mc31_station("", "", "large", 9) +
        "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\nident = " + of_8 + "\npo = [6, 1500]\n" +
        "[[control.slave]]\naddress = 9\nident = " + of_9 + "\npo = [6, 1500]\n");
  };
  const auto swapped = plant("0x3100", "0x3111");
  swapped->shown("dp.8.status1");  // from now on it is looked at
  swapped->run(3 * kSecond);
  for (size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(swapped->master().slave(n).exchanges(), 0U) << n;
    EXPECT_TRUE(swapped->master().slave(n).view().has(profibus::diag::kPrmFault)) << n;
    EXPECT_EQ(swapped->speed(n), 0);
  }
  const auto right = plant("0x3111", "0x3100");
  right->run(3 * kSecond);
  for (size_t n = 0; n < 2; ++n) {
    EXPECT_TRUE(right->master().slave(n).exchanging()) << n;
    EXPECT_EQ(right->speed(n), 300'000);
  }
}

// Six rates are found without a setting at the station; 3000 kbaud is none.
TEST(DpDiag, AutomaticRate) {
  PROVES("DP-ID-08");
  for (const uint32_t baud : {9'600U, 19'200U, 93'750U, 187'500U, 500'000U, 1'500'000U}) {
    DpPlant bench(dp_line(baud) + mc31_station() + dp_master("po = [6, 1500]\n"));
    bench.run(6 * kSecond);
    EXPECT_TRUE(bench.master().slave(0).exchanging()) << baud;
    EXPECT_EQ(bench.speed(), 300'000) << baud;
  }
  EXPECT_NE(errors_of(dp_line(3'000'000)).find("9600, 19200, 93750, 187500, 500000 or 1500000 baud, not 3000000"), std::string::npos);
}

// P073 shows the address in use: that of the switches at the last power-on, and no other.
TEST(DpDiag, AddressInUse) {
  PROVES("DP-ID-07");
  HandPlant bench(dp_line() + mc31_station());
  EXPECT_EQ(bench.shown("inv.P073"), "8");
  EXPECT_EQ(bench.station().set_switch(runtime::StationSwitch::ProfibusAddress, 9), std::nullopt);
  bench.run_on(kSecond);
  EXPECT_EQ(bench.shown("inv.P073"), "8");
  EXPECT_EQ(bench.diag(), "02 05 00 FF 31 00") << "it answers at the old one";
  bench.plant->set_power("inv", false);
  bench.run_on(100 * kMillisecond);
  bench.plant->set_power("inv", true);
  bench.settle();
  EXPECT_EQ(bench.shown("inv.P073"), "9");
  EXPECT_EQ(bench.ask(1, 60), "-");
  bench.to = 9;
  EXPECT_EQ(bench.diag(), "02 05 00 FF 31 00");
  bench.start("F3 F0", prm_data(kNoWatchdog));
  EXPECT_EQ(bench.service("71 00 03 FA 00 00 00 00"), "71 00 03 FA 00 00 00 09") << "P073 over the bus";
}

}  // namespace
}  // namespace ipos::tests
