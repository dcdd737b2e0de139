// A drive: it turns terminals, process data, the program's words and the parameters into motion, and shows
// what it does in status words, process data, outputs and display values (unit profile: 1053 1610 p. 41,
// MOVITRAC 07 chapter 6, MDX60B/61B p. 84-93). One call of tick() a millisecond; docs/inside/drive.md has the order.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "runtime/drive/analog_outputs.hpp"
#include "runtime/drive/control.hpp"
#include "runtime/drive/decisions.hpp"
#include "runtime/drive/encoder_inputs.hpp"
#include "runtime/drive/link_watch.hpp"
#include "runtime/drive/outputs.hpp"
#include "runtime/drive/parameters.hpp"
#include "runtime/drive/position_control.hpp"
#include "runtime/drive/process_data.hpp"
#include "runtime/drive/scope.hpp"
#include "runtime/drive/setpoint.hpp"
#include "runtime/drive/setpoint_memory.hpp"
#include "runtime/motion/axis.hpp"
#include "runtime/part/part.hpp"

namespace ipos::runtime {

enum class UnitCondition : uint8_t {
#define UNIT_CONDITION(code, name, text) name = code,
#include "stdlib/unit_conditions.def"
};
std::string_view condition_text(UnitCondition condition);

class Drive final : private DriveLink {
 public:
  using Words = DriveWords;

  // Connects itself to the parameters, which must outlive it.
  explicit Drive(ParameterStore& parameters, const MachineData& machine = {});
  Drive(const Drive&) = delete;
  Drive& operator=(const Drive&) = delete;

  // --- what comes in ---
  // Levels as in InputLevel H483: bits 0..7 DI00..DI07, bits 8..15 DI10..DI17. All 0 at first: open
  // terminals.
  void set_inputs(uint16_t levels) { now_.set(&Situation::inputs, levels); }
  uint16_t inputs() const { return now_->inputs; }
  void set_analog(const AnalogInputs& analog) { now_.set(&Situation::analog, analog); }
  const AnalogInputs& analog() const { return now_->analog; }
  // From what the motor drives: a torque that acts on the shaft beside that of the machine data, 1/10000 Nm, positive
  // pulls counter-clockwise; and the speed of a shaft that is driven from outside, 1/1000 rpm.
  void set_load_torque(int32_t torque);
  int32_t load_torque() const { return state_.load_torque; }
  void set_shaft_speed(int32_t speed);
  // The mains go or come back, while the 24 V of the electronics stay.
  void set_mains(bool on);
  bool mains() const { return now_->mains; }
  bool runs_on_24v() const { return now_->link_is_low; }  // and can do nothing with its motor
  bool is_driven() const { return state_.axis.machine().driven; }
  // What other shafts say at its encoder sockets. Positioning and synchronous operation read it.
  void set_encoders(const EncoderInputs& encoders) {
    if (encoders == encoders_) return;
    encoders_ = encoders;
    now_.change();
  }
  const EncoderInputs& encoders() const { return encoders_; }

  // PO words of a telegram; words it does not carry keep their value. They show in P094..P096 in any case and
  // act only if P876 is ON and the source is the one of P100 or P101. `cyclic` is false for acyclic RS-485
  // requests, which do not restart the monitoring.
  void take_po(PoSource link, std::span<const uint16_t> words, bool cyclic = true);
  // The same words once more, which the drive has taken and listens to: that only begins the count of silence anew, so what is
  // known of the next ticks stays right. False: they bring something new, and nothing is done.
  bool hear_again(PoSource link, std::span<const uint16_t> words);
  // A valid cyclic request without process data restarts the monitoring, too (1053 1610 p. 27).
  void take_request(PoSource source);
  // The bus has a watchdog of its own, and it has run out.
  void lose(PoSource source);
  const Words& po() const { return now_->shown_po; }
  // PO4 to PO10 of the last telegram that had them.
  const FurtherWords& further_po() const { return further_po_; }

