// The tab Bus by itself: numbers, errors and rows of telegrams that a hand sends, on lines of all three kinds.
#include <cstring>

#include "tests/serve/serving.hpp"

namespace ipos::tests {
namespace {

using tools::serve::WallClock;

class OnLines : public Serving {
 protected:
  OnLines()
      : Serving(plant_of("[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[bus]]\nname = \"wire\"\nkind = \"rs485\"\n"
                            "[[station]]\nname = \"a\"\nunit = \"mdxb\"\nsbus = \"sbus\"\n")) {}

  void send(uint32_t id, const char* data = "01", Json more = Json::object()) {
    more.update({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", id}, {"data", data}});
    good(more);
  }
  Json rows() { return topic({{"topic", "bus"}})["rows"]; }
  Json line(const char* name) { return topic({{"topic", "bus"}})["buses"][name]; }
};

TEST_F(OnLines, NumbersOfTelegramsBeginAnewWithTheRun) {
  send(523);
  step(5);
  send(523);
  step(5);
  good({{"do", "restart"}});
  EXPECT_EQ(good({{"do", "bus.trace"}})["frames"], Json::array());
  send(524);
  step(5);
  const Json frames = good({{"do", "bus.trace"}})["frames"];
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0]["n"], 1);
}

TEST_F(OnLines, DisturbedFramesAreErrorsUntilTheyAreCleared) {
  send(524);
  step(5);
  EXPECT_EQ(line("sbus")["errors"], 0);
  good({{"do", "fault"}, {"bus", "sbus"}, {"kind", "corrupt"}, {"on", true}});
  send(523);
  step(5);
  EXPECT_GT(line("sbus")["errors"], 0);
  EXPECT_EQ(line("wire")["errors"], 0);
  EXPECT_EQ(rows().size(), 1U);
  good({{"do", "bus.clear"}});
  EXPECT_EQ(line("sbus")["errors"], 0);
  EXPECT_EQ(rows(), Json::array());
}

// What comes faster than it is sent is not sent, but its number is told: bytes 4 to 7 of the frame.
TEST_F(OnLines, TelegramsLeftOutOfTheTraceAreCounted) {
  good({{"do", "subscribe"}, {"topic", "trace"}, {"rate", 0.1}});
  auto much_later = [this, now = WallClock::now()]() mutable {
    page.post.sent.clear();
    page.host.router().publish(now += std::chrono::hours(1), false);
    const std::string bytes = page.binary();
    uint32_t left_out = 0, first = 0;
    if (bytes.size() >= 20) {
      std::memcpy(&left_out, bytes.data() + 4, 4);
      std::memcpy(&first, bytes.data() + 16, 4);
    }
    return std::pair(left_out, first);
  };
  send(523);
  step(5);
  EXPECT_EQ(much_later(), std::pair(0U, 1U));
  for (int n = 0; n < 42; ++n) {
    for (int m = 0; m < 50; ++m) send(523);
    step(20);
  }
  EXPECT_EQ(much_later(), std::pair(100U, 102U)) << "2100 have come, 2000 are sent at once";
}

TEST_F(OnLines, RemoteFramesHaveARowOfTheirOwn) {
  send(523, "0102");
  send(523, "0102", {{"remote", true}});
  send(523, "0102", {{"extended", true}});
  step(5);
  EXPECT_EQ(rows().size(), 3U);
}

TEST_F(OnLines, BeyondTheRowsThatThereCanBeOnlyKnownOnesCount) {
  for (uint32_t id = 0; id < 4'100; ++id) {
    send(0x10000 + id, "", {{"extended", true}});
    if (id % 50 == 49) step(20);
  }
  send(0x10000, "", {{"extended", true}});
  step(20);
  const Json all = rows();
  EXPECT_EQ(all.size(), 4'096U);
  EXPECT_EQ(all[0]["count"], 2);
}

// 1053 1610 p. 15: 02h, address, type, data, block check. 02 ^ 05 ^ 05 ^ 06 = 04.
TEST_F(OnLines, SerialTelegramsHaveARowAnAddressAndMistakesAreErrors) {
  const auto send_bytes = [this](const char* data) {
    good({{"do", "bus.send"}, {"bus", "wire"}, {"data", data}});
    step(50);
  };
  send_bytes("02 05 05 00 06 00 00 00 00 04");
  ASSERT_EQ(rows().size(), 1U) << rows();
  EXPECT_EQ(rows()[0]["id"], 5);
  EXPECT_EQ(line("wire")["errors"], 0);
  send_bytes("02 05 05 00 06 00 00 00 00 05");
  EXPECT_EQ(line("wire")["errors"], 1);
  EXPECT_EQ(rows()[0]["count"], 2);
  // In the words of `ipos bus decode` and `monitor`, also where it is asked for by itself.
  const std::string words = "void, BCC incorrect: 02 05 05 00 06 00 00 00 00 05";
  EXPECT_EQ(rows()[0]["text"], words);
  EXPECT_EQ(good({{"do", "bus.decode"}, {"frames", {{{"bus", "wire"}, {"data", "02050500060000000005"}}}}})["texts"],
            Json({words}));
}

// A lost frame is one that nobody heard.
TEST(OnProfibus, LostFramesAreErrors) {
  ServedPage page(plant_of("[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 500000\n[[station]]\nname = \"a\"\n"
                        "unit = \"mc31\"\noption = \"size0\"\nprofibus = \"dp\"\nprofibus_address = 9\n"));
  page.ask({{"do", "fault"}, {"bus", "dp"}, {"kind", "lost"}, {"on", true}});
  ASSERT_TRUE(page.ask({{"do", "bus.send"}, {"bus", "dp"}, {"data", "10 09 20 49 fcs 16"}})["ok"]);
  page.ask({{"do", "step"}, {"ms", 10}});
  page.ask({{"do", "subscribe"}, {"topic", "bus"}});
  EXPECT_EQ(page.event("bus")["buses"]["dp"]["errors"], 1) << page.event("bus");
}

// Chance is counted in thousandths.
TEST_F(OnLines, ARateIsRounded) {
  for (const auto& [rate, is] : {std::pair(0.0996, 0.1), {0.0014, 0.001}, {0.0016, 0.002}, {0.7, 0.7}}) {
    Json fault{{"do", "fault"}, {"bus", "sbus"}, {"kind", "drop"}, {"rate", rate}, {"on", true}};
    good(fault);
    EXPECT_EQ(topic({{"topic", "plant"}})["buses"]["sbus"]["faults"][0]["rate"], is) << rate;
    fault["on"] = false;
    good(fault);
  }
}

}  // namespace
}  // namespace ipos::tests
