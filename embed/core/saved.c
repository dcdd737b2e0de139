/* The whole state as bytes, the same on every platform, little endian without gaps:
 *   u32 "IPS1", u32 checksum of the image, u64 ticks, contexts, interrupts, fault, variables, telegrams, u32 CRC-32 of all
 * What the simulation saves of a machine (vm/exec/saved_state.cpp) has the same layout. */
#include "embed/core/state.h"

#if IPOS_STATES

enum { kStateMagic = 0x31535049 }; /* "IPS1" */

/* Goes through a state in one of three ways. */
typedef struct {
  uint8_t* at; /* null: only counted */
  size_t size;
  bool reads;
} cursor;

static void pass(cursor* c, void* field, size_t size) {
  if (c->at != NULL) {
    if (c->reads)
      memcpy(field, c->at, size);
    else
      memcpy(c->at, field, size);
    c->at += size;
  }
  c->size += size;
}

static void pass_context(cursor* c, ipos_context* t) {
  pass(c, t, 12); /* state, depth, task, rank, pc, wait_ms */
  pass(c, &t->commands, 8);
  pass(c, t->calls, sizeof t->calls);
}

static void pass_interrupts(cursor* c, all_interrupts* interrupts) {
  for (unsigned n = 0; n < kEvents; ++n) {
    pass(c, &interrupts->events[n], 2); /* installed, pending */
    pass(c, &interrupts->events[n].address, 4);
  }
  for (unsigned n = 0; n < kVariableInterrupts; ++n) {
    variable_interrupt* const watch = &interrupts->watches[n];
    pass(c, watch, 5); /* installed, held, mode, task, priority */
    pass(c, (uint8_t*)watch + offsetof(variable_interrupt, source), 4);   /* and structure */
    pass(c, (uint8_t*)watch + offsetof(variable_interrupt, compare), 12); /* and last, address */
  }
  pass(c, &interrupts->turn, 1);
}

static void pass_fault(cursor* c, ipos_fault* fault) {
  pass(c, fault, 3); /* number, task, context */
  pass(c, &fault->address, 4);
}

static void pass_objects(cursor* c, telegram_objects* objects) {
  for (unsigned n = 0; n < IPOS_MOST_CYCLIC; ++n) pass(c, &objects->cyclic[n], 10);
  for (unsigned n = 0; n < kMostReceive; ++n) pass(c, &objects->receive[n], 6);
  pass(c, (uint8_t*)objects + offsetof(telegram_objects, cyclic_count), 4); /* receive_count, started, closed */
  pass(c, &objects->start_tick, 8);
}

static void pass_state(cursor* c, ipos_vm* vm, uint32_t head[2]) {
  pass(c, head, 8);
  pass(c, &vm->ticks, 8);
  for (unsigned n = 0; n < kContexts; ++n) pass_context(c, &vm->contexts[n]);
  pass_interrupts(c, &vm->interrupts);
  pass_fault(c, &vm->fault);
  pass(c, vm->h, 4 * (size_t)vm->program->unit->variables);
  pass_objects(c, &vm->objects);
}

/* ---- Checks: execution depends on no more than this ---- */

static bool context_is_sound(const ipos_program* program, const command_starts* starts, const ipos_context* t,
                             unsigned number) {
  if (t->state > IPOS_TASK_WAITING || t->depth > program->unit->call_depth || t->depth > kMaxCallDepth ||
      t->task > kTasks || t->rank > kMaxPriority)
    return false;
  for (unsigned n = 0; n < t->depth; ++n)
    if (!is_start(starts, program->words, t->calls[n])) return false;
  if (number < kTasks && (t->rank != 0 || (t->task != 0 && t->task != number + 1))) return false;
  if (t->state == IPOS_TASK_STOPPED) return true;
  if (t->task == 0 || t->commands > UINT64_MAX / 2 || !is_start(starts, program->words, t->pc)) return false;
  if (t->state == IPOS_TASK_READY) return true;
  /* Only a command that waits has one after it to go on with. */
  const uint32_t opcode = program->code[t->pc] & 0xFF;
  const bool waits_for_time = opcode == Op_WaitH || opcode == Op_WaitK;
  const uint8_t flow = kFlows[opcode];
  return t->wait_ms != 0 ? waits_for_time : !waits_for_time && (flow == Flow_System || flow == Flow_SystemCall);
}

static bool interrupts_are_sound(const ipos_program* program, const command_starts* starts, const all_interrupts* interrupts) {
  const uint32_t variables = program->unit->variables;
  for (unsigned n = 0; n < kEvents; ++n) {
    const event_interrupt* const row = &interrupts->events[n];
    if (row->installed > 1 || row->pending > 1) return false;
    if (row->installed ? !is_start(starts, program->words, row->address) : row->pending) return false;
  }
  for (unsigned n = 0; n < kVariableInterrupts; ++n) {
    const variable_interrupt* const row = &interrupts->watches[n];
    if (row->installed > 1 || row->held > 1) return false;
    if (row->installed && (!is_start(starts, program->words, row->address) || row->mode >= kModes || row->task < 2 ||
                           row->task > kTasks || row->priority > kMaxPriority || row->source >= variables ||
                           row->structure + 7U > variables))
      return false;
  }
  return true;
}

static bool telegram_is_sound(const ipos_vm* vm, uint32_t id, uint32_t data, unsigned length, unsigned intel) {
  return id < kStandardIds && length <= 8 && intel <= 1 && data + variables_of(length) <= vm->program->unit->variables;
}

