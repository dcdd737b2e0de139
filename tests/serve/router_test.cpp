// The router without a plant: clients come and go, and what each has been sent.
#include <gtest/gtest.h>

#include "tests/serve/page.hpp"
#include "tools/serve/channel.hpp"
#include "tools/serve/host/router.hpp"

namespace ipos::tests {
namespace {

using tools::serve::Client;
using tools::serve::Router;
using tools::serve::Subscription;
using tools::serve::WallClock;

class AtTheRouter : public ::testing::Test {
 protected:
  AtTheRouter() {
    router.add_topic("news", [this](Client& client, Subscription& subscription) {
      if (subscription.is_news("value", value) || subscription.fresh)
        router.send(client, {{"event", "news"}, {"value", value}, {"mark", subscription.mark++}});
    });
    router.add_command("twice", [](const Router::Call& call) {
      return Json{{"value", 2 * call.arguments.whole("value", 0, 100)}};
    });
    router.on_closed = [this](const Client& client) { closed.push_back(client.number); };
  }
  void come(uint16_t client) { router.take({MessageKind::Opened, client, {}}); }
  void go(uint16_t client) { router.take({MessageKind::Closed, client, {}}); }
  void say(uint16_t client, const Json& message) { router.take({MessageKind::Text, client, message.dump()}); }
  std::vector<Json> heard(uint16_t client, MessageKind kind) {
    std::vector<Json> all;
    for (const auto& message : post.sent)
      if (message.client == client && message.kind == kind && message.body.starts_with("{"))
        all.push_back(Json::parse(message.body));
    post.sent.clear();
    return all;
  }
  // Much later each time.
  std::vector<Json> news(uint16_t client) {
    post.sent.clear();
    now += std::chrono::hours(1);
    router.publish(now, false);
    return heard(client, MessageKind::Event);
  }

  PagePost post;
  tools::serve::SteadyClock clock;
  Router router{post, clock};
  WallClock::time_point now = WallClock::now();
  Json value = 1;
  std::vector<uint16_t> closed;
};

TEST_F(AtTheRouter, WhoHasGoneIsForgotten) {
  for (uint16_t n = 1; n <= 100; ++n) {
    come(n);
    say(n, {{"do", "subscribe"}, {"topic", "news"}});
    go(n);
  }
  EXPECT_EQ(router.clients().size(), 0U);
  EXPECT_EQ(closed.size(), 100U);
  EXPECT_EQ(router.next_due(), WallClock::time_point::max());
  go(1);
  EXPECT_EQ(closed.size(), 100U) << "it was not there";
  post.sent.clear();
  say(2, {{"do", "twice"}, {"id", 1}, {"value", 1}});
  EXPECT_TRUE(heard(2, MessageKind::Reply).empty());
  // Its number may be given again: nothing of the old one is left.
  come(3);
  EXPECT_TRUE(news(3).empty());
}

TEST_F(AtTheRouter, EveryHostShowsTheLicences) {
  come(1);
  post.sent.clear();
  say(1, {{"do", "licences"}, {"id", 1}});
  const std::vector<Json> replies = heard(1, MessageKind::Reply);
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_NE(replies[0]["text"].get<std::string>().find("preact"), std::string::npos);
}

TEST_F(AtTheRouter, WhatHasNotChangedIsSentOnce) {
  come(1);
  say(1, {{"do", "subscribe"}, {"topic", "news"}});
  EXPECT_EQ(news(1).size(), 1U);
  EXPECT_TRUE(news(1).empty());
  value = 2;
  EXPECT_EQ(news(1).at(0)["value"], 2);
}

TEST_F(AtTheRouter, BehindARefreshEverythingIsNews) {
  come(1);
  say(1, {{"do", "subscribe"}, {"topic", "news"}});
  news(1);
  router.refresh();
  EXPECT_TRUE(router.clients().at(1).subscriptions.at("news").sent.empty());
  const auto again = news(1);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0]["mark"], 0) << "from the beginning";
}

