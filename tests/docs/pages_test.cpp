// The pages hang together: links lead somewhere, every page is in the index, every example in its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include "tests/harness/proves.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

const fs::path& root() {
  static const fs::path path = project("");
  return path;
}

std::vector<fs::path> pages() {
  std::vector<fs::path> found = {root() / "examples/README.md"};
  for (const auto& entry : fs::directory_iterator(root()))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  for (const auto& entry : fs::recursive_directory_iterator(root() / "docs"))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  return found;
}

// With the pages that stand beside the sources; packages of others bring their own.
std::vector<fs::path> all_markdown() {
  std::vector<fs::path> found = pages();
  for (const char* folder : {"tests", "tools", "python", "web", "packaging", "embed", "runtime", "examples"}) {
    if (!fs::exists(root() / folder)) continue;
    for (auto entry = fs::recursive_directory_iterator(root() / folder); entry != fs::recursive_directory_iterator(); ++entry)
      if (entry->path().filename() == "node_modules")
        entry.disable_recursion_pending();
      else if (entry->path().extension() == ".md" && entry->path() != root() / "examples/README.md")
        found.push_back(entry->path());
  }
  return found;
}

// The prose of a page: what a fence holds is no link.
std::string prose_of(const fs::path& page) {
  std::istringstream lines(read_text(page.string()));
  std::string prose;
  bool fenced = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```"))
      fenced = !fenced;
    else if (!fenced)
      prose += line + "\n";
  }
  return prose;
}

// The names of a page's headings in links, as web servers for Git make them: small letters, a hyphen for a space.
std::set<std::string> anchors_of(const fs::path& page) {
  std::set<std::string> anchors;
  std::istringstream lines(prose_of(page));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("#")) continue;
    std::string anchor;
    for (const char c : line.substr(line.find_first_not_of("# "))) {
      if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')
        anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      else if (c == ' ')
        anchor += '-';
    }
    anchors.insert(anchor);
  }
  return anchors;
}

// What the links of a page name, as they stand there.
std::vector<std::string> links_of(const fs::path& page) {
  static const std::regex kLink(R"(\]\(([^)\s]+)\))");
  const std::string prose = prose_of(page);
  std::vector<std::string> links;
  for (std::sregex_iterator it(prose.begin(), prose.end(), kLink), end; it != end; ++it)
    if ((*it)[1].str().find("://") == std::string::npos) links.push_back((*it)[1].str());
  return links;
}

// Where the links of a page lead, relative to the root of the project.
std::set<std::string> targets_of(const fs::path& page) {
  std::set<std::string> targets;
  for (const std::string& link : links_of(page))
    targets.insert((page.parent_path() / link.substr(0, link.find('#')))
                       .lexically_relative(root())
                       .lexically_normal()
                       .string());
  return targets;
}

// The page that ./dev web makes: what stands behind # names an example or a message with an IPOS program, or has a plant in it;
// what is in that one try_links.py reads.
constexpr std::string_view kRunning = "build/web/ipos.html";

bool runs(const std::string& fragment) {
  constexpr std::string_view kPlant = "plant=";
  if (fragment.starts_with(kPlant) && fragment.size() > kPlant.size()) return true;
  static const std::regex kNamed(R"((example|message)=([\w-]+)(\.right)?)");
  std::smatch named;
  if (!std::regex_match(fragment, named, kNamed)) return false;
  if (named[1] == "example") return !named[3].matched && fs::exists(root() / "examples" / named[2].str());
  const fs::path page = root() / "docs/reference/diagnostics" / (named[2].str() + ".md");
  return fs::exists(page) && read_text(page).find("```ipc\n") != std::string::npos;
}

TEST(Pages, LinksLeadSomewhere) {
  size_t count = 0;
  for (const fs::path& page : all_markdown()) {
    for (const std::string& link : links_of(page)) {
      SCOPED_TRACE(page.string() + ": " + link);
      ++count;
      const size_t hash = link.find('#');
      const fs::path target = hash == 0 ? page : page.parent_path() / link.substr(0, hash);
      if (target.lexically_normal() == (root() / kRunning).lexically_normal()) {
        EXPECT_TRUE(runs(link.substr(hash + 1)));
        continue;
      }
      ASSERT_TRUE(fs::exists(target));
      EXPECT_TRUE(hash == std::string::npos || anchors_of(target).contains(link.substr(hash + 1)));
    }
  }
  EXPECT_GT(count, 100U);
}

// `docs/guide/tour.md` and the like in prose and in messages.
TEST(Pages, PathsInProseLeadSomewhere) {
  static const std::regex kPath(R"(\bdocs/[\w/-]+\.\w+)");
  for (const fs::path& page : pages()) {
    const std::string text = read_text(page.string());
    for (std::sregex_iterator it(text.begin(), text.end(), kPath), end; it != end; ++it)
      EXPECT_TRUE(fs::exists(root() / it->str())) << page << ": " << it->str();
  }
}

TEST(Pages, IndexHasEveryPage) {
  const std::set<std::string> index = targets_of(root() / "docs/README.md");
  for (const fs::path& page : pages()) {
    const fs::path name = page.lexically_relative(root());
    const std::string folder = name.parent_path().string();  // a folder of many pages has one entry
    if (name == "README.md" || name == "docs/README.md") continue;
    EXPECT_TRUE(index.contains(name.string()) || index.contains(folder)) << name;
  }
}

TEST(Pages, EveryPageStandsOnAShelf) {
  for (const auto& entry : fs::directory_iterator(root() / "docs"))
    EXPECT_TRUE(entry.is_directory() || entry.path().filename() == "README.md") << entry.path();
}

TEST(Pages, IndexOfExamplesHasEveryExample) {
  const std::set<std::string> index = targets_of(root() / "examples/README.md");
  for (const std::string folder : {"examples", "examples/embedding"})
    for (const auto& entry : fs::directory_iterator(root() / folder))
      if (entry.is_directory()) {
        const std::string name = entry.path().lexically_relative(root()).string();
        EXPECT_TRUE(index.contains(name)) << name;
      }
}

// The page shows the files that `ipos new` writes.
TEST(Pages, CiFilesAreThoseOfANewProject) {
  const std::string page = read_text(root() / "docs/guide/ci.md");
  for (const char* file : {"github.yml", "gitlab.yml"}) {
    const std::string text = read_text(root() / "tools/new/template" / file);
    EXPECT_NE(page.find("```yaml\n" + text + "```\n"), std::string::npos) << file;
  }
}

// What the manual names of a fieldbus card and the simulated one does not do.
TEST(Limits, NameTheOtherFunctionsOfAFieldbus) {
  PROVES("MDB-TOC-24");
  const std::string limits = prose_of(root() / "docs/reference/limits.md");
  for (const char* function : {"IPOS access", "engineering access over the fieldbus", "web diagnostics",
                               "motion control over the fieldbus"})
    EXPECT_NE(limits.find(function), std::string::npos) << function;
}

}  // namespace
}  // namespace ipos::tests
