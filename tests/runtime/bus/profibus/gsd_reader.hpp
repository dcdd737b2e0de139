// A reader of GSD files that knows no more of ipos than they do: keys, modules, and what the standard forbids.
#pragma once

#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace ipos::tests {

struct Gsd {
  std::map<std::string, std::string> keys;
  std::vector<std::pair<std::string, std::string>> modules;  // name, identifiers
  std::vector<std::string> problems;
};

inline Gsd read_gsd(const std::string& text) {
  Gsd gsd;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  if (line != "#Profibus_DP") gsd.problems.push_back("first line");
  const std::regex module("Module=\"([^\"]*)\" ((0x[0-9A-F]{2},?)+)");
  const std::regex key("([A-Za-z0-9_.]+)=(\"[^\"]{0,32}\"|[0-9]+|0x[0-9A-F]{4})");
  std::smatch match;
  bool open = false;
  while (std::getline(lines, line)) {
    if (line.size() > 80) gsd.problems.push_back("long: " + line);
    for (const char c : line)
      if (c < 0x20 || c > 0x7E || c == '@') gsd.problems.push_back("character: " + line);
    if (line.empty() || line[0] == ';') continue;
    if (line == "EndModule") {
      if (!open) gsd.problems.push_back(line);
      open = false;
    } else if (std::regex_match(line, match, module)) {
      if (open) gsd.problems.push_back(line);
      open = true;
      gsd.modules.emplace_back(match[1], match[2]);
    } else if (!open && std::regex_match(line, match, key)) {
      if (!gsd.keys.emplace(match[1], match[2]).second) gsd.problems.push_back("twice: " + line);
    } else {
      gsd.problems.push_back(line);
    }
  }
  return gsd;
}

}  // namespace ipos::tests
