// The host of the page by itself, as a browser's worker has it: messages in, messages out, and a clock of its caller. No
// copies of the process, no ports, no sources: time goes back by running again.
#include <gtest/gtest.h>

#include "tests/serve/page.hpp"
#include "tests/serve/plants.hpp"

namespace ipos::tests {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using tools::serve::WallClock;

// It stands until the test moves it on, except for the microsecond that each look at it takes.
class TestClock final : public tools::serve::Clock {
 public:
  WallClock::time_point now() const override { return now_ += microseconds(1); }
  void pass(WallClock::duration time) { now_ += time; }

 private:
  mutable WallClock::time_point now_{std::chrono::hours(1)};
};

class HostAlone : public ::testing::Test {
 protected:
  Json good(Json message) {
    Json reply = page.ask(std::move(message));
    EXPECT_TRUE(reply.value("ok", false)) << reply;
    return reply;
  }
  Json topic(Json message) {
    message["do"] = "subscribe";
    good(message);
    return page.event(message["topic"]);
  }
  int64_t value(const char* name) {
    good({{"do", "watch"}, {"names", {name}}});
    return topic({{"topic", "watch"}})["values"][name]["value"].get<int64_t>();
  }
  // Says it without waiting for an answer.
  void say(const Json& message) { page.host.take({MessageKind::Text, 1, message.dump()}); }
  // Until the time comes that the host has named.
  void turn_when_due() {
    const auto due = page.host.turn();
    const auto now = clock.now();
    if (due > now) clock.pass(std::min<WallClock::duration>(due - now, milliseconds(10)));
  }

