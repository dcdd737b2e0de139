// The debug adapter in one process: requests and what they answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "tests/debug/plants.hpp"
#include "tools/debug/dap.hpp"
#include "tools/input/sources.hpp"

namespace ipos::tests {
namespace {

using namespace tools::debug;

class Dap : public ::testing::Test {
 protected:
  Json ask(const std::string& command, const Json& arguments = Json::object()) {
    server_.receive(
        Json{{"type", "request"}, {"seq", ++seq_}, {"command", command}, {"arguments", arguments}}.dump());
    while (server_.handle_next()) {
    }
    for (const Json& message : sent_)
      if (message["type"] == "response" && message["request_seq"] == seq_) return message;
    return nullptr;
  }
  Json last_stop() {
    for (size_t n = sent_.size(); n-- > 0;)
      if (sent_[n]["type"] == "event" && sent_[n]["event"] == "stopped") return sent_[n]["body"];
    return nullptr;
  }
  // After a stop the references begin anew.
  void references_again() {
    const int thread = ask("threads")["body"]["threads"][0]["id"];
    ask("scopes", {{"frameId", thread * 64}});
  }
  void launch() {
    ask("initialize");
    ASSERT_EQ(ask("launch", {{"program", "P1.IPC"}})["success"], true);
    ask("configurationDone");
  }

  std::vector<Json> sent_;
  int64_t seq_ = 0;
  static constexpr const char* kText =
      "\nlong lFirst;\nlong aTable[3];\nmain()\n{\n  lFirst = 5;\n  aTable[1] = lFirst;\n"
      "  lFirst = 6;\n  while (1) {}\n}\n";
  MakePlant plant_ = plant_of({kText});
  DapServer server_{[this](const DapLaunch&) { return plant_; },
                    [this](const Json& message) { sent_.push_back(message); }, nullptr};
};

TEST_F(Dap, BreakpointsStepsAndStepsBack) {
  launch();
  EXPECT_EQ(last_stop()["reason"], "entry");
  const Json set = ask("setBreakpoints",
                       {{"source", {{"path", "P1.IPC"}}}, {"breakpoints", Json::array({Json{{"line", 7}}})}});
  EXPECT_EQ(set["body"]["breakpoints"][0]["verified"], true);
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  ask("continue", {{"threadId", thread}});
  EXPECT_EQ(last_stop()["reason"], "breakpoint");
  const auto line = [&] {
    return ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0]["line"].get<int>();
  };
  EXPECT_EQ(line(), 7);
  ask("next", {{"threadId", thread}});
  EXPECT_EQ(line(), 8);
  ask("stepBack", {{"threadId", thread}});
  EXPECT_EQ(line(), 7);
  ask("stepBack", {{"threadId", thread}});
  EXPECT_EQ(line(), 6);
}

TEST_F(Dap, ScopesShowAndSetValues) {
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  const int frame = ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0]["id"];
  const Json scopes = ask("scopes", {{"frameId", frame}})["body"]["scopes"];
  std::vector<std::string> names;
  for (const Json& scope : scopes) names.push_back(scope["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"Variables", "H", "Parameters", "Inputs and outputs",
                                             "Process data", "SBus objects"}));
  for (const Json& scope : scopes)
    EXPECT_EQ(ask("variables", {{"variablesReference", scope["variablesReference"]}})["success"], true);
  const Json named = scopes[0]["variablesReference"];
  EXPECT_TRUE(ask("setVariable",
                  {{"variablesReference", named}, {"name", "lFirst"}, {"value", "40 + 2"}})["success"]);
  EXPECT_EQ(ask("evaluate", {{"expression", "lFirst"}, {"frameId", frame}})["body"]["result"], "42");
  EXPECT_EQ(ask("evaluate", {{"expression", "lNobody"}, {"frameId", frame}})["success"], false);
  const Json few = ask(
      "variables", {{"variablesReference", scopes[1]["variablesReference"]}, {"start", 10}, {"count", 2}});
  EXPECT_EQ(few["body"]["variables"].size(), 2U);
  EXPECT_EQ(few["body"]["variables"][0]["name"], "H10");
}

TEST_F(Dap, ACursorInAWordIsCompleted) {
  launch();
  const Json targets = ask("completions", {{"text", "1 + lFi"}, {"column", 8}})["body"]["targets"];
  ASSERT_EQ(targets.size(), 1U);
  EXPECT_EQ(targets[0]["label"], "lFirst");
  EXPECT_EQ(targets[0]["start"], 5);  // from 1, as `column`
  EXPECT_EQ(targets[0]["length"], 3);
}

TEST_F(Dap, ARestartIsAtPowerOnAgain) {
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  ask("next", {{"threadId", thread}});
  ask("next", {{"threadId", thread}});
  EXPECT_EQ(ask("evaluate", {{"expression", "lFirst"}})["body"]["result"], "5");
  EXPECT_TRUE(ask("restart")["success"]);
  EXPECT_EQ(last_stop()["reason"], "entry");
  EXPECT_EQ(last_stop()["description"], "entry at 0.000 ms");
  EXPECT_EQ(ask("evaluate", {{"expression", "lFirst"}})["body"]["result"], "0");
}

