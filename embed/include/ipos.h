/* ipos.h - the ipos virtual machine as a library, in C99.
 *
 * Runs programs of the kind of SEW IPOSplus inside a drive's firmware or any other program: loads and
 * verifies an image, executes it a millisecond or a command at a time, and calls back for everything that is
 * not computing.
 *
 * Memory     The library allocates nothing. Programs and machines live in memory the caller hands over and
 *            may take back at any time: nothing has to be closed. Sizes: IPOS_PROGRAM_BYTES, IPOS_VM_BYTES.
 * Errors     Every function that can fail returns an ipos_status. Nothing throws, aborts or prints. After a
 *            status other than IPOS_OK, IPOS_FAULTED and IPOS_ENDED nothing has changed, unless the function
 *            says otherwise.
 * Threads    There is no global state. A program does not change after loading: any number of machines and
 *            threads may use it at once. A machine is used by one thread at a time.
 * Callbacks  are called inside the function that needs them, on the caller's stack, with the machine as
 *            argument. They may use the functions of the machine marked "in callbacks"; the others answer
 *            IPOS_BUSY there. A callback must return; it must not leave by longjmp or an exception.
 * Time       is a count of milliseconds ("ticks") that the caller advances. No clock is read, but by
 *            ipos_run_due().
 * Bounds     A program cannot run longer than the ticks and commands asked for, reach memory but its H
 *            variables, or nest deeper than its unit allows, whatever the image contains.
 * Platform   Two's complement, little endian, 32 bits or more.
 *
 * Numbers of variables are those of the manuals (H0 and up); times are in milliseconds unless a name ends in
 * _us. Pointers must not be null unless "may be null" is written.
 */
#ifndef IPOS_H
#define IPOS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ipos_commands.h"

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__ /* what is declared here is all a shared library shows */
#pragma GCC visibility push(default)
#endif

/* ---- Version and features ------------------------------------------------------------------------------- */

/* Version of this header. Within a major version functions are only added, and structures do not change. */
#define IPOS_VERSION_MAJOR 0
#define IPOS_VERSION_MINOR 1
#define IPOS_VERSION_PATCH 0
#define IPOS_VERSION (IPOS_VERSION_MAJOR * 10000 + IPOS_VERSION_MINOR * 100 + IPOS_VERSION_PATCH)

/* Variables of a machine. A library built for smaller units (CMake: IPOS_VARIABLES) needs the same value
 * here; the CMake target and pkg-config pass it on. ipos_init() refuses memory that is too small. */
#ifndef IPOS_VARIABLES
#define IPOS_VARIABLES 1024
#endif

/* Version of the library, as IPOS_VERSION. */
uint32_t ipos_version(void);

/* What a build of the library has; bits of ipos_features(). */
enum {
  IPOS_FEATURE_FAST = 1,       /* ipos_program_accelerate() */
  IPOS_FEATURE_TELEGRAMS = 2,  /* variable telegrams by `send`, ipos_receive() */
  IPOS_FEATURE_INTERRUPTS = 4, /* SETINT and VARINT, ipos_raise_event() */
  IPOS_FEATURE_STATES = 8,     /* ipos_save(), ipos_restore() */
  IPOS_FEATURE_TEXTS = 16      /* texts of statuses, rules and faults; without, they are "" */
};
uint32_t ipos_features(void);

/* The most variables and code words a program may need; units and programs beyond are refused. */
uint32_t ipos_most_variables(void);
uint32_t ipos_most_words(void);

/* ---- Status --------------------------------------------------------------------------------------------- */

