// The forms in which `ipos campaign merge` writes results. All are decided by the results alone: the same cases give the same
// bytes, whoever ran them.
#pragma once

#include <string>

#include "tools/campaign/results.hpp"
#include "tools/coverage/coverage.hpp"

namespace ipos::tools::campaign {

// A column a factor, then a column a measure, a row a case of the plan. A case without results leaves the measures empty.
std::string csv_report(const Results& results);
// A test case a case, a failure a check that failed.
std::string junit_report(const Results& results);
// The rows as the shards have them, in the order of the plan.
std::string jsonl_report(const Results& results);
// One page for a browser, which stands alone.
std::string html_report(const Results& results, const coverage::Coverage* coverage);

// "hoist.P130 = 0.5 s, hoist.torque = 5 Nm".
std::string values_text(const Outline& outline, const Levels& levels);

}  // namespace ipos::tools::campaign
