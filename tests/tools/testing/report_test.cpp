// What comes out of a run: the text for people, JUnit XML by the rules of Jenkins' junit-10.xsd, TAP 13,
// JSON.
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "runtime/signals/states.hpp"
#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"
#include "tools/test_file/test_case.hpp"

namespace ipos::tests {
namespace {

const std::string kFeeder = "tests/tools/testing/broken/feeder.test.toml";

// What a stranger needs to see what to mend: the program waits for DI11, the light barrier is at DI10.
TEST(Report, OfABrokenProgramShowsWhatToMend) {
  const CommandResult result = run_ipos({"test", kFeeder}, project(""));
  EXPECT_EQ(result.exit_code, 1);
  for (const char* part :
       {"FAILED  tests/tools/testing/broken/feeder  2 checks in 0.400 s\n",
        "feeder.test.toml:15:1: DO01 of feeder did not become 1 from 100 ms to 120 ms, is 0\n",
        "(the pusher comes out when the light barrier sees a piece)\n", "> 15 | [[expect]]\n",
        "    17 | output = \"DO01\"\n", "feeder.DI10 = 1 since 100 ms, 0 from ",
        "feeder: task 1 is at tests/tools/testing/broken/FEEDER.IPC:12:", "while (!DI11)\n",
        "feeder.test.toml:21:1: lPieces of feeder is 0 at 400 ms, expected 1\n",
        "lPieces of feeder does not become 1 until 400 ms, the end of the test\n",
        "1 test, 0 passed, 1 failed\n"})
    EXPECT_TRUE(contains(result.out, part)) << part << "\n" << result.out;
}

TEST(Report, InTheDocumentationIsReal) {
  const std::string page = read_text(project("docs/guide/testing.md"));
  const std::string command = "$ ipos test " + kFeeder + "\n";
  const size_t at = page.find(command);
  ASSERT_NE(at, std::string::npos);
  const size_t begin = at + command.size();
  EXPECT_EQ(page.substr(begin, page.find("```", begin) - begin),
            run_ipos({"test", kFeeder}, project("")).out);
}

TEST(Report, DocumentationHasEveryState) {
  const std::string page = read_text(project("docs/guide/testing.md"));
  for (const signals::StationState& state : signals::station_states()) {
    const std::string row = "| `" + std::string(state.name) + "` | " + std::string(state.meaning) + " |\n";
    EXPECT_TRUE(contains(page, row)) << row;
  }
}

// Frames in the words of `ipos bus decode`, and beside each failed test what it left.
TEST(Report, ArtifactsOfWhatFailed) {
  const TemporaryFolder folder;
  folder.write("A.IPC",
               "#include <const.h>\nSCTRCYCL Tr;\nlong lValue, lOther;\nmain()\n{\n  Tr.ObjectNo = 1024;\n"
               "  Tr.CycleTime = 10;\n  Tr.Format = 4;\n  Tr.DPointer = numof(lValue);\n"
               "  _SBusCommDef(SCD_TRCYCL, Tr);\n  _SBusCommOn();\n  while (1) lValue = 7;\n}\n");
  const std::string plant =
      "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[station]]\nname = \"u\"\nunit = \"md60a\"\nprogram = "
      "\"A.IPC\"\n"
      "sbus = \"sbus\"\n[[station]]\nname = \"v\"\nunit = \"md60a\"\nsbus = "
      "\"sbus\"\n[station.parameters]\nP813 = 2\n";
  const std::string expect =
      "[[expect]]\nafter = \"50ms\"\nstation = \"u\"\nvariable = \"lValue\"\nequals = ";
  folder.write("good.test.toml", plant + expect + "7\n");
  folder.write("bad.test.toml", plant + expect + "8\n");
  const CommandResult result =
      run_ipos({"test", ".", "--artifacts", "left", "--html", "report.html"}, folder.path());
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_TRUE(contains(result.out, "400#00000007 | 400 lValue = 7 (00000007h) <- u")) << result.out;
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path() / "left"))
    if (entry.is_regular_file())
      files.insert(entry.path().lexically_relative(folder.path() / "left").string());
  EXPECT_EQ(files, (std::set<std::string>{"bad/bus.pcapng", "bad/journal.txt", "bad/plot.html",
                                          "bad/report.txt", "bad/state.ipos", "bad/trace.csv", "bad/trace.vcd"}));
  const std::string trace = read_text(folder.path() / "left/bad/trace.csv");
  EXPECT_TRUE(
      trace.starts_with("time_ms,u.speed [rpm],u.setpoint [rpm],u.status,v.speed [rpm],"
                        "v.setpoint [rpm],v.status,u.lValue,sbus.frames\n"))
      << trace.substr(0, 200);
  EXPECT_TRUE(contains(trace, "\n50,"));
  const CommandResult decoded = run_ipos({"bus", "decode", "left/bad/bus.pcapng"}, folder.path());
  EXPECT_EQ(decoded.exit_code, 0) << decoded.err;
  EXPECT_TRUE(contains(decoded.out, "sbus 400 00 00 00 07")) << decoded.out;
  const std::string page = read_text(folder.path() / "report.html");
  EXPECT_TRUE(contains(page, "href=\"left/bad/plot.html\"") && !contains(page, "left/good"));
  // The picture stands in the report, and the failed check leads to its moment there.
  EXPECT_TRUE(contains(page, "<iframe title=\"bad\" loading=\"lazy\" src=\"left/bad/plot.html\">")) << page;
  EXPECT_TRUE(contains(page, "href=\"left/bad/plot.html#50\">0.050 s in the curves</a>")) << page;
  EXPECT_TRUE(contains(read_text(folder.path() / "left/bad/plot.html"), "\"name\":\"u.lValue\""));
}