/* One row a status: X(name, number, text). */
#define IPOS_STATUSES(X)                                                                           \
  X(IPOS_OK, 0, "done")                                                                            \
  X(IPOS_ENDED, 1, "no task of the program runs")                                                  \
  X(IPOS_FAULTED, 2, "the program caused a fault, all its tasks are stopped; see ipos_fault_of()") \
  X(IPOS_INVALID_ARGUMENT, 3, "a pointer is null or a number is out of its range")                 \
  X(IPOS_MEMORY_TOO_SMALL, 4, "the memory handed over is too small")                               \
  X(IPOS_MISALIGNED, 5, "the memory handed over or the image is not aligned as it has to be")      \
  X(IPOS_NOT_AN_IMAGE, 6, "the bytes are no ipos image")                                           \
  X(IPOS_IMAGE_VERSION, 7, "the image has a version this library does not know")                   \
  X(IPOS_IMAGE_DAMAGED, 8, "the image is damaged: checksum or layout is wrong")                    \
  X(IPOS_UNKNOWN_UNIT, 9, "no unit type has this number or name, or it has no IPOS")               \
  X(IPOS_UNIT_TOO_LARGE, 10, "the unit type has more variables than this library was built for")   \
  X(IPOS_REFUSED, 11, "the code breaks a rule of the verifier")                                    \
  X(IPOS_NO_VARIABLE, 12, "the unit has no variable of this number")                               \
  X(IPOS_NO_SYMBOL, 13, "the image has no symbol of this name or number")                          \
  X(IPOS_BUSY, 14, "the function cannot be called from a callback of the machine")                 \
  X(IPOS_NOT_TAKEN, 15, "no receive object takes this frame")                                      \
  X(IPOS_NO_CALLBACK, 16, "the callback this function needs is not there")                         \
  X(IPOS_HOST_FAILED, 17, "a callback has failed")                                                 \
  X(IPOS_NO_CONTENT, 18, "the non-volatile memory holds nothing valid")                            \
  X(IPOS_BAD_STATE, 19, "the bytes are no saved state, or damaged")                                \
  X(IPOS_OTHER_PROGRAM, 20, "the saved state belongs to another program")                          \
  X(IPOS_NOT_BUILT_IN, 21, "this build of the library does not have the function")                 \
  X(IPOS_SOURCE_ERROR, 22, "the source has errors (ipos_compile.h)")                               \
  X(IPOS_OUT_OF_MEMORY, 23, "the compiler found no memory (ipos_compile.h)")

typedef int32_t ipos_status;
enum {
#define IPOS_STATUS_ROW(name, number, text) name = number,
  IPOS_STATUSES(IPOS_STATUS_ROW)
#undef IPOS_STATUS_ROW
};

/* The text of a status, in English; "" for a number that is none. Static. In callbacks. */
const char* ipos_status_text(ipos_status status);

/* ---- Programs ------------------------------------------------------------------------------------------- */

/* A verified program. Opaque; in memory of the caller, aligned to 8. */
typedef struct ipos_program ipos_program;

/* Bytes that hold a program object on any platform. The image itself is not copied into it. */
#define IPOS_PROGRAM_BYTES 176
/* The exact number on this one. */
size_t ipos_program_size(void);

/* Where and why an image was refused. */
typedef struct ipos_trouble {
  uint32_t offset;     /* byte of the image where the trouble was seen */
  uint32_t word;       /* IPOS_REFUSED: address of the first bad command in code words */
  uint8_t rule;        /* IPOS_REFUSED: the rule it breaks, 1.. for V01..; else 0 */
  uint32_t violations; /* IPOS_REFUSED: how many commands break rules */
} ipos_trouble;

/* Checks an image (.ipx) completely and makes a program of it in `memory`.
 *   memory, size  at least ipos_program_size() bytes, aligned to 8
 *   image         aligned to 4; is not copied: it must stay where it is, unchanged, as long as the program or
 * a machine with it is used. Flash is a good place. program       takes the program: a pointer into `memory`
 *   trouble       may be null; filled when the image is refused
 * IPOS_NOT_AN_IMAGE, IPOS_IMAGE_VERSION, IPOS_IMAGE_DAMAGED, IPOS_UNKNOWN_UNIT, IPOS_UNIT_TOO_LARGE,
 * IPOS_REFUSED, IPOS_MEMORY_TOO_SMALL, IPOS_MISALIGNED. Time and stack are bounded by the size of the image
 * and by ipos_most_words() / 8 bytes. */
