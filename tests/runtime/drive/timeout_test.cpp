// Monitoring of the process data: P812 (RS-485), P815 (SBus), P819 (fieldbus), display t and the way back
// (1053 1610 p. 27, 41, 64; MOVITRAC 07 chapters 4.1, 7.1, 8.1).
#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

// A telegram comes at any moment of a millisecond, so the time ends at most one millisecond late, never
// early.
void expect_fault_after(DriveRig& rig, int ms, uint8_t number) {
  rig.run_ms(ms);
  EXPECT_EQ(rig.drive.fault(), 0) << "before " << ms << " ms";
  rig.run_ms(1);
  EXPECT_EQ(rig.drive.fault(), number) << "after " << ms << " ms";
}

struct SbusRig : DriveRig {
  explicit SbusRig(std::string_view name, int32_t p815) : DriveRig(name) {
    bus_control();
    set("P815", p815);
  }
  void telegram(uint16_t control = 0x0006) {
    const uint16_t words[] = {control, 5000, 0};
    drive.take_po(PoSource::Sbus, words);
  }
};

struct Rs485Rig : DriveRig {
  explicit Rs485Rig(std::string_view name = "md60a", int32_t p812 = 500) : DriveRig(name) {
    enable_terminals();
    set("P100", 2);
    set("P101", 1);
    set("P812", p812);
  }
  void telegram(bool cyclic = true) {
    const uint16_t words[] = {0x0006, 5000, 0};
    drive.take_po(PoSource::Rs485, words, cyclic);
  }
};

TEST(Rs485Timeout, CyclicRequestsKeepItQuiet) {
  PROVES("TIME-01");
  Rs485Rig rig;
  for (int n = 0; n < 20; ++n) {
    rig.telegram();
    rig.run_ms(400);
    ASSERT_EQ(rig.drive.fault(), 0) << n;
  }
  rig.telegram();
  expect_fault_after(rig, 500, 43);
}

// The part of TIME-02 that is the drive's; frames with a wrong check character never reach it.
TEST(Rs485Timeout, AcyclicRequestsAreNotMonitored) {
  Rs485Rig rig;
  for (int n = 0; n < 20; ++n) {
    rig.telegram(false);
    rig.run_ms(100);
  }
  EXPECT_EQ(rig.rpm() > 0, true) << "they carry process data all the same";
  rig.run_ms(5000);
  EXPECT_EQ(rig.drive.fault(), 0);
  rig.telegram();
  for (int n = 0; n < 4; ++n) {
    rig.run_ms(100);
    rig.telegram(false);
  }
  expect_fault_after(rig, 100, 43);
  // A cyclic request without process data restarts the time.
  Rs485Rig parameters;
  parameters.telegram();
  for (int n = 0; n < 20; ++n) {
    parameters.run_ms(400);
    parameters.drive.take_request(PoSource::Rs485);
  }
  expect_fault_after(parameters, 500, 43);
}

TEST(Rs485Timeout, EightResponses) {
  PROVES("TIME-03");
  const DriveRig fresh("md60a");
  EXPECT_EQ(fresh.value("P833"), 7);
  for (int32_t response = 0; response <= 7; ++response) {
    Rs485Rig rig;
    rig.set("P833", response);
    rig.set("P136", 600);
    rig.set("P137", 1200);
    rig.po({0x0006, 5000, 0}, PoSource::Rs485);
    rig.settle();
    rig.silence();
    rig.telegram();
    rig.run_ms(500);
    EXPECT_EQ(rig.drive.fault(), 0) << response;
    EXPECT_EQ(rig.rpm(), 1000) << response;
    rig.run_ms(1);
    const bool stays = response <= 1;
    const bool off = response == 2 || response == 5;
    const bool error = response >= 2 && response <= 4;
    EXPECT_EQ(rig.stage(), !off) << response;
    EXPECT_EQ(rig.drive.fault(), response == 0 ? 0 : 43) << response;
    EXPECT_EQ(rig.drive.error(), error) << response;
    if (response == 3 || response == 6) {
      EXPECT_NEAR(rig.ms_until_standing(), mdx_ramp_ms(1000, 1200), 2) << response;
    }
    if (response == 4 || response == 7) {
      EXPECT_NEAR(rig.ms_until_standing(), mdx_ramp_ms(1000, 600), 2) << response;
    }
    rig.run_ms(1000);
    EXPECT_EQ(rig.rpm(), stays ? 1000 : 0) << response;
    rig.telegram();
    rig.run_ms(400);
    EXPECT_EQ(rig.rpm() != 0, !error) << response << ": after communication is back";
  }
}

