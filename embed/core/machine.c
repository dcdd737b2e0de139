/* Contexts and commands: decode, do, next. It does what the reference interpreter of the simulation does (vm/exec), command by
 * command; tests/embed compares their whole states. */
#include "embed/core/state.h"

static ipos_reply carry_out(ipos_vm* vm, unsigned number, const instruction* command);
static void cancel_wait(ipos_vm* vm, unsigned number);
static bool set_interrupt(ipos_vm* vm, unsigned number, int32_t keyword, uint32_t address);
static bool set_variable_interrupt(ipos_vm* vm, unsigned number, uint32_t structure, uint32_t address);

/* After a context of the task has begun or ended. */
static void choose_active(ipos_vm* vm, unsigned task) {
  unsigned active = task - 1;
  for (unsigned n = kTasks; n < kContexts; ++n) {
    const ipos_context* const t = &vm->contexts[n];
    if (t->state != IPOS_TASK_STOPPED && t->task == task && t->rank > vm->contexts[active].rank) active = n;
  }
  vm->active[task - 1] = (uint8_t)active;
}

static ipos_context* begin(ipos_vm* vm, unsigned number, unsigned task, uint32_t address) {
  ipos_context* const t = &vm->contexts[number];
  memset(t, 0, sizeof *t);
  t->state = IPOS_TASK_READY;
  t->task = (uint8_t)task;
  t->pc = address;
  return t;
}

static void end(ipos_vm* vm, ipos_context* t) {
  t->state = IPOS_TASK_STOPPED;
  choose_active(vm, t->task);
}

static bool waits_for_host(const ipos_context* t) { return t->state == IPOS_TASK_WAITING && t->wait_ms == 0; }

/* Stops the contexts of a task; of all for 0. */
static void stop_task(ipos_vm* vm, unsigned task) {
  for (unsigned n = 0; n < kContexts; ++n) {
    ipos_context* const t = &vm->contexts[n];
    if (t->state == IPOS_TASK_STOPPED || (task != 0 && t->task != task)) continue;
    const bool host_waits = waits_for_host(t);
    end(vm, t);
    if (host_waits) cancel_wait(vm, n);
  }
}

static void start_task(ipos_vm* vm, unsigned task, uint32_t address) {
  stop_task(vm, task);
  begin(vm, task - 1, task, address);
}

/* The wait is over: on after the command. */
static void go_on(ipos_vm* vm, ipos_context* t) {
  instruction command;
  t->state = IPOS_TASK_READY;
  decode(vm->program->code, vm->program->words, t->pc, &command);
  t->pc += command.words;
}

static bool raise_fault(ipos_vm* vm, unsigned number, unsigned fault, const char* reason) {
  const ipos_context* const t = &vm->contexts[number];
  vm->fault.number = (uint8_t)fault;
  vm->fault.task = t->task;
  vm->fault.context = (uint8_t)(number + 1);
  vm->fault.address = t->pc;
  vm->fault.reason = reason;
  stop_task(vm, 0);
  return true;
}

static bool call(ipos_vm* vm, unsigned number, const instruction* command, uint32_t target) {
  ipos_context* const t = &vm->contexts[number];
  if (t->depth == vm->program->unit->call_depth || t->depth == kMaxCallDepth)
    return raise_fault(vm, number, kFaultOverflow, TEXT("calls are nested deeper than the unit allows"));
  t->calls[t->depth++] = (uint16_t)(t->pc + command->words);
  t->pc = target;
  return false;
}

/* What no command of the machine does. */
static bool execute_by_host(ipos_vm* vm, unsigned number, const instruction* command) {
  ipos_context* const t = &vm->contexts[number];
  const ipos_reply reply = carry_out(vm, number, command);
  if (reply.answer == IPOS_ANSWER_FAULT) return raise_fault(vm, number, reply.fault, reply.reason);
  if (t->state == IPOS_TASK_STOPPED || t->commands == 0) return false; /* it has stopped or restarted its own task */
  if (reply.answer == IPOS_ANSWER_WAIT)
    t->state = IPOS_TASK_WAITING;
  else if (reply.answer == IPOS_ANSWER_TAKEN) {
    unsigned last = 3;
    while (kind_of(command->form, last) == Kind_None) --last;
    return call(vm, number, command, (uint32_t)command->operands[last]);
  } else
    t->pc += command->words;
  return false;
}

static int32_t with_bit(int32_t value, int32_t bit, bool on) {
  const uint32_t mask = (uint32_t)1 << bit;
  return (int32_t)(on ? (uint32_t)value | mask : (uint32_t)value & ~mask);
}

/* Executes the command a context stands at; true when the program is stopped by a fault. Arithmetic is that of IPOS: 32
 * bits with wrap-around (IPOSplus p. 28), division toward zero, shift counts modulo 32. */
