/* Interrupts of task 1 (SETINT, IPOSplus p. 45, 342) and variable interrupts (VARINT, p. 347). What the manuals leave open is
 * told in vm/exec/interrupts.cpp, which does the same. */
#include "embed/core/state.h"

enum { kVarIntReq = 530, kAllRequests = (1 << kVariableInterrupts) - 1, kMaxPriority = 10 };

static bool has_requests(const ipos_vm* vm) {
  return IPOS_VARIABLES > kVarIntReq && vm->program->unit->variables > kVarIntReq;
}

#if IPOS_INTERRUPTS

enum { Element_Control, Element_IntNum, Element_SrcVar, Element_CompareVar, Element_Mode, Element_Priority, Element_IntEvent };

enum { /* modes of VARINT */
#define MODE_ROW(value, name) Mode_##name = value,
  IPOS_COMPARE_MODES(MODE_ROW) kModes
};

static bool set_interrupt(ipos_vm* vm, unsigned number, int32_t keyword, uint32_t address) {
  /* By keyword: ERROR, TIMER0, TOUCHP1 after DISABLE. */
  static const uint8_t by_keyword[] = {IPOS_EVENT_ERROR, IPOS_EVENT_TIMER0, IPOS_EVENT_TOUCH_PROBE};
  (void)number;
  if (keyword == 0) {
    memset(vm->interrupts.events, 0, sizeof vm->interrupts.events);
    return false;
  }
  event_interrupt* const interrupt = &vm->interrupts.events[by_keyword[keyword - 1]];
  interrupt->installed = 1;
  interrupt->address = address;
  return false;
}

/* VARINT copies its structure, so that later changes of it do nothing (IPOSplus p. 347). */
static bool set_variable_interrupt(ipos_vm* vm, unsigned number, uint32_t structure, uint32_t address) {
  const int32_t* const element = &vm->h[structure];
  const char* reason = NULL;
  if (element[Element_Control] == 0) {
    memset(vm->interrupts.watches, 0, sizeof vm->interrupts.watches);
    return false;
  }
  if ((uint32_t)element[Element_Control] > 2)
    reason = TEXT("Control of VARINT is none of 0, 1, 2");
  else if ((uint32_t)element[Element_IntNum] >= kVariableInterrupts)
    reason = TEXT("IntNum of VARINT is none of 0..3");
  else if ((uint32_t)element[Element_SrcVar] >= vm->program->unit->variables)
    reason = TEXT("SrcVar of VARINT is no variable of the unit");
  else if ((uint32_t)element[Element_Mode] >= kModes)
    reason = TEXT("Mode of VARINT is none of 0..9");
  else if ((uint32_t)element[Element_Priority] > kMaxPriority)
    reason = TEXT("Priority of VARINT is none of 0..10");
  if (reason != NULL) return raise_fault(vm, number, kFaultIllop, reason);
  variable_interrupt* const interrupt = &vm->interrupts.watches[element[Element_IntNum]];
  interrupt->installed = element[Element_Priority] != 0;
  interrupt->held = 0;
  interrupt->mode = (uint8_t)element[Element_Mode];
  interrupt->task = (uint8_t)(element[Element_Control] + 1);
  interrupt->priority = (uint8_t)element[Element_Priority];
  interrupt->source = (uint16_t)element[Element_SrcVar];
  interrupt->structure = (uint16_t)structure;
  interrupt->compare = element[Element_CompareVar];
  interrupt->last = vm->h[interrupt->source];
  interrupt->address = address;
  return false;
}

/* Looks at the watched variable; true when this is the event. A condition is one when it becomes true. */
static bool look(variable_interrupt* interrupt, int32_t value) {
  const uint32_t mask = (uint32_t)interrupt->compare;
  const uint32_t now = (uint32_t)value;
  const uint32_t before = (uint32_t)interrupt->last;
  interrupt->last = value;
  bool condition = false;
  switch (interrupt->mode) {
    case Mode_Never: return false;
    case Mode_Changed: return ((now ^ before) & mask) != 0;
    case Mode_Rising: return (now & ~before & mask) != 0;
    case Mode_Falling: return (~now & before & mask) != 0;
    case Mode_Equal: condition = value == interrupt->compare; break;
    case Mode_NotEqual: condition = value != interrupt->compare; break;
    case Mode_AtLeast: condition = value >= interrupt->compare; break;
    case Mode_AtMost: condition = value <= interrupt->compare; break;
    case Mode_AnySet: condition = (now & mask) != 0; break;
    default: condition = (now & mask) == 0; break;
  }
  const bool event = condition && !interrupt->held;
  interrupt->held = condition;
  return event;
}