  // From the program: H484, PI words with assignment IPOS PI-DATA, outputs with function IPOS OUTPUT (bits as
  // outputs()).
  void set_ipos_control_word(uint32_t word) { now_.set(&Situation::ipos_word, word); }
  void set_ipos_pi(const Words& words) { state_.ipos_pi = words; }
  void set_further_pi(const FurtherWords& words) { further_pi_ = words; }
  void set_ipos_outputs(uint16_t levels) {
    if (levels != state_.ipos_outputs) steady_left_ = 0;
    state_.ipos_outputs = levels;
  }

  // One millisecond has passed.
  void tick(const PositionControl& position = {});

  // --- ticks in which it goes as positioning tells it, and nothing else happens (drive_following.hpp) ---
  class Following;
  // How many of the next ticks, at most so many, may be such ones with this control, as far as that can be said before.
  Ticks following_ticks(const PositionControl& position, Ticks most) const;

  // --- ticks in which nothing is decided ---
  struct Moment;
  // Before a tick.
  Moment moment() const;
  // After it: how many of the next ticks are advance(), while nobody touches the drive; 0 when that one did
  // more.
  Ticks steady_since(const Moment& before) const;
  void hold_steady(Ticks ticks) {
    steady_left_ = ticks;
    steady_for_ = now_.changes();
  }
  // How many of them are left: the next ones are advance() instead of tick(), if position_control() is
  // ordered again.
  Ticks steady_left() const {
    return steady_for_ == now_.changes() && now_->settings == parameters_.changes() ? steady_left_ : 0;
  }
  void advance(Ticks ticks);
  const PositionControl& position_control() const { return state_.position; }  // of the last tick

  // --- for the positioning of IPOS ---
  bool can_position() const { return decided().can_position; }  // P700 is a mode with IPOS (1053 1610 p. 80)
  // Enabled, magnetized, brake open: a speed of PositionControl acts.
  bool follows() const { return follows(decided()); }
  bool follows(const Decisions& d) const {
    return state_.axis.phase() == AxisPhase::Moving && verdict_of(d).command == Command::Enable;
  }
  // For who asks for more than one thing.
  const Decisions& decisions() const { return decided(); }
  // Grows whenever something that the drive decides or tells (faults, verdict, setpoint note) may have
  // changed.
  uint32_t changes() const {
    decided();
    return now_.changes();
  }
  const Terminals& terminals() const { return decided().terminals; }
  // POSITION LO and HI of the bus of P100 or P101.
  std::optional<int32_t> bus_position() const { return decided().bus_position; }
  // Another count for where the shaft is; the shaft itself has not moved.
  void set_position(int32_t counter);
  int32_t shaft_position() const;  // increments turned ever, whatever the count

  // --- faults ---
  // With the response its parameter chooses, or another one. An error stays until it is reset: by an input,
  // control word bit 6, P840, the program, or auto reset P841.
  void raise_fault(uint8_t number);
  void raise_fault(uint8_t number, FaultResponse response);
  void reset_fault();                                // by hand: auto reset counts from zero
  uint32_t resets() const { return state_.resets; }  // how often a reset was ordered, by whomever
  uint32_t rs485_timeouts() const { return state_.rs485_timeouts; }  // F43 by P812, so far
  // _FaultReaction on a fault without a parameter for its response; false: that of this one is fixed.
  bool set_fault_response(uint8_t number, FaultResponse response);
  uint8_t fault() const { return now_->faults.shown(); }  // error or warning, 0 is none
  bool error() const { return now_->faults.error(); }

