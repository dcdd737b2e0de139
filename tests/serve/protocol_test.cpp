// The commands and topics of docs/reference/serve.md, without a network.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include "runtime/bus_plan/names.hpp"
#include "tests/serve/serving.hpp"
#include "tools/recording/trace.hpp"

namespace ipos::tests {
namespace {

// A master and a slave with two process data words; speeds count 0.2 rpm.
constexpr const char* kDpPlant = R"(
[[bus]]
name = "dp"
kind = "profibus"
baud = 500000
[[station]]
name = "pump"
unit = "mc31"
option = "size0"
profibus = "dp"
profibus_address = 9
)";
constexpr const char* kDpMaster = R"(
[[control]]
name = "plc"
profibus = "dp"
address = 1
[[control.slave]]
address = 9
cfg = "F1"
watchdog = "200ms"
po = [6, 2500]
)";

// A node and its master, which writes a mapping of its own.
constexpr const char* kCanopenPlant = R"(
[[bus]]
name = "can"
kind = "can"
baud = 500000
[[station]]
name = "belt"
unit = "mdxb"
sbus = "can"
[station.parameters]
P880 = 1
P886 = 5
[[control]]
name = "plc"
kind = "canopen"
sbus = "can"
cycle = "10ms"
[[control.target]]
address = 5
po = [6, 5000, 0]
[[control.target.pdo]]
number = 2
transmit = true
map = ["PI3", "PI1"]
)";

// The rows of a PROFIBUS line by source, destination and destination access point.
class ServingDp : public Serving {
 protected:
  explicit ServingDp(const std::string& text = std::string(kDpPlant) + kDpMaster) : Serving(plant_of(text)) {}

  Json row(int source, int destination, const Json& dsap) {
    const Json event = topic({{"topic", "bus"}});
    for (const Json& one : event["rows"])
      if (one["source"] == source && one["destination"] == destination && one["dsap"] == dsap) return one;
    return {};
  }
};
class QuietDp : public ServingDp {
 protected:
  QuietDp() : ServingDp(kDpPlant) {}
};
class ServingCanopen : public Serving {
 protected:
  ServingCanopen() : Serving(plant_of(kCanopenPlant)) {}

  static runtime::Frame frame_of(const Json& json) {
    runtime::Frame frame;
    const std::string data = json["data"];
    frame.id = json["id"];
    frame.remote = json["remote"];
    frame.length = static_cast<uint8_t>(data.size() / 2);
    for (size_t n = 0; n < frame.length; ++n)
      frame.data[n] = static_cast<uint8_t>(std::stoi(data.substr(2 * n, 2), nullptr, 16));
    return frame;
  }
};
class DpAndSerial : public ServingDp {
 protected:
  DpAndSerial() : ServingDp(std::string("[[bus]]\nname = \"line1\"\nkind = \"rs485\"\n") + kDpPlant) {}
};

TEST_F(Serving, SaysHelloAndStandsAtZero) {
  page.post.sent.clear();
  page.come(2);
  const Json hello = page.event("hello");
  EXPECT_EQ(hello["protocol"], 1);
  EXPECT_EQ(hello["mode"], "plant");
  const Json time = page.event("time");
  EXPECT_EQ(time["us"], 0);
  EXPECT_EQ(time["running"], false);
}

TEST_F(Serving, MessagesThatMakeNoSenseAreAnsweredInWords) {
  EXPECT_EQ(page.say("{").value("error", ""), "a message is one JSON object");
  EXPECT_TRUE(page.say("[]")["re"].is_null());
  EXPECT_EQ(error({{"do", 5}}), "'do' must be a text");
  EXPECT_EQ(error(Json::object()), "'do' is missing");
  EXPECT_EQ(error({{"do", "dance"}}), "there is no command 'dance' here");
  EXPECT_EQ(error({{"do", "step"}, {"ms", 0.5}}), "'ms' must be a whole number");
  EXPECT_EQ(error({{"do", "step"}, {"ms", 18446744073709551615U}}), "'ms' must be 1 to 3600000");
  EXPECT_EQ(error({{"do", "speed"}, {"speed", -1}}), "'speed' must be 0 to 1000");
  EXPECT_EQ(error({{"do", "subscribe"}, {"topic", "weather"}}), "there is no topic 'weather' here");
  EXPECT_EQ(error({{"do", "parameters"}, {"station", "mill"}}), "there is no station 'mill', only saw, lift");
}

