// Copies between H variables, parameters, drive and positioner.
#include "runtime/services/positioning_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "stdlib/system_variables.hpp"
#include "stdlib/unit_text.hpp"

namespace ipos::runtime {
namespace {

enum SystemVariable : size_t {
  kModuloCtrl = stdlib::system_variable("ModuloCtrl"),
  kModTagPos = stdlib::system_variable("ModTagPos"),
  kModActPos = stdlib::system_variable("ModActPos"),
  kModCount = stdlib::system_variable("ModCount"),
  kStatusWord = stdlib::system_variable("StatusWord"),
  kSetpointPos = stdlib::system_variable("SetpointPos"),
  kTargetPos = stdlib::system_variable("TargetPos"),
  kPosWindow = stdlib::system_variable("PosWindow"),
  kLagWindow = stdlib::system_variable("LagWindow"),
  kLagDistance = stdlib::system_variable("LagDistance"),
  kSlsRight = stdlib::system_variable("SLS_right"),
  kSlsLeft = stdlib::system_variable("SLS_left"),
  kRefOffset = stdlib::system_variable("RefOffset"),
  kSetpointPosBus = stdlib::system_variable("SetpointPosBus"),
  kTpPos2Abs = stdlib::system_variable("TpPos2_Abs"),  // up to H507 in a row
  kActPosAbs = stdlib::system_variable("ActPos_Abs"),
  kActPosExt = stdlib::system_variable("ActPos_Ext"),
  kActPosMot = stdlib::system_variable("ActPos_Mot"),
  kSyncSource = stdlib::system_variable("SyncSource"),
  kSyncControl = stdlib::system_variable("SyncControl"),
  kSyncState = stdlib::system_variable("SyncState"),
  kGearMaster = stdlib::system_variable("SyncGearMaster"),
  kGearSlave = stdlib::system_variable("SyncGearSlave"),
};

// System variables that are the same datum as a parameter; every unit with positioning has these.
struct Mirror {
  size_t variable;
  int32_t PositioningSettings::*member;
  std::string_view number;
};
constexpr Mirror kMirrorRows[] = {{kPosWindow, &PositioningSettings::window, "922"},
                                  {kLagWindow, &PositioningSettings::lag_window, "923"},
                                  {kSlsRight, &PositioningSettings::limit_cw, "920"},
                                  {kSlsLeft, &PositioningSettings::limit_ccw, "921"},
                                  {kRefOffset, &PositioningSettings::reference_offset, "900"}};

constexpr unsigned kInPosition = 19;  // IPOSplus p. 34
constexpr unsigned kReferenced = 20;  // IPOSplus p. 91

constexpr int32_t kNoOverride = 1'000;

// P930: 0..10 V at AI1 are 0..150 % of the travel speeds (common knowledge, in no manual read).
int32_t override_of(const AnalogInputs& analog) {
  constexpr int32_t kFullVoltage = 10'000, kMost = 1'500;
  return std::clamp(analog.ai1.millivolt, 0, kFullVoltage) * kMost / kFullVoltage;
}

Command command_of(Halt halt) {
  switch (halt) {
    case Halt::RapidStop: return Command::RapidStop;
    case Halt::HoldControl: return Command::HoldControl;
    case Halt::None: break;
  }
  return Command::Enable;
}

}  // namespace

PositioningService::PositioningService(const OwnMilliseconds& milliseconds, Drive& drive, ParameterStore& parameters, Journal& journal,
                                       std::string_view station, SourcePlace place)
    : milliseconds_(milliseconds),
      drive_(drive),
      parameters_(parameters),
      journal_(journal),
      station_(station),
      place_(std::move(place)),
      settings_version_(parameters.changes() - 1) {
  const auto index_of = [&](std::string_view number) -> uint16_t {
    const stdlib::Parameter* row = parameters.table().find(number);
    return row == nullptr ? 0 : row->index;
  };
#define POSITIONING_SETTING(member, number, value) \
  if (const uint16_t index = index_of(number)) cells_.push_back({&PositioningSettings::member, index});
#include "runtime/positioning/settings.def"
  static_assert(std::size(kMirrorRows) == kMirrors);
  read_settings();
  positioner_.power_on(settings_, drive.shaft_position());
  positioner_version_ = settings_version_;
}

void PositioningService::read_changed_settings() {
  settings_version_ = parameters_.changes();
  mirrors_agree_ = false;
  for (const Cell& cell : cells_) settings_.*cell.member = parameters_.stored(cell.index);
}

void PositioningService::set_parameter(std::string_view number, int32_t value) {
  if (const stdlib::Parameter* row = parameters_.table().find(number))
    parameters_.set_working(row->index, value);
  ++changes_;
}

void PositioningService::set_parameter(std::string_view number, int32_t value, uint32_t address) {
  set_parameter(number, value);
  ordered_at(PositioningCause::Setting, address);
  setting_version_ = parameters_.changes();
}

inline bool PositioningService::mirrors_written(std::span<const int32_t> h) const {
  return [&]<size_t... n>(std::index_sequence<n...>) {
    return ((h[kMirrorRows[n].variable] ^ mirrored_[n]) | ...) != 0;
  }
  (std::make_index_sequence<kMirrors>());
}

// The last one to write wins: over a bus the parameter, in the program the variable.
void PositioningService::take_mirrors(std::span<int32_t> h) {
  for (size_t n = 0; n < kMirrors; ++n) {
    const Mirror& row = kMirrorRows[n];
    if (h[row.variable] != mirrored_[n] && settings_.*row.member == mirrored_[n])
      set_parameter(row.number, h[row.variable]);
  }
  read_settings();
  for (size_t n = 0; n < kMirrors; ++n)
    h[kMirrorRows[n].variable] = mirrored_[n] = settings_.*kMirrorRows[n].member;
  mirrors_agree_ = true;
}

inline bool PositioningService::targets_written(std::span<const int32_t> h) const {
  return h[kTargetPos] != shown_target_ || h[kModTagPos] != shown_modulo_target_ ||
         h[kModCount] != shown_turns_;
}

void PositioningService::take_targets(std::span<const int32_t> h) {
  if (targets_written(h)) take_written_targets(h);
}

void PositioningService::take_written_targets(std::span<const int32_t> h) {
  ++changes_;
  if (h[kTargetPos] != shown_target_) {
    not_ordered(PositioningCause::Target);
    positioner_.write_target(h[kTargetPos]);
  }
  if (h[kModTagPos] != shown_modulo_target_) {
    not_ordered(PositioningCause::Target);
    positioner_.write_modulo_target(h[kModTagPos]);
  }
  if (h[kModCount] != shown_turns_) positioner_.set_modulo_turns(h[kModCount]);
  shown_target_ = h[kTargetPos];
  shown_modulo_target_ = h[kModTagPos];
  shown_turns_ = h[kModCount];
}

inline void PositioningService::show_target_positions(std::span<int32_t> h) {
  h[kTargetPos] = shown_target_ = positioner_.target();
  h[kModTagPos] = shown_modulo_target_ = positioner_.modulo_target();
  h[kModCount] = shown_turns_ = positioner_.modulo().turns();
}

inline void PositioningService::show_bits(std::span<int32_t> h) {
  constexpr uint32_t kBits = 1U << kInPosition | 1U << kReferenced;
  ordered_.in_position = positioner_.in_position();
  const uint32_t bits =
      (ordered_.in_position ? 1U << kInPosition : 0) | (positioner_.referenced() ? 1U << kReferenced : 0);
  h[kStatusWord] = static_cast<int32_t>((static_cast<uint32_t>(h[kStatusWord]) & ~kBits) | bits);
}

void PositioningService::show_targets(std::span<int32_t> h) {
  show_target_positions(h);
  show_bits(h);
}

void PositioningService::read_terminals(const Terminals& t) {
  using F = InputFunction;
  terminals_ = t;
  inputs_.cam = t.on(F::ReferenceCam);
  inputs_.limit_cw = t.off(F::LimitCw);  // low-active
  inputs_.limit_ccw = t.off(F::LimitCcw);
  inputs_.has_cam = t.assigned(F::ReferenceCam);
  inputs_.has_limits = t.assigned(F::LimitCw) && t.assigned(F::LimitCcw);
  inputs_.reference_start = t.on(F::ReferenceStart);
}

inline void PositioningService::read_inputs(std::span<const int32_t> h, uint32_t syncs) {
  const Decisions& decisions = drive_.decisions();
  if (!(decisions.terminals == terminals_)) read_terminals(decisions.terminals);
  inputs_.possible = decisions.can_position;
  inputs_.following = drive_.follows(decisions);
  inputs_.speed = drive_.speed();
  inputs_.levels = drive_.inputs();
  inputs_.override_permille = settings_.override_on == 1 ? override_of(drive_.analog()) : kNoOverride;
  inputs_.modulo_control = static_cast<uint32_t>(h[kModuloCtrl]);
  inputs_.external = drive_.encoders().x14;
  inputs_.master = settings_.technology_function == kIsync ? master(h, syncs != syncs_) : MasterInputs{};
  syncs_ = syncs;
}

// A gear of 0 is one of 1.
MasterInputs PositioningService::master(std::span<const int32_t> h, bool sync) const {
  if (h.size() <= kGearSlave) return {};
  const auto source = static_cast<uint32_t>(h[kSyncSource]);
  if (source == 0 || source >= h.size()) return {};
  MasterInputs master;
  master.sync = sync;
  master.follow = (h[kSyncControl] & 1) != 0;
  master.catch_up = (h[kSyncControl] & 2) != 0;
  master.position = h[source];
  if (h[kGearMaster] != 0) master.gear_master = h[kGearMaster];
  if (h[kGearSlave] != 0) master.gear_slave = h[kGearSlave];
  return master;
}

inline bool PositioningService::written(std::span<const int32_t> h) const {
  return targets_written(h) || static_cast<uint32_t>(h[kModuloCtrl]) != inputs_.modulo_control ||
         mirrors_written(h);
}

[[gnu::always_inline]] inline void PositioningService::lead() {
  if (positioner_.idles()) {
    positioner_.idle();
    ordered_.speed = drive_.speed();
  } else {
    ordered_.speed = positioner_.go_on();
  }
}

const PositionControl& PositioningService::go_on(uint32_t syncs) {
  syncs_ = syncs;
  lead();
  return ordered_;
}

bool PositioningService::goes_on(std::span<const int32_t> h) const {
  return followed_ && *followed_ == Followed{drive_.changes(), changes_} && !positioner_.lags_too_far() && !written(h);
}

// If no input of an order has changed, a travel goes on with its plan, and
// who idles goes on to do so.
const PositionControl& PositioningService::order(Time now, std::span<int32_t> h, uint32_t syncs) {
  if (!followed_ || !(*followed_ == Followed{drive_.changes(), changes_}) || written(h))
    return order_anew(now, h, syncs);
  syncs_ = syncs;
  lead();
  if (positioner_.has_events()) {
    report_events(now);
    followed_.reset();
  }
  return ordered_;
}

inline void PositioningService::note_probes() {
  const TouchProbes::Probe& first = positioner_.touch_probes().probe(0);
  const TouchProbes::Probe& second = positioner_.touch_probes().probe(1);
  probed_ = {second.absolute, first.absolute, second.external, second.motor, first.external, first.motor};
}

const PositionControl& PositioningService::order_anew(Time now, std::span<int32_t> h, uint32_t syncs) {
  read_settings();
  if (!mirrors_agree_ || mirrors_written(h)) take_mirrors(h);
  take_targets(h);
  if (positioner_version_ != settings_version_) {
    positioner_version_ = settings_version_;
    positioner_.take_over(settings_);
  }
  const Followed followed{drive_.changes(), changes_};
  // Where the master turns an encoder X14, its position is taken as often as a telegram would bring it (ours).
  constexpr int64_t kEvery = 5;
  if (h.size() > kSyncSource && h[kSyncSource] == kActPosExt && drive_.encoders().x14 && milliseconds_.number(now) % kEvery == 0) syncs_ = syncs - 1;
  read_inputs(h, syncs);
  if (inputs_.reference_start && !positioner_.inputs().reference_start)
    not_ordered(PositioningCause::Reference);
  const PositioningOrder order = positioner_.tick(inputs_);
  if (positioner_.has_events() || reported_.any()) report_events(now);
  const bool settled = reported_.none() && settings_.technology_function != kIsync &&
                       (positioner_.idles() || positioner_.goes_on());
  followed_ = settled ? std::optional(followed) : std::nullopt;
  if (const auto counter = positioner_.take_motor_counter()) drive_.set_position(*counter);
  note_probes();
  ordered_ = {order.controls, order.speed, command_of(order.halt), positioner_.in_position(),
              positioner_.referenced()};
  return ordered_;
}

std::string PositioningService::place_of(PositioningEvent event) const {
  PositioningCause cause = cause_of(event);
  if (cause == PositioningCause::Motion)
    cause = positioner_.follow_state() != FollowState::Free ? PositioningCause::None
            : positioner_.referencing()                     ? PositioningCause::Reference
                                                            : PositioningCause::Target;
  // Somebody else has changed a parameter since.
  if (cause == PositioningCause::Setting && setting_version_ != parameters_.changes()) return {};
  const std::optional<uint32_t> address = ordered_at_[static_cast<size_t>(cause)];
  return address ? place_(*address) : std::string();
}

void PositioningService::report_events(Time now) {
  const auto [events, target] = positioner_.take_events();
  const auto fresh = events & ~reported_;
  reported_ = events;
  for (size_t n = 0; n < fresh.size(); ++n) {
    if (!fresh.test(n)) continue;
    const auto event = static_cast<PositioningEvent>(n);
    const uint8_t fault = fault_of(event);
    if (fault != 0) drive_.raise_fault(fault);
    const std::string place = place_of(event);
    journal_.note(
        now, Weight::Warning, station_,
        fmt::format("{}{} ({}position {}{}{})", fault == 0 ? "" : fmt::format("F{:02}: ", fault),
                    stdlib::unit_text(parameters_.unit(), text_of(event)),
                    target ? fmt::format("target {}, ", *target) : "", positioner_.setpoint(),
                    place.empty() ? "" : ", ordered at ", place));
  }
}

inline void PositioningService::show_positions(std::span<int32_t> h, const Encoders::Positions& positions,
                                               int32_t setpoint) {
  const uint32_t control = static_cast<uint32_t>(h[kModuloCtrl]);
  if (positioner_.modulo().on()) h[kModActPos] = positioner_.modulo().position((control >> 1 & 1) != 0);
  h[kSetpointPos] = setpoint;
  h[kActPosMot] = positions.of(PositionSource::Motor);
  h[kActPosExt] = positions.of(PositionSource::External);
  h[kActPosAbs] = positions.of(PositionSource::Absolute);
}

void PositioningService::advance(std::span<int32_t> h, uint32_t syncs, int32_t before) {
  syncs_ = syncs;
  const int32_t counter = drive_.position();
  if (positioner_.encoders().stands_at(counter)) return;
  positioner_.advance(before, counter);
  const Encoders::Positions positions = positioner_.encoders().positions();
  show_target_positions(h);
  show_positions(h, positions, positions.of(positioner_.source()));
}

void PositioningService::show(Time now, std::span<int32_t> h) {
  show_target_positions(h);
  show_bits(h);
  h[kModActPos] = 0;
  show_positions(h, positioner_.encoders().positions(), positioner_.setpoint());
  h[kLagDistance] = positioner_.lag();
  if (h.size() > kGearSlave) h[kSyncState] = static_cast<int32_t>(positioner_.follow_state());
  h[kSetpointPosBus] = bus_position_ = drive_.bus_position().value_or(bus_position_);
  std::memcpy(&h[kTpPos2Abs], probed_.data(), sizeof probed_);
  if (cams_run_) run_cams(now, h);
}

void PositioningService::run_cams(Time now, std::span<int32_t> h) {
  cam_sources_.tick(h);
  const auto ms = static_cast<uint64_t>(milliseconds_.number(now));
  if (extended_cams_.runs() && !extended_cams_.tick(h, cam_sources_, {positioner_.referenced(), ms}))
    journal_.note(now, Weight::Warning, station_,
                  "GSCAM_EXT: the structure names a variable the unit does not have; this cam controller is "
                  "stopped");
  cams_run_ = extended_cams_.runs() || !cam_sources_.watches_none();
}

}  // namespace ipos::runtime
