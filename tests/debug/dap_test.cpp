// The debug adapter in one process: requests and what they answer.
#include <gtest/gtest.h>

#include "tests/debug/plants.hpp"
#include "tools/debug/dap.hpp"

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
  void launch() {
    ask("initialize");
    ASSERT_EQ(ask("launch", {{"program", "P1.IPC"}})["success"], true);
    ask("configurationDone");
  }

  std::vector<Json> sent_;
  int64_t seq_ = 0;
  MakePlant plant_ =
      plant_of({"\nlong lFirst;\nlong aTable[3];\nmain()\n{\n  lFirst = 5;\n  aTable[1] = lFirst;\n"
                "  lFirst = 6;\n  while (1) {}\n}\n"});
  DapServer server_{[this](const DapLaunch&) { return plant_; },
                    [this](const Json& message) { sent_.push_back(message); }, false};
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
  EXPECT_EQ(targets[0]["start"], 4);
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
  EXPECT_EQ(last_stop()["text"].get<std::string>().substr(0, 4), "40A#");
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
