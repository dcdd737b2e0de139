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
  DapServer server_{
      [](const DapLaunch&) {
        return plant_of(
            {"\nlong lFirst;\nlong aTable[3];\nmain()\n{\n  lFirst = 5;\n  aTable[1] = lFirst;\n"
             "  lFirst = 6;\n  while (1) {}\n}\n"});
      },
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
