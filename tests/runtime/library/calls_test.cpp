// Calls in random order, with memory that fails; and that nothing grows.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <vector>

#include "tests/runtime/library/calls.hpp"
#include "tests/runtime/library/functions.hpp"

namespace ipos::tests {
namespace {

// IPOS_CALL_SEQUENCES and IPOS_STEPS: more of them than in the daily run.
size_t count_of(const char* variable, size_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

TEST(LibraryCalls, InAnyOrderAndWithoutMemoryKeepThePromisesOfTheHeader) {
  const size_t sequences = count_of("IPOS_CALL_SEQUENCES", 200);
  std::mt19937 random(1);
  size_t calls = 0;
  for (size_t n = 0; n < sequences; ++n) {
    std::vector<uint8_t> bytes(40 + random() % 200);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
    if (n % 2 == 0) bytes[0] = 0;  // memory does not fail
    const Outcome outcome = play_calls(bytes);
    ASSERT_EQ(outcome.broken, nullptr) << "sequence " << n;
    calls += outcome.calls;
  }
  EXPECT_GT(calls, 10 * sequences);
}

constexpr const char* kPlant =
    "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[station]]\nname = \"a\"\nunit = \"mdxb\"\nsbus = \"sbus\"\n";

TEST(LibraryCalls, StepsAndReadsTakeNoMemory) {
  ipos_plant_source source = {};
  source.text = kPlant;
  ipos_plant* plant = nullptr;
  ASSERT_EQ(ipos_plant_open(&source, &plant), IPOS_PLANT_OK);
  uint32_t speed = 0;
  ASSERT_EQ(ipos_plant_find(plant, 0, IPOS_PLANT_STATE, "speed", &speed), IPOS_PLANT_OK);
  int64_t now = 0, value = 0;
  const auto steps = [&](size_t count) {
    for (size_t n = 0; n < count; ++n) {
      now += 1'000'000;
      ASSERT_EQ(ipos_plant_run(plant, now), IPOS_PLANT_OK);
      ASSERT_EQ(ipos_plant_read(plant, speed, &value), IPOS_PLANT_OK);
    }
  };
  steps(1000);
  const int64_t before = live_allocations();
  steps(count_of("IPOS_STEPS", 20'000));
  EXPECT_EQ(live_allocations(), before);
  EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
}

TEST(LibraryCalls, APlantWithoutMemoryIsBrokenAndTheOthersGoOn) {
  ipos_plant_source source = {};
  source.text = kPlant;
  ipos_plant *plant = nullptr, *other = nullptr;
  fail_allocations_after(0);
  EXPECT_EQ(ipos_plant_open(&source, &plant), IPOS_PLANT_OUT_OF_MEMORY);
  fail_allocations_after(-1);
  EXPECT_EQ(plant, nullptr);
  ASSERT_EQ(ipos_plant_open(&source, &plant), IPOS_PLANT_OK);
  ASSERT_EQ(ipos_plant_open(&source, &other), IPOS_PLANT_OK);
  uint64_t hash = 0;
  fail_allocations_after(0);
  EXPECT_EQ(ipos_plant_trace_hash(plant, &hash), IPOS_PLANT_OUT_OF_MEMORY);
  fail_allocations_after(-1);
  EXPECT_EQ(ipos_plant_run(plant, 1'000'000), IPOS_PLANT_BROKEN);
  EXPECT_EQ(ipos_plant_run(other, 1'000'000), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_close(other), IPOS_PLANT_OK);
}

}  // namespace
}  // namespace ipos::tests
