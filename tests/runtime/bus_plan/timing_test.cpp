// Times of a plan by their closed forms: load, response times, the rhythm of PDOs; and the names of variables.
#include <gtest/gtest.h>

#include "runtime/bus_plan/checks.hpp"
#include "runtime/bus_plan/names.hpp"
#include "runtime/bus_plan/response_time.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

TEST(PlanTiming, SeventyPercentMayBePlanned) {
  const auto texts = [](uint64_t load_bits, uint32_t baud) {
    LinePlan plan;
    plan.name = "b";
    plan.baud = baud;
    plan.load_bits = load_bits;
    std::vector<Finding> findings;
    check_timing(plan, findings);
    return findings.empty() ? "" : findings[0].line + ": " + findings[0].text;
  };
  EXPECT_EQ(texts(350'000, 500'000), "");
  EXPECT_EQ(texts(350'001, 500'000), "b: worst-case load 70.0 %, at most 70 % may be planned");
  EXPECT_EQ(texts(712'900, 1'000'000), "b: worst-case load 71.2 %, at most 70 % may be planned");
  EXPECT_EQ(texts(0, 125'000), "");
}

TEST(PlanTiming, AResponseMayTakeOnePeriod) {
  const auto texts = [](Rhythm rhythm, bool bounded, Time worst) {
    LinePlan plan;
    plan.baud = 500'000;
    PlannedTelegram telegram{0x123, "u", "object Tr", 8, rhythm, 2 * kMillisecond, 0, ~0U, {}};
    telegram.response.bounded = bounded;
    telegram.response.worst = worst;
    plan.telegrams.push_back(telegram);
    std::vector<Finding> findings;
    check_timing(plan, findings);
    return findings.empty() ? "" : findings[0].text;
  };
  const std::string begin = "object Tr of u, identifier 123h (291), ";
  EXPECT_EQ(texts(Rhythm::Cyclic, true, 2 * kMillisecond), "");
  EXPECT_EQ(texts(Rhythm::Cyclic, true, 2 * kMillisecond + kMicrosecond),
            begin + "may take 2001 us, its period is 2000 us");
  EXPECT_EQ(texts(Rhythm::Cyclic, false, 0), begin + "may wait for ever, its period is 2000 us");
  for (const Rhythm rhythm : {Rhythm::Answer, Rhythm::Acyclic})
    EXPECT_EQ(texts(rhythm, false, 9 * kMillisecond), "");
}

// A frame waits for one of lower priority that is on the line, then for all of higher or its own priority.
TEST(PlanTiming, ResponseTimesOfFewFrames) {
  constexpr Time kBit = 2'000, kFrame = 100 * kBit;
  const auto worst = [](std::vector<PeriodicFrame> frames, size_t n) {
    const ResponseTime time = response_times(frames, kBit)[n];
    return time.bounded ? time.worst : -1;
  };
  const PeriodicFrame high{1, kFrame, 10 * kFrame, 0}, low{9, 3 * kFrame, 20 * kFrame, 0};
  EXPECT_EQ(worst({high}, 0), kFrame);
  EXPECT_EQ(worst({high, low}, 0), 4 * kFrame) << "blocked by the longer one";
  EXPECT_EQ(worst({high, low}, 1), 4 * kFrame) << "behind the other once";
  EXPECT_EQ(worst({{1, kFrame, 10 * kFrame, 7 * kBit}}, 0), kFrame + 7 * kBit) << "with its jitter";
  EXPECT_EQ(worst({{5, kFrame, 10 * kFrame, 0}, {5, 2 * kFrame, 10 * kFrame, 0}}, 0), 3 * kFrame)
      << "equal ones wait for each other";
  // Full load has no bound; one part in a million less has one.
  EXPECT_EQ(worst({{1, kFrame, 2 * kFrame, 0}, {2, kFrame, 2 * kFrame, 0}}, 1), -1);
  EXPECT_EQ(worst({{1, kFrame, 2 * kFrame, 0}, {2, kFrame, 4 * kFrame, 0}}, 1), 2 * kFrame);
  EXPECT_EQ(worst({{1, kFrame, kFrame, 0}}, 0), -1);
  // Two instances in a busy period: the second one waits for the first.
  EXPECT_EQ(worst({{1, kFrame, 5 * kFrame, 0}, {9, 6 * kFrame, 50 * kFrame, 0}}, 0), 7 * kFrame);
  const ResponseTime twice = response_times(
      std::vector<PeriodicFrame>{{1, kFrame, 5 * kFrame, 0}, {9, 6 * kFrame, 50 * kFrame, 0}}, kBit)[0];
  EXPECT_EQ(std::tuple(twice.blocking, twice.instances, twice.busy_period),
            std::tuple(6 * kFrame, 2U, 8 * kFrame));
}

std::string timed_node(const std::string& pdos) {
  return bus_text() + station_text("saw", "P880 = 1\nP886 = 5\n", "mdxb") +
         "[[control]]\nname = 'plc'\nkind = 'canopen'\nsbus = 'sbus'\ncycle = "
         "'4ms'\n[[control.target]]\naddress = 5\n" +
         pdos;
}

// Type n: with every n-th SYNC, 0 at the worst with each; 254 and 255: as often as the inhibit time lets it, or the event
// timer tells it (CiA 301).
TEST(PlanTiming, RhythmOfPdos) {
  const auto period = [](const std::string& keys) {
    PlantRig rig(
        timed_node("[[control.target.pdo]]\ntransmit = true\nmap = ['PI1', 'PI2', 'PI3', 'PI4']\n" + keys));
    const BusPlan plan = make_plan(rig.get(), {});
    for (const PlannedTelegram& telegram : plan.lines.at(0).telegrams)
      if (telegram.id == 0x185) {
        EXPECT_EQ(std::tuple(telegram.sender, telegram.what, telegram.bytes), std::tuple("saw", "TPDO1", 8));
        const bool synchronous = keys.find("type = 25") == std::string::npos;
        EXPECT_EQ(telegram.request, synchronous ? 0x080U : ~0U) << "it follows SYNC";
        return telegram.rhythm == Rhythm::Cyclic ? telegram.period : -telegram.period;
      }
    return Time{0};
  };
  EXPECT_EQ(period("type = 0\n"), 4 * kMillisecond);
  EXPECT_EQ(period("type = 1\n"), 4 * kMillisecond);
  EXPECT_EQ(period("type = 3\n"), 12 * kMillisecond);
  EXPECT_EQ(period("type = 240\n"), 960 * kMillisecond);
  for (const char* type : {"type = 254\n", "type = 255\n"}) {
    EXPECT_EQ(period(std::string(type) + "event = '20ms'\n"), 20 * kMillisecond);
    EXPECT_EQ(period(std::string(type) + "inhibit = '5ms'\nevent = '20ms'\n"), 5 * kMillisecond);
    EXPECT_EQ(period(std::string(type) + "inhibit = '700us'\n"), 700 * kMicrosecond);
  }
}

TEST(PlanTiming, MessagesOfANode) {
  PlantRig rig(
      timed_node("heartbeat = '50ms'\n[[control.target.pdo]]\nnumber = 2\nmap = ['PO4', 'PO5']\n"
                 "[[control.target.pdo]]\nnumber = 1\nmap = []\n"));
  const BusPlan plan = make_plan(rig.get(), {});
  std::map<uint32_t, std::string> sent;
  for (const PlannedTelegram& telegram : plan.lines.at(0).telegrams)
    sent[telegram.id] = telegram.sender + ' ' + telegram.what + ' ' + std::to_string(telegram.bytes) + ' ' +
                        std::to_string(telegram.period / kMillisecond);
  EXPECT_EQ(sent[0x080], "plc SYNC 0 4");
  EXPECT_EQ(sent[0x305], "plc RPDO2 of saw 4 4");
  EXPECT_EQ(sent[0x705], "saw guarding or heartbeat 1 50");
  EXPECT_EQ(sent.count(0x205), 0U) << "it is off";
  EXPECT_EQ(sent.count(0x085), 0U) << "no emergency in the trial";
  EXPECT_EQ(sent.count(0x605), 0U) << "the master is not planned to ask";
}

TEST(PlanNames, OfVariables) {
  vm::Image image;
  image.symbols = {{"x", 5, 1}, {"a", 10, 3}, {"T.b", 20, 1}};
  for (const auto& [number, name] : std::map<uint32_t, std::string>{
           {4, "H4"}, {5, "x"}, {6, "H6"}, {9, "H9"}, {10, "a[0]"}, {12, "a[2]"}, {13, "H13"}, {20, "T.b"}})
    EXPECT_EQ(variable_name(&image, number), name);
  EXPECT_EQ(variable_name(nullptr, 5), "H5");
}

TEST(PlanNames, OfPlants) {
  PlantRig rig(
      bus_text() + "[[bus]]\nname = 'other'\nkind = 'can'\n" +
      station_text("a", "P881 = 3\nP882 = 4\nP810 = 7\nP811 = 107\nP871 = 9\nP874 = 2\nP890 = 1\nP896 = 6\n",
                   "mdxb", "", "sbus2 = 'other'\n") +
      station_text("b", "P880 = 1\nP886 = 5\n", "mdxb"));
  const CanNames names = can_names(rig.get());
  ASSERT_EQ(names.lines.size(), 2U);
  const CanLineNames& first = names.lines.at("sbus");
  ASSERT_EQ(first.movilink.units.size(), 1U);
  const UnitNames& unit = first.movilink.units[0];
  EXPECT_EQ(std::tuple(unit.name, unit.settings.address, unit.settings.group, unit.output[1], unit.input[1]),
            std::tuple("a", 3, 4, 9, 2));
  ASSERT_EQ(first.nodes.size(), 1U);
  EXPECT_EQ(std::pair(first.nodes[0].node, first.nodes[0].name), std::pair(uint8_t{5}, std::string("b")));
  const CanLineNames& second = names.lines.at("other");
  EXPECT_TRUE(second.movilink.units.empty());
  EXPECT_EQ(second.nodes.at(0).name, "a");
  EXPECT_EQ(names.all.movilink.units.size(), 1U);
  EXPECT_EQ(names.all.nodes.size(), 2U);
  const TelegramNames serial = serial_names(rig.get());
  ASSERT_EQ(serial.units.size(), 2U);
  EXPECT_EQ(
      std::tuple(serial.units[0].name, serial.units[0].settings.address, serial.units[0].settings.group),
      std::tuple("a", 7, 107));
}

}  // namespace
}  // namespace ipos::tests
