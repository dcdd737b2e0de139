// Fifty plants in fifty threads do what one plant alone does; one plant belongs to one thread.
#include <gtest/gtest.h>

#include <array>
#include <thread>
#include <vector>

#include "tests/runtime/library/functions.hpp"

namespace {

ipos_plant* open_plant() {
  ipos_plant_source source = {};
  source.text =
      "[[station]]\nname = \"a\"\nunit = \"mdxb\"\n[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
  ipos_plant* plant = nullptr;
  EXPECT_EQ(ipos_plant_open(&source, &plant), IPOS_PLANT_OK);
  return plant;
}

uint64_t run_one() {
  ipos_plant* plant = open_plant();
  uint32_t analog = 0;
  EXPECT_EQ(ipos_plant_find(plant, 0, IPOS_PLANT_ANALOG, "AI1", &analog), IPOS_PLANT_OK);
  for (int64_t now = 1; now <= 100; ++now) {
    if (now == 20) {
      EXPECT_EQ(ipos_plant_write_text(plant, analog, "5 V"), IPOS_PLANT_OK);
    }
    EXPECT_EQ(ipos_plant_run(plant, now * 1'000'000), IPOS_PLANT_OK);
  }
  uint64_t hash = 0;
  EXPECT_EQ(ipos_plant_trace_hash(plant, &hash), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
  return hash;
}

TEST(LibraryThreads, FiftyPlantsInFiftyThreads) {
  constexpr size_t kThreads = 50;
  std::array<uint64_t, kThreads> hashes{};
  std::vector<std::thread> threads;
  for (uint64_t& hash : hashes) threads.emplace_back([&hash] { hash = run_one(); });
  for (std::thread& thread : threads) thread.join();
  const uint64_t alone = run_one();
  for (const uint64_t hash : hashes) EXPECT_EQ(hash, alone);
}

TEST(LibraryThreads, ASecondThreadIsRefusedUntilItAdoptsThePlant) {
  ipos_plant* plant = open_plant();
  int64_t now = 0;
  std::thread([&] {
    EXPECT_EQ(ipos_plant_run(plant, 1'000'000), IPOS_PLANT_OTHER_THREAD);
    EXPECT_EQ(ipos_plant_time(plant, &now), IPOS_PLANT_OTHER_THREAD);
    EXPECT_STREQ(ipos_plant_message(plant), "");
    EXPECT_EQ(ipos_plant_adopt(plant), IPOS_PLANT_OK);
    EXPECT_EQ(ipos_plant_run(plant, 1'000'000), IPOS_PLANT_OK);
  }).join();
  EXPECT_EQ(ipos_plant_run(plant, 2'000'000), IPOS_PLANT_OTHER_THREAD);
  EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
}

}  // namespace
