// What the server gives an editor to draw and to do: corrections, lenses, folds, hints, colours; and the ways between
// programs, plants and tests.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/editor/client.hpp"

namespace ipos::tests {
namespace {

const std::string kProgram = "/p/A.IPC";
const std::string kPlant = "/p/line.toml";
const std::string kTest = "/p/line.test.toml";

const std::string kSource =
    "#include <const.h>\ntypedef struct { long target; long step; } Axis;\nlong lSpeed;\nAxis left[2];\n"
    "main()\n{\n  lSpeed = 1;\n  left[1].target = lSpeed;\n}\n";
const std::string kPlantText =
    "[[station]]\nname = \"saw\"\nunit = \"md60a\"\nprogram = \"A.IPC\"\nhex = [\"lSpeed\"]\n"
    "[station.parameters]\nP130 = \"1 s\"\n\n"
    "[[expect]]\nstation = \"saw\"\nat = \"1s\"\nvariable = \"lSpeed\"\nequals = 1\n";
const std::string kTestText =
    "plant = \"line.toml\"\n[[expect]]\nvariable = \"left[1].target\"\nequals = 1\n"
    "[[step]]\nstation = \"saw\"\nvariable = \"lSpeed\"\nset = 5\n";

// An editor with all three files.
Client& opened(Client& client) {
  client.open(kProgram, kSource);
  client.open(kPlant, kPlantText);
  client.open(kTest, kTestText);
  return client;
}

std::string uri(const std::string& path) { return "file://" + path; }

Json range(int line, int begin, int end) {
  return {{"start", {{"line", line}, {"character", begin}}}, {"end", {{"line", line}, {"character", end}}}};
}

Json actions(Client& client, const std::string& path, const Json& where) {
  Json params = Client::document(path);
  params["range"] = where;
  params["context"] = {{"diagnostics", Json::array()}};
  return client.request("textDocument/codeAction", params);
}

// Path and line of each edit of a rename.
std::vector<std::string> edits(const Json& answer) {
  std::vector<std::string> found;
  for (const auto& [file, changes] : answer["changes"].items())
    for (const Json& change : changes)
      found.push_back(file.substr(file.rfind('/') + 1) + ":" + change["range"]["start"].dump());
  std::sort(found.begin(), found.end());
  return found;
}

TEST(LspActions, WhatWasMeantIsWritten) {
  Client client;
  client.open(kProgram, "long lSpeed;\nmain() { lSped = 1; }\n");
  const Json found = actions(client, kProgram, range(1, 9, 9));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0]["kind"], "quickfix");
  const Json edit = found[0]["edit"]["changes"][uri(kProgram)][0];
  EXPECT_EQ(edit["newText"], "lSpeed");
  EXPECT_EQ(edit["range"], range(1, 9, 14));
  EXPECT_TRUE(actions(client, kProgram, range(0, 0, 0)).empty()) << "there is nothing to mend";
}

TEST(LspActions, OfMembersAndDirectives) {
  Client client;
  client.open(kProgram, "#inclde <const.h>\nmain() { }\n");
  EXPECT_EQ(actions(client, kProgram, range(0, 0, 17))[0]["edit"]["changes"][uri(kProgram)][0]["newText"],
            "#include");
  client.open(kProgram, "#include <const.h>\nMOVLNK Ml;\nmain() { Ml.Adress = 1; }\n");
  const Json member = actions(client, kProgram, range(2, 12, 12));
  ASSERT_EQ(member.size(), 1U);
  EXPECT_EQ(member[0]["edit"]["changes"][uri(kProgram)][0]["newText"], "Address");
  EXPECT_EQ(member[0]["edit"]["changes"][uri(kProgram)][0]["range"], range(2, 12, 18));
}

// The text after the only quick fix of a program, which has one mistake somewhere in its lines.
std::string mended(const std::string& source) {
  Client client;
  client.open(kProgram, source);
  const Json found = actions(client, kProgram, {{"start", {{"line", 0}, {"character", 0}}}, {"end", {{"line", 99}, {"character", 0}}}});
  if (found.size() != 1) return "fixes: " + found.dump();
  const Json edit = found[0]["edit"]["changes"][uri(kProgram)][0];
  const auto offset = [&](const Json& at) {
    size_t begin = 0;
    for (int line = 0; line < at["line"]; ++line) begin = source.find('\n', begin) + 1;
    return begin + at["character"].get<size_t>();
  };
  const size_t begin = offset(edit["range"]["start"]);
  return source.substr(0, begin) + edit["newText"].get<std::string>() + source.substr(offset(edit["range"]["end"]));
}