// A structure, a cyclic telegram each 5 ms, and after 100 ms a watchdog that runs out.
class DapOfAPlant : public Dap {
 protected:
  DapOfAPlant() {
    const std::string text =
        "#include <constb.h>\ntypedef struct { long target; long speed[2]; } Axis;\nAxis left;\nSCTRCYCL "
        "Tr;\n"
        "main()\n{\n  left.target = 7;\n  Tr.ObjectNo = 1034;\n  Tr.CycleTime = 5;\n  Tr.Format = 4;\n"
        "  Tr.DPointer = numof(left);\n  _SBusCommDef(SCD_TRCYCL, Tr);\n  _SBusCommOn();\n  _Wait(100);\n"
        "  _WdOn(10);\n  while (1) {}\n}\n";
    plant_ = [text] {
      compiler::CompileOptions options;
      options.unit = stdlib::find_unit("mdxb");
      std::vector<std::optional<vm::Image>> images;
      for (int n = 0; n < 2; ++n) images.push_back(compiler::compile("P1.IPC", "", text, options).image);
      images[1].reset();
      std::vector<runtime::PlantError> errors;
      return std::make_unique<runtime::Plant>(
          runtime::read_plant_file("[[bus]]\nname = \"sbus\"\nkind = \"can\"\nbaud = 500000\n"
                                   "[[station]]\nname = \"unit1\"\nunit = \"mdxb\"\nprogram = \"P1.IPC\"\n"
                                   "sbus = \"sbus\"\n"
                                   "[[station]]\nname = \"unit2\"\nunit = \"mdxb\"\nsbus = \"sbus\"\n"
                                   "[station.parameters]\nP881 = 2\n")
              .plant,
          images, std::nullopt, errors);
    };
  }
};

TEST_F(DapOfAPlant, StructuresExpand) {
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  const int frame = ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0]["id"];
  const Json named = ask("scopes", {{"frameId", frame}})["body"]["scopes"][0]["variablesReference"];
  Json left;
  const Json variables = ask("variables", {{"variablesReference", named}})["body"]["variables"];
  for (const Json& one : variables)
    if (one["name"] == "left") left = one["variablesReference"];
  ASSERT_FALSE(left.is_null());
  const Json members = ask("variables", {{"variablesReference", left}})["body"]["variables"];
  ASSERT_EQ(members.size(), 2U) << members;
  EXPECT_EQ(members[0]["name"], "target");
  EXPECT_EQ(members[0]["evaluateName"], "left.target");
  EXPECT_EQ(members[1]["name"], "speed");
  EXPECT_EQ(members[1]["indexedVariables"], 2);
  EXPECT_TRUE(
      ask("setVariable", {{"variablesReference", left}, {"name", "target"}, {"value", "9"}})["success"]);
  EXPECT_EQ(ask("evaluate", {{"expression", "left.target"}})["body"]["result"], "9");
}

TEST_F(DapOfAPlant, AFrameStopsThePlant) {
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  EXPECT_EQ(ask("setFunctionBreakpoints", {{"breakpoints", {{{"name", "sbus 40A#*"}}}}})["success"], true);
  ask("continue", {{"threadId", thread}});
  EXPECT_EQ(last_stop()["reason"], "function breakpoint");
  const Json others = ask("setFunctionBreakpoints", {{"breakpoints", {{{"name", ""}}, {{"name", "???"}}, {{"name", "*"}},
                                                                      {{"name", "sbus hello"}}}}})["body"]["breakpoints"];
  for (const Json& one : others) EXPECT_EQ(one["verified"], false) << one;
  EXPECT_EQ(last_stop()["text"].get<std::string>().substr(0, 4), "40A#");
}

// Of the program: 4 is "main()", 5 "{", 6 to 8 have commands.
TEST_F(Dap, BreakpointLocationsAreTheLinesWithCommands) {
  launch();
  const Json asked = ask("breakpointLocations", {{"source", {{"path", "P1.IPC"}}}, {"line", 4}, {"endLine", 8}})["body"]["breakpoints"];
  std::vector<int> lines;
  for (const Json& one : asked) lines.push_back(one["line"]);
  EXPECT_EQ(lines, (std::vector<int>{6, 7, 8}));
  EXPECT_EQ(ask("breakpointLocations", {{"source", {{"path", "P1.IPC"}}}, {"line", 5}})["body"]["breakpoints"].size(), 0U);
  EXPECT_EQ(ask("breakpointLocations", {{"source", {{"path", "OTHER.IPC"}}}, {"line", 6}})["body"]["breakpoints"].size(), 0U);
}

