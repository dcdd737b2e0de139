// The tasks of a program: what each does, and where it stands.
#include <fmt/format.h>

#include "runtime/signals/collector.hpp"

namespace ipos::signals {

using namespace runtime;

void add_tasks(Collector& out) {
  const Station& station = out.station();
  if (station.image() == nullptr) return;
  for (int task = 1; task <= station.config().unit->tasks; ++task) {
    out.add(Group::Task, fmt::format("task{}.state", task), "0 stopped, 1 ready, 2 waiting",
            [&station, task]() -> int64_t {
              if (station.machine() == nullptr) return 0;
              return static_cast<int64_t>(station.machine()->task(task).state);
            });
    out.add(Group::Task, fmt::format("task{}.line", task), "source line it stands at; 0 stopped",
            [&station, task]() -> int64_t {
              if (station.machine() == nullptr) return 0;
              const vm::TaskContext& context = station.machine()->task(task);
              return context.state == vm::TaskState::Stopped ? 0 : station.source_line(context.pc);
            });
  }
}

}  // namespace ipos::signals
