// Tables of the pages that are rows of the project: faults in docs/inside/drive.md, settings without effect in
// docs/reference/limits.md.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "stdlib/faults.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/unsimulated.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

std::string response_parameter(const stdlib::FaultRow& row) {
  if (row.parameter == stdlib::kByCommand) return "`_FaultReaction`";
  std::string text = row.parameter.empty() ? "" : "P" + std::string(row.parameter);
  if (const size_t comma = text.find(','); comma != std::string::npos) text.replace(comma, 1, ", P");
  return text;
}

// "no process data over the SBus within P883 (mdxb); within P815 (md60a, compact, mc07)", in the words of each unit.
std::string meanings(const stdlib::FaultRow& row) {
  std::vector<std::pair<std::string, std::string>> groups;  // text, units
  for (const stdlib::UnitType& unit : stdlib::unit_types()) {
    const std::string text = stdlib::meaning_on(unit, row);
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& one) { return one.first == text; });
    if (same == groups.end())
      groups.emplace_back(text, unit.name);
    else
      same->second += ", " + std::string(unit.name);
  }
  if (groups.size() == 1) return groups[0].first;
  std::string all;
  for (const auto& [text, units] : groups) all += (all.empty() ? "" : "; ") + text + " (" + units + ")";
  return all;
}

TEST(DrivePage, FaultTable) {
  const stdlib::Parameter* p830 = stdlib::parameter_table(*stdlib::find_unit("md60a")).find("P830");
  std::vector<std::string> want;
  for (const stdlib::FaultRow& row : stdlib::fault_table())
    want.push_back(fmt::format("| F{:02} | {} | {} | {} | {} |", row.number, row.name,
                               stdlib::parameter_text(*p830, static_cast<int32_t>(row.response)),
                               response_parameter(row), meanings(row)));
  std::vector<std::string> found;
  std::istringstream page(read_text(project("docs/inside/drive.md")));
  for (std::string line; std::getline(page, line);)
    if (line.starts_with("| F")) found.push_back(line);
  EXPECT_EQ(found, want);
}

// "P100, P200..P207"
std::string with_letters(std::string_view numbers) {
  std::string text;
  for (size_t n = 0; n < numbers.size(); ++n) {
    const bool begins = n == 0 || ((numbers[n - 1] == ',' || numbers[n - 1] == '.') && numbers[n] != '.');
    if (n > 0 && numbers[n - 1] == ',') text += ' ';
    if (begins) text += 'P';
    text += numbers[n];
  }
  return text;
}

TEST(LimitsPage, SettingsWithoutEffect) {
  const auto values = [](std::string_view codes) {
    std::string text(codes.empty() ? "any" : codes);
    for (size_t at = 0; (at = text.find(',', at)) < text.size(); at += 2) text.replace(at, 1, ", ");
    return text;
  };
  std::vector<std::string> want;
  for (const stdlib::UnsimulatedRow& row : stdlib::unsimulated_rows())
    want.push_back(fmt::format("| {} | {} | {} | {} |", with_letters(row.parameters), values(row.values),
                               row.unit_names(), row.text));
  std::vector<std::string> found;
  std::istringstream page(read_text(project("docs/reference/limits.md")));
  for (std::string line; std::getline(page, line);)
    if (line.size() > 3 && line.starts_with("| P") && line[3] >= '0' && line[3] <= '9') found.push_back(line);
  EXPECT_EQ(found, want);
}

}  // namespace
}  // namespace ipos::tests