// 5 and 0x04030201, the lowest byte first, in base64.
TEST_F(Dap, MemoryIsReadFromAVariable) {
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  const int frame = ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0]["id"];
  const Json named = ask("scopes", {{"frameId", frame}})["body"]["scopes"][0]["variablesReference"];
  ask("setVariable", {{"variablesReference", named}, {"name", "lFirst"}, {"value", "5"}});
  ask("evaluate", {{"expression", "aTable[0] = 0x04030201"}, {"frameId", frame}, {"context", "repl"}});
  const Json variables = ask("variables", {{"variablesReference", named}})["body"]["variables"];
  const auto first = std::find_if(variables.begin(), variables.end(), [](const Json& one) { return one["name"] == "lFirst"; });
  ASSERT_NE(first, variables.end());
  const Json memory = ask("readMemory", {{"memoryReference", (*first)["memoryReference"]}, {"count", 8}})["body"];
  EXPECT_EQ(memory["data"], "BQAAAAECAwQ=");
  EXPECT_EQ(memory["unreadableBytes"], 0);
  EXPECT_EQ(ask("readMemory", {{"memoryReference", (*first)["memoryReference"]}, {"offset", 5}, {"count", 2}})["body"]["data"], "AgM=");
  EXPECT_EQ(ask("readMemory", {{"memoryReference", "0:H1023"}, {"count", 6}})["body"]["unreadableBytes"], 2);
  for (const char* wrong : {"", "H420", "9:H420", "0:H1024", "0:H1x", "0:H-1"})
    EXPECT_EQ(ask("readMemory", {{"memoryReference", wrong}, {"count", 4}})["success"], false) << wrong;
}

TEST_F(Dap, AFaultTellsWhatItIs) {
  plant_ = plant_of({"long a, b;\nmain()\n{\n  a = 1 / b;\n}\n"});
  launch();
  EXPECT_EQ(ask("exceptionInfo", {{"threadId", 1}})["success"], false);
  ask("continue");
  EXPECT_EQ(last_stop()["reason"], "exception");
  const Json info = ask("exceptionInfo", {{"threadId", 1}})["body"];
  EXPECT_EQ(info["exceptionId"], "F10") << info;
  EXPECT_NE(info["description"].get<std::string>().find("division by zero"), std::string::npos) << info;
}

// What no file has: the editor asks for its text.
TEST_F(Dap, ABlockIsShownByItsText) {
  plant_ = plant_of({"#include <blocks/edge.h>\nmain()\n{\n  StepEdge();\n  while (1) {}\n}\n"});
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  ask("setFunctionBreakpoints", {{"breakpoints", {{{"name", "StepEdge"}}}}});
  ask("continue", {{"threadId", thread}});
  const Json source = ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0]["source"];
  EXPECT_EQ(source["name"], "blocks/edge.h");
  const Json text = ask("source", {{"source", source}, {"sourceReference", source["sourceReference"]}})["body"]["content"];
  EXPECT_EQ(text.get<std::string>().find("// blocks/edge.h:"), 0U);
  EXPECT_EQ(ask("setBreakpoints", {{"source", source}, {"breakpoints", Json::array({Json{{"line", 23}}})}})["body"]["breakpoints"][0]["verified"], true);
  EXPECT_EQ(ask("source", {{"sourceReference", 0}})["success"], false);
  EXPECT_EQ(ask("source", {{"sourceReference", 1000}})["success"], false);
}

// Line 7, aTable[1] = lFirst, is left out; what was skipped stays skipped when the moment comes again.
TEST_F(Dap, AStatementIsSetAsTheNextOne) {
  tools::keep_source("P1.IPC", kText);
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  const auto targets = [&](int line) {
    return ask("gotoTargets", {{"source", {{"path", "P1.IPC"}}}, {"line", line}})["body"]["targets"];
  };
  const auto line = [&] { return ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0]["line"].get<int>(); };
  EXPECT_EQ(targets(5).size(), 0U);
  Json at = targets(8);
  ASSERT_EQ(at.size(), 1U);
  EXPECT_EQ(at[0]["label"], "unit1 main");
  const Json early = ask("goto", {{"threadId", thread}, {"targetId", at[0]["id"]}});
  EXPECT_EQ(early["message"], "nothing of that program has been executed yet");
  ask("next", {{"threadId", thread}});  // to the first command
  ask("next", {{"threadId", thread}});
  EXPECT_EQ(line(), 7);
  EXPECT_EQ(ask("goto", {{"threadId", thread}, {"targetId", at[0]["id"]}})["success"], false) << "that was before the stop";
  at = targets(8);
  EXPECT_EQ(ask("goto", {{"threadId", thread}, {"targetId", at[0]["id"]}})["success"], true);
  EXPECT_EQ(last_stop()["reason"], "goto");
  EXPECT_EQ(line(), 8);
  ask("next", {{"threadId", thread}});
  EXPECT_EQ(line(), 9);
  EXPECT_EQ(ask("evaluate", {{"expression", "lFirst"}})["body"]["result"], "6");
  EXPECT_EQ(ask("evaluate", {{"expression", "aTable[1]"}})["body"]["result"], "0");
  ask("stepBack", {{"threadId", thread}});
  EXPECT_EQ(line(), 8);
  EXPECT_EQ(ask("evaluate", {{"expression", "lFirst"}})["body"]["result"], "5");
  ask("next", {{"threadId", thread}});
  EXPECT_EQ(ask("evaluate", {{"expression", "aTable[1]"}})["body"]["result"], "0");
  ask("goto", {{"threadId", thread}, {"targetId", targets(6)[0]["id"]}});
  ask("next", {{"threadId", thread}});
  ask("next", {{"threadId", thread}});
  EXPECT_EQ(ask("evaluate", {{"expression", "aTable[1]"}})["body"]["result"], "5") << "backward is a jump, too";
}

