// Counts how many rows of the conformance lists are proved by tests that passed, from the XML reports of all
// test programs: conformance_counter LISTS REPORTS [--unproved]. Fails when a test claims an id that no list
// has or when a report is missing. The last line is "N passed, N failed, N skipped".
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

namespace {

namespace fs = std::filesystem;

struct List {
  std::string file;
  std::vector<std::string> ids;  // in the order of the file
};

struct Findings {
  std::map<std::string, std::string> claimed;  // id -> a test that names it
  std::set<std::string> proved;
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
  for (const auto* p = properties->FirstChildElement("property"); p; p = p->NextSiblingElement("property")) {
    if (std::string(text(p, "value")) != ipos::tests::kProves) continue;
    findings.claimed.emplace(text(p, "name"), name);
    if (passed) findings.proved.insert(text(p, "name"));
  }
}

Findings read_reports(const fs::path& folder) {
  Findings findings;
  std::ifstream names(folder / "tests.txt");
  std::string name;
  while (std::getline(names, name)) {
    if (name.empty()) continue;
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
  return findings;
}

// "M07-PAR-28" -> "M07-PAR"
std::string prefix(const std::string& id) { return id.substr(0, id.rfind('-')); }

int print(const std::vector<List>& lists, const Findings& findings, bool unproved) {
  std::set<std::string> known;
  size_t total = 0;
  size_t covered = 0;
  bool sound = findings.complete;
  for (const List& list : lists) {
    std::vector<std::string> prefixes;
    std::map<std::string, std::pair<int, int>> counts;  // prefix -> covered, total
    int file_covered = 0;
    for (const std::string& id : list.ids) {
      if (!known.insert(id).second) {
        std::printf("%s: id %s stands twice\n", list.file.c_str(), id.c_str());
        sound = false;
      }
      if (!counts.count(prefix(id))) prefixes.push_back(prefix(id));
      const int proved = findings.proved.count(id) ? 1 : 0;
      counts[prefix(id)].first += proved;
      counts[prefix(id)].second += 1;
      file_covered += proved;
      if (unproved && !proved) std::printf("unproved %s\n", id.c_str());
    }
    std::printf("%-28s %4d / %zu\n", list.file.c_str(), file_covered, list.ids.size());
    for (const std::string& p : prefixes)
      std::printf("  %-26s %4d / %d\n", p.c_str(), counts[p].first, counts[p].second);
    total += list.ids.size();
    covered += static_cast<size_t>(file_covered);
  }
  std::printf("%-28s %4zu / %zu\n", "conformance rows proved", covered, total);
  for (const auto& [id, test] : findings.claimed) {
    if (known.count(id)) continue;
    std::printf("%s claims to prove %s, which no list has\n", test.c_str(), id.c_str());
    sound = false;
  }
  for (const std::string& test : findings.skipped) std::printf("skipped %s\n", test.c_str());
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
