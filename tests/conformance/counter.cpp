// Counts how many rows of the conformance lists are proved by tests that passed, from the XML reports of all
// test programs: conformance_counter LISTS REPORTS [--unproved]. Proved is what a test shows where users go
// (tests/harness/reach.hpp); what only tests of C++ classes show is counted beside it. Fails when a test claims an id that no
// list has or when a report is missing. At the end come all skipped tests with their reasons: those of test programs, of pytest
// (*.pytest.xml) and of ctest (ctest.xml), where there are such reports; the last line is "N passed, N failed, N skipped".
#include <tinyxml2.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/harness/proves.hpp"
#include "tests/harness/reach.hpp"

namespace {

namespace fs = std::filesystem;

struct List {
  std::string file;
  std::vector<std::string> ids;  // in the order of the file
};

struct Findings {
  std::map<std::string, std::string> claimed;  // id -> a test that names it
  std::set<std::string> proved;
  std::set<std::string> by_classes;  // only, or also
  std::vector<std::string> skipped;  // "test: reason"
  int passed = 0;
  int failed = 0;
  bool complete = true;
};

std::vector<List> read_lists(const fs::path& folder) {
  std::vector<List> lists;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".tsv") continue;
    List list{entry.path().filename().string(), {}};
    std::ifstream in(entry.path());
    std::string line;
    std::getline(in, line);  // column names
    while (std::getline(in, line)) list.ids.push_back(line.substr(0, line.find('\t')));
    lists.push_back(std::move(list));
  }
  std::sort(lists.begin(), lists.end(), [](const List& a, const List& b) { return a.file < b.file; });
  return lists;
}

const char* text(const tinyxml2::XMLElement* element, const char* attribute) {
  const char* value = element->Attribute(attribute);
  return value ? value : "";
}

void read_case(const tinyxml2::XMLElement* test, Findings& findings) {
  const std::string name = std::string(text(test, "classname")) + "." + text(test, "name");
  if (std::string(text(test, "status")) != "run") {
    findings.skipped.push_back(name + ": disabled by its name");
    return;
  }
  if (const auto* skipped = test->FirstChildElement("skipped")) {
    std::string reason = text(skipped, "message");
    // GoogleTest puts file and line before the reason.
    if (const size_t end = reason.find('\n'); end != std::string::npos) reason.erase(0, end + 1);
    while (!reason.empty() && reason.back() == '\n') reason.pop_back();
    findings.skipped.push_back(name + ": " + (reason.empty() ? "no reason given" : reason));
    return;
  }
  const bool passed = test->FirstChildElement("failure") == nullptr;
  ++(passed ? findings.passed : findings.failed);
  const auto* properties = test->FirstChildElement("properties");
  if (!properties) return;
  bool reaches = false;
  for (const auto* p = properties->FirstChildElement("property"); p; p = p->NextSiblingElement("property"))
    reaches |= std::string(text(p, "name")) == ipos::tests::kGoesThrough;
  for (const auto* p = properties->FirstChildElement("property"); p; p = p->NextSiblingElement("property")) {
    const std::string value = text(p, "value");
    if (value != ipos::tests::kProves && value != ipos::tests::kByClasses) continue;
    findings.claimed.emplace(text(p, "name"), name);
    if (passed) (reaches && value == ipos::tests::kProves ? findings.proved : findings.by_classes).insert(text(p, "name"));
  }
}

// The first line of a text that is not blank.
std::string first_line(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t\r\n");
  return begin == std::string::npos ? "no reason given" : text.substr(begin, text.find('\n', begin) - begin);
}

// What pytest and ctest have skipped. Of ctest only what leaves no report of its own.
void read_skipped(const fs::path& folder, const std::set<std::string>& programs, Findings& findings) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (const std::string name = entry.path().filename().string(); name == "ctest.xml" || name.ends_with(".pytest.xml"))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    tinyxml2::XMLDocument report;
    if (report.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS || !report.RootElement()) continue;
    const auto* suite = report.RootElement();
    if (const auto* inner = suite->FirstChildElement("testsuite")) suite = inner;
    for (const auto* test = suite->FirstChildElement("testcase"); test; test = test->NextSiblingElement("testcase")) {
      const auto* skipped = test->FirstChildElement("skipped");
      const std::string name = text(test, "name");
      if (skipped == nullptr || programs.count(name) != 0) continue;
      const auto* said = test->FirstChildElement("system-out");
      const char* words = said != nullptr ? said->GetText() : text(skipped, "message");
      findings.skipped.push_back(file.filename() == "ctest.xml"
                                     ? name + ": " + first_line(words ? words : "")
                                     : std::string(text(test, "classname")) + "." + name + ": " + first_line(words ? words : ""));
    }
  }
}

