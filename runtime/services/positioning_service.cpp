// Copies between H variables, parameters, drive and positioner.
#include "runtime/services/positioning_service.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime {
namespace {

enum SystemVariable : size_t {
  kModuloCtrl = 453,
  kModTagPos = 454,
  kModActPos = 455,
  kModCount = 456,
  kStatusWord = 473,
  kSetpointPos = 491,
  kTargetPos = 492,
  kPosWindow = 493,
  kLagWindow = 494,
  kLagDistance = 495,
  kSlsRight = 496,
  kSlsLeft = 497,
  kRefOffset = 498,
  kSetpointPosBus = 499,
  kTpPos2Abs = 502,
  kTpPos1Abs = 503,
  kTpPos2Ext = 504,
  kTpPos2Mot = 505,
  kTpPos1Ext = 506,
  kTpPos1Mot = 507,
  kActPosAbs = 509,
  kActPosExt = 510,
  kActPosMot = 511,
  kSyncSource = 560,
  kSyncControl = 561,
  kSyncState = 562,
  kGearMaster = 563,
  kGearSlave = 564,
};

constexpr unsigned kInPosition = 19;  // IPOSplus p. 34
constexpr unsigned kReferenced = 20;  // IPOSplus p. 91

void set_bit(int32_t& word, unsigned bit, bool on) {
  const uint32_t mask = 1U << bit;
  const auto bits = static_cast<uint32_t>(word);
  word = static_cast<int32_t>(on ? bits | mask : bits & ~mask);
}

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

PositioningService::PositioningService(Drive& drive, ParameterStore& parameters, Journal& journal,
                                       std::string_view station, SourcePlace place)
    : drive_(drive),
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
  using P = PositioningSettings;
  for (const Mirror& mirror :
       {Mirror{kPosWindow, &P::window, "922", 0}, Mirror{kLagWindow, &P::lag_window, "923", 0},
        Mirror{kSlsRight, &P::limit_cw, "920", 0}, Mirror{kSlsLeft, &P::limit_ccw, "921", 0},
        Mirror{kRefOffset, &P::reference_offset, "900", 0}})
    if (index_of(mirror.number) != 0) mirrors_.push_back(mirror);
  read_settings();
  positioner_.power_on(settings_, drive.shaft_position());
}

void PositioningService::read_settings() {
  if (settings_version_ == parameters_.changes()) return;
  settings_version_ = parameters_.changes();
  for (const Cell& cell : cells_) settings_.*cell.member = parameters_.stored(cell.index);
}

void PositioningService::set_parameter(std::string_view number, int32_t value) {
  if (const stdlib::Parameter* row = parameters_.table().find(number))
    parameters_.set_working(row->index, value);
}

// The last one to write wins: over a bus the parameter, in the program the variable.
void PositioningService::take_mirrors(std::span<int32_t> h) {
  const bool agreed = std::all_of(mirrors_.begin(), mirrors_.end(), [&](const Mirror& mirror) {
    return h[mirror.variable] == mirror.shown && settings_.*mirror.member == mirror.shown;
  });
  if (agreed) return;
  for (Mirror& mirror : mirrors_)
    if (h[mirror.variable] != mirror.shown && settings_.*mirror.member == mirror.shown)
      set_parameter(mirror.number, h[mirror.variable]);
  read_settings();
  for (Mirror& mirror : mirrors_) h[mirror.variable] = mirror.shown = settings_.*mirror.member;
}

void PositioningService::take_targets(std::span<const int32_t> h) {
  if (h[kTargetPos] != shown_target_) {
    ordered_at_.reset();
    positioner_.write_target(h[kTargetPos]);
  }
  if (h[kModTagPos] != shown_modulo_target_) {
    ordered_at_.reset();
    positioner_.write_modulo_target(h[kModTagPos]);
  }
  if (h[kModCount] != shown_turns_) positioner_.set_modulo_turns(h[kModCount]);
  shown_target_ = h[kTargetPos];
  shown_modulo_target_ = h[kModTagPos];
  shown_turns_ = h[kModCount];
}

void PositioningService::show_target_positions(std::span<int32_t> h) {
  h[kTargetPos] = shown_target_ = positioner_.target();
  h[kModTagPos] = shown_modulo_target_ = positioner_.modulo_target();
  h[kModCount] = shown_turns_ = positioner_.modulo().turns();
}

void PositioningService::show_targets(std::span<int32_t> h) {
  show_target_positions(h);
  set_bit(h[kStatusWord], kInPosition, positioner_.in_position());
  set_bit(h[kStatusWord], kReferenced, positioner_.referenced());
}

PositioningInputs PositioningService::inputs(std::span<const int32_t> h) const {
  using F = InputFunction;
  const Terminals t = drive_.terminals();
  PositioningInputs in;
  in.possible = drive_.can_position();
  in.following = drive_.follows();
  in.speed = drive_.speed();
  in.levels = drive_.inputs();
  in.cam = t.on(F::ReferenceCam);
  in.limit_cw = t.off(F::LimitCw);  // low-active
  in.limit_ccw = t.off(F::LimitCcw);
  in.has_cam = t.assigned(F::ReferenceCam);
  in.has_limits = t.assigned(F::LimitCw) && t.assigned(F::LimitCcw);
  in.reference_start = t.on(F::ReferenceStart);
  in.override_permille = override_of(drive_.analog());
  in.modulo_control = static_cast<uint32_t>(h[kModuloCtrl]);
  return in;
}

