// What is kept of a plant from start to start, and that the source on the page is the text that runs.
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/serve/serving.hpp"
#include "tests/tools/command.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/sources.hpp"
#include "tools/serve/kept.hpp"
#include "tools/serve/state_folder.hpp"

namespace ipos::tests {
namespace {

using tools::serve::Kept;

class KeptOfAPlant : public ::testing::Test {
 protected:
  KeptOfAPlant() { setenv("XDG_STATE_HOME", folder.path().c_str(), 1); }
  ~KeptOfAPlant() override { unsetenv("XDG_STATE_HOME"); }
  TemporaryFolder folder;
};

TEST_F(KeptOfAPlant, EachPlantHasItsTokenAndPort) {
  const Kept one = Kept::of_plant(folder.write("one.toml", "")), two = Kept::of_plant(folder.write("two.toml", ""));
  const std::string token = one.token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_EQ(one.token(), token);
  EXPECT_EQ(Kept::of_plant((folder.path() / "." / "one.toml").string()).token(), token) << "another way to the same file";
  EXPECT_NE(two.token(), token);
  EXPECT_NE(Kept::of_drive("can0", "1").token(), Kept::of_drive("can0", "2").token());
  EXPECT_EQ(one.port(), std::nullopt);
  one.keep_port(8123);
  EXPECT_EQ(one.port(), 8123);
  EXPECT_EQ(two.port(), std::nullopt);
  EXPECT_EQ(one.token(), token);
}

TEST_F(KeptOfAPlant, WhatIsDamagedIsMadeAnew) {
  const Kept kept = Kept::of_plant(folder.write("one.toml", ""));
  const std::string name = tools::serve::state_name(
      "serve", std::filesystem::weakly_canonical(folder.path() / "one.toml").string());
  for (const char* text : {"", "{", "[]", R"({"token": 5, "port": -1})", R"({"token": "abc", "port": 70000})",
                           R"({"token": "0123456789abcdef0123456789abcdeF", "settings": 5})"}) {
    ASSERT_TRUE(tools::serve::write_state(name, text));
    EXPECT_EQ(kept.port(), std::nullopt) << text;
    const std::string token = kept.token();
    EXPECT_EQ(token.size(), 32U) << text;
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << text;
    EXPECT_EQ(kept.token(), token);
  }
}

// The server keeps the port while the host keeps the settings of a session: two processes, one file.
TEST_F(KeptOfAPlant, WhatTwoProcessesKeepAtOnceIsAllThere) {
  const Kept kept = Kept::of_plant(folder.write("one.toml", ""));
  constexpr int kTimes = 200;
  const pid_t other = fork();
  ASSERT_GE(other, 0);
  if (other == 0) {
    for (int n = 1; n <= kTimes; ++n) kept.keep_port(static_cast<uint16_t>(n));
    _exit(0);
  }
  ServedPage page(the_plant());
  kept.add_commands(page.host.router());
  for (int n = 1; n <= kTimes; ++n) page.host.router().keep("name" + std::to_string(n), n);
  int status = -1;
  ASSERT_EQ(waitpid(other, &status, 0), other);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(kept.port(), kTimes);
  EXPECT_EQ(kept.settings().size(), static_cast<size_t>(kTimes));
}

// What can be written can be read: nothing is lost by being long.
TEST_F(KeptOfAPlant, LongSettingsComeBackOrAreRefused) {
  const Kept kept = Kept::of_plant(folder.write("one.toml", ""));
  const std::string token = kept.token();
  ServedPage page(the_plant());
  kept.add_commands(page.host.router());
  for (const size_t length : {1000U, 100'000U, 250'000U, 300'000U}) {
    page.host.router().keep("long", std::string(length, 'x'));
    EXPECT_EQ(kept.settings().value("long", "").size(), std::min<size_t>(length, 250'000)) << "300 000 are refused";
    EXPECT_EQ(kept.token(), token) << length;
  }
}

void restore(Page& page, const Kept& kept) {
  kept.add_commands(page.host.router());
  page.host.restore(kept.settings());
}

TEST_F(KeptOfAPlant, SettingsOutliveTheServer) {
  const Kept kept = Kept::of_plant(folder.write("one.toml", ""));
  const std::string token = kept.token();
  const Json pins = Json::array({{{"name", "saw.lCount"}}});
  {
    ServedPage page(the_plant());
    restore(page, kept);
    EXPECT_EQ(page.ask({{"do", "settings"}})["settings"], Json::object());
    EXPECT_TRUE(page.ask({{"do", "settings.set"}, {"name", "watch.pinned"}, {"value", pins}})["ok"]);
    EXPECT_TRUE(page.ask({{"do", "settings.set"}, {"name", "keys"}, {"value", false}})["ok"]);
    EXPECT_EQ(page.ask({{"do", "settings.set"}, {"name", "x"}}).value("error", ""), "'value' is missing");
    EXPECT_EQ(page.ask({{"do", "settings.set"}, {"name", "x"}, {"value", std::string(300'000, 'x')}}).value("error", ""),
              "there is no room for more settings");
  }
  ServedPage page(the_plant());
  restore(page, Kept::of_plant((folder.path() / "one.toml").string()));
  EXPECT_EQ(page.ask({{"do", "settings"}})["settings"], (Json{{"watch.pinned", pins}, {"keys", false}}));
  EXPECT_EQ(kept.token(), token);
}

TEST_F(KeptOfAPlant, TheScopeHasItsSettingsAgainAsFarAsTheyStillFit) {
  const Kept kept = Kept::of_plant(folder.write("one.toml", ""));
  const Json trigger{{"kind", "edge"}, {"signal", "saw.lCount"}, {"value", 5.0}, {"slope", "falling"}};
  const auto scope = [&](Page& page) { return page.ask({{"do", "scope"}}); };
  {
    ServedPage page(the_plant());
    restore(page, kept);
    page.ask({{"do", "scope"}, {"channels", {"saw.lCount", "lift.speed"}}, {"trigger", trigger}, {"pre", 30}});
  }
  {
    ServedPage page(the_plant());
    restore(page, kept);
    const Json now = scope(page);
    ASSERT_EQ(now["channels"].size(), 2U);
    EXPECT_EQ(now["channels"][1]["name"], "lift.speed");
    EXPECT_EQ(now["trigger"], trigger);
    EXPECT_EQ(now["pre"], 30);
    page.ask({{"do", "step"}, {"ms", 10}});
    EXPECT_EQ(scope(page)["first_us"], 1000);
  }
  // Channels that are no more: those of the start, and the rest as it was.
  ASSERT_TRUE(kept.settings()["scope"].is_object());
  ServedPage page(the_plant());
  Json wrong = kept.settings()["scope"];
  wrong["channels"] = {"saw.lGone"};
  kept.add_commands(page.host.router());
  page.host.router().keep("scope", wrong);
  restore(page, kept);
  EXPECT_EQ(scope(page)["channels"].size(), 6U);
  EXPECT_EQ(scope(page)["pre"], 30);
}

TEST(SourceOnThePage, IsWhatWasCompiled) {
  const TemporaryFolder folder;
  const std::string old_text = "#include \"part.h\"\r\nmain() { while (1) H1 = PART; }\n";
  folder.write("part.h", "#define PART 81920\n");
  folder.write("A.IPC", old_text);
  const std::string plant = folder.write("a.toml", "[[station]]\nname = \"a\"\nunit = \"md60a\"\nprogram = \"A.IPC\"\n");
  const tools::PlantInput input = tools::read_plant_input(plant, {});
  ServedPage page([&] { return tools::make_plant(input, runtime::FileUse::Look); });
  const auto text_of = [&](const std::string& name) {
    const Json reply = page.ask({{"do", "program"}, {"station", "a"}});
    for (const Json& file : reply["files"])
      if (file["name"].get<std::string>().ends_with(name)) return file["text"].get<std::string>();
    return std::string("none");
  };
  const auto changed = [&] {
    page.ask({{"do", "subscribe"}, {"topic", "program"}, {"station", "a"}});
    return page.event("program")["changed"];
  };
  EXPECT_EQ(text_of("A.IPC"), old_text);
  EXPECT_EQ(changed(), Json::array());
  folder.write("A.IPC", "main() { while (1) H1 = 40960; }\n");
  EXPECT_EQ(text_of("A.IPC"), old_text);
  std::filesystem::remove(folder.path() / "A.IPC");
  EXPECT_EQ(text_of("A.IPC"), old_text) << "also where it is gone";
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // it is looked at once a second
  ASSERT_EQ(changed().size(), 1U);
  EXPECT_TRUE(changed()[0].get<std::string>().ends_with("A.IPC"));
  const std::string path = input.programs[0]->files[0];
  EXPECT_EQ(tools::source_line(path, 1), "#include \"part.h\"");
  EXPECT_EQ(tools::source_line(path, 2), "main() { while (1) H1 = PART; }");
  for (const size_t none : {0U, 3U, 4U, 1000U}) EXPECT_EQ(tools::source_line(path, none), "");
  EXPECT_TRUE(tools::source_has_changed(path));
  // Time that begins anew shows no other text either: nothing is compiled again.
  page.ask({{"do", "restart"}});
  EXPECT_EQ(text_of("A.IPC"), old_text);
}

TEST(SourceOnThePage, ATraceHoldsTheLastOnesOfWhatIsShown) {
  const std::string text =
      "[[bus]]\nname = \"busy\"\nkind = \"can\"\n[[bus]]\nname = \"quiet\"\nkind = \"can\"\n"
      "[[station]]\nname = \"a\"\nunit = \"mdxb\"\nsbus = \"busy\"\n[[station]]\nname = \"b\"\nunit = \"mdxb\"\nsbus = \"quiet\"\n";
  ServedPage page([&] {
    std::vector<runtime::PlantError> errors;
    return std::make_unique<runtime::Plant>(runtime::read_plant_file(text).plant,
                                            std::vector<std::optional<vm::Image>>(2), std::nullopt, errors);
  });
  const auto send = [&](const char* bus, int id) {
    page.ask({{"do", "bus.send"}, {"bus", bus}, {"identifier", id}, {"data", "0102"}});
    page.ask({{"do", "step"}});
  };
  send("quiet", 77);
  for (int n = 0; n < 300; ++n) send("busy", 1000 + n % 3);
  send("quiet", 78);
  const auto frames = [&](Json more) {
    more["do"] = "bus.trace";
    return page.ask(more)["frames"];
  };
  const Json quiet = frames({{"bus", "quiet"}});
  ASSERT_EQ(quiet.size(), 2U) << quiet;
  EXPECT_EQ(quiet[0]["id"], 77);
  EXPECT_EQ(quiet[0]["n"], 1);
  EXPECT_EQ(quiet[1]["n"], 302);
  EXPECT_EQ(frames({{"bus", "busy"}}).size(), 200U);
  EXPECT_EQ(frames({{"bus", "busy"}, {"filter", "1001"}}).size(), 100U);
  EXPECT_EQ(frames({{"limit", 301}})[0]["n"], 2) << "all lines in their order";
  EXPECT_EQ(frames({{"before", 302}, {"limit", 1}})[0]["n"], 301);
  EXPECT_EQ(page.ask({{"do", "bus.trace"}, {"bus", "none"}}).value("error", ""), "there is no bus 'none'");
}

TEST(AtTheBeginning, ACardDoesNotContradictItself) {
  ServedPage page(the_plant());
  const auto saw = [&] {
    page.ask({{"do", "subscribe"}, {"topic", "plant"}});
    return page.event("plant")["stations"]["saw"];
  };
  EXPECT_EQ(saw()["in"], 1);
  EXPECT_EQ(saw()["why"].get<std::string>().find("DI00"), std::string::npos) << saw();
  EXPECT_NE(saw()["why"].get<std::string>().find("before the first millisecond"), std::string::npos);
  for (int turn = 0; turn < 2; ++turn) {
    EXPECT_EQ(saw()["state"], "power-on");
    EXPECT_EQ(saw()["display"], "");
    page.ask({{"do", "step"}});
    EXPECT_NE(saw()["state"], "power-on");
    EXPECT_NE(saw()["display"], "");
    if (turn == 0) page.ask({{"do", "back"}, {"us", 0}});
  }
  EXPECT_EQ(saw()["why"].get<std::string>().find("millisecond"), std::string::npos) << saw();
  // A switch that is touched while time stands is seen at once, the unit's words are older, and say so.
  page.ask({{"do", "input"}, {"station", "saw"}, {"name", "DI00"}, {"on", false}});
  page.ask({{"do", "step"}});
  EXPECT_NE(saw()["why"].get<std::string>().find("DI00"), std::string::npos) << saw();
  page.ask({{"do", "input"}, {"station", "saw"}, {"name", "DI00"}, {"on", true}});
  EXPECT_NE(saw()["why"].get<std::string>().find("at the last millisecond"), std::string::npos) << saw();
  page.ask({{"do", "back"}, {"us", 2000}});
  page.ask({{"do", "step"}});
  EXPECT_EQ(saw()["why"].get<std::string>().find("millisecond"), std::string::npos) << saw();
}

// The decimal form of the greatest numbers of 32 bits, with and without sign.
TEST_F(Serving, ANumberBeyond32BitsIsNoNumber) {
  const auto set = [&](const char* value) { return error({{"do", "set"}, {"name", "saw.H300"}, {"value", value}}); };
  for (const char* good : {"2147483647", "-2147483648", "0xFFFFFFFF", "-1", "0"}) EXPECT_EQ(set(good), "no error") << good;
  for (const char* bad : {"4294967295", "2147483648", "-2147483649", "-4294967295", "0x100000000", "", "-", "0x", "1 ", "1.5", "+1"})
    EXPECT_NE(set(bad).find("is no number of 32 bits"), std::string::npos) << bad << ": " << set(bad);
  EXPECT_NE(error({{"do", "force"}, {"name", "saw.H300"}, {"value", "4294967295"}}).find("is no number of 32 bits"), std::string::npos);
}

TEST_F(Serving, AUnitWithoutPowerHasNoValues) {
  step(5);
  EXPECT_EQ(value("saw.DI00"), 1);
  good({{"do", "power"}, {"station", "saw"}, {"on", false}});
  step(5);
  EXPECT_TRUE(topic({{"topic", "watch"}})["values"]["saw.DI00"].is_null());
}

TEST_F(Serving, ARateIsThatOfTheLastSecond) {
  const auto row = [&] { return topic({{"topic", "bus"}})["rows"][0]; };
  for (int n = 0; n < 3; ++n) good({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", 523}, {"data", "01"}});
  step(1000);
  EXPECT_EQ(row()["rate"], 3);
  step(1000);
  EXPECT_EQ(row()["rate"], 0);
  EXPECT_EQ(row()["count"], 3);
}

TEST_F(Serving, AUnitComparedWithItselfHasNoDifferences) {
  EXPECT_EQ(good({{"do", "parameters.compare"}, {"station", "saw"}, {"with", "saw"}})["rows"], Json::array());
  const Json list = good({{"do", "parameters"}, {"station", "saw"}});
  for (const Json& row : list["parameters"]) {
    if (row["access"] == "RO") {
      EXPECT_EQ(row["changed"], false) << row;
    }
  }
}

TEST_F(Serving, TheScopeWaitsForTheTelegramThatWasNamed) {
  good({{"do", "scope"}, {"channels", {"saw.lCount"}}, {"trigger", {{"kind", "telegram"}, {"bus", "sbus"}, {"id", 523}}}});
  good({{"do", "scope.arm"}});
  good({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", 11}, {"data", "01"}});
  step(100);
  EXPECT_EQ(topic({{"topic", "scope"}})["state"], "armed");
  good({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", 523}, {"data", "01"}});
  step(20);
  EXPECT_NE(topic({{"topic", "scope"}})["state"], "armed");
}

// A second subscription and time that went back both send what has not changed, too.
TEST_F(Serving, BehindATimeThatWentBackValuesAreSentAnew) {
  good({{"do", "watch"}, {"names", {"saw.H300"}}});
  good({{"do", "subscribe"}, {"topic", "watch"}, {"rate", 60}});
  good({{"do", "subscribe"}, {"topic", "plant"}, {"rate", 60}});
  step(10);
  good({{"do", "back"}, {"ms", 5}});
  EXPECT_TRUE(page.event("watch")["values"].contains("saw.H300")) << "it was 0 and is 0";
  EXPECT_TRUE(page.event("plant")["stations"].contains("lift"));
}

}  // namespace
}  // namespace ipos::tests