Findings read_reports(const fs::path& folder) {
  Findings findings;
  std::ifstream names(folder / "tests.txt");
  std::set<std::string> programs;
  std::string name;
  while (std::getline(names, name)) {
    if (name.empty()) continue;
    programs.insert(name);
    tinyxml2::XMLDocument report;
    if (report.LoadFile((folder / (name + ".xml")).c_str()) != tinyxml2::XML_SUCCESS ||
        !report.RootElement()) {
      std::printf("%s has left no report: not run, or crashed\n", name.c_str());
      findings.complete = false;
      continue;
    }
    const auto* suite = report.RootElement()->FirstChildElement("testsuite");
    for (; suite; suite = suite->NextSiblingElement("testsuite"))
      for (const auto* t = suite->FirstChildElement("testcase"); t; t = t->NextSiblingElement("testcase"))
        read_case(t, findings);
  }
  read_skipped(folder, programs, findings);
  return findings;
}

// "M07-PAR-28" -> "M07-PAR"
std::string prefix(const std::string& id) { return id.substr(0, id.rfind('-')); }

struct Count {
  size_t proved = 0;
  size_t by_classes = 0;  // and not proved
  size_t total = 0;

  void add(const Findings& findings, const std::string& id) {
    const bool is_proved = findings.proved.count(id) != 0;
    proved += is_proved ? 1 : 0;
    by_classes += !is_proved && findings.by_classes.count(id) != 0 ? 1 : 0;
    ++total;
  }
  void print(const std::string& name) const {
    std::printf("%-28s %6zu %10zu %7zu\n", name.c_str(), proved, by_classes, total);
  }
};

int print(const std::vector<List>& lists, const Findings& findings, bool unproved) {
  std::set<std::string> known;
  Count all;
  bool sound = findings.complete;
  std::printf("%-28s %6s %10s %7s\n", "", "proved", "by classes", "of");
  for (const List& list : lists) {
    std::vector<std::string> prefixes;
    std::map<std::string, Count> counts;  // by prefix
    Count whole;
    for (const std::string& id : list.ids) {
      if (!known.insert(id).second) {
        std::printf("%s: id %s stands twice\n", list.file.c_str(), id.c_str());
        sound = false;
      }
      if (!counts.count(prefix(id))) prefixes.push_back(prefix(id));
      counts[prefix(id)].add(findings, id);
      whole.add(findings, id);
      all.add(findings, id);
      if (unproved && findings.proved.count(id) == 0)
        std::printf("%s %s\n", findings.by_classes.count(id) != 0 ? "by classes only" : "open", id.c_str());
    }
    whole.print(list.file);
    for (const std::string& p : prefixes) counts[p].print("  " + p);
  }
  all.print("conformance rows");
  std::printf("%zu of %zu statements are proved where users go (a plant file, a verb, the page, the C library, Python), "
              "%zu more by C++ classes only, %zu are open\n",
              all.proved, all.total, all.by_classes, all.total - all.proved - all.by_classes);
  for (const auto& [id, test] : findings.claimed) {
    if (known.count(id)) continue;
    std::printf("%s claims to prove %s, which no list has\n", test.c_str(), id.c_str());
    sound = false;
  }
  if (!findings.skipped.empty()) std::printf("skipped, and why:\n");
  for (const std::string& test : findings.skipped) std::printf("  %s\n", test.c_str());
  std::printf("%d passed, %d failed, %zu skipped\n", findings.passed, findings.failed,
              findings.skipped.size());
  return sound ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: conformance_counter LISTS REPORTS [--unproved]\n");
    return 64;
  }
  const bool unproved = argc > 3 && std::string(argv[3]) == "--unproved";
  return print(read_lists(argv[1]), read_reports(argv[2]), unproved);
}
