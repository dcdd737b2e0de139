// A gateway that works: its signals are the words and counts of its drives, and names of signals are those of the plant's
// gateways and buses, too.
#include "runtime/signals/find.hpp"
#include "tests/runtime/plant/plain_plant.hpp"

namespace ipos::runtime {
namespace {

using tests::PlainPlant;

std::string gateway_drive(const std::string& name, int address) {
  return "[[station]]\nname = '" + name +
         "'\nunit = 'mc07'\nsbus = 'can'\n[station.parameters]\nP813 = " + std::to_string(address) +
         "\nP100 = 10\nP101 = 3\nP815 = 0\n";
}
const std::string kGatewayAtWork =
    "[[bus]]\nname = 'dp'\nkind = 'profibus'\n[[bus]]\nname = 'can'\nkind = 'can'\n" +
    gateway_drive("fan", 5) + gateway_drive("pump", 2) +
    "[[station]]\nname = 'g'\nunit = 'gateway'\nprofibus = 'dp'\nprofibus_address = 10\nsbus = 'can'\n"
    "[[control]]\nname = 'plc'\nprofibus = 'dp'\n[[control.slave]]\naddress = 10\ncfg = 'F3 F2 F2'\n"
    "po = [4, 1500, 7, 4, 3000, 0x8008]\n";

class GatewaySignals : public ::testing::Test {
 protected:
  void SetUp() override { plant_->run_until(kSecond); }
  int64_t value(const std::string& name) {
    const auto found = signals::find_signals(*plant_, name);
    EXPECT_TRUE(found && found->size() == 1) << (found ? name : found.error());
    return found && !found->empty() ? found->front().read() : INT64_MIN;
  }
  PlainPlant plant_{kGatewayAtWork};
};

// The lower address stands first in the process image.
TEST_F(GatewaySignals, AreTheWordsOfEachDrive) {
  const std::vector<int64_t> sent = {4, 1500, 7, 4, 3000, 0x8008};
  for (size_t word = 0; word < 3; ++word) {
    const std::string number = std::to_string(word + 1);
    EXPECT_EQ(value("g.drive2.PO" + number), sent[word]);
    EXPECT_EQ(value("g.drive5.PO" + number), sent[3 + word]);
    EXPECT_EQ(value("g.drive5.PI" + number), plant_.station(0).drive().state().pi()[word]);
    EXPECT_EQ(value("g.drive2.PI" + number), plant_.station(1).drive().state().pi()[word]);
  }
  EXPECT_NE(value("g.drive2.PI1"), 0);
  EXPECT_EQ(value("g.powered"), 1);
  EXPECT_EQ(value("g.exchange"), 1);
  EXPECT_EQ(value("g.error"), 0);
  for (const auto& [name, bits] :
       {std::pair("g.error", 32), std::pair("g.lost", 8), std::pair("g.drive2.PO3", 16),
        std::pair("g.drive5.PI1", 16), std::pair("g.powered", 1), std::pair("g.drive2.lost", 1),
        std::pair("g.drive2.asked", 0)})
    EXPECT_EQ(signals::find_signals(*plant_, name).value()[0].bits, static_cast<size_t>(bits)) << name;
}

// A telegram to each drive every 10 ms; who has not answered for the reply timeout is lost.
TEST_F(GatewaySignals, CountTelegramsAndLosses) {
  for (const char* drive : {"g.drive2.", "g.drive5."}) {
    const int64_t asked = value(std::string(drive) + "asked"),
                  answered = value(std::string(drive) + "answered");
    EXPECT_NEAR(static_cast<double>(asked), 100, 2);
    EXPECT_LE(answered, asked);
    EXPECT_GE(answered, asked - 2);
    EXPECT_EQ(value(std::string(drive) + "lost"), 0);
    EXPECT_EQ(value(std::string(drive) + "losses"), 0);
  }
  EXPECT_EQ(value("g.lost"), 0);
  for (const auto& [station, drive, bit] :
       {std::tuple("fan", "g.drive5.", 2), std::tuple("pump", "g.drive2.", 1)}) {
    const std::string name = drive;
    plant_->set_power(station, false);
    plant_->run_until(plant_->now() + kSecond);
    EXPECT_EQ(value(name + "lost"), 1);
    EXPECT_EQ(value(name + "losses"), 1);
    EXPECT_EQ(value(name + "PI1"), 0) << "what it said last does not stay";
    EXPECT_EQ(value("g.lost"), bit);
    const int64_t answered = value(name + "answered");
    plant_->run_until(plant_->now() + 100 * kMillisecond);
    EXPECT_EQ(value(name + "answered"), answered);
    plant_->set_power(station, true);
    plant_->run_until(plant_->now() + kSecond);
    EXPECT_EQ(value(name + "lost"), 0);
    EXPECT_EQ(value(name + "losses"), 1);
    EXPECT_NE(value(name + "PI1"), 0);
    EXPECT_EQ(value("g.lost"), 0);
  }
}

// On the line before it they stand behind the parameter channel, three for each drive; from the first look on.
TEST_F(GatewaySignals, AreThoseOfTheTelegramsOnItsLine) {
  std::vector<std::string> names;
  std::map<std::string, std::function<int64_t()>> read;
  const auto found = signals::find_signals(*plant_, "dp.10.P?*");
  ASSERT_TRUE(found) << found.error();
  for (const signals::Signal& signal : *found) {
    names.push_back(signal.name);
    read[signal.name] = signal.read;
    EXPECT_EQ(signal.read(), 0);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"dp.10.PO1", "dp.10.PO2", "dp.10.PO3", "dp.10.PO4", "dp.10.PO5",
                                             "dp.10.PO6", "dp.10.PI1", "dp.10.PI2", "dp.10.PI3", "dp.10.PI4",
                                             "dp.10.PI5", "dp.10.PI6"}));
  plant_->run_until(plant_->now() + 100 * kMillisecond);
  const std::vector<int64_t> sent = {4, 1500, 7, 4, 3000, 0x8008};
  for (size_t word = 0; word < sent.size(); ++word) {
    EXPECT_EQ(read["dp.10.PO" + std::to_string(word + 1)](), sent[word]);
    EXPECT_EQ(read["dp.10.PI" + std::to_string(word + 1)](),
              plant_.station(word < 3 ? 1 : 0).drive().state().pi()[word % 3]);
  }
}

