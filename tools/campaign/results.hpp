// Folders of results, read together: the plan, and one row a case of it.
#pragma once

#include <string>
#include <vector>

#include "tools/campaign/row.hpp"

namespace ipos::tools::campaign {

// The plan beside the results, in one step; whoever has written the same before wrote the same bytes.
void write_outline(const std::string& folder, const Outline& outline);

// Of a file of results, also one that grows.
std::string read_results_file(const std::string& path);

struct Results {
  Outline outline;
  std::vector<Levels> levels;  // of each case of the plan, in its order
  std::vector<Row> rows;       // likewise; of a missing case only its name
  std::vector<bool> there;
  // For a person.
  std::vector<std::string> complaints;  // the results can be used, but are not all, or come twice
};

// Results of several campaigns, or of another state of one of its files, and rows that say different things of one case are a
// Failure.
Results read_results(const std::vector<std::string>& folders);

}  // namespace ipos::tools::campaign
