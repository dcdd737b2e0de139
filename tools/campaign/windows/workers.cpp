// A process cannot be copied: cases run here, and one that hangs or dies is not survived.
#include "tools/campaign/workers.hpp"

namespace ipos::tools::campaign {

void run_cases(const WorkOrder& order, CaseRunner& runner, const WorkListener& listener) {
  Levels levels;
  for (const uint64_t number : order.numbers) {
    if (!listener.go_on()) break;
    const uint64_t id = order.case_of(number, levels);
    const Outcome outcome = runner.run(levels);
    std::string line;
    order.writer.append(line, id, levels, outcome.measures, outcome.failed, outcome.hash ? hex(*outcome.hash) : "", outcome.ms);
    listener.on_lines(line, 1);
  }
  if (listener.extra && listener.on_extra) listener.on_extra(listener.extra());
}

}  // namespace ipos::tools::campaign
