// The tabs of a plant one by one: what belongs to one client, one station, one run; and what a hand does at terminals.
#include <set>

#include "tests/serve/serving.hpp"

namespace ipos::tests {
namespace {

using tools::serve::WallClock;

// --- Watch ---

TEST_F(Serving, TheListOfAClientGoesWithIt) {
  page.come(2);
  page.ask({{"do", "watch"}, {"names", {"saw.H300"}}}, 2);
  page.post.waiting.push_back({MessageKind::Closed, 2, {}});
  page.come(2);  // another one with its number
  page.ask({{"do", "subscribe"}, {"topic", "watch"}}, 2);
  EXPECT_EQ(page.event("watch")["values"], Json::object());
}

TEST_F(Serving, WhatIsForcedStaysForcedBehindARestart) {
  good({{"do", "force"}, {"name", "saw.lCount"}, {"value", "7"}});
  step(5);
  good({{"do", "restart"}});
  EXPECT_EQ(good({{"do", "forced"}})["names"], Json::array({"saw.lCount"}));
  good({{"do", "release"}, {"name", "saw.lCount"}});
  EXPECT_EQ(good({{"do", "forced"}})["names"], Json::array());
  EXPECT_EQ(error({{"do", "release"}, {"name", "saw.lCount"}}), "saw.lCount is not forced");
}

TEST_F(Serving, ANewListSendsAllItsValues) {
  good({{"do", "watch"}, {"names", {"saw.H300"}}});
  good({{"do", "subscribe"}, {"topic", "watch"}, {"rate", 60}});
  good({{"do", "watch"}, {"names", {"saw.H300"}}});
  page.post.sent.clear();
  page.host.router().publish(WallClock::now() + std::chrono::hours(1), false);
  EXPECT_TRUE(page.event("watch")["values"].contains("saw.H300")) << "it has not changed";
}

TEST_F(Serving, ASearchCountsAlsoWhatItDoesNotShow) {
  const Json all = good({{"do", "search"}, {"text", "ltab"}});
  const Json one = good({{"do", "search"}, {"text", "ltab"}, {"limit", 1}});
  EXPECT_EQ(one["names"].size(), 1U);
  EXPECT_EQ(one["total"], all["names"].size());
}

// --- Parameters ---

// 1053 1610 p. 22: a value written over the fast service (volatile) is gone with the power.
TEST_F(Serving, ParametersAreKeptUnlessTheyAreVolatile) {
  const auto set = [&](const char* number, const char* value, Json more = Json::object()) {
    more.update({{"do", "parameters.set"}, {"station", "saw"}, {"number", number}, {"value", value}});
    good(more);
  };
  set("P130", "7 s");
  set("P131", "8 s", {{"volatile", true}});
  const auto text = [&](const char* index) {
    return topic({{"topic", "parameters"}, {"station", "saw"}})["values"][index]["text"];
  };
  EXPECT_EQ(text("8471"), "8.000 s");
  for (const bool on : {false, true}) {
    good({{"do", "power"}, {"station", "saw"}, {"on", on}});
    step(3000);
  }
  EXPECT_EQ(text("8470"), "7.000 s");
  EXPECT_EQ(text("8471"), "2.000 s") << "its factory setting";
}

// docs/guide/param.md: the lock comes off first, which is no row of the file.
TEST_F(Serving, TakingTheLockOffIsNotCounted) {
  const std::string text = good({{"do", "parameters.save"}, {"station", "saw"}})["text"];
  const auto load = [&] { return good({{"do", "parameters.load"}, {"station", "saw"}, {"text", text}}); };
  const Json before = load();
  EXPECT_EQ(before["set"], 0);
  good({{"do", "parameters.set"}, {"station", "saw"}, {"number", "P130"}, {"value", "7 s"}});
  good({{"do", "parameters.set"}, {"station", "saw"}, {"number", "P803"}, {"value", "ON"}});
  const Json after = load();
  EXPECT_EQ(after["set"].get<int>() + after["unchanged"].get<int>(), before["unchanged"]) << after;
  EXPECT_EQ(after["refused"], Json::array());
}

TEST_F(Serving, AComparisonHasWhatOnlyOneOfThemHas) {
  const auto count = [&](const char* one, const char* other, const char* side) {
    size_t found = 0;
    const Json reply = good({{"do", "parameters.compare"}, {"station", one}, {"with", other}});
    for (const Json& row : reply["rows"]) found += row[side].is_null() ? 1 : 0;
    return found;
  };
  EXPECT_GT(count("saw", "lift", "text"), 0U) << "MOVIDRIVE B has more";
  EXPECT_EQ(count("saw", "lift", "text"), count("lift", "saw", "with"));
}

// --- Scope ---

// An external fault (P601 = /EXT. ERROR) from the first millisecond on, at a terminal without voltage.
constexpr const char* kFaults =
    "[[station]]\nname = \"one\"\nunit = \"md60a\"\n[station.parameters]\nP601 = \"/EXT. ERROR\"\n[station.inputs]\n"
    "DI02 = 1\n[[station]]\nname = \"two\"\nunit = \"md60a\"\n[station.parameters]\nP601 = \"/EXT. ERROR\"\n"
    "[station.inputs]\nDI02 = 0\n";

class WithFaults : public Serving {
 protected:
  WithFaults() : Serving(plant_of(kFaults)) {}
  void arm(Json trigger) {
    trigger["kind"] = "fault";
    good({{"do", "scope"}, {"channels", {"one.speed"}}, {"trigger", trigger}});
    good({{"do", "scope.arm"}});
  }
  Json scope() { return topic({{"topic", "scope"}}); }
};

TEST_F(WithFaults, TheScopeWaitsForThatOfTheStationThatWasNamed) {
  arm({{"station", "one"}});
  step(50);
  EXPECT_EQ(topic({{"topic", "plant"}})["stations"]["two"]["fault"], 26);
  EXPECT_EQ(scope()["state"], "armed") << scope();
  good({{"do", "input"}, {"station", "one"}, {"name", "DI02"}, {"on", false}});
  step(50);
  EXPECT_EQ(scope()["state"], "triggered");
  EXPECT_EQ(scope()["trigger_text"], "one has fault F26");
}

TEST_F(WithFaults, AFaultIsNewAgainInANewRun) {
  arm(Json::object());
  step(50);
  EXPECT_EQ(scope()["trigger_text"], "two has fault F26");
  const Json at = scope()["trigger_us"];
  good({{"do", "restart"}});
  EXPECT_EQ(scope()["state"], "armed");
  step(50);
  EXPECT_EQ(scope()["state"], "triggered");
  EXPECT_EQ(scope()["trigger_us"], at);
}

TEST_F(Serving, TheScopeTriggersBelowAValueAndOnAFallingEdge) {
  const auto armed_with = [&](Json trigger) {
    trigger.update({{"signal", "saw.H300"}, {"value", 3}});
    good({{"do", "scope"}, {"channels", {"saw.lCount"}}, {"pre", 20}, {"length_ms", 100}, {"trigger", trigger}});
    good({{"do", "scope.arm"}, {"single", true}});
  };
  const auto set = [&](const char* value) {
    good({{"do", "set"}, {"name", "saw.H300"}, {"value", value}});
    step(2);
    return topic({{"topic", "scope"}})["state"];
  };
  set("9");
  armed_with({{"kind", "level"}, {"below", true}});
  EXPECT_EQ(set("8"), "armed");
  EXPECT_EQ(set("2"), "triggered");
  armed_with({{"kind", "edge"}, {"slope", "falling"}});
  EXPECT_EQ(set("1"), "armed") << "it has been below";
  EXPECT_EQ(set("9"), "armed") << "it rises";
  EXPECT_EQ(set("2"), "triggered");
  // 20 of 100 ms lie before the trigger, 80 behind it.
  const int64_t at = topic({{"topic", "scope"}})["trigger_us"];
  step(500);
  EXPECT_EQ(topic({{"topic", "scope"}})["last_us"], at + 80'000);
}

// --- Program ---

constexpr const char* kCalls =
    "long lCount;\nCount()\n{\n  lCount++;\n}\nmain()\n{\n  while (1)\n  {\n    Count();\n    _Wait(5);\n  }\n}\n";

class WithCalls : public Serving {
 protected:
  WithCalls() : Serving(made()) {}
  static tools::debug::MakePlant made() {
    compiler::CompileOptions options;
    options.unit = stdlib::find_unit("md60a");
    const auto image = compiler::compile("SAW.IPC", "", kCalls, options).image;
    return plant_of("[[station]]\nname = \"saw\"\nunit = \"md60a\"\nprogram = \"SAW.IPC\"\n", image);
  }
  Json place(const char* kind) {
    good({{"do", "program.step"}, {"station", "saw"}, {"kind", kind}});
    return page.event("time")["stopped"];
  }
};

TEST_F(WithCalls, AStepOutEndsBehindTheCall) {
  good({{"do", "break.set"}, {"station", "saw"}, {"file", "SAW.IPC"}, {"line", 4}});
  good({{"do", "run"}, {"speed", 0}});
  page.settle();
  ASSERT_EQ(page.event("time")["stopped"]["line"], 4) << page.event("time");
  EXPECT_EQ(place("out")["line"], 11);
}

TEST_F(WithCalls, AConditionIsTheLastThatWasGiven) {
  Json point{{"do", "break.set"}, {"station", "saw"}, {"file", "SAW.IPC"}, {"line", 4}, {"condition", "lCount == 3"}};
  good(point);
  point["condition"] = "lCount == 5";
  EXPECT_EQ(good(point)["breakpoint"]["condition"], "lCount == 5");
  EXPECT_EQ(good({{"do", "breaks"}})["breakpoints"].size(), 1U);
  good({{"do", "run"}, {"speed", 0}});
  page.settle();
  EXPECT_EQ(value("saw.lCount"), 5);
}

TEST_F(WithCalls, CoverageIsOfThisRun) {
  const auto covered = [&] { return topic({{"topic", "program"}, {"station", "saw"}})["covered"]; };
  EXPECT_EQ(covered(), Json::object());
  step(20);
  EXPECT_EQ(covered()["SAW.IPC"], Json({4, 5, 8, 10, 11})) << "5 is the way back";
  good({{"do", "restart"}});
  EXPECT_EQ(covered(), Json::object());
}

// --- Plant and journal ---

TEST_F(Serving, ATerminalHasOneVoltageOrOneCurrent) {
  const auto texts = [&](const char* value) {
    good({{"do", "analog"}, {"station", "saw"}, {"name", "AI1"}, {"value", value}});
    step(1);
    return topic({{"topic", "plant"}})["stations"]["saw"]["analog"]["AI1"];
  };
  EXPECT_EQ(texts("5 V"), "5.000 V");
  EXPECT_EQ(texts("12 mA"), "12.000 mA");
  EXPECT_EQ(texts("5 V"), "5.000 V");
}

TEST(OfAPlant, ASwitchHasNoEndWhereItGoesOnForEver) {
  ServedPage page(plant_of("[[station]]\nname = \"a\"\nunit = \"md60a\"\n[[switch]]\nstation = \"a\"\ninput = \"DI04\"\n"
                     "to = -5\n[[switch]]\nstation = \"a\"\ninput = \"DI05\"\nfrom = 7\n"));
  const Json switches = page.ask({{"do", "plant"}})["plant"]["switches"];
  ASSERT_EQ(switches.size(), 2U) << switches;
  EXPECT_TRUE(switches[0]["from"].is_null());
  EXPECT_EQ(switches[0]["to"], -5);
  EXPECT_EQ(switches[1]["from"], 7);
  EXPECT_TRUE(switches[1]["to"].is_null());
}

TEST(OfAPlant, AGatewayNamesTheDrivesThatDoNotAnswer) {
  ServedPage page(plant_of(R"(
[[bus]]
name = "dp"
kind = "profibus"
baud = 500000
[[bus]]
name = "sbus"
kind = "can"
baud = 500000
[[control]]
name = "plc"
profibus = "dp"
address = 1
[[control.slave]]
address = 10
cfg = "F3 F2"
watchdog = "200ms"
po = [6, 1500, 0]
[[station]]
name = "gateway"
unit = "gateway"
profibus = "dp"
profibus_address = 10
sbus = "sbus"
[[station]]
name = "pump"
unit = "mc07"
sbus = "sbus"
[station.parameters]
P813 = 2
)"));
  const auto gateway = [&] {
    page.ask({{"do", "subscribe"}, {"topic", "plant"}});
    return page.event("plant")["stations"]["gateway"];
  };
  page.ask({{"do", "step"}, {"ms", 2000}});
  EXPECT_EQ(gateway()["why"], "") << gateway();
  page.ask({{"do", "power"}, {"station", "pump"}, {"on", false}});
  page.ask({{"do", "step"}, {"ms", 2000}});
  EXPECT_EQ(gateway()["why"], "no answer from the drives with SBus address 2");
}

TEST(OfAPlant, AStepToTheNextTelegramEndsThere) {
  ServedPage page(plant_of("[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n[[station]]\nname = \"belt\"\n"
                     "unit = \"mdxb\"\nsbus = \"can\"\n[station.parameters]\nP880 = 1\nP886 = 5\n[[control]]\n"
                     "name = \"plc\"\nkind = \"canopen\"\nsbus = \"can\"\ncycle = \"200ms\"\n[[control.target]]\n"
                     "address = 5\npo = [6, 5000, 0]\n"));
  page.ask({{"do", "step"}, {"ms", 1000}});
  const auto heard = [&] { return page.ask({{"do", "bus.trace"}, {"limit", 1000}})["frames"].size(); };
  for (int n = 0; n < 5; ++n) {
    const size_t before = heard();
    page.ask({{"do", "step"}, {"telegram", true}});
    const Json us = page.event("time")["us"];
    EXPECT_GT(heard(), before);
    const Json last = page.ask({{"do", "bus.trace"}, {"limit", 1}})["frames"][0];
    EXPECT_GT(last["us"].get<int64_t>(), us.get<int64_t>() - 1000) << "it came in the last millisecond";
  }
}

// The journal comes in parts of at most 500 and misses nothing.
TEST_F(Serving, ALongJournalComesWhole) {
  for (int n = 0; n < 400; ++n) {
    good({{"do", "power"}, {"station", "lift"}, {"on", n % 2 == 1}});
    step(1);
    good({{"do", "power"}, {"station", "saw"}, {"on", n % 2 == 1}});
    step(1);
  }
  const size_t all = page.host.plant().journal().entries().size();
  ASSERT_GT(all, 600U);
  std::vector<size_t> numbers;
  good({{"do", "subscribe"}, {"topic", "journal"}, {"rate", 60}});
  Json event = page.event("journal");
  EXPECT_EQ(event["entries"].size(), 500U);
  for (int n = 1; n < 10 && numbers.size() < all; ++n) {
    for (const Json& entry : event["entries"]) numbers.push_back(entry["n"]);
    page.post.sent.clear();
    page.host.router().publish(WallClock::now() + std::chrono::hours(n), false);
    event = page.event("journal");
  }
  ASSERT_EQ(numbers.size(), all);
  for (size_t n = 0; n < all; ++n) EXPECT_EQ(numbers[n], n + 1);
}

// Each weight has its word; a line without terminators is told as a warning when the plant begins.
TEST(OfAPlant, TheJournalTellsWhatIsAWarningAndWhatAFault) {
  ServedPage page(plant_of(std::string(kFaults) + "[[bus]]\nname = \"wire\"\nkind = \"can\"\n[[control]]\nname = \"plc\"\n"
                                            "sbus = \"wire\"\n[[control.target]]\naddress = 7\npo = [6]\nevery = \"10ms\"\n"));
  page.ask({{"do", "step"}, {"ms", 3000}});
  page.ask({{"do", "subscribe"}, {"topic", "journal"}});
  const auto& entries = page.host.plant().journal().entries();
  const Json told = page.event("journal")["entries"];
  ASSERT_EQ(told.size(), entries.size());
  std::set<runtime::Weight> weights;
  for (size_t n = 0; n < entries.size(); ++n) {
    weights.insert(entries[n].weight);
    EXPECT_EQ(told[n]["weight"], entries[n].weight == runtime::Weight::Why       ? "why"
                                 : entries[n].weight == runtime::Weight::Warning ? "warning"
                                                                                 : "fault")
        << told[n];
  }
  EXPECT_TRUE(weights.contains(runtime::Weight::Warning)) << told;
  EXPECT_TRUE(weights.contains(runtime::Weight::Fault)) << told;
}

}  // namespace
}  // namespace ipos::tests
