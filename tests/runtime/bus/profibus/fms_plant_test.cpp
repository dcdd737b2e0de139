// FMS of a MOVITRAC 31 as a user has it: in a plant, over the line, beside DP (MOVITRAC 31 PROFIBUS, chapter 4, 2.7, 2.8).
// Expected values are those that the manual prints, and arithmetic on its words.
#include "runtime/station/dp_slaves.hpp"
#include "tests/runtime/bus/profibus/dp_plant_rig.hpp"

namespace ipos::tests {
namespace {

namespace fms = profibus::fms;
using fms::Service;
using runtime::kMillisecond;
using runtime::kSecond;
using runtime::Time;

std::string unit(const std::string& keys = "", const std::string& option = "ffp31") {
  return "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 500000\n[[station]]\nname = \"inv\"\nunit = \"mc31\"\n"
         "option = \"" + option + "\"\nprofibus = \"dp\"\nprofibus_address = 8\n" + keys +
         "[station.parameters]\nP841 = \"FIELDBUS\"\nP600 = 0\nP601 = 0\n[station.inputs]\nDI00 = 1\n";
}
const std::string kDp = "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\ncfg = \"F2\"\npo = [6, 1500]\n";

const std::string kRejected = "rejected: the service is not there on this connection";

struct FmsPlant : DpPlant {
  explicit FmsPlant(const std::string& text) : DpPlant(text) {
    hand();  // joins the ring, and a slave that hears nobody else finds the rate
    run(1500 * kMillisecond);
  }
  runtime::FmsOperator& hand() {
    return runtime::fms_operator_of(*plant, *runtime::as<runtime::ProfibusBus>(plant->find_bus("dp")));
  }

