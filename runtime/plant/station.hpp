// One station: the VM with its program, the drive with its parameters, and the ports to the buses. Everything
// that happens in it happens in its millisecond tick or on the arrival of a frame; docs/cycle.md has the
// order.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/movilink/keypad.hpp"
#include "runtime/clock/backoff.hpp"
#include "runtime/plant/drive_server.hpp"
#include "runtime/plant/execution.hpp"
#include "runtime/plant/plant_file.hpp"
#include "runtime/plant/program_reach.hpp"
#include "runtime/plant/sbus_port.hpp"
#include "runtime/plant/serial_port.hpp"
#include "runtime/plant/station_inputs.hpp"
#include "runtime/services/journal.hpp"
#include "runtime/services/mirrored_values.hpp"
#include "runtime/services/noted_variables.hpp"
#include "runtime/services/pid_block.hpp"
#include "runtime/services/positioning_commands.hpp"
#include "runtime/services/sleeper.hpp"
#include "runtime/services/system_commands.hpp"
#include "runtime/services/timers.hpp"
#include "vm/exec/machine.hpp"
#include "vm/fast/predecode.hpp"
#include "vm/image/image.hpp"
#include "vm/sched/scheduler.hpp"

namespace ipos::runtime {

// What a unit type allows a program.
vm::Limits limits_of(const stdlib::UnitType& unit);

// The lines of a station; null where it is not connected.
struct StationLines {
  std::array<CanLine*, 2> sbus{};  // SBus 1 and 2
  Rs485Line* x13 = nullptr;
  Rs485Line* xt = nullptr;  // with a keypad the line to it
};

class Station;

// Executes commands in place of the scheduler: a debugger.
class CommandRunner {
 public:
  // The commands left of this millisecond. False: it stops between two of them; Station::resume_tick() goes
  // on, and until then no other event may run.
  virtual bool run(Station& station, vm::Machine& machine, vm::TickSteps& steps) = 0;

 protected:
  ~CommandRunner() = default;
};

class Station final : private EventTarget, private Sleeper {
 public:
  // `program` is empty for a station without IPOS program. The config and the journal must outlive the
  // station. Parameters of the config must be checked before (plant.cpp). The program must pass verify() for
  // the unit.
  Station(EventQueue& queue, uint32_t source, const StationConfig& config, std::optional<vm::Image> program,
          StationLines lines, Journal& journal, std::optional<vm::Rates> rates,
          const Execution& execution = {});

  // Applies a parameter of the plant file; nothing when it was accepted, else why not.
  std::optional<std::string> set_parameter(const ParameterSetting& setting);

  // Keeps what survives power-off on `medium`, and takes over what is there; nothing when that is possible,
  // else why not. Before the parameters are set. Without it everything is kept for the run only.
  std::optional<std::string> use_memory(std::unique_ptr<NvMedium> medium, std::string name) {
    return drive_.memory().open(std::move(medium), std::move(name));
  }

  // The first time after all parameters are set: connects to the bus and starts the program. After
  // power_off() the unit begins again with what its memory holds; parameters of the plant file are not set
  // again.
  void power_on();
  void power_off();
  bool powered() const { return powered_; }

  // The program memory, which may have been changed through indices 16000 + n, is verified and started from
  // its beginning; variables keep their values. Nothing when it was started, else the rule it breaks.
  std::optional<std::string> start_program();
  void stop_program();

  // From the next tick on; it must outlive the station.
  void use_runner(CommandRunner& runner) {
    leave_steady();
    runner_ = &runner;
  }
  // From now on no tick is left out or shortened.
  void stay_awake() {
    leave_steady();
    execution_.skip_idle = false;
  }
  // Ticks are being skipped; whoever reads the station first executes them.
  bool asleep() const {
    look();
    return asleep_;
  }
  // In the next tick drive and positioning decide nothing, unless somebody writes to the station before it.
  bool steady() const {
    look();
    return steady_;
  }
  using Sleeper::late;
  // Late, and its drive and positioning follow its tasks only when they are asked for.
  bool runs_ahead() const { return ahead_left_ != 0; }
  // The station stands in the middle of its tick.
  bool in_tick() const { return in_tick_; }
  void resume_tick();