// The last frames are told in the words of `ipos bus decode` with the same plant, on lines of every kind. What a master wrote
// long before they came decides about CANopen: here PO5 on a PDO that was off.
TEST(Report, LastFramesHaveTheWordsOfDecode) {
  const TemporaryFolder folder;
  std::string text =
      "[[bus]]\nname = \"can\"\nkind = \"can\"\n[[bus]]\nname = \"line\"\nkind = \"rs485\"\n"
      "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\n"
      "[[station]]\nname = \"saw\"\nunit = \"mdxb\"\nsbus = \"can\"\nrs485 = \"line\"\noption = \"dfp\"\n"
      "profibus = \"dp\"\nprofibus_address = 8\n[station.parameters]\nP880 = 1\nP886 = 5\nP810 = 3\n";
  const auto send = [&](const std::string& bus, const std::string& what) {
    text += "[[step]]\nbus = \"" + bus + "\"\nsend = \"" + what + "\"\n[[step]]\nwait = \"50ms\"\n";
  };
  send("can", "605#2301160110050020");  // 1601h:1 = 2000h:5, 16 bits
  send("can", "605#2F01160001000000");
  send("can", "605#2F011402FF000000");  // type 255
  send("can", "605#2301140105030000");  // 305h
  send("can", "000#0105");
  for (int n = 0; n < 9; ++n) send("can", "305#3412");
  send("can", "605#4017100000000000");
  send("line", "02 03 85 00 06 13 88 00 00 bcc");
  send("dp", "10 08 02 49 fcs 16");
  text += "[[expect]]\nstation = \"saw\"\nstate = \"speed\"\nequals = 7\n";
  folder.write("bad.test.toml", text);
  const CommandResult result = run_ipos({"test", "bad.test.toml", "--artifacts", "left"}, folder.path());
  EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
  EXPECT_TRUE(contains(result.out, "can 305#3412 | 305 RPDO2 PO5 1234h -> saw")) << result.out;
  EXPECT_TRUE(contains(result.out, "-> saw\n")) << result.out;
  folder.write("plant.toml", text.substr(0, text.find("[[step]]")));
  const CommandResult decoded =
      run_ipos({"bus", "decode", "left/bad/bus.pcapng", "--names", "plant.toml"}, folder.path());
  EXPECT_EQ(decoded.exit_code, 0) << decoded.err;
  // Each line of the report has the words of one of the log.
  size_t compared = 0;
  std::istringstream lines(result.out);
  for (std::string line; std::getline(lines, line);) {
    const size_t words = line.find(" | ");
    if (words == std::string::npos || line.find(" ms ") == std::string::npos) continue;
    ++compared;
    EXPECT_TRUE(contains(decoded.out, line.substr(words + 3) + "\n")) << line << "\n" << decoded.out;
  }
  EXPECT_EQ(compared, 8U) << result.out;
}

