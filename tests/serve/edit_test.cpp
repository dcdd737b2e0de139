// Editing where the plant runs: which files belong to it, what a build says, and when what was built takes effect. The
// program counts `lCount` up by one each 5 ms, within one of them, and shows its double in `lTwice`.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/serve/page.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/serve/channel.hpp"
#include "tools/serve/posix/forked_copies.hpp"
#include "tools/serve/language.hpp"
#include "tools/serve/plant_files.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSource = R"(#include <const.h>
#include "step.h"
long lCount, lTwice;
main()
{
  while (1)
  {
    lCount = lCount + STEP;
    lTwice = lCount * 2;
    _Wait(5);
  }
}
)";
constexpr const char* kToml = R"([[station]]
name = "saw"
unit = "mdxb"
program = "SAW.IPC"
[station.inputs]
DI00 = 1
[station.parameters]
P938 = 9
)";

class Editing : public ::testing::Test {
 protected:
  void SetUp() override {
    char name[] = "/tmp/ipos-edit-XXXXXX";
    folder = mkdtemp(name);
    put("SAW.IPC", kSource);
    put("step.h", "#define STEP 1\n");
    put("saw.toml", kToml);
    put("saw.test.toml", "plant = \"saw.toml\"\n");
    put("other.test.toml", "plant = \"lift.toml\"\n");
    put("notes.txt", "nothing");
    begin();
  }
  void TearDown() override {
    page.reset();
    fs::remove_all(folder);
  }
  void begin(const std::string& read_only = {}) {
    page.reset();
    files.emplace(path("saw.toml"), tools::CompileFlags{}, read_only);
    const tools::debug::MakePlant make = [input = tools::read_plant_input(path("saw.toml"), {})] {
      return tools::make_plant(input, runtime::FileUse::Look);
    };
    page.emplace(make, clock, copies, *files);
  }

