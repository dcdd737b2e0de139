// The VM of one unit: H variables, tasks and interrupts of a verified program. Everything it knows is in this
// object, a copy is a snapshot; it takes no memory, reads no clock and calls nothing but its host.
//
// Time is counted in commands: run(task, budget) executes at most `budget` commands of one task and says why
// it stopped. Who calls it how often is vm/sched.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "vm/context/context.hpp"
#include "vm/exec/idle.hpp"
#include "vm/exec/interrupts.hpp"
#include "vm/host/build.hpp"
#include "vm/host/host.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::vm {

// The unit looks at them in every tick (IPOSplus p. 29); what each is stands in stdlib/system_variables.def.
inline constexpr uint32_t kFirstSystemVariable = 453;
inline constexpr uint32_t kLastSystemVariable = 564;

// Faults a program can cause by itself.
inline constexpr uint8_t kFaultIllop = 10;          // F10 IPOS ILLOP
inline constexpr uint8_t kFaultIndexOverflow = 32;  // F32 IPOS index overflow

struct Fault {
  uint8_t number = 0;            // drive fault number; 0 = none
  uint8_t task = 0;              // 1..3
  uint8_t context = 0;           // the task itself, or the interrupt routine it was in
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

namespace fast {
class Predecoded;
struct Native;
}  // namespace fast

class Machine {
 public:
  explicit Machine(const VerifiedImage& program, const Host& host);

  // From now on the fast engine executes what it can, with the same results; null: the reference interpreter
  // alone. With `native` machine code executes what it can of that (vm/jit). Both must be made of this
  // machine's program and outlive the machine and its copies.
  void use(const fast::Predecoded* program, const fast::Native* native = nullptr) {
    fast_ = program;
    native_ = native;
  }

  // Starts task 1 at word 0 with all tasks stopped and no interrupt installed; variables keep their values.
  void start();
  // Starts a task (1..3) at a verified command start, from its beginning even if it is running.
  void start_task(int task, uint32_t address);
  // Ends a task in whatever it does, interrupt routines of it included.
  void stop_task(int task);
  void stop_all();

  // Executes at most `budget` commands of a task, its interrupt routines first. Exact: a budget of 1 is a
  // single step.
  RunResult run(int task, uint32_t budget);
  // The same of all tasks in turn. Returns the commands executed.
  uint32_t run_tasks(const std::array<uint32_t, kTasks>& budgets);

  // One millisecond has passed: WAIT counts down, contexts whose wait is over become ready, interrupts that
  // are due begin.
  void tick();

  // How many ticks from now on, each with these budgets of commands for the tasks, lead nowhere, if meanwhile
  // nobody else writes variables, resumes, raises events or starts and stops tasks: tasks wait, have ended,
  // or go round in a loop of at most `longest` commands that leaves all variables as they were and changes
  // none that others look at. Costs up to `longest` commands for each task. `found` is what skip_ticks() needs.
  static constexpr uint32_t kLongestLoop = 256;
  uint64_t idle_ticks(const std::array<uint32_t, kTasks>& budgets, Idle& found,
                      uint32_t longest = kLongestLoop);
  uint64_t idle_ticks(const std::array<uint32_t, kTasks>& budgets);

  // What `ticks` of tick() and run() do. At once, where the machine is in the state of `found`, which then is that
  // of the state it leaves; else one by one, and `found` is of no more use. Returns the commands executed.
  uint64_t skip_ticks(const std::array<uint32_t, kTasks>& budgets, Idle& found, uint64_t ticks);

  // `ticks` times tick() and run() with these budgets, the tasks one after the other instead of in turn.
  // False, and nothing has changed: that is not possible, as something else than variables and jumps would
  // come in between, or without the fast engine. Only for tasks that use no variable another one writes, nor
  // one that anybody else changes in these ticks (vm/sched/outlook.hpp), and not when interrupts have been
  // requested since the last tick. `rollback` are the variables that they can write.
  bool run_ahead(const std::array<uint32_t, kTasks>& budgets, uint32_t ticks,
                 std::span<const uint16_t> rollback);
  static constexpr size_t kMostRollback = 256;
  // The same; `before` takes what there was, for take_back(): after it the machine is as if run_ahead() had not been,
  // unless something else has changed it since.
  struct BeforeAhead;
  bool run_ahead(const std::array<uint32_t, kTasks>& budgets, uint32_t ticks,
                 std::span<const uint16_t> rollback, BeforeAhead& before);
  void take_back(std::span<const uint16_t> rollback, const BeforeAhead& before);
  // In so many of the next ticks no wait for a time is over.
  uint32_t waits_on() const;

