// A station answers on every line that it is on while its power is on, and on none while it is off; its keypad asks as
// long.
#include "tests/runtime/plant/plain_plant.hpp"

namespace ipos::runtime {
namespace {

using tests::PlainPlant;

class AnswerListener final : public BusObserver {
 public:
  void on_message(const Bus&, const BusMessage& message) override { texts.push_back(message.text); }
  std::vector<std::string> texts;
};

struct AskedLine {
  const char* bus;
  const char* request;
  const char* answer;  // its begin
};

// Read 8318 of unit 1 (1053 1610 p. 22, 38), and the FDL status of slave 8 (EN 50170 volume 2).
constexpr AskedLine kAskedLines[] = {
    {"can", "20B#3100207E00000000", "20C#3100207E"},
    {"other", "213#3100207E00000000", "214#3100207E"},
    {"rs", "02 01 86 31 00 20 7E 00 00 00 00 bcc", "1D 01 86 31 00 20 7E"},
    {"xt", "02 01 86 31 00 20 7E 00 00 00 00 bcc", "1D 01 86 31 00 20 7E"},
    {"dp", "10 08 02 49 fcs 16", "10 02 08 00"},
};

TEST(StationPower, AnswersOnEveryLineWhileItIsOn) {
  const PlainPlant plant(R"(
[[bus]]
name = 'can'
kind = 'can'
[[bus]]
name = 'other'
kind = 'can'
[[bus]]
name = 'rs'
kind = 'rs485'
[[bus]]
name = 'xt'
kind = 'rs485'
baud = 57600
[[bus]]
name = 'dp'
kind = 'profibus'
[[station]]
name = 'u'
unit = 'mdxb'
sbus = 'can'
rs485 = 'rs'
rs485_xt = 'xt'
option = 'dfp'
profibus = 'dp'
profibus_address = 8
[station.parameters]
P810 = 1
P881 = 1
[[station]]
name = 'v'
unit = 'mdxb'
sbus2 = 'other'
[station.parameters]
P891 = 2
[[station]]
name = 'w'
unit = 'mdxb'
sbus = 'can'
sbus2 = 'other'
[station.parameters]
P881 = 9
P891 = 9
)");
  ASSERT_TRUE(plant.errors.empty());
  std::map<std::string, AnswerListener> heard;
  for (const AskedLine& line : kAskedLines) {
    plant->find_bus(line.bus)->add_observer(heard[line.bus]);
    plant->find_bus(line.bus)->attach_hand();
  }
  // The card finds its rate from what it hears.
  for (int n = 0; n < 20; ++n) {
    plant->run_until(plant->now() + 20 * kMillisecond);
    EXPECT_EQ(plant->find_bus("dp")->send("10 7D 02 49 fcs 16"), std::nullopt);
  }
  for (const bool on : {true, false, true, false, true}) {
    for (const char* station : {"u", "v"}) plant->set_power(station, on);
    plant->run_until(plant->now() + 500 * kMillisecond);
    for (int n = 0; n < 20; ++n) {
      plant->find_bus("dp")->send("10 7D 02 49 fcs 16");
      plant->run_until(plant->now() + 20 * kMillisecond);
    }
    for (const AskedLine& line : kAskedLines) {
      auto& texts = heard[line.bus].texts;
      texts.clear();
      EXPECT_EQ(plant->find_bus(line.bus)->send(line.request), std::nullopt);
      plant->run_until(plant->now() + 200 * kMillisecond);
      const auto answers = std::count_if(
          texts.begin(), texts.end(), [&](const std::string& text) { return text.starts_with(line.answer); });
      EXPECT_EQ(answers, on ? 1 : 0) << line.bus << (on ? " on" : " off");
    }
  }
}

// Who is on stays as it is when it is switched on, and nothing begins twice.
TEST(StationPower, SwitchedOnTwiceIsOnOnce) {
  const PlainPlant plant(
      "[[bus]]\nname = 'b'\nkind = 'can'\n[[bus]]\nname = 'p'\nkind = 'profibus'\n"
      "[[station]]\nname = 'u'\nunit = 'mdxb'\nsbus = 'b'\n[station.parameters]\nP881 = 5\n"
      "[[station]]\nname = 'g'\nunit = 'gateway'\nprofibus = 'p'\nprofibus_address = 5\nsbus = 'b'\n");
  ASSERT_TRUE(plant.errors.empty());
  plant->run_until(100 * kMillisecond);
  const auto frames_of_a_second = [&] {
    const uint64_t before = plant->find_bus("b")->load(plant->now()).frames;
    plant->run_until(plant->now() + kSecond);
    return plant->find_bus("b")->load(plant->now()).frames - before;
  };
  const uint64_t frames = frames_of_a_second();
  EXPECT_GT(frames, 100U);
  const SbusPort* port = std::as_const(plant.station()).sbus(1);
  plant.station().power_on();
  plant->find_gateway("g")->power_on();
  EXPECT_EQ(std::as_const(plant.station()).sbus(1), port);
  EXPECT_EQ(frames_of_a_second(), frames);
  for (int n = 0; n < 2; ++n) {
    plant.station().power_off();
    plant->find_gateway("g")->power_off();
  }
  plant->run_until(plant->now() + 10 * kMillisecond);
  EXPECT_EQ(frames_of_a_second(), 0U);
  for (int n = 0; n < 2; ++n) {
    plant.station().power_on();
    plant->find_gateway("g")->power_on();
  }
  plant->run_until(plant->now() + 100 * kMillisecond);
  EXPECT_NEAR(static_cast<double>(frames_of_a_second()), static_cast<double>(frames), 2);
}

// What a gateway has found out about its drives is not forgotten when it is switched on again while it is on.
TEST(StationPower, AGatewayThatIsOnGoesOn) {
  const PlainPlant plant(
      "[[bus]]\nname = 'b'\nkind = 'can'\n[[bus]]\nname = 'p'\nkind = 'profibus'\n"
      "[[station]]\nname = 'u'\nunit = 'mdxb'\n"
      "[[station]]\nname = 'g'\nunit = 'gateway'\nprofibus = 'p'\nprofibus_address = 5\nsbus = 'b'\n"
      "drives = [9]\n");
  ASSERT_TRUE(plant.errors.empty());
  Gateway& gateway = *plant->find_gateway("g");
  plant->run_until(kSecond);
  EXPECT_TRUE(gateway.drives().at(0).lost);
  gateway.power_on();
  plant->run_until(kSecond + 50 * kMillisecond);
  EXPECT_TRUE(gateway.drives().at(0).lost);
  EXPECT_EQ(gateway.drives().at(0).losses, 1U);
  EXPECT_TRUE(plant.told("g", "answers again").empty());
}

TEST(StationPower, TheKeypadAsksWhileItIsOn) {
  const PlainPlant plant("[[station]]\nname = 'u'\nunit = 'mdxb'\nkeypad = true\n");
  const auto frames = [&] { return plant->find_bus("u.keypad")->load(plant->now()).frames; };
  for (const bool on : {true, false, true}) {
    plant->set_power("u", on);
    plant->run_until(plant->now() + 500 * kMillisecond);
    const uint64_t before = frames();
    plant->run_until(plant->now() + kSecond);
    EXPECT_EQ(frames() > before, on);
  }
}

}  // namespace
}  // namespace ipos::runtime