ipos_status ipos_program_load(void* memory, size_t size, const void* image, size_t image_size,
                              ipos_program** program, ipos_trouble* trouble);

/* The meaning of a rule of the verifier (1 and up); "" for a number that is none. Static. In callbacks. */
const char* ipos_rule_text(uint8_t rule);

typedef struct ipos_program_info {
  uint8_t unit;       /* unit type: its code in stdlib/unit_types.def, 4 is mdxb */
  uint8_t tasks;      /* 1..3 */
  uint8_t call_depth; /* nested calls of a task */
  uint16_t variables; /* H0 .. variables - 1 */
  uint32_t words;     /* code words */
  uint32_t symbols;   /* rows of the symbol table; 0 if the image has none */
  uint32_t checksum;  /* CRC-32 of the image: equal for equal images */
} ipos_program_info;

/* In callbacks. */
ipos_status ipos_program_info_of(const ipos_program* program, ipos_program_info* info);

/* Memory ipos_program_accelerate() needs for a program: about 10 bytes a code word. 0: not built in. */
size_t ipos_accelerate_size(const ipos_program* program);

/* Translates the program for the fast engine: same results to the command, several times the speed.
 *   memory  at least ipos_accelerate_size() bytes, aligned to 8, kept as long as the program
 * Before machines are made of the program: existing ones go on without. IPOS_NOT_BUILT_IN,
 * IPOS_MEMORY_TOO_SMALL, IPOS_MISALIGNED. */
ipos_status ipos_program_accelerate(ipos_program* program, void* memory, size_t size);

/* A named variable or run of variables. `name` is not terminated by 0; it points into the image. */
typedef struct ipos_symbol {
  const char* name;
  size_t length;     /* bytes of the name */
  uint16_t variable; /* number of the first variable */
  uint16_t count;    /* 1.. consecutive variables */
} ipos_symbol;

/* Row `index` of the symbol table, 0 and up. The time grows with the index. IPOS_NO_SYMBOL. In callbacks. */
ipos_status ipos_symbol_at(const ipos_program* program, uint32_t index, ipos_symbol* symbol);

/* The symbol called `name` (terminated by 0; "speed", "TrCycl.ObjectNo"), or a variable by its number
 * ("H420"; then symbol->name is `name`). The time grows with the table. IPOS_NO_SYMBOL. In callbacks. */
ipos_status ipos_find(const ipos_program* program, const char* name, ipos_symbol* symbol);

/* ---- The host: what a machine calls --------------------------------------------------------------------- */

/* A running program. Opaque; in memory of the caller, aligned to 8. */
typedef struct ipos_vm ipos_vm;

/* Bytes that hold a machine on any platform. */
#define IPOS_VM_BYTES (2048 + 4 * (IPOS_VARIABLES))
/* The exact number on this one. */
size_t ipos_vm_size(void);

/* The commands that reach the `command` callback: IPOS_HOST_COMMANDS(X) in ipos_commands.h, which the build writes out
 * of the instruction set. Operands are those of docs/reference/isa.md, in order: variables by number. Some come only
 * without the callback by which the library does them itself: Scom, ScomOn, ScomState without `send`, Memorize without
 * `nv_write`. InputCall and SystemCall: IPOS_ANSWER_TAKEN calls the label.
 */
enum {
#define IPOS_OPCODE_ROW(name, code) IPOS_COMMAND_##name = code,
  IPOS_HOST_COMMANDS(IPOS_OPCODE_ROW)
#undef IPOS_OPCODE_ROW
};

typedef struct ipos_command {
  uint8_t opcode;      /* one of IPOS_COMMAND_... */
  uint8_t context;     /* who executes it: 1..3 the tasks, 4..10 interrupt routines; for ipos_resume() */
  uint32_t address;    /* of the command, in code words */
  int32_t operands[4]; /* variables by number, constants, labels as word addresses */
} ipos_command;

