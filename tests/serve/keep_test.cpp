// A test that the page has kept does the same run again: whatever was done on the page, in whatever plant, it is green at
// once and ends in the same state, and it is red where one of its values is changed.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <regex>
#include <set>

#include "runtime/plant/trace_hash.hpp"
#include "tests/harness/contains.hpp"
#include "tests/serve/plants.hpp"
#include "tests/serve/served_page.hpp"
#include "tests/tools/command.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/serve/host/step_text.hpp"
#include "tools/serve/opened_session.hpp"
#include "tools/test_file/read_tests.hpp"
#include "tools/testing/failed_state.hpp"
#include "tools/testing/run_test.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;
using tools::testing::Outcome;

// A page whose plant file and tests lie in a folder.
struct FolderParts {
  explicit FolderParts(const std::string& plant) : files(plant, {}) {}
  tools::serve::SteadyClock clock;
  tools::serve::ForkedCopies copies{false};
  tools::serve::PlantFiles files;
};
class FolderPage : private FolderParts, public Page {
 public:
  FolderPage(const std::string& plant, tools::debug::Debuggee make)
      : FolderParts(plant), Page(std::move(make), clock, copies, files) {}
};

// A copy of an example, so that its plant is called as the page of the tests calls it.
class Example {
 public:
  explicit Example(const fs::path& plant) {
    for (const auto& file : fs::directory_iterator(plant.parent_path()))
      if (file.path().extension() != ".toml") fs::copy(file.path(), folder_.path() / file.path().filename());
    folder_.write("plant.toml", read_text(plant));
  }
  std::string at(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }
  tools::debug::MakePlant make() const {
    return [input = tools::read_plant_input((folder_.path() / "plant.toml").string(), {})] {
      return tools::make_plant(input, runtime::FileUse::Look);
    };
  }
  struct Ran {
    tools::testing::TestResult result;
    uint64_t digest = 0;
  };
  Ran run(const std::string& text) const {
    const std::string file = folder_.write("kept.test.toml", text);
    const auto tests = tools::testing::read_tests(file);
    EXPECT_EQ(tests.size(), 1U);
    tools::testing::Programs programs{{}};
    tools::testing::RunOptions options;
    const runtime::Plant* plant = nullptr;
    Ran ran;
    options.prepare = [&](runtime::Plant& built) {
      plant = &built;
      return nullptr;
    };
    options.finish = [&] { ran.digest = runtime::state_digest(*plant); };
    ran.result = run_test(tests.front(), programs, options);
    return ran;
  }

 private:
  TemporaryFolder folder_;
};

std::string told(const tools::testing::TestResult& result) {
  std::string text = result.messages;
  for (const auto& finding : result.findings) text += std::to_string(finding.place.line) + ": " + finding.text + "\n";
  return text;
}

// Somebody who clicks here and there. What the page refuses changes nothing.
class Hand {
 public:
  Hand(Page& page, uint32_t seed) : page_(page), random_(seed) {
    plant_ = page.ask({{"do", "plant"}})["plant"];
    for (const Json reply = page.ask({{"do", "search"}, {"group", "variables"}, {"limit", 1000}}); const Json& row : reply["names"])
      variables_.push_back(row["name"]);
    for (const Json reply = page.ask({{"do", "search"}, {"text", ""}, {"limit", 1000}}); const Json& row : reply["names"])
      names_.push_back(row["name"]);
  }

  void act() {
    switch (below(13)) {
      case 0: case 1: case 2: return input();
      case 3: return set(one_of(variables_), below(2) == 0 ? "set" : "force", std::to_string(below(5000)));
      case 4: return set(station() + (below(2) == 0 ? ".PO1" : ".PO2"), below(2) == 0 ? "set" : "force", std::to_string(below(2000)));
      case 5: return set(station() + (below(2) == 0 ? ".P130" : ".P160"), below(2) == 0 ? "set" : "force", std::to_string(below(2000)));
      case 6: return release();
      case 7: return ask({{"do", "power"}, {"station", station()}, {"on", below(3) != 0}});
      case 8: return line_fault();
      case 9: return ask({{"do", "reset"}, {"station", station()}});
      case 10: return send();
      case 11: return ask({{"do", "mains"}, {"station", station()}, {"on", below(2) != 0}});
      default: return ask({{"do", "analog"}, {"station", station()}, {"name", "AI1"},
                           {"action", below(2) == 0 ? "set" : "force"}, {"value", std::to_string(below(10)) + " V"}});
    }
  }
  void pass() {
    if (below(8) == 0)
      ask({{"do", "back"}, {"ms", 1 + below(150)}});
    else
      ask({{"do", "step"}, {"ms", 1 + below(below(2) == 0 ? 5 : 400)}});
  }
  std::vector<std::string> pins() {
    std::vector<std::string> all;
    for (int n = 0; n < 8; ++n) all.push_back(one_of(names_));
    return all;
  }
  void ask(const Json& message) {
    page_.ask(message);
    done_ += message.dump() + "\n";
  }
  const std::string& done() const { return done_; }

