/* Machines, and how they run: a millisecond, a command, what is due by the host's clock. */
#include "embed/core/state.h"

enum { kTickUs = 1000 };

/* Executes at most `budget` commands of a task, its interrupt routines first. Returns how many. */
static uint32_t run_task(ipos_vm* vm, unsigned task, uint32_t budget) {
  uint32_t used = 0;
  for (;;) {
    const unsigned number = vm->active[task - 1];
    ipos_context* const t = &vm->contexts[number];
    if (t->state != IPOS_TASK_READY) return used;
#if IPOS_FAST
    if (vm->fast != NULL) used = budget - ipos_fast_run(vm->fast, t, vm->h, budget - used);
#endif
    if (used == budget) return used;
    ++used;
    ++t->commands;
    if (execute(vm, number)) return used;
  }
}

/* With a trace: command by command, each announced. */
static uint32_t run_announced(ipos_vm* vm, unsigned task, uint32_t budget) {
  if (vm->host.trace == NULL) return run_task(vm, task, budget);
  uint32_t used = 0;
  while (used < budget) {
    const unsigned number = vm->active[task - 1];
    const ipos_context* const t = &vm->contexts[number];
    if (t->state != IPOS_TASK_READY) break;
    const ipos_step step = {vm->ticks, t->pc, vm->program->code[t->pc], (uint8_t)(number + 1)};
    vm->host.trace(vm->host.user, vm, &step);
    const uint32_t executed = run_task(vm, task, 1);
    used += executed;
    if (executed == 0 || vm->fault.number != 0) break;
  }
  return used;
}

static uint64_t run_tick(ipos_vm* vm) {
  uint64_t executed = 0;
  for (unsigned n = 0; n < kContexts; ++n) {
    ipos_context* const t = &vm->contexts[n];
    if (t->state == IPOS_TASK_WAITING && t->wait_ms != 0 && --t->wait_ms == 0) go_on(vm, t);
  }
  take_interrupts(vm);
  for (unsigned task = 1; task <= kTasks; ++task) executed += run_announced(vm, task, vm->rates[task - 1]);
  if (vm->fault.number == 0) send_due(vm);
  ++vm->ticks;
  return executed;
}

static bool any_task_runs(const ipos_vm* vm) {
  for (unsigned n = 0; n < kTasks; ++n)
    if (vm->contexts[n].state != IPOS_TASK_STOPPED) return true;
  return false;
}

size_t ipos_vm_size(void) { return sizeof(ipos_vm); }

ipos_status ipos_init(void* memory, size_t size, const ipos_program* program, const ipos_host* host, ipos_vm** out) {
  if (program == NULL || out == NULL) return IPOS_INVALID_ARGUMENT;
  const ipos_status status = check_memory(memory, size, sizeof(ipos_vm), 8);
  if (status != IPOS_OK) return status;
  ipos_vm* const vm = memory;
  memset(vm, 0, sizeof *vm);
  vm->program = program;
  vm->fast = program->fast;
  vm->fault.reason = "";
  if (host != NULL) vm->host = *host;
  for (unsigned n = 0; n < kTasks; ++n) vm->active[n] = (uint8_t)n;
  vm->rates[0] = 1; /* P938 + 1, P939 + 2; 20 is ours, the manual says 20 to 40 */
  vm->rates[1] = 2;
  vm->rates[2] = 20;
  set_bus(vm, kDefaultBaud, 0, 0);
  *out = vm;
  return IPOS_OK;
}

const ipos_program* ipos_program_of(const ipos_vm* vm) { return vm != NULL ? vm->program : NULL; }

static ipos_status start(ipos_vm* vm) {
  stop_task(vm, 0);
  memset(&vm->fault, 0, sizeof vm->fault);
  vm->fault.reason = "";
  memset(vm->contexts, 0, sizeof vm->contexts);
  forget_interrupts(vm);
  start_task(vm, 1, 0);
  forget_objects(vm);
  vm->fault_told = false;
  vm->due_known = false;
  return IPOS_OK;
}

static ipos_status stop(ipos_vm* vm) {
  stop_task(vm, 0);
  forget_objects(vm);
  return IPOS_OK;
}

ipos_status ipos_start(ipos_vm* vm) { return in_callbacks(vm, start); }
ipos_status ipos_stop(ipos_vm* vm) { return in_callbacks(vm, stop); }

ipos_status ipos_set_rates(ipos_vm* vm, const uint32_t commands[3]) {
  if (vm == NULL || commands == NULL) return IPOS_INVALID_ARGUMENT;
  memcpy(vm->rates, commands, sizeof vm->rates);
  return IPOS_OK;
}

/* Whether a run can begin: it is busy then. */
static ipos_status begin_run(ipos_vm* vm) {
  if (vm->busy) return IPOS_BUSY;
  if (vm->fault.number != 0) return IPOS_FAULTED;
  vm->busy = true;
  return IPOS_OK;
}

ipos_status ipos_run_ticks(ipos_vm* vm, uint32_t ticks, ipos_progress* progress) {
  ipos_progress ours;
  if (progress == NULL) progress = &ours;
  memset(progress, 0, sizeof *progress);
  if (vm == NULL) return IPOS_INVALID_ARGUMENT;
  const ipos_status status = begin_run(vm);
  if (status != IPOS_OK) return status;
  while (progress->ticks < ticks && vm->fault.number == 0) {
    progress->commands += run_tick(vm);
    ++progress->ticks;
    tell_fault(vm);
  }
  vm->busy = false;
  return vm->fault.number != 0 ? IPOS_FAULTED : any_task_runs(vm) ? IPOS_OK : IPOS_ENDED;
}

ipos_status ipos_run_commands(ipos_vm* vm, uint8_t task, uint32_t commands, uint32_t* executed) {
  uint32_t ours;
  if (executed == NULL) executed = &ours;
  *executed = 0;
  if (vm == NULL || task < 1 || task > kTasks) return IPOS_INVALID_ARGUMENT;
  const ipos_status status = begin_run(vm);
  if (status != IPOS_OK) return status;
  *executed = run_announced(vm, task, commands);
  tell_fault(vm);
  vm->busy = false;
  if (vm->fault.number != 0) return IPOS_FAULTED;
  return vm->contexts[task - 1].state == IPOS_TASK_STOPPED ? IPOS_ENDED : IPOS_OK;
}

ipos_status ipos_run_due(ipos_vm* vm, uint32_t most, ipos_progress* progress) {
  ipos_progress ours;
  if (progress == NULL) progress = &ours;
  memset(progress, 0, sizeof *progress);
  if (vm == NULL) return IPOS_INVALID_ARGUMENT;
  if (vm->host.time_us == NULL) return IPOS_NO_CALLBACK;
  if (vm->busy) return IPOS_BUSY;
  vm->busy = true;
  const uint64_t now = vm->host.time_us(vm->host.user);
  vm->busy = false;
  if (!vm->due_known) vm->due_us = now;
  vm->due_known = true;
  uint32_t due = 0; /* counted, as 64-bit division weighs more than the loop takes */
  for (uint64_t at = vm->due_us; due < most && now >= at && now - at >= kTickUs; at += kTickUs) ++due;
  const ipos_status status = ipos_run_ticks(vm, due, progress);
  vm->due_us += (uint64_t)progress->ticks * kTickUs;
  return status;
}

uint64_t ipos_ticks(const ipos_vm* vm) { return vm != NULL ? vm->ticks : 0; }