TEST_F(Dap, AJumpIsRefusedWithItsReason) {
  const std::string text =
      "long a, b, t[9], i;\nOther()\n{\n  a = 7;\n}\nmain()\n{\n  a = (a + b) *\n      (b - 3);\n  Other();\n  _Wait(5);\n"
                     "  for (i = 0; i < 9; i++)\n  {\n    a = t[i] + 1;\n    t[i] = a;\n  }\n  b = 1;\n  while (1) {}\n}\n";
  plant_ = plant_of({text});
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  const auto targets = [&](int line) {
    return ask("gotoTargets", {{"source", {{"path", "P1.IPC"}}}, {"line", line}})["body"]["targets"];
  };
  const auto refusal = [&](int line) {
    return ask("goto", {{"threadId", thread}, {"targetId", targets(line)[0]["id"]}}).value("message", "");
  };
  tools::keep_source("P1.IPC", text);
  ask("next", {{"threadId", thread}});  // line 9, which goes on with the statement of line 8
  EXPECT_EQ(targets(9).size(), 0U);
  EXPECT_EQ(refusal(4), "P1.IPC:4 is in Other, and unit1 task 1 stands in main: a jump leaves no function");
  EXPECT_EQ(refusal(17), "");
  EXPECT_EQ(refusal(11), "");
  ask("next", {{"threadId", thread}, {"granularity", "instruction"}});
  EXPECT_EQ(ask("goto", {{"threadId", thread}, {"targetId", 999}}).value("message", ""), "there is no such target");
  EXPECT_EQ(ask("goto", {{"threadId", 77}, {"targetId", 1}})["success"], false);
}

// A variable without a name in the program is one of the compiler: line 7 reads what line 6 has put there, line 8 does not.
TEST_F(Dap, AJumpToWhatNeedsTheCodeBeforeItIsRefused) {
  tools::keep_source("P1.IPC", kText);
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit("mdxb");
  vm::Image image = *compiler::compile("P1.IPC", "", kText, options).image;
  std::erase_if(image.symbols, [](const vm::Symbol& symbol) { return symbol.name == "lFirst"; });
  plant_ = [image] {
    std::vector<runtime::PlantError> errors;
    std::vector<std::optional<vm::Image>> images{image};
    return std::make_unique<runtime::Plant>(
        runtime::read_plant_file("[[station]]\nname = \"unit1\"\nunit = \"mdxb\"\nprogram = \"P1.IPC\"\n").plant, images, std::nullopt, errors);
  };
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  ask("next", {{"threadId", thread}});
  const auto jump = [&](int line) {
    const Json targets = ask("gotoTargets", {{"source", {{"path", "P1.IPC"}}}, {"line", line}})["body"]["targets"];
    return ask("goto", {{"threadId", thread}, {"targetId", targets[0]["id"]}}).value("message", "");
  };
  EXPECT_EQ(jump(7), "P1.IPC:7 goes on with H420, which the code before it computes");
  EXPECT_EQ(jump(8), "");
}

// Of the two statements before, the first wrote it; the plant stays where it stands, and references stay good.
TEST_F(Dap, TheConsoleTellsTheLastWriter) {
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  for (int n = 0; n < 3; ++n) ask("next", {{"threadId", thread}});  // to the first command, and behind two
  const int frame = ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0]["id"];
  const Json named = ask("scopes", {{"frameId", frame}})["body"]["scopes"][0]["variablesReference"];
  const size_t sent = sent_.size();
  const auto who = [&](const std::string& name) {
    return ask("evaluate", {{"expression", "who " + name}, {"frameId", frame}, {"context", "repl"}});
  };
  EXPECT_EQ(who("lFirst")["body"]["result"].get<std::string>().find("lFirst: 0 -> 5 by unit1 task 1, main at P1.IPC:6 ("), 0U);
  EXPECT_EQ(who("aTable[1]")["body"]["result"].get<std::string>().find("aTable[1]: 0 -> 5 by unit1 task 1, main at P1.IPC:7 ("), 0U);
  EXPECT_EQ(who("aTable[2]")["body"]["result"], "nobody has changed aTable[2] = 0 so far");
  EXPECT_EQ(who("lNobody")["success"], false);
  EXPECT_EQ(sent_.size(), sent + 4) << "a response each, and no stop";
  // The same of a variable in its list, and where a menu asks for its breakpoint.
  const auto of_list = [&](const char* command, const char* name) {
    return ask(command, {{"variablesReference", named}, {"name", name}})["body"];
  };
  EXPECT_EQ(of_list("who", "lFirst")["result"], who("lFirst")["body"]["result"]);
  const Json info = of_list("dataBreakpointInfo", "lFirst");
  EXPECT_FALSE(info["dataId"].is_null());
  EXPECT_EQ(info["description"].get<std::string>().find("unit1.lFirst (lFirst: 0 -> 5 by unit1 task 1, main at P1.IPC:6 ("), 0U) << info;
  EXPECT_EQ(of_list("dataBreakpointInfo", "aTable[2]")["description"], "unit1.aTable[2] (nobody has changed aTable[2] = 0 so far)");
  EXPECT_EQ(ask("who", {{"name", "lNobody"}})["success"], false);
  EXPECT_EQ(ask("setDataBreakpoints", {{"breakpoints", {{{"dataId", info["dataId"]}}}}})["body"]["breakpoints"][0]["verified"], true);
  EXPECT_EQ(ask("variables", {{"variablesReference", named}})["success"], true);
  EXPECT_EQ(ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0]["line"], 8);
  EXPECT_EQ(ask("evaluate", {{"expression", "who lFirst"}, {"context", "watch"}})["success"], false) << "the console alone";
}