/* Begins the routine unless the task runs one that is not below it. */
static bool begin_routine(ipos_vm* vm, unsigned number, unsigned task, unsigned rank, uint32_t address) {
  if (vm->contexts[number].state != IPOS_TASK_STOPPED || vm->contexts[vm->active[task - 1]].rank >= rank) return false;
  begin(vm, number, task, address)->rank = (uint8_t)rank;
  choose_active(vm, task);
  return true;
}

/* One of the installed events is looked at in a millisecond, in turn (IPOSplus p. 45). */
static void take_events(ipos_vm* vm) {
  unsigned installed = 0;
  for (unsigned n = 0; n < kEvents; ++n) {
    if (vm->contexts[0].state == IPOS_TASK_STOPPED) vm->interrupts.events[n].pending = 0;
    installed += vm->interrupts.events[n].installed;
  }
  if (installed == 0) return;
  unsigned turn = vm->interrupts.turn;
  while (turn >= installed) turn -= installed;
  vm->interrupts.turn = (uint8_t)(turn + 1 == installed ? 0 : turn + 1);
  for (unsigned n = 0; n < kEvents; ++n) {
    event_interrupt* const interrupt = &vm->interrupts.events[n];
    if (!interrupt->installed || turn-- != 0) continue;
    if (interrupt->pending && begin_routine(vm, kTasks + n, 1, kEvents - n, interrupt->address)) interrupt->pending = 0;
    return;
  }
}

static void take_variable_interrupts(ipos_vm* vm) {
  uint32_t requests = (uint32_t)vm->h[kVarIntReq];
  for (unsigned n = 0; n < kVariableInterrupts; ++n) {
    variable_interrupt* const interrupt = &vm->interrupts.watches[n];
    /* A stopped task has its variable looked at, too: what happens meanwhile is over when it starts. */
    const bool event = interrupt->installed && look(interrupt, vm->h[interrupt->source]);
    if (!interrupt->installed || vm->contexts[interrupt->task - 1].state == IPOS_TASK_STOPPED) {
      requests &= ~((uint32_t)1 << n);
    } else if (event) {
      requests |= (uint32_t)1 << n;
      vm->h[interrupt->structure + Element_IntEvent] = interrupt->last;
    }
  }
  /* The highest priority first, of equals the lowest number. */
  for (unsigned priority = (requests & kAllRequests) != 0 ? kMaxPriority : 0; priority > 0; --priority)
    for (unsigned n = 0; n < kVariableInterrupts; ++n) {
      const variable_interrupt* const interrupt = &vm->interrupts.watches[n];
      if (interrupt->priority == priority && (requests >> n & 1) != 0 &&
          begin_routine(vm, kTasks + kEvents + n, interrupt->task, priority, interrupt->address))
        requests &= ~((uint32_t)1 << n);
    }
  vm->h[kVarIntReq] = (int32_t)requests;
}

static void take_interrupts(ipos_vm* vm) {
  take_events(vm);
  if (has_requests(vm)) take_variable_interrupts(vm);
}

static void forget_interrupts(ipos_vm* vm) {
  memset(&vm->interrupts, 0, sizeof vm->interrupts);
}

ipos_status ipos_raise_event(ipos_vm* vm, ipos_event event) {
  if (vm == NULL || event < 0 || event >= kEvents) return IPOS_INVALID_ARGUMENT;
  if (vm->interrupts.events[event].installed && vm->contexts[0].state != IPOS_TASK_STOPPED) vm->interrupts.events[event].pending = 1;
  return IPOS_OK;
}

#else

static bool set_interrupt(ipos_vm* vm, unsigned number, int32_t keyword, uint32_t address) {
  (void)keyword, (void)address;
  return raise_fault(vm, number, kFaultIllop, TEXT("interrupts are not built in"));
}

static bool set_variable_interrupt(ipos_vm* vm, unsigned number, uint32_t structure, uint32_t address) {
  return set_interrupt(vm, number, (int32_t)structure, address);
}

static void take_interrupts(ipos_vm* vm) {
  if (has_requests(vm)) vm->h[kVarIntReq] &= ~kAllRequests; /* nobody takes them */
}

static void forget_interrupts(ipos_vm* vm) { (void)vm; }

ipos_status ipos_raise_event(ipos_vm* vm, ipos_event event) {
  return vm == NULL || event < 0 || event >= kEvents ? IPOS_INVALID_ARGUMENT : IPOS_NOT_BUILT_IN;
}

#endif