  TestClock clock;
  tools::serve::Copies copies;
  tools::serve::Files files;  // none
  Page page{the_plant(), clock, copies, files};
};

TEST_F(HostAlone, OpensAPlantAndTellsWhatItIs) {
  page.post.sent.clear();
  page.come(2);
  EXPECT_EQ(page.event("hello")["mode"], "plant");
  EXPECT_EQ(page.event("time")["us"], 0);
  const Json plant = good({{"do", "plant"}})["plant"];
  ASSERT_EQ(plant["stations"].size(), 2U);
  EXPECT_EQ(plant["stations"][0]["name"], "saw");
  EXPECT_EQ(plant["buses"][0]["name"], "sbus");
  EXPECT_TRUE(good({{"do", "program"}, {"station", "saw"}})["files"][0]["text"].is_null());
}

// Who asks and then waits for the event must not wait in vain (docs/reference/serve.md).
TEST_F(HostAlone, TellsTheTimeAfterTheReplyThatHasChangedIt) {
  const std::pair<Json, bool> orders[] = {
      {{{"do", "run"}, {"speed", 1}}, true}, {{{"do", "speed"}, {"speed", 2}}, true}, {{{"do", "pause"}}, false},
      {{{"do", "step"}, {"ms", 3}}, false},  {{{"do", "back"}, {"ms", 1}}, false},    {{{"do", "restart"}}, false}};
  for (auto [order, runs] : orders) {
    order["id"] = 7;
    page.post.sent.clear();
    say(order);
    for (int turn = 0; turn < 20; ++turn) page.host.turn();  // less than the 50 ms between two events of a run
    std::vector<std::string> came;
    for (const auto& message : page.post.sent) {
      if (message.kind != MessageKind::Reply && message.kind != MessageKind::Event) continue;
      const Json body = Json::parse(message.body);
      if (message.kind == MessageKind::Reply) came.push_back(body.value("ok", false) ? "reply" : "refused");
      if (body.value("event", "") == "time") came.push_back(body["running"] == runs ? "time" : "time before the order");
    }
    EXPECT_EQ(came, (std::vector<std::string>{"reply", "time"})) << order;
  }
}

TEST_F(HostAlone, RunsAsFastAsItsCallersClock) {
  say({{"do", "run"}, {"speed", 2}});
  for (int turn = 0; turn < 50; ++turn) page.host.turn();
  EXPECT_LE(page.host.us(), 2'000);  // 50 turns at one time
  const auto begin = clock.now();
  while (clock.now() < begin + milliseconds(500)) turn_when_due();
  EXPECT_NEAR(static_cast<double>(page.host.us()), 1'000'000, 5'000);
  say({{"do", "pause"}});
  const int64_t stands = page.host.us();
  clock.pass(milliseconds(100));
  for (int turn = 0; turn < 5; ++turn) page.host.turn();
  EXPECT_EQ(page.host.us(), stands);
  EXPECT_FALSE(page.host.busy());
}

TEST_F(HostAlone, WhatTheClockIsTooLateForIsLeftOut) {
  say({{"do", "run"}, {"speed", 1}});
  page.host.turn();
  clock.pass(std::chrono::seconds(10));  // a worker that was asleep
  const auto begin = clock.now();
  while (clock.now() < begin + milliseconds(100)) turn_when_due();
  EXPECT_LT(page.host.us(), 400'000);
}

TEST_F(HostAlone, AMessageComesBetweenTheTurnsOfALongStep) {
  page.post.sent.clear();
  say({{"do", "step"}, {"ms", 3'600'000}, {"id", 7}});
  for (int turn = 0; turn < 3; ++turn) page.host.turn();
  EXPECT_TRUE(page.host.busy());
  const int64_t reached = page.host.us();
  EXPECT_GT(reached, 0);
  say({{"do", "back"}, {"us", 0}, {"id", 8}});
  say({{"do", "pause"}, {"id", 9}});
  while (page.host.busy()) page.host.turn();
  EXPECT_EQ(page.host.us(), reached);
  std::map<int, Json> replies;
  for (const auto& message : page.post.sent)
    if (message.kind == MessageKind::Reply)
      if (Json reply = Json::parse(message.body); reply["re"].is_number()) replies[reply["re"]] = reply;
  EXPECT_EQ(replies[7]["us"], reached);
  EXPECT_TRUE(replies[8].contains("error"));  // the step was still on its way
  EXPECT_EQ(replies[9]["ok"], true);
}

TEST_F(HostAlone, StepsOfTheProgramGoOnInTheNextTurn) {
  good({{"do", "step"}, {"ms", 20}});
  good({{"do", "break.set"}, {"station", "saw"}, {"file", "SAW.IPC"}, {"line", 8}});
  good({{"do", "run"}, {"speed", 0}});
  EXPECT_EQ(page.event("time")["stopped"]["line"], 8);
  good({{"do", "break.clear"}, {"number", 1}});
  good({{"do", "program.step"}, {"station", "saw"}, {"kind", "over"}});
  EXPECT_EQ(page.event("time")["stopped"]["line"], 9);
  good({{"do", "program.step"}, {"station", "saw"}, {"kind", "over"}, {"back", true}});
  EXPECT_EQ(page.event("time")["stopped"]["line"], 8);
}

TEST_F(HostAlone, ForcesSetsAndGoesBack) {
  good({{"do", "step"}, {"ms", 100}});
  const int64_t before = value("saw.lCount");
  good({{"do", "input"}, {"station", "lift"}, {"name", "DI05"}, {"action", "force"}, {"on", true}});
  good({{"do", "force"}, {"name", "saw.H200"}, {"value", "77"}});
  good({{"do", "parameters.set"}, {"station", "lift"}, {"number", "P130"}, {"value", "3.0 s"}});
  good({{"do", "step"}, {"ms", 100}});
  EXPECT_GT(value("saw.lCount"), before);
  EXPECT_EQ(value("saw.H200"), 77);
  EXPECT_EQ(value("lift.DI05"), 1);
  EXPECT_EQ(value("lift.P130"), 3);
  good({{"do", "back"}, {"us", 50'000}});
  EXPECT_EQ(page.host.us(), 50'000);
  EXPECT_LT(value("saw.lCount"), before);
  EXPECT_EQ(value("saw.H200"), 0);
  EXPECT_EQ(value("lift.P130"), 2);
  good({{"do", "step"}, {"ms", 50}});
  EXPECT_EQ(value("saw.lCount"), before);
}

TEST_F(HostAlone, ActionsAreDoneAgainWhenTheirTimeComesAgain) {
  good({{"do", "step"}, {"ms", 10}});
  good({{"do", "parameters.set"}, {"station", "lift"}, {"number", "P130"}, {"value", "3.0 s"}});
  good({{"do", "step"}, {"ms", 30}});
  good({{"do", "back"}, {"us", 20'000}});
  EXPECT_EQ(value("lift.P130"), 3);
}

TEST_F(HostAlone, RecordsAndHearsTheBus) {
  good({{"do", "scope"}, {"channels", {"saw.lCount"}}});
  good({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", 523}, {"data", "0102"}});
  good({{"do", "step"}, {"ms", 50}});
  const std::string csv = good({{"do", "scope.csv"}})["csv"];
  EXPECT_TRUE(csv.starts_with("time_ms,saw.lCount\n")) << csv.substr(0, 60);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 51);
  const Json frames = good({{"do", "bus.trace"}})["frames"];
  ASSERT_GE(frames.size(), 1U);
  EXPECT_EQ(frames.back()["id"], 523);
  good({{"do", "back"}, {"us", 10'000}});
  good({{"do", "scope.csv"}});
}

TEST_F(HostAlone, ThatHasNothingToDoWaitsForAMessage) {
  page.settle();
  EXPECT_EQ(page.host.turn(), WallClock::time_point::max());
  topic({{"topic", "plant"}, {"rate", 10}});
  const auto due = page.host.turn();
  EXPECT_GT(due, clock.now());
  EXPECT_LE(due, clock.now() + milliseconds(100));
}

}  // namespace
}  // namespace ipos::tests