  std::string path(const std::string& name) const { return (folder / name).string(); }
  void put(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
  std::string on_disk(const std::string& name) const { return *tools::try_read_file(path(name)); }
  static std::string with(std::string text, const std::string& old, const std::string& replaced) {
    const size_t at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return text.replace(at, old.size(), replaced);
  }

  Json good(Json message) {
    Json reply = page->ask(std::move(message));
    EXPECT_TRUE(reply.value("ok", false)) << reply;
    return reply;
  }
  std::string error(Json message) { return page->ask(std::move(message)).value("error", "no error"); }
  void step(int ms) { good({{"do", "step"}, {"ms", ms}}); }
  int64_t value(const std::string& name) {
    good({{"do", "watch"}, {"names", {"saw." + name}}});
    good({{"do", "subscribe"}, {"topic", "watch"}});
    return page->event("watch")["values"].front()["value"].get<int64_t>();
  }
  std::string running_text() {
    return good({{"do", "program"}, {"station", "saw"}})["files"][0]["text"];
  }
  void write_and_build(const std::string& text) {
    const Json file = good({{"do", "file.read"}, {"name", path("SAW.IPC")}});
    good({{"do", "file.write"}, {"name", path("SAW.IPC")}, {"text", text}, {"version", file["version"]}});
    EXPECT_TRUE(good({{"do", "build"}})["good"]);
  }
  int breakpoint_line() { return good({{"do", "breaks"}})["breakpoints"].at(0)["line"]; }
  // Where it stands after it has run into a breakpoint.
  int runs_to_line() {
    good({{"do", "step"}, {"ms", 1000}});
    good({{"do", "subscribe"}, {"topic", "program"}, {"station", "saw"}});
    return page->event("program")["tasks"][0]["line"];
  }

  fs::path folder;
  tools::serve::SteadyClock clock;
  tools::serve::ForkedCopies copies{false};
  std::optional<tools::serve::PlantFiles> files;
  std::optional<Page> page;
};

TEST_F(Editing, ListsThePlantItsProgramsTheirHeadersAndItsTests) {
  std::map<std::string, std::string> kinds;
  const Json reply = good({{"do", "files"}});
  for (const Json& file : reply["files"]) kinds[fs::path(file["name"].get<std::string>()).filename()] = file["kind"];
  const std::map<std::string, std::string> expected{
      {"saw.toml", "plant"}, {"SAW.IPC", "program"}, {"step.h", "include"}, {"saw.test.toml", "test"}};
  EXPECT_EQ(kinds, expected);
}

TEST_F(Editing, WritesOnlyFilesOfThePlantAndNewTestsAndSessionsBesideIt) {
  for (const std::string& name : {path("notes.txt"), path("other.IPC"), path("lift.toml"), path(".test.toml"), path("sub/x.test.toml"),
                                 path("../x.test.toml"), std::string("/etc/x.test.toml"), std::string("a\\b.test.toml"), path("")})
    EXPECT_NE(error({{"do", "file.write"}, {"name", name}, {"text", "x"}}), "no error") << name;
  EXPECT_EQ(on_disk("notes.txt"), "nothing");
  EXPECT_EQ(good({{"do", "file.write"}, {"name", "new.test.toml"}, {"text", "plant = \"saw.toml\"\n"}})["name"], path("new.test.toml"));
  EXPECT_EQ(on_disk("new.test.toml"), "plant = \"saw.toml\"\n");
  good({{"do", "file.write"}, {"name", path("day.ipos")}, {"text", "{}"}});
  EXPECT_EQ(on_disk("day.ipos"), "{}");
  for (const auto& entry : fs::directory_iterator(folder))
    EXPECT_FALSE(entry.path().string().ends_with(".tmp")) << entry.path();
}

TEST_F(Editing, WritesNothingWhereThatIsNotAllowed) {
  begin("another machine");
  EXPECT_EQ(error({{"do", "file.write"}, {"name", path("SAW.IPC")}, {"text", "x"}, {"over", true}}), "another machine");
  EXPECT_EQ(on_disk("SAW.IPC"), kSource);
  const Json reply = good({{"do", "files"}});
  EXPECT_EQ(reply["files"].size(), 4U);
  for (const Json& file : reply["files"]) EXPECT_EQ(file["read_only"], "another machine");
}

TEST_F(Editing, DoesNotOverwriteWhatSomebodyElseHasWrittenMeanwhile) {
  const Json file = good({{"do", "file.read"}, {"name", path("SAW.IPC")}});
  EXPECT_EQ(file["text"], kSource);
  put("SAW.IPC", "// theirs\n");
  EXPECT_NE(error({{"do", "file.write"}, {"name", path("SAW.IPC")}, {"text", "// mine\n"}, {"version", file["version"]}}).find("has changed"),
            std::string::npos);
  EXPECT_EQ(on_disk("SAW.IPC"), "// theirs\n");
  good({{"do", "file.write"}, {"name", path("SAW.IPC")}, {"text", "// mine\n"}, {"over", true}});
  EXPECT_EQ(on_disk("SAW.IPC"), "// mine\n");
}

TEST_F(Editing, BuildAloneTouchesNothingThatRuns) {
  write_and_build(with(kSource, "* 2", "* 3"));
  EXPECT_EQ(running_text(), kSource);
  step(100);
  EXPECT_EQ(value("lTwice"), 2 * value("lCount"));
}

TEST_F(Editing, RestartBeginsWithWhatWasBuilt) {
  step(100);
  write_and_build(with(kSource, "* 2", "* 3"));
  EXPECT_EQ(good({{"do", "restart"}})["us"], 0);
  EXPECT_NE(running_text(), kSource);
  step(100);
  EXPECT_EQ(value("lTwice"), 3 * value("lCount"));
  EXPECT_NE(error({{"do", "load"}, {"station", "saw"}}), "no error");  // nothing waits any more
  // Time goes back in the plant that was built, not in the one before.
  good({{"do", "back"}, {"us", 0}});
  step(100);
  EXPECT_EQ(value("lTwice"), 3 * value("lCount"));
}

TEST_F(Editing, AMistakeIsToldAtItsLineAndTheOldPlantGoesOn) {
  step(100);
  const Json file = good({{"do", "file.read"}, {"name", path("SAW.IPC")}});
  good({{"do", "file.write"}, {"name", path("SAW.IPC")}, {"text", with(kSource, "lCount * 2", "lCunt * 2")}, {"version", file["version"]}});
  const Json build = good({{"do", "build"}});
  EXPECT_FALSE(build["good"]);
  ASSERT_EQ(build["messages"].size(), 1U) << build;
  EXPECT_EQ(build["messages"][0]["file"], path("SAW.IPC"));
  EXPECT_EQ(build["messages"][0]["line"], 9);
  EXPECT_EQ(build["messages"][0]["column"], 14);
  good({{"do", "restart"}});
  EXPECT_EQ(running_text(), kSource);
  step(100);
  EXPECT_EQ(value("lTwice"), 2 * value("lCount"));
}

TEST_F(Editing, AMistakeInThePlantFileOrInWhatItsUnitsRefuseIsToldAtItsLine) {
  for (const auto& [text, line] : {std::pair<std::string, int>{std::string(kToml) + "P999 = 1\n", 9},
                                   {with(kToml, "program =", "programm ="), 4}, {with(kToml, "SAW.IPC", "NONE.IPC"), 4}}) {
    put("saw.toml", text);
    const Json build = good({{"do", "build"}});
    EXPECT_FALSE(build["good"]) << text;
    ASSERT_FALSE(build["messages"].empty()) << text;
    EXPECT_EQ(build["messages"][0]["file"], path("saw.toml"));
    EXPECT_EQ(build["messages"][0]["line"], line) << build;
  }
}

TEST_F(Editing, LoadIsADownload) {
  step(103);
  const int64_t count = value("lCount");
  ASSERT_GT(count, 10);
  write_and_build(with(kSource, "* 2", "* 3"));
  good({{"do", "load"}, {"station", "saw"}});
  EXPECT_NE(running_text(), kSource);
  EXPECT_EQ(value("lCount"), count);  // variables stay
  step(4);
  EXPECT_EQ(value("lCount"), count + 1);  // the program has begun anew
  EXPECT_EQ(value("lTwice"), 3 * (count + 1));
  // Before the download the old program runs, and the download comes again.
  good({{"do", "back"}, {"us", 50'000}});
  EXPECT_EQ(running_text(), kSource);
  EXPECT_EQ(value("lTwice"), 2 * value("lCount"));
}

TEST_F(Editing, ALoadedProgramIsThereAgainWhereTimeGoesBackToItsTime) {
  step(103);
  write_and_build(with(kSource, "* 2", "* 3"));
  good({{"do", "load"}, {"station", "saw"}});
  step(100);
  const int64_t count = value("lCount");
  step(100);
  good({{"do", "back"}, {"ms", 100}});
  EXPECT_EQ(value("lCount"), count);
  EXPECT_EQ(value("lTwice"), 3 * count);
  EXPECT_NE(running_text(), kSource);
}

TEST_F(Editing, ALoadInTheMiddleOfAMillisecondBeginsTheProgram) {
  good({{"do", "break.set"}, {"station", "saw"}, {"file", path("SAW.IPC")}, {"line", 9}});
  EXPECT_EQ(runs_to_line(), 9);
  write_and_build(with(kSource, "* 2", "* 3"));
  good({{"do", "load"}, {"station", "saw"}});
  const int64_t count = value("lCount");
  EXPECT_EQ(runs_to_line(), 9);
  EXPECT_EQ(value("lCount"), count + 1);
}

TEST_F(Editing, ABreakpointFollowsItsLine) {
  good({{"do", "break.set"}, {"station", "saw"}, {"file", path("SAW.IPC")}, {"line", 9}});
  write_and_build(with(kSource, "  while (1)", "  // one more\n\n  while (1)"));
  EXPECT_EQ(breakpoint_line(), 9);  // the old text runs
  good({{"do", "restart"}});
  EXPECT_EQ(breakpoint_line(), 11);
  EXPECT_EQ(runs_to_line(), 11);
}

TEST_F(Editing, ABreakpointStandsAtTheLineOfTheProgramOfItsTime) {
  good({{"do", "break.set"}, {"station", "saw"}, {"file", path("SAW.IPC")}, {"line", 9}});
  EXPECT_EQ(runs_to_line(), 9);
  write_and_build(with(kSource, "  while (1)", "  // one more\n\n  while (1)"));
  good({{"do", "load"}, {"station", "saw"}});
  EXPECT_EQ(breakpoint_line(), 11);
  EXPECT_EQ(runs_to_line(), 11);
  good({{"do", "back"}, {"us", 0}});  // it stands within what happens at 0 s
  EXPECT_EQ(breakpoint_line(), 9);
}

TEST_F(Editing, RestartKeepsWhatIsForcedAndDropsClicks) {
  good({{"do", "input"}, {"station", "saw"}, {"name", "DI02"}, {"on", true}});
  good({{"do", "input"}, {"station", "saw"}, {"name", "DI03"}, {"action", "force"}, {"on", true}});
  good({{"do", "force"}, {"name", "saw.lTwice"}, {"value", "77"}});
  step(20);
  write_and_build(with(kSource, "* 2", "* 3"));
  good({{"do", "restart"}});
  step(22);  // a force acts at the beginning of a millisecond; at each fifth one the program writes behind it
  EXPECT_EQ(value("DI02"), 0);
  EXPECT_EQ(value("DI03"), 1);
  EXPECT_EQ(value("lTwice"), 77);
  EXPECT_EQ(good({{"do", "forced"}})["names"].size(), 2U);
}

TEST_F(Editing, NamesThatAreGoneAreLeftOut) {
  good({{"do", "scope"}, {"channels", {"saw.lTwice", "saw.speed"}}});
  good({{"do", "force"}, {"name", "saw.lTwice"}, {"value", "77"}});
  good({{"do", "watch"}, {"names", {"saw.lTwice", "saw.lCount"}}});
  good({{"do", "subscribe"}, {"topic", "watch"}});
  std::string renamed = with(kSource, "lTwice;", "lDouble;");
  renamed = with(renamed, "lTwice =", "lDouble =");
  write_and_build(renamed);
  good({{"do", "load"}, {"station", "saw"}});
  step(20);
  EXPECT_EQ(good({{"do", "scope"}})["channels"].size(), 1U);
  good({{"do", "restart"}});
  step(20);
  EXPECT_EQ(good({{"do", "scope"}})["channels"].size(), 1U);
  EXPECT_EQ(value("lDouble"), 2 * value("lCount"));
}

TEST_F(Editing, AStationThatIsNewIsThereAfterRestart) {
  put("saw.toml", std::string(kToml) + "[[station]]\nname = \"lift\"\nunit = \"md60a\"\n");
  EXPECT_TRUE(good({{"do", "build"}})["good"]);
  EXPECT_EQ(good({{"do", "plant"}})["plant"]["stations"].size(), 1U);
  page->post.sent.clear();
  good({{"do", "restart"}});
  EXPECT_FALSE(page->event("rebuilt").is_null());
  EXPECT_EQ(good({{"do", "plant"}})["plant"]["stations"].size(), 2U);
  step(20);
}

TEST_F(Editing, AHeaderOfAProgramCountsToo) {
  put("step.h", "#define STEP 5\n");
  good({{"do", "subscribe"}, {"topic", "files"}, {"rate", 60}});
  EXPECT_TRUE(good({{"do", "build"}})["good"]);
  good({{"do", "restart"}});
  step(2);
  EXPECT_EQ(value("lCount"), 5);
}

TEST_F(Editing, ValuesOfTheProgramComeByTheirNames) {
  step(20);
  good({{"do", "subscribe"}, {"topic", "values"}, {"station", "saw"}, {"names", {"lCount", "lTwice", "nothing"}}});
  const Json values = page->event("values")["values"];
  EXPECT_EQ(values.size(), 2U);
  EXPECT_EQ(std::stoi(values["lTwice"].get<std::string>()), 2 * std::stoi(values["lCount"].get<std::string>()));
}

TEST(LineIn, FindsTheSameLineOrTheOneInItsPlace) {
  using tools::serve::line_in;
  const std::string before = "a\nb\nc\nd\n";
  EXPECT_EQ(line_in(before, before, 3), 3U);
  EXPECT_EQ(line_in(before, "new\na\nb\nc\nd\n", 3), 4U);
  EXPECT_EQ(line_in(before, "a\nc\nd\n", 3), 2U);
  EXPECT_EQ(line_in(before, "a\nb\nchanged\nd\n", 3), 3U);
  EXPECT_EQ(line_in(before, "a\nb\nd\n", 3), 3U);  // it is gone: the next one
  EXPECT_EQ(line_in(before, "x\na\nb\ny\nc\nz\nd\n", 3), 5U);
  EXPECT_EQ(line_in(before, "a\r\nb\r\nnew\r\nc\r\nd\r\n", 3), 4U);
  EXPECT_EQ(line_in(before, "", 3), 1U);
}

TEST(LanguageOfTheEditor, AnswersForTextsThatAreNotSaved) {
  tools::serve::LanguageServer server({});
  const std::string uri = "file:///nowhere/SAW.IPC";
  const tools::serve::Texts texts{{uri, "long lFloor;\nmain()\n{\n  lFl;\n}\n"}};
  const Json items = server.answer("textDocument/completion", {{"textDocument", {{"uri", uri}}}, {"position", {{"line", 3}, {"character", 5}}}}, texts);
  const Json& list = items.is_array() ? items : items["items"];
  EXPECT_TRUE(std::any_of(list.begin(), list.end(), [](const Json& one) { return one["label"] == "lFloor"; }));
  const Json wrong = server.answer("diagnostics", Json::object(), texts);
  ASSERT_FALSE(wrong[uri].empty()) << wrong;
  EXPECT_EQ(wrong[uri][0]["range"]["start"]["line"], 3);
  EXPECT_TRUE(server.answer("diagnostics", Json::object(), {{uri, "main()\n{\n}\n"}})[uri].empty());
  EXPECT_THROW(server.answer("textDocument/nothing", Json::object(), texts), tools::serve::Mistake);
}

// As ipos test --mutate keeps them; looked for anew with each question, as it may run meanwhile.
TEST(LanguageOfTheEditor, ShowsWhatNoTestNoticed) {
  const std::string text = "long n;\nmain()\n{\n  n = 200;\n}\n";
  std::vector<tools::Survivor> kept;
  tools::serve::LanguageServer server({}, [&](const std::string& path, std::string_view of) {
    return path == "/nowhere/SAW.IPC" && of == text ? kept : std::vector<tools::Survivor>();
  });
  const std::string uri = "file:///nowhere/SAW.IPC";
  EXPECT_TRUE(server.answer("diagnostics", Json::object(), {{uri, text}})[uri].empty());
  kept = {{4, 7, "200 became 220", true}};
  const Json shown = server.answer("diagnostics", Json::object(), {{uri, text}})[uri];
  ASSERT_EQ(shown.size(), 1U) << shown;
  EXPECT_EQ(shown[0]["message"], "no test notices: 200 became 220");
  EXPECT_EQ(shown[0]["severity"], 3);
  EXPECT_EQ(shown[0]["range"], (Json{{"start", {{"line", 3}, {"character", 6}}}, {"end", {{"line", 3}, {"character", 9}}}}));
  EXPECT_TRUE(server.answer("diagnostics", Json::object(), {{uri, text + "\n"}})[uri].empty()) << "another text by now";
}

}  // namespace
}  // namespace ipos::tests
