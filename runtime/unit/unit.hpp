// One unit: the program on its machine, the drive with its parameters, positioning and timers, and what a
// millisecond does to them (docs/inside/cycle.md). It knows plain milliseconds; who executes them, and when, is a
// matter of runtime/pace and of ManyTicks.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/commands/movilink_command.hpp"
#include "runtime/commands/positioning_commands.hpp"
#include "runtime/commands/system_commands.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/services/mirrored_values.hpp"
#include "runtime/services/pid_block.hpp"
#include "runtime/services/synchronous_service.hpp"
#include "runtime/services/timers.hpp"
#include "runtime/unit/unit_interface.hpp"
#include "runtime/unit/execution.hpp"
#include "runtime/unit/unit_inputs.hpp"
#include "runtime/unit/unit_program.hpp"
#include "vm/exec/machine.hpp"
#include "vm/image/image.hpp"
#include "vm/sched/scheduler.hpp"

namespace ipos::runtime {

// What a unit type allows a program.
vm::Limits limits_of(const stdlib::UnitType& unit);

struct UnitConfig {
  std::string name;  // of the station, for messages
  const stdlib::UnitType& type;
  MachineData machine;
  DriveOptions options;
};

// Executes the commands of a millisecond in place of the scheduler.
class TaskRunner {
 public:
  // The commands left of this millisecond. False: it stops between two of them, and Unit::run_tasks() goes on.
  virtual bool run(vm::Machine& machine, vm::TickSteps& steps) = 0;

 protected:
  ~TaskRunner() = default;
};

class Unit final {
 public:
  // `program` is empty for a unit without IPOS program; it must pass verify() for the unit. `rates` stand for
  // P938 and P939. Clock and journal must outlive it.
  Unit(const EventQueue& clock, UnitConfig config, std::optional<vm::Image> program, Journal& journal,
       std::optional<vm::Rates> rates, const Execution& execution);

  // --- the millisecond, in the order of docs/inside/cycle.md ---
  // All of it but what is sent. False: the runner stops between two commands; run_tasks() goes on there, and
  // finish() is the rest.
  bool tick(Time now) {
    begin(now);
    if (!run_tasks()) return false;
    finish(now);
    return true;
  }
  void begin(Time now);   // inputs, positioning, drive, events, variables, timers, PID
  bool run_tasks();       // waits, interrupts, tasks
  void finish(Time now);  // what the program has written, its fault, the memory

  // The parts of begin(), for milliseconds in which the unit does nothing but move (MovingTicks).
  void move(Time now);         // inputs, positioning, drive
  void begin_moved(Time now);  // the rest
  // The next tick may be one in which the axis moves, and that is all. What is asked here stays so until somebody touches
  // the unit.
  bool can_only_move() const;
  // Where that is so: move(), again and again, at most so often, as long as nothing else happens: of all that begin_moved()
  // looks at and shows only positions change, and nobody needs to be told. Returns how often that was so; where it is less
  // than `most`, one more tick has moved, in which more has happened.
  Ticks move_on(Ticks most);
  // What so many of them have left, the last one at `now`; and its variables.
  void count_moved(Time now, Ticks ticks);
  void show_moved(Time now);
  // The axis follows a plan of positioning.
  bool is_led() const { return positioning_ && positioning_->leads(); }

  // Its parts, for milliseconds in which drive and positioning decide nothing.
  void advance(Ticks ticks);
  void count_timers();
  void take_variables(Time now);
  void store(Time now);  // at the end of each that is executed

  // --- power and program ---
  // Drive and positioning, before buses are connected; then restart_program_memory().
  void power_on();
  void restart_program_memory(Time now);
  void power_off();
  // The objects of SBus 1 or 2, which stay where they are.
  void connect(int sbus, VariableObjects& objects) { objects_[static_cast<size_t>(sbus - 1)] = &objects; }
  // The program memory is verified and started from its beginning; variables keep their values. Nothing when
  // it was started, else the rule that it breaks.
  std::optional<std::string> load_program();
  // A download: this program takes the place of the one in the program memory, and begins. Variables keep their values.
  // Nothing when it was done, else the rule that the program breaks; then the old one goes on.
  std::optional<std::string> take_program(vm::Image image);
  void stop_tasks();
  void use_runner(TaskRunner& runner) { runner_ = &runner; }
  // Stores what is still to be stored, at the end of the run. False: that failed, the journal says why.
  bool store_memory(Time now);