TEST_F(GatewaySignals, AreFoundByNameAndPattern) {
  const auto names = [&](const std::string& pattern) {
    std::vector<std::string> all;
    const auto found = signals::find_signals(*plant_, pattern);
    if (found)
      for (const signals::Signal& signal : *found) all.push_back(signal.name);
    return all;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names("g.drive2.PO?"), (Names{"g.drive2.PO1", "g.drive2.PO2", "g.drive2.PO3"}));
  EXPECT_EQ(names("g.drive?.lost"), (Names{"g.drive2.lost", "g.drive5.lost"}));
  EXPECT_EQ(names("g.lost.?").size(), 8U);
  EXPECT_EQ(names("*.load"), (Names{"dp.load", "can.load"}));
  EXPECT_EQ(names("dp.count"), Names{"dp.count"});
  EXPECT_EQ(value("g.drive2.PO1.2"), 1);
  EXPECT_EQ(value("g.drive2.PO1.1"), 0);
  EXPECT_GT(value("dp.count"), 100);
  EXPECT_GT(value("can.load"), 1);
  EXPECT_EQ(value("can.count"), static_cast<int64_t>(plant_->find_bus("can")->load(plant_->now()).frames));
  EXPECT_EQ(signals::find_signals(*plant_, "g.drive3.PO1").error().substr(0, 61),
            "gateway 'g' has no signal 'drive3.PO1'; it has powered, excha");
  EXPECT_EQ(signals::find_signals(*plant_, "x.y").error(),
            "'x.y' is no signal; signals begin with fan., pump.; the buses have dp.load, dp.count, can.load, "
            "can.count");
  EXPECT_TRUE(signals::find_signals(*plant_, "fan.y")
                  .error()
                  .ends_with("; the buses have dp.load, dp.count, can.load, can.count"));
  EXPECT_EQ(signals::find_signals(*plant_, "y*").error(), "no signal is called like 'y*'");
}

// With one station its name may be left out, and the longest name that fits counts.
TEST(SignalOwners, AreFoundByTheBeginOfAName) {
  const auto found = [](const std::string& text, const std::string& name) {
    const PlainPlant plant(text);
    const auto all = signals::find_signals(*plant, name);
    return all ? all->front().name : "none";
  };
  const std::string u = "[[station]]\nname = 'u'\nunit = 'mdxb'\n",
                    ub = "[[station]]\nname = 'u.b'\nunit = 'mdxb'\n";
  EXPECT_EQ(found(u, "speed"), "u.speed");
  EXPECT_EQ(found(u, "sp?ed"), "u.speed");
  EXPECT_EQ(found(u + ub, "speed"), "none");
  EXPECT_EQ(found(u + ub, "sp?ed"), "none");
  for (const std::string& text : {u + ub, ub + u}) {
    EXPECT_EQ(found(text, "u.b.speed"), "u.b.speed");
    EXPECT_EQ(found(text, "u.b.sp?ed"), "u.b.speed");
    EXPECT_EQ(found(text, "u.speed"), "u.speed");
  }
}

}  // namespace
}  // namespace ipos::runtime
