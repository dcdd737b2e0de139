// A trace is read back as numbers.
#include "tests/fmi_import/folder.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace ipos::tests {

std::vector<std::vector<double>> traced(const FmuFolder& folder, const std::string& plant, const std::string& signals,
                                        const std::string& length) {
  const CommandResult result =
      folder.run({"run", plant, "--for", length, "--allow-fmu", "--trace", "trace.csv", "--signals", signals});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::istringstream lines(read_text(folder.path() / "trace.csv"));
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) {
      char* end = nullptr;
      const double value = std::strtod(cell.c_str(), &end);
      if (end != cell.c_str()) row.push_back(value);
    }
    if (!row.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace ipos::tests