TEST(LspActions, WhereTheMendIsCertain) {
  EXPECT_EQ(mended("const long MAX = 5;\nmain() { H1 = MAX; }\n"), "#define MAX 5\nmain() { H1 = MAX; }\n");
  EXPECT_EQ(mended("const long A = -5, B = 0x10;\nmain() { H1 = A + B; }\n"),
            "#define A -5\n#define B 0x10\nmain() { H1 = A + B; }\n");
  EXPECT_EQ(mended("enum { IDLE, RUN = 5, STOP };\nmain() { H1 = STOP; }\n"),
            "#define IDLE 0\n#define RUN 5\n#define STOP 6\nmain() { H1 = STOP; }\n");
  EXPECT_EQ(mended("main() { H481.1 = 1; }\n"), "main() { _BitSet(H481, 1); }\n");
  EXPECT_EQ(mended("long a; main() { a.3 = 0; }\n"), "long a; main() { _BitClear(a, 3); }\n");
  EXPECT_EQ(mended("main() { _BitSet(H481.1); }\n"), "main() { _BitSet(H481, 1); }\n");
  EXPECT_EQ(mended("main() { H1 = 16#FF; }\n"), "main() { H1 = 0xFF; }\n");
  EXPECT_EQ(mended("main() { _Wait(T#1m30s); }\n"), "main() { _Wait(90000); }\n");
  EXPECT_EQ(mended("#include <constb.h>\n#include <iob.h>\nmain() { DO01 = 1; }\n"),
            "#include <constb.h>\n#include <iob.h>\nmain() { SET_DO01; }\n");
  EXPECT_EQ(mended("#include <constb.h>\n#include <iob.h>\nmain() { DO01 = 0; }\n"),
            "#include <constb.h>\n#include <iob.h>\nmain() { CLEAR_DO01; }\n");
  EXPECT_EQ(mended("main() { if (H1 > 1); H2 = 1; else H2 = 2; }\n"), "main() { if (H1 > 1) H2 = 1; else H2 = 2; }\n");
  EXPECT_EQ(mended("main() { switch (H1) { csae 1: H2 = 1; } }\n"), "main() { switch (H1) { case 1: H2 = 1; } }\n");
  EXPECT_EQ(mended("SCREC r; long d;\nmain() { d = 1; r.DPointer = d; }\n"),
            "SCREC r; long d;\nmain() { d = 1; r.DPointer = numof(d); }\n");
  EXPECT_EQ(mended("#include <const.h>\nmain() { if (StatusWord & 19) H1 = 1; }\n"),
            "#include <const.h>\nmain() { if (StatusWord & (1 << 19)) H1 = 1; }\n");
}

TEST(LspActions, NoneWhereItIsNot) {
  EXPECT_EQ(mended("main() { H1 = 5; } const long MAX = 5;\n"), "fixes: []") << "a directive begins a line";
  EXPECT_EQ(mended("long a; main() { if (a.3) H1 = 1; }\n"), "fixes: []") << "there are several ways to test a bit";
}

TEST(LspActions, OfPlants) {
  Client client;
  client.open(kPlant, "[[station]]\nname = \"saw\"\nunit = \"md60b\"\nprogramm = \"A.IPC\"\n");
  const Json key = actions(client, kPlant, range(3, 0, 0));
  ASSERT_EQ(key.size(), 1U);
  EXPECT_EQ(key[0]["edit"]["changes"][uri(kPlant)][0]["newText"], "program");
  EXPECT_EQ(key[0]["edit"]["changes"][uri(kPlant)][0]["range"], range(3, 0, 8));
  const Json unit = actions(client, kPlant, range(2, 9, 9));
  ASSERT_EQ(unit.size(), 1U);
  EXPECT_EQ(unit[0]["edit"]["changes"][uri(kPlant)][0]["newText"], "md60a");
}

