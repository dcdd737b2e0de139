// The slave's states and services against the manual and the norm's tables, frame by frame.
#include "runtime/bus/profibus/dp_slave.hpp"

#include "tests/runtime/bus/profibus/slave_rig.hpp"

namespace ipos::tests {
namespace {

// The start-up of the captured S7, with this unit's ident and configuration.
TEST(DpSlave, StartUpAsAMasterDoesIt) {
  PROVES("DP-CFG-10", "DP-CFG-12", "DP-DIAG-11", "DP-DIAG-18", "DP-DIAG-20");
  SlaveBench bench;
  bench.control(1, 0);  // "Operate" goes out before anybody listens
  EXPECT_EQ(bench.diag(), "02 05 00 FF 31 00");
  EXPECT_EQ(bench.ask(1, 59), "08 F0");
  EXPECT_EQ(bench.exchange(1, "00 06 05 DC 00 00"), "RS");
  EXPECT_EQ(bench.ask(1, 61, prm()), "E5");
  EXPECT_EQ(bench.diag(), "02 0C 00 01 31 00");
  EXPECT_EQ(bench.exchange(1, "00 06 05 DC 00 00"), "RS");
  EXPECT_EQ(bench.ask(1, 62, "F2"), "E5");
  EXPECT_EQ(bench.diag(), "00 0C 00 01 31 00");
  EXPECT_EQ(bench.ask(1, 59), "08 F2");
  EXPECT_EQ(bench.exchange(1, "00 06 05 DC 00 00"), "08 01 01 01 01 01 01");
  EXPECT_EQ(text_of(bench.unit.outputs), "00 06 05 DC 00 00");
  EXPECT_EQ(bench.unit.name, "3 PD");
  // A wrong step: Chk_Cfg without Set_Prm changes nothing.
  SlaveBench early;
  EXPECT_EQ(early.ask(1, 62, "F2"), "E5");
  EXPECT_EQ(early.diag(), "02 05 00 FF 31 00");
  EXPECT_TRUE(early.notes.last_is(SlaveNote::CfgTooEarly));
}

TEST(DpSlave, DiagnosisFrames) {
  PROVES("DP-DIAG-02", "DP-DIAG-09", "DP-DIAG-15", "DP-DIAG-21", "DP-DIAG-22");
  SlaveBench bench;
  EXPECT_EQ(bench.ask(2, 60), "08 02 05 00 FF 31 00");
  bench.start(2);
  EXPECT_EQ(bench.diag(2), "00 0C 00 02 31 00");
  bench.slave.set_fault(bench.now, 47);
  bench.now += 100 * kMillisecond;
  bench.exchange(2, "00 00 00 00 00 00");
  bench.now = 800 * kMillisecond;
  EXPECT_EQ(bench.diag(2), "08 0C 00 02 31 00 02 2F");
  bench.slave.set_fault(bench.now, std::nullopt);
  bench.now = 1600 * kMillisecond;
  EXPECT_EQ(bench.diag(2), "00 0C 00 02 31 00");
  SlaveBench quiet({8, 0x3111});
  quiet.start(2, prm(kNoWatchdog, "31 11"));
  EXPECT_EQ(quiet.diag(2), "00 04 00 02 31 11");
}

TEST(DpSlave, UnitDiagnosisIsRefreshedEvery800Milliseconds) {
  PROVES("DP-DIAG-04");
  for (Time at = 0; at <= 1700; at += 100) {
    SlaveBench bench;
    bench.start(1, prm(kNoWatchdog));
    bench.slave.set_fault(at * kMillisecond, 11);
    Time seen = -1;
    for (Time now = at; seen < 0 && now < at + 2000; ++now) {
      bench.now = now * kMillisecond;
      if (bench.diag().size() > 17) seen = now;
    }
    EXPECT_EQ(seen, (at + 799) / 800 * 800) << at;  // the next multiple of 800 ms
  }
  // What came and went between two refreshes was never shown.
  SlaveBench bench;
  bench.slave.set_fault(100 * kMillisecond, 11);
  bench.slave.set_fault(700 * kMillisecond, std::nullopt);
  bench.now = 900 * kMillisecond;
  EXPECT_EQ(bench.diag(), "02 05 00 FF 31 00");
}

TEST(DpSlave, AnswersHighUntilDiagnosisIsFetched) {
  SlaveBench bench;
  bench.start(1, prm(kNoWatchdog));
  EXPECT_EQ(bench.exchange(1, "00 00 00 00 00 00").substr(0, 2), "08");
  bench.slave.set_fault(10 * kMillisecond, 47);
  bench.now = 799 * kMillisecond;
  EXPECT_EQ(bench.exchange(1, "00 00 00 00 00 00").substr(0, 2), "08");
  bench.now = 800 * kMillisecond;
  EXPECT_EQ(bench.exchange(1, "00 00 00 00 00 00").substr(0, 2), "0A");
  EXPECT_EQ(bench.exchange(1, "00 00 00 00 00 00").substr(0, 2), "0A");
  bench.diag(9);  // another master's look does not count
  bench.exchange(1, "00 00 00 00 00 00");
  EXPECT_EQ(bench.diag(1), "08 04 00 01 31 00 02 2F");
  EXPECT_EQ(bench.exchange(1, "00 00 00 00 00 00").substr(0, 2), "08");
  bench.slave.set_static_diagnosis(true);
  EXPECT_EQ(bench.diag(1), "08 06 00 01 31 00 02 2F");
  EXPECT_EQ(bench.exchange(1, "00 00 00 00 00 00").substr(0, 2), "0A");
}

TEST(DpSlave, BitsThatNeverChange) {
  PROVES("DP-DIAG-16", "DP-DIAG-19");
  SlaveBench bench;
  const auto check = [&] {
    const Octets octets = encode(bench.slave.diagnosis(bench.now));
    EXPECT_EQ(octets[0] & 0xA1, 0);
    EXPECT_EQ(octets[1] & 0xC4, 0x04);
    EXPECT_EQ(octets[2], 0);
  };
  check();
  bench.ask(1, 61, "80 00 00 0B 31 01 00");
  check();
  bench.start(1, prm(kModes));
  check();
  bench.control(1, 0x28);
  check();
  bench.slave.set_static_diagnosis(true);
  bench.ask(1, 55, "05 31 00 00");
  check();
}

TEST(DpSlave, SetPrmFaults) {
  PROVES("DP-DIAG-06", "DP-ID-01");
  const std::pair<std::string, SlaveNote> kWrong[] = {
      {"80 00 00 0B 31 01 00", SlaveNote::PrmIdent},
      {"80 00 00 0B 31 00", SlaveNote::PrmLength},
      {"80 00 00 0B 31 00 00 00", SlaveNote::PrmLength},
      {"81 00 00 0B 31 00 00", SlaveNote::PrmReserved},
      {"88 00 01 0B 31 00 00", SlaveNote::PrmWatchdog},
      {"88 01 00 0B 31 00 00", SlaveNote::PrmWatchdog},
      {"80 00 00 0A 31 00 00", SlaveNote::PrmMinTsdr},
      {"80 00 00 01 31 00 00", SlaveNote::PrmMinTsdr},
      {"80 00 00 0B 31 00 00 00 00 00", SlaveNote::PrmLength}};
  for (const auto& [data, why] : kWrong) {
    SlaveBench bench;
    EXPECT_EQ(bench.ask(1, 61, data), "E5") << data;
    EXPECT_TRUE(bench.notes.last_is(why)) << data;
    EXPECT_EQ(bench.diag(), why == SlaveNote::PrmReserved ? "52 05 00 FF 31 00" : "42 05 00 FF 31 00")
        << data;
    EXPECT_EQ(bench.slave.min_tsdr(), 11);
    bench.start();
    EXPECT_EQ(bench.diag(), "00 0C 00 01 31 00");
    // In data exchange it ends it.
    EXPECT_EQ(bench.ask(1, 61, data), "E5");
    EXPECT_EQ(bench.slave.state(), SlaveState::WaitPrm);
    EXPECT_EQ(bench.unit.ended, 1);
    EXPECT_EQ(bench.exchange(1, "00 00 00 00 00 00"), "RS");
  }
  // Every ident number but its own.
  SlaveBench bench;
  for (int ident = 0; ident < 0x10000; ident += 0xFF) {
    const Octets octets{0x80, 0, 0, 11, static_cast<uint8_t>(ident >> 8), static_cast<uint8_t>(ident), 0};
    bench.ask(1, std::optional<uint8_t>(61), octets);
    EXPECT_EQ(bench.slave.state() == SlaveState::WaitCfg, ident == 0x3100) << ident;
  }
}

TEST(DpSlave, Size0HasItsOwnIdent) {
  PROVES("DP-ID-02");
  SlaveBench bench({8, 0x3111});
  bench.ask(1, 61, prm(kNoWatchdog, "31 00"));
  EXPECT_EQ(bench.diag(), "42 05 00 FF 31 11");
  bench.start(1, prm(kNoWatchdog, "31 11"));
}

TEST(DpSlave, WrongConfigurations) {
  PROVES("DP-CFG-04", "DP-CFG-09", "DP-DIAG-10");
  for (const char* cfg : {"F3", "D2 E1", "", "30", "C0", "F3 F3", "10", "20"}) {
    SlaveBench bench;
    bench.ask(1, 61, prm());
    EXPECT_EQ(bench.ask(1, 62, cfg), "E5") << cfg;
    EXPECT_EQ(bench.diag(), "06 05 00 FF 31 00") << cfg;
    EXPECT_TRUE(bench.notes.last_is(SlaveNote::CfgRefused));
    EXPECT_EQ(bench.exchange(1, "00 00"), "RS");
    bench.start(1, prm(), "F0");
    EXPECT_EQ(bench.diag(), "00 0C 00 01 31 00");
  }
}

TEST(DpSlave, SixConfigurationsExchange) {
  PROVES("DP-CFG-06", "DP-CFG-07", "DP-CFG-15");
  const std::pair<std::string, size_t> kPrinted[] = {{"F0", 2},     {"F1", 4},     {"F2", 6},
                                                     {"F3 F0", 10}, {"F3 F1", 12}, {"F3 F2", 14}};
  for (const auto& [cfg, octets] : kPrinted) {
    SlaveBench bench;
    bench.start(1, prm(kNoWatchdog), cfg);
    for (size_t length = 0; length <= 244; ++length) {
      if (length == octets) continue;
      SlaveBench other;
      other.start(1, prm(kNoWatchdog), cfg);
      EXPECT_EQ(other.ask(1, std::nullopt, Octets(length, 1)), "RS") << cfg << ' ' << length;
      EXPECT_EQ(other.slave.state(), SlaveState::WaitPrm);
      EXPECT_EQ(other.unit.taken, 0);
      EXPECT_EQ(other.diag(), "06 05 00 FF 31 00");
    }
    Octets outputs;
    for (size_t n = 0; n < octets; ++n) outputs.push_back(static_cast<uint8_t>(n));
    EXPECT_EQ(bench.ask(1, std::nullopt, outputs).size(), 2 + 3 * octets);
    EXPECT_EQ(bench.unit.outputs, outputs);
  }
}

TEST(DpSlave, TheMasterAloneChoosesTheConfiguration) {
  PROVES("DP-CFG-11");
  SlaveBench bench;
  bench.start(1, prm(kNoWatchdog), "F0");
  EXPECT_EQ(bench.exchange(1, "00 06"), "08 01 01");
  bench.ask(1, 61, "40 00 00 00 00 00 00");
  bench.start(1, prm(kNoWatchdog), "F3 F2");
  EXPECT_EQ(bench.unit.name, "Param + 3 PD");
  EXPECT_EQ(bench.exchange(1, "00 00 00 00 00 00 00 00 00 06 05 DC 00 00").size(), 2 + 3 * 14U);
  // A master that starts anew without having unlocked.
  bench.start(1, prm(kNoWatchdog), "F1");
  EXPECT_EQ(text_of(bench.unit.outputs), "00 00 00 00");
  const int taken = bench.unit.taken;
  EXPECT_EQ(bench.ask(1, 62, "F1"), "E5");  // the same again changes nothing
  EXPECT_EQ(bench.unit.taken, taken);
  EXPECT_EQ(bench.slave.state(), SlaveState::DataExchange);
  EXPECT_EQ(bench.ask(1, 62, "F3"), "E5");
  EXPECT_EQ(bench.slave.state(), SlaveState::WaitPrm);
}

TEST(DpSlave, LockAndUnlock) {
  SlaveBench bench;
  bench.start(1, prm(kNoWatchdog));
  const Octets before = encode(bench.slave.diagnosis(0));
  // Another master: everything that changes something is refused.
  EXPECT_EQ(bench.ask(2, 61, prm()), "RS");
  EXPECT_EQ(bench.ask(2, 61, "40 00 00 00 00 00 00"), "RS");
  EXPECT_EQ(bench.ask(2, 62, "F0"), "RS");
  EXPECT_EQ(bench.exchange(2, "00 06 00 00 00 00"), "RS");
  EXPECT_TRUE(bench.notes.last_is(SlaveNote::OtherMaster));
  bench.control(2, 0x02);
  EXPECT_EQ(encode(bench.slave.diagnosis(0)), before);
  EXPECT_EQ(bench.unit.taken, 0);
  // What only looks is answered.
  EXPECT_EQ(bench.diag(2), "00 04 00 01 31 00");
  EXPECT_EQ(bench.ask(2, 59), "08 F2");
  EXPECT_EQ(bench.ask(2, 56).substr(0, 2), "08");
  EXPECT_EQ(bench.ask(2, 57), "08 00 00 00 00 00 00");
  // 00: only min Tsdr, whatever the ident; 01 and 11 unlock.
  EXPECT_EQ(bench.ask(1, 61, "00 00 00 1E 12 34 00"), "E5");
  EXPECT_EQ(bench.slave.min_tsdr(), 30);
  EXPECT_EQ(bench.slave.state(), SlaveState::DataExchange);
  EXPECT_EQ(bench.ask(1, 61, "00 00 00 00 12 34 00"), "E5");
  EXPECT_EQ(bench.slave.min_tsdr(), 30);
  for (const char* unlock : {"40 00 00 00 00 00 00", "C0 00 00 00 31 00 00"}) {
    SlaveBench own;
    own.start(1, prm(kNoWatchdog));
    EXPECT_EQ(own.ask(1, 61, unlock), "E5");
    EXPECT_EQ(own.diag(), "02 05 00 FF 31 00");
    EXPECT_EQ(own.unit.ended, 1);
    EXPECT_EQ(own.ask(2, 61, prm()), "E5");  // free for another one
    EXPECT_EQ(own.diag(2), "02 0C 00 02 31 00");
  }
}

TEST(DpSlave, NotThere) {
  PROVES("DP-DIAG-08");
  SlaveBench bench;
  EXPECT_EQ(bench.ask(1, 55, "05 31 00 00"), "RS");
  EXPECT_TRUE(bench.notes.last_is(SlaveNote::NoSetAddress));
  EXPECT_EQ(bench.diag(), "12 05 00 FF 31 00");
  bench.ask(1, 61, prm());
  EXPECT_EQ(bench.diag(), "02 0C 00 01 31 00");
  const std::pair<int, SlaveNote> kPoints[] = {
      {49, SlaveNote::NoAcyclic},    {50, SlaveNote::NoAcyclic},     {51, SlaveNote::NoAcyclic},
      {53, SlaveNote::NoAcyclic},    {20, SlaveNote::NoFms},         {26, SlaveNote::NoFms},
      {0, SlaveNote::NoAccessPoint}, {58, SlaveNote::NoAccessPoint}, {63, SlaveNote::NoAccessPoint}};
  for (const auto& [point, why] : kPoints) {
    EXPECT_EQ(bench.ask(1, static_cast<uint8_t>(point)), "RS") << point;
    EXPECT_TRUE(bench.notes.last_is(why)) << point;
    EXPECT_FALSE(slave_note_text(why).empty());
  }
  EXPECT_EQ(bench.ask(1, 56), "RS");
  EXPECT_EQ(bench.ask(1, 57), "RS");
  // The master's side must be access point 62.
  EXPECT_EQ(bench.answer_of(bench.slave.on_frame(0, {Delimiter::SD2, 8, 1, 0x6D, 60, 61, {}})), "RS");
  // Functions of layer 2.
  const auto fdl = [&](uint8_t fc) { return bench.answer_of(bench.slave.on_frame(0, make_frame(8, 1, fc))); };
  EXPECT_EQ(fdl(0x49), "OK");
  EXPECT_EQ(fdl(0x4E), "RS");
  EXPECT_EQ(fdl(0x4F), "RS");
  EXPECT_EQ(fdl(0x43), "RS");
  EXPECT_EQ(fdl(0x45), "RS");
  EXPECT_EQ(fdl(0x40), "-");
  EXPECT_EQ(fdl(0x4A), "-");
}

TEST(DpSlave, SpeaksOnlyWhenAsked) {
  SlaveBench bench;
  EXPECT_FALSE(bench.slave.on_frame(0, make_acknowledgement()));
  EXPECT_FALSE(bench.slave.on_frame(0, make_token(8, 1)));
  EXPECT_FALSE(
      bench.slave.on_frame(0, make_frame(8, 1, 0x08, 62, 60, hex("02 05 00 FF 31 00"))));  // an answer
  EXPECT_FALSE(bench.slave.on_frame(0, make_frame(9, 1, 0x49)));
  EXPECT_FALSE(bench.slave.on_frame(0, make_frame(127, 1, 0x49)));
  EXPECT_FALSE(bench.slave.on_frame(0, make_frame(127, 1, 0x6D, 60, 62)));
  EXPECT_FALSE(bench.slave.on_frame(0, make_frame(127, 1, 0x44, 58, 62, {0, 0})));
}

TEST(DpSlave, Addresses) {
  PROVES("DP-ID-05");
  for (const int address : {0, 1, 125}) {
    SlaveBench bench({static_cast<uint8_t>(address), 0x3100});
    EXPECT_EQ(bench.diag(), "02 05 00 FF 31 00") << address;
  }
  for (const int address : {126, 127, 200}) {
    SlaveBench bench({static_cast<uint8_t>(address), 0x3100});
    for (const uint8_t fc : {uint8_t{0x49}, uint8_t{0x6D}})
      EXPECT_FALSE(bench.slave.on_frame(0, make_frame(static_cast<uint8_t>(address & 127), 1, fc, 60, 62)));
  }
  SlaveBench bench;
  EXPECT_EQ(bench.ask(1, 55, "05 31 00 00"), "RS");
  EXPECT_EQ(bench.diag(), "12 05 00 FF 31 00");
}

TEST(DpSlave, ARepeatedRequestIsNotExecuted) {
  SlaveBench bench;
  bench.start(1, prm(kNoWatchdog), "F0");
  EXPECT_EQ(bench.exchange(1, "00 06"), "08 01 01");
  FdlFrame again = bench.last_request;
  again.data = hex("00 07");  // whatever it contains
  EXPECT_EQ(bench.answer_of(bench.slave.on_frame(0, again)), "08 01 01");
  EXPECT_EQ(bench.answer_of(bench.slave.on_frame(0, again)), "08 01 01");
  EXPECT_EQ(bench.unit.taken, 1);
  EXPECT_EQ(text_of(bench.unit.outputs), "00 06");
  // FDL status and a broadcast between do not count.
  bench.slave.on_frame(0, make_frame(8, 1, 0x49));
  bench.control(1, 0);
  EXPECT_EQ(bench.answer_of(bench.slave.on_frame(0, again)), "08 01 01");
  EXPECT_EQ(bench.exchange(1, "00 08"), "08 02 02");
  // The acknowledgement is stored, too: a Set_Prm whose E5 was lost.
  EXPECT_EQ(bench.ask(1, 61, "40 00 00 00 00 00 00"), "E5");
  bench.ask(1, 61, prm(kNoWatchdog));
  const FdlFrame repetition = bench.last_request;
  const size_t notes = bench.notes.all.size();
  EXPECT_EQ(bench.answer_of(bench.slave.on_frame(0, repetition)), "E5");
  EXPECT_EQ(bench.notes.all.size(), notes);
  // The same bit of another master is no repetition, and FCV 0 begins anew.
  FdlFrame other = repetition;
  other.source = 2;
  bench.last_request = other;
  EXPECT_EQ(bench.answer_of(bench.slave.on_frame(0, other)), "RS");
  FdlFrame first = make_frame(8, 1, 0x6D, 60, 62);
  const auto once = bench.slave.on_frame(0, first), twice = bench.slave.on_frame(0, first);
  EXPECT_EQ(once, twice);
}

TEST(DpSlave, Watchdog) {
  SlaveBench bench;
  EXPECT_EQ(bench.slave.watchdog_deadline(), runtime::kNever);
  bench.start(1, prm("88 14 01"));  // 20 x 1 x 10 ms
  EXPECT_EQ(bench.unit.watchdog, 200 * kMillisecond);
  EXPECT_EQ(bench.slave.watchdog_deadline(), 200 * kMillisecond);
  bench.now = 150 * kMillisecond;
  bench.exchange(1, "00 06 00 00 00 00");
  EXPECT_EQ(bench.slave.watchdog_deadline(), 350 * kMillisecond);
  bench.now = 200 * kMillisecond;
  bench.diag(2);        // another master does not help
  bench.control(1, 0);  // nor does a broadcast
  EXPECT_EQ(bench.slave.watchdog_deadline(), 350 * kMillisecond);
  bench.slave.expire(349 * kMillisecond);
  EXPECT_EQ(bench.slave.state(), SlaveState::DataExchange);
  bench.slave.expire(350 * kMillisecond);
  EXPECT_EQ(bench.unit.expired, 1);
  EXPECT_EQ(bench.unit.ended, 0);
  EXPECT_EQ(bench.slave.watchdog_deadline(), runtime::kNever);
  EXPECT_EQ(bench.exchange(1, "00 06 00 00 00 00"), "RS");
  EXPECT_EQ(bench.diag(), "02 05 00 FF 31 00");
  bench.start(1, prm(kNoWatchdog));
  EXPECT_EQ(bench.unit.watchdog, std::nullopt);
  EXPECT_EQ(bench.slave.watchdog_deadline(), runtime::kNever);
  bench.start(1, prm("88 FF FF"));
  EXPECT_EQ(bench.unit.watchdog, 650'250 * kMillisecond);
}

// The unit hears of each exchange of its master, also of one whose outputs wait for the next Sync.
TEST(DpSlave, EachExchangeIsTold) {
  SlaveBench bench;
  EXPECT_EQ(bench.exchange(1, "00 06 00 00 00 00"), "RS");
  bench.start(1, prm(kModes));
  bench.now = 5;
  bench.exchange(1, "00 06 00 00 00 00");
  bench.control(1, 0x20);
  bench.now = 6;
  bench.exchange(1, "00 07 00 00 00 00");
  EXPECT_EQ(bench.unit.exchanges, (std::vector<Time>{5, 6}));
  const int taken = bench.unit.taken;
  bench.now = 7;
  bench.exchange(2, "00 08 00 00 00 00");  // another master
  bench.exchange(1, "00 08");              // another length
  EXPECT_EQ(bench.unit.exchanges.size(), 2U);
  EXPECT_EQ(bench.unit.taken, taken);
}

TEST(DpSlave, Sync) {
  PROVES("DP-SYNC-01", "DP-SYNC-03", "DP-DIAG-14", "DP-SYNC-09");
  SlaveBench bench;
  bench.start(1, prm(kModes), "F0");
  bench.exchange(1, "00 01");
  bench.control(1, 0x20);
  EXPECT_EQ(bench.diag(), "00 24 00 01 31 00");
  bench.exchange(1, "00 02");
  bench.exchange(1, "00 03");
  EXPECT_EQ(text_of(bench.unit.outputs), "00 01");
  EXPECT_EQ(bench.ask(1, 57), "08 00 01");  // RD_Outputs: as they act
  bench.control(1, 0x20);
  EXPECT_EQ(text_of(bench.unit.outputs), "00 03");
  bench.exchange(1, "00 04");
  EXPECT_EQ(text_of(bench.unit.outputs), "00 03");
  bench.control(1, 0x30);  // both: Unsync
  EXPECT_EQ(text_of(bench.unit.outputs), "00 04");
  EXPECT_EQ(bench.diag(), "00 04 00 01 31 00");
  bench.exchange(1, "00 05");
  EXPECT_EQ(text_of(bench.unit.outputs), "00 05");
  bench.control(1, 0x28);
  EXPECT_EQ(bench.diag(), "00 34 00 01 31 00");
  bench.control(1, 0x04);
  EXPECT_EQ(bench.diag(), "00 24 00 01 31 00");
  bench.control(1, 0x10);
  EXPECT_EQ(bench.diag(), "00 04 00 01 31 00");
}

TEST(DpSlave, Freeze) {
  PROVES("DP-SYNC-04", "DP-SYNC-06");
  SlaveBench bench;
  bench.start(1, prm(kModes), "F0");
  EXPECT_EQ(bench.exchange(1, "00 01"), "08 01 01");
  bench.control(1, 0x08);
  EXPECT_EQ(bench.exchange(1, "00 01"), "08 02 02");
  EXPECT_EQ(bench.exchange(1, "00 01"), "08 02 02");
  EXPECT_EQ(bench.ask(2, 56), "08 02 02");  // RD_Inputs: the frozen ones
  bench.control(1, 0x08);
  EXPECT_EQ(bench.exchange(1, "00 01"), "08 03 03");
  bench.control(1, 0x0C);  // both: Unfreeze
  EXPECT_EQ(bench.exchange(1, "00 01"), "08 04 04");
  EXPECT_EQ(bench.exchange(1, "00 01"), "08 05 05");
}

// Whoever leaves data exchange leaves Sync and Freeze, too: the next start has neither.
TEST(DpSlave, ModesEndWithTheExchange) {
  SlaveBench bench;
  bench.start(1, prm(kModes), "F0");
  bench.control(1, 0x28);
  EXPECT_EQ(bench.diag(), "00 34 00 01 31 00");
  EXPECT_EQ(bench.ask(1, 61, "40 00 00 00 00 00 00"), "E5");
  EXPECT_EQ(bench.diag(), "02 05 00 FF 31 00");
  bench.start(1, prm(kModes), "F0");
  EXPECT_EQ(bench.diag(), "00 04 00 01 31 00");
  const std::string first = bench.exchange(1, "00 05");
  EXPECT_EQ(text_of(bench.unit.outputs), "00 05");
  EXPECT_NE(bench.exchange(1, "00 06"), first) << "fresh inputs each time";
  EXPECT_EQ(text_of(bench.unit.outputs), "00 06");
}

TEST(DpSlave, ClearAndOperate) {
  SlaveBench bench;
  bench.start(1, prm(kModes), "F0");
  bench.exchange(1, "12 34");
  bench.control(1, 0x00);
  EXPECT_EQ(text_of(bench.unit.outputs), "12 34");
  bench.control(1, 0x02);
  EXPECT_EQ(text_of(bench.unit.outputs), "00 00");
  // Also in Sync mode, and nothing that waited comes back.
  bench.exchange(1, "12 34");
  bench.control(1, 0x20);
  bench.exchange(1, "56 78");
  bench.control(1, 0x02);
  EXPECT_EQ(text_of(bench.unit.outputs), "00 00");
  bench.control(1, 0x10);
  EXPECT_EQ(text_of(bench.unit.outputs), "00 00");
}

TEST(DpSlave, ModesThatSetPrmDidNotAskFor) {
  SlaveBench bench;
  bench.start(1, prm(kNoWatchdog), "F0");
  bench.control(1, 0x20);
  EXPECT_TRUE(bench.notes.last_is(SlaveNote::SyncNotRequested));
  bench.control(1, 0x08);
  EXPECT_TRUE(bench.notes.last_is(SlaveNote::FreezeNotRequested));
  EXPECT_EQ(bench.diag(), "00 04 00 01 31 00");
  bench.exchange(1, "00 09");
  EXPECT_EQ(text_of(bench.unit.outputs), "00 09");
}

TEST(DpSlave, Groups) {
  SlaveBench bench;
  bench.start(1, prm(kModes, "31 00", "05"), "F0");
  bench.exchange(1, "00 01");
  bench.control(1, 0x02, 0x0A);
  EXPECT_EQ(text_of(bench.unit.outputs), "00 01");
  bench.control(1, 0x02, 0x04);
  EXPECT_EQ(text_of(bench.unit.outputs), "00 00");
  // A slave in no group hears only what is for all.
  SlaveBench none;
  none.start(1, prm(kModes), "F0");
  none.exchange(1, "00 01");
  none.control(1, 0x02, 0xFF);
  EXPECT_EQ(text_of(none.unit.outputs), "00 01");
  none.control(1, 0x02, 0x00);
  EXPECT_EQ(text_of(none.unit.outputs), "00 00");
}

TEST(DpSlave, PowerOnForgetsAll) {
  SlaveBench bench;
  bench.start(1, prm("88 14 01"), "F3 F2");
  bench.slave.set_min_tsdr(77);
  bench.slave.set_fault(0, 9);
  bench.slave.power_on(5 * kSecond, {9, 0x3100});
  bench.last_master = 255;
  bench.now = 5 * kSecond;
  EXPECT_EQ(bench.diag(), "02 05 00 FF 31 00");
  EXPECT_EQ(bench.ask(1, 59), "08 F0");
  EXPECT_EQ(bench.slave.min_tsdr(), 11);
}

// Who has lost its power knows no answer any more: a request that repeats the one before it is answered anew.
TEST(DpSlave, PowerOnForgetsTheAnswerBefore) {
  SlaveBench bench;
  bench.start();
  EXPECT_EQ(bench.diag(), "00 0C 00 01 31 00") << "exchanges data with master 1, and its watchdog is on";
  const FdlFrame repeated = bench.last_request;
  ASSERT_TRUE(repeated.frame_count_valid());
  EXPECT_EQ(bench.answer_of(bench.slave.on_frame(bench.now, repeated)).substr(3), "00 0C 00 01 31 00");
  bench.slave.power_on(5 * kSecond, {8, 0x3100});
  bench.now = 5 * kSecond;
  EXPECT_EQ(bench.answer_of(bench.slave.on_frame(bench.now, repeated)).substr(3), "02 05 00 FF 31 00");
}

// A frame that answers is no request, whoever it names: it is not answered, and does not keep the watchdog quiet.
TEST(DpSlave, AnswersOfOthersAreNothing) {
  SlaveBench bench;
  bench.start(1, prm("88 14 01"));
  bench.now = 100 * kMillisecond;
  for (const uint8_t function : std::initializer_list<uint8_t>{0x00, 0x03, 0x08, 0x0A, 0x20, 0x2D})
    EXPECT_FALSE(bench.slave.on_frame(bench.now, make_frame(8, 1, function, 62, 60, hex("00 0C"))));
  EXPECT_EQ(bench.slave.watchdog_deadline(), 200 * kMillisecond);
  EXPECT_EQ(bench.exchange(1, "00 06 05 DC 00 00").substr(0, 2), "08");
  EXPECT_EQ(bench.slave.watchdog_deadline(), 300 * kMillisecond);
}

}  // namespace
}  // namespace ipos::tests