// A gear of 0 is one of 1.
MasterInputs PositioningService::master(std::span<const int32_t> h, uint32_t syncs) {
  MasterInputs master;
  master.sync = syncs != syncs_;
  syncs_ = syncs;
  if (h.size() <= kGearSlave) return {};
  const auto source = static_cast<uint32_t>(h[kSyncSource]);
  if (settings_.technology_function != kIsync || source == 0 || source >= h.size()) return {};
  master.follow = (h[kSyncControl] & 1) != 0;
  master.position = h[source];
  if (h[kGearMaster] != 0) master.gear_master = h[kGearMaster];
  if (h[kGearSlave] != 0) master.gear_slave = h[kGearSlave];
  return master;
}

// Nothing that positioning follows has changed since a millisecond in which there was nothing to do; so there
// is nothing to do in this one.
bool PositioningService::stays_idle(std::span<const int32_t> h) const {
  const PositioningInputs& last = positioner_.inputs();
  return idles_ && settings_version_ == parameters_.changes() && drive_.inputs() == last.levels &&
         !drive_.can_position() &&
         drive_.terminals().on(InputFunction::ReferenceStart) == last.reference_start &&
         h[kTargetPos] == shown_target_ && h[kModTagPos] == shown_modulo_target_ &&
         h[kModCount] == shown_turns_ && static_cast<uint32_t>(h[kModuloCtrl]) == last.modulo_control &&
         std::all_of(mirrors_.begin(), mirrors_.end(),
                     [&](const Mirror& mirror) { return h[mirror.variable] == mirror.shown; });
}

PositionControl PositioningService::order(Time now, std::span<int32_t> h, uint32_t syncs) {
  if (stays_idle(h)) {
    syncs_ = syncs;
    const PositioningOrder order = positioner_.idle(drive_.speed());
    return {order.controls, order.speed, command_of(order.halt), false, positioner_.referenced()};
  }
  read_settings();
  take_mirrors(h);
  take_targets(h);
  PositioningInputs in = inputs(h);
  in.master = master(h, syncs);
  const PositioningOrder order = positioner_.tick(in, settings_);
  report_events(now);
  idles_ = positioner_.idles() && reported_.none() && settings_.technology_function != kIsync;
  if (const auto counter = positioner_.take_motor_counter()) drive_.set_position(*counter);
  return {order.controls, order.speed, command_of(order.halt), positioner_.in_position(),
          positioner_.referenced()};
}

void PositioningService::report_events(Time now) {
  const auto events = positioner_.take_events();
  if (events.none()) {
    reported_.reset();
    return;
  }
  const auto fresh = events & ~reported_;
  reported_ = events;
  for (size_t n = 0; n < fresh.size(); ++n) {
    if (!fresh.test(n)) continue;
    const auto event = static_cast<PositioningEvent>(n);
    const uint8_t fault = fault_of(event);
    if (fault != 0) drive_.raise_fault(fault);
    const std::string place = ordered_at_ ? place_(*ordered_at_) : std::string();
    journal_.note(
        now, Weight::Warning, station_,
        fmt::format("{}{} (target {}, position {}{}{})", fault == 0 ? "" : fmt::format("F{:02}: ", fault),
                    text_of(event), positioner_.target(), positioner_.setpoint(),
                    place.empty() ? "" : ", ordered at ", place));
  }
}

void PositioningService::go_on(std::span<int32_t> h, uint32_t syncs) {
  syncs_ = syncs;
  const int32_t counter = drive_.position();
  if (positioner_.encoders().stands_at(counter)) return;
  positioner_.glide(counter);
  const Encoders::Positions positions = positioner_.encoders().positions();
  show_target_positions(h);
  show_positions(h, positions, positions.of(positioner_.source()));
}

void PositioningService::show_positions(std::span<int32_t> h, const Encoders::Positions& positions,
                                        int32_t setpoint) {
  const uint32_t control = static_cast<uint32_t>(h[kModuloCtrl]);
  if (positioner_.modulo().on()) h[kModActPos] = positioner_.modulo().position((control >> 1 & 1) != 0);
  h[kSetpointPos] = setpoint;
  h[kActPosMot] = positions.motor;
  h[kActPosExt] = positions.external;
  h[kActPosAbs] = positions.absolute;
}

void PositioningService::show(Time now, std::span<int32_t> h) {
  positioner_.observe(drive_.position());
  show_targets(h);
  h[kModActPos] = 0;
  show_positions(h, positioner_.encoders().positions(), positioner_.setpoint());
  h[kLagDistance] = positioner_.lag();
  if (h.size() > kGearSlave) h[kSyncState] = static_cast<int32_t>(positioner_.follow_state());
  h[kSetpointPosBus] = bus_position_ = drive_.bus_position().value_or(bus_position_);
  const TouchProbes::Probe& first = positioner_.touch_probes().probe(0);
  const TouchProbes::Probe& second = positioner_.touch_probes().probe(1);
  h[kTpPos1Mot] = first.motor;
  h[kTpPos1Ext] = first.external;
  h[kTpPos1Abs] = first.absolute;
  h[kTpPos2Mot] = second.motor;
  h[kTpPos2Ext] = second.external;
  h[kTpPos2Abs] = second.absolute;
  if (!cams_run_) return;
  cam_sources_.tick(h);
  const auto ms = static_cast<uint64_t>(now / kMillisecond);
  if (extended_cams_.runs() && !extended_cams_.tick(h, cam_sources_, {positioner_.referenced(), ms}))
    journal_.note(now, Weight::Warning, station_,
                  "GSCAM_EXT: the structure names a variable the unit does not have; this cam controller is "
                  "stopped");
  cams_run_ = extended_cams_.runs() || !cam_sources_.watches_none();
}

}  // namespace ipos::runtime
