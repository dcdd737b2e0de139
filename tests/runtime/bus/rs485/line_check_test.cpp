// The rules of an RS-485 line from characters of exact times (1053 1610 p. 17-22), and the sender of setpoints at a
// requester that is given no end.
#include "runtime/bus/movilink/line_check.hpp"

#include "runtime/bus/movilink/master_slave.hpp"
#include "tests/runtime/bus/rs485/serial_rig.hpp"

namespace ipos::tests {
namespace {

struct CheckedLine {
  CheckedLine() = default;
  // A telegram with its check; the end of its last character.
  Time hear(Time start, const std::string& text, NodeId sender, bool complete = true) {
    for (const uint8_t byte : complete ? telegram(text) : hex(text)) {
      check.on_character(line, sender, {start, start + kMillisecond, byte, false, false});
      start += kMillisecond;
    }
    return start;
  }
  std::vector<std::string> told() { return std::exchange(texts, {}); }
  EventQueue queue;
  Rs485Line line{queue, 7, "line1", 9600};
  HandNode a{line, "a"}, b{line, "b"}, c{line, "c"};
  std::vector<std::string> texts;
  std::vector<Time> times;
  LineCheck check{[this](Time now, std::string text) {
    times.push_back(now);
    texts.push_back(std::move(text));
  }};
};
using Texts = std::vector<std::string>;
constexpr NodeId kA = 0, kB = 1, kC = 2;

std::string masters(const std::string& one, const std::string& other) {
  return "line1: " + one + " and " + other + " are both masters; only one may be active (1053 1610 p. 47)";
}

TEST(LineChecker, PausesToTheNanosecond) {
  struct Row {
    std::string before;
    bool complete;
    Time pause;  // at least
    std::string after, least;
  };
  // A group, a response and an answered request want the start pause only, which the receiver itself asks for.
  const Row rows[] = {{"02 FF 01 00 01", true, 25 * kMillisecond, "a broadcast", "25000"},
                      {"02 01 01", false, 6'880 * kMicrosecond, "a request that was broken off", "6880"},
                      {"02 65 01 00 01", true, 3'440 * kMicrosecond, "", ""},
                      {"02 FE 01 00 01", true, 3'440 * kMicrosecond, "", ""},
                      {"1D FF 01 00 01", true, 3'440 * kMicrosecond, "", ""},
                      {"1D 01 01", false, 3'440 * kMicrosecond, "", ""}};
  for (const Row& row : rows)
    for (const Time more : {Time{-1}, Time{0}}) {
      if (row.after.empty() && more < 0) continue;
      CheckedLine rig;
      const Time end = rig.hear(kSecond, row.before, kA, row.complete);
      const Time start = end + row.pause + more;
      const Time last = rig.hear(start, "02 02 01 00 01", kA);
      const std::string expected = "line1: a request begins " + std::to_string((row.pause + more) / 1000) +
                                   " us after " + row.after + ", at least " + row.least + " us are required";
      EXPECT_EQ(rig.texts, more < 0 ? Texts{expected} : Texts{}) << row.before;
      if (more < 0) {
        EXPECT_EQ(rig.times[0], last);
      }
      EXPECT_EQ(rig.check.telegrams(), row.complete ? 2U : 1U);
      // It is over with the next request.
      rig.told();
      rig.hear(last + 4 * kMillisecond, "02 02 01 00 01", kA);
      EXPECT_TRUE(rig.told().empty());
    }
}

TEST(LineChecker, ResponsesEndNoPause) {
  CheckedLine rig;
  Time end = rig.hear(0, "02 FF 01 00 01", kA);
  const Time answer = rig.hear(end + 4 * kMillisecond, "1D 01 01 00 01", kB);
  EXPECT_TRUE(rig.told().empty());
  rig.hear(answer + 4 * kMillisecond, "02 01 01 00 01", kA);
  EXPECT_EQ(rig.told(),
            Texts{"line1: a request begins 14000 us after a broadcast, at least 25000 us are required"});
  // What is faulty in another way was not broken off.
  CheckedLine faulty;
  end = faulty.hear(0, "02 01 01 00 01 99", kA, false);
  faulty.hear(end + 4 * kMillisecond, "02 01 01 00 01", kA);
  EXPECT_TRUE(faulty.told().empty());
  EXPECT_EQ(faulty.check.telegrams(), 1U);
}

TEST(LineChecker, EveryRequestOfASecondMaster) {
  CheckedLine rig;
  Time end = rig.hear(0, "02 01 01 00 01", kB);
  end = rig.hear(end + 4 * kMillisecond, "1D 01 01 00 01", kC);
  end = rig.hear(end + 4 * kMillisecond, "02 01 01 00 01", kB);
  EXPECT_TRUE(rig.told().empty());
  end = rig.hear(end + 4 * kMillisecond, "02 01 01 00 01", kA);
  EXPECT_EQ(rig.told(), Texts{masters("b", "a")});
  EXPECT_EQ(rig.times.back(), end);
  rig.hear(end + 4 * kMillisecond, "02 01 01 00 01", kC);
  EXPECT_EQ(rig.told(), Texts{masters("b", "c")});
}

// Several senders at once make no telegram, but a request that begins so comes from two masters.
TEST(LineChecker, MastersThatCollide) {
  const auto collide = [](CheckedLine& rig) {
    rig.check.on_serial_event(rig.line, {SerialEventKind::Collision, 5, kC, kA});
  };
  const std::string collision = "line1: c collides: another station sends at the same time (other station a)";
  CheckedLine rig;
  collide(rig);
  EXPECT_EQ(rig.told(), Texts{collision});
  EXPECT_EQ(rig.times.back(), 5);
  Time end = rig.hear(0, "02 01 01 00 01 99", kNoNode, false);
  EXPECT_EQ(rig.told(), Texts{masters("a", "c")});
  end = rig.hear(end + 4 * kMillisecond, "1D 01 01 00 01 99", kNoNode, false);
  EXPECT_TRUE(rig.told().empty()) << "a response";
  end = rig.hear(end + 4 * kMillisecond, "1D 01 01 00 01", kB);
  end = rig.hear(end + 4 * kMillisecond, "02 01 01 00 01 99", kNoNode, false);
  EXPECT_TRUE(rig.told().empty()) << "one station alone was heard since";
  // Good telegrams of nobody make nobody a master.
  rig.hear(end + 4 * kMillisecond, "02 01 01 00 01", kNoNode);
  EXPECT_TRUE(rig.told().empty());
  CheckedLine other;
  other.check.on_serial_event(other.line, {SerialEventKind::NotConnected, 5, kC, kA});
  EXPECT_EQ(other.told(), Texts{"line1: c takes no part: it is not connected to the line"});
  other.hear(0, "02 01 01 00 01 99", kNoNode, false);
  EXPECT_TRUE(other.told().empty());
}

struct SetpointDrive final : MasterSlaveDrive {
  ProcessWords setpoint_to_send(Time now) override {
    asked.push_back(now);
    return {6, static_cast<uint16_t>(now / kMillisecond), 9};
  }
  void setpoint_received(Time, const ProcessWords&) override {}
  void link_lost(Time) override {}
  std::vector<Time> asked;
};

// A cyclic telegram of three words every 20 ms (ours); while one is not out there is no next one.
TEST(MasterSlave, OneSetpointAfterTheOther) {
  EventQueue queue;
  Wire wire(queue);
  SerialRequester requester(queue, 1, wire, {.repeats = 0, .character = kMillisecond});
  SetpointDrive drive;
  SetpointSender sender(queue, 1, requester, drive);
  EXPECT_FALSE(sender.running());
  queue.run_until(7 * kMillisecond);
  sender.start(queue.now(), 101);
  EXPECT_TRUE(sender.running());
  sender.start(queue.now(), 102);  // it is running already
  queue.run_until(7 * kMillisecond);
  EXPECT_EQ(wire.sent, std::vector<Bytes>{telegram("02 65 05 00 06 00 07 00 09")});
  queue.run_until(17 * kMillisecond);
  requester.on_sent(17 * kMillisecond);
  queue.run_until(27 * kMillisecond);
  EXPECT_EQ(drive.asked, (std::vector<Time>{7 * kMillisecond, 27 * kMillisecond}));
  EXPECT_EQ(wire.sent.back(), telegram("02 65 05 00 06 00 1B 00 09"));
  // Of this one nobody hears the end: ten characters and one, then the response delay.
  queue.run_until(106 * kMillisecond);
  EXPECT_EQ(drive.asked.size(), 2U);
  queue.run_until(107 * kMillisecond);
  EXPECT_EQ(drive.asked.size(), 3U);
  requester.on_sent(107 * kMillisecond);
  sender.stop();
  EXPECT_FALSE(sender.running());
  queue.run_until(kSecond);
  EXPECT_EQ(drive.asked.size(), 3U);
  sender.start(kSecond, 103);
  queue.run_until(kSecond);
  EXPECT_EQ(wire.sent.back()[1], 103);
}

}  // namespace
}  // namespace ipos::tests
