// The traffic of a line: every telegram with its rhythm, and its worst-case response time.
#pragma once

#include <vector>

#include "runtime/bus_plan/plan.hpp"
#include "runtime/bus_plan/roster.hpp"

namespace ipos::runtime {

std::vector<PlannedTelegram> planned_telegrams(const LineRoster& roster, const SeenTelegrams& seen,
                                               const PlanOptions& options);

// Fills the response times. The jitter of an answer is the response time of its request and the longest wait
// of the unit, so the analysis is repeated until nothing changes any more.
void analyse(std::vector<PlannedTelegram>& telegrams, Time bit_time);

// Worst-case bits per second.
uint64_t worst_load(const std::vector<PlannedTelegram>& telegrams);

}  // namespace ipos::runtime
