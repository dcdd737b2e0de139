// What the scope tells the page: its first channels and how each is drawn, exact numbers, files with a picture, and the tree of
// signals to pick from.
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/serve/serving.hpp"
#include "tools/recording/plot_html.hpp"
#include "tools/recording/plot_svg.hpp"

namespace ipos::tests {
namespace {

constexpr size_t kHead = 32;  // bytes of a frame

std::string stations(int count) {
  std::string text = "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n";
  for (int n = 1; n <= count; ++n)
    text += fmt::format("[[station]]\nname = \"u{0}\"\nunit = \"mdxb\"\nsbus = \"sbus\"\n[station.parameters]\nP881 = {0}\n", n);
  return text;
}

class ScopeOfPlant : public Serving {
 protected:
  Json scope() { return good({{"do", "scope"}}); }
  Json channel(const std::string& name) {
    good({{"do", "scope"}, {"channels", {name}}});
    return scope()["channels"][0];
  }
  std::string picture(const char* form, Json more = Json::object()) {
    more.update({{"do", "scope.picture"}, {"form", form}, {"title", "t"}});
    good(more);
    std::string text;
    for (const Json& part : page.parts) text += part.value("text", "");
    return text;
  }
  // What `ipos run --plot` records of the same plant.
  static tools::Recording recorded(const std::vector<std::string>& names, int ms) {
    const std::unique_ptr<runtime::Plant> plant = the_plant()();
    tools::Recorder recorder(*plant, names);
    plant->run_until(ms * runtime::kMillisecond, [&](runtime::Time now) {
      recorder.sample(now);
      return true;
    });
    return recorder.recording();
  }
};

class FirstChannels : public ::testing::TestWithParam<int> {};

TEST_P(FirstChannels, AreOfEveryStationThatHasRoom) {
  ServedPage page(plant_of(stations(GetParam())));
  const Json state = page.ask({{"do", "scope"}});
  std::vector<std::string> names;
  for (const Json& channel : state["channels"]) names.push_back(channel["name"]);
  EXPECT_EQ(state["most"], 16);
  ASSERT_LE(names.size(), 16U);
  const auto has = [&](const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  for (int n = 1; n <= std::min(GetParam(), 16); ++n) EXPECT_TRUE(has(fmt::format("u{}.speed", n))) << n;
  for (int n = 1; n <= GetParam() && GetParam() <= 5; ++n)
    for (const char* own : {"setpoint", "status"}) EXPECT_TRUE(has(fmt::format("u{}.{}", n, own))) << n;
}
INSTANTIATE_TEST_SUITE_P(Of, FirstChannels, ::testing::Values(1, 3, 5, 6, 20));

TEST_F(ScopeOfPlant, HasSixteenChannelsAndSaysSoOfOneMore) {
  std::vector<std::string> names;
  for (int n = 0; n < 16; ++n) names.push_back(fmt::format("saw.H{}", 300 + n));
  EXPECT_EQ(good({{"do", "scope"}, {"channels", names}})["channels"].size(), 16U);
  names.push_back("saw.H400");
  EXPECT_NE(error({{"do", "scope"}, {"channels", names}}).find("16"), std::string::npos);
  EXPECT_NE(error({{"do", "scope"}, {"channels", {"saw.H3*"}}}).find("1 to 16 channels"), std::string::npos);
  EXPECT_EQ(scope()["channels"].size(), 16U) << "nothing has changed";
}

TEST_F(ScopeOfPlant, ToldAreBitsAndWordsOfAChannel) {
  EXPECT_EQ(channel("saw.speed")["kind"], "curve");
  EXPECT_EQ(channel("saw.DI00")["kind"], "level");
  EXPECT_EQ(channel("saw.status.0")["kind"], "level");
  const Json status = channel("saw.status");
  EXPECT_EQ(status["kind"], "word");
  // Status word 1 of the manual: bit 0 output stage, bit 1 ready, bit 5 fault; the high byte is the state or the fault.
  const auto has = [](const Json& list, const Json& pair) { return std::find(list.begin(), list.end(), pair) != list.end(); };
  EXPECT_TRUE(has(status["bit_names"], {0, "output stage on"}));
  EXPECT_TRUE(has(status["bit_names"], {1, "ready"}));
  EXPECT_EQ(status["mask"], 0xFF20);
  EXPECT_TRUE(std::any_of(status["texts"].begin(), status["texts"].end(), [](const Json& pair) {
    return pair[0] == (26 << 8 | 0x20) && pair[1].get<std::string>().starts_with("F26 ");
  }));
  const Json fault = channel("saw.fault");
  EXPECT_EQ(fault["kind"], "words");
  EXPECT_EQ(fault["texts"][0], Json({0, "no fault"}));
  EXPECT_EQ(channel("saw.task1.state")["texts"], Json({{0, "stopped"}, {1, "ready"}, {2, "waiting"}}));
  const Json source = channel("saw.P100");
  EXPECT_EQ(source["kind"], "words");
  EXPECT_GE(source["texts"].size(), 2U);
  EXPECT_EQ(channel("saw.lCount")["kind"], "curve");
}

// A number of 32 bits has more digits than a float.
TEST_F(ScopeOfPlant, ExactPointsHaveAllDigits) {
  constexpr int32_t kNumber = 16'777'217;  // 2^24 + 1
  good({{"do", "scope"}, {"channels", {"saw.H300"}}});
  good({{"do", "set"}, {"name", "saw.H300"}, {"value", std::to_string(kNumber)}});
  step(3);
  page.ask({{"do", "scope.view"}, {"from_us", 2'000}, {"to_us", 2'000}, {"points", 1}, {"exact", true}});
  const std::string bytes = page.binary();
  ASSERT_EQ(bytes.size(), kHead + sizeof(double));
  EXPECT_EQ(bytes[3], 1);
  double value = 0;
  std::memcpy(&value, bytes.data() + kHead, sizeof value);
  EXPECT_EQ(value, kNumber);
}

// After the way back the rest of the recording is there for who asks for it, until another future begins: with copies of the
// process, and where the plant runs again from 0 s.
class WayBack : public Serving, public ::testing::WithParamInterface<bool> {
 protected:
  WayBack() : Serving(the_plant(), GetParam()) {}
  std::string points(bool later) {
    page.ask({{"do", "scope.view"}, {"from_us", 0}, {"to_us", 2'000'000}, {"points", 4096}, {"exact", true}, {"later", later}});
    const std::string frame = page.binary();
    return frame.size() < kHead ? "no frame" : frame.substr(kHead);
  }
};

TEST_P(WayBack, LaterTimesAreKnownUntilTheyAreDropped) {
  constexpr size_t kSample = sizeof(double);
  good({{"do", "scope"}, {"channels", {"saw.lCount"}}});
  step(1000);
  EXPECT_TRUE(good({{"do", "scope"}})["later_us"].is_null());
  const std::string whole = points(false);
  EXPECT_EQ(points(true), whole);
  ASSERT_EQ(whole.size(), 1000 * kSample);
  for (const int ms : {300, 700, 65, 1}) {
    good({{"do", "go"}, {"us", ms * 1000}});
    const Json scope = good({{"do", "scope"}});
    EXPECT_EQ(scope["last_us"], ms * 1000);
    EXPECT_EQ(scope["later_us"], 1'000'000);
    EXPECT_EQ(points(false), whole.substr(0, static_cast<size_t>(ms) * kSample));
    EXPECT_TRUE(points(true) == whole) << ms;
  }
  EXPECT_EQ(page.ask({{"do", "scope.csv"}})["csv"].get<std::string>().find("\n2,"), std::string::npos) << "a file ends with now";
  good({{"do", "go"}, {"us", 300'000}});
  good({{"do", "set"}, {"name", "saw.H300"}, {"value", "5"}});
  step(1);
  EXPECT_TRUE(good({{"do", "scope"}})["later_us"].is_null());
  EXPECT_EQ(points(true).size(), 301 * kSample);
}
INSTANTIATE_TEST_SUITE_P(WithAndWithoutCopies, WayBack, ::testing::Bool());

// One millisecond of one bit is seen at any zoom, and hides no other bit.
TEST_F(ScopeOfPlant, ABitOfAWordThatWasOnForAMillisecondIsInItsPoint) {
  good({{"do", "scope"}, {"channels", {"lift.PO1"}}});
  good({{"do", "force"}, {"name", "lift.PO1"}, {"value", "0x0900"}});
  step(500);
  good({{"do", "force"}, {"name", "lift.PO1"}, {"value", "0x0104"}});
  step(1);
  good({{"do", "force"}, {"name", "lift.PO1"}, {"value", "0x0900"}});
  step(500);
  page.ask({{"do", "scope.view"}, {"from_us", 100'000}, {"to_us", 1'000'000}, {"points", 1}, {"exact", true}});
  const std::string bytes = page.binary();
  ASSERT_EQ(bytes.size(), kHead + 2 * sizeof(double));
  double values[2] = {};
  std::memcpy(values, bytes.data() + kHead, sizeof values);
  EXPECT_EQ(values[0], 0x0100) << "on all the time";
  EXPECT_EQ(values[1], 0x0904) << "on at some time";
}

TEST_F(ScopeOfPlant, PicturesAreThoseOfTheCommandLine) {
  const std::vector<std::string> names{"saw.lCount", "lift.P008", "saw.DI00"};
  step(400);
  good({{"do", "scope"}, {"channels", names}});
  EXPECT_EQ(picture("svg"), tools::plot_svg(recorded(names, 400), "t"));
  EXPECT_EQ(picture("html"), tools::plot_html(recorded(names, 400), "t"));
  const std::string part = picture("html", {{"from_us", 100'000}, {"to_us", 199'000}});
  EXPECT_NE(part.find("\"begin\":100.0"), std::string::npos);
  EXPECT_NE(part.find("\"samples\":100"), std::string::npos);
  EXPECT_NE(error({{"do", "scope.picture"}, {"form", "png"}}).find("svg or html"), std::string::npos);
}

TEST_F(ScopeOfPlant, TheTreeHasStationsAndLinesWithTheirGroups) {
  const auto groups = [&](const Json& tree, const std::string& station) {
    for (const Json& branch : tree)
      if (branch["station"] == station) return branch["groups"];
    return Json();
  };
  const Json all = good({{"do", "search"}, {"text", ""}, {"limit", 1}});
  EXPECT_EQ(all["tree"][0]["station"], "saw");
  size_t total = 0;
  for (const Json& branch : all["tree"])
    for (const Json& group : branch["groups"]) total += group["count"].get<size_t>();
  EXPECT_EQ(total, all["total"].get<size_t>());
  EXPECT_TRUE(groups(all["tree"], "sbus").is_array());
  const Json found = good({{"do", "search"}, {"text", "lcount"}});
  EXPECT_EQ(found["tree"], Json::parse(R"([{"station": "saw", "groups": [{"name": "variables", "count": 1}]}])"));
}

}  // namespace
}  // namespace ipos::tests
