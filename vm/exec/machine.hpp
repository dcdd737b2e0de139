// The VM of one unit: H variables and the tasks of a verified program. Everything it knows is in this object;
// it takes no memory after construction, reads no clock and calls nothing but its host.
//
// Time is counted in commands: run(task, budget) executes at most `budget` commands of one task and says why
// it stopped. Who calls it how often is vm/sched.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "vm/host/host.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::vm {

inline constexpr uint32_t kMaxVariables = 1024;
inline constexpr uint32_t kMaxCallDepth = 64;
inline constexpr int kTasks = 3;

enum class TaskState : uint8_t {
  Stopped,  // never started, ended, or stopped
  Ready,    // executes when it gets commands
  Waiting,  // inside a waiting command, for the host or for wait_ms to pass
};

struct TaskContext {
  TaskState state = TaskState::Stopped;
  uint8_t depth = 0;      // entries in use of `calls`
  uint32_t pc = 0;        // word address of the command to be executed next, or being waited in
  uint32_t wait_ms = 0;   // WAIT: ticks still to pass
  uint64_t commands = 0;  // executed since the start
  std::array<uint32_t, kMaxCallDepth> calls{};  // return addresses
};

// Faults a program can cause by itself.
inline constexpr uint8_t kFaultIllop = 10;          // F10 IPOS ILLOP
inline constexpr uint8_t kFaultIndexOverflow = 32;  // F32 IPOS index overflow

struct Fault {
  uint8_t number = 0;            // drive fault number; 0 = none
  uint8_t task = 0;              // 1..3
  uint32_t address = 0;          // word address of the command
  const char* reason = nullptr;  // static text
};

enum class Stop : uint8_t {
  Budget,   // the budget is used up
  Waiting,  // the task waits
  Ended,    // the task has ended or is not running
  Faulted,  // the program caused a fault: see Machine::fault(). All tasks are stopped.
};

struct RunResult {
  Stop stop;
  uint32_t commands;  // executed in this call
};

class Machine {
 public:
  explicit Machine(const VerifiedImage& program, const Host& host);

  // Starts task 1 at word 0 with all tasks reset; variables keep their values.
  void start();
  // Starts a task (1..3) at a verified command start, from its beginning even if it is running.
  void start_task(int task, uint32_t address);
  void stop_task(int task);
  void stop_all();

  // Executes at most `budget` commands of a task. Exact: a budget of 1 is a single step.
  RunResult run(int task, uint32_t budget);

  // One millisecond has passed: WAIT counts down, tasks whose wait is over become ready.
  void tick();

  // The host has finished the command the task waits in: it goes on behind it.
  void resume(int task);

  std::span<int32_t> variables() { return {h_.data(), program_.limits().variables}; }
  std::span<const int32_t> variables() const { return {h_.data(), program_.limits().variables}; }
  const TaskContext& task(int task) const { return tasks_[static_cast<size_t>(task - 1)]; }
  const Fault& fault() const { return fault_; }
  const VerifiedImage& program() const { return program_; }

 private:
  TaskContext& context(int task) { return tasks_[static_cast<size_t>(task - 1)]; }
  void raise(int task, uint8_t number, const char* reason);
  Stop execute(int task, TaskContext& t);

  VerifiedImage program_;
  Host host_;
  Fault fault_;
  std::array<TaskContext, kTasks> tasks_{};
  std::array<int32_t, kMaxVariables> h_{};
};

}  // namespace ipos::vm
