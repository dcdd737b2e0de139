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
