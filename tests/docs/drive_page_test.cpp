// docs/drive.md: its table of faults is the one of stdlib/faults.def, row by row.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <sstream>

#include "stdlib/faults.hpp"
#include "stdlib/parameters.hpp"
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
  std::istringstream page(read_text(project("docs/drive.md")));
  for (std::string line; std::getline(page, line);)
    if (line.starts_with("| F")) found.push_back(line);
  EXPECT_EQ(found, want);
}

}  // namespace
}  // namespace ipos::tests
