// The outlook of the machine, and what it means for positions and telegrams.
#include "runtime/unit/program_reach.hpp"

#include <algorithm>
#include <utility>

#include "stdlib/system_variables.hpp"
#include "vm/sched/outlook.hpp"

namespace ipos::runtime {
namespace {

using vm::Opcode;

constexpr Opcode kBusCalls[] = {Opcode::Movlnk, Opcode::Scom, Opcode::ScomOn, Opcode::ScomState};

// PositioningCommands answers none of them with a fault.
constexpr Opcode kOfPositioning[] = {Opcode::GoAbsH, Opcode::GoAbsK,   Opcode::GoRelH,    Opcode::GoRelK,
                                     Opcode::Go0,    Opcode::AxisStop, Opcode::TouchProbe};

// Not the target, and not what belongs to the modulo function.
constexpr size_t kOfTravel[] = {
    stdlib::system_variable("SetpointPos"), stdlib::system_variable("LagDistance"), stdlib::system_variable("ActPos_Abs"),
    stdlib::system_variable("ActPos_Ext"), stdlib::system_variable("ActPos_Mot")};

bool has_system_variables(uint32_t first, VariableFormat format) {
  for (uint32_t n = 0; n < format.variables(); ++n)
    if (is_system_variable(first + n)) return true;
  return false;
}

}  // namespace

bool is_system_variable(size_t variable) {
  return variable >= stdlib::kFirstSystemVariable && variable <= stdlib::kLastSystemVariable;
}

ProgramReach::ProgramReach(const vm::Machine& machine, std::span<const VariableObjects* const> objects, bool positions,
                           std::vector<uint16_t> memory)
    : rollback(std::move(memory)) {
  rollback.clear();
  const vm::Outlook outlook(machine);
  const auto reached = [&](Opcode call) { return outlook.reaches(call); };
  const auto used = [&](const stdlib::UsedVariable& variable) {
    return variable.use == stdlib::VariableUse::Moves && outlook.used()[variable.number];
  };
  mute = std::none_of(std::begin(kBusCalls), std::end(kBusCalls), reached);
  modest = true;
  for (size_t n = stdlib::kFirstSystemVariable; n <= stdlib::kLastSystemVariable; ++n)
    modest = modest && !outlook.written()[n];
  quiet = modest && !outlook.calls();
  may_fault = positions ? outlook.may_fault_beside(kOfPositioning) : outlook.may_fault();
  may_stop = outlook.may_stop();
  reads_position = std::any_of(std::begin(stdlib::kUsedVariables), std::end(stdlib::kUsedVariables), used);
  reads_travel = std::any_of(std::begin(kOfTravel), std::end(kOfTravel),
                             [&](size_t variable) { return outlook.used()[variable]; });
  sends_position = false;
  apart = outlook.apart();
  for (const VariableObjects* of_bus : objects) {
    of_bus->each_sent([&](uint32_t data, VariableFormat format) {
      sends_position = sends_position || has_system_variables(data, format);
    });
    of_bus->each_received([&](uint32_t /*id*/, uint32_t data, VariableFormat format) {
      apart = apart && !has_system_variables(data, format);
    });
  }
  if (!mute || !apart || !modest) return;
  for (size_t n = 0; n < outlook.written().size(); ++n)
    if (outlook.written()[n]) rollback.push_back(static_cast<uint16_t>(n));
  apart = apart && rollback.size() <= vm::Machine::kMostRollback;
}

}  // namespace ipos::runtime
