// The commands one by one. Keyword values are those of vm/isa/keywords.def.
#include "runtime/commands/positioning_commands.hpp"

#include <cassert>
#include <utility>

#include "runtime/commands/command_call.hpp"

namespace ipos::runtime {
namespace {

using vm::Opcode;

constexpr vm::HostReply fail(const char* reason) { return {vm::Answer::Fault, vm::kFaultIllop, reason}; }

constexpr int32_t kWait = 1;  // of the set go

// Of the set go0: three bits, or RESET.
constexpr int32_t kNoWait = 1, kCam = 2, kConditional = 4, kGo0Reset = 8;

enum AxisStopKeyword : int32_t { kRapidStop, kHoldControl, kPositionStop, kEnable };

// Of the set touchp: four for each probe.
constexpr int32_t kProbeKeywords = 4;
enum TouchProbeKeyword : int32_t { kDisable, kBothEdges, kRising, kFalling };

constexpr int32_t kGetCam = 8;
enum SetSysKeyword : int32_t { kPosRamp = 9, kPosSpeed = 10 };

}  // namespace

bool PositioningCommands::has_value(Opcode opcode, int32_t keyword) {
  return opcode == Opcode::GetSys ? keyword == kGetCam : keyword == kPosRamp || keyword == kPosSpeed;
}

vm::HostReply PositioningCommands::execute(vm::Machine& machine, int context,
                                           const vm::Instruction& command) {
  const auto h = machine.variables();
  const int32_t a = command.operands[0];
  const uint32_t address = machine.context(context).pc;
  switch (command.opcode) {
    case Opcode::GoAbsH:
    case Opcode::GoAbsK:
    case Opcode::GoRelH:
    case Opcode::GoRelK: return travel(machine, context, command);

    case Opcode::Go0:
      service_.take_targets(h);
      service_.ordered_at(PositioningCause::Reference, address);
      if (a == kGo0Reset)
        service_.change_positioner().end_reference();
      else
        service_.change_positioner().start_reference((a & kConditional) != 0, (a & kCam) == 0);
      service_.show_targets(h);
      return service_.positioner().referencing() && (a & kNoWait) == 0 ? wait(context) : vm::HostReply{};

    case Opcode::AxisStop:
      service_.take_targets(h);
      switch (a) {
        case kRapidStop: service_.change_positioner().halt(Halt::RapidStop); break;
        case kHoldControl: service_.change_positioner().halt(Halt::HoldControl); break;
        case kPositionStop: service_.change_positioner().stop_here(); break;
        case kEnable: service_.change_positioner().halt(Halt::None); break;
        default: break;
      }
      service_.show_targets(h);
      return vm::HostReply{};

    case Opcode::TouchProbe: {
      const int32_t edges = a % kProbeKeywords;
      service_.change_positioner().touch_probes().enable(static_cast<size_t>(a / kProbeKeywords),
                                                         edges == kBothEdges || edges == kRising,
                                                         edges == kBothEdges || edges == kFalling);
      return vm::HostReply{};
    }

    case Opcode::GetSys: return run_cam(h, static_cast<uint32_t>(a));
    case Opcode::SetSys: return set_system_value(h, a, static_cast<size_t>(command.operands[1]), address);
    default: break;
  }
  assert(false && "the command is one of positioning");
  return {};
}

vm::HostReply PositioningCommands::travel(vm::Machine& machine, int context, const vm::Instruction& command) {
  const auto h = machine.variables();
  const bool from_variable = command.opcode == Opcode::GoAbsH || command.opcode == Opcode::GoRelH;
  const bool relative = command.opcode == Opcode::GoRelH || command.opcode == Opcode::GoRelK;
  const int32_t operand = command.operands[1];
  const int32_t value = from_variable ? h[static_cast<size_t>(operand)] : operand;
  service_.take_targets(h);
  service_.ordered_at(PositioningCause::Target, machine.context(context).pc);
  if (relative)
    service_.change_positioner().move_target(value);
  else
    service_.change_positioner().write_target(value);
  service_.show_targets(h);
  return command.operands[0] == kWait ? wait(context) : vm::HostReply{};
}

vm::HostReply PositioningCommands::wait(int context) {
  if (service_.positioner().in_position()) return {};
  waiting_[slot(context)] = may_wait_ = true;
  return {vm::Answer::Wait, 0, nullptr};
}

void PositioningCommands::resume(vm::Machine& machine) {
  may_wait_ = false;
  for (int context = 1; context <= vm::kContexts; ++context)
    if (std::exchange(waiting_[slot(context)], false)) machine.resume(context);
}

vm::HostReply PositioningCommands::set_system_value(std::span<const int32_t> h, int32_t keyword,
                                                    size_t variable, uint32_t address) {
  constexpr int32_t kDigit = 100;  // in 1/1000 rpm
  const auto speed = [&](size_t n) {
    const int64_t mrpm = int64_t{h[variable + n]} * kDigit;
    return static_cast<int32_t>(std::clamp<int64_t>(mrpm, 0, INT32_MAX));
  };
  const auto has = [&](size_t count) { return variable + count <= h.size(); };
  assert(has_value(Opcode::SetSys, keyword));
  if (keyword == kPosRamp) {
    if (!has(2)) return fail("SETSYS POS.RAMP: the structure ends behind the variables of the unit");
    service_.set_parameter("911", h[variable], address);
    service_.set_parameter("912", h[variable + 1], address);
    return {};
  }
  if (!has(2)) return fail("SETSYS POS.SPEED: the structure ends behind the variables of the unit");
  service_.set_parameter("913", speed(0), address);
  service_.set_parameter("914", speed(1), address);
  return {};
}

vm::HostReply PositioningCommands::run_cam(std::span<int32_t> h, uint32_t structure) {
  // Bit 31 of the first element tells the two kinds apart (IPOSplus p. 86, 91).
  const bool extended = h[structure] < 0;
  const bool good = extended ? service_.extended_cams().start(structure, h, service_.cam_sources())
                             : run_standard_cam(structure, h, service_.cam_sources());
  return good ? vm::HostReply{}
              : fail("GETSYS CAM: the structure leads to no variable of the unit, or there are too many");
}

namespace commands {
namespace {

vm::HostReply position(CommandCall& call) {
  PositioningCommands* positioning = call.services.positioning;
  if (positioning == nullptr) return illegal("the unit does not position");
  return positioning->execute(call.machine, call.context, call.command);
}

}  // namespace

vm::HostReply GoAbsH(CommandCall& call) { return position(call); }
vm::HostReply GoAbsK(CommandCall& call) { return position(call); }
vm::HostReply GoRelH(CommandCall& call) { return position(call); }
vm::HostReply GoRelK(CommandCall& call) { return position(call); }
vm::HostReply Go0(CommandCall& call) { return position(call); }
vm::HostReply AxisStop(CommandCall& call) { return position(call); }
vm::HostReply TouchProbe(CommandCall& call) { return position(call); }

}  // namespace commands

}  // namespace ipos::runtime
