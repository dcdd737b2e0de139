// A drive whose control word is that of a bus, or of a master, before anybody has sent one: it counts as 0000h, the safe
// state (MOVITRAC 07 chapter 6.3), on every unit and bus, whatever the monitoring. Terminals enable it all the time.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "runtime/plant/plant.hpp"

namespace ipos::runtime {
namespace {

const std::string kLines =
    "[[bus]]\nname = 'sbus'\nkind = 'can'\n[[bus]]\nname = 'sbus2'\nkind = 'can'\n"
    "[[bus]]\nname = 'line'\nkind = 'rs485'\n[[bus]]\nname = 'dp'\nkind = 'profibus'\n";
const std::string kEnabled = "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI02 = 0\nDI03 = 1\n";

struct Case {
  std::string unit, keys, parameters;
  std::string sender;  // a table that sends an enable and 1000 rpm; empty: none is tried
};

std::unique_ptr<Plant> plant_of(const std::string& text) {
  PlantFileResult file = read_plant_file(text);
  for (const PlantError& error : file.errors)
    ADD_FAILURE() << error.place.line << ": " << error.text << "\n" << text;
  std::vector<PlantError> errors;
  std::vector<std::optional<vm::Image>> programs(file.plant.stations.size());
  auto plant = std::make_unique<Plant>(std::move(file.plant), std::move(programs), std::nullopt, errors);
  for (const PlantError& error : errors) ADD_FAILURE() << error.text << "\n" << text;
  return plant;
}

std::vector<Case> cases() {
  const std::string sbus_master =
      "[[control]]\nname = 'plc'\nsbus = 'sbus'\n[[control.target]]\naddress = 1\npo = [6, 5000, 0]\nevery = "
      "'20ms'\n";
  const auto dp_master = [](const std::string& cfg) {
    return "[[control]]\nname = 'plc'\nprofibus = 'dp'\n[[control.slave]]\naddress = 8\n" + cfg +
           "po = [6, 1500, 0]\n";
  };
  const std::string on_dp = "option = 'dfp'\nprofibus = 'dp'\nprofibus_address = 8\n";
  std::vector<Case> all;
  for (const std::string timeout : {"0", "50", "650000"}) {
    const std::string sources = "P100 = 10\nP101 = 3\n";
    all.push_back({"md60a", "sbus = 'sbus'\n", sources + "P813 = 1\nP815 = " + timeout + "\n", sbus_master});
    all.push_back(
        {"compact", "sbus = 'sbus'\n", sources + "P813 = 1\nP815 = " + timeout + "\n", sbus_master});
    all.push_back({"mc07", "sbus = 'sbus'\n", sources + "P813 = 1\nP815 = " + timeout + "\n",
                   timeout == "50" ? "" : sbus_master});
    all.push_back({"mdxb", "sbus = 'sbus'\n", sources + "P881 = 1\nP883 = " + timeout + "\n", sbus_master});
    all.push_back({"mdxb", "sbus2 = 'sbus2'\n", sources + "P891 = 1\nP893 = " + timeout + "\n", ""});
    for (const std::string protocol : {"P880", "P890"})
      all.push_back({"mdxb", protocol == "P880" ? "sbus = 'sbus'\n" : "sbus2 = 'sbus2'\n",
                     sources + protocol + " = 1\nP883 = " + timeout + "\nP893 = " + timeout + "\n", ""});
    // The setpoint from elsewhere, and no word that is a control word.
    all.push_back({"mdxb", "sbus = 'sbus'\n", "P101 = 3\nP881 = 1\nP883 = " + timeout + "\n", sbus_master});
    all.push_back({"mdxb", "sbus = 'sbus'\n",
                   sources + "P870 = 1\nP871 = 1\nP872 = 1\nP881 = 1\nP883 = " + timeout + "\n", ""});
    for (const std::string unit : {"md60a", "mdxb"}) {
      const std::string monitoring = unit == "mdxb" ? "P883 = " : "P815 = ";
      all.push_back({unit, "sbus = 'sbus'\n", "P100 = 8\n" + monitoring + timeout + "\n", ""});
      all.push_back({unit, "rs485 = 'line'\n", "P100 = 9\nP811 = 101\nP812 = " + timeout + "\n", ""});
      all.push_back({unit, "rs485 = 'line'\n", "P100 = 2\nP101 = 1\nP812 = " + timeout + "\n", ""});
      all.push_back({unit, on_dp, "P100 = 3\nP101 = 2\nP819 = " + timeout + "\n",
                     dp_master("cfg = 'F2'\nwatchdog = '1s'\n")});
    }
    all.push_back({"mc07", "rs485 = 'line'\n", "P100 = 2\nP101 = 1\nP812 = " + timeout + "\n", ""});
  }
  all.push_back({"mc31", "option = 'ffp31'\nprofibus = 'dp'\nprofibus_address = 8\n",
                 "P841 = 1\nP600 = 0\nP601 = 0\n", dp_master("")});
  return all;
}

TEST(FirstWord, NobodyMovesBeforeIt) {
  for (const Case& one : cases()) {
    const std::string text = kLines + "[[station]]\nname = 'n'\nunit = '" + one.unit + "'\n" + one.keys +
                             "[station.parameters]\n" + one.parameters + kEnabled;
    const auto plant = plant_of(text);
    const Drive& drive = plant->stations()[0]->drive().state();
    bool moved = false;
    plant->run_until(2 * kSecond, [&](Time) { return !(moved = moved || drive.speed() != 0); });
    EXPECT_FALSE(moved) << text;
    EXPECT_FALSE(drive.output_stage()) << text;
    const Block why = drive.verdict().reason;
    EXPECT_TRUE(why == Block::NoControlWord || why == Block::Waiting || why == Block::Fault)
        << block_text(why, *plant->stations()[0]->config().unit) << "\n"
        << text;
    if (one.sender.empty()) continue;
    const auto called = plant_of(text + one.sender);
    called->run_until(3 * kSecond);
    EXPECT_GT(called->stations()[0]->drive().state().speed(), 0) << text << one.sender;
  }
}

// A master that comes late, and a bus that falls silent behind it: the word that has come stays, as long as the monitoring
// does not end it.
TEST(FirstWord, FromItOnTheBusDecides) {
  const auto plant = plant_of(kLines +
                              "[[station]]\nname = 'n'\nunit = 'mdxb'\nsbus = 'sbus'\n[station.parameters]\n"
                              "P100 = 10\nP101 = 3\nP881 = 1\nP883 = 0\n" +
                              kEnabled);
  Station& station = *plant->stations()[0];
  const auto speed_at = [&](Time end) {
    plant->run_until(end);
    return station.drive().state().speed();
  };
  EXPECT_EQ(speed_at(kSecond), 0);
  const uint16_t words[] = {0x0006, 1500, 0};
  station.drive().take_output(kSecond, OutputChannel::Single, words);
  EXPECT_EQ(speed_at(4 * kSecond), 300'000);
  EXPECT_EQ(speed_at(10 * kSecond), 300'000) << "P883 = 0: silence is no fault";
  const uint16_t stop[] = {0x0000, 1500, 0};
  station.drive().take_output(10 * kSecond, OutputChannel::Single, stop);
  EXPECT_EQ(speed_at(12 * kSecond), 0);
}

}  // namespace
}  // namespace ipos::runtime