  // --- what it shows ---
  Words pi() const;
  uint16_t pi_word(size_t n) const;
  // Those of its words that may change in a tick in which nothing is decided, the first in bit 0.
  uint16_t counting_words() const {
    settings();
    return counting_words_;
  }
  const FurtherWords& further_pi() const { return further_pi_; }
  Verdict verdict() const { return verdict_of(decided()); }  // what it is told, and why not more
  UnitCondition condition() const { return told().condition; }
  char display() const;  // the seven-segment display: a digit, 't' waiting, 'F' fault
  bool ready() const { return decided().ready; }
  bool po_data_enabled() const;
  // Bits of the present control word that are 1 though they are to be sent as 0; they have no effect.
  uint16_t reserved_control_bits() const { return decided().reserved_control_bits; }
  uint16_t status_word_1() const { return told().status_word_1; }
  uint16_t status_word_2() const;  // high byte: virtual output terminals DO10..DO17
  uint16_t status_word_3() const { return told().status_word_1 & 0xFF; }  // high byte in no manual read; 0 is ours
  const Setpoint& setpoint() const { return state_.setpoint; }  // of the last tick
  const AxisState& axis() const { return state_.axis.state(); }
  // Of axis(), for who looks every millisecond.
  int32_t position() const { return state_.axis.position(); }
  int32_t speed() const { return state_.axis.speed(); }
  int64_t shaft_angle() const;  // turned ever, 1/1000000 rad
  int32_t axis_setpoint() const { return state_.axis.setpoint(); }
  AxisPhase axis_phase() const { return state_.axis.phase(); }
  bool output_stage() const { return state_.axis.output_stage(); }
  bool brake_released() const { return state_.axis.brake_released(); }
  bool current_limited() const { return state_.axis.current_limited(); }
  bool standing() const { return state_.axis.standing(); }
  int32_t shown_speed() const {  // P000
    const int32_t speed = noisy(this->speed(), state_.axis.machine().rated_speed, Noise::Speed);
    return set().change_direction == 1 ? -speed : speed;
  }
  uint16_t outputs() const { return state_.outputs.levels(); }
  // AO1 and AO2 (0, 1); `ipos` is the program's value for it, H478 or H479.
  AnalogLevel analog_output(size_t output, int32_t ipos) const;

  // What the master of a master/slave group sends; its slaves scale it (P751): control word 1, the setpoint that
  // P750 chooses and the third IPOS PI-DATA word of the program.
  Words master_words(SlaveSetpoint what) const;

  const Scope& scope() const { return scope_; }

  // Power off and on: everything as at first, except the motor potentiometer with P152. The parameters are
  // the caller's.
  void power_cycle();

  // Decides again at the next occasion. Changes only the time it takes; for tests that compare a drive
  // with one that decides everything every millisecond.
  void forget_decisions() {
    now_.change();
    decisions_known_ = false;
    shown_for_ = settings_version_ - 1;
  }

  // What the parameters say now.
  const Settings& settings() const {
    if (settings_version_ != parameters_.changes()) read_settings();
    return settings_;
  }

 private:
  static constexpr uint32_t kMinuteMs = 60'000;
  // P017 counts in 1E5 Ws (quantity 8, conversion index 5).
  static constexpr int64_t kEnergyDigit = 100'000;
  static constexpr int32_t kOvertemperature =
      90;  // °C of the heat sink, where the unit protects itself; ours
  static constexpr int32_t kFullUtilization = 100'000;
  static constexpr int32_t kOvervoltage = 900'000;  // mV, where the unit protects itself; ours
  // Of its voltage at mains, below which the power section is off; ours.
  static constexpr int32_t kLowLinkPercent = 60;

  // An actual value as it is measured ([station] noise): another one of each kind in each millisecond.
  enum class Noise : uint8_t { Speed, Current, ActiveCurrent };
  int32_t noisy(int32_t value, int32_t whole, Noise kind) const {
    return state_.axis.machine().noise == 0 ? value : with_noise(value, whole, kind);
  }
  int32_t with_noise(int32_t value, int32_t whole, Noise kind) const;

  std::optional<int32_t> live_value(uint16_t index) const override;
  bool controller_inhibited() const override;
  bool output_stage_on() const override { return state_.axis.output_stage(); }
  void on_parameter_written(uint16_t index, int32_t value) override;

  void read_settings() const;
  uint16_t find_counting_words() const;
  const ParameterSet& set() const { return settings().sets[now_->second_set ? 1 : 0]; }
  const ParameterSet& other_set() const { return settings().sets[now_->second_set ? 0 : 1]; }