// A command a millisecond, a command a statement.
TEST_F(Dap, TheCostSinceTheStopBeforeIsTold) {
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  const auto cost = [&] {
    return ask("evaluate", {{"expression", "info cost"}, {"context", "repl"}})["body"]["result"].get<std::string>();
  };
  EXPECT_EQ(cost(), "nothing has run since the session began");
  ask("next", {{"threadId", thread}});
  ask("next", {{"threadId", thread}});
  EXPECT_EQ(cost(), "1.000 ms since the stop before\n  unit1 task 1: 1 commands");
  EXPECT_NE(last_stop()["description"].get<std::string>().find(" ms, 1 commands later"), std::string::npos) << last_stop();
  ask("stepBack", {{"threadId", thread}});
  EXPECT_EQ(cost(), "time went back to this stop");
  EXPECT_EQ(last_stop()["description"].get<std::string>().find("later"), std::string::npos) << last_stop();
}

// The object is sent each 5 ms, so the third frame comes 10 ms behind the first.
TEST_F(DapOfAPlant, AFrameStopsThePlantAtItsHitsAndWhereItsConditionHolds) {
  launch();
  const auto stops_at = [&](const Json& point) {
    ask("restart");
    ask("setFunctionBreakpoints", {{"breakpoints", Json::array({point})}});
    ask("continue");
    EXPECT_EQ(last_stop()["reason"], "function breakpoint") << point;
    return std::stoi(ask("evaluate", {{"expression", "now"}})["body"]["result"].get<std::string>());
  };
  const int first = stops_at({{"name", "sbus 40A#*"}});
  EXPECT_EQ(stops_at({{"name", "sbus 40A#*"}, {"hitCondition", "== 3"}}), first + 10);
  EXPECT_EQ(stops_at({{"name", "sbus 40A#*"}, {"hitCondition", "%4"}}), first + 15);
  const int late = stops_at({{"name", "sbus 40A#*"}, {"condition", "now > 42"}});
  EXPECT_GT(late, 42);
  EXPECT_LE(late, 49);
  EXPECT_EQ((late - first) % 5, 0);
  stops_at({{"name", "sbus 40A#*"}, {"condition", "lNobody"}});
  EXPECT_NE(last_stop()["text"].get<std::string>().find("lNobody"), std::string::npos) << last_stop();
}

// Nobody receives what the program sends: told once, behind the response to launch or before it, at the line of the command.
TEST_F(DapOfAPlant, WhatTheProgramsOfAPlantSayTogetherIsTold) {
  launch();
  std::vector<Json> told;
  for (const Json& message : sent_)
    if (message.value("event", "") == "output" && message["body"]["output"].get<std::string>().find("[B28]") != std::string::npos)
      told.push_back(message["body"]);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0]["line"], 12) << told[0];
  EXPECT_EQ(told[0]["source"]["name"], "P1.IPC");
  EXPECT_EQ(told[0]["output"].get<std::string>().find("P1.IPC:12:3: warning: nobody on sbus receives object 40Ah (1034), which unit1 sends here"), 0U) << told[0];
}

TEST_F(Dap, SourcesOfAllProgramsAreListed) {
  launch();
  const Json sources = ask("loadedSources")["body"]["sources"];
  ASSERT_EQ(sources.size(), 1U);
  EXPECT_EQ(sources[0]["name"], "P1.IPC");
}

TEST_F(DapOfAPlant, AFaultOfADriveStopsThePlant) {
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  EXPECT_EQ(ask("setExceptionBreakpoints", {{"filters", {"fault"}}})["success"], true);
  ask("continue", {{"threadId", thread}});
  EXPECT_EQ(last_stop()["reason"], "exception");
  EXPECT_EQ(last_stop()["text"].get<std::string>().find("unit"), 0U) << last_stop();
}