  // --- its parts ---
  OwnMilliseconds& milliseconds() { return milliseconds_; }
  const OwnMilliseconds& milliseconds() const { return milliseconds_; }
  const std::string& name() const { return config_.name; }
  const vm::Image* image() const { return image_ ? &*image_ : nullptr; }
  // It was started at least once; null: never.
  const UnitProgram* program() const { return program_.get(); }
  vm::Machine* machine() { return machine_ ? &*machine_ : nullptr; }
  const vm::Machine* machine() const { return machine_ ? &*machine_ : nullptr; }
  // The H variables: the unit has them with and without a program, so a master that knows indices only finds the
  // system variables alive (ours: the manuals tie them to the unit, not to its program). Empty for a unit without IPOS.
  std::span<int32_t> variables() { return drive_.memory().variables().words(); }
  std::span<const int32_t> variables() const { return drive_.memory().variables().words(); }
  bool has_variables() const { return config_.type.variables != 0; }
  UnitInterface& server() { return drive_; }
  const UnitInterface& server() const { return drive_; }
  Drive& drive() { return drive_.state(); }
  const Drive& drive() const { return drive_.state(); }
  UnitInputs& inputs() { return inputs_; }
  const UnitInputs& inputs() const { return inputs_; }
  const PositioningService* positioning() const { return positioning_ ? &*positioning_ : nullptr; }
  // It follows a master with its DRS card, or might in the next millisecond.
  bool synchronizes() const { return synchronous_ && synchronous_->selected(); }
  const SynchronousService* synchronous() const { return synchronous_ ? &*synchronous_ : nullptr; }
  const Timers& timers() const { return timers_; }
  // The unit has a PID controller, and it is on.
  bool controls() const { return pid_ && !PidBlock::is_off(variables()); }
  MovilinkCommand& movilink() { return movilink_; }
  const MovilinkCommand& movilink() const { return movilink_; }
  const std::array<VariableObjects*, 2>& objects() const { return objects_; }
  // Milliseconds so far that were more than counting: in all others drive and program decide nothing.
  uint32_t executed() const { return executed_; }
  // Commands of the tasks in a millisecond.
  const vm::Rates& rates() const { return rates_ ? *rates_ : drive_.rates(); }
  // Programs started so far: what was found out about one holds for it alone.
  uint32_t programs() const { return programs_; }
  // The program has a fault that was not told yet.
  bool has_fresh_fault() const { return machine_ && machine_->fault().number != 0 && !fault_reported_; }
  // "SCOM1.IPC:12:5" of a word address, or empty.
  std::string source_place(uint32_t address) const;
  uint32_t source_line(uint32_t address) const;  // 12, or 0

 private:
  void move_on();
  bool had_only_moved() const;
  bool runs_image() const { return image_ && program_ && std::ranges::equal(program_->code(), image_->code); }
  void take_inputs();
  const PositionControl& order_position(Time now);
  void raise_events();
  void restart_after_reset(Time now);
  void show_variables(Time now);
  void show_positioning(Time now);
  void begin_variables();
  void start_machine();
  ProgramServices services();
  void report_drive(Time now);
  void report_reasons(Time now);
  void report_fault(Time now);
  void report_memory(Time now);
  void note(Time now, Weight weight, std::string text) {
    journal_.note(now, weight, config_.name, std::move(text));
  }

  // What every tick looks at stands together, as many units take turns.
  TaskRunner* runner_ = nullptr;
  bool in_tasks_ = false;        // the runner has stopped between two commands
  bool fault_reported_ = false;  // of the program
  uint32_t executed_ = 0;
  std::optional<vm::Rates> rates_;
  UnitInputs inputs_;
  Timers timers_;
  UnitInterface drive_;
  std::optional<vm::Machine> machine_;
  std::optional<PositioningService> positioning_;  // of a unit that has it
  std::optional<SynchronousService> synchronous_;  // of one with a master encoder at its DRS card

  const EventQueue& clock_;
  OwnMilliseconds milliseconds_;
  UnitConfig config_;
  Journal& journal_;
  Execution execution_;
  MovilinkCommand movilink_;
  std::array<VariableObjects*, 2> objects_{};  // of SBus 1 and 2; null for a bus it is not on

  std::optional<vm::Image> image_;
  std::shared_ptr<const UnitProgram> program_;  // what the machine runs: the verified program memory; null: nothing yet
  uint32_t programs_ = 0;

  // What works with the variables beside the program.
  std::optional<MirroredValues> mirrored_;
  std::optional<PidBlock> pid_;  // MOVIDRIVE B
  std::optional<PositioningCommands> positioning_commands_;
  std::optional<SystemCommands> commands_;
  vm::TickSteps steps_;  // with a runner

  bool was_off_ = false;
  uint32_t drive_changes_ = 0;  // as last told
  uint32_t drive_bits_ = 0;     // of H473, that follow from them
  uint32_t resets_seen_ = 0;    // of the drive's faults
  uint8_t error_seen_ = 0;      // error of the drive in the last millisecond
  // What was last told of the drive.
  uint8_t told_fault_ = 0;
  uint16_t told_reserved_ = 0;  // bits of the control word
  Block told_block_ = Block::None;
  SetpointNote told_note_ = SetpointNote::None;
};

}  // namespace ipos::runtime
