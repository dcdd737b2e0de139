// The page of a campaign: what it sums up, and that it stands alone.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/campaign/case_coverage.hpp"
#include "tools/campaign/reports.hpp"
#include "tools/campaign/shrink.hpp"
#include "tools/campaign/summary.hpp"

namespace {

using namespace ipos::tools;
using namespace ipos::tools::campaign;

// 2 x 3 cases; the measure is 10 a + b, and a = 1 with b > 0 fails.
Results results() {
  Results all;
  all.outline.campaign = "</script><b>.toml";
  for (const auto& [name, count] : {std::pair{"a", 2}, std::pair{"b", 3}}) {
    FactorOutline& factor = all.outline.factors.emplace_back();
    factor.name = name;
    for (int n = 0; n < count; ++n) factor.levels.push_back({std::to_string(n), std::to_string(n), static_cast<uint64_t>(n)});
  }
  all.outline.measures.push_back({"m", "rpm", std::nullopt, 10});
  for (uint32_t a = 0; a < 2; ++a)
    for (uint32_t b = 0; b < 3; ++b) {
      all.levels.push_back({a, b});
      Row& row = all.rows.emplace_back();
      row.id = 10 * a + b;
      row.measures = {10.0 * a + b};
      if (a == 1 && b > 0) row.failed = {"m: too much " + std::to_string(b)};
      all.there.push_back(true);
    }
  return all;
}

nlohmann::json data_of(const std::string& page) {
  const std::string head = "<script id=\"data\" type=\"application/json\">";
  const size_t begin = page.find(head) + head.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST(CampaignSummary, CountsFailuresOverFactorsAndOverPairs) {
  const Summary summary(results());
  EXPECT_EQ(summary.factors[0][0].failed, 0U);
  EXPECT_EQ(summary.factors[0][1].failed, 2U);
  EXPECT_EQ(summary.factors[0][1].cases, 3U);
  EXPECT_EQ(summary.factors[1][2].failed, 1U);
  ASSERT_EQ(summary.maps.size(), 1U);
  EXPECT_EQ(summary.maps[0].failed, (std::vector<uint64_t>{0, 0, 0, 1, 0, 1}));
  EXPECT_EQ(summary.maps[0].cases, std::vector<uint64_t>(6, 1));
}

TEST(CampaignSummary, SpreadsMeasuresOverFactors) {
  const Summary summary(results());
  const Spread& spread = summary.factors[0][1].measures[0];
  EXPECT_EQ(spread.least, 10);
  EXPECT_EQ(spread.most, 12);
  EXPECT_EQ(spread.sum, 33);
  EXPECT_EQ(summary.measures[0].good.front(), 1U);  // 0 alone
  EXPECT_EQ(summary.measures[0].failed.back(), 1U);
}

TEST(CampaignSummary, ManyLevelsStandTogether) {
  Results all = results();
  FactorOutline& factor = all.outline.factors[1];
  for (int n = 3; n < 1000; ++n) factor.levels.push_back({std::to_string(n), std::to_string(n), static_cast<uint64_t>(n)});
  const Summary summary(all);
  EXPECT_EQ(summary.factors[1].size(), Summary::kBins);
  EXPECT_EQ(summary.factors[1].front().text, "0 to 24");
  EXPECT_EQ(summary.bin_of(1, 999), Summary::kBins - 1);
}

TEST(CampaignPage, HasItsDataAndNothingElseIsAskedFor) {
  const std::string page = html_report(results(), nullptr);
  const nlohmann::json data = data_of(page);
  EXPECT_EQ(data["campaign"], "</script><b>.toml");
  EXPECT_EQ(data["failed"], 2);
  EXPECT_EQ(data["shown"].size(), 6U);
  EXPECT_EQ(data["shown"][0][3][0], "m: too much 1");  // failures first
  EXPECT_EQ(data["groups"][0]["cases"], 2);
  EXPECT_FALSE(data.contains("coverage"));
  for (const char* request : {"src=", "href=\"http", "@import", "url(", "fetch("}) EXPECT_EQ(page.find(request), std::string::npos) << request;
}

TEST(CampaignPage, SaysWhatNoCaseReached) {
  coverage::Coverage coverage;
  coverage::SourceFile& file = coverage.files["A.IPC"];
  file.lines = {{3, 5}, {4, 0}};
  file.conditions[{{3, 7}, 0}].ways = {coverage::Condition::Way{{4, 1}, 0}, coverage::Condition::Way{{5, 1}, 5}};
  file.functions["main"] = {3, 1};
  const auto again = read_coverage_json(coverage_json(coverage));
  ASSERT_TRUE(again);
  EXPECT_EQ(coverage_json(*again), coverage_json(coverage));
  const nlohmann::json data = data_of(html_report(results(), &coverage));
  EXPECT_EQ(data["coverage"][0]["unreached"], nlohmann::json({4}));
  EXPECT_EQ(data["coverage"][0]["ways"][0], nlohmann::json({3, 7, 4}));
  EXPECT_EQ(data["coverage"][0]["lines"], nlohmann::json({1, 2}));
}

TEST(CampaignTables, QuoteWhatTheyMust) {
  Results all = results();
  all.outline.factors[0].name = "a, \"b\"";
  EXPECT_TRUE(csv_report(all).starts_with("\"a, \"\"b\"\"\",b,m\n0,0,0\n0,1,1\n"));
  EXPECT_NE(junit_report(all).find("classname=\"&lt;/script&gt;&lt;b&gt;.toml\""), std::string::npos);
}

TEST(CampaignGroups, AreOfTheFirstCheckAndNameTheFirstCase) {
  Groups groups;
  groups.add(7, {"m: 3 is more than 2", "n: x"});
  groups.add(3, {"m: 4 is more than 2"});
  groups.add(5, {});
  groups.add(9, {"died: signal 11 (x)"});
  ASSERT_EQ(groups.all().size(), 2U);
  EXPECT_EQ(groups.all().find("m")->second.cases, 2U);
  EXPECT_EQ(groups.all().find("m")->second.text, "m: 4 is more than 2");
  EXPECT_EQ(check_of("time"), "time");
}

// Fails where the first two of three factors are both far from the middle.
TEST(CampaignGroups, ShrinkTakesBackWhatDoesNotMatter) {
  Outline outline;
  for (int n = 0; n < 3; ++n) {
    outline.factors.emplace_back();
    for (int level = 0; level < 5; ++level) outline.factors.back().levels.push_back({});
  }
  const auto fails = [](const Levels& levels) { return levels[0] > 2 && levels[1] != 2; };
  EXPECT_EQ(shrunk(outline, {4, 0, 1}, fails), (Levels{4, 0, 2}));
}

}  // namespace
