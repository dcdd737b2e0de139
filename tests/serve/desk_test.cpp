// The desk without a plant: clients come and go, and what each has been sent.
#include <gtest/gtest.h>

#include "tests/serve/page.hpp"
#include "tools/serve/desk.hpp"

namespace ipos::tests {
namespace {

using tools::serve::Client;
using tools::serve::Desk;
using tools::serve::Subscription;
using tools::serve::WallClock;

class AtTheDesk : public ::testing::Test {
 protected:
  AtTheDesk() {
    desk.add_topic("news", [this](Client& client, Subscription& subscription) {
      if (subscription.is_news("value", value) || subscription.fresh)
        desk.send(client, {{"event", "news"}, {"value", value}, {"mark", subscription.mark++}});
    });
    desk.add_command("twice", [](const Desk::Call& call) {
      return Json{{"value", 2 * call.arguments.whole("value", 0, 100)}};
    });
    desk.on_closed = [this](const Client& client) { closed.push_back(client.number); };
  }
  void come(uint16_t client) { desk.take({LetterKind::Opened, client, {}}); }
  void go(uint16_t client) { desk.take({LetterKind::Closed, client, {}}); }
  void say(uint16_t client, const Json& message) { desk.take({LetterKind::Message, client, message.dump()}); }
  std::vector<Json> heard(uint16_t client, LetterKind kind) {
    std::vector<Json> all;
    for (const auto& letter : post.sent)
      if (letter.client == client && letter.kind == kind && letter.body.starts_with("{"))
        all.push_back(Json::parse(letter.body));
    post.sent.clear();
    return all;
  }
  // Much later each time.
  std::vector<Json> news(uint16_t client) {
    post.sent.clear();
    now += std::chrono::hours(1);
    desk.publish(now, false);
    return heard(client, LetterKind::Event);
  }

  PagePost post;
  Desk desk{post};
  WallClock::time_point now = WallClock::now();
  Json value = 1;
  std::vector<uint16_t> closed;
};

TEST_F(AtTheDesk, WhoHasGoneIsForgotten) {
  for (uint16_t n = 1; n <= 100; ++n) {
    come(n);
    say(n, {{"do", "subscribe"}, {"topic", "news"}});
    go(n);
  }
  EXPECT_EQ(desk.clients().size(), 0U);
  EXPECT_EQ(closed.size(), 100U);
  EXPECT_EQ(desk.next_due(), WallClock::time_point::max());
  go(1);
  EXPECT_EQ(closed.size(), 100U) << "it was not there";
  post.sent.clear();
  say(2, {{"do", "twice"}, {"id", 1}, {"value", 1}});
  EXPECT_TRUE(heard(2, LetterKind::Reply).empty());
  // Its number may be given again: nothing of the old one is left.
  come(3);
  EXPECT_TRUE(news(3).empty());
}

TEST_F(AtTheDesk, WhatHasNotChangedIsSentOnce) {
  come(1);
  say(1, {{"do", "subscribe"}, {"topic", "news"}});
  EXPECT_EQ(news(1).size(), 1U);
  EXPECT_TRUE(news(1).empty());
  value = 2;
  EXPECT_EQ(news(1).at(0)["value"], 2);
}

TEST_F(AtTheDesk, BehindARefreshEverythingIsNews) {
  come(1);
  say(1, {{"do", "subscribe"}, {"topic", "news"}});
  news(1);
  desk.refresh();
  EXPECT_TRUE(desk.clients().at(1).subscriptions.at("news").sent.empty());
  const auto again = news(1);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0]["mark"], 0) << "from the beginning";
}

TEST_F(AtTheDesk, ASubscriptionIsAskedAsOftenAsItWants) {
  come(1);
  say(1, {{"do", "subscribe"}, {"topic", "news"}, {"rate", 2}});
  desk.publish(now, false);
  EXPECT_EQ(desk.next_due(), now + std::chrono::milliseconds(500));
  value = 2;
  post.sent.clear();
  desk.publish(now + std::chrono::milliseconds(499), false);
  EXPECT_TRUE(heard(1, LetterKind::Event).empty());
  desk.publish(now + std::chrono::milliseconds(500), false);
  EXPECT_EQ(heard(1, LetterKind::Event).size(), 1U);
  say(1, {{"do", "unsubscribe"}, {"topic", "news"}});
  value = 3;
  EXPECT_TRUE(news(1).empty());
}