TEST(LspLenses, RunDebugAndTheWayToThePlant) {
  Client client;
  opened(client);
  std::vector<std::string> titles;
  const Json of_program = client.request("textDocument/codeLens", Client::document(kProgram));
  for (const Json& lens : of_program) titles.push_back(lens["command"]["title"]);
  ASSERT_EQ(titles.size(), 4U);
  EXPECT_TRUE(titles.back().starts_with("at most ")) << titles.back();
  titles.pop_back();
  EXPECT_EQ(titles, (std::vector<std::string>{"Run", "Debug", "saw in line.toml"}));
  EXPECT_EQ(of_program[0]["range"]["start"]["line"], 4);
  EXPECT_EQ(of_program[2]["command"]["arguments"], Json({uri(kPlant), {{"line", 3}, {"character", 11}}}));
  std::vector<std::string> commands;
  for (const Json& lens : client.request("textDocument/codeLens", Client::document(kPlant)))
    commands.push_back(lens["command"]["command"]);
  EXPECT_EQ(commands, (std::vector<std::string>{"ipos.run", "ipos.debug", "ipos.test"}));
  const Json of_test = client.request("textDocument/codeLens", Client::document(kTest));
  ASSERT_EQ(of_test.size(), 1U);
  EXPECT_EQ(of_test[0]["command"]["command"], "ipos.test");
}

// What a function costs stands above it, as `ipos build --time` has it (tests/generated/timing_test.cpp counts by hand).
TEST(LspLenses, CostOfFunctions) {
  Client client;
  client.open(kProgram,
              "long lA;\nCount()\n{\n  lA++;\n}\nHang()\n{\n  while (lA != 5) {}\n}\nmain()\n{\n  while (1)\n  {\n    Count();\n    Hang();\n  }\n}\n");
  std::map<int, std::string> titles;
  for (const Json& lens : client.request("textDocument/codeLens", Client::document(kProgram)))
    if (lens["command"]["command"] == "") titles[lens["range"]["start"]["line"]] = lens["command"]["title"];
  ASSERT_EQ(titles.size(), 3U);
  EXPECT_EQ(titles[1], "at most 2 commands, 2 ms");
  EXPECT_TRUE(titles[5].starts_with("no bound: ")) << titles[5];
  EXPECT_TRUE(titles[9].starts_with("a turn: no bound: ")) << titles[9];
}

TEST(LspFolding, BlocksCommentsAndTables) {
  Client client;
  client.open(kProgram, "/* a\n b */\nmain()\n{\n  while (1)\n  {\n    H0 = 1;\n  }\n  // }\n}\n");
  Json folds = client.request("textDocument/foldingRange", Client::document(kProgram));
  const auto has = [&](int first, int last) {
    return std::any_of(folds.begin(), folds.end(),
                       [&](const Json& one) { return one["startLine"] == first && one["endLine"] == last; });
  };
  EXPECT_TRUE(has(0, 1)) << folds;  // the comment
  EXPECT_TRUE(has(3, 8)) << folds;  // main
  EXPECT_TRUE(has(5, 6)) << folds;
  client.open(kPlant, kPlantText);
  folds = client.request("textDocument/foldingRange", Client::document(kPlant));
  EXPECT_TRUE(has(0, 6)) << folds;  // the station with its parameters
  EXPECT_TRUE(has(8, 12)) << folds;
}

TEST(LspHints, NumbersOfVariables) {
  Client client;
  client.open(kProgram, kSource);
  Json params = Client::document(kProgram);
  params["range"] = {{"start", {{"line", 0}, {"character", 0}}}, {"end", {{"line", 9}, {"character", 0}}}};
  const Json hints = client.request("textDocument/inlayHint", params);
  ASSERT_EQ(hints.size(), 2U) << hints;
  // The manual's compiler numbers global variables from H420 on (IPOSplus p. 274).
  EXPECT_EQ(hints[0]["label"], "H420");
  EXPECT_EQ(hints[0]["position"], Json({{"line", 2}, {"character", 11}}));
  EXPECT_EQ(hints[1]["label"], "H421..H424");
}

// Tokens as "line:character:length type".
std::vector<std::string> tokens(const Json& answer) {
  const char* types[] = {"macro", "variable", "function", "type", "property", "number", "namespace"};
  std::vector<std::string> found;
  int line = 0, character = 0;
  const Json& data = answer["data"];
  for (size_t n = 0; n + 5 <= data.size(); n += 5) {
    const int down = data[n];
    line += down;
    character = (down == 0 ? character : 0) + data[n + 1].get<int>();
    found.push_back(std::to_string(line) + ":" + std::to_string(character) + ":" +
                    std::to_string(data[n + 2].get<int>()) + " " + types[data[n + 3].get<size_t>()]);
  }
  return found;
}

