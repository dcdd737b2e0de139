// Where the commands of programs went, as plain data: of each task a tree of the functions that called each other, and in
// each what its lines have cost. Waits stand apart from work.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace ipos::tools::profile {

struct Line {
  std::string file;  // as the compiler was given it; empty: the image does not know it
  uint32_t line = 0;

  auto operator<=>(const Line&) const = default;
  std::string text() const;  // "SCOM1.IPC:12"
};

struct Cost {
  uint64_t commands = 0;
  double ms = 0;     // of the task: its commands over those that it has in a millisecond (P938, P939)
  double waits = 0;  // ms in which it could have worked and waited here

  Cost& operator+=(const Cost& other);
};

// A function as it was called on one way; the first one of a task or interrupt has no parent.
struct Node {
  std::string function;
  size_t parent = SIZE_MAX;
  uint64_t calls = 0;  // starts of the task and of interrupts are calls, too
  std::map<Line, Cost> lines;
};

struct Task {
  std::string name;  // "unit1.task1"; interrupt routines work in the time of a task
  std::vector<Node> nodes;
};

// A row of the table: a line of a function in a task, on whichever way it was called.
struct Row {
  Line line;
  std::string function;
  std::string task;
  Cost cost;
  uint64_t calls = 0;  // of the function
};

// The most expensive line first.
std::vector<Row> rows(const std::vector<Task>& tasks);

// "line function task commands ms calls waits", a row each; ms have three digits.
std::string table(const std::vector<Task>& tasks);

// The file format of https://www.speedscope.app: a profile each task, weights in milliseconds, waits as a frame of their own.
std::string speedscope(const std::vector<Task>& tasks, const std::string& name);

}  // namespace ipos::tools::profile