TEST_F(Dap, InstructionsAreShownAndStoppedAt) {
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  const Json top = ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0];
  const Json code =
      ask("disassemble", {{"memoryReference", top["instructionPointerReference"]}, {"instructionCount", 4}});
  const Json second = code["body"]["instructions"][1];
  const Json set = ask("setInstructionBreakpoints",
                       {{"breakpoints", Json::array({Json{{"instructionReference", second["address"]}}})}});
  EXPECT_EQ(set["body"]["breakpoints"][0]["verified"], true);
  ask("continue", {{"threadId", thread}});
  EXPECT_EQ(
      ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0]["instructionPointerReference"],
      second["address"]);
}

// What comes with the order in one piece is behind it and counts.
TEST_F(Dap, APauseThatComesWithTheOrderPauses) {
  launch();
  const auto send = [&](const std::string& command) {
    server_.receive(Json{{"type", "request"}, {"seq", ++seq_}, {"command", command}}.dump());
  };
  for (const char* stops : {"pause", "terminate"}) {
    sent_.clear();
    send("continue");
    send(stops);
    while (server_.handle_next()) {
    }
    std::vector<std::string> answered;
    for (const Json& message : sent_)
      if (message["type"] == "response") answered.push_back(message["command"]);
    EXPECT_EQ(answered, (std::vector<std::string>{"continue", stops}));
    EXPECT_EQ(last_stop()["reason"], "pause");
  }
  EXPECT_EQ(sent_.back()["event"], "terminated");
  EXPECT_FALSE(server_.ended());
  EXPECT_TRUE(ask("disconnect")["success"]);
  EXPECT_TRUE(server_.ended());
}

// Behind an evaluation that waits for a stop a breakpoint still acts at once.
TEST_F(Dap, BreakpointsOvertakeWhatWaits) {
  launch();
  bool asked = false;
  server_.poll = [&] {
    if (std::exchange(asked, true)) return;
    server_.receive(Json{{"type", "request"}, {"seq", 900}, {"command", "evaluate"},
                         {"arguments", {{"expression", "lFirst"}}}}.dump());
    server_.receive(Json{{"type", "request"}, {"seq", 901}, {"command", "setBreakpoints"},
                         {"arguments", {{"source", {{"path", "P1.IPC"}}}, {"breakpoints", {{{"line", 9}}}}}}}
                        .dump());
  };
  ask("continue");
  EXPECT_EQ(last_stop()["reason"], "breakpoint");
  std::vector<int> order;
  for (const Json& message : sent_)
    if (message["type"] == "response" && message["request_seq"] >= 900) order.push_back(message["request_seq"]);
  EXPECT_EQ(order, (std::vector<int>{901, 900}));
}

TEST_F(Dap, AFunctionStopsByItsNameAndOtherTextsAreNotVerified) {
  plant_ = plant_of({"long n;\nmain()\n{\n  while (1) { work(); _Wait(1); }\n}\nwork()\n{\n  n++;\n}\n"});
  launch();
  const Json set = ask("setFunctionBreakpoints",
                       {{"breakpoints", {{{"name", "work"}, {"hitCondition", "%3"}},
                                         {{"name", ""}}, {{"name", "???"}}, {{"name", "nobody"}}, {{"name", "40A#*"}}}}});
  std::vector<bool> verified;
  for (const Json& one : set["body"]["breakpoints"]) verified.push_back(one["verified"]);
  EXPECT_EQ(verified, (std::vector<bool>{true, false, false, false, false})) << set;  // this plant has no bus
  for (const char* passed : {"2", "5", "8"}) {  // before the 3rd, 6th and 9th n++
    ask("continue");
    EXPECT_EQ(last_stop()["reason"], "breakpoint");
    EXPECT_EQ(ask("evaluate", {{"expression", "n"}})["body"]["result"], passed);
  }
  ask("setInstructionBreakpoints", {{"breakpoints", Json::array()}});  // leaves those of functions alone
  ask("continue");
  EXPECT_EQ(ask("evaluate", {{"expression", "n"}})["body"]["result"], "11");
}

TEST_F(Dap, ExpressionsHaveTheFormsOfTheLanguage) {
  launch();
  const auto value = [&](const std::string& expression) {
    const Json answer = ask("evaluate", {{"expression", expression}});
    return answer["success"] ? answer["body"]["result"].get<std::string>() : answer["message"].get<std::string>();
  };
  ask("evaluate", {{"expression", "aTable[1] = 7"}, {"context", "repl"}});
  EXPECT_EQ(value("0b101 + 0B1"), "6");
  EXPECT_EQ(value("numof(aTable[1]) - numof(aTable)"), "1");
  EXPECT_EQ(value("*numof(aTable[1])"), "7");
  EXPECT_EQ(value("5 * *(numof(aTable) + 1)"), "35");
  EXPECT_EQ(value("aTable"), "{0, 7, 0}");
  EXPECT_EQ(value("aTable[1],h"), "0x7");
  EXPECT_NE(value("aTable[3]").find("has 3 elements"), std::string::npos) << value("aTable[3]");
  EXPECT_NE(value("aTable + 1").find("is 3 variables"), std::string::npos) << value("aTable + 1");
  EXPECT_NE(value("0b102").find("no number"), std::string::npos);
  EXPECT_NE(value("numof(7)").find("'7'"), std::string::npos) << value("numof(7)");
  EXPECT_NE(value("*4711").find("no H4711"), std::string::npos);
}