TEST_F(Serving, StepsAMillisecondAtATime) {
  EXPECT_EQ(step(1)["us"], 1000);
  EXPECT_EQ(step(9)["us"], 10'000);
  EXPECT_EQ(page.event("time")["us"], 10'000);
}

TEST_F(Serving, GoesBackInTimeWithAllThatWasDone) {
  step(3);
  good({{"do", "set"}, {"name", "saw.lCount"}, {"value", "1000"}});
  step(20);
  const int64_t then = value("saw.lCount");
  EXPECT_GT(then, 1000);
  step(50);
  const Json reply = good({{"do", "back"}, {"us", 23'000}});
  EXPECT_EQ(reply["us"], 23'000);
  EXPECT_EQ(page.event("time")["generation"], 2);
  EXPECT_EQ(value("saw.lCount"), then);
  good({{"do", "back"}, {"us", 2'000}});
  EXPECT_LT(value("saw.lCount"), 10);
  step(21);
  EXPECT_LT(value("saw.lCount"), 100) << "what was set later is gone";
  EXPECT_EQ(error({{"do", "back"}, {"us", 1'000'000}}), "that time is still to come");
}

TEST_F(Serving, RestartsAndDoesTheSameAgain) {
  step(100);
  const int64_t then = value("saw.lCount");
  good({{"do", "set"}, {"name", "saw.lCount"}, {"value", "-5"}});
  EXPECT_EQ(good({{"do", "restart"}})["us"], 0);
  step(100);
  EXPECT_EQ(value("saw.lCount"), then);
}

TEST_F(Serving, AnInputTurnsTheAxis) {
  Json saw = topic({{"topic", "plant"}})["stations"]["saw"];
  EXPECT_EQ(saw["in"], 1);
  EXPECT_EQ(saw["enabled"], false);
  EXPECT_FALSE(saw["why"].get<std::string>().empty());
  good({{"do", "analog"}, {"station", "saw"}, {"name", "AI1"}, {"value", "10 V"}});
  for (const char* name : {"DI01", "DI03"})
    good({{"do", "input"}, {"station", "saw"}, {"name", name}, {"action", "set"}, {"on", true}});
  step(3000);
  saw = topic({{"topic", "plant"}})["stations"]["saw"];
  EXPECT_EQ(saw["enabled"], true) << saw;
  EXPECT_EQ(saw["why"], "");
  EXPECT_GT(saw["speed"].get<double>(), 100);
  EXPECT_EQ(saw["analog"]["AI1"], "10.000 V");
}

TEST_F(Serving, WiresHoldTheirInputsAgainstAHandButNotAgainstForce) {
  step(2);
  EXPECT_EQ(error({{"do", "input"}, {"station", "lift"}, {"name", "DI05"}, {"action", "set"}, {"on", true}}),
            "DI05 of lift is held by a wire or a switch of the plant; force it");
  const int before = topic({{"topic", "plant"}})["stations"]["lift"]["in"].get<int>();
  const bool level = (before & 1 << 5) == 0;
  good({{"do", "input"}, {"station", "lift"}, {"name", "DI05"}, {"action", "force"}, {"on", level}});
  step(5);
  const Json lift = topic({{"topic", "plant"}})["stations"]["lift"];
  EXPECT_EQ(lift["in"].get<int>(), before ^ 1 << 5);
  EXPECT_EQ(lift["forced"], 1 << 5);
  good({{"do", "input"}, {"station", "lift"}, {"name", "DI05"}, {"action", "release"}});
  step(5);
  EXPECT_EQ(topic({{"topic", "plant"}})["stations"]["lift"]["in"].get<int>(), before);
}

TEST_F(Serving, APulseEndsByItself) {
  good(
      {{"do", "input"}, {"station", "saw"}, {"name", "DI02"}, {"action", "pulse"}, {"on", true}, {"ms", 10}});
  step(5);
  EXPECT_EQ(topic({{"topic", "plant"}})["stations"]["saw"]["in"], 5);
  step(10);
  EXPECT_EQ(topic({{"topic", "plant"}})["stations"]["saw"]["in"], 1);
}

TEST_F(Serving, MainsGoOffAndOn) {
  const auto saw = [&] { return topic({{"topic", "plant"}})["stations"]["saw"]; };
  EXPECT_EQ(saw()["mains"], true);
  EXPECT_EQ(error({{"do", "mains"}, {"station", "saw"}, {"on", true}}), "the mains are on");
  good({{"do", "mains"}, {"station", "saw"}, {"on", false}});
  EXPECT_EQ(error({{"do", "mains"}, {"station", "saw"}, {"on", false}}), "the mains are off");
  step(4'000);
  EXPECT_EQ(saw()["mains"], false);
  EXPECT_EQ(saw()["powered"], true) << "its 24 V stay";
  EXPECT_EQ(saw()["dc_link"], 0);
  EXPECT_EQ(saw()["state"], "not ready");
  good({{"do", "mains"}, {"station", "saw"}, {"on", true}});
  step(200);
  EXPECT_EQ(saw()["dc_link"], 560);
  EXPECT_NE(saw()["state"], "not ready");
  const std::string journal = topic({{"topic", "journal"}}).dump();
  for (const char* told : {"the mains are off", "the mains are back"}) EXPECT_NE(journal.find(told), std::string::npos) << journal;
}

// AO1 shows the speed as delivered; with P642 = 2 it is a current. At standstill both are 0.
TEST_F(Serving, AnalogOutputsAreShownAsTheyAreWired) {
  const Json described = good({{"do", "plant"}})["plant"]["stations"][0]["analog_outputs"];
  ASSERT_EQ(described.size(), 2U) << described;
  EXPECT_EQ(described[0]["name"], "AO1");
  EXPECT_EQ(described[0]["function"], "ACTUAL SPEED");
  step(5);
  EXPECT_EQ(topic({{"topic", "plant"}})["stations"]["saw"]["analog_outputs"]["AO1"], "0.00 V");
  good({{"do", "parameters.set"}, {"station", "saw"}, {"number", "P642"}, {"value", "3"}});
  step(5);
  EXPECT_EQ(topic({{"topic", "plant"}})["stations"]["saw"]["analog_outputs"]["AO1"], "4.00 mA") << "4 to 20 mA";
}

TEST_F(Serving, PowerGoesOffAndOn) {
  good({{"do", "power"}, {"station", "saw"}, {"on", false}});
  step(5);
  EXPECT_EQ(topic({{"topic", "plant"}})["stations"]["saw"]["powered"], false);
  EXPECT_EQ(error({{"do", "power"}, {"station", "saw"}, {"on", false}}), "it is off");
  good({{"do", "power"}, {"station", "lift"}, {"on", false}});
  EXPECT_EQ(step(100)["us"], 105'000) << "time passes with all units off";
  good({{"do", "power"}, {"station", "saw"}, {"on", true}});
  step(20);
  EXPECT_EQ(topic({{"topic", "plant"}})["stations"]["saw"]["powered"], true);
  EXPECT_LT(value("saw.lCount"), 6);
  const std::string journal = topic({{"topic", "journal"}}).dump();
  for (const char* told : {"the power is switched off", "the power is switched on"})
    EXPECT_NE(journal.find(told), std::string::npos) << journal;
}

TEST_F(Serving, CableCutsAndFaultsComeAndGo) {
  const Json description = good({{"do", "plant"}})["plant"];
  EXPECT_EQ(description["buses"][0]["stations"], Json({"saw", "lift"}));
  EXPECT_NE(description["buses"][0]["faults"].dump().find("\"cut\""), std::string::npos);
  EXPECT_EQ(description["wires"][0], (Json{{"from", "saw.DO01"}, {"to", "lift.DI05"}, {"invert", false}}));
  const Json cut{{"do", "fault"}, {"bus", "sbus"}, {"kind", "cut"}, {"station", "lift"}, {"on", true}};
  good(cut);
  EXPECT_EQ(error(cut), "this fault is there already");
  step(2);
  EXPECT_EQ(topic({{"topic", "plant"}})["buses"]["sbus"]["faults"].size(), 1U);
  Json repair = cut;
  repair["on"] = false;
  good(repair);
  step(2);
  EXPECT_EQ(topic({{"topic", "plant"}})["buses"]["sbus"]["faults"].size(), 0U);
  EXPECT_EQ(error(repair), "there is no such fault");
  EXPECT_EQ(error({{"do", "fault"}, {"bus", "sbus"}, {"kind", "cut"}, {"on", true}}),
            "'cut' needs a station");
  EXPECT_EQ(error({{"do", "fault"}, {"bus", "sbus"}, {"kind", "short"}, {"station", "saw"}, {"on", true}}),
            "'short' concerns the whole line, not one station");
  EXPECT_EQ(error({{"do", "fault"}, {"bus", "sbus"}, {"kind", "stuck"}, {"rate", 0.5}, {"on", true}}),
            "'stuck' lasts until it is ended: it has no rate");
  EXPECT_EQ(error({{"do", "fault"}, {"bus", "sbus"}, {"kind", "short"}, {"identifier", 5}, {"on", true}}),
            "'short' concerns the wires: it has no identifier");
  EXPECT_EQ(error({{"do", "fault"}, {"bus", "sbus"}, {"kind", "drop"}, {"rate", 0.0001}, {"on", true}}),
            "'rate' must be 0.001 to 1");
  EXPECT_EQ(error({{"do", "fault"}, {"bus", "sbus"}, {"kind", "parity"}, {"on", true}}),
            "there is no fault 'parity' of an SBus; there are drop, corrupt, delay, duplicate, terminator, "
            "cut, swap, "
            "short, stuck, length, baud");
  EXPECT_EQ(error({{"do", "fault"}, {"bus", "bus2"}, {"kind", "drop"}, {"on", true}}),
            "there is no line 'bus2', only sbus");
  good({{"do", "fault"},
        {"bus", "sbus"},
        {"kind", "drop"},
        {"identifier", 523},
        {"rate", 0.57},
        {"on", true}});
  EXPECT_EQ(topic({{"topic", "plant"}})["buses"]["sbus"]["faults"],
            Json::array({{{"kind", "drop"}, {"station", ""}, {"id", 523}, {"rate", 0.57}}}));
  EXPECT_NE(topic({{"topic", "journal"}}).dump().find("is cut"), std::string::npos);
}

TEST_F(Serving, WatchesSetsAndForcesVariables) {
  const Json found = good({{"do", "search"}, {"text", "ltab"}});
  EXPECT_EQ(found["total"], 3);
  EXPECT_EQ(found["groups"][0], "variables");
  EXPECT_EQ(good({{"do", "watch"}, {"names", {"saw.lTable", "saw.P130", "saw.DI00"}}})["names"].size(), 5U);
  step(20);
  const Json values = topic({{"topic", "watch"}})["values"];
  EXPECT_EQ(values["saw.P130"]["text"], "2.000");
  EXPECT_EQ(values["saw.DI00"]["value"], 1);
  good({{"do", "set"}, {"name", "saw.H300"}, {"value", "0x10"}});
  EXPECT_EQ(value("saw.H300"), 16);
  EXPECT_EQ(error({{"do", "set"}, {"name", "saw.H300"}, {"value", "4294967296"}}),
            "'4294967296' is no number of 32 bits; write it decimal or as 0x1F");
  good({{"do", "force"}, {"name", "saw.lCount"}, {"value", "7"}});
  step(50);
  EXPECT_LE(value("saw.lCount"), 8);
  EXPECT_EQ(good({{"do", "forced"}})["names"], Json({"saw.lCount"}));
  good({{"do", "release"}, {"name", "saw.lCount"}});
  step(50);
  EXPECT_GT(value("saw.lCount"), 9);
  EXPECT_EQ(error({{"do", "set"}, {"name", "saw.speed"}, {"value", "1"}}), "saw.speed cannot be set");
}

TEST_F(Serving, ParametersAreRefusedInTheDrivesWords) {
  const Json list = good({{"do", "parameters"}, {"station", "saw"}});
  const auto row = [&](const char* number) {
    for (const Json& parameter : list["parameters"])
      if (parameter["number"] == number) return parameter;
    return Json();
  };
  // 1053 1610 p. 71: P130 index 8470, 0 to 2000 s, factory setting 2 s.
  EXPECT_EQ(row("P130")["index"], 8470);
  EXPECT_EQ(row("P130")["default"], "2.000 s");
  EXPECT_EQ(row("P130")["least"], "0.000 s");
  EXPECT_EQ(row("P130")["most"], "2000.000 s");
  EXPECT_EQ(row("P130")["changed"], false);
  EXPECT_EQ(row("P130")["group"], "P13");
  EXPECT_EQ(row("P000")["access"], "RO");
  EXPECT_EQ(
      good({{"do", "parameters.set"}, {"station", "saw"}, {"number", "P130"}, {"value", "2500 ms"}})["text"],
      "2.500 s");
  const Json news = topic({{"topic", "parameters"}, {"station", "saw"}});
  EXPECT_EQ(news["values"]["8470"], (Json{{"value", 2500}, {"text", "2.500 s"}, {"changed", true}}));
  const Json refused =
      page.ask({{"do", "parameters.set"}, {"station", "saw"}, {"number", "P130"}, {"value", "3000 s"}});
  EXPECT_EQ(refused["refused"], true) << refused;
  EXPECT_EQ(refused["error"],
            "P130 Ramp t11 UP CW := 3000.000 s: parameter value too large (0.000 s..2000.000 s)");
  const Json compared = good({{"do", "parameters.compare"}, {"station", "saw"}, {"with", "lift"}});
  EXPECT_NE(compared["rows"].dump().find("\"P130\""), std::string::npos);
}

TEST_F(Serving, SavesAndLoadsFilesOfParam) {
  good({{"do", "parameters.set"}, {"station", "saw"}, {"number", "P130"}, {"value", "7 s"}});
  const std::string text = good({{"do", "parameters.save"}, {"station", "saw"}})["text"];
  EXPECT_NE(text.find("value = \"7.000 s\""), std::string::npos);
  good({{"do", "parameters.set"}, {"station", "saw"}, {"number", "P130"}, {"value", "1 s"}});
  EXPECT_EQ(good({{"do", "parameters.load"}, {"station", "saw"}, {"text", text}})["set"], 1);
  EXPECT_NE(topic({{"topic", "parameters"}, {"station", "saw"}})["values"]["8470"].dump().find("7.000 s"),
            std::string::npos);
  EXPECT_EQ(error({{"do", "parameters.load"}, {"station", "saw"}, {"text", "x = 1"}}).substr(0, 9),
            "the file:");
  EXPECT_EQ(error({{"do", "parameters.load"}, {"station", "lift"}, {"text", text}}),
            "the file is of unit md60a, lift is mdxb");
}

// The same digits as `ipos run --trace`: its recorder takes the samples of a plant that runs without a page.
TEST_F(Serving, TheCsvOfTheScopeIsThatOfARun) {
  const std::vector<std::string> names{"saw.speed", "saw.lCount", "saw.status", "lift.P008", "saw.DI00"};
  good({{"do", "scope"}, {"channels", names}});
  step(250);
  const std::unique_ptr<runtime::Plant> plant = the_plant()();
  tools::Recorder recorder(*plant, names);
  plant->run_until(250 * runtime::kMillisecond, [&](runtime::Time now) {
    recorder.sample(now);
    return true;
  });
  std::ostringstream wanted;
  write_csv(wanted, recorder.recording());
  EXPECT_EQ(good({{"do", "scope.csv"}})["csv"], wanted.str());
}

TEST_F(Serving, LongCsvComesInParts) {
  good({{"do", "scope"}, {"channels", {"saw.lCount"}}});
  step(12'000);
  good({{"do", "scope.csv"}});
  ASSERT_EQ(page.parts.size(), 3U);
  std::string whole;
  for (const Json& part : page.parts) whole += part["csv"].get<std::string>();
  EXPECT_EQ(std::count(whole.begin(), whole.end(), '\n'), 12'001);
  EXPECT_EQ(whole.substr(0, 19), "time_ms,saw.lCount\n");
  EXPECT_EQ(page.parts[0]["more"], true);
  EXPECT_FALSE(page.parts[2].contains("more"));
}

TEST_F(Serving, TheScopeTriggersOnAnEdgeWithPreTriggerAndStops) {
  good({{"do", "scope"},
        {"channels", {"saw.lCount"}},
        {"pre", 50},
        {"length_ms", 100},
        {"trigger", {{"kind", "edge"}, {"signal", "saw.H300"}, {"value", 3}, {"slope", "rising"}}}});
  EXPECT_EQ(good({{"do", "scope.arm"}, {"single", true}})["state"], "armed");
  step(80);
  good({{"do", "set"}, {"name", "saw.H300"}, {"value", "4"}});
  step(10);
  Json scope = topic({{"topic", "scope"}});
  EXPECT_EQ(scope["state"], "triggered");
  EXPECT_EQ(scope["trigger_us"], 81'000);
  step(500);
  scope = topic({{"topic", "scope"}});
  EXPECT_EQ(scope["state"], "done");
  EXPECT_EQ(scope["last_us"], 131'000);
  EXPECT_EQ(good({{"do", "scope.free"}})["state"], "free");
}

TEST_F(Serving, TheScopeTriggersOnALineOfTheProgramAndHaltsThePlant) {
  good({{"do", "scope"},
        {"trigger",
         {{"kind", "line"}, {"station", "saw"}, {"file", "SAW.IPC"}, {"line", 10}, {"stop", true}}}});
  good({{"do", "scope.arm"}});
  step(1000);
  EXPECT_LT(page.event("time")["us"].get<int64_t>(), 100'000);
  EXPECT_EQ(page.event("time")["stopped"]["reason"], "trigger");
}

TEST_F(Serving, AViewHasTheExtremesOfItsPoints) {
  good({{"do", "scope"}, {"channels", {"saw.lCount"}}});
  step(1000);
  page.ask({{"do", "scope.view"}, {"from_us", 0}, {"to_us", 1'000'000}, {"points", 10}});
  const std::string bytes = page.binary();
  ASSERT_EQ(bytes.size(), 32U + 10 * 2 * 4);
  EXPECT_EQ(bytes[0], 1);
  EXPECT_EQ(bytes[2], 2);
  uint32_t step_us = 0;
  std::memcpy(&step_us, bytes.data() + 16, 4);
  EXPECT_EQ(step_us, 100'000U);
  std::vector<float> values(20);
  std::memcpy(values.data(), bytes.data() + 32, 80);
  for (size_t n = 0; n + 2 < values.size(); n += 2)
    EXPECT_LE(values[n + 1], values[n + 2]) << "it only rises";
  EXPECT_LT(values[0], values[1]);
}

TEST_F(Serving, TelegramsAreCountedTracedAndSent) {
  good({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", 523}, {"data", "0102 0304"}});
  step(5);
  const Json rows = topic({{"topic", "bus"}})["rows"];
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0]["id"], 523);
  EXPECT_EQ(rows[0]["data"], "01020304");
  good({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", 523}, {"data", "01FF0304"}});
  step(5);
  EXPECT_EQ(topic({{"topic", "bus"}})["rows"][0]["changed"], Json({1}));
  const Json trace = good({{"do", "bus.trace"}, {"filter", "01FF"}})["frames"];
  ASSERT_EQ(trace.size(), 1U);
  EXPECT_EQ(trace[0]["n"], 2);
  good({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", 11}, {"data", "07"}});
  step(5);
  for (const char* known_by : {"sbus 11 ", " 00B "})
    EXPECT_EQ(good({{"do", "bus.trace"}, {"filter", known_by}})["frames"].size(), 1U) << known_by;
  EXPECT_EQ(error({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", 5000}, {"data", ""}}),
            "'identifier' must be 0 to 2047");
  EXPECT_EQ(error({{"do", "bus.send"}, {"bus", "sbus"}, {"id", 5}, {"data", "0"}}),
            "the last byte has one digit only");
}

// EN 50170 volume 2, DP: Set_Prm goes to access point 61, Slave_Diag to 60, Chk_Cfg to 62, from 62 of the master;
// Data_Exchange has none. A token is DC DA SA; SD2 has LE = 3 + data twice.
TEST_F(ServingDp, RowsByAddressesAndAccessPoints) {
  const Json plant = good({{"do", "plant"}})["plant"];
  EXPECT_EQ(plant["buses"][0]["kind"], "profibus");
  EXPECT_EQ(plant["buses"][0]["stations"].size(), 2U) << plant["buses"];
  EXPECT_EQ(plant["stations"][0]["lines"], Json({"dp"}));
  EXPECT_EQ(plant["controls"], Json::array({{{"name", "plc"}, {"bus", "dp"}}}));
  step(1500);
  const Json set_prm = row(1, 9, 61);
  EXPECT_EQ(set_prm["ssap"], 62) << set_prm;
  EXPECT_NE(set_prm["text"].get<std::string>().find("1 -> 9 Set_Prm"), std::string::npos);
  EXPECT_NE(row(1, 9, 62)["text"].get<std::string>().find("Chk_Cfg"), std::string::npos);
  EXPECT_NE(row(1, 9, 60)["text"].get<std::string>().find("Slave_Diag"), std::string::npos);
  const Json outputs = row(1, 9, nullptr);
  const std::string octets = outputs["data"];
  EXPECT_EQ(octets.substr(0, 12), "680707680901");
  EXPECT_EQ(octets.substr(14, 8), "000609C4");
  EXPECT_EQ(outputs["changed"], Json::array()) << "only the frame count turns";
  EXPECT_GT(outputs["count"], 20);
  EXPECT_GT(outputs["rate"], 20);
  EXPECT_NE(outputs["text"].get<std::string>().find("Data_Exchange"), std::string::npos);
  EXPECT_EQ(row(1, 1, nullptr)["data"], "DC0101");
  const Json line = topic({{"topic", "bus"}})["buses"]["dp"];
  EXPECT_GT(line["load"], 0);
  EXPECT_EQ(line["errors"], 0) << line;
  EXPECT_GT(topic({{"topic", "plant"}})["buses"]["dp"]["frames"], 40);
  const Json trace = good({{"do", "bus.trace"}, {"filter", "Chk_Cfg"}})["frames"];
  ASSERT_GE(trace.size(), 1U);
  EXPECT_EQ(trace[0]["dsap"], 62);
  EXPECT_EQ(good({{"do", "bus.decode"}, {"frames", {{{"bus", "dp"}, {"data", "DC 03 05"}}}}})["texts"],
            Json({"5 -> 3 token"}));
}

// Faults of a PROFIBUS line strike frames of one sender or of all.
TEST_F(ServingDp, FaultsComeAndGo) {
  const Json bus = good({{"do", "plant"}})["plant"]["buses"][0];
  EXPECT_EQ(bus["faults"], Json({"lost", "cut", "parity", "noise", "collision", "swap", "link", "card", "card_flash", "diagnosis", "terminator", "length", "baud"}));
  EXPECT_EQ(
      bus["fault_rules"]["cut"],
      (Json{{"text", "cuts a frame short"}, {"station", "may"}, {"rate", true}, {"identifier", false}}));
  const auto line = [&] { return topic({{"topic", "bus"}})["buses"]["dp"]; };
  step(1500);
  EXPECT_EQ(line()["errors"], 0);
  const Json parity{{"do", "fault"}, {"bus", "dp"}, {"kind", "parity"}, {"station", "pump"}, {"on", true}};
  good(parity);
  EXPECT_EQ(error(parity), "this fault is there already");
  step(100);
  EXPECT_EQ(topic({{"topic", "plant"}})["buses"]["dp"]["faults"],
            Json::array({{{"kind", "parity"}, {"station", "pump"}}}));
  EXPECT_GT(line()["errors"], 3);
  Json end = parity;
  end["on"] = false;
  good(end);
  EXPECT_EQ(error(end), "there is no such fault");
  step(10);
  const Json errors = line()["errors"];
  step(500);
  EXPECT_EQ(line()["errors"], errors);
  EXPECT_EQ(topic({{"topic", "plant"}})["buses"]["dp"]["faults"], Json::array());
  EXPECT_GT(row(1, 9, nullptr)["rate"], 20) << "data exchange goes on";
  // Lost frames of all: nobody hears anything.
  good({{"do", "fault"}, {"bus", "dp"}, {"kind", "lost"}, {"on", true}});
  step(10);
  const Json frames = line()["frames"];
  step(100);
  EXPECT_EQ(line()["frames"], frames);
  const std::string journal = topic({{"topic", "journal"}}).dump();
  EXPECT_NE(journal.find("the line turns a parity bit round"), std::string::npos);
  EXPECT_NE(journal.find("the line loses a frame"), std::string::npos);
}

TEST_F(ServingDp, AFaultIsNotThereBeforeItWasPlanted) {
  const auto faults = [&] { return topic({{"topic", "plant"}})["buses"]["dp"]["faults"]; };
  step(100);
  good({{"do", "fault"}, {"bus", "dp"}, {"kind", "noise"}, {"rate", 0.5}, {"on", true}});
  step(100);
  EXPECT_EQ(faults(), Json::array({{{"kind", "noise"}, {"station", ""}, {"rate", 0.5}}}));
  good({{"do", "back"}, {"us", 50'000}});
  EXPECT_EQ(faults(), Json::array());
}

TEST_F(DpAndSerial, WhatALineHasNotIsRefusedInWords) {
  const auto refused = [&](Json message) {
    message.update({{"do", "fault"}, {"on", true}});
    return error(message);
  };
  EXPECT_EQ(refused({{"bus", "dp"}, {"kind", "short"}}),
            "there is no fault 'short' of a PROFIBUS line; there are lost, cut, parity, noise, collision, swap, link, card, card_flash, diagnosis, "
            "terminator, length, baud");
  EXPECT_EQ(refused({{"bus", "dp"}, {"kind", "cut"}, {"identifier", 9}}),
            "'cut' strikes all frames of a sender: frames of a PROFIBUS line have no identifier");
  EXPECT_EQ(refused({{"bus", "dp"}, {"kind", "cut"}, {"station", "mill"}}), "there is no 'mill' on dp");
  EXPECT_EQ(refused({{"bus", "line1"}, {"kind", "link"}}),
            "there is no fault 'link' of a serial line; there are lost, cut, parity, noise, collision, swap, terminator, length, baud");
  EXPECT_EQ(refused({{"bus", "sbus"}, {"kind", "cut"}}), "there is no line 'sbus', only line1, dp");
  const Json answer = good({{"do", "plant"}});
  for (const Json& bus : answer["plant"]["buses"])
    if (bus["name"] == "line1") {
      EXPECT_EQ(bus["faults"], Json({"lost", "cut", "parity", "noise", "collision", "swap", "terminator", "length", "baud"}));
      EXPECT_EQ(bus["fault_rules"]["swap"]["station"], "must");
      EXPECT_EQ(bus["fault_rules"]["noise"]["rate"], true);
    }
}

// A fault of a serial line comes and goes, and the journal names it.
TEST_F(DpAndSerial, FaultsOfASerialLine) {
  Json noise{{"do", "fault"}, {"bus", "line1"}, {"kind", "noise"}, {"rate", 0.5}, {"on", true}};
  good(noise);
  EXPECT_EQ(topic({{"topic", "plant"}})["buses"]["line1"]["faults"], Json::array({{{"kind", "noise"}, {"station", ""}, {"rate", 0.5}}}));
  noise["on"] = false;
  good(noise);
  EXPECT_EQ(topic({{"topic", "plant"}})["buses"]["line1"]["faults"], Json::array());
}

// The same words as those of the tools that read a log of the line from its beginning.
TEST_F(ServingCanopen, TheTabBusHasTheWordsOfCanopen) {
  step(300);
  const Json frames = good({{"do", "bus.trace"}, {"limit", 1000}})["frames"];
  ASSERT_EQ(frames[0]["n"], 1);
  runtime::CanWords words(runtime::can_names(page.host.plant()));
  for (const Json& frame : frames) EXPECT_EQ(frame["text"], words.describe("can", frame_of(frame)).text);
  const auto row = [&](int id) {
    const Json rows = topic({{"topic", "bus"}})["rows"];
    const auto found = std::find_if(rows.begin(), rows.end(), [id](const Json& one) { return one["id"] == id; });
    return found == rows.end() ? std::string() : (*found)["text"].get<std::string>();
  };
  EXPECT_EQ(row(0x000), "000 NMT start -> belt");
  EXPECT_EQ(row(0x080), "080 SYNC");
  EXPECT_EQ(row(0x185).substr(0, 10), "185 TPDO1 ");
  EXPECT_NE(row(0x185).find("<- belt"), std::string::npos) << row(0x185);
  const std::string mapped = row(0x285);
  EXPECT_EQ(mapped.substr(0, 10), "285 TPDO2 ");
  EXPECT_LT(mapped.find("PI3"), mapped.find("PI1")) << mapped;
  EXPECT_FALSE(good({{"do", "bus.trace"}, {"filter", "SDO written 1A01h"}})["frames"].empty());
  // A question leaves nothing behind: were this heard, TPDO1 would have another identifier.
  const Json asked{{"do", "bus.decode"},
                   {"frames",
                    {{{"bus", "can"}, {"id", 0x605}, {"data", "2300180123010000"}},
                     {{"bus", "can"}, {"id", 0x585}, {"data", "6000180100000000"}}}}};
  EXPECT_EQ(good(asked)["texts"], Json({"605 SDO write 1800h:1 TPDO1 COB-ID = 00000123h -> belt",
                                        "585 SDO written 1800h:1 TPDO1 COB-ID <- belt"}));
  step(100);
  EXPECT_EQ(row(0x185).substr(0, 10), "185 TPDO1 ");
}

// FC 46h: a request, SDN high; 66h has the frame count bit. 09h + 20h + 49h = 72h.
TEST_F(QuietDp, FramesOfAHandAreAnsweredAndChangesAreThoseOfTheirData) {
  const auto send = [&](const char* data) {
    good({{"do", "bus.send"}, {"bus", "dp"}, {"data", data}});
    step(5);
  };
  send("68 05 05 68 7F 20 46 01 02 fcs 16");
  send("68 05 05 68 7F 20 66 01 03 fcs 16");
  const Json row_of_it = row(32, 127, nullptr);
  EXPECT_EQ(row_of_it["count"], 2) << row_of_it;
  EXPECT_EQ(row_of_it["changed"], Json({8})) << "neither the frame count nor the frame check";
  // It looks for the rate of the line first.
  for (int n = 0; n < 200 && row(9, 32, nullptr).is_null(); ++n) send("100920497216");
  EXPECT_NE(row(9, 32, nullptr)["text"].get<std::string>().find("slave"), std::string::npos);
  EXPECT_EQ(topic({{"topic", "bus"}})["buses"]["dp"]["errors"], 0);
  send("10 09 20 49 00 16");
  EXPECT_EQ(topic({{"topic", "bus"}})["buses"]["dp"]["errors"], 1);
  const Json trace = good({{"do", "bus.trace"}, {"filter", "void"}})["frames"];
  ASSERT_EQ(trace.size(), 1U);
  EXPECT_EQ(trace[0]["text"], "void, frame check sequence incorrect: 10 09 20 49 00 16");
  EXPECT_EQ(trace[0]["source"], nullptr);
  EXPECT_EQ(error({{"do", "bus.send"}, {"bus", "dp"}, {"data", "10 xx fcs 16"}}),
            "'10 xx fcs 16' are no octets; write for example \"10 08 02 49 fcs 16\"");
}

// The same frame goes out again when time has gone back and comes to it once more.
TEST_F(QuietDp, WhatAHandSentIsSentAgainWhenItsTimeComesAgain) {
  step(10);
  good({{"do", "bus.send"}, {"bus", "dp"}, {"data", "10 09 20 49 fcs 16"}});
  step(10);
  good({{"do", "back"}, {"us", 5'000}});
  EXPECT_EQ(row(32, 9, nullptr), Json());
  step(15);
  EXPECT_EQ(row(32, 9, nullptr), Json()) << "what was done later is gone";
  good({{"do", "restart"}});
  good({{"do", "bus.send"}, {"bus", "dp"}, {"data", "10 09 20 49 fcs 16"}});
  step(20);
  good({{"do", "back"}, {"us", 10'000}});
  EXPECT_EQ(row(32, 9, nullptr)["count"], 1);
}

TEST_F(Serving, BreakpointsStopTheRunAndStepsGoOn) {
  const Json point = good({{"do", "break.set"},
                           {"station", "saw"},
                           {"file", "SAW.IPC"},
                           {"line", 9},
                           {"condition", "lCount == 4"}});
  EXPECT_EQ(point["breakpoint"]["line"], 9);
  good({{"do", "run"}, {"speed", 0}});
  const Json time = page.event("time");
  EXPECT_EQ(time["running"], false);
  EXPECT_EQ(time["stopped"]["reason"], "breakpoint");
  EXPECT_EQ(time["stopped"]["line"], 9);
  EXPECT_EQ(value("saw.lCount"), 4);
  good({{"do", "program.step"}, {"station", "saw"}, {"kind", "over"}});
  EXPECT_EQ(page.event("time")["stopped"]["line"], 10);
  EXPECT_EQ(page.event("time")["stopped"]["cost"]["commands"], page.event("time")["stopped"]["cost"]["us"].get<int>() / 1000)
      << "a command a millisecond";
  good({{"do", "program.step"}, {"station", "saw"}, {"kind", "over"}, {"back", true}});
  EXPECT_EQ(page.event("time")["stopped"]["line"], 9);
  EXPECT_FALSE(page.event("time")["stopped"].contains("cost")) << "time went back";
  const Json program = topic({{"topic", "program"}, {"station", "saw"}});
  EXPECT_EQ(program["tasks"][0]["line"], 9);
  EXPECT_EQ(program["breakpoints"].size(), 1U);
  for (const int line : {8, 9, 10})
    EXPECT_NE(std::find(program["covered"]["SAW.IPC"].begin(), program["covered"]["SAW.IPC"].end(), line),
              program["covered"]["SAW.IPC"].end())
        << line;
  good({{"do", "break.clear"}, {"number", point["breakpoint"]["number"]}});
  EXPECT_EQ(good({{"do", "breaks"}})["breakpoints"].size(), 0U);
  EXPECT_EQ(error({{"do", "program"}, {"station", "lift"}}), "lift has no program");
}

TEST_F(Serving, TwoClientsSeeTheSame) {
  page.come(2);
  page.ask({{"do", "subscribe"}, {"topic", "plant"}}, 2);
  page.ask({{"do", "input"}, {"station", "saw"}, {"name", "DI02"}, {"on", true}}, 1);
  page.ask({{"do", "subscribe"}, {"topic", "plant"}}, 2);
  EXPECT_EQ(page.event("plant")["stations"]["saw"]["in"], 5);
}

}  // namespace
}  // namespace ipos::tests
