// Cases on several cores. Where processes can be copied (posix) each worker is one: a case that dies or hangs ends its worker
// and is a result, and another worker goes on. Else (windows) cases run here, one after the other.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/campaign/case_runner.hpp"
#include "tools/campaign/row.hpp"

namespace ipos::tools::campaign {

struct WorkOrder {
  const Campaign& campaign;
  const RowWriter& writer;
  // The levels of a case by its number, and what it is called.
  std::function<uint64_t(uint64_t number, Levels& levels)> case_of;
  std::vector<uint64_t> numbers;  // of the cases to run
  unsigned jobs = 1;
};

struct WorkListener {
  // Whole lines of results, in any order, with how many cases they are.
  std::function<void(std::string_view lines, uint64_t cases)> on_lines;
  // Several times a second. False: no more is wanted.
  std::function<bool()> go_on;
  // In the worker, when its cases are over; what it gives is handed to on_extra here. May be empty.
  std::function<std::string()> extra{};
  std::function<void(const std::string&)> on_extra{};
};

// Until all are done, or no more is wanted.
void run_cases(const WorkOrder& order, CaseRunner& runner, const WorkListener& listener);

}  // namespace ipos::tools::campaign
