// GETSYS and SETSYS. The manuals read print the names of some; their units are ours, docs/reference/stdlib.md has them.
#include "runtime/commands/system_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace ipos::runtime {
namespace {

constexpr uint8_t kFaultControlWord = 77;
constexpr uint8_t kFaultRamp = 99;

constexpr int32_t kTenthRpm = 100;      // in 1/1000 rpm
constexpr int32_t kTenthPercent = 100;  // in 1/1000 %

// Values of the keyword set `getsys`.
enum Readable : int32_t {
  kActualCurrent,
  kActualSpeed,
  kSpeedSetpoint,
  kFault,
  kUnitState,
  kPoData,
  kDcLink,
  kAnalogInputs,
  kPoData10 = 9,
};

// Values of the keyword set `setsys`.
enum Writable : int32_t {
  kFixed11,
  kFixed12,
  kFixed13,
  kFixed21,
  kFixed22,
  kFixed23,
  kPiData,
  kOperatingMode,
  kMaximumCurrent,
  kPositionRamp,
  kPositionSpeed,
  kOverride,
  kBrakeFunction,
  kRampType,
  kReset,
  kPiData10,
};

// Values that are parameters: the variable times `factor`, rounded toward 0 to `step`, goes into the
// parameter, volatile.
struct ParameterValue {
  Writable keyword;
  std::string_view parameter;
  int32_t factor;
  int32_t step;
  const char* mode;  // what does not exist when the value is none of the parameter's: F77; null: F10
};
constexpr ParameterValue kParameterValues[] = {
    {kFixed11, "160", kTenthRpm, 200, nullptr},
    {kFixed12, "161", kTenthRpm, 200, nullptr},
    {kFixed13, "162", kTenthRpm, 200, nullptr},
    {kFixed21, "170", kTenthRpm, 200, nullptr},
    {kFixed22, "171", kTenthRpm, 200, nullptr},
    {kFixed23, "172", kTenthRpm, 200, nullptr},
    {kOperatingMode, "700", 1, 1, "operating mode"},
    {kMaximumCurrent, "303", kTenthPercent, 1000, nullptr},
    {kOverride, "930", 1, 1, nullptr},
    {kBrakeFunction, "730", 1, 1, nullptr},
    {kRampType, "916", 1, 1, "ramp type"},
};

int32_t value_of_word(uint16_t word) { return static_cast<int16_t>(word); }

// Variables as words, from the `first` of the block on.
template <typename Words>
Words words_at(CommandCall& call, size_t first) {
  Words words{};
  for (size_t n = 0; n < words.size(); ++n) words[n] = static_cast<uint16_t>(call.variable(1, first + n));
  return words;
}

bool is_out_of_range(stdlib::ReturnCode code) {
  namespace codes = stdlib::return_codes;
  return code == codes::kTooLarge || code == codes::kTooSmall || code == codes::kIncorrectValue;
}

vm::HostReply set_parameter_value(CommandCall& call, const ParameterValue& row) {
  ParameterStore& parameters = call.services.parameters;
  const stdlib::Parameter* parameter = parameters.table().find(row.parameter);
  if (parameter == nullptr) return illegal("SETSYS: the unit does not have this value");
  const int32_t given = call.variable(1);
  const int64_t scaled = int64_t{given} * row.factor / row.step * row.step;
  const auto value = static_cast<int32_t>(
      std::clamp<int64_t>(scaled, std::numeric_limits<int32_t>::min(), std::numeric_limits<int32_t>::max()));
  if (row.keyword == kRampType && parameters.stored(parameter->index) != value && ramp_is_locked(call))
    return {};
  const auto service = ParameterService::WriteVolatile;
  const ParameterReply reply = parameters.execute(service, parameter->index, value);
  if (reply) return {};
  if (row.mode != nullptr && is_out_of_range(reply.error())) {
    call.caused_fault = kFaultControlWord;
    call.cause = fmt::format("there is no {} {}", row.mode, given);
    return {};
  }
  call.why = parameters.explain(static_cast<uint8_t>(service), parameter->index, value, reply.error());
  return illegal("SETSYS: the unit refuses this value");
}

}  // namespace

bool ramp_is_locked(CommandCall& call) {
  const ParameterStore& parameters = call.services.parameters;
  const stdlib::Parameter* ramp_type = parameters.table().find("916");
  if (ramp_type == nullptr || parameters.stored(ramp_type->index) == 0) return false;
  if (call.services.drive.verdict().command != Command::Enable) return false;
  call.caused_fault = kFaultRamp;
  call.cause = "a ramp that is not linear (P916) was to be changed while the drive is enabled";
  return true;
}

namespace {

vm::HostReply get_system_value(const CommandCall& call) {
  const Drive& drive = call.services.drive;
  const AxisState& axis = drive.axis();
  int32_t& target = call.variable(0);
  switch (call.operand(1)) {
    case kActualCurrent: target = axis.output_current / kTenthPercent; return {};
    case kActualSpeed: target = axis.speed / kTenthRpm; return {};
    case kSpeedSetpoint: target = drive.setpoint().speed / kTenthRpm; return {};
    case kFault: target = drive.fault(); return {};
    case kUnitState: target = static_cast<int32_t>(drive.condition()); return {};
    case kPoData10:
      for (size_t n = 0; n < kFurtherWords; ++n)
        call.variable(0, kProcessWords + n) = value_of_word(drive.further_po()[n]);
      [[fallthrough]];
    case kPoData:
      for (size_t n = 0; n < kProcessWords; ++n) call.variable(0, n) = value_of_word(drive.po()[n]);
      return {};
    case kDcLink: target = axis.dc_link / 1000; return {};
    case kAnalogInputs:
      call.variable(0, 0) = drive.analog().ai1.millivolt;
      call.variable(0, 1) = drive.analog().ai2.millivolt;
      return {};
    default: return illegal("GETSYS: this value is not simulated yet, see docs/reference/limits.md");
  }
}

vm::HostReply set_system_value(CommandCall& call) {
  const int32_t keyword = call.operand(0);
  for (const ParameterValue& row : kParameterValues)
    if (row.keyword == keyword) return set_parameter_value(call, row);
  Drive& drive = call.services.drive;
  switch (keyword) {
    case kPiData10: drive.set_further_pi(words_at<FurtherWords>(call, kProcessWords)); [[fallthrough]];
    case kPiData: drive.set_ipos_pi(words_at<DriveWords>(call, 0)); return {};
    case kReset:
      if (call.variable(1) != 0 && drive.fault() != 0) drive.reset_fault();
      return {};
    default: return illegal("SETSYS: this value is not simulated yet, see docs/reference/limits.md");
  }
}

}  // namespace

namespace commands {

// Of a unit that positions, positioning has some of the values.
vm::HostReply GetSys(CommandCall& call) {
  PositioningCommands* positioning = call.services.positioning;
  if (positioning != nullptr && positioning->has_value(call.command.opcode, call.operand(1)))
    return positioning->execute(call.machine, call.context, call.command);
  return get_system_value(call);
}

vm::HostReply SetSys(CommandCall& call) {
  PositioningCommands* positioning = call.services.positioning;
  if (positioning != nullptr && positioning->has_value(call.command.opcode, call.operand(0)))
    return positioning->execute(call.machine, call.context, call.command);
  return set_system_value(call);
}

}  // namespace commands

}  // namespace ipos::runtime
