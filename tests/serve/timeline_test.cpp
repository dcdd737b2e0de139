// Time goes to any moment that was reached, back and on, and nothing is lost by looking; who goes on from an earlier moment
// or changes something there drops what came later. Without copies, by running again in turns.
#include <gtest/gtest.h>

#include "runtime/plant/trace_hash.hpp"
#include "tests/serve/page.hpp"
#include "tests/serve/plants.hpp"

namespace ipos::tests {
namespace {

using std::chrono::microseconds;
using tools::serve::WallClock;

// Each look at it takes a tenth of a millisecond: a turn ends after some milliseconds of the plant.
class SlowClock final : public tools::serve::Clock {
 public:
  WallClock::time_point now() const override { return now_ += microseconds(100); }

 private:
  mutable WallClock::time_point now_{std::chrono::hours(1)};
};

class Timeline : public ::testing::Test {
 protected:
  Json good(Json message) {
    Json reply = page.ask(std::move(message));
    EXPECT_TRUE(reply.value("ok", false)) << reply;
    return reply;
  }
  void step(int ms) { good({{"do", "step"}, {"ms", ms}}); }
  void go(int ms) {
    EXPECT_EQ(good({{"do", "go"}, {"us", ms * 1000}})["us"], ms * 1000);
    EXPECT_EQ(page.host.us(), ms * 1000);
  }
  void click(const char* station, const char* input) {
    good({{"do", "input"}, {"station", station}, {"name", input}, {"on", true}});
  }
  std::string error(Json message) { return page.ask(std::move(message)).value("error", "no error"); }
  // Says it without waiting for an answer.
  void say(int id, Json message) {
    message["id"] = id;
    page.host.take({MessageKind::Text, 1, message.dump()});
  }
  Json reply(int id) const {
    for (const auto& sent : page.post.sent) {
      if (sent.kind != MessageKind::Reply) continue;
      Json body = Json::parse(sent.body);
      if (body["re"] == id) return body;
    }
    return nullptr;
  }
  uint64_t digest() const { return runtime::state_digest(page.host.plant()); }
  int64_t value(const std::string& name) {
    good({{"do", "watch"}, {"names", {name}}});
    good({{"do", "subscribe"}, {"topic", "watch"}});
    return page.event("watch")["values"][name]["value"].get<int64_t>();
  }
  Json timeline() {
    good({{"do", "subscribe"}, {"topic", "timeline"}});
    return page.event("timeline");
  }
  // "0.100 DI02" of each mark of a kind.
  std::vector<std::string> marks(const std::string& kind) {
    std::vector<std::string> texts;
    const Json state = timeline();
    for (const Json& mark : state["marks"])
      if (mark["kind"] == kind)
        texts.push_back(std::to_string(mark["us"].get<int64_t>() / 1000) + " " + mark["what"].get<std::string>());
    return texts;
  }
  std::string csv() {
    good({{"do", "scope.csv"}});
    std::string text;
    for (const Json& part : page.parts) text += part["csv"].get<std::string>();
    return text;
  }

