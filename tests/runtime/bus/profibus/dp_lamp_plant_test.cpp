// The lamps of the interface of a MOVITRAC 31 in a plant, as signals, over DP, FMS and both (MOVITRAC 31 PROFIBUS, 2.8).
#include "runtime/station/dp_slaves.hpp"
#include "tests/runtime/bus/profibus/dp_plant_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;
using runtime::kSecond;

const std::string kPanel = "[[control]]\nname = \"panel\"\nkind = \"fms\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\n";
const std::string kOpens = "[[control.slave.request]]\nat = \"2s\"\ninitiate = true\n[[control.slave.request]]\nat = \"3s\"\nabort = true\n";

// RUN, BUS FAULT and their rates: "1 0.0 Hz, 0 0.0 Hz" is green on, red off.
std::string lamps(DpPlant& bench) {
  return bench.shown("inv.RUN") + " " + bench.shown("inv.RUN_rate") + ", " + bench.shown("inv.BUS_FAULT") + " " +
         bench.shown("inv.BUS_FAULT_rate");
}
const std::string kGreen = "1 0.0 Hz, 0 0.0 Hz", kBoth = "1 0.0 Hz, 1 0.0 Hz";

TEST(DpLamps, DataExchange) {
  PROVES("DP-LED-03", "DP-LED-04", "DP-LED-08");
  DpPlant bench(dp_line() + mc31_station() +
                dp_master("watchdog = \"200ms\"\n", "[[control.command]]\nat = \"0ms\"\ncommand = \"stop\"\n"
                                                    "[[control.command]]\nat = \"3s\"\ncommand = \"start\"\n"
                                                    "[[control.command]]\nat = \"6s\"\ncommand = \"stop\"\n"));
  bench.run(2900 * kMillisecond);
  EXPECT_EQ(lamps(bench), kBoth) << "before data exchange";
  bench.run(5900 * kMillisecond);
  EXPECT_TRUE(bench.master().slave(0).exchanging());
  EXPECT_EQ(lamps(bench), kGreen) << "in data exchange";
  bench.run(6150 * kMillisecond);
  EXPECT_EQ(lamps(bench), kGreen) << "within the watchdog time";
  bench.run(6300 * kMillisecond);
  EXPECT_EQ(lamps(bench), kBoth) << "the timeout has elapsed";
}

// FMS alone, wherever the switch stands: an active connection, or none.
TEST(DpLamps, FmsAlone) {
  PROVES("DP-LED-03", "DP-LED-04");
  for (const char* position : {"fms_switch = false\n", "fms_switch = true\n"}) {
    DpPlant bench(dp_line() + mc31_station("", position) + kPanel + kOpens);
    bench.run(1900 * kMillisecond);
    EXPECT_EQ(lamps(bench), kBoth) << position << "no active connection";
    bench.run(2500 * kMillisecond);
    EXPECT_EQ(lamps(bench), kGreen) << position << "an active connection";
    bench.run(3500 * kMillisecond);
    EXPECT_EQ(lamps(bench), kBoth) << position << "it is closed";
  }
}

// Both at once with the switch at FMS: red while either is missing. At DP the data exchange alone counts.
TEST(DpLamps, BothAtOnce) {
  const std::string dp = dp_master("watchdog = \"200ms\"\n", "[[control.command]]\nat = \"2500ms\"\ncommand = \"stop\"\n");
  DpPlant mixed(dp_line() + mc31_station("", "fms_switch = true\n") + dp + kPanel + kOpens);
  mixed.run(1900 * kMillisecond);
  EXPECT_EQ(lamps(mixed), kBoth) << "no connection of FMS";
  mixed.run(2400 * kMillisecond);
  EXPECT_EQ(lamps(mixed), kGreen);
  mixed.run(2900 * kMillisecond);
  EXPECT_EQ(lamps(mixed), kBoth) << "no data exchange";
  DpPlant of_dp(dp_line() + mc31_station() + dp + kPanel + kOpens);
  of_dp.run(1900 * kMillisecond);
  EXPECT_EQ(lamps(of_dp), kGreen);
  of_dp.run(2900 * kMillisecond);
  EXPECT_EQ(lamps(of_dp), kBoth) << "although FMS is connected";
}

// An address that is none: the switches count from the next power-on, and only from there.
TEST(DpLamps, WrongAddress) {
  PROVES("DP-LED-02");
  DpPlant bench(dp_line() + mc31_station("", "", "inv", 126));
  const auto is_wrong = [&] {
    return bench.shown("inv.RUN") == "1" && bench.shown("inv.RUN_rate") == "0.0 Hz" && bench.shown("inv.BUS_FAULT_rate") == "0.5 Hz";
  };
  bench.run(3 * kSecond);
  EXPECT_TRUE(is_wrong());
  // 0.5 Hz by the clock: how often it is lit anew in ten seconds.
  int flashes = 0;
  std::string before = bench.shown("inv.BUS_FAULT");
  for (int n = 0; n < 1000; ++n) {
    bench.run_on(10 * kMillisecond);
    const std::string now = bench.shown("inv.BUS_FAULT");
    flashes += before == "0" && now == "1";
    before = now;
  }
  EXPECT_EQ(flashes, 5);
  EXPECT_EQ(bench.station().set_switch(runtime::StationSwitch::ProfibusAddress, 5), std::nullopt);
  bench.run_on(kSecond);
  EXPECT_TRUE(is_wrong()) << "without a restart";
  bench.plant->set_power("inv", false);
  bench.run_on(kSecond);
  bench.plant->set_power("inv", true);
  bench.run_on(3 * kSecond);
  EXPECT_EQ(lamps(bench), kBoth) << "a right address, and no master";
}

}  // namespace
}  // namespace ipos::tests