static bool execute(ipos_vm* vm, unsigned number) {
  ipos_context* const t = &vm->contexts[number];
  int32_t* const h = vm->h;
  instruction command;
  decode(vm->program->code, vm->program->words, t->pc, &command);
  const int32_t a = command.operands[0];
  const int32_t b = command.operands[1];
  int32_t none = 0;
  int32_t* const left = kind_of(command.form, 0) == Kind_V ? &h[a] : &none;
  const int32_t right = kind_of(command.form, 1) == Kind_V ? h[b] : b; /* or a constant, or a bit */
  const uint32_t count = (uint32_t)right & 31;
  uint32_t next = t->pc + command.words;
  bool jumps = false;

  switch (command.opcode) {
    case Op_Nop: break;
    case Op_End: stop_task(vm, t->task); return false;
    case Op_Ret:
      if (t->depth == 0)
        end(vm, t);
      else
        t->pc = t->calls[--t->depth];
      return false;
    case Op_Call: return call(vm, number, &command, (uint32_t)a);
    case Op_Jmp: next = (uint32_t)a; break;
    case Op_JmpEqHH:
    case Op_JmpEqHK: jumps = *left == right; break;
    case Op_JmpNeHH:
    case Op_JmpNeHK: jumps = *left != right; break;
    case Op_JmpLtHH:
    case Op_JmpLtHK: jumps = *left < right; break;
    case Op_JmpLeHH:
    case Op_JmpLeHK: jumps = *left <= right; break;
    case Op_JmpGtHH:
    case Op_JmpGtHK: jumps = *left > right; break;
    case Op_JmpGeHH:
    case Op_JmpGeHK: jumps = *left >= right; break;

    case Op_SetHH:
    case Op_SetHK: *left = right; break;
    case Op_SetiStore:
      if ((uint32_t)*left >= vm->program->unit->variables) goto no_variable;
      h[*left] = right;
      break;
    case Op_SetiLoad:
      if ((uint32_t)right >= vm->program->unit->variables) goto no_variable;
      *left = h[right];
      break;
    case Op_Copy: memmove(left, &h[b], sizeof(int32_t) * (uint32_t)command.operands[2]); break;

    case Op_AddHH:
    case Op_AddHK: *left = (int32_t)((uint32_t)*left + (uint32_t)right); break;
    case Op_SubHH:
    case Op_SubHK: *left = (int32_t)((uint32_t)*left - (uint32_t)right); break;
    case Op_MulHH:
    case Op_MulHK: *left = (int32_t)((uint32_t)*left * (uint32_t)right); break;
    case Op_DivHH:
    case Op_DivHK:
    case Op_ModHH:
    case Op_ModHK: {
      const bool remainder = command.opcode == Op_ModHH || command.opcode == Op_ModHK;
      if (right == 0) return raise_fault(vm, number, kFaultIllop, TEXT("division by zero"));
      if (right == -1) /* also of the least number, where C has no quotient */
        *left = remainder ? 0 : (int32_t)(0 - (uint32_t)*left);
      else
        *left = remainder ? *left % right : *left / right;
      break;
    }
    case Op_AndHH:
    case Op_AndHK: *left &= right; break;
    case Op_OrHH:
    case Op_OrHK: *left |= right; break;
    case Op_XorHH:
    case Op_XorHK: *left ^= right; break;
    case Op_ShlHH:
    case Op_ShlHK: *left = (int32_t)((uint32_t)*left << count); break;
    case Op_ShrHH:
    case Op_ShrHK: *left = (int32_t)((uint32_t)*left >> count); break;
    case Op_AshrHH:
    case Op_AshrHK: *left = (int32_t)(*left < 0 ? ~(~(uint32_t)*left >> count) : (uint32_t)*left >> count); break;
    case Op_NotH: *left = ~right; break;

    case Op_BitSet: *left = with_bit(*left, b, true); break;
    case Op_BitClear: *left = with_bit(*left, b, false); break;
    case Op_BitMove:
    case Op_BitMoveNeg: {
      const bool source = ((uint32_t)h[command.operands[2]] >> command.operands[3] & 1) != 0;
      *left = with_bit(*left, b, source == (command.opcode == Op_BitMove));
      break;
    }

    case Op_WaitH:
    case Op_WaitK: {
      const int32_t ms = command.opcode == Op_WaitH ? *left : a;
      if (ms <= 0) break; /* nothing to wait for (ours) */
      t->wait_ms = (uint32_t)ms;
      t->state = IPOS_TASK_WAITING;
      return false;
    }
    case Op_Task2:
    case Op_Task: {
      const unsigned other = command.opcode == Op_Task2 ? 2 : 3;
      if (a == 0)
        stop_task(vm, other);
      else
        start_task(vm, other, (uint32_t)b);
      if (t->state == IPOS_TASK_STOPPED || (a != 0 && other == number + 1)) return false; /* its own end or restart */
      break;
    }
    case Op_SetInt:
      if (set_interrupt(vm, number, a, (uint32_t)b)) return true;
      break;
    case Op_VarInt:
      if (set_variable_interrupt(vm, number, (uint32_t)a, (uint32_t)b)) return true;
      break;
    default: return execute_by_host(vm, number, &command);
  }
  t->pc = jumps ? (uint32_t)command.operands[2] : next;
  return false;

no_variable:
  return raise_fault(vm, number, kFaultIllop, TEXT("the unit has no variable with this number"));
}
