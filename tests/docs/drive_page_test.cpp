// Tables of the pages that are rows of the project: faults in docs/inside/drive.md, settings without effect in
// docs/reference/limits.md.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <sstream>

#include "stdlib/faults.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/unsimulated.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

std::string response_parameter(const stdlib::FaultRow& row) {
  if (row.parameter == stdlib::kByCommand) return "`_FaultReaction`";
  return row.parameter.empty() ? "" : "P" + std::string(row.parameter);
}

TEST(DrivePage, FaultTable) {
  const stdlib::Parameter* p830 = stdlib::parameter_table(*stdlib::find_unit("md60a")).find("P830");
  std::vector<std::string> want;
  for (const stdlib::FaultRow& row : stdlib::fault_table())
    want.push_back(fmt::format("| F{:02} | {} | {} | {} | {} |", row.number, row.name,
                               stdlib::parameter_text(*p830, static_cast<int32_t>(row.response)),
                               response_parameter(row), row.meaning));
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
                               row.units.empty() ? "all" : row.units, row.text));
  std::vector<std::string> found;
  std::istringstream page(read_text(project("docs/reference/limits.md")));
  for (std::string line; std::getline(page, line);)
    if (line.size() > 3 && line.starts_with("| P") && line[3] >= '0' && line[3] <= '9') found.push_back(line);
  EXPECT_EQ(found, want);
}

}  // namespace
}  // namespace ipos::tests