 private:
  int below(int limit) { return static_cast<int>(random_() % static_cast<uint32_t>(limit)); }
  template <typename List>
  typename List::value_type one_of(const List& list) {
    return list.empty() ? typename List::value_type() : list[static_cast<size_t>(below(static_cast<int>(list.size())))];
  }
  std::string station() { return one_of(plant_["stations"].get<std::vector<Json>>())["name"]; }

  void input() {
    const char* actions[] = {"set", "set", "force", "pulse", "release"};
    const Json station = one_of(plant_["stations"].get<std::vector<Json>>());
    if (station["inputs"].empty()) return;
    ask({{"do", "input"}, {"station", station["name"]}, {"name", one_of(station["inputs"].get<std::vector<Json>>())["name"]},
         {"action", actions[below(5)]}, {"on", below(2) == 0}, {"ms", 1 + below(300)}});
  }
  void set(const std::string& name, const char* how, const std::string& value) {
    if (!name.empty()) ask({{"do", how}, {"name", name}, {"value", value}});
  }
  void release() {
    const Json forced = page_.ask({{"do", "forced"}})["names"];
    if (!forced.empty()) ask({{"do", "release"}, {"name", one_of(forced.get<std::vector<std::string>>())}});
  }
  void line_fault() {
    if (plant_["buses"].empty()) return;
    const Json bus = one_of(plant_["buses"].get<std::vector<Json>>());
    if (bus["faults"].empty()) return;
    const std::string kind = one_of(bus["faults"].get<std::vector<std::string>>());
    const Json& rule = bus["fault_rules"][kind];
    Json fault{{"do", "fault"}, {"bus", bus["name"]}, {"kind", kind}, {"on", true}};
    if (rule["station"] == "must" || (rule["station"] == "may" && below(2) == 0))
      fault["station"] = one_of(bus["stations"].get<std::vector<std::string>>());
    if (rule["rate"].get<bool>()) fault["rate"] = below(2) == 0 ? 1.0 : 0.25;
    ask(fault);
    planted_.push_back(fault);
    if (below(2) == 0) return;
    Json ended = one_of(planted_);
    ended["on"] = false;
    pass();
    ask(ended);
  }
  void send() {
    if (plant_["buses"].empty()) return;
    const Json bus = one_of(plant_["buses"].get<std::vector<Json>>());
    if (bus["kind"] == "can")
      return ask({{"do", "bus.send"}, {"bus", bus["name"]}, {"identifier", 0x200 + below(0x100)}, {"data", "0006 0BB8"}});
    ask({{"do", "bus.send"}, {"bus", bus["name"]}, {"data", bus["kind"] == "profibus" ? "10 08 02 49 53 16" : "02 01 85 00 06 13 88 00 00 1B"}});
  }

  Page& page_;
  std::mt19937 random_;
  Json plant_;
  std::vector<std::string> variables_, names_;
  std::vector<Json> planted_;
  std::string done_;
};

std::vector<fs::path> example_plants() {
  std::vector<fs::path> plants;
  for (const auto& folder : fs::directory_iterator(project("examples")))
    if (folder.is_directory())
      for (const auto& file : fs::directory_iterator(folder.path()))
        if (file.path().extension() == ".toml" && file.path().stem().extension().empty()) plants.push_back(file.path());
  std::sort(plants.begin(), plants.end());
  return plants;
}

class KeptTestOf : public ::testing::TestWithParam<fs::path> {};

TEST_P(KeptTestOf, IsGreenAtOnceAndRedAfterAChange) {
  const Example example(GetParam());
  const auto make = example.make();
  for (uint32_t seed = 1; seed <= 3; ++seed) {
    ServedPage page(make);
    Hand hand(page, seed * 7919);
    hand.act();
    for (int n = 0; n < 12; ++n) {
      hand.pass();
      hand.act();
      hand.act();
    }
    page.ask({{"do", "step"}, {"ms", 20}});
    const Json kept = page.ask({{"do", "keep.test"}, {"pinned", hand.pins()}});
    ASSERT_TRUE(kept.value("ok", false)) << kept;
    for (const std::string reason : kept["left_out"])
      EXPECT_TRUE(contains(reason, "stations and gateways only")) << reason;
    const std::string text = kept["text"];
    const Example::Ran ran = example.run(text);
    ASSERT_EQ(ran.result.outcome, Outcome::Passed) << told(ran.result) << hand.done() << text;
    EXPECT_EQ(ran.digest, runtime::state_digest(page.host.plant())) << hand.done() << text;

    // One value of it is another one.
    std::smatch last;
    ASSERT_TRUE(std::regex_search(text, last, std::regex("equals = (-?\\d+)\n")));
    const std::string other = last.prefix().str() + "equals = " + std::to_string(std::stoll(last[1]) ^ 1) + "\n" + last.suffix().str();
    const auto red = example.run(other).result;
    EXPECT_EQ(red.outcome, Outcome::Failed);
    EXPECT_EQ(red.findings.size(), 1U) << told(red);
  }
}