// Folders whose names become equal stay two; names beyond what a file system takes are cut.
TEST(Report, EachFailedTestHasItsOwnFolder) {
  const TemporaryFolder folder;
  const std::string plant =
      "[[station]]\nname = \"u\"\nunit = \"md60a\"\n[[expect]]\nstation = \"u\"\nstate = \"speed\"\nequals "
      "= ";
  for (const std::string& name : {std::string("a b"), std::string("a+b"), std::string("a_b")})
    folder.write(name + ".test.toml", plant + "1\n");
  const CommandResult result =
      run_ipos({"test", ".", "--artifacts", "left", "--html", "r.html"}, folder.path());
  EXPECT_EQ(result.exit_code, 1);
  const std::string page = read_text(folder.path() / "r.html");
  std::set<std::string> tests;
  for (const char* one : {"a_b", "a_b_2", "a_b_3"}) {
    const std::string report = read_text(folder.path() / "left" / one / "report.txt");
    tests.insert(report.substr(0, report.find(" check")));
    EXPECT_TRUE(contains(page, std::string("href=\"left/") + one + "/plot.html\"")) << one;
  }
  EXPECT_EQ(tests.size(), 3U);
}

TEST(Report, SaysWhenAValueComesTooLate) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "long a;\nmain()\n{\n  _Wait(150);\n  a = 5;\n}\n");
  folder.write("a.test.toml",
               "[[station]]\nname = \"u\"\nunit = \"md60a\"\nprogram = \"A.IPC\"\n"
               "[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"100ms\"\n[[step]]\nuntil = \"300ms\"\n");
  const CommandResult result = run_ipos({"test", "a.test.toml"}, folder.path());
  EXPECT_TRUE(contains(result.out, "a of u becomes 5 at 15")) << result.out;
  EXPECT_TRUE(contains(result.out, "u: task 1 waits at A.IPC:4:3: _Wait(150);\n")) << result.out;
}

// A run with a test that passes, one that fails, one that is malformed and one with characters that XML and
// TAP have to escape.
class Forms : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("A.IPC", "long a;\nmain()\n{\n  a = 5;\n  while (1) ;\n}\n");
    const std::string station = "[[station]]\nname = \"u\"\nunit = \"md60a\"\nprogram = \"A.IPC\"\n";
    const std::string expect = "[[expect]]\nvariable = \"a\"\nat = \"100ms\"\nequals = ";
    folder_.write("good.test.toml", station + expect + "5\n");
    folder_.write("bad.test.toml", station + expect + "6\nnote = \"<&\\\"# \\u00e4\"\n" + expect + "7\n");
    folder_.write("broken.test.toml", "x = 1\n");
    folder_.write("odd & <#1>.test.toml", station + expect + "5\n");
    result_ =
        run_ipos({"test", ".", "--junit", "r.xml", "--tap", "r.tap", "--json", "r.json"}, folder_.path());
  }
  std::string report(const char* name) const { return read_text(folder_.path() / name); }
  TemporaryFolder folder_;
  CommandResult result_;
};

