// One station: a unit on its lines. The ports carry frames and characters to the unit and from it, a pacer
// executes its milliseconds, and tools read and change it here. docs/inside/cycle.md has the order of what happens.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/movilink/keypad.hpp"
#include "runtime/pace/pacer.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "runtime/plant_file/state_names.hpp"
#include "runtime/station/canopen_port.hpp"
#include "runtime/station/profibus_port.hpp"
#include "runtime/station/sbus_port.hpp"
#include "runtime/station/serial_port.hpp"
#include "runtime/unit/door.hpp"
#include "runtime/unit/many_ticks.hpp"
#include "runtime/unit/unit.hpp"

namespace ipos::runtime {

// The lines of a station; null where it is not connected.
struct StationLines {
  std::array<CanLine*, 2> sbus{};  // SBus 1 and 2
  Rs485Line* x13 = nullptr;
  Rs485Line* xt = nullptr;  // with a keypad the line to it
  ProfibusBus* profibus = nullptr;
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

// Follows what a drive decides. It is told of each tick that has executed more than counting, late ones with their own
// time; in all others the drive only counts on (docs/inside/cycle.md), so what it decided before holds.
class DriveWatcher {
 public:
  virtual void on_decided(const Drive& drive, Time tick) = 0;

 protected:
  ~DriveWatcher() = default;
};

class Station final : private Timed, private TaskRunner {
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
  std::optional<std::string> use_memory(std::unique_ptr<NvMedium> medium, std::string name);

  // The first time after all parameters are set: connects to the bus and starts the program. After
  // power_off() the unit begins again with what its memory holds; parameters of the plant file are not set
  // again.
  void power_on();
  void power_off();
  bool powered() const { return powered_; }

  // The program memory, which may have been changed through indices 16000 + n, is verified and started from
  // its beginning; variables keep their values. Nothing when it was started, else the rule it breaks.
  std::optional<std::string> start_program();
  // A download of a program for this unit, which begins anew; variables keep their values, and the drive goes on. Nothing
  // when it was done, else why not.
  std::optional<std::string> load_program(vm::Image image);
  void stop_program();

  // From the next tick on; it must outlive the station. Every tick then comes in its turn.
  void use_runner(CommandRunner& runner);
  // The station stands in the middle of its tick.
  bool in_tick() const { return in_tick_; }
  void resume_tick();

  void use_pace(Pace pace) { pacer_.use(pace); }
  // It must outlive the run. What is written between two ticks it finds in the station itself, which then is not behind.
  void add_watcher(DriveWatcher& watcher) { watchers_.push_back(&watcher); }
  // Ticks are pending; a read executes them first.
  bool behind() const { return pacer_.behind(); }
  // How its next ticks are done.
  ManyTicks::Mode mode() const { return ticks_.mode(); }

  // Stores what is still to be stored, at the end of the run. False: that failed, the journal says why.
  bool store_memory();

  const StationConfig& config() const { return config_; }
  Time now() const { return queue_.now(); }
  const vm::Image* image() const { return unit_.image(); }
  bool has_variables() const { return config_.unit->variables != 0; }  // it has IPOS
  // Of its program; none without one.
  std::span<const vm::Symbol> symbols() const {
    return image() == nullptr ? std::span<const vm::Symbol>() : image()->symbols;
  }
  const vm::Machine* machine() const { return door_.look().machine(); }
  // To change something; what only reads takes the others.
  UnitInterface& drive() { return door_.touch().server(); }
  const UnitInterface& drive() const { return door_.look().server(); }
  uint16_t outputs() const { return door_.look().drive().outputs(); }
  int32_t shaft_position() const { return door_.look().drive().shaft_position(); }
  UnitInputs& inputs() { return door_.touch().inputs(); }
  const UnitInputs& inputs() const { return unit_.inputs(); }  // only others change them
  // The first reader executes the pending ticks, so a read never sees old values.
  void look() const { door_.look(); }
  // As the parameter channel reads an index; 0 where it refuses.
  int32_t read(uint16_t index) const;

