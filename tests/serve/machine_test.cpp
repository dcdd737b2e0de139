// What the host tells of the machine that a station drives: of the plant file, else of switches and parameters.
#include "tests/serve/serving.hpp"

namespace ipos::tests {
namespace {

// n11 = 1500 rpm; see tests/runtime/plant/belt_test.cpp for the belt: an increment is 0.001 mm.
constexpr const char* kMachines = R"(
[[station]]
name = "hoist"
unit = "mdxb"
[station.parameters]
P920 = 90000
P921 = -500
P900 = 77
[station.machine]
kind = "hoist"
unit = "mm"
per_turn = 40
from = 0
to = 2000
[[station]]
name = "table"
unit = "mdxb"
[station.parameters]
P960 = 2
P961 = 10
P962 = 3
P963 = 4096
[[station]]
name = "slide"
unit = "mdxb"
[station.parameters]
P903 = 5
[[station]]
name = "plain"
unit = "mdxb"
[[station]]
name = "pump"
unit = "mc31"
[[station]]
name = "belt"
unit = "mdxb"
[station.parameters]
P130 = 0
P160 = 1500000
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
DI04 = 1
[station.machine]
kind = "conveyor"
unit = "mm"
per_turn = 4.096
from = 0
to = 100
parts = [10]
part_length = 5
[[switch]]
station = "slide"
input = "DI10"
from = 5
[[switch]]
station = "belt"
input = "DI10"
part_at = 50
active = "low"
)";

class Machines : public Serving {
 protected:
  Machines() : Serving(plant_of(kMachines)) {}
  Json plant() { return topic({{"topic", "plant"}}); }
};

TEST_F(Machines, AreThoseOfThePlantFile) {
  const Json hoist = plant()["machines"]["hoist"];
  EXPECT_EQ(hoist["kind"], "hoist");
  EXPECT_EQ(hoist["unit"], "mm");
  EXPECT_EQ(hoist["per_turn"], 40.0);
  EXPECT_EQ(hoist["from"], 0.0);
  EXPECT_EQ(hoist["to"], 2000.0);
  EXPECT_EQ(hoist["given"], true);
  EXPECT_EQ(hoist["limits"], (Json{-500, 90000}));
  EXPECT_EQ(hoist["reference"], 77);
}

TEST_F(Machines, AreMadeOfWhatIsThere) {
  const Json machines = plant()["machines"];
  // A turn of the output takes 10 / 3 turns of the motor.
  EXPECT_EQ(machines["table"]["kind"], "turntable");
  EXPECT_EQ(machines["table"]["unit"], "deg");
  EXPECT_NEAR(machines["table"]["per_turn"].get<double>(), 108.0, 1e-9);
  EXPECT_EQ(machines["slide"]["kind"], "axis");
  EXPECT_EQ(machines["slide"]["unit"], "inc");
  EXPECT_EQ(machines["slide"]["per_turn"], 4096);
  EXPECT_EQ(machines["slide"]["reference"], nullptr) << "P903 = 5: no reference travel";
  for (const char* name : {"plain", "pump"}) {
    EXPECT_EQ(machines[name]["kind"], "shaft") << name;
    EXPECT_EQ(machines[name]["limits"], nullptr) << name;
    EXPECT_EQ(machines[name]["given"], false) << name;
  }
  EXPECT_EQ(machines["pump"]["reference"], nullptr) << "a unit without positioning";
}

TEST_F(Machines, ParametersThatChangeAreNews) {
  plant();
  good({{"do", "parameters.set"}, {"station", "plain"}, {"number", "P920"}, {"value", "1000"}});
  step(1);
  page.post.sent.clear();
  page.host.router().publish(tools::serve::WallClock::now() + std::chrono::hours(1), false);
  const Json machines = page.event("plant")["machines"];
  EXPECT_EQ(machines.size(), 1U) << machines;
  EXPECT_EQ(machines["plain"]["kind"], "axis");
  EXPECT_EQ(machines["plain"]["limits"], (Json{0, 1000}));
}

TEST_F(Machines, BarriersStandInThePlantAndPartsInTheState) {
  const Json told = good({{"do", "plant"}})["plant"];
  EXPECT_EQ(told["barriers"], Json::array({{{"input", "belt.DI10"}, {"belt", "belt"}, {"at", 50.0}, {"active_high", false}}}));
  EXPECT_EQ(told["switches"].size(), 1U);
  EXPECT_EQ(plant()["machines"]["belt"]["part_length"], 5.0);
  step(1000);
  const Json state = plant()["stations"]["belt"];
  const double moved = state["machine"]["shaft"].get<double>() / 1000;
  EXPECT_GT(moved, 50);
  // The parts were moved at the beginning of the last millisecond, 102.4 increments before.
  ASSERT_EQ(state["machine"]["parts"].size(), 1U) << state;
  EXPECT_NEAR(state["machine"]["parts"][0].get<double>(), 10 + moved, 0.11);
  // They are part of what time goes back to.
  step(400);
  EXPECT_NE(plant()["stations"]["belt"]["machine"]["parts"], state["machine"]["parts"]);
  good({{"do", "back"}, {"us", 1'000'000}});
  EXPECT_EQ(plant()["stations"]["belt"]["machine"]["parts"], state["machine"]["parts"]);
  EXPECT_FALSE(plant()["stations"]["plain"]["machine"].contains("parts"));
  EXPECT_FALSE(plant()["stations"]["pump"]["machine"].contains("target"));
  EXPECT_EQ(state["machine"]["referenced"], false);
}

// --- what the tab Plant folds away, and what it calls not well ---

TEST_F(Machines, TerminalsThatNobodyUses) {
  const Json stations = good({{"do", "plant"}})["plant"]["stations"];
  const auto used = [&](const std::string& station, const char* group) {
    std::vector<std::string> names;
    for (const Json& one : stations)
      if (one["name"] == station)
        for (const Json& terminal : one[group])
          if (terminal["used"]) names.push_back(terminal["name"]);
    return names;
  };
  // As delivered DI00 to DI05 and DB00 to DO02 have functions (MDX60B/61B, P600..P604 and P620, P621); more: what the file
  // names.
  const std::vector<std::string> delivered = used("plain", "inputs");
  EXPECT_EQ(std::count(delivered.begin(), delivered.end(), "DI10"), 0);
  EXPECT_EQ(std::count(delivered.begin(), delivered.end(), "DI00"), 1);
  std::vector<std::string> with_switch = used("slide", "inputs");
  EXPECT_EQ(with_switch.size(), delivered.size() + 1);
  EXPECT_EQ(std::count(with_switch.begin(), with_switch.end(), "DI10"), 1);
  EXPECT_EQ(used("belt", "inputs"), with_switch) << "a light barrier";
}

constexpr const char* kOrders = R"(
[[station]]
name = "idle"
unit = "mdxb"
[[station]]
name = "inhibited"
unit = "mdxb"
[station.inputs]
DI01 = 1
DI03 = 1
[[station]]
name = "runs"
unit = "mdxb"
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
[[station]]
name = "waits"
unit = "mdxb"
[station.parameters]
P101 = 3
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
)";

class Orders : public Serving {
 protected:
  Orders() : Serving(plant_of(kOrders)) {}
};

TEST_F(Orders, AreWhatADriveShouldDo) {
  for (const Json event = topic({{"topic", "plant"}}); const auto& [name, state] : event["stations"].items())
    EXPECT_EQ(state["ordered"], false) << name << " before the first millisecond";
  step(10);
  const Json stations = topic({{"topic", "plant"}})["stations"];
  const auto facts = [&](const char* name) { return std::pair(stations[name]["ordered"], stations[name]["enabled"]); };
  EXPECT_EQ(facts("idle"), std::pair(Json(false), Json(false)));
  EXPECT_EQ(facts("inhibited"), std::pair(Json(true), Json(false)));
  EXPECT_EQ(facts("runs"), std::pair(Json(true), Json(true)));
  EXPECT_EQ(facts("waits"), std::pair(Json(true), Json(false))) << stations["waits"]["why"];
}

}  // namespace
}  // namespace ipos::tests
