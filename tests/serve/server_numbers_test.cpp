// The server of the page by itself, with this test as its host: the numbers of its clients, and when messages have come.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <set>
#include <string>
#include <thread>

#include "tools/serve/arrival.hpp"
#include "tools/serve/channel.hpp"
#include "tools/serve/server.hpp"

namespace ipos::tools::serve {
namespace {

using namespace std::chrono_literals;

class Numbers : public testing::Test {
 protected:
  void SetUp() override {
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    host_ = ends[1];
    ServerOptions options;
    options.token = "t";
    options.page = "page";
    options.last_number = 5;
    server_.emplace(options, ends[0]);
    const std::string address = server_->address();
    port_ = static_cast<uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
    channel_.emplace(host_);
    thread_ = std::thread([this] { server_->run([] {}); });
    channel_->send(MessageKind::Ready, 0, {});
  }
  void TearDown() override {
    close(host_);  // the server ends
    thread_.join();
  }

  int connect() {
    const int client = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(port_);
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(client, reinterpret_cast<sockaddr*>(&at), sizeof at), 0);
    const std::string request =
        "GET /ws?token=t HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) +
        "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
    EXPECT_EQ(write(client, request.data(), request.size()), static_cast<ssize_t>(request.size()));
    return client;
  }
  // The next message of a kind.
  Message next(MessageKind kind) {
    for (int n = 0; n < 2000; ++n)
      if (auto message = channel_->wait(20); message && message->kind == kind) return *message;
    ADD_FAILURE() << "waited for a message of kind " << static_cast<int>(kind);
    return {};
  }
  // A masked text of less than 126 bytes, as a browser sends it; the mask is 0.
  static void say(int client, const std::string& text) {
    const std::string frame =
        std::string("\x81") + static_cast<char>(0x80 | text.size()) + std::string(4, '\0') + text;
    EXPECT_EQ(write(client, frame.data(), frame.size()), static_cast<ssize_t>(frame.size()));
  }

  int host_ = -1;
  uint16_t port_ = 0;
  std::optional<Server> server_;
  std::optional<Channel> channel_;
  std::thread thread_;
};

TEST_F(Numbers, AClientKeepsItsNumberWhenTheyBeginAnew) {
  const int old = connect();
  EXPECT_EQ(next(MessageKind::Opened).client, 1);
  const int other = connect();
  EXPECT_EQ(next(MessageKind::Opened).client, 2);
  std::set<uint16_t> given;
  for (int n = 0; n < 12; ++n) {
    const int passing = connect();
    given.insert(next(MessageKind::Opened).client);
    close(passing);
    next(MessageKind::Closed);
  }
  EXPECT_EQ(given, (std::set<uint16_t>{3, 4, 5}));
  say(old, "{}");
  EXPECT_EQ(next(MessageKind::Text).client, 1);
  close(old);
  EXPECT_EQ(next(MessageKind::Closed).client, 1);
  close(other);
}

TEST_F(Numbers, AMessageHasTheTimeAtWhichItCame) {
  const int client = connect();
  next(MessageKind::Opened);
  const auto before = WallClock::now();
  say(client, "{}");
  const Message message = next(MessageKind::Text);
  EXPECT_GE(message.arrived, before - Arrival::kNap - 100ms);
  EXPECT_LE(message.arrived, WallClock::now());
  close(client);
}

// The server reads on when one of 32 is answered; what waited in the system meanwhile is not new.
TEST_F(Numbers, WhatWaitedWhileNobodyReadIsOld) {
  const int client = connect();
  next(MessageKind::Opened);
  for (int n = 0; n < kMostUnanswered + 1; ++n) say(client, "{}");
  for (int n = 0; n < kMostUnanswered; ++n) next(MessageKind::Text);
  const auto held = WallClock::now();
  std::this_thread::sleep_for(600ms);
  channel_->send(MessageKind::Taken, 1, {});
  EXPECT_LE(next(MessageKind::Text).arrived, held);
  close(client);
}

TEST(Arrivals, AProcessThatSleptDoesNotCallOldMessagesNew) {
  const WallClock::time_point start(100s);
  Arrival arrival;
  for (auto now = start; now < start + 1s; now += 50ms) arrival.awake(now);
  EXPECT_EQ(arrival.of_message(start + 1s), start + 1s);
  arrival.awake(start + 5s);  // it was stopped
  EXPECT_EQ(arrival.of_message(start + 5s), start + 950ms);
  EXPECT_EQ(arrival.of_message(start + 5s + 99ms), start + 950ms);
  EXPECT_EQ(arrival.of_message(start + 5s + 101ms), start + 5s + 101ms);
}

}  // namespace
}  // namespace ipos::tools::serve
