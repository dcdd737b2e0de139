// Every telegram of every example has on the page the words that `ipos bus decode --names PLANT` has for it in the log that
// the page saves: what the page says of a line is what the other tools say.
#include <filesystem>
#include <map>

#include "runtime/bus/words/bus_words.hpp"
#include "tests/serve/bytes_of_text.hpp"
#include "tests/serve/served_page.hpp"
#include "tests/tools/command.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/program.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> plants() {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(project("examples"))) {
    const fs::path& path = entry.path();
    if (path.extension() != ".toml" || path.stem().extension() == ".test" ||
        read_text(path).find("[[station]]") == std::string::npos || read_text(path).find("\nport = ") != std::string::npos)
      continue;
    found.push_back(path);
  }
  std::sort(found.begin(), found.end());
  return found;
}

struct Said {
  std::string line, text;
};

// In the order of their numbers.
std::map<uint64_t, Said> on_the_page(Page& page) {
  std::map<uint64_t, Said> all;
  Json before = nullptr;
  for (;;) {
    const Json reply = page.ask({{"do", "bus.trace"}, {"limit", 1000}, {"before", before}});
    const Json& frames = reply["frames"];
    for (const Json& frame : frames) all[frame["n"].get<uint64_t>()] = {frame["bus"], frame["text"]};
    if (frames.empty()) return all;
    before = frames[0]["n"];
  }
}

std::vector<Said> decoded(Page& page, const fs::path& plant) {
  std::vector<Said> all;
  runtime::BusWords words(tools::bus_names_of(plant.string(), tools::CompileFlags{}));
  std::string bytes;
  Json next = 0, until = nullptr;
  while (!next.is_null()) {
    const Json reply = page.ask({{"do", "bus.save"}, {"form", "pcapng"}, {"after", next}, {"until", until}});
    if (!reply.value("ok", false)) return {};  // it has no line
    bytes += bytes_of_base64(reply["base64"].get<std::string>());
    next = reply["next"];
    until = reply["until"];
  }
  tools::read_log(bytes, {[&](const runtime::LogEntry& entry, tools::LogPlace) {
                     all.push_back({entry.bus, words.describe(entry.bus, entry.frame).text});
                   },
                   [&](const runtime::SerialEntry& entry, tools::LogPlace) {
                     all.push_back({entry.line, words.describe(entry.reception)});
                   },
                   [&](const runtime::ProfibusEntry& entry, tools::LogPlace) {
                     all.push_back({entry.line, words.describe(entry.line, entry.reception)});
                   },
                   [](tools::LogPlace, const std::string& message) { ADD_FAILURE() << message; }});
  return all;
}

TEST(ExampleWords, AreThoseOfBusDecode) {
  size_t telegrams = 0, with_telegrams = 0;
  for (const fs::path& path : plants()) {
    SCOPED_TRACE(path.string());
    ServedPage page([path] {
      return tools::make_plant(tools::read_plant_input(path.string(), tools::CompileFlags{}, "sbus"), runtime::FileUse::Look);
    });
    ASSERT_TRUE(page.ask({{"do", "step"}, {"ms", 2000}}).value("ok", false));
    const auto told = on_the_page(page);
    const auto said = decoded(page, path);
    ASSERT_EQ(told.size(), said.size());
    size_t n = 0, wrong = 0;
    for (const auto& [number, one] : told) {
      if (one.text != said[n].text && wrong++ < 5)
        ADD_FAILURE() << one.line << " " << number << "\n  page:   " << one.text << "\n  decode: " << said[n].text;
      ++n;
    }
    telegrams += told.size();
    with_telegrams += told.empty() ? 0 : 1;
  }
  EXPECT_GT(telegrams, 5'000U);
  EXPECT_GT(with_telegrams, 10U);
}

}  // namespace
}  // namespace ipos::tests
