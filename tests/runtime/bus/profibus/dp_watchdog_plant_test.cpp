// The watchdog of a MOVITRAC 31 in a plant: P571, and what happens when the master falls silent (MOVITRAC 31 PROFIBUS, 3.3). The time
// is 10 ms times two factors of Set_Prm (EN 50170 volume 2).
#include "tests/runtime/bus/profibus/hand_rig.hpp"

namespace ipos::tests {
namespace {

constexpr uint8_t kFieldbusTimeout = 28;

TEST(DpWatchdog, TheTimeOfTheMasterInP571) {
  PROVES("DP-WD-01", "DP-WD-02");
  DpPlant with(dp_line() + mc31_station() + dp_master("watchdog = \"200ms\"\n"));
  with.shown("dp.8.status2");  // from now on it is looked at
  with.run(2 * kSecond);
  EXPECT_EQ(with.shown("inv.P571"), "0.20 s");
  EXPECT_EQ(with.shown("dp.8.status2"), "12") << "WD_On and the bit that is always 1";
  DpPlant without(dp_line() + mc31_station() + dp_master(""));
  without.shown("dp.8.status2");
  without.run(2 * kSecond);
  EXPECT_EQ(without.shown("inv.P571"), "650.00 s");
  EXPECT_EQ(without.shown("dp.8.status2"), "4");
}

TEST(DpWatchdog, TwoFactors) {
  PROVES("DP-WD-03");
  struct Row {
    const char* prm;
    int32_t hundredths;
    bool on;
  };
  HandPlant bench(dp_line() + mc31_station());
  for (const Row& row : {Row{"88 14 01", 20, true}, Row{"88 01 14", 20, true}, Row{"88 01 01", 1, true}, Row{"88 FE FF", 64'770, true},
                         Row{"88 FF FF", 64'999, true}, Row{"80 FF FF", 65'000, false}, Row{"80 14 01", 65'000, false}}) {
    bench.start("F0", prm_data(row.prm));
    EXPECT_EQ(bench.value("571"), row.hundredths) << row.prm;
    EXPECT_EQ(bench.diag(), row.on ? "00 0C 00 01 31 00" : "00 04 00 01 31 00") << row.prm;
    bench.ask(1, 61, prm_data("80 00 00"));
  }
}

// From the last cycle on; a cycle of one slave at 500 kbaud is some milliseconds at most.
TEST(DpWatchdog, WhenTheMasterFallsSilent) {
  PROVES("DP-WD-04");
  for (const Time watchdog : {50, 200, 1000}) {
    DpPlant bench(dp_line() + mc31_station("P572 = 4\n") +
                  dp_master("po = [6, 1500]\nwatchdog = \"" + std::to_string(watchdog) + "ms\"\n",
                            "[[control.command]]\nat = \"3s\"\ncommand = \"stop\"\n"));
    bench.run(3 * kSecond);
    EXPECT_EQ(bench.speed(), 300'000);
    EXPECT_EQ(bench.fault(), 0);
    const auto cycle = static_cast<Time>(bench.master().cycle_bits() * kSecond / 500'000);
    ASSERT_LT(cycle, 5 * kMillisecond);
    while (bench.fault() == 0 && bench.plant->now() < 6 * kSecond) bench.run_on(kMillisecond);
    EXPECT_EQ(bench.fault(), kFieldbusTimeout);
    EXPECT_NEAR(static_cast<double>(bench.plant->now() - 3 * kSecond), static_cast<double>(watchdog * kMillisecond),
                static_cast<double>(cycle + kMillisecond));
    EXPECT_TRUE(bench.told("hears nothing from its master within the watchdog time and leaves data exchange"));
    bench.run_on(2 * kSecond);
    EXPECT_EQ(bench.speed(), 0) << "it has stopped by itself";
  }
}

// A value by hand stays until the next start of the master.
TEST(DpWatchdog, TheMasterOverwritesP571) {
  PROVES("DP-WD-07");
  DpPlant bench(dp_line() + mc31_station("P572 = 0\n") +
                dp_master("watchdog = \"200ms\"\n", "[[control.command]]\nat = \"2s\"\ncommand = \"stop\"\n"
                                                    "[[control.command]]\nat = \"4s\"\ncommand = \"start\"\n") +
                "[[stimulus]]\nstation = \"inv\"\nat = \"3s\"\nparameter = \"P571\"\nset = \"5 s\"\n");
  bench.run(2 * kSecond);
  EXPECT_EQ(bench.shown("inv.P571"), "0.20 s");
  bench.run(3900 * kMillisecond);
  EXPECT_EQ(bench.shown("inv.P571"), "5.00 s");
  bench.run(6 * kSecond);
  EXPECT_TRUE(bench.master().slave(0).exchanging());
  EXPECT_EQ(bench.shown("inv.P571"), "0.20 s");
}

}  // namespace
}  // namespace ipos::tests