/* Of all classes of the unit together. */
static unsigned most_cyclic(const ipos_vm* vm) {
  unsigned most = 0;
  for (unsigned n = 0; n < sizeof kObjectClasses / sizeof *kObjectClasses; ++n)
    if (kObjectClasses[n].family == vm->program->unit->family) most += kObjectClasses[n].objects;
  return most;
}

/* Ticks are counted on without ever overflowing. */
static bool is_time(uint64_t tick) { return tick < (uint64_t)1 << 62; }

static bool objects_are_sound(const ipos_vm* vm, const telegram_objects* objects) {
  if (objects->started > 1 || objects->closed > 1 || (objects->started && vm->host.send == NULL) ||
      !is_time((uint64_t)objects->start_tick) || objects->cyclic_count > most_cyclic(vm) ||
      objects->receive_count > vm->program->unit->receive_objects)
    return false;
  for (unsigned n = 0; n < objects->cyclic_count; ++n) {
    const cyclic_object* const object = &objects->cyclic[n];
    if (object->cycle == 0 || !telegram_is_sound(vm, object->id, object->data, object->length, object->intel)) return false;
  }
  for (unsigned n = 0; n < objects->receive_count; ++n) {
    const receive_object* const object = &objects->receive[n];
    if (!telegram_is_sound(vm, object->id, object->data, object->length, object->intel)) return false;
  }
  return true;
}

/* Each part in a place of its own, as nothing of the machine may change yet. */
APART static bool contexts_are_sound(cursor* c, const ipos_program* program, const command_starts* starts) {
  for (unsigned n = 0; n < kContexts; ++n) {
    ipos_context t;
    memset(&t, 0, sizeof t);
    pass_context(c, &t);
    if (!context_is_sound(program, starts, &t, n)) return false;
  }
  all_interrupts interrupts;
  ipos_fault fault;
  memset(&interrupts, 0, sizeof interrupts);
  memset(&fault, 0, sizeof fault);
  pass_interrupts(c, &interrupts);
  pass_fault(c, &fault);
  return interrupts_are_sound(program, starts, &interrupts) && fault.task <= kTasks && fault.context <= kContexts;
}

APART static bool starts_are_met(cursor* c, const ipos_program* program) {
  command_starts starts;
  instruction command;
  memset(&starts, 0, sizeof starts);
  for (uint32_t at = 0; at < program->words; at += command.words) {
    decode(program->code, program->words, at, &command);
    mark_start(&starts, at);
  }
  return contexts_are_sound(c, program, &starts);
}

APART static bool rest_is_sound(cursor* c, const ipos_vm* vm) {
  telegram_objects objects;
  memset(&objects, 0, sizeof objects);
  c->at += 4 * (size_t)vm->program->unit->variables;
  pass_objects(c, &objects);
  return objects_are_sound(vm, &objects);
}

size_t ipos_state_size(const ipos_vm* vm) {
  cursor c = {NULL, 4, false}; /* with the CRC-32 */
  uint32_t head[2] = {0, 0};
  if (vm == NULL) return 0;
  pass_state(&c, (ipos_vm*)vm, head); /* which is only looked at */
  return c.size;
}

ipos_status ipos_save(const ipos_vm* vm, void* bytes, size_t size) {
  if (vm == NULL || bytes == NULL) return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  if (size < ipos_state_size(vm)) return IPOS_MEMORY_TOO_SMALL;
  cursor c = {bytes, 0, false};
  uint32_t head[2] = {kStateMagic, vm->program->checksum};
  pass_state(&c, (ipos_vm*)vm, head);
  uint32_t checksum = crc32(bytes, c.size);
  pass(&c, &checksum, 4);
  return IPOS_OK;
}

ipos_status ipos_restore(ipos_vm* vm, const void* bytes, size_t size) {
  if (vm == NULL || bytes == NULL) return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  if (size != ipos_state_size(vm)) return IPOS_BAD_STATE;
  uint32_t head[2] = {0, 0};
  uint64_t ticks = 0;
  cursor c = {(uint8_t*)bytes, 0, true}; /* it reads */
  pass(&c, head, 8);
  pass(&c, &ticks, 8);
  if (head[0] != kStateMagic || u32_at((const uint8_t*)bytes + size - 4) != crc32(bytes, size - 4)) return IPOS_BAD_STATE;
  if (head[1] != vm->program->checksum) return IPOS_OTHER_PROGRAM;
  if (!is_time(ticks) || !starts_are_met(&c, vm->program) || !rest_is_sound(&c, vm)) return IPOS_BAD_STATE;
  c.at = (uint8_t*)bytes;
  pass_state(&c, vm, head);
  vm->fault.reason = "";
  vm->fault_told = vm->fault.number != 0;
  vm->due_known = false;
  for (unsigned task = 1; task <= kTasks; ++task) choose_active(vm, task);
  return IPOS_OK;
}

#else

size_t ipos_state_size(const ipos_vm* vm) {
  (void)vm;
  return 0;
}
ipos_status ipos_save(const ipos_vm* vm, void* bytes, size_t size) {
  (void)size;
  return vm == NULL || bytes == NULL ? IPOS_INVALID_ARGUMENT : IPOS_NOT_BUILT_IN;
}
ipos_status ipos_restore(ipos_vm* vm, const void* bytes, size_t size) {
  (void)size;
  return vm == NULL || bytes == NULL ? IPOS_INVALID_ARGUMENT : IPOS_NOT_BUILT_IN;
}

#endif