// Elements, their attributes (required ones with !) and children, as in junit-10.xsd.
struct Rule {
  std::set<std::string> attributes, required, children;
};
const std::map<std::string, Rule> kJunit = {
    {"testsuites", {{"name", "time", "tests", "failures", "errors"}, {}, {"testsuite"}}},
    {"testsuite",
     {{"name", "tests", "failures", "errors", "group", "time", "skipped", "timestamp", "hostname", "id",
       "package", "file", "log", "url"},
      {"name", "tests", "failures", "errors"},
      {"testsuite", "properties", "testcase", "system-out", "system-err"}}},
    {"testcase",
     {{"name", "time", "classname", "group"},
      {"name"},
      {"skipped", "error", "failure", "system-out", "system-err"}}},
    {"failure", {{"type", "message"}, {}, {}}},
    {"error", {{"type", "message"}, {}, {}}},
    {"skipped", {{"type", "message"}, {}, {}}},
    {"system-out", {{}, {}, {}}},
};

void check_element(const tinyxml2::XMLElement& element) {
  const auto rule = kJunit.find(element.Name());
  ASSERT_NE(rule, kJunit.end()) << element.Name();
  std::set<std::string> names;
  for (const auto* attribute = element.FirstAttribute(); attribute != nullptr;
       attribute = attribute->Next()) {
    names.insert(attribute->Name());
    EXPECT_TRUE(rule->second.attributes.contains(attribute->Name()))
        << element.Name() << " " << attribute->Name();
  }
  for (const std::string& name : rule->second.required)
    EXPECT_TRUE(names.contains(name)) << element.Name() << " " << name;
  for (const auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    EXPECT_TRUE(rule->second.children.contains(child->Name())) << element.Name() << " " << child->Name();
    check_element(*child);
  }
}

void check_junit(const std::string& text) {
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(text.c_str(), text.size()), tinyxml2::XML_SUCCESS) << text;
  ASSERT_STREQ(document.RootElement()->Name(), "testsuites");
  check_element(*document.RootElement());
}

// GitLab and Jenkins show what stands so in the output of a test.
TEST_F(Forms, JunitNamesTheArtifactsOfWhatFailed) {
  const std::string folder = (folder_.path() / "left").string();
  run_ipos({"test", ".", "--junit", "r.xml", "--artifacts", folder}, folder_.path());
  const std::string text = report("r.xml");
  check_junit(text);
  size_t found = 0;
  for (size_t at = 0; (at = text.find("[[ATTACHMENT|", at)) != std::string::npos; ++found) {
    at += std::string_view("[[ATTACHMENT|").size();
    const std::string path = text.substr(at, text.find("]]\n", at) - at);
    EXPECT_TRUE(path.starts_with(folder + "/") && std::filesystem::is_regular_file(path)) << path;
  }
  EXPECT_GE(found, 7U) << text;
  for (const char* name : {"plot.html]]", "trace.csv]]", "bus.pcapng]]", "report.txt]]"}) EXPECT_TRUE(contains(text, name)) << name;
  EXPECT_FALSE(contains(report("r.xml"), "good/")) << "what passed has none";
}

TEST_F(Forms, JunitIsAsJenkinsReadsIt) {
  EXPECT_EQ(result_.exit_code, 65) << result_.out << result_.err;
  const std::string text = report("r.xml");
  check_junit(text);
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(text.c_str(), text.size()), tinyxml2::XML_SUCCESS);
  const tinyxml2::XMLElement& root = *document.RootElement();
  EXPECT_EQ(root.IntAttribute("tests"), 4);
  EXPECT_EQ(root.IntAttribute("failures"), 1);
  EXPECT_EQ(root.IntAttribute("errors"), 1);
  const tinyxml2::XMLElement* suite = root.FirstChildElement("testsuite");
  EXPECT_STREQ(suite->Attribute("name"), "bad.test.toml");
  const tinyxml2::XMLElement* failure = suite->FirstChildElement("testcase")->FirstChildElement("failure");
  ASSERT_NE(failure, nullptr);
  EXPECT_STREQ(failure->Attribute("message"), "a of u is 5 at 100 ms, expected 6");
  EXPECT_TRUE(contains(failure->GetText(), "(<&\"# \u00e4)"));
  EXPECT_NE(failure->NextSiblingElement("failure"), nullptr);
  suite = suite->NextSiblingElement();
  EXPECT_NE(suite->FirstChildElement("testcase")->FirstChildElement("error"), nullptr);
  suite = suite->NextSiblingElement()->NextSiblingElement();
  EXPECT_STREQ(suite->FirstChildElement("testcase")->Attribute("name"), "odd & <#1>");
}