typedef int32_t ipos_answer;
enum {
  IPOS_ANSWER_DONE = 0,  /* go on with the next command */
  IPOS_ANSWER_TAKEN = 1, /* InputCall and SystemCall only: the condition holds, the label is called */
  IPOS_ANSWER_WAIT = 2,  /* the context waits until ipos_resume() */
  IPOS_ANSWER_FAULT = 3  /* not possible: the program stops with reply.fault */
};

typedef struct ipos_reply {
  ipos_answer answer;
  uint8_t fault;      /* fault number 1..255 with IPOS_ANSWER_FAULT; 10 is "IPOS ILLOP" */
  const char* reason; /* static text for people, may be null */
} ipos_reply;

/* A CAN data frame with an 11-bit identifier. */
typedef struct ipos_frame {
  uint16_t id;     /* 0..2047 */
  uint8_t length;  /* 0..8 */
  uint8_t data[8]; /* bytes beyond the length are 0 */
} ipos_frame;

typedef int32_t ipos_sending;
enum {
  IPOS_SENDING_DONE = 0,   /* it is on its way or sent: nothing more will be said about it */
  IPOS_SENDING_QUEUED = 1, /* ipos_sent() will follow */
  IPOS_SENDING_FAILED = 2  /* it will not be sent */
};

typedef struct ipos_fault {
  uint8_t number;     /* drive fault, 10 "IPOS ILLOP", 32 "IPOS index overflow", ...; 0: none */
  uint8_t task;       /* 1..3 */
  uint8_t context;    /* the task itself or one of its interrupt routines */
  uint32_t address;   /* of the command, in code words */
  const char* reason; /* static text; "" after a restored state */
} ipos_fault;

typedef struct ipos_step {
  uint64_t tick;    /* as ipos_ticks() */
  uint32_t address; /* of the command about to be executed, in code words */
  uint32_t word;    /* its first code word; bits 0..7 are the opcode */
  uint8_t context;
} ipos_step;

/* The callbacks of one machine. Each may be null; what a program then asks for ends in fault 10 with a
 * reason, never in silence. `user` is the first argument of each. */
typedef struct ipos_host {
  void* user;
  /* Carries out a command of IPOS_HOST_COMMANDS. */
  ipos_reply (*command)(void* user, ipos_vm* vm, const ipos_command* command);
  /* A context that waited for ipos_resume() was stopped and is not to be resumed for that command. */
  void (*cancel)(void* user, ipos_vm* vm, uint8_t context);
  /* Sends a frame of a variable telegram. With this callback the library does SCOM, SCOMON and SCOMST itself,
   * at most 30 + 1 frames a tick. `tag` names the object for ipos_sent(): below 65536 a cyclic one, whose
   * frame, if still waiting for the bus, is to be replaced by this one. */
  ipos_sending (*send)(void* user, ipos_vm* vm, const ipos_frame* frame, uint32_t tag);
  /* Microseconds since any moment, never going back. Only ipos_run_due() calls it. */
  uint64_t (*time_us)(void* user);
  /* Non-volatile memory: `size` bytes at `offset`, below IPOS_NV_BYTES. False: failed. With nv_write the
   * library does MEM itself. */
  bool (*nv_write)(void* user, uint32_t offset, const void* bytes, uint32_t size);
  bool (*nv_read)(void* user, uint32_t offset, void* bytes, uint32_t size);
  /* The program has stopped with a fault. Once a fault. */
  void (*fault)(void* user, ipos_vm* vm, const ipos_fault* fault);
  /* Before every command. Slow: commands are then executed one by one. */
  void (*trace)(void* user, ipos_vm* vm, const ipos_step* step);
} ipos_host;

/* ---- Machines ------------------------------------------------------------------------------------------- */

/* Makes a machine in `memory`: variables 0, tasks stopped, tick 0.
 *   memory, size  at least ipos_vm_size() bytes, aligned to 8
 *   host          is copied; null: no callbacks
 * IPOS_MEMORY_TOO_SMALL, IPOS_MISALIGNED. */
ipos_status ipos_init(void* memory, size_t size, const ipos_program* program, const ipos_host* host,
                      ipos_vm** vm);

