// INPCALL and SYSCALL: calls on a condition. The forms and the events are ours, see docs/reference/stdlib.md.
#include "runtime/commands/command_call.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::runtime {
namespace {

using stdlib::system_variable;

vm::HostReply call_if(bool condition) { return {condition ? vm::Answer::Taken : vm::Answer::Done}; }

// All inputs of the mask have the level; the bits are those of InputLevel.
vm::HostReply input_call(const CommandCall& call) {
  const auto levels = static_cast<uint32_t>(call.h()[system_variable("InputLevel")]);
  const auto mask = static_cast<uint32_t>(call.operand(1));
  constexpr int32_t kHigh = 1;
  return call_if(((call.operand(0) == kHigh ? levels : ~levels) & mask) == mask);
}

// Values of the keyword set `event`.
enum SystemEvent : int32_t {
  kAlways,
  kStandstill,
  kNotInPosition,
  kNotReferenced,
  kTouchProbe,
  kNoTouchProbe
};

vm::HostReply system_call(const CommandCall& call) {
  const int32_t status = call.h()[system_variable("StatusWord")];
  const auto off = [&](unsigned bit) { return call_if((static_cast<uint32_t>(status) >> bit & 1) == 0); };
  switch (call.operand(0)) {
    case kAlways: return call_if(true);
    case kStandstill: return call_if(call.services.drive.standing());
    case kNotInPosition: return off(19);  // IPOSplus p. 34
    case kNotReferenced: return off(20);  // p. 91
    case kTouchProbe:
    case kNoTouchProbe: break;
    default: return illegal("SYSCALL: there is no such event");
  }
  if (call.services.positioning == nullptr) return illegal("SYSCALL: the unit has no touch probes");
  return call_if(call.services.positioning->touched() == (call.operand(0) == kTouchProbe));
}

}  // namespace

namespace commands {

vm::HostReply InputCall(CommandCall& call) { return input_call(call); }
vm::HostReply SystemCall(CommandCall& call) { return system_call(call); }

}  // namespace commands

}  // namespace ipos::runtime
