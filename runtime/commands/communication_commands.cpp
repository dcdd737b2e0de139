// SCOM, SCOMON and SCOMST (1053 1610 p. 53 to 56), MOVLNK (p. 47); MOVCOM and MOVON are not simulated.
#include <algorithm>

#include "runtime/commands/command_call.hpp"

namespace ipos::runtime {
namespace {

vm::HostReply define_object(CommandCall& call) {
  const auto kind = static_cast<ObjectKind>(call.operand(0));
  const int32_t object = call.variable(1);
  const bool second = object >= 0 && (object & kSbus2Object) != 0 && call.services.objects[1] != nullptr;
  VariableObjects* objects = call.services.objects[second ? 1 : 0];
  if (objects == nullptr) return illegal("SCOM: the station is not on this SBus");
  if (objects->define(kind, static_cast<uint32_t>(call.operand(1)), call.h(), call.why)) return {};
  return illegal("DPointer of SCOM does not lead to variables of the unit");
}

vm::HostReply start_objects(const ProgramServices& services) {
  const auto missing = [](const VariableObjects* objects) { return objects == nullptr; };
  if (std::all_of(services.objects.begin(), services.objects.end(), missing))
    return illegal("SCOMON: the station is on no SBus");
  for (VariableObjects* objects : services.objects)
    if (objects != nullptr) objects->start(services.milliseconds.number(services.clock.now()));
  return {};
}

// The variable takes the state: 1 sending and receiving, 0 not (ours: no manual read prints the arguments).
vm::HostReply switch_objects(CommandCall& call) {
  const bool on = call.operand(0) != 0;
  if (on) {
    if (const vm::HostReply reply = start_objects(call.services); reply.answer != vm::Answer::Done)
      return reply;
  } else {
    for (VariableObjects* objects : call.services.objects)
      if (objects != nullptr) objects->pause();
  }
  call.variable(1) = on ? 1 : 0;
  return {};
}

}  // namespace

namespace commands {

vm::HostReply Scom(CommandCall& call) { return define_object(call); }
vm::HostReply ScomOn(CommandCall& call) { return start_objects(call.services); }
vm::HostReply ScomState(CommandCall& call) { return switch_objects(call); }

vm::HostReply Movlnk(CommandCall& call) {
  const ProgramServices& s = call.services;
  return s.movilink.start(s.clock.now(), call.machine, call.context, static_cast<uint32_t>(call.operand(0)),
                          call.why);
}

vm::HostReply MovCom(CommandCall&) { return illegal(kNotSimulated); }
vm::HostReply MovOn(CommandCall&) { return illegal(kNotSimulated); }

}  // namespace commands

}  // namespace ipos::runtime