/* The program of a machine, or null for null. In callbacks. */
const ipos_program* ipos_program_of(const ipos_vm* vm);

/* Ends whatever runs and starts task 1 at its first command. Variables keep their values, interrupts and
 * variable telegrams are forgotten, a fault is cleared. To begin as after power-on: ipos_nv_load(), then
 * this. IPOS_BUSY. */
ipos_status ipos_start(ipos_vm* vm);

/* Stops all tasks and variable telegrams. IPOS_BUSY. */
ipos_status ipos_stop(ipos_vm* vm);

/* Commands a tick for tasks 1, 2 and 3; at first 1, 2 and 20, as a drive (P938, P939). 0 holds a task. In
 * callbacks, from the next task on. */
ipos_status ipos_set_rates(ipos_vm* vm, const uint32_t commands[3]);

/* The SBus as the program sees it, for SCOM; at first 500000 baud, address and group 0, sync identifier 0.
 * Not while objects exist: to be called before ipos_start(). baud     bit/s, 1..1000000: limits the load of
 * cyclic objects address, group  0..63 (P813, P814); their MOVILINK identifiers are closed to the program's
 * objects sync_id  0..2047 (P817) */
ipos_status ipos_set_sbus(ipos_vm* vm, uint32_t baud, uint8_t address, uint8_t group, uint16_t sync_id);

/* What a run did. */
typedef struct ipos_progress {
  uint32_t ticks;    /* completed */
  uint64_t commands; /* executed */
} ipos_progress;

/* Runs `ticks` milliseconds: in each waits count down, interrupts begin, every task executes its commands,
 * then cyclic telegrams that are due are sent. Ends early when the program faults, then with the tick in
 * which it did. progress  may be null IPOS_OK, IPOS_ENDED (all ticks have passed and no task runs),
 * IPOS_FAULTED, IPOS_BUSY. */
ipos_status ipos_run_ticks(ipos_vm* vm, uint32_t ticks, ipos_progress* progress);

/* Executes at most `commands` commands of one task, 1..3, without time passing. Fewer when it waits or ends.
 *   done  may be null; takes how many
 * IPOS_OK, IPOS_ENDED (this task does not run), IPOS_FAULTED, IPOS_BUSY. */
ipos_status ipos_run_commands(ipos_vm* vm, uint8_t task, uint32_t commands, uint32_t* done);

/* Runs the ticks that are due by the host's clock since the first call of this function or the last
 * ipos_start(), at most `most`; the rest remains due. As ipos_run_ticks(), and IPOS_NO_CALLBACK. */
ipos_status ipos_run_due(ipos_vm* vm, uint32_t most, ipos_progress* progress);

/* Ticks since ipos_init(). In callbacks. */
uint64_t ipos_ticks(const ipos_vm* vm);

/* ---- Variables (in callbacks) --------------------------------------------------------------------------- */

/* IPOS_NO_VARIABLE. */
ipos_status ipos_read(const ipos_vm* vm, uint32_t variable, int32_t* value);
ipos_status ipos_write(ipos_vm* vm, uint32_t variable, int32_t value);

/* By the name of a symbol as for ipos_find(), its first variable. IPOS_NO_SYMBOL. */
ipos_status ipos_read_symbol(const ipos_vm* vm, const char* name, int32_t* value);
ipos_status ipos_write_symbol(ipos_vm* vm, const char* name, int32_t value);

/* All variables as an array of program_info.variables numbers, valid as long as the machine; null for null.
 */
int32_t* ipos_variables(ipos_vm* vm);

/* ---- Tasks, events, frames (in callbacks) --------------------------------------------------------------- */

typedef int32_t ipos_task_state;
enum {
  IPOS_TASK_STOPPED = 0,
  IPOS_TASK_READY = 1,
  IPOS_TASK_WAITING = 2 /* for time or for ipos_resume() */
};

