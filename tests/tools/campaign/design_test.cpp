// Which cases a campaign has: the grid in its order, draws without a repetition, strata that are all met, pairs that all meet.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numeric>
#include <set>

#include "tools/campaign/design.hpp"
#include "tools/campaign/outline.hpp"

namespace {

using namespace ipos::tools::campaign;

std::vector<std::vector<uint32_t>> all(const Design& design) {
  std::vector<std::vector<uint32_t>> rows(design.size());
  for (uint64_t n = 0; n < design.size(); ++n) design.levels(n, rows[n]);
  return rows;
}

TEST(CampaignDesign, GridHasAllCasesAndTheLastFactorChangesFirst) {
  const auto rows = all(Design({Sample::Grid, 0, 1}, {2, 3}));
  const std::vector<std::vector<uint32_t>> wanted{{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}};
  EXPECT_EQ(rows, wanted);
}

TEST(CampaignDesign, NoFactorIsOneCase) { EXPECT_EQ(Design({Sample::Grid, 0, 1}, {}).size(), 1U); }

TEST(CampaignDesign, AGridThatIsTooLargeToCountIsToldSo) {
  EXPECT_EQ(Design({Sample::Grid, 0, 1}, std::vector<uint32_t>(20, 1000)).size(), UINT64_MAX);
}

RC_GTEST_PROP(CampaignDesign, ShuffledIsAPermutation, (uint64_t seed)) {
  const auto size = *rc::gen::inRange<uint64_t>(1, 3000);
  std::set<uint64_t> seen;
  for (uint64_t n = 0; n < size; ++n) seen.insert(shuffled(n, size, seed));
  RC_ASSERT(seen.size() == size);
  RC_ASSERT(*seen.rbegin() == size - 1);
}

RC_GTEST_PROP(CampaignDesign, RandomCasesComeOnceAndAreOfTheGrid, (uint64_t seed)) {
  const auto counts = *rc::gen::container<std::vector<uint32_t>>(3, rc::gen::inRange<uint32_t>(1, 20));
  const auto count = *rc::gen::inRange<uint64_t>(1, 500);
  const auto rows = all(Design({Sample::Random, count, seed}, counts));
  const uint64_t grid = uint64_t{counts[0]} * counts[1] * counts[2];
  RC_ASSERT(rows.size() == std::min(count, grid));
  RC_ASSERT(std::set<std::vector<uint32_t>>(rows.begin(), rows.end()).size() == rows.size());
  for (const auto& row : rows)
    for (size_t n = 0; n < counts.size(); ++n) RC_ASSERT(row[n] < counts[n]);
}

TEST(CampaignDesign, RandomCasesAreSpreadOverTheGrid) {
  const auto rows = all(Design({Sample::Random, 4000, 7}, {10, 1000, 7}));
  std::vector<int> counts(10);
  for (const auto& row : rows) ++counts[row[0]];
  for (const int count : counts) EXPECT_NEAR(count, 400, 80);  // four times the deviation of a fair draw
}

RC_GTEST_PROP(CampaignDesign, LatinMeetsEachStratumOnce, (uint64_t seed)) {
  const auto count = *rc::gen::inRange<uint32_t>(1, 300);
  for (const auto& [levels, most] : {std::pair{count, 1U}, std::pair{1U, count}}) {
    const auto rows = all(Design({Sample::Latin, count, seed}, {levels, 5}));
    std::vector<uint32_t> met(levels);
    for (const auto& row : rows) ++met[row[0]];
    for (const uint32_t times : met) RC_ASSERT(times == most);
  }
}

RC_GTEST_PROP(CampaignDesign, PairsAllMeet, (uint64_t seed)) {
  const auto counts = *rc::gen::container<std::vector<uint32_t>>(*rc::gen::inRange<size_t>(1, 8), rc::gen::inRange<uint32_t>(1, 7));
  const auto rows = pairwise(counts, seed);
  std::set<std::array<size_t, 4>> met;
  std::set<std::pair<size_t, uint32_t>> levels;
  for (const auto& row : rows) {
    RC_ASSERT(row.size() == counts.size());
    for (size_t a = 0; a < row.size(); ++a) {
      RC_ASSERT(row[a] < counts[a]);
      levels.insert({a, row[a]});
      for (size_t b = a + 1; b < row.size(); ++b) met.insert({a, row[a], b, row[b]});
    }
  }
  RC_ASSERT(met.size() == pair_count(counts));
  RC_ASSERT(levels.size() == std::accumulate(counts.begin(), counts.end(), 0U));
}

// 13 factors of 3 values: the best known array has 15 rows, greedy methods some 20; the grid 1 594 323.
TEST(CampaignDesign, PairsAreFew) { EXPECT_LE(pairwise(std::vector<uint32_t>(13, 3), 1).size(), 27U); }

Outline outline_with(std::vector<size_t> counts) {
  Outline outline;
  for (const size_t count : counts) {
    FactorOutline& factor = outline.factors.emplace_back();
    factor.name = "f" + std::to_string(outline.factors.size());
    for (size_t n = 0; n < count; ++n) factor.levels.push_back({std::to_string(n), std::to_string(n), n * 77});
  }
  return outline;
}

TEST(CampaignPlan, EveryCaseHasItsOwnName) {
  const Plan plan(outline_with({100, 100, 100}));
  std::vector<uint64_t> names;
  for (uint64_t rank = 0; rank < plan.size(); ++rank) names.push_back(plan.case_at(rank));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()) - names.begin(), 1'000'000);
}

TEST(CampaignPlan, ANameIsOfEverythingThatDecides) {
  Outline outline = outline_with({2, 2});
  const uint64_t name = outline.case_of({0, 1});
  EXPECT_NE(name, outline.case_of({1, 0}));
  outline.identity = 1;
  EXPECT_NE(name, outline.case_of({0, 1}));
}

TEST(CampaignPlan, CasesOfAHypercubeThatComeTwiceAreLeftOut) {
  Outline outline = outline_with({2, 2});
  outline.sampling = {Sample::Latin, 100, 1};
  const Plan plan(outline);
  EXPECT_EQ(plan.size(), 4U);
  EXPECT_EQ(plan.left_out(), 96U);
}

TEST(CampaignPlan, IsReadAgainAsItWasWritten) {
  Outline outline = outline_with({3});
  outline.campaign = "a \"b\".toml";
  outline.version = "1";
  outline.identity = 0xFEDCBA9876543210;
  outline.inputs["x.toml"] = 5;
  outline.sampling = {Sample::Random, 2, 9};
  outline.measures.push_back({"m", "rpm", -1.5, std::nullopt});
  const auto again = read_outline(outline_json(outline));
  ASSERT_TRUE(again);
  EXPECT_EQ(outline_json(*again), outline_json(outline));
  EXPECT_EQ(again->case_of({2}), outline.case_of({2}));
  EXPECT_FALSE(read_outline("{}"));
}

}  // namespace