TEST(Rs485Timeout, WaitsForTheFirstTelegram) {
  PROVES("TIME-04");
  for (const int32_t p812 : {500, 0}) {
    Rs485Rig rig("md60a", p812);
    rig.run_ms(2000);
    EXPECT_EQ(rig.drive.display(), 't') << p812;
    EXPECT_EQ(rig.rpm(), 0);
    EXPECT_FALSE(rig.stage());
    EXPECT_EQ(rig.drive.verdict().reason, Block::Waiting);
    EXPECT_NE(runtime::block_text(Block::Waiting, unit("md60a")).find("waiting for process data"), std::string::npos);
    EXPECT_EQ(rig.drive.fault(), 0) << "no time runs before the first request";
    rig.input("DI03", false);
    rig.run_ms(1);
    EXPECT_EQ(rig.drive.display(), '2') << "only an enabled drive shows t";
    rig.input("DI03", true);
    rig.telegram();
    rig.run_ms(100);
    EXPECT_NE(rig.drive.display(), 't');
    EXPECT_GT(rig.rpm(), 0);
    // After the reset of an error it waits again.
    rig.drive.raise_fault(1);
    rig.run_ms(1);
    EXPECT_EQ(rig.drive.display(), 'F');
    rig.drive.reset_fault();
    rig.run_ms(100);
    EXPECT_EQ(rig.drive.display(), 't');
    EXPECT_EQ(rig.rpm(), 0);
    rig.telegram();
    rig.run_ms(200);
    EXPECT_GT(rig.rpm(), 0);
  }
}

TEST(Rs485Timeout, WarningEndsWithTheNextRequest) {
  PROVES("TIME-05");
  Rs485Rig rig;
  rig.telegram();
  rig.run_ms(3000);
  EXPECT_EQ(rig.drive.fault(), 43);
  EXPECT_EQ(rig.status() & 0x22, 0x22) << "a warning";
  EXPECT_EQ(rig.rpm(), 0);
  rig.drive.take_request(PoSource::Rs485);  // without process data: the last ones act again
  rig.run_ms(200);
  EXPECT_EQ(rig.drive.fault(), 0);
  EXPECT_GT(rig.rpm(), 0);
}