  // What is decided for the present situation.
  const Decisions& decided() const {
    if (now_.changed() || now_->settings != parameters_.changes() ||
        now_->factory_setting != parameters_.factory_setting_running())
      look_around();
    return decisions_;
  }
  void look_around() const;
  void decide_anew() const;

  // drive_decisions.cpp: how it is decided, from situation and settings; `t` are the terminals in them.
  Terminals read_terminals() const;
  bool runs_free(const Terminals& t) const;
  ControlInputs control_inputs(const Terminals& t) const;
  std::array<LinkWatch::Rules, kPoLinks> link_rules(bool enabled_locally, bool free_run) const;
  void decide_setpoint(Decisions& d) const;
  bool mode_can_position() const;
  std::optional<int32_t> read_bus_position() const;
  uint16_t read_reserved_bits() const;
  const BusOrder& order_of(PoSource source) const;
  const BusOrder& control_order() const;
  const BusOrder& setpoint_order() const;
  bool ipos_bit(InputFunction function) const {
    return (now_->ipos_word >> static_cast<unsigned>(function) & 1) != 0;
  }
  bool function_on(const Terminals& t, InputFunction function) const {
    return t.on(function) || ipos_bit(function);
  }
  bool waits_for(PoSource bus) const;
  bool is_waiting() const;
  bool starting_up() const { return state_.up_ms < parameters_.options().start_up_ms; }
  bool heard(PoSource source) const { return now_->heard[static_cast<size_t>(source)]; }
  FaultResponse response_of(uint8_t number) const;
  struct Told;
  const Told& told() const;
  void tell_anew() const;
  UnitCondition enabled_condition() const;
  UnitCondition read_condition() const;
  uint8_t status_block() const;
  int32_t user_display() const;
  int32_t share_of_ai2(int32_t limit) const;
  int32_t with_torque_limit(int32_t current_limit) const;

  LinkWatch& touched_watch(PoSource source);
  void note_heard();

  // The steps of a tick.
  void take(const PositionControl& position);
  void count();
  void decide_and_watch();
  void apply();
  void choose_order();
  void move();
  void show();
  OutputInputs shown() const;
  void show_anew();

  void order_load(AxisOrder& order) const;
  void order_scope(bool start);
  void record();
  std::optional<int32_t> scope_value(uint16_t index) const;

  void count_minute(uint32_t& ms, uint16_t minutes);
  void latch_three_wire();
  bool watch_links();
  void watch_resets();
  bool links_run() const;
  bool machine_suffers() const;
  bool can_follow(const PositionControl& position) const;
  bool counts_mains() const { return decisions_.mains_gone != now_->mains_stop; }
  Command mains_off_response() const;
  void begin_without_mains();
  void watch_mains();
  void count_limited();
  bool counts_limited() const { return state_.axis.current_limited() || state_.limited_ms != 0; }
  // Once more without a fault.
  bool may_count_limited() const { return state_.limited_ms < set().speed_monitoring_delay; }
  void watch_machine();
  void clear_faults();
  int32_t monitored(int32_t delay_ms) const;
  void select_parameter_set();
  Setpoint next_setpoint(const Decisions& d);
  Verdict verdict_of(const Decisions& d) const {
    const bool more =
        state_.stopped_by_setpoint || (d.controls.command == Command::Enable && !now_->positioning);
    return more ? verdict_with_setpoint(d) : d.controls;
  }
  Verdict verdict_with_setpoint(const Decisions& d) const;
  AxisOrder axis_order(Command command) const;

  ParameterStore& parameters_;
  stdlib::Traits traits_;
  SettingsReader reader_;
  mutable Settings settings_;
  mutable uint32_t settings_version_;
  mutable uint16_t counting_words_ = 0;  // by the settings

  // What was made of process data, and of which.
  struct KnownOrder {
    Words words{};
    std::optional<uint32_t> version;  // of the settings
    int32_t maximum_speed = 0;
    BusOrder order;
  };
  mutable std::array<KnownOrder, kPoSources> known_orders_{};

