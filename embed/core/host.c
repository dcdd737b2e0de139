/* From the machine to the callbacks: variable telegrams and non-volatile memory are done here when the host gives the
 * means, everything else is asked of its `command`. Also the memory of MEM: u32 "IPNV", u32 CRC-32 of the values, H0 to H127. */
#include "embed/core/state.h"

enum { kNvMagic = 0x564E5049 }; /* "IPNV" */

static ipos_status nv_store(ipos_vm* vm) {
  if (vm->host.nv_write == NULL) return IPOS_NO_CALLBACK;
  const uint32_t head[2] = {kNvMagic, crc32((const uint8_t*)vm->h, 4 * IPOS_NV_VARIABLES)};
  /* The head last: a store that is interrupted leaves nothing that passes for valid. */
  const bool stored = vm->host.nv_write(vm->host.user, sizeof head, vm->h, 4 * IPOS_NV_VARIABLES) &&
                      vm->host.nv_write(vm->host.user, 0, head, sizeof head);
  return stored ? IPOS_OK : IPOS_HOST_FAILED;
}

APART static ipos_status nv_load(ipos_vm* vm) {
  if (vm->host.nv_read == NULL) return IPOS_NO_CALLBACK;
  uint32_t head[2];
  int32_t values[IPOS_NV_VARIABLES];
  memset(head, 0, sizeof head);
  memset(values, 0, sizeof values);
  if (!vm->host.nv_read(vm->host.user, 0, head, sizeof head) ||
      !vm->host.nv_read(vm->host.user, sizeof head, values, sizeof values))
    return IPOS_HOST_FAILED;
  if (head[0] != kNvMagic || head[1] != crc32((const uint8_t*)values, sizeof values)) return IPOS_NO_CONTENT;
  memcpy(vm->h, values, sizeof values);
  return IPOS_OK;
}

static ipos_status in_callbacks(ipos_vm* vm, ipos_status (*act)(ipos_vm* vm)) {
  if (vm == NULL) return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  vm->busy = true;
  const ipos_status status = act(vm);
  vm->busy = false;
  return status;
}

ipos_status ipos_nv_store(ipos_vm* vm) { return in_callbacks(vm, nv_store); }
ipos_status ipos_nv_load(ipos_vm* vm) { return in_callbacks(vm, nv_load); }

static ipos_reply fail(unsigned fault, const char* reason) {
  const ipos_reply reply = {IPOS_ANSWER_FAULT, (uint8_t)fault, reason};
  return reply;
}

static ipos_reply done(void) {
  const ipos_reply reply = {IPOS_ANSWER_DONE, 0, NULL};
  return reply;
}

static ipos_reply ask(ipos_vm* vm, unsigned number, const instruction* asked) {
  if (vm->host.command == NULL) return fail(kFaultIllop, TEXT("the host cannot carry out system commands"));
  ipos_command command;
  memset(&command, 0, sizeof command);
  command.opcode = (uint8_t)asked->opcode;
  command.context = (uint8_t)(number + 1);
  command.address = vm->contexts[number].pc;
  memcpy(command.operands, asked->operands, sizeof command.operands);
  ipos_reply reply = vm->host.command(vm->host.user, vm, &command);
  if (reply.answer == IPOS_ANSWER_DONE || reply.answer == IPOS_ANSWER_WAIT ||
      (reply.answer == IPOS_ANSWER_TAKEN && kFlows[asked->opcode] == Flow_SystemCall))
    return reply;
  if (reply.answer == IPOS_ANSWER_FAULT && reply.fault != 0) {
    if (reply.reason == NULL) reply.reason = "";
    return reply;
  }
  return fail(kFaultIllop, TEXT("the host has given an answer that this command cannot have"));
}

/* The keyword set `mem`: 0 nothing, 1 store all, 2 load all, 3 store program, 4 store data. The program is in the image. */
static ipos_reply memorize(ipos_vm* vm, int32_t what) {
  ipos_status status = IPOS_OK;
  if (what == 1 || what == 4) status = nv_store(vm);
  if (what == 2) status = nv_load(vm);
  return status == IPOS_OK ? done() : fail(kFaultEeprom, TEXT("MEM: the data could not be stored or loaded"));
}

static ipos_reply carry_out(ipos_vm* vm, unsigned number, const instruction* command) {
  const int32_t* const operands = command->operands;
  if (command->opcode == Op_Memorize && vm->host.nv_write != NULL) return memorize(vm, operands[0]);
#if IPOS_TELEGRAMS
  if (vm->host.send != NULL) switch (command->opcode) {
      case Op_Scom:
        return define_object(vm, operands[0], (uint32_t)operands[1])
                   ? done()
                   : fail(kFaultIllop, TEXT("DPointer of SCOM does not lead to variables of the unit"));
      case Op_ScomOn: start_objects(vm); return done();
      case Op_ScomState: /* the variable takes the state (ours, as in runtime/commands) */
        if (operands[0] != 0)
          start_objects(vm);
        else
          vm->objects.started = 0;
        vm->h[operands[1]] = operands[0] != 0;
        return done();
      default: break;
    }
#endif
  return ask(vm, number, command);
}

static void cancel_wait(ipos_vm* vm, unsigned number) {
  if (vm->host.cancel != NULL) vm->host.cancel(vm->host.user, vm, (uint8_t)(number + 1));
}

/* Tells the host about a fault of the program, once, and ends its telegrams. */
static void tell_fault(ipos_vm* vm) {
  ipos_fault fault;
  if (vm->fault.number == 0 || vm->fault_told) return;
  vm->fault_told = true;
  forget_objects(vm);
  if (vm->host.fault == NULL) return;
  ipos_fault_of(vm, &fault);
  vm->host.fault(vm->host.user, vm, &fault);
}