  fms::Response done(Service service, uint16_t index = 0, const std::string& data = "", uint8_t cref = 7) {
    hand().ask(8, *fms::find_connection(cref), {service, index, hex(data)});
    for (int n = 0; n < 10'000; ++n) {
      run_on(kMillisecond);
      if (auto one = hand().take()) return one->response;
    }
    return fms::Response::aborted(fms::Reason::NoAnswer);
  }
  std::string ask(Service service, uint16_t index = 0, const std::string& data = "", uint8_t cref = 7) {
    return fms::describe(done(service, index, data, cref));
  }
  std::string read(uint16_t index) { return ask(Service::Read, index); }
  std::string write(uint16_t index, const std::string& data) { return ask(Service::Write, index, data); }
  // Class, code and additional code of a negative response, as the manual writes them.
  std::string refused(Service service, uint16_t index, const std::string& data = "") {
    const fms::Response response = done(service, index, data);
    if (response.end != fms::End::Error) return fms::describe(response);
    const uint32_t packed = response.error.packed();
    return text_of(profibus::Octets{static_cast<uint8_t>(packed >> 24), static_cast<uint8_t>(packed >> 16),
                                    static_cast<uint8_t>(packed >> 8), static_cast<uint8_t>(packed)});
  }
  const profibus::InterfaceCard& card() { return std::as_const(station()).profibus()->card(); }
  profibus::LedPattern lamps() { return card().leds(plant->now()); }
};

std::string described(int index, int length, const std::string& access) {
  return std::to_string(index) + ": object code 7, data type 10, " + std::to_string(length) + " octets, " + access;
}

TEST(FmsPlant, ObjectList) {
  PROVES("FMS-OBJ-01", "FMS-OBJ-03", "FMS-OBJ-05", "FMS-OBJ-07", "FMS-OBJ-14", "FMS-SVC-08");
  FmsPlant bench(unit());
  const std::string all = "read all / write all";
  const std::pair<int, std::pair<int, std::string>> kPrinted[] = {
      {988, {2, all}}, {989, {4, all}}, {990, {6, all}}, {991, {2, "read all"}}, {992, {4, "read all"}}, {993, {6, "read all"}},
      {994, {1, all}}, {995, {6, all}}, {996, {230, "write all"}}, {997, {10, "write all"}}, {998, {4, all}}, {999, {8, all}},
      {1025, {4, all}}};
  for (const auto& [index, rest] : kPrinted) {
    EXPECT_EQ(bench.ask(Service::GetOvLong, static_cast<uint16_t>(index)), described(index, rest.first, rest.second));
    EXPECT_EQ(bench.ask(Service::GetOvShort, static_cast<uint16_t>(index)).substr(0, 3), std::to_string(index).substr(0, 3));
  }
  for (const uint16_t none : {uint16_t{0}, uint16_t{1}, uint16_t{987}})
    EXPECT_EQ(bench.refused(Service::GetOvLong, none), "06 07 00 00") << none;
  // One for each parameter, and no more that can be read: P120 is 25, so 1025.
  EXPECT_EQ(bench.write(1025, "00 00 09 50"), "done");
  EXPECT_EQ(bench.value("120"), 950);
  EXPECT_EQ(bench.refused(Service::Read, 996), "06 03 00 00");
}

TEST(FmsPlant, WhatTheInverterRefuses) {
  PROVES("FMS-OBJ-04", "FMS-OBJ-06", "FMS-OBJ-24", "FMS-SVC-10", "FMS-SVC-11");
  FmsPlant bench(unit());
  EXPECT_EQ(bench.ask(Service::GetOvLong, 1999), described(1999, 4, "read all / write all")) << "it is in the list";
  EXPECT_EQ(bench.refused(Service::Read, 1999), "08 00 00 10");
  EXPECT_EQ(bench.ask(Service::GetOvLong, 1018), described(1018, 4, "read all / write all")) << "P073, read only";
  EXPECT_EQ(bench.refused(Service::Write, 1018, "00 00 00 05"), "08 00 00 12");
  EXPECT_EQ(bench.refused(Service::Write, 1025, "99 99 99 99"), "08 00 00 15");
  EXPECT_EQ(bench.refused(Service::Write, 1025, "00 00 09"), "06 08 00 00");
  const int32_t before = bench.value("120");
  EXPECT_EQ(bench.refused(Service::PhysicalWrite, 0, "01 02").substr(0, 2), "06");
  EXPECT_EQ(bench.value("120"), before);
}

// The link between card and unit is lost: a plant says so with a fault.
TEST(FmsPlant, LinkToTheInverter) {
  PROVES("FMS-OBJ-02", "DP-PAR-13");
  FmsPlant bench(unit() + "[[fault]]\nbus = \"dp\"\nkind = \"link\"\nstation = \"inv\"\nfrom = \"2s\"\nuntil = \"4s\"\n"
                          "[[fault]]\nbus = \"dp\"\nkind = \"link\"\nstation = \"inv\"\nfrom = \"6s\"\n");
  EXPECT_EQ(bench.read(1025).size(), 11U);
  bench.run(2100 * kMillisecond);
  EXPECT_EQ(bench.read(994), "0B") << "the card answers itself";
  EXPECT_EQ(bench.read(995), "02 05 00 FF 31 00");
  EXPECT_EQ(bench.refused(Service::Read, 1025), "06 02 00 00");
  EXPECT_EQ(bench.refused(Service::Write, 1025, "00 00 09 50"), "06 02 00 00");
  bench.run(4100 * kMillisecond);
  EXPECT_EQ(bench.write(1025, "00 00 09 50"), "done") << "repeated";
  bench.run(6100 * kMillisecond);
  EXPECT_EQ(bench.refused(Service::Read, 1025), "06 02 00 00");
  bench.plant->set_power("inv", false);
  bench.run_on(100 * kMillisecond);
  bench.plant->set_power("inv", true);
  bench.run_on(2 * kSecond);
  EXPECT_EQ(bench.read(1025), "aborted: the connection is not open") << "of before";
  EXPECT_EQ(bench.read(1025), "00 00 09 50") << "only power-off clears a lasting one";
}

TEST(FmsPlant, ControlsTheDrive) {
  PROVES("FMS-OBJ-08", "FMS-OBJ-09", "FMS-OBJ-11");
  FmsPlant alone(unit());
  EXPECT_EQ(alone.write(989, "00 06 05 DC"), "done");
  alone.run_on(5 * kSecond);
  EXPECT_EQ(alone.speed(), 300'000) << "1500 x 0.2 rpm";
  const std::string status = alone.read(991);
  EXPECT_EQ(alone.read(992), status + " 05 DC");
  EXPECT_EQ(alone.read(993).substr(0, 11), status + " 05 DC");
  for (const uint16_t index : {uint16_t{991}, uint16_t{992}, uint16_t{993}})
    EXPECT_EQ(alone.refused(Service::Write, index, "00 00"), "06 03 00 00");
  EXPECT_EQ(alone.write(988, "00 00"), "done");
  alone.run_on(5 * kSecond);
  EXPECT_EQ(alone.speed(), 0);
  FmsPlant mixed(unit() + kDp);
  EXPECT_EQ(mixed.read(989), "00 06 05 DC") << "what the DP master sends";
  EXPECT_EQ(mixed.read(988), "00 06");
  EXPECT_EQ(mixed.refused(Service::Write, 990, "00 00 00 00 00 00"), "06 03 00 00");
  mixed.run_on(5 * kSecond);
  EXPECT_EQ(mixed.speed(), 300'000);
}

// DP and FMS at the same time, wherever the switch stands; size 0 has no FMS.
TEST(FmsPlant, Combislave) {
  PROVES("DP-CFG-20", "FMS-OBJ-13", "FMS-OBJ-10");
  for (const char* position : {"fms_switch = false\n", "fms_switch = true\n"}) {
    FmsPlant bench(unit(position) + kDp + "[[control.slave.change]]\nat = \"2s\"\npo = [6, 6, 6]\n");
    EXPECT_TRUE(bench.master().slave(0).exchanging());
    EXPECT_EQ(bench.read(1025).size(), 11U);
    EXPECT_EQ(bench.read(995), "00 04 00 01 31 00");
    bench.run(2500 * kMillisecond);
    EXPECT_EQ(bench.read(990), "00 06 00 06 00 06");
    const uint64_t before = bench.master().slave(0).exchanges();
    bench.run_on(kSecond);
    EXPECT_GT(bench.master().slave(0).exchanges(), before + 100);
    EXPECT_TRUE(bench.master().slave(0).exchanging());
  }
  FmsPlant small(unit("", "size0"));
  EXPECT_EQ(small.ask(Service::Read, 1025), "aborted: nobody answers");
  EXPECT_TRUE(small.told("this interface has no FMS"));
}

// min Tsdr by the switch: 11 bit times for DP, more for FMS; what is written lasts until power-off.
TEST(FmsPlant, MinTsdr) {
  PROVES("DP-ID-09", "FMS-OBJ-12");
  FmsPlant dp(unit());
  EXPECT_EQ(dp.read(994), "0B");
  FmsPlant bench(unit("fms_switch = true\n"));
  const std::string by_switch = bench.read(994);
  EXPECT_GT(hex(by_switch)[0], 11);
  EXPECT_EQ(bench.write(994, "1E"), "done");
  EXPECT_EQ(bench.read(994), "1E");
  EXPECT_EQ(bench.refused(Service::Write, 994, "0A"), "08 00 00 16");
  bench.plant->set_power("inv", false);
  bench.run_on(100 * kMillisecond);
  bench.plant->set_power("inv", true);
  bench.run_on(2 * kSecond);
  EXPECT_EQ(bench.read(994), "aborted: the connection is not open") << "of before";
  EXPECT_EQ(bench.read(994), by_switch);
}

std::string block(const std::string& begin) {
  profibus::Octets octets = hex(begin);
  octets.resize(230);
  return text_of(octets);
}

TEST(FmsPlant, DownloadBlock) {
  PROVES("FMS-OBJ-15", "FMS-OBJ-16", "FMS-OBJ-17", "FMS-OBJ-18");
  FmsPlant bench(unit());
  // P120 = 9.50 s and 1.20 s, one after the other: the last one stays. P841 (175) stays FIELDBUS.
  EXPECT_EQ(bench.write(996, block("00 03 04 01 00 00 09 50 04 97 00 00 00 01 04 01 00 00 01 20")), "done");
  EXPECT_EQ(bench.value("120"), 120);
  std::string entries = "00 14";
  for (int n = 1; n <= 20; ++n) {
    char entry[32];
    std::snprintf(entry, sizeof entry, n == 11 ? " 04 01 99 99 99 99" : " 04 01 00 00 00 %02d", n);
    entries += entry;
  }
  const Time from = bench.plant->now();
  EXPECT_EQ(bench.refused(Service::Write, 996, block(entries)), "08 00 0B 15");
  EXPECT_EQ(bench.value("120"), 10);
  EXPECT_GE(bench.plant->now() - from, 10 * kMillisecond) << "the answer comes last";
  EXPECT_EQ(bench.refused(Service::Write, 996, block("00 27")), "06 08 00 00") << "39 entries";
}

TEST(FmsPlant, UniversalObjects) {
  PROVES("FMS-OBJ-20", "FMS-OBJ-21", "FMS-OBJ-22", "FMS-OBJ-23");
  FmsPlant bench(unit());
  EXPECT_EQ(bench.write(997, "04 01 00 00 09 50 00 00 00 00"), "done");
  EXPECT_EQ(bench.value("120"), 950);
  EXPECT_EQ(bench.refused(Service::Read, 997), "06 03 00 00");
  EXPECT_EQ(bench.read(998), "03 E8 00 00");
  EXPECT_EQ(bench.write(998, "04 01 00 00"), "done");
  EXPECT_EQ(bench.read(999), "00 00 09 50 00 00 00 00");
  EXPECT_EQ(bench.read(998), "04 01 00 00");
  EXPECT_EQ(bench.write(998, "03 E8 00 01"), "done");
  for (int n = 0; n < 3; ++n) bench.read(999);
  EXPECT_EQ(bench.read(998), "03 EB 00 01");
  EXPECT_EQ(bench.write(998, "04 01 FF FF"), "done");
  bench.read(999);
  EXPECT_EQ(bench.read(998), "04 00 FF FF") << "1025 + 65535 in 16 bits";
  EXPECT_EQ(bench.refused(Service::Write, 999, "04 01 00 00 00 00 00 00"), "06 03 00 00");
  EXPECT_EQ(bench.value("120"), 950);
}

TEST(FmsPlant, Services) {
  PROVES("FMS-SVC-01", "FMS-SVC-02", "FMS-SVC-04", "FMS-SVC-06", "FMS-SVC-07", "FMS-SVC-09");
  FmsPlant bench(unit());
  EXPECT_EQ(bench.ask(Service::Initiate, 0, "", 8), "done");
  EXPECT_EQ(bench.ask(Service::Initiate, 0, "", 8), "aborted: the connection was open");
  EXPECT_EQ(bench.ask(Service::Initiate, 0, "", 8), "done");
  const fms::Response identity = bench.done(Service::Identify);
  ASSERT_EQ(identity.texts.size(), 3U);
  EXPECT_EQ(identity.texts[0], "SEW-Eurodrive GmbH & Co");
  EXPECT_EQ(identity.texts[1], "MOVITRAC");
  EXPECT_EQ(identity.texts[2].substr(0, 3), "821");
  EXPECT_EQ(identity.texts[2].find_first_not_of("0123456789"), std::string::npos);
  EXPECT_EQ(identity.texts[2].size(), 9U);
  EXPECT_EQ(bench.ask(Service::Status), "00 00") << "logical and physical state, no local detail";
  EXPECT_EQ(bench.ask(Service::AcknowledgeEvent, 0, "", 8), kRejected);
  EXPECT_EQ(bench.read(1025).size(), 11U);
}

// A master of the plant file: its requests at their times, what does not fit is refused.
TEST(FmsPlant, MasterOfThePlantFile) {
  PROVES("FMS-SVC-03", "FMS-CRL-15", "FMS-CRL-16", "FMS-CRL-17", "FMS-CRL-18");
  const auto master = [](const std::string& keys) {
    return "[[control]]\nname = \"vis\"\nkind = \"fms\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\n" + keys +
           "[[control.slave.request]]\nat = \"1s\"\nwrite = 1025\ndata = \"00 00 09 50\"\n"
           "[[control.slave.request]]\nat = \"1500ms\"\nevery = \"200ms\"\nread = 1025\n";
  };
  DpPlant good(unit() + kDp + master("features = \"80 33 00 00 00 00\"\npdu = \"00 F1 00 F1\"\n"));
  good.run(3 * kSecond);
  EXPECT_EQ(good.value("120"), 950);
  EXPECT_TRUE(good.told("slave 8, connection 7, Read 1025: 00 00 09 50"));
  EXPECT_TRUE(good.told("slave 8, connection 7, Write 1025 = 00 00 09 50: done"));
  EXPECT_TRUE(good.told("has opened an FMS connection (master 2)"));
  EXPECT_TRUE(good.master().slave(0).exchanging());
  for (const char* wrong : {"features = \"80 33 10 00 00 00\"\n", "pdu = \"00 F1 00 F0\"\n", "pdu = \"00 F2 00 F1\"\n"}) {
    DpPlant bad(unit() + master(wrong));
    bad.run(3 * kSecond);
    EXPECT_NE(bad.value("120"), 950) << wrong;
    EXPECT_TRUE(bad.told("error, class 0")) << wrong;
  }
  DpPlant unfit(unit() + master("counters = \"00 00 00 00\"\n"));
  unfit.run(10 * kMillisecond);
  EXPECT_TRUE(unfit.told("SCC is 0, RCC of the slave 1"));
  // On a connection that only reads a write is rejected.
  DpPlant cyclic(unit() + master("connection = 2\n"));
  cyclic.run(3 * kSecond);
  EXPECT_TRUE(cyclic.told(kRejected));
  EXPECT_EQ(errors_of(unit() + "[[control]]\nname = \"v\"\nkind = \"fms\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\nconnection = 9\n")
                .find("connection is 2 to 8") == std::string::npos,
            false);
}

struct Row {
  uint8_t cref;
  bool reads, writes, describes;
};

// CREF 2 to 5 are cyclic ones for one service, 6 to 8 have all; what a connection has not is rejected.
TEST(FmsPlant, Connections) {
  PROVES("FMS-CRL-01", "FMS-CRL-02", "FMS-CRL-03", "FMS-CRL-04", "FMS-CRL-05", "FMS-CRL-06", "FMS-CRL-07", "FMS-CRL-08",
         "FMS-CRL-09", "FMS-CRL-10", "FMS-CRL-14");
  const std::pair<const char*, Row> kRows[] = {
      {"2 MSZY O 20 All All 0 0 0 0 3000", {2, true, false, false}},    {"3 MSZY O 21 All All 0 0 0 0 3000", {3, false, true, false}},
      {"4 MSZY_SI O 22 All All 0 0 1 0 3000", {4, true, false, false}}, {"5 MSZY_SI O 23 All All 0 0 1 0 3000", {5, false, true, false}},
      {"6 MSAZ_SI O 24 All All 0 1 1 0 0", {6, true, true, true}},      {"7 MSAZ O 25 All All 0 1 0 0 0", {7, true, true, true}},
      {"8 MSAZ O 26 All All 0 1 0 0 0", {8, true, true, true}}};
  ASSERT_EQ(fms::connections().size(), std::size(kRows));
  FmsPlant bench(unit());
  for (const auto& [printed, row] : kRows) {
    EXPECT_EQ(fms::describe(*fms::find_connection(row.cref)), printed);
    EXPECT_EQ(bench.ask(Service::Read, 1025, "", row.cref) != kRejected, row.reads) << printed;
    EXPECT_EQ(bench.ask(Service::Write, 1025, "00 00 09 50", row.cref), row.writes ? "done" : kRejected) << printed;
    EXPECT_EQ(bench.ask(Service::GetOvLong, 1025, "", row.cref) != kRejected, row.describes) << printed;
    EXPECT_EQ(bench.ask(Service::AcknowledgeEvent, 0, "", row.cref), kRejected) << printed;
  }
  for (const int none : {0, 1, 9, 10}) EXPECT_EQ(fms::find_connection(static_cast<uint8_t>(none)), nullptr);
}

// Without data within 30 s a cyclic connection ends, and with it the lamp; an acyclic one stays.
TEST(FmsPlant, ControlInterval) {
  PROVES("FMS-CRL-13", "FMS-SVC-05");
  const auto plant = [](const std::string& connection) {
    return unit("fms_switch = true\n") + "[[control]]\nname = \"vis\"\nkind = \"fms\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\nconnection = " +
           connection + "\n[[control.slave.request]]\nat = \"1s\"\ninitiate = true\n" +
           "[[fault]]\nbus = \"dp\"\nkind = \"lost\"\nstation = \"vis\"\nfrom = \"2s\"\nuntil = \"50s\"\n";
  };
  DpPlant cyclic(plant("2"));
  const auto connected = [](DpPlant& bench) {
    return bench.station().profibus()->card().fms().connected(bench.plant->now());
  };
  cyclic.run(30 * kSecond);
  EXPECT_TRUE(connected(cyclic));
  cyclic.run(33 * kSecond);
  EXPECT_FALSE(connected(cyclic));
  DpPlant acyclic(plant("7"));
  acyclic.run(49 * kSecond);
  EXPECT_TRUE(connected(acyclic));
  // Of the master: no answer, and no connection.
  FmsPlant bench(unit());
  EXPECT_EQ(bench.ask(Service::Initiate), "done");
  EXPECT_EQ(bench.ask(Service::Abort), "done");
  EXPECT_FALSE(connected(bench));
}

// --- lamps and switches

TEST(FmsPlant, LampsOfMixedMode) {
  PROVES("DP-LED-07", "DP-LED-01", "DP-LED-05");
  using profibus::Light;
  DpPlant young(unit());
  young.run(100 * kMillisecond);
  EXPECT_EQ(std::as_const(young.station()).profibus()->card().leds(young.plant->now()),
            (profibus::LedPattern{Light::ThreeHertz, Light::Off}));
  FmsPlant bench(unit("fms_switch = true\n") + kDp);
  EXPECT_EQ(bench.lamps(), (profibus::LedPattern{Light::On, Light::On})) << "DP alone, in mixed mode";
  EXPECT_EQ(bench.ask(Service::Initiate), "done");
  EXPECT_EQ(bench.lamps(), (profibus::LedPattern{Light::On, Light::Off}));
  bench.hand().ask(8, *fms::find_connection(7), {Service::Write, 996, hex(block("00 02 04 01 00 00 09 50 04 01 00 00 09 50"))});
  int flickers = 0;
  for (int n = 0; n < 20; ++n) {
    bench.run_on(kMillisecond);
    flickers += bench.lamps().green == Light::Flicker ? 1 : 0;
  }
  EXPECT_GT(flickers, 5) << "while a block is written";
}

TEST(FmsPlant, HardwareFaultsOfTheCard) {
  PROVES("DP-LED-06");
  using profibus::Light;
  FmsPlant bench(unit() + kDp + "[[fault]]\nbus = \"dp\"\nkind = \"card\"\nstation = \"inv\"\nfrom = \"2s\"\nuntil = \"3s\"\n" +
                 "[[fault]]\nbus = \"dp\"\nkind = \"card_flash\"\nstation = \"inv\"\nfrom = \"4s\"\nuntil = \"5s\"\n");
  const profibus::LedPattern before = bench.lamps();
  bench.run(2500 * kMillisecond);
  EXPECT_EQ(bench.lamps(), (profibus::LedPattern{Light::Off, Light::On}));
  EXPECT_FALSE(bench.master().slave(0).exchanging());
  bench.run(3500 * kMillisecond);
  EXPECT_EQ(bench.lamps(), before);
  bench.run(4500 * kMillisecond);
  EXPECT_EQ(bench.lamps(), (profibus::LedPattern{Light::OneHertz, Light::OneHertz}));
}

// A hand turns switches while the plant runs: they act from the next power-on.
TEST(FmsPlant, SwitchesActFromPowerOn) {
  PROVES("DP-ID-06");
  FmsPlant bench(unit());
  runtime::Station& station = bench.station();
  EXPECT_EQ(station.set_switch(runtime::StationSwitch::FmsSwitch, 1), std::nullopt);
  EXPECT_EQ(station.set_switch(runtime::StationSwitch::ProfibusAddress, 9), std::nullopt);
  EXPECT_EQ(station.switch_value(runtime::StationSwitch::ProfibusAddress), 9);
  EXPECT_EQ(bench.read(994), "0B");
  EXPECT_EQ(bench.card().station().slave().address(), 8);
  bench.plant->set_power("inv", false);
  bench.run_on(100 * kMillisecond);
  bench.plant->set_power("inv", true);
  bench.run_on(2 * kSecond);
  EXPECT_EQ(bench.card().station().slave().address(), 9);
  EXPECT_TRUE(bench.card().station().switches().fms());
  EXPECT_EQ(errors_of(unit("fms_switch = true\n", "size0")).find("has no FMS/DP switch") == std::string::npos, false);
}

// A and B interchanged at the slave: the master hears nobody; at the master: nobody hears it.
TEST(FmsPlant, SwappedWires) {
  PROVES("DP-ID-12");
  const std::string fault = "[[fault]]\nbus = \"dp\"\nkind = \"swap\"\nfrom = \"2s\"\nuntil = \"4s\"\nstation = ";
  for (const char* who : {"\"inv\"\n", "\"plc\"\n"}) {
    FmsPlant bench(unit() + kDp + fault + who);
    EXPECT_TRUE(bench.master().slave(0).exchanging());
    bench.run(3 * kSecond);
    EXPECT_FALSE(bench.master().slave(0).exchanging()) << who;
    EXPECT_TRUE(bench.told("has A and B interchanged"));
    bench.run(8 * kSecond);
    EXPECT_TRUE(bench.master().slave(0).exchanging()) << who;
  }
}

}  // namespace
}  // namespace ipos::tests