// Every parameter takes what is shown of it, each in the form it is shown in.
TEST_F(Dap, ParametersTakeWhatIsShown) {
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  const int frame = ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0]["id"];
  const Json reference = ask("scopes", {{"frameId", frame}})["body"]["scopes"][2]["variablesReference"];
  size_t set = 0;
  for (const bool hex : {false, true}) {
    const Json all =
        ask("variables", {{"variablesReference", reference}, {"format", {{"hex", hex}}}})["body"]["variables"];
    EXPECT_GT(all.size(), 300U);
    for (const Json& one : all) {
      const Json answer = ask("setVariable", {{"variablesReference", reference}, {"name", one["name"]},
                                              {"value", one["value"]}, {"format", {{"hex", hex}}}});
      // What is refused is refused for what the parameter is (read only, inhibit), not for the form of the text.
      const std::string why = answer.value("message", "");
      EXPECT_EQ(why.find(" in '"), std::string::npos) << one << " " << why;
      if (answer["success"]) {
        EXPECT_EQ(answer["body"]["value"], one["value"]);
      }
      set += answer["success"].get<bool>();
    }
  }
  EXPECT_GT(set, 400U);
  const auto after = [&](const char* text) {
    return ask("setVariable", {{"variablesReference", reference}, {"name", "P130"}, {"value", text}})["body"]["value"];
  };
  EXPECT_EQ(after("2.5 s"), "2500 (2.500 s)");
  EXPECT_EQ(after("3000"), "3000 (3.000 s)");
  EXPECT_EQ(after("3000 (4.000 s)"), "4000 (4.000 s)");
  EXPECT_EQ(after("5000 (4.000 s)"), "5000 (5.000 s)");
}

TEST_F(Dap, LinesColumnsAndPathsAreThoseOfTheEditor) {
  ask("initialize", {{"linesStartAt1", false}, {"columnsStartAt1", false}, {"pathFormat", "uri"}});
  ask("launch", {{"program", "P1.IPC"}, {"stopOnEntry", false}});
  const std::string uri = "file://" + std::filesystem::absolute("P1.IPC").string();
  const Json set = ask("setBreakpoints",
                       {{"source", {{"path", uri}}}, {"breakpoints", Json::array({Json{{"line", 6}}})}});
  EXPECT_EQ(set["body"]["breakpoints"][0]["line"], 6) << set;
  ask("configurationDone");
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  const Json top = ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0];
  EXPECT_EQ(top["line"], 6);    // aTable[1] = lFirst;
  EXPECT_EQ(top["column"], 2);  // behind two blanks
  EXPECT_EQ(top["source"]["path"], uri);
  const Json targets = ask("completions", {{"text", "1 + lFi"}, {"column", 7}})["body"]["targets"];
  ASSERT_EQ(targets.size(), 1U);
  EXPECT_EQ(targets[0]["start"], 4);
}

// VS Code searches for the present command by halves.
TEST_F(DapOfAPlant, AddressesOfAViewRise) {
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  const Json here = ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0]["instructionPointerReference"];
  const auto addresses = [&](const Json& reference, int offset, int count) {
    const Json rows = ask("disassemble", {{"memoryReference", reference}, {"instructionOffset", offset},
                                          {"instructionCount", count}})["body"]["instructions"];
    std::vector<int64_t> all;
    for (const Json& row : rows) all.push_back(std::stoll(row["address"].get<std::string>()));
    return all;
  };
  const auto all = addresses(here, -200, 400);
  ASSERT_EQ(all.size(), 400U);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
  EXPECT_EQ(all[200], std::stoll(here.get<std::string>()));
  // What fills up has references, too: going on from one gives the same rows.
  const auto further = addresses(std::to_string(all[0]), 100, 200);
  EXPECT_EQ(further, std::vector<int64_t>(all.begin() + 100, all.begin() + 300));
  const auto behind = addresses(std::to_string(all[399]), -300, 200);
  EXPECT_EQ(behind, std::vector<int64_t>(all.begin() + 99, all.begin() + 299));
}