  // An event of task 1 has happened. Without an installed routine nothing follows.
  void raise_event(Event event);

  // The host has finished the command the context waits in: it goes on after it. A context that no longer
  // waits for the host is left alone.
  void resume(int context);

  // A fault the program caused in the eyes of the unit (watchdog): all tasks stop where they are. It is
  // reported of the first task that runs, or of task 1.
  void raise_fault(uint8_t number, const char* reason);

  std::span<int32_t> variables() { return {h_.data(), program_.limits().variables}; }
  std::span<const int32_t> variables() const { return {h_.data(), program_.limits().variables}; }
  const TaskContext& task(int task) const { return context(task); }
  const TaskContext& context(int number) const { return contexts_[static_cast<size_t>(number - 1)]; }
  // What executes when the task gets commands: an interrupt routine, or the task itself.
  int active_context(int task) const { return active_[static_cast<size_t>(task - 1)] + 1; }
  const Interrupts& interrupts() const { return interrupts_; }
  const Fault& fault() const { return fault_; }
  const VerifiedImage& program() const { return program_; }

 private:
  friend class SavedState;
  TaskContext& context_at(int number) { return contexts_[static_cast<size_t>(number - 1)]; }
  void begin(int number, uint32_t address);
  void end(TaskContext& t);
  void stop_context(int number);
  void go_on(TaskContext& t);
  uint32_t run_fast(TaskContext& t, uint32_t budget);
  RunResult run_task(int task, uint32_t budget);
  RunResult run_on(int task, uint32_t budget, uint32_t used);
  void raise(int number, uint8_t fault, const char* reason);
  Stop execute(int number, TaskContext& t);

  void set_interrupt(int32_t keyword, uint32_t address);
  const char* set_variable_interrupt(uint32_t structure, uint32_t address);  // why not, or nullptr
  void pass_millisecond();
  void take_events();
  void take_variable_interrupts();
  void choose_active(int task);
  void see_interrupts();
  struct Spin;
  Spin find_spin(int number, uint32_t longest, Idle& found);
  bool executes(int task, const std::array<uint32_t, kTasks>& budgets) const;
  void note_state(Idle& found) const;
  bool is_in_state(const Idle& found, const std::array<uint32_t, kTasks>& budgets, uint64_t ticks) const;
  bool would_fault(const TaskContext& t, const Instruction& command) const;
  uint32_t index_of(const Instruction& command) const;
  bool try_command(int number, Spin& spin);
  bool interrupts_rest() const;
  bool begin_routine(int number, int task, uint8_t rank, uint32_t address);

  VerifiedImage program_;
  Host host_;
  const fast::Predecoded* fast_ = nullptr;
  const fast::Native* native_ = nullptr;
  Fault fault_;
  Interrupts interrupts_;
  // What follows from contexts and interrupts and is asked for in every millisecond.
  std::array<uint8_t, kTasks> active_{0, 1, 2};  // in contexts_, what executes of each task
  bool events_ = false;                          // an interrupt of task 1 is installed or pending
  bool watches_ = false;                         // a variable interrupt is installed
  bool waits_ = false;                           // a context may wait for time to pass
  uint32_t begun_ = 0;                           // contexts, since the machine was made
  std::array<TaskContext, kContexts> contexts_{};
  std::array<int32_t, kMaxVariables> h_{};
};

// What the fast engine changes of contexts, and variables that tasks can write.
struct Machine::BeforeAhead {
  struct Stand {
    void note(const TaskContext& t);
    void give_back(TaskContext& t) const;

    uint32_t pc;
    uint8_t depth;
    uint64_t commands;
    std::array<uint16_t, kMaxCallDepth> calls;
  };
  uint32_t ticks;
  size_t tasks;  // so many of them have a stand
  std::array<Stand, kTasks> stands;
  std::array<int32_t, kMostRollback> values;
};

}  // namespace ipos::vm
