// From the machine to the callbacks: variable telegrams and non-volatile memory are done here when the host
// gives the means, everything else is asked of its `command`.
#include <algorithm>

#include "embed/objects.hpp"
#include "vm/image/view.hpp"

namespace ipos::api {
namespace {

using runtime::AcyclicStatus;
using runtime::ObjectKind;
using runtime::ObjectTable;
using vm::Opcode;

constexpr uint8_t kFaultEeprom = 25;  // F25 EEPROM

vm::HostReply fail(uint8_t fault, const char* reason) { return {vm::Answer::Fault, fault, reason}; }

ipos_frame to_c(const runtime::Frame& frame) {
  ipos_frame out{static_cast<uint16_t>(frame.id), frame.length, {}};
  std::copy(frame.data.begin(), frame.data.end(), out.data);
  return out;
}

vm::HostReply define_object(ipos_vm& self, ObjectKind kind, uint32_t variable) {
  const auto h = self.machine.variables();
  const runtime::ObjectRequest request = self.objects.request(kind, variable, h);
  const runtime::ObjectVerdict verdict = self.objects.define(request, h);
  if (verdict == runtime::ObjectVerdict::NoVariables)
    return fail(vm::kFaultIllop, "DPointer of SCOM does not lead to variables of the unit");
  if (verdict == runtime::ObjectVerdict::Accepted && kind == ObjectKind::TransmitAcyclic) {
    const uint32_t tag = ObjectTable::kAcyclicTags + variable;
    ObjectTable::note_acyclic(tag, AcyclicStatus::Sending, h);
    const ipos_frame frame = to_c(ObjectTable::acyclic_frame(request, h));
    switch (self.host.send(self.host.user, &self, &frame, tag)) {
      case IPOS_SENDING_QUEUED: break;
      case IPOS_SENDING_DONE: ObjectTable::note_acyclic(tag, AcyclicStatus::Sent, h); break;
      default: ObjectTable::note_acyclic(tag, AcyclicStatus::Failed, h); break;
    }
  }
  return {};
}

// SCOMST: the variable takes the state, 1 on, 0 off (ours, as in runtime/commands).
vm::HostReply switch_objects(ipos_vm& self, bool on, uint32_t variable) {
  if (on)
    self.objects.start(static_cast<int64_t>(self.ticks));
  else
    self.objects.pause();
  self.machine.variables()[variable] = on ? 1 : 0;
  return {};
}

// The values of the keyword set `mem`: 0 nothing, 1 store all, 2 load all, 3 store program, 4 store data. The
// program is in the image already.
vm::HostReply memorize(ipos_vm& self, int32_t what) {
  self.busy = false;
  ipos_status status = IPOS_OK;
  if (what == 1 || what == 4) status = ipos_nv_store(&self);
  if (what == 2) status = ipos_nv_load(&self);
  self.busy = true;
  return status == IPOS_OK ? vm::HostReply{}
                           : fail(kFaultEeprom, "MEM: the data could not be stored or loaded");
}

vm::HostReply ask(ipos_vm& self, int context, const vm::Instruction& instruction) {
  if (self.host.command == nullptr) return fail(vm::kFaultIllop, "the host cannot carry out system commands");
  ipos_command command{static_cast<uint8_t>(instruction.opcode),
                       static_cast<uint8_t>(context),
                       self.machine.context(context).pc,
                       {}};
  std::copy(instruction.operands.begin(), instruction.operands.end(), command.operands);
  const ipos_reply reply = self.host.command(self.host.user, &self, &command);
  switch (reply.answer) {
    case IPOS_ANSWER_DONE: return {};
    case IPOS_ANSWER_WAIT: return {vm::Answer::Wait, 0, nullptr};
    case IPOS_ANSWER_TAKEN:
      if (vm::coding(instruction.opcode).flow == vm::Flow::SystemCall) return {vm::Answer::Taken, 0, nullptr};
      break;
    case IPOS_ANSWER_FAULT:
      if (reply.fault != 0) return fail(reply.fault, reply.reason != nullptr ? reply.reason : "");
      break;
  }
  return fail(vm::kFaultIllop, "the host has given an answer that this command cannot have");
}

vm::HostReply execute(void* user, vm::Machine&, int context, const vm::Instruction& command) noexcept {
  ipos_vm& self = *static_cast<ipos_vm*>(user);
  const auto operand = [&](size_t n) { return static_cast<uint32_t>(command.operands[n]); };
  const bool sends = self.host.send != nullptr;
  switch (command.opcode) {
    case Opcode::Scom:
      if (sends) return define_object(self, static_cast<ObjectKind>(command.operands[0]), operand(1));
      break;
    case Opcode::ScomOn:
      if (sends) return self.objects.start(static_cast<int64_t>(self.ticks)), vm::HostReply{};
      break;
    case Opcode::ScomState:
      if (sends) return switch_objects(self, command.operands[0] != 0, operand(1));
      break;
    case Opcode::Memorize:
      if (self.host.nv_write != nullptr) return memorize(self, command.operands[0]);
      break;
    default: break;
  }
  return ask(self, context, command);
}

void cancel(void* user, vm::Machine&, int context) noexcept {
  ipos_vm& self = *static_cast<ipos_vm*>(user);
  if (self.host.cancel != nullptr) self.host.cancel(self.host.user, &self, static_cast<uint8_t>(context));
}

}  // namespace

vm::Host machine_host(ipos_vm& self) { return {&self, execute, cancel}; }

void tell_fault(ipos_vm& self) {
  if (self.machine.fault().number == 0 || self.fault_told) return;
  self.fault_told = true;
  self.objects.stop();
  if (self.host.fault == nullptr) return;
  ipos_fault fault;
  ipos_fault_of(&self, &fault);
  self.host.fault(self.host.user, &self, &fault);
}

}  // namespace ipos::api

using namespace ipos;       // NOLINT
using namespace ipos::api;  // NOLINT

ipos_status ipos_receive(ipos_vm* vm, const ipos_frame* frame) {
  if (vm == nullptr || frame == nullptr || frame->length > 8 || frame->id >= runtime::kStandardIdLimit)
    return IPOS_INVALID_ARGUMENT;
  runtime::Frame received;
  received.id = frame->id;
  received.length = frame->length;
  std::copy_n(frame->data, frame->length, received.data.begin());
  const auto receiver = vm->objects.receiver(received);
  return receiver && vm->objects.take(*receiver, received, vm->machine.variables()) ? IPOS_OK
                                                                                    : IPOS_NOT_TAKEN;
}

ipos_status ipos_sent(ipos_vm* vm, uint32_t tag, bool sent) {
  if (vm == nullptr) return IPOS_INVALID_ARGUMENT;
  ObjectTable::note_acyclic(tag, sent ? AcyclicStatus::Sent : AcyclicStatus::Failed, vm->machine.variables());
  return IPOS_OK;
}