TEST_F(DapOfAPlant, WatchesOpenStructuresAndArrays) {
  launch();
  const int thread = ask("threads")["body"]["threads"][0]["id"];
  const Json scopes = ask("scopes", {{"frameId", ask("stackTrace", {{"threadId", thread}})["body"]["stackFrames"][0]["id"]}})["body"]["scopes"];
  const Json left = ask("evaluate", {{"expression", "left"}, {"context", "watch"}})["body"];
  EXPECT_EQ(left["result"], "{0, 0, 0}");
  const Json members = ask("variables", {{"variablesReference", left["variablesReference"]}})["body"]["variables"];
  ASSERT_EQ(members.size(), 2U);
  EXPECT_EQ(members[1]["name"], "speed");
  const Json speed = ask("evaluate", {{"expression", "unit1.left.speed"}, {"context", "hover"}})["body"];
  EXPECT_EQ(speed["indexedVariables"], 2);
  const auto children = [&](const Json& reference, const char* filter) {
    return ask("variables", {{"variablesReference", reference}, {"filter", filter}})["body"]["variables"].size();
  };
  EXPECT_EQ(children(speed["variablesReference"], "indexed"), 2U);
  EXPECT_EQ(children(speed["variablesReference"], "named"), 0U);
  EXPECT_EQ(children(scopes[1]["variablesReference"], "named"), 0U);
  EXPECT_EQ(children(scopes[1]["variablesReference"], "indexed"), 1024U);
  EXPECT_GT(children(scopes[0]["variablesReference"], "named"), 0U);
  EXPECT_EQ(children(scopes[0]["variablesReference"], "indexed"), 0U);
  // A member is watched by the name it has within its structure.
  EXPECT_FALSE(ask("dataBreakpointInfo", {{"variablesReference", left["variablesReference"]}, {"name", "target"}})
                   ["body"]["dataId"].is_null());
}

// An axis of a plant that is built anew each time: the signal is that of the present plant.
TEST_F(DapOfAPlant, AWatchedSignalSurvivesTheWayBack) {
  launch();
  const Json id = ask("dataBreakpointInfo", {{"name", "unit1.status"}})["body"]["dataId"];
  ASSERT_FALSE(id.is_null());
  const Json set = ask("setDataBreakpoints", {{"breakpoints", {{{"dataId", id}}, {{"dataId", "nonsense"}}, {{"dataId", "{}"}}}}});
  EXPECT_EQ(set["body"]["breakpoints"][0]["verified"], true) << set;
  EXPECT_EQ(set["body"]["breakpoints"][1]["verified"], false);
  EXPECT_EQ(set["body"]["breakpoints"][2]["verified"], false);
  ask("continue");
  EXPECT_TRUE(ask("reverseContinue")["success"]);
  EXPECT_TRUE(ask("evaluate", {{"expression", "unit1.status"}})["success"]);
}

// Nothing that a client may send brings a text of the libraries below to it.
TEST_F(DapOfAPlant, NoTextOfAnExceptionReachesTheClient) {
  launch();
  const Json values[] = {nullptr, true, -1, 1e99, "x", "99999999999999999999", "0xzz", Json::array({1}), {{"a", 1}}};
  for (const char* command :
       {"setBreakpoints", "setInstructionBreakpoints", "dataBreakpointInfo", "setDataBreakpoints",
        "setExceptionBreakpoints", "setFunctionBreakpoints", "stackTrace", "scopes", "variables", "setVariable",
        "setExpression", "evaluate", "completions", "disassemble", "next", "stepIn", "threads", "source",
        "breakpointLocations", "readMemory", "exceptionInfo", "who"})
    for (const char* key :
         {"source", "breakpoints", "name", "variablesReference", "filters", "threadId", "frameId", "start", "count",
          "value", "expression", "text", "column", "memoryReference", "instructionCount", "instructionOffset",
          "offset", "granularity", "format", "context", "line", "endLine", "count", "sourceReference"})
      for (const Json& value : values) {
        Json arguments{{"breakpoints", Json::array({Json{{"line", value}, {"instructionReference", value},
                                                         {"name", value}, {"dataId", value}}})},
                       {"name", "left"}, {"expression", "left"}, {"variablesReference", 1}, {"value", "1"},
                       {"source", {{"path", value}}}, {"memoryReference", "65536"}, {"instructionCount", 1}};
        arguments[key] = value;
        const Json answer = ask(command, arguments);
        const std::string why = answer.value("message", "");
        for (const char* part : {"json", "exception", "stoul", "stoi", "type_error", "std::", "basic_string", "vector", "map::at"})
          EXPECT_EQ(why.find(part), std::string::npos) << command << " " << key << " " << value << ": " << why;
        references_again();
      }
  EXPECT_TRUE(ask("threads")["success"]);
}

TEST_F(Dap, BadRequestsAreRefusedAndTheSessionGoesOn) {
  EXPECT_EQ(ask("threads")["success"], false);
  launch();
  for (const char* command :
       {"nonsense", "stackTrace", "scopes", "variables", "next", "disassemble", "setVariable"})
    EXPECT_EQ(ask(command)["success"], false) << command;
  EXPECT_EQ(ask("stackTrace", {{"threadId", 99}})["success"], false);
  EXPECT_EQ(ask("variables", {{"variablesReference", 4711}})["success"], false);
  server_.receive("no json");
  EXPECT_EQ(ask("threads")["success"], true);
}

}  // namespace
}  // namespace ipos::tests
