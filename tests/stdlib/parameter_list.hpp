// Reads stdlib/parameters/*.tsv anew for tests: only the cells, no shared code with the library, so that
// rules can be computed independently of it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace ipos::tests {

using Cells = std::map<std::string, std::string>;  // by column name

inline std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

inline std::vector<Cells> read_list(const std::string& file) {
  std::vector<Cells> rows;
  std::ifstream in(std::filesystem::path(IPOS_PARAMETER_LISTS) / file);
  std::vector<std::string> columns;
  std::string line;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> cells = split(line, '\t');
    if (columns.empty()) {
      columns = cells;
      continue;
    }
    Cells row;
    for (size_t i = 0; i < columns.size() && i < cells.size(); ++i) row[columns[i]] = cells[i];
    rows.push_back(row);
  }
  return rows;
}

// The rules of one index as a test computes them from the printed cells.
struct ListedParameter {
  Cells cells;
  uint16_t index = 0;
  std::vector<std::array<int64_t, 3>> ranges;  // minimum, maximum, step
  std::map<int64_t, bool> codes;               // code -> LOGODrive only
  int64_t default_value = 0;

  bool has(const std::string& letter) const {
    for (const std::string& word : split(cells.at("access"), '/'))
      if (word == letter) return true;
    return false;
  }
  bool free() const { return ranges.empty() && codes.empty(); }
  int64_t minimum() const {
    return !ranges.empty() ? ranges.front()[0] : !codes.empty() ? codes.begin()->first : INT32_MIN;
  }
  int64_t maximum() const {
    return !ranges.empty() ? ranges.back()[1] : !codes.empty() ? codes.rbegin()->first : INT32_MAX;
  }
  bool legal(int64_t value) const {
    for (const auto& [low, high, step] : ranges)
      for (int64_t at = low; step > 1000 && at <= high; at += step)
        if (at == value) return true;
    for (const auto& [low, high, step] : ranges)
      if (step <= 1000 && value >= low && value <= high && (value - low) % step == 0) return true;
    return free() || codes.count(value) > 0;
  }
  // Can these bits be sent at all? Unsigned where the maximum needs it.
  bool sendable(int64_t value) const {
    return maximum() > INT32_MAX ? value >= 0 && value <= UINT32_MAX
                                 : value >= INT32_MIN && value <= INT32_MAX;
  }
};

// The leading rows of a unit's list by index. `files` in order, later ones replace rows of the same number.
inline std::map<uint16_t, ListedParameter> listed(const std::vector<std::string>& files,
                                                  bool option_cards = true) {
  std::vector<Cells> rows;
  for (const std::string& file : files)
    for (const Cells& row : read_list(file)) {
      const std::string& number = row.at("number");
      if (file != files.front())
        std::erase_if(rows, [&](const Cells& old) { return !number.empty() && old.at("number") == number; });
      rows.push_back(row);
    }
  std::map<uint16_t, ListedParameter> result;
  for (const Cells& row : rows) {
    if (row.at("role") == "view" || row.at("index").empty()) continue;
    if (!option_cards && !row.at("option").empty()) continue;
    ListedParameter p;
    p.cells = row;
    p.index = static_cast<uint16_t>(std::stoi(row.at("index")));
    p.default_value = std::stoll(row.at("default"));
    if (!row.at("range").empty())
      for (const std::string& range : split(row.at("range"), ';')) {
        std::array<int64_t, 3> r{};
        char dots = 0;
        std::istringstream(range) >> r[0] >> dots >> dots >> r[1] >> dots >> r[2];
        p.ranges.push_back(r);
      }
    std::string texts = row.at("texts");
    if (texts.rfind("=P", 0) == 0)
      for (const Cells& other : rows)
        if (other.at("number") == texts.substr(2)) {
          texts = other.at("texts");
          break;
        }
    if (!texts.empty())
      for (const std::string& entry : split(texts, '|'))
        p.codes[std::stoll(entry)] = entry.find("*=") != std::string::npos;
    result[p.index] = p;
  }
  return result;
}

}  // namespace ipos::tests
