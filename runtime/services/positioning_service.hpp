// Positioning of one station: carries parameters, inputs and H variables to the Positioner, its order to the
// drive, and what it reports to both. Called twice a millisecond, around the drive's tick.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/clock/own_milliseconds.hpp"
#include "runtime/drive/drive.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/positioning/cams.hpp"
#include "runtime/positioning/positioner.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::runtime {

class PositioningService {
 public:
  // "SCOM1.IPC:12:5" of a word address, or empty.
  using SourcePlace = std::function<std::string(uint32_t)>;

  // All must outlive it.
  PositioningService(const OwnMilliseconds& milliseconds, Drive& drive, ParameterStore& parameters, Journal& journal, std::string_view station,
                     SourcePlace place);

  // Before the drive's tick: what the program wrote, what is to be done. `syncs`: sync telegrams so far.
  const PositionControl& order(Time now, std::span<int32_t> h, uint32_t syncs);
  // After it: where the axis is now.
  void observe() { positioner_.observe(drive_.position()); }
  // And then the system variables of positioning, and the extended cams.
  void show(Time now, std::span<int32_t> h);

  // --- ticks in which the axis does nothing but move ---
  // The next order() only goes on, and has nothing to report.
  bool goes_on(std::span<const int32_t> h) const;
  // It is on its way to a target, or holds it: no target moves.
  bool leads() const { return !positioner_.idles(); }
  // order() where goes_on() is true, or was before ticks that had_only_moved(), and nobody has written since.
  const PositionControl& go_on(uint32_t syncs);
  // The same with a tick of the drive and observe(), at most so often, within a phase of the travel and as long as nothing else
  // can happen (lead.cpp). Returns how often; only the last one need be asked had_only_moved().
  Ticks lead_on(uint32_t syncs, Ticks most);
  // After observe(): no bit has changed, and the next tick has nothing to report.
  bool had_only_moved() const {
    return positioner_.in_position() == ordered_.in_position && !positioner_.lags_too_far();
  }

  // Looks at no variable but system variables: no cam controller runs, no master is followed.
  bool reads_system_variables_only() const { return settings_.technology_function != kIsync && !cams_run_; }

  // In every millisecond, of the program's choice: an extended cam controller runs.
  bool writes_variables() const { return cams_run_ && extended_cams_.runs(); }

  // State after a millisecond, without displayed values.
  struct Left {
    explicit Left(const PositioningService& service)
        : positioner(service.positioner_), reported(service.reported_) {}
    Positioner positioner;
    std::bitset<kPositioningEvents> reported;
  };
  bool has_left(const Left& before) const {
    return before.positioner == positioner_ && before.reported == reported_;
  }

  // Grows with everything that commands change: targets, travels, cams, parameters.
  uint32_t changes() const { return changes_; }
  // There is nothing to do. While inputs, parameters, system variables and changes() stay as they are since
  // the last order(), advance() is order() and show() around a tick of the drive, or around several; before
  // the last of them its counter was `before`.
  bool idles() const {
    return positioner_.idles() && reported_.none() && followed_ && followed_->commands == changes_ &&
           reads_system_variables_only();
  }
  // It changes the variables with use Moves then.
  void advance(std::span<int32_t> h, uint32_t syncs, int32_t before);
  // For commands, between two ticks.
  const Positioner& positioner() const { return positioner_; }
  Positioner& change_positioner() {
    ++changes_;
    return positioner_;
  }
  void take_targets(std::span<const int32_t> h);  // written since the last look
  // The command, for what is reported of it.
  void ordered_at(PositioningCause kind, uint32_t address) {
    ordered_at_[static_cast<size_t>(kind)] = address;
  }
  void show_targets(std::span<int32_t> h);  // and the bits 19 and 20 of H473
  CamSources& cam_sources() {
    ++changes_;
    cams_run_ = true;
    return cam_sources_;
  }
  ExtendedCams& extended_cams() {
    ++changes_;
    cams_run_ = true;
    return extended_cams_;
  }
  // A parameter by its number, as the program's own working value; where a command ordered it, that stands at `address`.
  void set_parameter(std::string_view number, int32_t value);
  void set_parameter(std::string_view number, int32_t value, uint32_t address);

 private:
  static constexpr int32_t kIsync = 2;  // setting of P077 (1053 1610 p. 69)
  static constexpr size_t kMirrors = 5;

  void read_settings() {
    if (settings_version_ != parameters_.changes()) read_changed_settings();
  }
  void read_changed_settings();
  bool written(std::span<const int32_t> h) const;
  void lead();
  const PositionControl& order_anew(Time now, std::span<int32_t> h, uint32_t syncs);
  void note_probes();
  void run_cams(Time now, std::span<int32_t> h);
  bool mirrors_written(std::span<const int32_t> h) const;
  bool targets_written(std::span<const int32_t> h) const;
  void take_mirrors(std::span<int32_t> h);
  void take_written_targets(std::span<const int32_t> h);
  void read_terminals(const Terminals& terminals);
  void read_inputs(std::span<const int32_t> h, uint32_t syncs);
  MasterInputs master(std::span<const int32_t> h, bool sync) const;
  void show_target_positions(std::span<int32_t> h);
  void show_bits(std::span<int32_t> h);
  void show_positions(std::span<int32_t> h, const Encoders::Positions& positions, int32_t setpoint);
  void report_events(Time now);
  std::string place_of(PositioningEvent event) const;
  void not_ordered(PositioningCause kind) { ordered_at_[static_cast<size_t>(kind)].reset(); }

  const OwnMilliseconds& milliseconds_;
  Drive& drive_;
  ParameterStore& parameters_;
  Journal& journal_;
  std::string station_;
  SourcePlace place_;

  struct Cell {
    int32_t PositioningSettings::*member;
    uint16_t index;
  };
  std::vector<Cell> cells_;  // of the parameters the unit has
  PositioningSettings settings_;
  uint32_t settings_version_;
  std::array<int32_t, kMirrors> mirrored_{};  // as last shown in the variables
  bool mirrors_agree_ = false;                // that is what the settings say

  Positioner positioner_;
  uint32_t positioner_version_;  // of the settings it has
  PositioningInputs inputs_;
  Terminals terminals_;  // of which they tell
  CamSources cam_sources_;
  ExtendedCams extended_cams_;
  bool cams_run_ = false;  // or one may have been started since the last look
  // As last shown; the program has written what differs.
  int32_t shown_target_ = 0;
  int32_t shown_modulo_target_ = 0;
  int32_t shown_turns_ = 0;
  int32_t bus_position_ = 0;
  PositionControl ordered_;
  std::array<int32_t, 6> probed_{};  // H502 to H507
  uint32_t changes_ = 0;
  // The count of changes of what an order depends on, besides variables, at the last computed order; there
  // only where the next ones need not be while it is the same. Settings are what the drive decides by, too.
  struct Followed {
    uint32_t drive = 0;
    uint32_t commands = 0;
    bool operator==(const Followed&) const = default;
  };
  std::optional<Followed> followed_;
  uint32_t syncs_ = 0;                        // sync telegrams, as of the last millisecond
  std::bitset<kPositioningEvents> reported_;  // in the last millisecond
  // Of each kind the last one; nothing: not by a command, but by writing a variable or an input.
  std::array<std::optional<uint32_t>, kPositioningCauses> ordered_at_;
  uint32_t setting_version_ = 0;  // of the parameters, after the last command that has set one
};

}  // namespace ipos::runtime
