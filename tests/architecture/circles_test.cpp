// No folder includes, directly or by others, a folder that includes it; and rooms of verbs do not know each other. Both are
// read from the #include lines of all sources, so that it holds for sources that this system does not compile, too.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {
namespace fs = std::filesystem;

// For each folder the folders that its sources include, and a line that does so.
using Includes = std::map<std::string, std::map<std::string, std::string>>;

Includes includes() {
  Includes found;
  const fs::path root = IPOS_SOURCE_DIR;
  const std::regex include(R"re(^\s*#\s*include\s+"([^"]+)".*)re");
  for (const char* top : {"stdlib", "compiler", "vm", "runtime", "embed", "tools"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      static const std::set<std::string> kSources = {".cpp", ".hpp", ".h", ".def", ".y", ".l"};
      if (!kSources.contains(entry.path().extension())) continue;
      const std::string folder = entry.path().parent_path().lexically_relative(root);
      std::ifstream text(entry.path());
      std::smatch match;
      for (std::string line; std::getline(text, line);)
        if (std::regex_match(line, match, include) && fs::exists(root / match[1].str())) {
          const std::string to = fs::path(match[1].str()).parent_path();
          if (to != folder) found[folder].emplace(to, entry.path().filename().string() + ": " + line);
        }
    }
  return found;
}

// Follows the includes from `folder`; true when one of them leads back to a folder of the way.
bool circle(const Includes& all, const std::string& folder, std::vector<std::string>& way, std::set<std::string>& clean) {
  if (clean.contains(folder)) return false;
  const bool back = std::find(way.begin(), way.end(), folder) != way.end();
  way.push_back(folder);
  if (back) return true;
  if (const auto own = all.find(folder); own != all.end())
    for (const auto& [to, line] : own->second)
      if (circle(all, to, way, clean)) return true;
  way.pop_back();
  clean.insert(folder);
  return false;
}

TEST(Folders, StandInNoCircle) {
  const Includes all = includes();
  ASSERT_GT(all.size(), 50U);
  std::set<std::string> clean;
  for (const auto& [folder, to] : all) {
    std::vector<std::string> way;
    if (!circle(all, folder, way, clean)) continue;
    std::string told;
    const auto begin = std::find(way.begin(), way.end(), way.back());
    for (auto step = begin; step + 1 != way.end(); ++step)
      told += *step + " -> " + step[1] + "  " + all.at(*step).at(step[1]) + "\n";
    FAIL() << told;
  }
}

// A room of verbs is a folder of tools that has a file verb_*.cpp of other than completion.
TEST(Folders, RoomsOfVerbsDoNotKnowEachOther) {
  std::set<std::string> rooms;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(IPOS_SOURCE_DIR) / "tools"))
    if (entry.path().filename().string().starts_with("verb_"))
      rooms.insert(entry.path().parent_path().lexically_relative(IPOS_SOURCE_DIR));
  rooms.erase("tools/cli");  // `ipos completion`, which prints the options of all
  ASSERT_GT(rooms.size(), 5U);
  const Includes all = includes();
  for (const auto& [room, known] : all) {
    if (!rooms.contains(room)) continue;
    for (const auto& [to, line] : known) EXPECT_FALSE(rooms.contains(to)) << room << " -> " << to << "  " << line;
  }
}

// What the host of the page includes, directly or by others of ours: a browser's worker and Windows have it, too.
TEST(Folders, TheHostOfThePageKnowsNoSocketsProcessesAndThreads) {
  const fs::path root = IPOS_SOURCE_DIR;
  const std::regex include(R"re(^\s*#\s*include\s+(["<])([^">]+)[">].*)re");
  const std::regex outside(
      "(thread|mutex|condition_variable|future|pthread\\.h|unistd\\.h|poll\\.h|sched\\.h|csignal|signal\\.h|sys/.*|boost/.*|"
      "windows\\.h|netinet/.*|arpa/.*|fcntl\\.h)");
  std::vector<fs::path> all;
  for (const auto& entry : fs::directory_iterator(root / "tools/serve/host")) all.push_back(entry.path());
  ASSERT_GT(all.size(), 20U);
  std::set<fs::path> known(all.begin(), all.end());
  for (size_t n = 0; n < all.size(); ++n) {
    std::ifstream text(all[n]);
    std::smatch match;
    for (std::string line; std::getline(text, line);) {
      if (!std::regex_match(line, match, include)) continue;
      EXPECT_FALSE(match[1] == "<" && std::regex_match(match[2].str(), outside)) << all[n] << ": " << line;
      if (const fs::path other = root / match[2].str(); fs::exists(other) && known.insert(other).second) all.push_back(other);
    }
  }
}

}  // namespace