TEST(Rs485Timeout, ZeroIsOff) {
  PROVES("TIME-09");
  const DriveRig fresh("md60a");
  EXPECT_EQ(fresh.value("P812"), 0);
  Rs485Rig rig("md60a", 0);
  rig.telegram();
  rig.run_ms(600'000);
  EXPECT_EQ(rig.drive.fault(), 0);
  EXPECT_EQ(rig.rpm(), 1000);
}

TEST(SbusTimeout, P815AndItsResponse) {
  PROVES("TIME-10");
  SbusRig rig("md60a", 200);
  for (int n = 0; n < 20; ++n) {
    rig.telegram();
    rig.run_ms(100);
    ASSERT_EQ(rig.drive.fault(), 0);
  }
  rig.telegram();
  expect_fault_after(rig, 200, 47);
  // Fresh and enabled, P100 = SBus: factory settings.
  runtime::ParameterStore parameters(unit("md60a"));
  Drive drive(parameters, light_machine());
  ASSERT_TRUE(parameters.preset(8461, 10));
  ASSERT_TRUE(parameters.preset(8477, 600));  // P137
  EXPECT_EQ(parameters.value(8602), 100);
  EXPECT_EQ(parameters.value(8615), 3);
  drive.set_inputs(1 | 1 << 1 | 1 << 3);
  const uint16_t words[] = {0, 5000, 0};
  for (int n = 0; n < 30; ++n) {
    drive.take_po(PoSource::Sbus, words);
    for (int ms = 0; ms < 50; ++ms) drive.tick();
  }
  drive.take_po(PoSource::Sbus, words);
  for (int ms = 0; ms < 100; ++ms) drive.tick();
  ASSERT_EQ(drive.axis().speed, 1'000'000);
  EXPECT_EQ(drive.fault(), 0);
  int ms = 0;
  for (; ms < 1000 && drive.axis().speed != 0; ++ms) drive.tick();
  EXPECT_EQ(drive.fault(), 47);
  EXPECT_TRUE(drive.error());
  EXPECT_NEAR(ms, mdx_ramp_ms(1000, 600), 2) << "emergency stop ramp";
}

TEST(SbusTimeout, OffAtZeroAndAt650Seconds) {
  PROVES("TIME-12");
  for (const int32_t off : {0, 650'000}) {
    SbusRig rig("md60a", off);
    rig.telegram();
    rig.run_ms(20 * 60'000);
    EXPECT_EQ(rig.drive.fault(), 0) << off;
    EXPECT_EQ(rig.rpm(), 1000);
  }
  SbusRig rig("md60a", 649'990);
  rig.telegram();
  expect_fault_after(rig, 649'990, 47);
  SbusRig m07("mc07", 650'000);
  m07.telegram();
  expect_fault_after(m07, 650'000, 47);
}

TEST(SbusTimeout, F47IsShownEverywhere) {
  PROVES("TIME-13");
  SbusRig rig("md60a", 100);
  rig.telegram();
  rig.run_ms(102);
  EXPECT_EQ(rig.status() >> 8, 47);
  EXPECT_EQ(rig.value("P080"), 47);
  EXPECT_EQ(rig.drive.display(), 'F');
  EXPECT_EQ(rig.drive.fault(), 47);
}

TEST(SbusTimeout, GoesOnWithTheLastSetpoints) {
  PROVES("TIME-14");
  for (const int32_t response : {0, 1}) {
    SbusRig rig("md60a", 100);
    rig.set("P836", response);
    rig.po({0x0006, 5000, 0});
    rig.settle();
    rig.silence();
    rig.run_ms(5000);
    EXPECT_EQ(rig.rpm(), 1000) << response;
    EXPECT_EQ(rig.drive.fault(), response == 0 ? 0 : 47);
  }
}

TEST(SbusTimeout, CausesOfF47) {
  PROVES("DIAG-07", "DIAG-08");
  SbusRig none("md60a", 100);
  none.run_ms(10'000);
  EXPECT_EQ(none.drive.display(), 't') << "never any process data";
  SbusRig some("md60a", 100);
  some.po({0x0006, 5000, 0});
  some.run_ms(10'000);
  EXPECT_EQ(some.drive.fault(), 0);
  for (const auto& [p815, p836, fault, error] : {std::tuple{100, 3, 47, true},
                                                 {200, 3, 0, false},
                                                 {100, 5, 47, false},
                                                 {100, 6, 47, false},
                                                 {100, 7, 47, false}}) {
    SbusRig late("md60a", p815);
    late.set("P836", p836);
    for (int n = 0; n < 5; ++n) {
      late.telegram();
      late.run_ms(150);
    }
    EXPECT_EQ(late.drive.fault(), fault) << p815 << p836;
    EXPECT_EQ(late.drive.error(), error) << p815 << p836;
  }
}

// Setpoint source, control source or both are the SBus. Process data cure it; P815 = 0 cures the display, and the enable
// where it does not come from the bus: 0000h is the word of a bus that has sent none (MOVITRAC 07 chapter 6.3).
TEST(SbusTimeout, DisplayTWithoutProcessData) {
  PROVES("DIAG-12");
  for (const auto& [p100, p101] : {std::pair{10, 3}, {10, 0}, {1, 3}})
    for (const bool by_telegram : {false, true}) {
      DriveRig rig("md60a");
      rig.enable_terminals();
      rig.set("P100", p100);
      rig.set("P101", p101);
      rig.set("P301", 60'000);
      rig.set("P815", 100);
      rig.run_ms(1000);
      EXPECT_EQ(rig.drive.display(), 't');
      EXPECT_FALSE(rig.stage());
      EXPECT_EQ(rig.drive.verdict().reason, Block::Waiting);
      const std::string hint = runtime::block_text(Block::Waiting, unit("md60a"));
      EXPECT_NE(hint.find("send process data"), std::string::npos);
      EXPECT_NE(hint.find("P815 = 0"), std::string::npos);
      if (by_telegram)
        rig.po({0x0006, 0, 0});
      else
        rig.set("P815", 0);
      rig.run_ms(1000);
      const bool enabled = by_telegram || p101 == 0;
      EXPECT_NE(rig.drive.display(), 't') << p100 << p101;
      EXPECT_EQ(rig.drive.display() == '4', enabled) << p100 << p101;
      EXPECT_EQ(rig.rpm(), enabled ? 60 : 0) << "the minimum speed";
      EXPECT_EQ(rig.drive.verdict().reason == Block::NoControlWord, !enabled) << p100 << p101;
      EXPECT_EQ(rig.drive.setpoint().note == SetpointNote::NoBusData, p100 == 10 && !by_telegram);
    }
  // MOVITRAC 07 has no t; there a control word that never came is no enable.
  SbusRig m07("mc07", 0);
  m07.run_ms(1000);
  EXPECT_EQ(m07.drive.verdict().reason, Block::NoControlWord);
  EXPECT_FALSE(m07.stage());
}

TEST(M07Timeout, P815) {
  PROVES("M07-MON-01");
  SbusRig rig("mc07", 500);
  rig.telegram();
  expect_fault_after(rig, 500, 47);
  SbusRig off("mc07", 0);
  off.telegram();
  off.run_ms(20 * 60'000);
  EXPECT_EQ(off.drive.fault(), 0);
  EXPECT_EQ(off.write("P815", 5), 0x1D);
  EXPECT_EQ(off.write("P815", 10), 0);
  EXPECT_EQ(off.write("P815", 650'000), 0);
  EXPECT_EQ(off.write("P815", 650'010), 0x15);
}

TEST(M07Timeout, RapidStopWithFaultWhateverIsSet) {
  PROVES("M07-MON-03", "M07-MON-04");
  SbusRig rig("mc07", 100);
  for (const char* number : {"P831", "P833", "P836"}) EXPECT_EQ(rig.parameters.table().find(number), nullptr);
  rig.set("P136", 600);
  rig.po({0x0006, 5000, 0});
  rig.settle();
  rig.silence();
  rig.ms_until([&] { return rig.drive.fault() != 0; });
  EXPECT_NEAR(1 + rig.ms_until_standing(), m07_ramp_ms(1000, 600), 2);
  rig.run_ms(2);
  EXPECT_FALSE(rig.stage());
  EXPECT_EQ(rig.drive.pi()[0], 0x2F24);
  EXPECT_EQ(rig.drive.pi()[0] & 0x22, 0x20);
}

TEST(M07Timeout, PresupposesAnEnabledUnit) {
  PROVES("M07-MON-05");
  SbusRig never("mc07", 300);
  expect_fault_after(never, 300, 47);
  SbusRig disabled("mc07", 300);
  disabled.input("DI03", false);
  disabled.run_ms(10'000);
  EXPECT_EQ(disabled.drive.fault(), 0);
  SbusRig elsewhere("mc07", 300);
  elsewhere.set("P100", 1);
  elsewhere.set("P101", 0);
  elsewhere.run_ms(10'000);
  EXPECT_EQ(elsewhere.drive.fault(), 0) << "SBus is no source";
  SbusRig closed("mc07", 300);
  closed.set("P876", 0);
  closed.run_ms(10'000);
  EXPECT_EQ(closed.drive.fault(), 0) << "nothing is taken over";
}

TEST(M07Timeout, NeedsAReset) {
  PROVES("M07-MON-06");
  for (const bool by_terminal : {false, true}) {
    SbusRig rig("mc07", 100);
    rig.set("P604", 12);  // DI05 FAULT RESET
    rig.telegram();
    rig.run_ms(1000);
    rig.po({0x0006, 5000, 0});
    rig.run_ms(1000);
    EXPECT_EQ(rig.drive.fault(), 47) << "traffic is back";
    EXPECT_EQ(rig.rpm(), 0);
    if (by_terminal)
      rig.input("DI05", true);
    else
      rig.po({0x0046, 5000, 0});
    rig.run_ms(1);
    EXPECT_EQ(rig.drive.fault(), 0);
    rig.po({0x0006, 5000, 0});
    rig.run_ms(500);
    EXPECT_GT(rig.rpm(), 0);
  }
}

TEST(M07Timeout, InterfacesAreWatchedSeparately) {
  PROVES("M07-MON-07");
  SbusRig rig("mc07", 100);
  rig.set("P812", 300);
  rig.po({0x0006, 5000, 0});
  const uint16_t words[] = {0x0006, 0, 0};
  rig.drive.take_po(PoSource::Rs485, words);
  rig.run_ms(299);
  EXPECT_EQ(rig.drive.fault(), 0) << "RS-485 silence does not trip P815";
  rig.run_ms(10);
  EXPECT_EQ(rig.drive.fault(), 43);
  Rs485Rig other("mc07", 100);
  other.set("P815", 50);
  const uint16_t sbus[] = {0, 0, 0};
  other.drive.take_po(PoSource::Sbus, sbus);
  other.po({0x0006, 5000, 0}, PoSource::Rs485);
  other.run_ms(5000);
  EXPECT_EQ(other.drive.fault(), 0) << "SBus silence does not trip P812";
}

// SBus and fieldbus are watched as the source of the setpoint, of the control word or of both, and while the terminals
// enable; RS-485 always (docs/inside/drive.md).
TEST(Timeouts, WhatIsUsedIsWatched) {
  struct Link {
    PoSource source;
    int32_t p100, p101;
    uint8_t fault;
  };
  constexpr Link kLinks[] = {
      {PoSource::Rs485, 2, 1, 43}, {PoSource::Fieldbus, 3, 2, 28}, {PoSource::Sbus, 10, 3, 47}};
  for (const Link& link : kLinks)
    for (const int32_t p100 : {1, 2, 3, 10})
      for (const int32_t p101 : {0, 1, 2, 3})
        for (const bool enabled : {false, true})
          for (const int32_t p876 : {0, 1}) {
            DriveRig rig("md60a");
            for (const char* number : {"P812", "P815", "P819"}) rig.set(number, 100);
            rig.set("P100", p100);
            rig.set("P101", p101);
            rig.set("P876", p876);
            if (enabled) rig.enable_terminals();
            const uint16_t words[] = {6, 5000, 0};
            rig.drive.take_po(link.source, words);
            rig.run_ms(100);
            EXPECT_EQ(rig.drive.fault(), 0);
            rig.run_ms(10);
            const bool used = p876 == 1 && enabled && (p100 == link.p100 || p101 == link.p101);
            EXPECT_EQ(rig.drive.fault(), used || link.fault == 43 ? link.fault : 0)
                << "F" << int{link.fault} << ": P100 " << p100 << ", P101 " << p101 << ", enabled " << enabled
                << ", P876 " << p876;
          }
}

// Silence of a bus while the terminals do not enable is no fault. The drive then waits for the next telegram as at the
// beginning (1053 1610 p. 27): it is neither a fault at the moment of the enable nor an enable by words of before.
TEST(Timeouts, SilenceBeforeTheEnableBringsBackTheWaiting) {
  struct Link {
    PoSource source;
    int32_t p100, p101;
  };
  constexpr Link kLinks[] = {{PoSource::Fieldbus, 3, 2}, {PoSource::Sbus, 10, 3}};
  for (const Link& link : kLinks) {
    SCOPED_TRACE(link.p100);
    DriveRig rig("md60a");
    for (const char* number : {"P815", "P819"}) rig.set(number, 100);
    rig.set("P100", link.p100);
    rig.set("P101", link.p101);
    const uint16_t words[] = {6, 5000, 0};
    rig.drive.take_po(link.source, words);
    rig.run_ms(1'000);
    EXPECT_EQ(rig.drive.fault(), 0);
    rig.enable_terminals();
    rig.run_ms(1'000);
    EXPECT_EQ(rig.drive.fault(), 0);
    EXPECT_EQ(rig.drive.display(), 't');
    EXPECT_EQ(rig.rpm(), 0);
    rig.drive.take_po(link.source, words);
    rig.run_ms(90);
    EXPECT_EQ(rig.drive.fault(), 0);
    EXPECT_GT(rig.rpm(), 0);
  }
}

TEST(FieldbusTimeout, P819) {
  DriveRig rig("md60a");
  rig.enable_terminals();
  rig.set("P100", 3);
  rig.set("P101", 2);
  rig.run_ms(10'000);
  EXPECT_EQ(rig.drive.display(), 't');
  const uint16_t words[] = {0x0006, 5000, 0};
  rig.drive.take_po(PoSource::Fieldbus, words);
  expect_fault_after(rig, 500, 28);
  EXPECT_TRUE(rig.drive.error()) << "P831: rapid stop, error";
}

// Master/slave over RS-485: P812 has no function, the link reports its loss after 500 ms itself
// (tests/runtime/bus/rs485), and the drive stops on the emergency ramp (MDX60B/61B p. 30).
TEST(Rs485Timeout, GroupOfAMaster) {
  DriveRig rig("md60a");
  rig.enable_terminals();
  rig.set("P100", 9);
  rig.set("P812", 300);
  rig.set("P137", 900);
  rig.set("P833", 0);
  rig.po({0x0006, 5000, 0}, PoSource::Rs485);
  rig.settle();
  rig.silence();
  rig.drive.take_po(PoSource::Rs485, Words{0x0006, 5000, 0});
  rig.run_ms(1000);
  EXPECT_EQ(rig.drive.fault(), 0);
  rig.drive.raise_fault(43, FaultResponse::EmergencyError);
  EXPECT_NEAR(rig.ms_until_standing(), mdx_ramp_ms(1000, 900), 2);
  EXPECT_TRUE(rig.drive.error());
}

}  // namespace
}  // namespace ipos::tests
