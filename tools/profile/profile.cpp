// The table of a profile.
#include "tools/profile/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace ipos::tools::profile {

std::string Line::text() const { return file.empty() ? "?" : fmt::format("{}:{}", file, line); }

Cost& Cost::operator+=(const Cost& other) {
  commands += other.commands;
  ms += other.ms;
  waits += other.waits;
  return *this;
}

std::vector<Row> rows(const std::vector<Task>& tasks) {
  std::vector<Row> all;
  for (const Task& task : tasks) {
    std::map<std::string, uint64_t> calls;
    std::map<std::pair<Line, std::string>, Cost> costs;
    for (const Node& node : task.nodes) {
      calls[node.function] += node.calls;
      for (const auto& [line, cost] : node.lines) costs[{line, node.function}] += cost;
    }
    for (const auto& [key, cost] : costs)
      all.push_back({key.first, key.second, task.name, cost, calls.at(key.second)});
  }
  std::stable_sort(all.begin(), all.end(), [](const Row& a, const Row& b) {
    return std::tuple(a.cost.commands, a.cost.waits) > std::tuple(b.cost.commands, b.cost.waits);
  });
  return all;
}

std::string table(const std::vector<Task>& tasks) {
  const std::vector<Row> all = rows(tasks);
  size_t place = 4, function = 8, task = 4;
  for (const Row& row : all) {
    place = std::max(place, row.line.text().size());
    function = std::max(function, row.function.size());
    task = std::max(task, row.task.size());
  }
  std::string out = fmt::format("{:<{}}  {:<{}}  {:<{}}  {:>10}  {:>12}  {:>8}  {:>12}\n", "line", place, "function", function, "task",
                                task, "commands", "ms", "calls", "waits");
  for (const Row& row : all)
    out += fmt::format("{:<{}}  {:<{}}  {:<{}}  {:>10}  {:>12.3f}  {:>8}  {:>12.3f}\n", row.line.text(), place, row.function,
                       function, row.task, task, row.cost.commands, row.cost.ms, row.calls, row.cost.waits);
  return out;
}

}  // namespace ipos::tools::profile
