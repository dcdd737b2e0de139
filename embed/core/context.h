/* The switches of a build, contexts and programs. The parts of this folder are one C99 source, ipos.c, which
 * cmake/firmware_file.cmake writes together with the tables of the instruction set and the units. */
#ifndef IPOS_CONTEXT_H
#define IPOS_CONTEXT_H

#include <string.h>

#include "ipos.h"

/* Sizes and parts of a build; docs/guide/firmware.md has a table of what each part weighs. */
#ifndef IPOS_PROGRAM_WORDS
#define IPOS_PROGRAM_WORDS 16384 /* the longest program, in code words */
#endif
#ifndef IPOS_TELEGRAMS
#define IPOS_TELEGRAMS 1 /* SCOM, SCOMON, SCOMST; without, the host's `command` is asked for them */
#endif
#ifndef IPOS_INTERRUPTS
#define IPOS_INTERRUPTS 1 /* SETINT, VARINT; without, these commands are a fault */
#endif
#ifndef IPOS_TEXTS
#define IPOS_TEXTS 1 /* the texts of statuses, rules and faults; without, "" */
#endif
#ifndef IPOS_FAST
#define IPOS_FAST 0 /* the fast engine, which is C++ and not in this file (embed/fast.cpp) */
#endif
#define IPOS_STATES (IPOS_TELEGRAMS && IPOS_INTERRUPTS) /* ipos_save(): there is one layout of saved states */

#if IPOS_PROGRAM_WORDS > 65535
#error "word addresses are kept in 16 bits"
#endif
#ifdef __BYTE_ORDER__
#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "images are used in place: little endian only"
#endif
#endif

#ifdef __GNUC__
#define APART __attribute__((noinline)) /* whose stack is not to be that of who calls it */
#else
#define APART
#endif
#define TEXT(text) (IPOS_TEXTS ? (text) : "")

enum {
  kTasks = 3,
  kEvents = 3,             /* ERROR, TOUCH PROBE, TIMER 0: the highest priority first (IPOSplus p. 342) */
  kVariableInterrupts = 4, /* IPOSplus p. 45 */
  kContexts = kTasks + kEvents + kVariableInterrupts,
  kMaxCallDepth = 32, /* that of every unit */
  kMostReceive = 32,  /* receive objects, 1053 1610 p. 55 */
  kFaultIllop = 10,   /* F10 IPOS ILLOP */
  kFaultEeprom = 25,  /* F25 EEPROM */
  kFaultOverflow = 32 /* F32 IPOS index overflow */
};

/* A task or an interrupt routine. The fast engine knows it as vm::TaskContext, whose layout it has. */
typedef struct {
  uint8_t state; /* IPOS_TASK_... */
  uint8_t depth; /* entries in use of `calls` */
  uint8_t task;  /* whose commands it uses, 1..3 */
  uint8_t rank;  /* of the contexts of a task the highest executes; a task has 0 */
  uint32_t pc;   /* of the next command, or the one it waits in */
  uint32_t wait_ms;
  uint64_t commands; /* since its start */
  uint16_t calls[kMaxCallDepth];
} ipos_context;

typedef struct {
  uint8_t code, family, tasks, call_depth, receive_objects, traits;
  uint16_t variables, program_words;
} unit_type;

struct ipos_program {
  const unit_type* unit;
  const uint32_t* code;
  uint32_t words;
  const uint8_t* symbols;
  const uint8_t* symbols_end;
  uint32_t symbol_count;
  uint32_t checksum;
  const void* fast; /* vm::fast::Predecoded, or null */
};

#if IPOS_FAST
/* embed/fast.cpp: executes what the fast engine can, returns how many commands of the budget are left. */
uint32_t ipos_fast_run(const void* fast, ipos_context* context, int32_t* h, uint32_t budget);
#endif

#endif