typedef struct ipos_task {
  ipos_task_state state;
  uint32_t address;  /* next command, or the one it waits in, in code words */
  uint32_t wait_ms;  /* ticks still to wait; 0 while waiting: for the host */
  uint8_t depth;     /* nested calls */
  uint64_t commands; /* executed since its start */
} ipos_task;

/* Contexts are 1..3 for the tasks, 4 ERROR, 5 TOUCH PROBE and 6 TIMER 0 interrupt, 7..10 variable interrupts.
 */
ipos_status ipos_task_of(const ipos_vm* vm, uint8_t context, ipos_task* task);

/* Starts task 1..3 at the start of a command, anew if it runs; stops it. */
ipos_status ipos_start_task(ipos_vm* vm, uint8_t task, uint32_t address);
ipos_status ipos_stop_task(ipos_vm* vm, uint8_t task);

/* Ends the wait of a context that was answered IPOS_ANSWER_WAIT. One that does not wait for the host is left
 * alone, and the status is IPOS_NOT_TAKEN. */
ipos_status ipos_resume(ipos_vm* vm, uint8_t context);

/* What SETINT can wait for. Without an installed routine nothing follows. */
typedef int32_t ipos_event;
enum { IPOS_EVENT_ERROR = 0, IPOS_EVENT_TOUCH_PROBE = 1, IPOS_EVENT_TIMER0 = 2 };
ipos_status ipos_raise_event(ipos_vm* vm, ipos_event event);

/* The last fault of the program; number 0 when there is none. */
ipos_status ipos_fault_of(const ipos_vm* vm, ipos_fault* fault);

/* Stops the program with a fault of the unit (a watchdog, for example), 1..255. `reason` is static text. Not
 * in callbacks: there a command is answered with IPOS_ANSWER_FAULT; IPOS_BUSY. */
ipos_status ipos_raise_fault(ipos_vm* vm, uint8_t number, const char* reason);

/* A frame from the bus: a receive object with its identifier takes it. IPOS_NOT_TAKEN: none has it, its
 * length differs, or _SBusCommOn has not run. */
ipos_status ipos_receive(ipos_vm* vm, const ipos_frame* frame);

/* What became of a frame that was answered IPOS_SENDING_QUEUED. Tags of cyclic objects may be left out. */
ipos_status ipos_sent(ipos_vm* vm, uint32_t tag, bool sent);

/* ---- Non-volatile memory -------------------------------------------------------------------------------- */

/* Variables that are kept, H0 and up (IPOSplus p. 28), and the bytes of memory they take with head and
 * CRC-32. */
#define IPOS_NV_VARIABLES 128
#define IPOS_NV_BYTES (4 * IPOS_NV_VARIABLES + 8)

/* Stores and loads H0..H127 by the callbacks nv_write and nv_read, as MEM does. A load that fails leaves the
 * variables as they are. IPOS_NO_CALLBACK, IPOS_HOST_FAILED, IPOS_NO_CONTENT (load only), IPOS_BUSY. */
ipos_status ipos_nv_store(ipos_vm* vm);
ipos_status ipos_nv_load(ipos_vm* vm);

/* ---- The whole state ------------------------------------------------------------------------------------ */

/* Bytes of a saved state; the same for all machines with the same program. 0 for null. */
size_t ipos_state_size(const ipos_vm* vm);

/* Writes everything that changes while the program runs: variables, tasks, calls, waits, interrupts, telegrams,
 * ticks, fault. Rates and callbacks are the host's and not in it. The bytes are the same on every platform.
 * IPOS_MEMORY_TOO_SMALL, IPOS_BUSY. */
ipos_status ipos_save(const ipos_vm* vm, void* bytes, size_t size);

/* Takes a saved state over; `size` as ipos_state_size(). The bytes may come from anywhere: what could not
 * have been saved by a machine of this program is refused and nothing changes. What a context waits for from
 * the host is for the caller to carry on. IPOS_BAD_STATE, IPOS_OTHER_PROGRAM, IPOS_BUSY. */
ipos_status ipos_restore(ipos_vm* vm, const void* bytes, size_t size);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif /* IPOS_H */