// The same moment, and from there on the same run.
TEST_P(KeptTestOf, IsTheSameMomentAsASession) {
  const Example example(GetParam());
  const auto make = example.make();
  FolderPage page(example.at("plant.toml"), make);
  // One that has not begun comes back, too.
  FolderPage at_power_on(example.at("plant.toml"), make);
  at_power_on.host.resume(tools::sessions::read_session(page.ask({{"do", "session"}})["text"].get<std::string>()));
  Hand hand(page, 4711);
  for (int n = 0; n < 8; ++n) {
    hand.act();
    hand.pass();
  }
  const Json saved = page.ask({{"do", "session"}, {"settings", {{"watch.pinned", {"x"}}}}});
  ASSERT_TRUE(saved.value("ok", false)) << saved;
  const tools::serve::OpenedSession opened(example.write("s.ipos", saved["text"]));
  EXPECT_FALSE(opened.is_unpacked());
  EXPECT_EQ(tools::sessions::read_session(saved["text"].get<std::string>()).settings["watch.pinned"], Json({"x"}));
  FolderPage again(example.at("plant.toml"), make);
  opened.resume(again.host);
  for (int n = 0; n < 2; ++n) {
    EXPECT_EQ(again.host.us(), page.host.us());
    EXPECT_EQ(runtime::state_digest(again.host.plant()), runtime::state_digest(page.host.plant())) << hand.done();
    for (Page* one : {static_cast<Page*>(&page), static_cast<Page*>(&again)}) one->ask({{"do", "step"}, {"ms", 250}});
  }
}

std::vector<fs::path> tests_of_examples() {
  std::vector<fs::path> tests;
  for (const auto& file : fs::recursive_directory_iterator(project("examples")))
    if (file.path().string().ends_with(".test.toml")) tests.push_back(file.path());
  std::sort(tests.begin(), tests.end());
  return tests;
}

class FailedTestOf : public ::testing::TestWithParam<fs::path> {};