TEST_F(Forms, TapVersion14) {
  std::istringstream in(report("r.tap"));
  std::vector<std::string> points;
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "TAP version 13");
  std::getline(in, line);
  EXPECT_EQ(line, "1..4");
  bool in_yaml = false;
  while (std::getline(in, line)) {
    if (line == "  ---") {
      EXPECT_FALSE(in_yaml);
      EXPECT_TRUE(points.back().starts_with("not ok")) << points.back();
      in_yaml = true;
    } else if (line == "  ...") {
      in_yaml = false;
    } else if (in_yaml) {
      EXPECT_TRUE(line.starts_with("  ")) << line;
    } else {
      points.push_back(line);
    }
  }
  EXPECT_FALSE(in_yaml);
  EXPECT_EQ(points, (std::vector<std::string>{"not ok 1 - bad", "not ok 2 - broken", "ok 3 - good",
                                              "ok 4 - odd & <\\#1>"}));
  EXPECT_TRUE(contains(report("r.tap"),
                       "  message: \"a of u is 5 at 100 ms, expected 6\"\n  severity: fail\n  at:\n    file: "
                       "\"bad.test.toml\"\n    line: 5\n    column: 1\n"));
}

TEST_F(Forms, Json) {
  const nlohmann::json json = nlohmann::json::parse(report("r.json"));
  EXPECT_EQ(json["tests"], 4);
  EXPECT_EQ(json["passed"], 2);
  EXPECT_EQ(json["failed"], 1);
  EXPECT_EQ(json["error"], 1);
  const nlohmann::json& bad = json["results"][0];
  EXPECT_EQ(bad["name"], "bad");
  EXPECT_EQ(bad["outcome"], "failed");
  EXPECT_EQ(bad["checks"], 2);
  EXPECT_EQ(bad["time_us"], 100'000);
  EXPECT_EQ(bad["findings"][0]["line"], 5);
  EXPECT_EQ(bad["findings"][0]["source"][0], "[[expect]]");
  EXPECT_EQ(bad["findings"][1]["message"], "a of u is 5 at 100 ms, expected 7");
  EXPECT_TRUE(contains(json["results"][1]["messages"], "broken.test.toml:1:1: error: unknown key 'x'"));
}

TEST_F(Forms, AReportOnStandardOutputStandsAlone) {
  const CommandResult xml = run_ipos({"test", "good.test.toml", "--junit", "-"}, folder_.path());
  check_junit(xml.out);
  EXPECT_EQ(xml.exit_code, 0);
  EXPECT_EQ(run_ipos({"test", "good.test.toml", "--junit", "-", "--tap", "-"}, folder_.path()).exit_code, 64);
}

TEST(Examples, HaveATestEach) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  const std::string xml = (folder.path() / "examples.xml").string();
  const CommandResult result = run_ipos({"test", "examples", "--junit", xml}, project(""));
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  check_junit(read_text(xml));
  for (const auto& entry : fs::recursive_directory_iterator(project("examples"))) {
    const std::string path = entry.path().string();
    if (!path.ends_with(".toml") || path.ends_with(".test.toml") || path.ends_with(".campaign.toml")) continue;
    bool tested = fs::exists(path.substr(0, path.size() - 5) + ".test.toml");
    for (const auto& test : fs::directory_iterator(entry.path().parent_path()))
      tested = tested || (test.path().string().ends_with(".test.toml") &&
                          contains(read_text(test.path()), "plant = \"" + entry.path().filename().string() + "\""));
    EXPECT_TRUE(tested) << path << " has no test";
  }
}

}  // namespace
}  // namespace ipos::tests
