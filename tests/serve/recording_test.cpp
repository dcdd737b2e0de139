// What the scope has recorded stays, whatever is chosen afterwards: a channel that comes later is computed by running again
// what was, and looks as if it had been there from the beginning: by a copy of the process, or by turns.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include <fmt/format.h>

#include "tests/serve/serving.hpp"
#include "tools/recording/trace.hpp"

namespace ipos::tests {
namespace {

class Recording : public Serving, public ::testing::WithParamInterface<bool> {
 protected:
  Recording() : Serving(the_plant(), GetParam()) {}
  // What `ipos run --trace` writes of a plant of its own, to which `hands` does the same.
  static std::string traced(const std::vector<std::string>& names, int ms) {
    const std::unique_ptr<runtime::Plant> plant = the_plant()();
    tools::Recorder recorder(*plant, names);
    plant->run_until(ms * runtime::kMillisecond, [&](runtime::Time now) {
      recorder.sample(now);
      return true;
    });
    std::ostringstream out;
    write_csv(out, recorder.recording());
    return out.str();
  }
  std::string csv(Json more = Json::object()) {
    more["do"] = "scope.csv";
    good(more);
    std::string text;
    for (const Json& part : page.parts) text += part["csv"].get<std::string>();
    return text;
  }
  Json scope() { return good({{"do", "scope"}}); }
  std::vector<std::string> channels() {
    std::vector<std::string> names;
    const Json state = scope();
    for (const Json& channel : state["channels"]) names.push_back(channel["name"]);
    return names;
  }
};

TEST_P(Recording, AChannelThatComesLaterIsThereFromTheBeginning) {
  good({{"do", "scope"}, {"channels", {"saw.lCount"}}});
  step(700);
  const std::vector<std::string> names{"saw.lCount", "saw.lTable[1]", "lift.P008"};
  good({{"do", "scope"}, {"channels", names}});
  EXPECT_EQ(csv(), traced(names, 700));
  step(300);
  EXPECT_EQ(csv(), traced(names, 1000)) << "and goes on";
  EXPECT_EQ(scope()["computes"], Json::array());
}

TEST_P(Recording, WhatAHandDidIsDoneAgain) {
  good({{"do", "scope"}, {"channels", {"saw.lCount"}}});
  step(100);
  good({{"do", "set"}, {"name", "saw.H300"}, {"value", "7"}});
  good({{"do", "input"}, {"station", "saw"}, {"name", "DI02"}, {"on", true}});
  step(100);
  good({{"do", "force"}, {"name", "saw.H301"}, {"value", "5"}});
  step(100);
  good({{"do", "scope"}, {"channels", {"saw.H300", "saw.DI02", "saw.H301"}}});
  const std::string text = csv();
  for (const char* row : {"\n100,0,0,0\n", "\n101,7,1,0\n", "\n200,7,1,0\n", "\n201,7,1,5\n", "\n300,7,1,5\n"})
    EXPECT_NE(text.find(row), std::string::npos) << row;
}

TEST_P(Recording, ACompleteSingleStaysWhatItIs) {
  good({{"do", "scope"},
        {"channels", {"saw.lCount"}},
        {"pre", 50},
        {"length_ms", 100},
        {"trigger", {{"kind", "edge"}, {"signal", "saw.lCount"}, {"value", 20}, {"slope", "rising"}}}});
  good({{"do", "scope.arm"}, {"single", true}});
  step(2000);
  const Json before = scope();
  ASSERT_EQ(before["state"], "done");
  good({{"do", "scope"}, {"channels", {"saw.lCount", "saw.lTable[1]"}}});
  const std::string text = csv();
  const Json after = scope();
  for (const char* same : {"state", "trigger_us", "trigger_text", "first_us", "last_us", "single"})
    EXPECT_EQ(after[same], before[same]) << same;
  EXPECT_EQ(text, traced({"saw.lCount", "saw.lTable[1]"}, static_cast<int>(after["last_us"].get<int64_t>() / 1000)));
  // A channel less, and the trigger changed: the same.
  good({{"do", "scope"}, {"channels", {"saw.lTable[1]"}}, {"trigger", {{"kind", "none"}}}});
  EXPECT_EQ(scope()["last_us"], before["last_us"]);
  EXPECT_EQ(scope()["state"], "done");
  // Armed again, all that was between is there, too.
  good({{"do", "scope.free"}});
  step(1);
  EXPECT_EQ(csv(), traced({"saw.lTable[1]"}, 2001));
}

TEST_P(Recording, ViewAndCsvHaveTheSameValues) {
  step(500);
  good({{"do", "scope"}, {"channels", {"saw.lCount", "lift.status"}}});
  csv();  // all is computed
  page.ask({{"do", "scope.view"}, {"from_us", 250'000}, {"to_us", 250'000}, {"points", 1}});
  const std::string bytes = page.binary();
  ASSERT_EQ(bytes.size(), 32U + 2 * 4);
  std::array<float, 2> values{};
  std::memcpy(values.data(), bytes.data() + 32, sizeof values);
  const std::string row = csv({{"from_us", 250'000}, {"to_us", 250'000}});
  EXPECT_NE(row.find(fmt::format("\n250,{},", values[0])), std::string::npos) << row;
  EXPECT_FALSE(std::isnan(values[1]));
}

TEST_P(Recording, GoingBackKeepsChannelsAndComputesThemAgain) {
  step(300);
  good({{"do", "scope"}, {"channels", {"saw.lCount", "saw.H300"}}});
  good({{"do", "set"}, {"name", "saw.H300"}, {"value", "7"}});
  step(100);
  good({{"do", "back"}, {"us", 200'000}});
  EXPECT_EQ(csv(), traced({"saw.lCount", "saw.H300"}, 200));
  step(200);
  EXPECT_EQ(csv(), traced({"saw.lCount", "saw.H300"}, 400)) << "what was written later is undone";
}

TEST_P(Recording, ATriggerOfAnotherSignalHasNoEdgeOfTheOldOne) {
  good({{"do", "scope"}, {"trigger", {{"kind", "edge"}, {"signal", "saw.H300"}, {"value", 5}}}});
  good({{"do", "scope.arm"}});
  step(200);
  good({{"do", "scope"}, {"trigger", {{"kind", "edge"}, {"signal", "saw.lCount"}, {"value", 5}}}});
  step(5);
  EXPECT_EQ(scope()["state"], "armed");
}

// What is still computed when another channel goes, when time goes on and when it goes back.
TEST_P(Recording, IsRightWhateverIsDoneMeanwhile) {
  good({{"do", "scope"}, {"channels", {"saw.lCount"}}});
  step(3000);
  good({{"do", "scope"}, {"channels", {"saw.lCount", "saw.lTable[1]"}}});
  good({{"do", "scope"}, {"channels", {"saw.lTable[1]", "lift.P008"}}});
  step(100);
  good({{"do", "scope"}, {"channels", {"lift.P008", "saw.lCount"}}});
  step(1);
  EXPECT_EQ(csv(), traced({"lift.P008", "saw.lCount"}, 3101));
  good({{"do", "scope"}, {"channels", {"lift.P008", "saw.lTable[1]"}}});
  good({{"do", "back"}, {"us", 1'500'000}});
  EXPECT_EQ(csv({{"to_us", 1'500'000}}), traced({"lift.P008", "saw.lTable[1]"}, 1500));
}

INSTANTIATE_TEST_SUITE_P(Of, Recording, ::testing::Bool(),
                         [](const auto& copied) { return copied.param ? "Copies" : "Turns"; });

}  // namespace
}  // namespace ipos::tests