  // Stores what is still to be stored, at the end of the run. False: that failed, the journal says why.
  bool store_memory();

  const StationConfig& config() const { return config_; }
  const vm::Image* image() const { return image_ ? &*image_ : nullptr; }
  const vm::Machine* machine() const {
    look();
    return machine_ ? &*machine_ : nullptr;
  }
  // To change something; what only reads takes the others, which let a station sleep.
  DriveServer& drive() {
    wake();
    return drive_;
  }
  const DriveServer& drive() const {
    look();
    return drive_;
  }
  uint16_t outputs() const {
    look();
    return drive_.state().outputs();
  }
  int32_t shaft_position() const {
    look();
    return drive_.state().shaft_position();
  }
  StationInputs& inputs() {
    wake();
    return inputs_;
  }
  const StationInputs& inputs() const { return inputs_; }
  // The first reader executes the pending ticks, so a read never sees old values.
  void look() const { const_cast<Station*>(this)->make_up(); }
  // As the parameter channel reads an index; 0 where it refuses.
  int32_t read(uint16_t index) const;

  // SBus 1 or 2; null when the station is not on it.
  const SbusPort* sbus(int number) const {
    look();
    return sbus_[static_cast<size_t>(number - 1)].get();
  }
  SbusPort* sbus(int number) {
    look();
    return sbus_[static_cast<size_t>(number - 1)].get();
  }

  // The MOVLNK of this structure was carried out, over whichever bus.
  bool has_called(uint32_t structure) const {
    look();
    return movilink_.has_called(structure);
  }

  // The program has ended, was never there, or a fault has stopped it.
  bool program_over() const;
  uint8_t fault() const;  // error or warning, 0 is none
  bool error() const;     // a fault that stops the drive until it is reset
  uint16_t status_word_1() const;

  // Number of the variable with this name (variable_names.hpp), of a whole the first; nothing when there is
  // none.
  std::optional<uint32_t> find_variable(std::string_view name) const;
  int32_t variable(uint32_t number) const {
    look();
    return machine_->variables()[number];
  }

  // "SCOM1.IPC:12:5" of a word address, or empty.
  std::string source_place(uint32_t address) const;

 private:
  static constexpr uint32_t kTick = 0;  // the only kind of event a station schedules

  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void tick(Time now);
  bool execute(Time now);
  void make_up() override;
  bool make_up_variables() override;
  void get_up();
  void touch() override;
  void run_late() override;
  bool keep(ObjectReader& reader, size_t object, const Frame& frame) override;
  void expect_variables(uint32_t first) override;
  void wake() override;
  Time last_tick() const;
  void leave_out_to(Time last);
  void execute_to(Time last);
  void execute_all_to(Time last);
  bool run_ahead(Time last);
  bool begin_ahead();
  void end_ahead() {
    if (ahead_left_ != 0 || behind_ != 0) finish_ahead();
  }
  void finish_ahead();
  void move_drive(Time now);
  bool stays_steady() {
    return drive_.state().steady_left() != 0 && inputs_.known() && (!touched_ || unwritten());
  }
  void steady_tick(Time now);
  void go_on(std::span<int32_t> h);
  // After the tasks: something has happened that a part of the unit must see.
  bool has_fresh_fault() const { return machine_->fault().number != 0 && !fault_reported_; }
  bool must_look() {
    return drive_.has_reasons() || has_fresh_fault() || ((!quiet_ || touched_) && !unwritten());
  }
  bool unwritten() { return !machine_ || noted_.same(machine_->variables()); }
  void leave_steady();
  void try_steady();
  void schedule_tick(Time now, Time telegram);
  void sleep_through(Time now);
  void try_sleep();
  void begin_trial();
  void try_program();
  uint64_t end_trial();
  void end_trial_without(Ticks longest);
  void try_late(Time now, Time telegram);
  bool can_be_late() const;
  void find_reach();
  void forget_reach();
  void connect_sbus(int number);
  void restart_program_memory();
  std::optional<std::string> load_program();
  void start_machine();
  void stop_tasks();
  void choose_engine(const vm::VerifiedImage& program);
  void note_memory(Time now);
  void connect_serial();
  void reconnect_serial();
  void begin_program(Time now);
  void show_positioning(Time now);
  void count_timers(std::span<int32_t> h);
  const vm::Rates& rates() const { return rates_ ? *rates_ : drive_.rates(); }
  bool run_commands();
  void end_program(Time now);
  Time send_telegrams(Time now);
  void settle(Time now);
  void raise_drive_events();
  void restart_after_reset(Time now);
  StationServices services();
  void report_reasons(Time now);
  void report_fault(Time now);
  void report_drive(Time now);