  // SBus 1 or 2; null when the station is not on it.
  const SbusPort* sbus(int number) const {
    look();
    return sbus_[static_cast<size_t>(number - 1)].get();
  }

  // Something of it carries PO4 to PO10: a fieldbus card that can, or CANopen.
  bool has_further_words() const;

  // The same with the protocol CANopen.
  const CanopenPort* canopen(int number) const {
    look();
    return canopen_[static_cast<size_t>(number - 1)].get();
  }

  // What a hand can turn: whether the station has it, how it stands, and turning it. Nothing when it was turned, else why
  // not.
  bool has_switch(StationSwitch which) const;
  int32_t switch_value(StationSwitch which) const;
  std::optional<std::string> set_switch(StationSwitch which, int32_t value);

  // Null when the station has no card on a PROFIBUS.
  ProfibusPort* profibus() { return profibus_.get(); }
  const ProfibusPort* profibus() const { return profibus_.get(); }

  // The MOVLNK of this structure was carried out, over whichever bus.
  bool has_called(uint32_t structure) const { return door_.look().movilink().has_called(structure); }

  // The program has ended, was never there, or a fault has stopped it.
  bool program_over() const;
  uint8_t fault() const;  // error or warning, 0 is none
  bool error() const;     // a fault that stops the drive until it is reset
  uint16_t status_word_1() const;

  int32_t variable(uint32_t number) const { return door_.look().variables()[number]; }

  // "SCOM1.IPC:12:5" of a word address, or empty.
  std::string source_place(uint32_t address) const { return unit_.source_place(address); }
  uint32_t source_line(uint32_t address) const { return unit_.source_line(address); }  // 12, or 0

 private:
  bool tick(Time now) override;
  bool tick_in_turn(Time now);
  void tell_watchers(Time tick) const {
    for (DriveWatcher* watcher : watchers_) watcher->on_decided(unit_.drive(), tick);
  }
  Time send(Time now) override;
  Time send_at_rest(Time now, Time until) override;
  void rest_ends() override;
  void settle_to_send() {
    if (ticks_.sends_pending() || tells_changes_) ticks_.settle();
  }
  Ticks horizon(Time first) override;
  Ticks horizon_of_idle(Time first);
  Ticks advance(Time first, Ticks most) override;
  Ticks silence(Time first) override;
  Ticks find_silence(Time first);
  void settle() override { ticks_.settle(); }
  void touched() override;
  void before_telegram() override;
  bool lets_wait() const override { return ticks_.lets_wait(); }
  bool rests() const override { return ticks_.variables_rest() && !leads_; }
  bool run(vm::Machine& machine, vm::TickSteps& steps) override;

  void want_frames_again();  // the variables may change from now on
  void list_ports();
  void connect_sbus(int number);
  void connect_serial();
  void connect_profibus();
  void miss_profibus();
  void reconnect_serial();

  EventQueue& queue_;
  uint32_t source_;
  Unit unit_;
  ManyTicks ticks_{unit_};
  Pacer pacer_;
  Door door_{unit_, ticks_, pacer_};
  std::vector<StationPort*> ports_;  // all of the following that there are, in the order in which they send
  std::array<std::unique_ptr<SbusPort>, 2> sbus_;
  std::array<std::unique_ptr<CanopenPort>, 2> canopen_;  // in place of the former, by P880 and P890

  // RS-485; empty without a line.
  std::unique_ptr<SerialPort> x13_;
  std::unique_ptr<SerialPort> xt_;
  std::unique_ptr<Keypad> keypad_;
  std::unique_ptr<ProfibusPort> profibus_;

  const StationConfig& config_;
  StationLines lines_;
  Journal& journal_;
  bool leads_ = false;  // a group of slaves: what it sends is the drive's
  bool tells_changes_ = false;  // what its unit decides goes out in the millisecond in which it does
  std::vector<DriveWatcher*> watchers_;
  CommandRunner* runner_ = nullptr;
  bool in_tick_ = false;
  bool powered_ = false;
  bool was_off_ = false;
};

}  // namespace ipos::runtime
