/* Variables, tasks and faults of a machine, for the host. */
#include "embed/core/state.h"

ipos_status ipos_read(const ipos_vm* vm, uint32_t variable, int32_t* value) {
  if (vm == NULL || value == NULL) return IPOS_INVALID_ARGUMENT;
  if (variable >= vm->program->unit->variables) return IPOS_NO_VARIABLE;
  *value = vm->h[variable];
  return IPOS_OK;
}

ipos_status ipos_write(ipos_vm* vm, uint32_t variable, int32_t value) {
  if (vm == NULL) return IPOS_INVALID_ARGUMENT;
  if (variable >= vm->program->unit->variables) return IPOS_NO_VARIABLE;
  vm->h[variable] = value;
  return IPOS_OK;
}

ipos_status ipos_read_symbol(const ipos_vm* vm, const char* name, int32_t* value) {
  ipos_symbol symbol;
  const ipos_status status = ipos_find(ipos_program_of(vm), name, &symbol);
  return status == IPOS_OK ? ipos_read(vm, symbol.variable, value) : status;
}

ipos_status ipos_write_symbol(ipos_vm* vm, const char* name, int32_t value) {
  ipos_symbol symbol;
  const ipos_status status = ipos_find(ipos_program_of(vm), name, &symbol);
  return status == IPOS_OK ? ipos_write(vm, symbol.variable, value) : status;
}

int32_t* ipos_variables(ipos_vm* vm) { return vm != NULL ? vm->h : NULL; }

ipos_status ipos_task_of(const ipos_vm* vm, uint8_t context, ipos_task* task) {
  if (vm == NULL || task == NULL || context < 1 || context > kContexts) return IPOS_INVALID_ARGUMENT;
  const ipos_context* const t = &vm->contexts[context - 1];
  task->state = t->state;
  task->address = t->pc;
  task->wait_ms = t->wait_ms;
  task->depth = t->depth;
  task->commands = t->commands;
  return IPOS_OK;
}

ipos_status ipos_start_task(ipos_vm* vm, uint8_t task, uint32_t address) {
  if (vm == NULL || task < 1 || task > vm->program->unit->tasks) return IPOS_INVALID_ARGUMENT;
  instruction command;
  uint32_t at = 0;
  while (at < address && decode(vm->program->code, vm->program->words, at, &command) == Decode_Ok) at += command.words;
  if (at != address || at >= vm->program->words) return IPOS_INVALID_ARGUMENT;
  const bool before = vm->busy;
  vm->busy = true;
  start_task(vm, task, address);
  vm->busy = before;
  return IPOS_OK;
}

ipos_status ipos_stop_task(ipos_vm* vm, uint8_t task) {
  if (vm == NULL || task < 1 || task > kTasks) return IPOS_INVALID_ARGUMENT;
  const bool before = vm->busy;
  vm->busy = true;
  stop_task(vm, task);
  vm->busy = before;
  return IPOS_OK;
}

ipos_status ipos_resume(ipos_vm* vm, uint8_t context) {
  if (vm == NULL || context < 1 || context > kContexts) return IPOS_INVALID_ARGUMENT;
  ipos_context* const t = &vm->contexts[context - 1];
  if (!waits_for_host(t)) return IPOS_NOT_TAKEN;
  go_on(vm, t);
  return IPOS_OK;
}

ipos_status ipos_fault_of(const ipos_vm* vm, ipos_fault* fault) {
  if (vm == NULL || fault == NULL) return IPOS_INVALID_ARGUMENT;
  *fault = vm->fault;
  return IPOS_OK;
}

ipos_status ipos_raise_fault(ipos_vm* vm, uint8_t number, const char* reason) {
  if (vm == NULL || number == 0 || reason == NULL) return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  if (vm->fault.number != 0) return IPOS_OK;
  vm->busy = true;
  unsigned task = 1; /* the first that runs */
  for (unsigned other = kTasks; other > 0; --other)
    if (vm->contexts[other - 1].state != IPOS_TASK_STOPPED) task = other;
  raise_fault(vm, vm->active[task - 1], number, reason);
  tell_fault(vm);
  vm->busy = false;
  return IPOS_OK;
}

/* ---- The build, and its texts ---- */

uint32_t ipos_version(void) { return IPOS_VERSION; }

uint32_t ipos_features(void) {
  return (IPOS_FAST ? IPOS_FEATURE_FAST : 0) | (IPOS_TELEGRAMS ? IPOS_FEATURE_TELEGRAMS : 0) |
         (IPOS_INTERRUPTS ? IPOS_FEATURE_INTERRUPTS : 0) | (IPOS_STATES ? IPOS_FEATURE_STATES : 0) |
         (IPOS_TEXTS ? IPOS_FEATURE_TEXTS : 0);
}

uint32_t ipos_most_variables(void) { return IPOS_VARIABLES; }
uint32_t ipos_most_words(void) { return IPOS_PROGRAM_WORDS; }

const char* ipos_status_text(ipos_status status) {
  switch (status) {
#define STATUS_TEXT(name, number, text) \
  case name: return TEXT(text);
    IPOS_STATUSES(STATUS_TEXT)
  }
  return "";
}

const char* ipos_rule_text(uint8_t rule) {
  switch (rule) {
#define RULE_TEXT(code, name, meaning) \
  case code: return TEXT(meaning);
    IPOS_RULES(RULE_TEXT)
  }
  return "";
}
