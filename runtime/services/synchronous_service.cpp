// Copies between parameters, terminals, encoders and synchronous operation.
#include "runtime/services/synchronous_service.hpp"

#include <fmt/format.h>

namespace ipos::runtime {
namespace {

constexpr uint8_t kLagError = 42;

}  // namespace

SynchronousService::SynchronousService(Drive& drive, ParameterStore& parameters, Journal& journal, std::string_view station)
    : drive_(drive), parameters_(parameters), journal_(journal), station_(station), settings_version_(parameters.changes() - 1) {
#define SYNCHRONOUS_SETTING(member, number, value) \
  cells_.push_back({&SynchronousSettings::member, parameters.table().find(std::string_view(number))->index});
#include "runtime/positioning/synchronous.def"
}

void SynchronousService::read_settings() {
  if (settings_version_ == parameters_.changes()) return;
  settings_version_ = parameters_.changes();
  for (const Cell& cell : cells_) settings_.*cell.member = parameters_.stored(cell.index);
}

// The terminals X40 of the card are no inputs of the plant: SLAVE FREE RUNN. stands for free running, and the inputs of the
// fixed setpoints choose the offset, as they have nothing else to do in synchronous operation (ours).
SynchronousInputs SynchronousService::inputs() const {
  using F = InputFunction;
  const Decisions& decisions = drive_.decisions();
  const Terminals& t = decisions.terminals;
  SynchronousInputs in;
  in.following = drive_.follows(decisions);
  in.speed = drive_.speed();
  in.master = drive_.encoders().x42.value_or(0);
  in.slave = drive_.shaft_position();
  in.free_run = t.on(F::SlaveFreeRun);
  in.zero_point = t.on(F::DrsZeroPoint);
  in.start = t.on(F::DrsSlaveStart) || !t.assigned(F::DrsSlaveStart);
  in.teach_in = t.on(F::DrsTeachIn);
  in.master_stopped = t.on(F::DrsMasterStopped);
  in.limit_cw = t.off(F::LimitCw);
  in.limit_ccw = t.off(F::LimitCcw);
  in.offset = static_cast<uint8_t>((t.on(F::FixedLow) ? 1 : 0) | (t.on(F::FixedHigh) ? 2 : 0));
  return in;
}

void SynchronousService::report_lag_error(Time now) {
  drive_.raise_fault(kLagError);
  journal_.note(now, Weight::Warning, station_,
                fmt::format("F{}: the slave has been more than P512 away from its master for longer than P513 (DRS); the difference is {} "
                            "increments",
                            kLagError, operation_.difference()));
}

const PositionControl& SynchronousService::order(Time now, const PositionControl& positioning) {
  if (!selected()) {
    operation_ = {};
    return positioning;
  }
  read_settings();
  const bool had_error = operation_.lag_error();
  const SynchronousOrder order = operation_.tick(settings_, inputs());
  if (operation_.lag_error() && !had_error) report_lag_error(now);
  const auto flag = [](bool on, uint32_t bit) { return on ? bit : 0; };
  ordered_ = positioning;
  ordered_.controls = order.controls;
  ordered_.speed = order.speed;
  if (order.stands && positioning.halt == Command::Enable) ordered_.halt = Command::Stop;
  ordered_.output_flags = flag(operation_.prewarning(), output_flags::kDrsPrewarning) |
                          flag(operation_.lag_error(), output_flags::kDrsLagError) |
                          flag(operation_.in_position(), output_flags::kDrsInPosition);
  return ordered_;
}

}  // namespace ipos::runtime