  // Inputs, process data, faults and modes are kept where they are compared.
  mutable WatchedSituation now_;
  mutable Situation decided_for_;
  mutable Decisions decisions_;
  mutable bool decisions_known_ = false;
  mutable bool applied_ = false;  // latches, faults and parameter set follow from these decisions already
  // What is told of them and of the axis, to who asks in each millisecond whether it is another.
  struct Told {
    uint64_t moment = 0;  // what it was told of: see told()
    UnitCondition condition{};
    uint16_t status_word_1 = 0;
  };
  mutable Told told_;
  // The rest of what follows from them, as far as it has been asked for.
  mutable std::optional<Command> order_for_;
  AxisOrder order_;
  Block blocked_by_ = Block::None;  // that was the reason of the last verdict
  struct SetpointMemory {
    int32_t ai1_speed = 0;
    int32_t motor_pot = 0;
    int32_t pi_output = 0;
    bool operator==(const SetpointMemory&) const = default;
  };
  mutable std::optional<SetpointMemory> selected_for_;
  Setpoint selected_;

  // What else a tick changes, or others tell the drive. All else follows from it, the situation and the
  // settings.
  struct State {
    explicit State(const Axis& at_rest) : axis(at_rest) {}
    void advance(Ticks ticks);
    Ticks bound() const;
    bool operator==(const State&) const = default;

    std::array<LinkWatch, kPoLinks> watches{};
    uint16_t last_control_word = 0;  // for the edge of its reset bit
    Words ipos_pi{};
    uint16_t ipos_outputs = 0;
    PositionControl position;
    uint32_t counter_shift = 0;  // by all of set_position

    uint32_t resets = 0;
    uint32_t rs485_timeouts = 0;
    bool reset_input = false;  // level at the last tick
    int32_t auto_reset_ms = 0;
    int auto_resets = 0;
    int32_t limited_ms = 0;    // at the current limit
    int32_t mains_off_ms = 0;  // that an input with MAINS ON says so

    bool cw_input = false, ccw_input = false;
    bool stopped_by_setpoint = false;
    MotorPotentiometer motor_pot;
    PiController pi_controller;
    int32_t pi_actual = 0;
    SetpointFilter ai1_filter;
    Setpoint setpoint;

    Axis axis;
    int32_t load_torque = 0;  // as it was set; order_ has its share of the rated torque
    int32_t shaft_speed = 0;
    Outputs outputs;
    uint32_t factory_setting_ms = 0;
    uint32_t up_ms = 0;  // since power-on, up to the end of the start-up
    uint32_t mains_ms = 0;
    uint32_t enabled_ms = 0;
    int64_t counted_energy = 0;
  };
  State state_;
  int32_t least_dc_link_;  // mV
  EncoderInputs encoders_;                                     // nothing that the drive itself does depends on them
  FurtherWords further_po_{}, further_pi_{};                   // nothing that the drive does depends on them
  Scope scope_;                                                // while it runs every tick is executed
  std::array<std::optional<FaultResponse>, 256> responses_{};  // chosen by the program, by fault number
  uint32_t shown_for_;                                         // the settings of the last tick of the outputs
  uint32_t quiet_for_ = 0;  // changes of the situation by the last tick, if nothing was left to watch
  Ticks steady_left_ = 0;
  uint32_t steady_for_ = 0;  // changes of the situation by then
};

struct Drive::Moment {
  State state;
  Situation situation;
};

// Condition and status follow from what is decided, whose changes are counted, and from these. The count begins with 1.
inline const Drive::Told& Drive::told() const {
  decided();
  const uint64_t moment = uint64_t{now_.changes()} << 32 | uint64_t{starting_up()} << 5 | uint64_t{output_stage()} << 4 |
                          uint64_t{standing()} << 3 | uint64_t{state_.stopped_by_setpoint} << 2 |
                          uint64_t{state_.setpoint.speed > 0} << 1 | uint64_t{state_.setpoint.speed < 0};
  if (moment != told_.moment) {
    tell_anew();
    told_.moment = moment;
  }
  return told_;
}

inline Drive::Moment Drive::moment() const {
  decided();
  return {state_, *now_};
}

}  // namespace ipos::runtime
