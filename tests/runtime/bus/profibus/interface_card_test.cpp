// The whole interface on a line with a master: process data, parameters over DP and FMS, address and LEDs.
#include "runtime/bus/profibus/interface_card.hpp"

#include "tests/runtime/bus/profibus/line_rig.hpp"
#include "tests/runtime/bus/profibus/mc31_rig.hpp"

namespace ipos::tests {
namespace {

struct CardRig {
  explicit CardRig(CardSwitches switches = {8}, OptionKind kind = OptionKind::Ffp31)
      : card(rig.queue, 50, rig.line, "inv", option_type(kind), switches, drive, mc31_table(), drive),
        master(rig.add_master({})) {
    master.add_slave(plan_of(8, "F3 F2", 14, "88 14 01 0B 31 00 00"));
    master.start();
    rig.run(2 * kSecond);
  }
  LedPattern leds() { return card.leds(rig.queue.now()); }
  void outputs(const std::string& octets) {
    master.slave(0).set_outputs(hex(octets));
    rig.run(50 * kMillisecond);
  }
  LineRig rig;
  Mc31 drive;
  InterfaceCard card;
  Master& master;
};

TEST(InterfaceCard, MasterToDrive) {
  CardRig bench;
  bench.drive.status = {0x0407, 0x05DC, 0};
  bench.outputs("72 00 04 01 00 00 09 50 00 06 05 DC 00 00");
  EXPECT_EQ(bench.drive.output, (std::vector<uint16_t>{6, 1500, 0}));
  EXPECT_EQ(bench.drive.values[25], 950);
  EXPECT_EQ(text_of(bench.master.slave(0).inputs()), "72 00 04 01 00 00 09 50 04 07 05 DC 00 00");
  EXPECT_EQ(bench.drive.values[index_of("571")], 20);
  bench.master.stop();
  bench.rig.run(kSecond);
  EXPECT_TRUE(bench.drive.expired_at.has_value());
}

TEST(InterfaceCard, AddressInP073) {
  PROVES("DP-ID-07");
  CardRig bench;
  EXPECT_EQ(bench.drive.values[index_of("073")], 8);
  bench.card.station().switches().set({9});
  EXPECT_EQ(bench.drive.values[index_of("073")], 8);
  bench.card.power_on(bench.rig.queue.now(), true);
  EXPECT_EQ(bench.drive.values[index_of("073")], 8);
  bench.card.power_on(bench.rig.queue.now(), false);
  EXPECT_EQ(bench.drive.values[index_of("073")], 9);
  EXPECT_EQ(bench.card.station().slave().address(), 9);
}

TEST(InterfaceCard, FlickersWhileParametersAreAccessed) {
  PROVES("DP-LED-05");
  CardRig bench;
  EXPECT_EQ(bench.leds(), (LedPattern{Light::On, Light::Off}));
  // A block over FMS: as long as the service is under way.
  const Time now = bench.rig.queue.now();
  fms::Server& fms = bench.card.fms();
  EXPECT_EQ(fms.initiate(now, 7, 2, master_entry(*fms::find_connection(7), 8)).end, fms::End::Positive);
  const std::vector<BlockEntry> entries(10, BlockEntry{1025, 0x950});
  EXPECT_FALSE(fms.request(now, 7, {fms::Service::Write, 996, encode_block(entries)}).has_value());
  EXPECT_EQ(bench.leds(), (LedPattern{Light::Flicker, Light::Off}));
  bench.rig.run(200 * kMillisecond);
  EXPECT_EQ(fms.response(bench.rig.queue.now(), 7)->end, fms::End::Positive);
  EXPECT_EQ(bench.leds(), (LedPattern{Light::On, Light::Off}));
  // Over the channel of DP.
  bench.outputs("71 00 04 01 00 00 00 00 00 06 05 DC 00 00");
  EXPECT_EQ(bench.leds(), (LedPattern{Light::Flicker, Light::Off}));
  bench.rig.run(kSecond);
  EXPECT_EQ(bench.leds(), (LedPattern{Light::On, Light::Off}));
}

}  // namespace
}  // namespace ipos::tests
