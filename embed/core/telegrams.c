/* The variable telegrams of the SBus (1053 1610 p. 51 to 61), as runtime/scom/object_table.cpp has them for the simulated
 * units. The order of checks decides which of several reasons a program sees. */
#include "embed/core/state.h"

enum { kStandardIds = 2048, kSbusAddresses = 64, kAcyclicTags = 0x10000, kDefaultBaud = 500000, kMaxBaud = 1000000 };

#if IPOS_TELEGRAMS

enum { Object_Cyclic = 1, Object_Acyclic = 2, Object_Receive = 3 };           /* the keyword set `scom` */
enum { Acyclic_Sending = 1, Acyclic_Sent = 2, Acyclic_Failed = 3 };           /* status of SCTRACYCL, p. 56 */
enum { Cyclic_WrongTime = -1, Cyclic_TooMany = -2, Cyclic_Overload = -3 };    /* result of SCTRCYCL, p. 54 */
enum { Offset_Any, Offset_OffsetBelowCycle, Offset_SumWithin };               /* which offsets a class permits */
enum { Known_Always, Known_Synchronous, Known_Channel2 };                     /* who knows a telegram of MOVILINK */

static const struct {
  uint8_t family, objects, rule;
  uint16_t shortest, longest, step, longest_offset, offset_step;
} kObjectClasses[] = {
#define OBJECTS_ROW(family, shortest, longest, step, objects, longest_offset, offset_step, rule) \
  {Family_##family, objects, Offset_##rule, shortest, longest, step, longest_offset, offset_step},
    IPOS_OBJECTS(OBJECTS_ROW)};

static const struct {
  uint8_t function, parameter, grouped, known;
} kMovilink[] = {
#define TELEGRAM_ROW(function, parameter, grouped, known) {function, parameter, grouped, Known_##known},
    IPOS_MOVILINK(TELEGRAM_ROW)};

/* One of the unit's own MOVILINK telegrams has this identifier (1053 1610 p. 51). */
static bool is_movilink(const ipos_vm* vm, uint32_t id) {
  if (id >= 2 * 8 * kSbusAddresses) return false;
  for (unsigned n = 0; n < sizeof kMovilink / sizeof *kMovilink; ++n) {
    if (kMovilink[n].function != id % 8 || kMovilink[n].parameter != id / (8 * kSbusAddresses)) continue;
    if (kMovilink[n].known == Known_Channel2) return false; /* the channel is off */
    if (kMovilink[n].known == Known_Synchronous && (vm->program->unit->traits & Trait_SynchronousSbus) == 0) return false;
    return id / 8 % kSbusAddresses == (kMovilink[n].grouped ? vm->group : vm->address);
  }
  return false;
}

/* 0..8, and 100h..108h for INTEL; in `length` and `intel`. */
static bool read_format(int32_t word, receive_object* object) {
  object->intel = word >= 0x100;
  object->length = (uint8_t)(word & 0xFF);
  return (word & ~0x10F) == 0 && object->length <= 8;
}

static unsigned variables_of(unsigned length) { return length == 0 ? 0 : length <= 4 ? 1 : 2; }

/* The low bytes of the 64-bit value of two variables, highest first or lowest first. */
static unsigned place_of(unsigned byte, unsigned length, unsigned intel) { return (intel ? byte : length - 1 - byte) & 7; }

static ipos_sending send_object(ipos_vm* vm, const receive_object* object, uint32_t tag) {
  ipos_frame frame;
  memset(&frame, 0, sizeof frame);
  frame.id = object->id;
  frame.length = object->length;
  for (unsigned n = 0; n < object->length; ++n)
    frame.data[place_of(n, object->length, object->intel)] =
        (uint8_t)((uint32_t)vm->h[object->data + n / 4] >> (8 * (n % 4)));
  return vm->host.send(vm->host.user, vm, &frame, tag);
}

static bool sends(const ipos_vm* vm, int32_t id) {
  for (unsigned n = 0; n < vm->objects.cyclic_count; ++n)
    if (vm->objects.cyclic[n].id == id) return true;
  return false;
}

static bool receives(const ipos_vm* vm, int32_t id) {
  for (unsigned n = 0; n < vm->objects.receive_count; ++n)
    if (vm->objects.receive[n].id == id) return true;
  return false;
}

/* A load in millionths of a bit per second, with the worst case of stuff bits: 55 + 10 n bits. In two steps of 32 bits. */
static uint64_t load_of(unsigned length, uint32_t cycle) {
  const uint64_t bits = (uint64_t)(55 + 10 * length) * 1000000000;
  const uint32_t high = (uint32_t)(bits >> 16);
  return ((uint64_t)(high / cycle) << 16) + ((high % cycle) << 16 | (uint32_t)(bits & 0xFFFF)) / cycle;
}

/* The whole percent still free of 70 % of the bus (docs/reference/stdlib.md). */
static int32_t free_capacity(const ipos_vm* vm, unsigned length, uint32_t cycle) {
  uint64_t used = load_of(length, cycle);
  const uint32_t budget = vm->baud * 70 / 100;         /* bit/s */
  const uint64_t percent = (uint64_t)budget * 10000;   /* in millionths */
  for (unsigned n = 0; n < vm->objects.cyclic_count; ++n)
    used += load_of(vm->objects.cyclic[n].length, vm->objects.cyclic[n].cycle);
  int32_t free = 100;
  uint64_t limit = 0;
  for (; limit < used; limit += percent)
    if (--free < 0) return Cyclic_Overload;
  return free;
}

static bool class_has(unsigned n, int32_t cycle) {
  return cycle >= kObjectClasses[n].shortest && cycle <= kObjectClasses[n].longest && cycle % kObjectClasses[n].step == 0;
}

static int32_t define_cyclic(ipos_vm* vm, const receive_object* object, int32_t cycle, int32_t offset) {
  telegram_objects* const objects = &vm->objects;
  unsigned n = 0;
  while (kObjectClasses[n].family != vm->program->unit->family || !class_has(n, cycle))
    if (++n == sizeof kObjectClasses / sizeof *kObjectClasses) return Cyclic_WrongTime;
  if (offset < 0 || offset > kObjectClasses[n].longest_offset || offset % kObjectClasses[n].offset_step != 0 ||
      (kObjectClasses[n].rule == Offset_OffsetBelowCycle && offset >= cycle) ||
      (kObjectClasses[n].rule == Offset_SumWithin && offset + cycle > kObjectClasses[n].longest))
    return Cyclic_WrongTime;
  if (sends(vm, object->id) || receives(vm, object->id)) return Cyclic_WrongTime;
  unsigned of_class = 0;
  for (unsigned other = 0; other < objects->cyclic_count; ++other) of_class += class_has(n, objects->cyclic[other].cycle);
  if (of_class >= kObjectClasses[n].objects) return Cyclic_TooMany;
  const int32_t result = free_capacity(vm, object->length, (uint32_t)cycle);
  if (result != Cyclic_Overload) {
    cyclic_object* const added = &objects->cyclic[objects->cyclic_count++];
    added->id = object->id;
    added->data = object->data;
    added->length = object->length;
    added->intel = object->intel;
    added->cycle = (uint16_t)cycle;
    added->offset = (uint16_t)offset;
  }
  return result;
}

static void define_receive(ipos_vm* vm, const receive_object* object) {
  telegram_objects* const objects = &vm->objects;
  if (objects->closed || receives(vm, object->id) || sends(vm, object->id) ||
      objects->receive_count >= vm->program->unit->receive_objects)
    return;
  objects->receive[objects->receive_count++] = *object;
}

/* The status of the acyclic object with this tag; others are left alone. */
static void note_acyclic(ipos_vm* vm, uint32_t tag, int32_t status) {
  if (tag >= kAcyclicTags && tag - kAcyclicTags + 3 < vm->program->unit->variables) vm->h[tag - kAcyclicTags + 3] = status;
}

static void send_acyclic(ipos_vm* vm, const receive_object* object, uint32_t variable) {
  const uint32_t tag = kAcyclicTags + variable;
  note_acyclic(vm, tag, Acyclic_Sending);
  const ipos_sending sending = send_object(vm, object, tag);
  if (sending != IPOS_SENDING_QUEUED)
    note_acyclic(vm, tag, sending == IPOS_SENDING_DONE ? Acyclic_Sent : Acyclic_Failed);
}

/* SCOM with the structure at `variable`; false: its pointer leads to no variables. */
static bool define_object(ipos_vm* vm, int32_t kind, uint32_t variable) {
  const unit_type* const unit = vm->program->unit;
  int32_t* const element = &vm->h[variable];
  const int32_t* const rest = element + (kind == Object_Cyclic ? 3 : 1); /* length and pointer */
  const int32_t id = element[0];
  receive_object object;
  const bool has_format = read_format(rest[0], &object);
  if (has_format && (rest[1] < 0 || (uint32_t)rest[1] + variables_of(object.length) > unit->variables)) return false;
  object.id = (uint16_t)id;
  object.data = (uint16_t)rest[1];
  const bool permitted = has_format && id >= 0 && id < kStandardIds && !is_movilink(vm, (uint32_t)id);
  /* No manual prints results for what is not permitted; ours are those of a refused object. */
  switch (kind) {
    case Object_Cyclic:
      element[5] = permitted ? define_cyclic(vm, &object, element[1], element[2]) : Cyclic_WrongTime;
      break;
    case Object_Acyclic:
      if (permitted)
        send_acyclic(vm, &object, variable);
      else
        element[3] = Acyclic_Failed;
      break;
    default:
      if (permitted) define_receive(vm, &object);
  }
  return true;
}

static void start_objects(ipos_vm* vm) {
  telegram_objects* const objects = &vm->objects;
  if (objects->started) return;
  objects->started = objects->closed = 1;
  objects->start_tick = (int64_t)vm->ticks;
}

/* elapsed % cycle in steps of 32 bits. */
static uint32_t remainder_of(uint64_t elapsed, uint32_t cycle) {
  const uint32_t high = (uint32_t)(elapsed >> 32);
  const uint32_t low = (uint32_t)elapsed % cycle;
  if (high == 0) return low;
  return ((high % cycle) * ((0 - cycle) % cycle) % cycle + low) % cycle; /* 2^32 % cycle; a cycle has 16 bits */
}

static void send_due(ipos_vm* vm) {
  for (unsigned n = 0; vm->objects.started && n < vm->objects.cyclic_count; ++n) {
    const cyclic_object* const object = &vm->objects.cyclic[n];
    const int64_t elapsed = (int64_t)vm->ticks - vm->objects.start_tick - object->offset;
    if (elapsed < 0 || remainder_of((uint64_t)elapsed, object->cycle) != 0) continue;
    const receive_object frame = {object->id, object->data, object->length, object->intel};
    send_object(vm, &frame, n); /* a failed one comes again with its next cycle */
  }
}

static void forget_objects(ipos_vm* vm) { memset(&vm->objects, 0, sizeof vm->objects); }

static void set_bus(ipos_vm* vm, uint32_t baud, uint8_t address, uint8_t group) {
  vm->baud = baud;
  vm->address = address;
  vm->group = group;
  forget_objects(vm);
}

ipos_status ipos_set_sbus(ipos_vm* vm, uint32_t baud, uint8_t address, uint8_t group, uint16_t sync_id) {
  if (vm == NULL || baud == 0 || baud > kMaxBaud || address >= kSbusAddresses || group >= kSbusAddresses ||
      sync_id >= kStandardIds)
    return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  set_bus(vm, baud, address, group);
  return IPOS_OK;
}

ipos_status ipos_receive(ipos_vm* vm, const ipos_frame* frame) {
  if (vm == NULL || frame == NULL || frame->length > 8 || frame->id >= kStandardIds) return IPOS_INVALID_ARGUMENT;
  for (unsigned n = 0; vm->objects.started && n < vm->objects.receive_count; ++n) {
    const receive_object* const object = &vm->objects.receive[n];
    if (object->id != frame->id) continue;
    if (object->length != frame->length) break;
    uint32_t values[2] = {0, 0};
    for (unsigned byte = 0; byte < frame->length; ++byte)
      values[byte / 4] |= (uint32_t)frame->data[place_of(byte, frame->length, object->intel)] << (8 * (byte % 4));
    for (unsigned k = 0; k < variables_of(frame->length); ++k) vm->h[object->data + k] = (int32_t)values[k];
    /* MOVIDRIVE B notes the object in H522 (IPOSplus p. 232). */
    if (IPOS_VARIABLES > IPOS_RECEIVE_FLAGS && (vm->program->unit->traits & Trait_NewVariables) != 0) {
      int32_t* const flags = &vm->h[IPOS_RECEIVE_FLAGS];
      *flags = (int32_t)((uint32_t)*flags | (uint32_t)1 << n);
    }
    return IPOS_OK;
  }
  return IPOS_NOT_TAKEN;
}

ipos_status ipos_sent(ipos_vm* vm, uint32_t tag, bool sent) {
  if (vm == NULL) return IPOS_INVALID_ARGUMENT;
  note_acyclic(vm, tag, sent ? Acyclic_Sent : Acyclic_Failed);
  return IPOS_OK;
}

#else

static void send_due(ipos_vm* vm) { (void)vm; }
static void forget_objects(ipos_vm* vm) { (void)vm; }
static void set_bus(ipos_vm* vm, uint32_t baud, uint8_t address, uint8_t group) {
  (void)vm, (void)baud, (void)address, (void)group;
}
ipos_status ipos_set_sbus(ipos_vm* vm, uint32_t baud, uint8_t address, uint8_t group, uint16_t sync_id) {
  (void)baud, (void)address, (void)group, (void)sync_id;
  return vm == NULL ? IPOS_INVALID_ARGUMENT : IPOS_NOT_BUILT_IN;
}
ipos_status ipos_receive(ipos_vm* vm, const ipos_frame* frame) {
  return vm == NULL || frame == NULL ? IPOS_INVALID_ARGUMENT : IPOS_NOT_BUILT_IN;
}
ipos_status ipos_sent(ipos_vm* vm, uint32_t tag, bool sent) {
  (void)tag, (void)sent;
  return vm == NULL ? IPOS_INVALID_ARGUMENT : IPOS_NOT_BUILT_IN;
}

#endif