// The plant of the page comes to the state that `ipos test` has had, with the script of the test beside it, and goes on as it.
TEST_P(FailedTestOf, OpensWhereItStood) {
  const TemporaryFolder folder;
  for (const auto& test : tools::testing::read_tests(GetParam().string())) {
    constexpr runtime::Time kLater = 640 * runtime::kMillisecond;
    runtime::Time look = 321 * runtime::kMillisecond;  // or where a short test ends
    std::map<runtime::Time, uint64_t> digests;
    tools::testing::RunOptions options;
    options.seed = 3;
    const runtime::Plant* plant = nullptr;
    options.prepare = [&](runtime::Plant& built) {
      plant = &built;
      return nullptr;
    };
    options.sample = [&](runtime::Time now) {
      if (now <= look || now == kLater) digests[now] = runtime::state_digest(*plant);
    };
    tools::testing::Programs programs{{}};
    run_test(test, programs, options);
    look = std::prev(digests.upper_bound(look))->first;

    const std::string text = tools::testing::failed_state(test, {}, {.seed = 3}, look);
    const tools::serve::OpenedSession opened(folder.write("state.ipos", text));
    EXPECT_TRUE(opened.is_unpacked());
    EXPECT_EQ(tools::sessions::read_session(text).digest, digests[look]) << test.name;
    const auto beside = opened.beside().value();
    EXPECT_EQ(beside.seed, 3U);
    FolderPage page(opened.plant(), tools::serve::debuggee_of(beside, {}));
    opened.resume(page.host);
    EXPECT_EQ(page.host.us(), look / runtime::kMicrosecond);
    page.ask({{"do", "step"}, {"ms", (kLater - look) / runtime::kMillisecond}});
    if (digests.contains(kLater)) {
      EXPECT_EQ(runtime::state_digest(page.host.plant()), digests[kLater]) << test.name;
    }
    page.ask({{"do", "go"}, {"us", look / runtime::kMicrosecond}});
    EXPECT_EQ(runtime::state_digest(page.host.plant()), digests[look]) << test.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, FailedTestOf, ::testing::ValuesIn(tests_of_examples()), [](const auto& test) {
  return std::regex_replace(test.param.filename().stem().stem().string(), std::regex("[^A-Za-z0-9]"), "_");
});

TEST(Session, ThatIsForeignDamagedOrCutOffIsRefused) {
  const Example example(project("examples/isync/isync.toml"));
  FolderPage page(example.at("plant.toml"), example.make());
  page.ask({{"do", "step"}, {"ms", 50}});
  const std::string text = page.ask({{"do", "session"}})["text"];
  const auto refusal = [](const std::string& session) {
    try {
      tools::sessions::read_session(session);
    } catch (const tools::sessions::Unreadable& mistake) {
      return std::string(mistake.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(text), "");
  for (const size_t cut : {size_t{0}, size_t{10}})
    EXPECT_EQ(refusal(text.substr(0, cut)), "this is no session of ipos");
  for (size_t cut = 40; cut + 2 < text.size(); cut += text.size() / 50)
    EXPECT_EQ(refusal(text.substr(0, cut)), "the session is damaged or cut off");
  EXPECT_EQ(refusal("(1436509052.249713) can0 044#2A366C2BBA\n"), "this is no session of ipos");
  const auto with = [&](const std::string& part, const std::string& other) {
    const size_t at = text.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return text.substr(0, at) + other + text.substr(at + part.size());
  };
  EXPECT_EQ(refusal(with("\"ipos_session\": 1", "\"ipos_session\": 2")), "the session is of version 2, this ipos reads version 1");
  EXPECT_EQ(refusal(with("\"MASTER.IPC\"", "\"../MASTER.IPC\"")), "'../MASTER.IPC' would lie outside of the session");
  EXPECT_TRUE(contains(refusal(with("\"actions\"", "\"others\"")), "a part of it is missing"));
  // A plant that has changed does not come to that state.
  tools::sessions::Session other = tools::sessions::read_session(text);
  other.digest ^= 1;
  EXPECT_THROW(page.host.resume(other), tools::serve::Mistake);
  other = tools::sessions::read_session(text);
  other.actions.push_back({other.moment, {}, 0, {{"act", "dance"}}});
  EXPECT_THROW(page.host.resume(other), tools::serve::Mistake);
}

TEST(KeptTest, HasWordsForEveryActionOfThePage) {
  ServedPage page(the_plant());
  const auto known = tools::serve::actions_with_words();
  for (const std::string& action : page.host.actions())
    EXPECT_NE(std::find(known.begin(), known.end(), action), known.end()) << action;
}

TEST(KeptTest, IsNoneAtTheBeginningAndTellsWhatItLeavesOut) {
  ServedPage page(the_plant());
  EXPECT_TRUE(contains(page.ask({{"do", "keep.test"}})["error"], "nothing has run yet"));
  page.ask({{"do", "step"}, {"ms", 3}});
  page.ask({{"do", "parameters.load"}, {"station", "lift"}, {"text", page.ask({{"do", "parameters.save"}, {"station", "lift"}})["text"]}});
  page.ask({{"do", "power"}, {"station", "lift"}, {"on", false}});
  const Json kept = page.ask({{"do", "keep.test"}, {"pinned", {"saw.lCount", "sbus.load"}}});
  EXPECT_EQ(kept["left_out"].size(), 2U) << kept;
  EXPECT_EQ(kept["text"], "# Kept from the page at 0.003 s: what was done there, and what was looked at.\nby_hand = true\n"
                          "plant = \"plant.toml\"\n\n[[step]]\nat = \"3ms\"\nstation = \"lift\"\npower = \"off\"\n\n"
                          "[[expect]]\nat = \"3ms\"\nstation = \"saw\"\nsignal = \"lCount\"\nequals = 1\n");
}

// The number by which a page is compared with a run (`ipos run --trace-hash`), also where something happens at 0 s.
TEST_P(KeptTestOf, HasAPageWithTheHashOfARun) {
  const Example example(GetParam());
  const std::unique_ptr<runtime::Plant> plant = example.make()();
  runtime::TraceHash hash(*plant);
  plant->run_until(1250 * runtime::kMillisecond, [&](runtime::Time now) {
    hash.sample(now);
    return true;
  });
  FolderPage page(example.at("plant.toml"), example.make());
  page.ask({{"do", "step"}, {"ms", 1250}});
  EXPECT_EQ(page.ask({{"do", "hash"}})["hash"], hash.text());
}

INSTANTIATE_TEST_SUITE_P(Examples, KeptTestOf, ::testing::ValuesIn(example_plants()), [](const auto& plant) {
  std::string name = plant.param.stem().string();
  std::replace_if(name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

}  // namespace
}  // namespace ipos::tests
