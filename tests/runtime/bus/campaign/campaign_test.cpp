// The campaigns in the size of the suite; ipos_bus_campaign runs them at any size.
#include <gtest/gtest.h>

#include <iostream>

#include "tests/runtime/bus/campaign/arbitration_campaign.hpp"
#include "tests/runtime/bus/campaign/fault_campaign.hpp"

namespace ipos::tests {
namespace {

TEST(Campaign, ArbitrationAgreesWithTheBitModel) {
  const ArbitrationTotals totals = run_arbitration(100'000, 4);
  std::cout << summary(totals) << '\n';
  EXPECT_EQ(totals.trouble, "");
  EXPECT_EQ(totals.frames, 100'000U);
  EXPECT_GT(totals.contested, 10'000U);
}

TEST(Campaign, FaultsOfTheLineLeaveNoTrace) {
  const FaultTotals totals = run_faults(1, 200);
  std::cout << summary(totals) << '\n';
  for (const std::string& failure : totals.failures) ADD_FAILURE() << failure;
  EXPECT_EQ(totals.seeds, 200U);
  for (const uint64_t struck : totals.struck) EXPECT_GT(struck, 0U);  // each kind has had its effect
  EXPECT_GT(totals.parameter_changes, 1000U);
  EXPECT_GT(totals.calls_failed, 0U);
  EXPECT_LE(totals.longest_recovery, kRecovery);
}

}  // namespace
}  // namespace ipos::tests