  // What every tick looks at stands together, as many stations take turns.
  EventQueue& queue_;
  uint32_t source_;
  bool asleep_ = false;
  bool variables_rest_ = true;  // the program then changes no variable, not even for a moment
  bool steady_ = false;
  bool trial_ = false;  // this tick is compared with what was before it, for sleep
  Time back_at_ = 0;    // asleep or late: the tick that is executed in its turn again
  EventId tick_ = kNoEvent;
  std::array<std::unique_ptr<SbusPort>, 2> sbus_;
  Time next_tick_ = 0;  // the first that was neither executed nor made up for

  // Late ticks (station_late.cpp).
  uint32_t ahead_left_ = 0;  // ticks of which only the tasks need be executed
  uint32_t behind_ = 0;      // those in which drive and positioning are behind them
  vm::Rates ahead_rates_;
  Backoff ahead_backoff_;
  // Telegrams that wait until the tasks have come so far.
  struct Telegram {
    Time after;  // this tick
    ObjectReader* reader;
    size_t object;
    Frame frame;
  };
  std::array<Telegram, 4> inbox_;
  uint8_t posted_ = 0;
  uint8_t read_ = 0;
  ProgramReach reach_;
  bool may_order_ = true;  // the program can write the control word of the drive
  Backoff reach_backoff_;

  bool quiet_ = false;           // the program's own commands write none of the noted variables
  bool unwritten_ = false;       // before this tick nobody had written them since the last one
  bool touched_ = false;         // somebody else may have written them since the last tick
  bool fault_reported_ = false;  // of the program
  bool in_tick_ = false;
  CommandRunner* runner_ = nullptr;
  Execution execution_;
  std::optional<vm::Rates> rates_;  // instead of P938 and P939
  StationInputs inputs_;
  Timers timers_;

  DriveServer drive_;
  std::optional<vm::Machine> machine_;
  std::optional<PositioningService> positioning_;  // of a unit that has it

  const StationConfig& config_;
  StationLines lines_;
  Journal& journal_;
  MovilinkCommand movilink_;
  std::optional<vm::Image> image_;
  std::vector<uint32_t> code_;  // what the machine runs: the verified program memory
  std::vector<vm::fast::Slot> slots_;
  std::optional<vm::fast::Predecoded> predecoded_;  // in slots_
  std::shared_ptr<const vm::fast::Native> native_;  // null: no machine code

  // RS-485; empty without a line.
  std::unique_ptr<SerialPort> x13_;
  std::unique_ptr<SerialPort> xt_;
  std::unique_ptr<Keypad> keypad_;

  // What the program works with.
  std::optional<MirroredValues> mirrored_;
  std::optional<PidBlock> pid_;  // MOVIDRIVE B
  std::optional<PositioningCommands> positioning_commands_;
  std::optional<SystemCommands> commands_;
  vm::TickSteps steps_;  // with a runner
  bool powered_ = false;
  bool was_off_ = false;

  // Steady ticks (station_steady.cpp).
  NotedVariables noted_;
  std::optional<Drive::Moment> before_tick_;  // before this tick, which is compared with it
  Backoff steady_backoff_;

  // Sleep (station_sleep.cpp).
  Backoff sleep_backoff_;
  uint64_t idle_ticks_ = 0;  // of the program, from the tick of the trial on
  struct {
    std::optional<PositioningService::Left> positioning;
    std::array<int32_t, vm::kMaxVariables> h;
  } rest_;  // before the trial

  uint32_t resets_seen_ = 0;  // of the drive's faults
  uint8_t error_seen_ = 0;    // error of the drive in the last millisecond
  // What was last told of the drive.
  uint8_t told_fault_ = 0;
  uint16_t told_reserved_ = 0;  // bits of the control word
  Block told_block_ = Block::None;
  SetpointNote told_note_ = SetpointNote::None;
};

}  // namespace ipos::runtime