TEST_F(AtTheRouter, ASubscriptionIsAskedAsOftenAsItWants) {
  come(1);
  say(1, {{"do", "subscribe"}, {"topic", "news"}, {"rate", 2}});
  router.publish(now, false);
  EXPECT_EQ(router.next_due(), now + std::chrono::milliseconds(500));
  value = 2;
  post.sent.clear();
  router.publish(now + std::chrono::milliseconds(499), false);
  EXPECT_TRUE(heard(1, MessageKind::Event).empty());
  router.publish(now + std::chrono::milliseconds(500), false);
  EXPECT_EQ(heard(1, MessageKind::Event).size(), 1U);
  say(1, {{"do", "unsubscribe"}, {"topic", "news"}});
  value = 3;
  EXPECT_TRUE(news(1).empty());
}

TEST_F(AtTheRouter, WhoDoesNotReadGetsNoEventsButReplies) {
  router.add_command("much", [](const Router::Call&) { return Json{{"text", std::string(300'000, 'x')}}; });
  come(1);
  say(1, {{"do", "subscribe"}, {"topic", "news"}});
  value = std::string(300'000, 'x');
  EXPECT_EQ(news(1).size(), 1U);
  value = 2;
  EXPECT_TRUE(news(1).empty());
  router.send_all({{"event", "all"}});
  EXPECT_TRUE(heard(1, MessageKind::Event).empty());
  say(1, {{"do", "twice"}, {"id", 5}, {"value", 21}});
  EXPECT_EQ(heard(1, MessageKind::Reply).at(0)["value"], 42);
  router.take({MessageKind::Drained, 1, "400000"});
  EXPECT_EQ(news(1).at(0)["value"], 2);
}

// What was read is taken off, not more.
TEST_F(AtTheRouter, WhoReadsALittleWaitsStill) {
  come(1);
  say(1, {{"do", "subscribe"}, {"topic", "news"}});
  value = std::string(300'000, 'x');
  news(1);
  value = 2;
  router.take({MessageKind::Drained, 1, "10"});
  EXPECT_TRUE(news(1).empty());
  const auto binaries = [&] {
    size_t count = 0;
    for (const auto& message : post.sent) count += message.kind == MessageKind::Binary ? 1 : 0;
    post.sent.clear();
    return count;
  };
  router.send_binary(router.clients().at(1), "event");
  EXPECT_EQ(binaries(), 0U);
  router.send_binary(router.clients().at(1), "view", true);
  EXPECT_EQ(binaries(), 1U) << "it was asked for";
  router.take({MessageKind::Drained, 1, "300000"});
  router.send_binary(router.clients().at(1), "event");
  EXPECT_EQ(binaries(), 1U);
}

// While the plant has its share of the time, only who has just come is served.
TEST_F(AtTheRouter, WhoComesWhileThePlantIsBusyIsServedAtOnce) {
  come(1);
  say(1, {{"do", "subscribe"}, {"topic", "news"}});
  router.publish(WallClock::now() - std::chrono::hours(1), true);  // took an hour: nine are the plant's
  come(2);
  say(2, {{"do", "subscribe"}, {"topic", "news"}});
  value = 2;
  post.sent.clear();
  router.publish(WallClock::now(), true);
  EXPECT_EQ(post.sent.size(), 1U);
  EXPECT_EQ(heard(2, MessageKind::Event).size(), 1U);
  router.publish(WallClock::now(), false);
  EXPECT_EQ(heard(1, MessageKind::Event).size(), 1U) << "it is not busy any more";
}

TEST_F(AtTheRouter, ACopyKnowsWhoIsThere) {
  come(7);
  say(7, {{"do", "subscribe"}, {"topic", "news"}, {"rate", 3}});
  router.clients().at(7).armed = true;
  router.clients().at(7).watched = {"saw.H1"};
  router.clients().at(7).unsent = 5;
  const Json state = router.save();
  come(8);
  router.load(state);
  ASSERT_EQ(router.clients().size(), 1U);
  const Client& client = router.clients().at(7);
  EXPECT_EQ(client.number, 7);
  EXPECT_TRUE(client.armed);
  EXPECT_EQ(client.watched, std::vector<std::string>{"saw.H1"});
  EXPECT_EQ(client.unsent, 5U);
  EXPECT_EQ(client.subscriptions.at("news").rate, 3);
  EXPECT_EQ(news(7).size(), 1U) << "all is news to it";
}

}  // namespace
}  // namespace ipos::tests