TEST_F(AtTheDesk, WhoDoesNotReadGetsNoEventsButReplies) {
  desk.add_command("much", [](const Desk::Call&) { return Json{{"text", std::string(300'000, 'x')}}; });
  come(1);
  say(1, {{"do", "subscribe"}, {"topic", "news"}});
  value = std::string(300'000, 'x');
  EXPECT_EQ(news(1).size(), 1U);
  value = 2;
  EXPECT_TRUE(news(1).empty());
  desk.send_all({{"event", "all"}});
  EXPECT_TRUE(heard(1, LetterKind::Event).empty());
  say(1, {{"do", "twice"}, {"id", 5}, {"value", 21}});
  EXPECT_EQ(heard(1, LetterKind::Reply).at(0)["value"], 42);
  desk.take({LetterKind::Drained, 1, "400000"});
  EXPECT_EQ(news(1).at(0)["value"], 2);
}

// What was read is taken off, not more.
TEST_F(AtTheDesk, WhoReadsALittleWaitsStill) {
  come(1);
  say(1, {{"do", "subscribe"}, {"topic", "news"}});
  value = std::string(300'000, 'x');
  news(1);
  value = 2;
  desk.take({LetterKind::Drained, 1, "10"});
  EXPECT_TRUE(news(1).empty());
  const auto binaries = [&] {
    size_t count = 0;
    for (const auto& letter : post.sent) count += letter.kind == LetterKind::Binary ? 1 : 0;
    post.sent.clear();
    return count;
  };
  desk.send_binary(desk.clients().at(1), "event");
  EXPECT_EQ(binaries(), 0U);
  desk.send_binary(desk.clients().at(1), "view", true);
  EXPECT_EQ(binaries(), 1U) << "it was asked for";
  desk.take({LetterKind::Drained, 1, "300000"});
  desk.send_binary(desk.clients().at(1), "event");
  EXPECT_EQ(binaries(), 1U);
}

// While the plant has its share of the time, only who has just come is served.
TEST_F(AtTheDesk, WhoComesWhileThePlantIsBusyIsServedAtOnce) {
  come(1);
  say(1, {{"do", "subscribe"}, {"topic", "news"}});
  desk.publish(WallClock::now() - std::chrono::hours(1), true);  // took an hour: nine are the plant's
  come(2);
  say(2, {{"do", "subscribe"}, {"topic", "news"}});
  value = 2;
  post.sent.clear();
  desk.publish(WallClock::now(), true);
  EXPECT_EQ(post.sent.size(), 1U);
  EXPECT_EQ(heard(2, LetterKind::Event).size(), 1U);
  desk.publish(WallClock::now(), false);
  EXPECT_EQ(heard(1, LetterKind::Event).size(), 1U) << "it is not busy any more";
}

TEST_F(AtTheDesk, ACopyKnowsWhoIsThere) {
  come(7);
  say(7, {{"do", "subscribe"}, {"topic", "news"}, {"rate", 3}});
  desk.clients().at(7).armed = true;
  desk.clients().at(7).watched = {"saw.H1"};
  desk.clients().at(7).unsent = 5;
  const Json state = desk.save();
  come(8);
  desk.load(state);
  ASSERT_EQ(desk.clients().size(), 1U);
  const Client& client = desk.clients().at(7);
  EXPECT_EQ(client.number, 7);
  EXPECT_TRUE(client.armed);
  EXPECT_EQ(client.watched, std::vector<std::string>{"saw.H1"});
  EXPECT_EQ(client.unsent, 5U);
  EXPECT_EQ(client.subscriptions.at("news").rate, 3);
  EXPECT_EQ(news(7).size(), 1U) << "all is news to it";
}

}  // namespace
}  // namespace ipos::tests
