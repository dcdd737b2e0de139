/* What a machine consists of. */
#ifndef IPOS_STATE_H
#define IPOS_STATE_H

#include "embed/core/context.h"

typedef struct {
  uint8_t installed;
  uint8_t pending;
  uint32_t address;
} event_interrupt;

typedef struct {
  uint8_t installed;
  uint8_t held; /* the condition was true at the last look */
  uint8_t mode;
  uint8_t task; /* 2 or 3 */
  uint8_t priority;
  uint16_t source;    /* number of the watched variable */
  uint16_t structure; /* where VARINT stood */
  int32_t compare;
  int32_t last;
  uint32_t address;
} variable_interrupt;

typedef struct {
  event_interrupt events[kEvents];
  variable_interrupt watches[kVariableInterrupts];
  uint8_t turn; /* which of the installed events is looked at next */
} all_interrupts;

/* Variable telegrams. The layouts are those of a saved state. */
typedef struct {
  uint16_t id;
  uint16_t data; /* number of the first variable */
  uint8_t length;
  uint8_t intel; /* the byte order: 0 MOTOROLA, 1 INTEL */
  uint16_t cycle;
  uint16_t offset;
} cyclic_object;

typedef struct {
  uint16_t id;
  uint16_t data;
  uint8_t length;
  uint8_t intel;
} receive_object;

typedef struct {
  cyclic_object cyclic[IPOS_MOST_CYCLIC];
  receive_object receive[kMostReceive];
  uint8_t cyclic_count;
  uint8_t receive_count;
  uint8_t started;
  uint8_t closed; /* no receive objects after the first start */
  int64_t start_tick;
} telegram_objects;

struct ipos_vm {
  const ipos_program* program;
  const void* fast; /* the program's, when the machine was made */
  ipos_host host;
  uint64_t ticks;
  uint64_t due_us; /* when the next tick of ipos_run_due() begins */
  ipos_context contexts[kContexts];
#if IPOS_TELEGRAMS
  telegram_objects objects;
  uint32_t baud;
  uint8_t address, group; /* on the SBus */
#endif
#if IPOS_INTERRUPTS
  all_interrupts interrupts;
#endif
  uint8_t active[kTasks]; /* in contexts, what executes of each task */
  bool due_known;
  bool busy;       /* inside a function that calls back */
  bool fault_told; /* to the callback */
  ipos_fault fault;
  uint32_t rates[kTasks];
  int32_t h[IPOS_VARIABLES];
};

/* A decoded command: operands in the order of the text form, labels as word addresses. */
typedef struct {
  uint32_t opcode;
  uint32_t form; /* kinds of the operands and the keyword set, see tables.c */
  uint32_t words;
  int32_t operands[4];
} instruction;

#endif