TEST(LspTokens, ByMeaning) {
  Client client;
  client.open(kProgram, "#define N 5\nlong v;\nmain()\n{\n  v = N;\n  _Wait(H1);\n}\n");
  const auto found = tokens(client.request("textDocument/semanticTokens/full", Client::document(kProgram)));
  for (const char* one : {"0:8:1 macro", "1:5:1 variable", "2:0:4 function", "4:2:1 variable", "4:6:1 macro",
                          "5:2:5 function", "5:8:2 variable"})
    EXPECT_NE(std::find(found.begin(), found.end(), one), found.end()) << one;
  client.open(kPlant, kPlantText);
  const auto plant = tokens(client.request("textDocument/semanticTokens/full", Client::document(kPlant)));
  for (const char* one : {"0:2:7 namespace", "1:0:4 property", "6:0:4 number"})
    EXPECT_NE(std::find(plant.begin(), plant.end(), one), plant.end()) << one;
}

TEST(LspRenameAcross, AVariableInProgramPlantAndTest) {
  Client client;
  opened(client);
  Json params = Client::at(kProgram, 2, 6);
  params["newName"] = "lPace";
  const std::vector<std::string> wanted{
      R"(A.IPC:{"character":19,"line":7})",      R"(A.IPC:{"character":2,"line":6})",
      R"(A.IPC:{"character":5,"line":2})",       R"(line.test.toml:{"character":12,"line":6})",
      R"(line.toml:{"character":12,"line":11})", R"(line.toml:{"character":8,"line":4})"};
  EXPECT_EQ(edits(client.request("textDocument/rename", params)), wanted);
  // The same from the test.
  Json other = Client::at(kTest, 6, 14);
  other["newName"] = "lPace";
  EXPECT_EQ(edits(client.request("textDocument/rename", other)), wanted);
  EXPECT_EQ(client.request("textDocument/prepareRename", Client::at(kTest, 6, 14))["placeholder"], "lSpeed");
}

TEST(LspRenameAcross, AMemberByItsPath) {
  Client client;
  opened(client);
  Json params = Client::at(kTest, 2, 22);  // target of left[1].target
  params["newName"] = "goal";
  EXPECT_EQ(
      edits(client.request("textDocument/rename", params)),
      (std::vector<std::string>{R"(A.IPC:{"character":10,"line":7})", R"(A.IPC:{"character":22,"line":1})",
                                R"(line.test.toml:{"character":20,"line":2})"}));
}

TEST(LspRenameAcross, AStationWithItsTests) {
  Client client;
  opened(client);
  Json params = Client::at(kPlant, 1, 9);
  params["newName"] = "belt";
  EXPECT_EQ(edits(client.request("textDocument/rename", params)),
            (std::vector<std::string>{R"(line.test.toml:{"character":11,"line":5})",
                                      R"(line.toml:{"character":11,"line":9})",
                                      R"(line.toml:{"character":8,"line":1})"}));
  client.open("/p/other.toml", "[[station]]\nname = \"saw\"\nunit = \"md60a\"\n");
  EXPECT_EQ(edits(client.request("textDocument/rename", params)).size(), 3U) << "another plant is left alone";
  params["newName"] = "";
  EXPECT_EQ(client.refused("textDocument/rename", params), -32803);
}

TEST(LspNavigation, FromThePlantToTheProgramAndBack) {
  Client client;
  opened(client);
  const Json declared = client.request("textDocument/definition", Client::at(kPlant, 11, 14));
  EXPECT_EQ(declared["uri"], uri(kProgram));
  EXPECT_EQ(declared["range"], range(2, 5, 11));
  const Json program = client.request("textDocument/definition", Client::at(kPlant, 3, 14));
  EXPECT_EQ(program["uri"], uri(kProgram));
  Json params = Client::at(kProgram, 2, 6);
  params["context"] = {{"includeDeclaration", true}};
  EXPECT_EQ(client.request("textDocument/references", params).size(), 6U);
}

}  // namespace
}  // namespace ipos::tests