  SlowClock clock;
  tools::serve::Copies copies;
  tools::serve::Files files;  // none
  Page page{the_plant(), clock, copies, files};
};

using Texts = std::vector<std::string>;

TEST_F(Timeline, EveryMomentIsTheSameHoweverOneComesThere) {
  std::map<int, uint64_t> digests;
  for (int ms = 0; ms < 400; ms += 50) {
    if (ms == 100) click("saw", "DI02");
    if (ms == 150) good({{"do", "set"}, {"name", "saw.H300"}, {"value", "7"}});
    if (ms == 200) good({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", 523}, {"data", "0102"}});
    if (ms == 250) good({{"do", "force"}, {"name", "saw.H301"}, {"value", "5"}});
    digests[ms] = digest();
    step(50);
  }
  const std::string recorded = csv();
  for (const int ms : {350, 100, 250, 0, 300, 50, 200, 150, 350, 0, 350}) {
    go(ms);
    EXPECT_EQ(digest(), digests[ms]) << ms;
    EXPECT_EQ(page.event("time")["furthest_us"], 400'000);
  }
  go(400);
  EXPECT_EQ(value("saw.H300"), 7);
  EXPECT_EQ(value("saw.DI02"), 1);
  EXPECT_EQ(csv(), recorded) << "the scope keeps what it has recorded";
}

// The same by the steps back of the tab Program and by `back`.
TEST_F(Timeline, GoingOnRepeatsTheClicksHoweverOneWentBack) {
  step(100);
  click("saw", "DI02");
  step(200);
  const uint64_t there = digest();
  good({{"do", "back"}, {"ms", 250}});
  EXPECT_EQ(value("saw.DI02"), 0);
  go(300);
  EXPECT_EQ(digest(), there);
  good({{"do", "program.step"}, {"station", "saw"}, {"kind", "over"}, {"back", true}});
  EXPECT_LE(page.host.us(), 300'000);
  go(300);
  EXPECT_EQ(digest(), there);
}

TEST_F(Timeline, RunningOnDropsWhatCameLaterAndSaysSo) {
  step(100);
  click("saw", "DI02");
  step(50);
  click("lift", "DI04");
  good({{"do", "force"}, {"name", "saw.H301"}, {"value", "5"}});
  step(50);
  EXPECT_EQ(marks("click"), (Texts{"100 DI02", "150 DI04", "150 H301"}));
  EXPECT_TRUE(timeline()["dropped"].is_null());
  go(120);
  EXPECT_EQ(marks("click"), (Texts{"100 DI02", "150 DI04", "150 H301"})) << "only looked at";
  step(10);
  EXPECT_EQ(marks("click"), Texts{"100 DI02"});
  EXPECT_EQ(timeline()["dropped"], (Json{{"us", 120'000}, {"clicks", 2}}));
  EXPECT_EQ(page.host.furthest_us(), 130'000);
  EXPECT_EQ(error({{"do", "go"}, {"us", 131'000}}), "that time is still to come");
  step(100);
  EXPECT_EQ(value("lift.DI04"), 0);
  EXPECT_EQ(value("saw.DI02"), 1);
}

TEST_F(Timeline, SoDoesRunningOnThoughNobodyHasClicked) {
  step(100);
  go(50);
  step(1);
  EXPECT_EQ(page.host.furthest_us(), 51'000);
  EXPECT_TRUE(timeline()["dropped"].is_null()) << "nothing is lost that does not come again by itself";
}

TEST_F(Timeline, AClickInThePastDropsWhatCameLater) {
  step(100);
  click("saw", "DI02");
  step(100);
  go(50);
  EXPECT_NE(error({{"do", "input"}, {"station", "saw"}, {"name", "DI99"}, {"on", true}}), "no error");
  EXPECT_EQ(page.host.furthest_us(), 200'000) << "what was refused changes nothing";
  click("saw", "DI03");
  EXPECT_EQ(page.host.furthest_us(), 50'000);
  EXPECT_EQ(marks("click"), Texts{"50 DI03"});
  EXPECT_EQ(timeline()["dropped"]["clicks"], 1);
  step(150);
  EXPECT_EQ(value("saw.DI02"), 0);
  EXPECT_EQ(value("saw.DI03"), 1);
}

TEST_F(Timeline, ANewerOrderReplacesOneThatIsUnderWay) {
  step(2000);
  page.post.sent.clear();
  say(101, {{"do", "go"}, {"us", 1'900'000}});
  page.host.turn();
  EXPECT_TRUE(page.host.busy()) << "a long way is gone in turns";
  EXPECT_GT(page.host.us(), 0);
  EXPECT_LT(page.host.us(), 1'000'000);
  say(102, {{"do", "go"}, {"us", 1'000'000}});
  EXPECT_EQ(reply(101)["replaced"], true);
  say(105, {{"do", "input"}, {"station", "saw"}, {"name", "DI02"}, {"on", true}});
  EXPECT_EQ(reply(105)["error"], "the plant is on its way to another moment");
  page.settle();
  EXPECT_EQ(page.host.us(), 1'000'000);
  say(103, {{"do", "go"}, {"us", 0}});
  say(104, {{"do", "go"}, {"us", 1'500'000}});
  page.settle();
  EXPECT_EQ(reply(103)["replaced"], true);
  EXPECT_EQ(reply(104)["us"], 1'500'000);
}

TEST_F(Timeline, APauseEndsALongWay) {
  step(2000);
  page.post.sent.clear();
  say(101, {{"do", "go"}, {"us", 1'900'000}});
  page.host.turn();
  say(102, {{"do", "pause"}});
  page.settle();
  EXPECT_LT(reply(101)["us"].get<int64_t>(), 1'000'000);
  go(2000);
}

TEST_F(Timeline, OnTheWayNothingIsShownButTheTime) {
  good({{"do", "subscribe"}, {"topic", "plant"}, {"rate", 60}});
  step(2000);
  page.post.sent.clear();
  say(101, {{"do", "go"}, {"us", 1'900'000}});
  while (page.host.busy()) page.host.turn();
  int plant = 0, time = 0;
  for (const auto& sent : page.post.sent)
    if (sent.kind == MessageKind::Event) {
      const Json event = Json::parse(sent.body);
      if (event["event"] == "time") ++time;
      if (event["event"] == "plant") {
        ++plant;
        EXPECT_EQ(event["us"], 1'900'000);
      }
    }
  EXPECT_GT(time, 1);
  EXPECT_LE(plant, 1);
}

TEST_F(Timeline, AClickAtTheBeginningIsDoneOnce) {
  good({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", 523}, {"data", "0102"}});
  const auto sent = [this] {
    int count = 0;
    const Json frames = good({{"do", "bus.trace"}})["frames"];
    for (const Json& frame : frames)
      if (frame["id"] == 523) ++count;
    return count;
  };
  step(20);
  const int first = sent();
  go(0);
  EXPECT_EQ(sent(), 0);
  go(20);
  EXPECT_EQ(sent(), first);
}

// A telegram goes to a unit that does not want it: the journal says why, at a moment that has a mark.
TEST_F(Timeline, HasMarksOfTheJournalOfTriggersAndOfBreakpoints) {
  good({{"do", "scope"}, {"trigger", {{"kind", "edge"}, {"signal", "saw.lCount"}, {"value", 5}}}});
  good({{"do", "scope.arm"}});
  step(100);
  const Json state = timeline();
  const auto triggers = marks("trigger");
  ASSERT_EQ(triggers.size(), 1U);
  EXPECT_FALSE(marks("journal").empty());
  const int number = good({{"do", "break.set"}, {"station", "saw"}, {"file", "SAW.IPC"}, {"line", 9}})["breakpoint"]["number"];
  step(100);
  const auto stops = marks("breakpoint");
  ASSERT_EQ(stops.size(), 1U);
  EXPECT_TRUE(stops[0].ends_with(" SAW.IPC:9")) << stops[0];
  good({{"do", "break.clear"}, {"number", number}});
  // Again on the way: there they are already.
  go(0);
  go(static_cast<int>(page.host.furthest_us() / 1000));
  EXPECT_EQ(marks("trigger"), triggers);
  EXPECT_EQ(marks("breakpoint"), stops);
  good({{"do", "restart"}});
  EXPECT_TRUE(timeline()["marks"].empty());
}

TEST_F(Timeline, ATriggerThatStopsThePlantDoesNotStopTheWay) {
  good({{"do", "scope"},
        {"trigger", {{"kind", "line"}, {"station", "saw"}, {"file", "SAW.IPC"}, {"line", 9}, {"stop", true}}}});
  good({{"do", "scope.arm"}});
  step(100);
  const int stood = static_cast<int>(page.host.us() / 1000);
  EXPECT_LT(stood, 100);
  step(100);
  const int end = static_cast<int>(page.host.us() / 1000);
  EXPECT_GT(end, stood);
  const Json before = good({{"do", "scope"}})["trigger_us"];
  go(0);
  EXPECT_TRUE(good({{"do", "scope"}})["trigger_us"].is_null());
  go(end);
  EXPECT_EQ(good({{"do", "scope"}})["trigger_us"], before) << "the line is followed on the way, too";
}

}  // namespace
}  // namespace ipos::tests
