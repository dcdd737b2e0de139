// Commands to the unit as a whole: responses to faults, reset, memory, watchdog.
#include <fmt/format.h>

#include "runtime/commands/command_call.hpp"
#include "stdlib/faults.hpp"

namespace ipos::runtime {
namespace {

constexpr uint8_t kFaultMemory = 25;

// SETFR. A fault with a parameter for its response: that parameter is written, volatile.
vm::HostReply set_fault_response(CommandCall& call) {
  const int32_t number = call.operand(0);
  const int32_t response = call.operand(1);
  const stdlib::FaultRow* row =
      number >= 0 && number <= UINT8_MAX ? stdlib::find_fault(static_cast<uint8_t>(number)) : nullptr;
  if (row == nullptr) return illegal("SETFR: the unit has no fault with this number");
  if (call.services.drive.set_fault_response(row->number, static_cast<FaultResponse>(response))) return {};
  if (row->parameter.empty()) return illegal("SETFR: the response to this fault is fixed");
  ParameterStore& parameters = call.services.parameters;
  const stdlib::Parameter* parameter = stdlib::response_parameter(parameters.table(), *row);
  if (parameter == nullptr) return illegal("SETFR: on this unit the response to this fault is fixed");
  const ParameterReply reply =
      parameters.execute(ParameterService::WriteVolatile, parameter->index, response);
  if (reply) return {};
  call.why = parameters.explain(static_cast<uint8_t>(ParameterService::WriteVolatile), parameter->index,
                                response, reply.error());
  return illegal("SETFR: the unit refuses this response");
}

vm::HostReply memorize(CommandCall& call) {
  if (!call.services.memory.memorize(static_cast<Memorize>(call.operand(0)))) {
    call.caused_fault = kFaultMemory;
    call.cause = "the non-volatile memory does not work";
  }
  return {};
}

// 0 and more (IPOSplus p. 34); 0 runs out in the next millisecond.
vm::HostReply start_watchdog(const CommandCall& call, int32_t ms) {
  if (ms < 0) return illegal("WDON: the time is negative");
  call.services.timers.start_watchdog(call.h(), ms);
  return {};
}

// RESET
vm::HostReply reset_fault(const CommandCall& call) {
  Drive& drive = call.services.drive;
  call.variable(0) = drive.fault();
  if (drive.fault() != 0) drive.reset_fault();
  return {};
}

}  // namespace

namespace commands {

vm::HostReply SetFault(CommandCall& call) { return set_fault_response(call); }
vm::HostReply Memorize(CommandCall& call) { return memorize(call); }
vm::HostReply WdOnH(CommandCall& call) { return start_watchdog(call, call.variable(0)); }
vm::HostReply WdOnK(CommandCall& call) { return start_watchdog(call, call.operand(0)); }
vm::HostReply Reset(CommandCall& call) { return reset_fault(call); }

vm::HostReply WdOff(CommandCall& call) {
  call.services.timers.stop_watchdog();
  return {};
}

}  // namespace commands

}  // namespace ipos::runtime
