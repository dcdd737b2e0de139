// That the looks of the campaign notice a promise that is broken.
#include "tests/campaign/promises.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;

constexpr const char* kBus = "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = {}\n";

TEST(Promises, ThePairExchangesWholeTelegramsAtEveryBaudRate) {
  for (const char* baud : {"125000", "500000", "1000000"}) {
    const Pair pair = make_pair_at(baud);
    const auto plant = make_plant(fmt::format(kBus, baud) + pair.stations, pair.programs);
    ASSERT_TRUE(plant);
    plant->run_until(200 * kMillisecond);
    EXPECT_GT(value(*plant, "H350", "receiver"), 20) << baud;
    EXPECT_EQ(torn_telegram(*plant), std::nullopt) << baud;
  }
}

// A hand sends what the pair never does: 20 with 7. In MOTOROLA format the second variable comes first.
TEST(Promises, ATornTelegramIsNoticed) {
  const Pair pair = make_pair_at("500000");
  const auto plant = make_plant(fmt::format(kBus, 500'000) + pair.stations, pair.programs);
  ASSERT_TRUE(plant);
  plant->buses()[0]->attach_hand();
  plant->run_until(3 * kMillisecond);
  plant->stations()[0]->power_off();
  plant->run_until(20 * kMillisecond);
  ASSERT_EQ(plant->buses()[0]->send(fmt::format("{:03X}#0000000700000014", kPairObject)), std::nullopt);
  plant->run_until(25 * kMillisecond);
  EXPECT_EQ(torn_telegram(*plant), "20 came with 7");
}

TEST(Promises, ATaskIsInTheSameExchangeUntilItEnds) {
  const auto plant =
      make_plant(fmt::format(kBus, 500'000) +
                     "[[station]]\nname = \"u\"\nunit = \"md60a\"\nprogram = \"P.IPC\"\nsbus = \"can\"\n"
                     "[station.parameters]\nP813 = 1\nP816 = 2\n",
                 {{"P.IPC",
                   "#include <constb.h>\nMOVLNK Ml; MLDATA Mld;\n"
                   "main() { Ml.BusType = 5; Ml.Address = 9; Ml.Format = 1; Ml.Service = ML_S_RD;\n"
                   "Ml.Index = 8318; Ml.DPointer = numof(Mld); while (1) _MoviLink(Ml); }\n"}});
  ASSERT_TRUE(plant);
  plant->run_until(20 * kMillisecond);
  const Exchanges first(*plant);
  plant->run_until(30 * kMillisecond);  // nobody answers; a master waits longer
  EXPECT_EQ(Exchanges(*plant).same_as(first), "task 1 of u");
  plant->run_until(2'000 * kMillisecond);
  EXPECT_EQ(Exchanges(*plant).same_as(first), std::nullopt);
}

}  // namespace
}  // namespace ipos::tests
