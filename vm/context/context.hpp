// What executes commands: the three tasks, and the interrupt routines that break into them. Each has a
// context of its own, so that a routine never shares the call depth or the wait of what it interrupts (ours).
//
// Contexts are numbered: 1..3 the tasks, then ERROR, TOUCH PROBE and TIMER 0 of task 1, then the variable
// interrupts 0..3. This number is what the host gets with a command and gives back to Machine::resume.
#pragma once

#include <array>
#include <cstdint>

namespace ipos::vm {

inline constexpr uint32_t kMaxCallDepth = 32;  // that of every unit
inline constexpr int kTasks = 3;

// Interrupts of task 1, the highest priority first (IPOSplus p. 342).
enum class Event : uint8_t { Error, TouchProbe, Timer0 };
inline constexpr int kEvents = 3;
inline constexpr int kVariableInterrupts = 4;  // IPOSplus p. 45
inline constexpr int kContexts = kTasks + kEvents + kVariableInterrupts;

constexpr int context_of(Event event) { return kTasks + 1 + static_cast<int>(event); }
constexpr int context_of_variable_interrupt(int number) { return kTasks + kEvents + 1 + number; }

// "task 1", "interrupt TIMER 0", "variable interrupt 2"
const char* context_name(int context);

enum class TaskState : uint8_t {
  Stopped,  // never started, ended, or stopped
  Ready,    // executes when it gets commands
  Waiting,  // inside a waiting command, for the host or for wait_ms to pass
};

struct TaskContext {
  TaskState state = TaskState::Stopped;
  uint8_t depth = 0;      // entries in use of `calls`
  uint8_t task = 0;       // whose commands it uses; a task its own
  uint8_t rank = 0;       // among the contexts of a task the highest executes; a task has 0
  uint32_t pc = 0;        // word address of the command to be executed next, or being waited in
  uint32_t wait_ms = 0;   // WAIT: ticks still to pass; 0 while waiting: for the host
  uint64_t commands = 0;  // executed since the start
  std::array<uint16_t, kMaxCallDepth> calls{};  // return addresses
};

}  // namespace ipos::vm
