/* ipos_plant.h - a plant of drives as a library, in C99.
 *
 * Opens a plant file (TOML) with its programs, lets virtual time pass, and reads, sets and forces whatever the plant has
 * by station and name: variables, parameters, terminals, process words, motion, frames and telegrams.
 *
 * Memory     A plant is an object of the library on the heap, from ipos_plant_open() to ipos_plant_close(). Texts the
 *            library hands out belong to it: they stay until the next call with the same plant, unless "stays" is said.
 *            What a caller hands over is copied; nothing is kept.
 * Errors     Every function that can fail returns an ipos_plant_status. Nothing throws, aborts or prints.
 *            ipos_plant_message() has the last failure in words. A refused call has changed nothing.
 * Threads    There is no global state: any number of plants may be used by any number of threads. One plant belongs to
 *            one thread, at first to the one that opened it; calls from others are IPOS_PLANT_OTHER_THREAD, except
 *            ipos_plant_adopt() and ipos_plant_close().
 * Time       is virtual: nanoseconds since power-on of the plant. It passes only in ipos_plant_run() and
 *            ipos_plant_run_until(); between two calls everything stands. The same calls give the same run, on any
 *            build. No clock is read.
 * Platform   64 bits, little endian, Linux and Windows. Programs run on the fast engine of the library, with the results of every
 *            other one.
 *
 * Texts are UTF-8 and end with 0. Pointers must not be null unless "may be null" is written.
 */
#ifndef IPOS_PLANT_H
#define IPOS_PLANT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#if defined __GNUC__ && !defined _WIN32 /* what is declared here is all the shared library shows */
#pragma GCC visibility push(default)
#endif

/* ---- Version and status --------------------------------------------------------------------------------- */

/* Version of this header. Within a major version functions are only added, and structures do not change. */
#define IPOS_PLANT_VERSION_MAJOR 0
#define IPOS_PLANT_VERSION_MINOR 1
#define IPOS_PLANT_VERSION_PATCH 0
#define IPOS_PLANT_VERSION \
  (IPOS_PLANT_VERSION_MAJOR * 10000 + IPOS_PLANT_VERSION_MINOR * 100 + IPOS_PLANT_VERSION_PATCH)

/* Version of the library, as IPOS_PLANT_VERSION. */
uint32_t ipos_plant_version(void);

/* One row a status: X(name, number, text). */
#define IPOS_PLANT_STATUSES(X)                                                                          \
  X(IPOS_PLANT_OK, 0, "done")                                                                           \
  X(IPOS_PLANT_NOT_REACHED, 1, "the time limit came before the condition")                              \
  X(IPOS_PLANT_INVALID_ARGUMENT, 2, "a pointer is null or a number is out of its range")                \
  X(IPOS_PLANT_BAD_PLANT, 3, "the plant or a program has mistakes")                                     \
  X(IPOS_PLANT_NOT_OPEN, 4, "the plant could not be opened: only its mistakes can be read, and it can be closed") \
  X(IPOS_PLANT_OTHER_THREAD, 5, "the plant belongs to another thread until this one adopts it")          \
  X(IPOS_PLANT_BUSY, 6, "the function cannot be called from a callback of the plant, or another thread is inside") \
  X(IPOS_PLANT_NO_STATION, 7, "the plant has no station of this name or number")                        \
  X(IPOS_PLANT_NO_SIGNAL, 8, "the station has nothing of this name, or no signal has this number")      \
  X(IPOS_PLANT_NO_BUS, 9, "the plant has no bus of this name or number, or one of another kind")        \
  X(IPOS_PLANT_READ_ONLY, 10, "this can only be read")                                                  \
  X(IPOS_PLANT_BAD_VALUE, 11, "the value is out of range, or the text says none")                       \
  X(IPOS_PLANT_REFUSED, 12, "the unit or the line refuses it")                                          \
  X(IPOS_PLANT_BAD_STATE, 13, "the bytes are no saved state, or damaged")                               \
  X(IPOS_PLANT_OTHER_PLANT, 14, "the saved state belongs to a plant of other contents")                 \
  X(IPOS_PLANT_NOT_RECORDED, 15, "the plant was opened without record: it cannot be saved, restored or hashed") \
  X(IPOS_PLANT_TOO_SMALL, 16, "the memory handed over is too small")                                    \
  X(IPOS_PLANT_OUT_OF_MEMORY, 17, "there is no memory any more; an open plant is broken by that") \
  X(IPOS_PLANT_BROKEN, 18, "the plant broke in an earlier call and can only be closed")                 \
  X(IPOS_PLANT_NOTHING, 19, "there is nothing more to read")                                           \
  X(IPOS_PLANT_FULL, 20, "too many frames wait to be sent")

typedef int32_t ipos_plant_status;
enum {
#define IPOS_PLANT_STATUS_ROW(name, number, text) name = number,
  IPOS_PLANT_STATUSES(IPOS_PLANT_STATUS_ROW)
#undef IPOS_PLANT_STATUS_ROW
};

/* The text of a status, in English; "" for a number that is none. Stays. */
const char* ipos_plant_status_text(ipos_plant_status status);

/* ---- Opening and closing -------------------------------------------------------------------------------- */

typedef struct ipos_plant ipos_plant;

enum {
  /* Memory files of stations (nvram) are written as `ipos run` does it. Without, what they hold is taken over and
   * nothing is written. Such a plant keeps no record. */
  IPOS_PLANT_WRITE_MEMORY = 1,
  /* Calls are not recorded: no save, restore and trace hash, and no memory grows with the number of calls. */
  IPOS_PLANT_NO_RECORD = 2
};

/* What to open. Start with all members 0 and set what is needed. */
typedef struct ipos_plant_source {
  const char* path;   /* of a plant file; or of a program (.IPC, .ipx), which makes a plant of one station; may be null */
  const char* text;   /* the text of a plant file in place of the file's; may be null */
  const char* folder; /* where programs and memories are, with `text`; null: that of `path`, else the current one */
  const char* const* include_dirs; /* for #include in programs; may be null */
  size_t include_dir_count;
  const char* const* defines; /* "NAME" or "NAME=TEXT"; may be null */
  size_t define_count;
  uint32_t flags;         /* IPOS_PLANT_... */
  uint32_t commands_a_ms; /* of every task; 0: as P938 and P939 say */
  uint64_t seed;          /* added to the seeds of the plant's faults */
} ipos_plant_source;

/* Opens a plant. *plant is set also when it has mistakes, so that they can be read, and is null only without memory;
 * it has to be closed. The plant stands at time 0, its stations switched on, before the first event.
 * IPOS_PLANT_BAD_PLANT, IPOS_PLANT_INVALID_ARGUMENT, IPOS_PLANT_OUT_OF_MEMORY. */
ipos_plant_status ipos_plant_open(const ipos_plant_source* source, ipos_plant** plant);

/* Ends a plant and its memory; null is allowed. From any thread, but not while another call is under way: then
 * IPOS_PLANT_BUSY, and the plant remains. IPOS_PLANT_REFUSED: a memory file could not be written; it is closed. */
ipos_plant_status ipos_plant_close(ipos_plant* plant);

/* From now on the plant belongs to the calling thread. IPOS_PLANT_BUSY. */
ipos_plant_status ipos_plant_adopt(ipos_plant* plant);

/* What the last call that failed has to say, with names and what there is instead; "" before. */
const char* ipos_plant_message(const ipos_plant* plant);

/* A mistake of the plant file or a program; `line` and `column` count from 1, 0: of the file as a whole. */
typedef struct ipos_plant_mistake {
  const char* file;
  const char* text;
  uint32_t line;
  uint32_t column;
} ipos_plant_mistake;

/* How many mistakes ipos_plant_open() found. */
size_t ipos_plant_mistakes(const ipos_plant* plant);
/* IPOS_PLANT_NOTHING. The texts stay as long as the plant. */
ipos_plant_status ipos_plant_mistake_at(const ipos_plant* plant, size_t number, ipos_plant_mistake* mistake);

/* ---- Time ----------------------------------------------------------------------------------------------- */

/* "500ms", "1.5s", "20us", "2min" in nanoseconds. IPOS_PLANT_BAD_VALUE. */
ipos_plant_status ipos_plant_duration(const char* text, int64_t* ns);

/* Nanoseconds since power-on. */
ipos_plant_status ipos_plant_time(ipos_plant* plant, int64_t* ns);

/* Runs until `until`, which is not before now: everything up to and including that time has happened then. */
ipos_plant_status ipos_plant_run(ipos_plant* plant, int64_t until);

/* Runs until a CAN line has carried something that ipos_plant_receive() has not yet given, at most until `until`; not at
 * all when there is something. It is then the time of that frame. IPOS_PLANT_NO_BUS. */
ipos_plant_status ipos_plant_run_to_frame(ipos_plant* plant, uint32_t bus, int64_t until);

/* Asked before the run and then at every full millisecond. It may read the plant (marked "in callbacks"); other calls
 * are IPOS_PLANT_BUSY. It must return. */
typedef bool (*ipos_plant_condition)(void* user, ipos_plant* plant);

/* Runs until the condition holds, at most until `limit`. IPOS_PLANT_NOT_REACHED. */
ipos_plant_status ipos_plant_run_until(ipos_plant* plant, int64_t limit, ipos_plant_condition condition, void* user);

/* ---- Stations ------------------------------------------------------------------------------------------- */

typedef struct ipos_plant_station_info {
  const char* name;    /* texts stay as long as the plant is open */
  const char* unit;    /* "mdxb" */
  const char* title;   /* "MOVIDRIVE B" */
  const char* program; /* its file as the plant names it, "" without */
} ipos_plant_station_info;

/* IPOS_PLANT_NO_STATION. In callbacks. Gateways have the numbers behind the stations with a drive, and the unit
 * "gateway": they have power and signals to read (IPOS_PLANT_STATE, IPOS_PLANT_SIGNAL); orders to a drive or a program
 * are IPOS_PLANT_REFUSED. */
ipos_plant_status ipos_plant_station_at(ipos_plant* plant, uint32_t station, ipos_plant_station_info* info);
ipos_plant_status ipos_plant_station(ipos_plant* plant, const char* name, uint32_t* station);

/* Whether the motor is the ideal one of 1.5 kW: the plant file has no [station.motor] for it. Without control = "real" it keeps
 * every speed, too. False of a gateway, which has none. IPOS_PLANT_NO_STATION. In callbacks. */
ipos_plant_status ipos_plant_ideal_motor(ipos_plant* plant, uint32_t station, bool* ideal);

/* Mains and 24 V off and on. */
ipos_plant_status ipos_plant_power(ipos_plant* plant, uint32_t station, bool on);

enum { IPOS_PLANT_PROGRAM_START = 0, IPOS_PLANT_PROGRAM_STOP = 1, IPOS_PLANT_PROGRAM_RESTART = 2 };
/* Starts, stops or restarts the program of a station. IPOS_PLANT_REFUSED. */
ipos_plant_status ipos_plant_program(ipos_plant* plant, uint32_t station, int32_t order);

/* Raises a drive fault, 1..255, with the response its parameter chooses; or resets what is pending, by hand. */
ipos_plant_status ipos_plant_drive_fault(ipos_plant* plant, uint32_t station, uint8_t number);
ipos_plant_status ipos_plant_reset_fault(ipos_plant* plant, uint32_t station);

/* Why the drive does not run, or not as its setpoint says; "enabled" when it does. In callbacks. */
ipos_plant_status ipos_plant_why(ipos_plant* plant, uint32_t station, const char** text);

/* ---- Signals: everything with a value ------------------------------------------------------------------- */

typedef int32_t ipos_plant_kind;
enum {
  IPOS_PLANT_ANY = 0,       /* for searching: the first kind below that has the name */
  IPOS_PLANT_VARIABLE = 1,  /* "lCount", "TrCycl.Result", "y[2]", "H430", "ActPos_Mot" */
  IPOS_PLANT_PARAMETER = 2, /* "P130", or an index "8300" */
  IPOS_PLANT_INPUT = 3,     /* "DI00".."DI07", "DI10".."DI17" */
  IPOS_PLANT_OUTPUT = 4,    /* "DB00", "DO01".."DO05", "DO10".."DO17" */
  IPOS_PLANT_ANALOG = 5,    /* "AI1", "AI2", "frequency", "potentiometer" */
  IPOS_PLANT_STATE = 6,     /* "speed", "position", "fault", ...: docs/reference */
  IPOS_PLANT_WORD = 7,      /* "PO1".."PO3", "PI1".."PI3" */
  IPOS_PLANT_SIGNAL = 8,    /* any other name of docs/guide/recording.md, to be read: "torque", "PO1.6", "task1.line" */
  IPOS_PLANT_SHAFT = 9      /* what acts on the shaft: "load_torque"; "shaft_speed", which can be written where the plant
                             * file says that the shaft is driven from outside */
};

enum { IPOS_PLANT_WRITABLE = 1 /* it can be written and forced */ };

typedef struct ipos_plant_signal_info {
  const char* name; /* texts stay as long as the plant is open */
  const char* unit; /* of value x factor, "" for a plain number */
  double factor;    /* what people read = value x factor */
  int32_t decimals; /* of it */
  ipos_plant_kind kind;
  uint32_t station;
  uint32_t number; /* of a variable, index of a parameter, bit of a terminal */
  uint32_t flags;
} ipos_plant_signal_info;

/* A line has signals, too, to be read as IPOS_PLANT_SIGNAL: "load", "count", and what its telegrams carried last, as
 * docs/guide/recording.md names them: "013.PO2". Where the functions below take a station, line number `bus` is
 * IPOS_PLANT_LINE + bus. A telegram is kept from the moment at which one of its signals is found. */
#define IPOS_PLANT_LINE 0x80000000U

/* Finds a signal once; its number holds as long as the plant is open, also over ipos_plant_restore()
 * and ipos_plant_restart().
 * IPOS_PLANT_NO_STATION, IPOS_PLANT_NO_SIGNAL (the message names what there is). In callbacks. */
ipos_plant_status ipos_plant_find(ipos_plant* plant, uint32_t station, ipos_plant_kind kind, const char* name,
                                  uint32_t* signal);
ipos_plant_status ipos_plant_signal_info_of(ipos_plant* plant, uint32_t signal, ipos_plant_signal_info* info);

/* Name number `number`, 0 and up, of what a station has of a kind (not IPOS_PLANT_ANY). Variables: the named ones of its
 * program, a structure or array member by member. `part`: only members of this whole, "TrCycl"; may be null. The name is
 * good until the next call. IPOS_PLANT_NOTHING after the last. In callbacks. */
ipos_plant_status ipos_plant_name_at(ipos_plant* plant, uint32_t station, ipos_plant_kind kind, const char* part,
                                     uint32_t number, const char** name);

/* Reads one signal, or many in one call. IPOS_PLANT_NO_SIGNAL. In callbacks. */
ipos_plant_status ipos_plant_read(ipos_plant* plant, uint32_t signal, int64_t* value);
ipos_plant_status ipos_plant_read_many(ipos_plant* plant, const uint32_t* signals, size_t count, int64_t* values);

/* The value as people read it: "2.500 s", "1", "5.000 V", "-7". In callbacks. */
ipos_plant_status ipos_plant_read_text(ipos_plant* plant, uint32_t signal, const char** text);

/* Writes a value. Variables and parameters as over the parameter channel, volatile; inputs and analog inputs are what
 * hangs on the terminal; process output words come as over the bus that P100 and P101 name.
 * IPOS_PLANT_READ_ONLY, IPOS_PLANT_BAD_VALUE, IPOS_PLANT_REFUSED (the message says why, with the unit's return code). */
ipos_plant_status ipos_plant_write(ipos_plant* plant, uint32_t signal, int64_t value);
/* The same by text, of parameters, analog inputs and the shaft with unit: "2.5 s", "12 mA", "-3.5 Nm". */
ipos_plant_status ipos_plant_write_text(ipos_plant* plant, uint32_t signal, const char* text);

/* Holds a value from now on against program, wires, switches and telegrams, until it is released. */
ipos_plant_status ipos_plant_force(ipos_plant* plant, uint32_t signal, int64_t value);
ipos_plant_status ipos_plant_force_text(ipos_plant* plant, uint32_t signal, const char* text);
ipos_plant_status ipos_plant_release(ipos_plant* plant, uint32_t signal);

/* ---- Buses ---------------------------------------------------------------------------------------------- */

typedef int32_t ipos_plant_bus_kind;
enum { IPOS_PLANT_CAN = 0, IPOS_PLANT_SERIAL = 1, IPOS_PLANT_PROFIBUS = 2 };

typedef struct ipos_plant_bus_info {
  const char* name; /* stays as long as the plant is open */
  ipos_plant_bus_kind kind;
  uint32_t baud;
} ipos_plant_bus_info;

/* CAN lines first, then RS-485 lines, then PROFIBUS lines. IPOS_PLANT_NO_BUS. In callbacks. */
ipos_plant_status ipos_plant_bus_at(ipos_plant* plant, uint32_t bus, ipos_plant_bus_info* info);
ipos_plant_status ipos_plant_bus(ipos_plant* plant, const char* name, uint32_t* bus);

typedef struct ipos_plant_load {
  uint64_t frames;  /* of a serial line: characters */
  uint64_t lost;    /* frames and telegrams that were thrown away unread: the last IPOS_PLANT_KEPT are kept */
  double percent;   /* of the time the line was busy, since time 0 */
} ipos_plant_load;
#define IPOS_PLANT_KEPT 100000
ipos_plant_status ipos_plant_bus_load(ipos_plant* plant, uint32_t bus, ipos_plant_load* load); /* in callbacks */

enum {
  IPOS_PLANT_EXTENDED = 1, /* 29-bit identifier */
  IPOS_PLANT_REMOTE = 2,
  IPOS_PLANT_ERROR = 4, /* no frame but an error the line reports: id has the CAN_ERR_... classes of SocketCAN */
  IPOS_PLANT_OWN = 8    /* sent by this library */
};

typedef struct ipos_plant_frame {
  int64_t time; /* ns, of the end of the last bit; ignored when sending */
  uint32_t id;
  uint32_t flags;
  uint32_t sender; /* number of the station on the line, for ipos_plant_node_name(); UINT32_MAX: none */
  uint32_t tag;    /* of a frame with IPOS_PLANT_OWN: what ipos_plant_send() gave */
  uint8_t length;  /* 0..8; of a remote frame what it asks for */
  uint8_t data[8];
} ipos_plant_frame;

/* The library takes part in a CAN line with a station of its own from the first call of this function or
 * ipos_plant_send() on: it acknowledges frames. Before, it only listens. */
ipos_plant_status ipos_plant_join(ipos_plant* plant, uint32_t bus);

/* Queues a frame. *tag may be null. IPOS_PLANT_FULL: 64 frames wait; there is room again when one has gone.
 * IPOS_PLANT_BAD_VALUE, IPOS_PLANT_REFUSED. */
ipos_plant_status ipos_plant_send(ipos_plant* plant, uint32_t bus, const ipos_plant_frame* frame, uint32_t* tag);

/* Takes what the line has carried since the last call, oldest first, own frames included: each is given once.
 *   capacity  how many fit in `frames`
 *   count     how many there were, at most capacity */
ipos_plant_status ipos_plant_receive(ipos_plant* plant, uint32_t bus, ipos_plant_frame* frames, size_t capacity,
                                     size_t* count);

/* The name of a station on a CAN line. In callbacks. */
ipos_plant_status ipos_plant_node_name(ipos_plant* plant, uint32_t bus, uint32_t node, const char** name);

typedef struct ipos_plant_telegram {
  int64_t start; /* ns, of the first start bit */
  int64_t end;   /* of the last stop bit */
  const uint8_t* bytes;
  size_t length;
  bool valid;       /* else `text` says what is wrong with it */
  const char* text; /* what it says */
} ipos_plant_telegram;

/* Sends bytes on an RS-485 line, at most 1000, or octets on a PROFIBUS line, at most 300, with a station of the library's
 * own. IPOS_PLANT_REFUSED while the one before is still being sent. */
ipos_plant_status ipos_plant_serial_send(ipos_plant* plant, uint32_t bus, const uint8_t* bytes, size_t length);

/* The next MOVILINK telegram of an RS-485 line, or frame of a PROFIBUS line; each is given once. IPOS_PLANT_NOTHING. */
ipos_plant_status ipos_plant_serial_receive(ipos_plant* plant, uint32_t bus, ipos_plant_telegram* telegram);

typedef int32_t ipos_plant_fms_end;
enum { IPOS_PLANT_FMS_DONE = 0, IPOS_PLANT_FMS_ERROR = 1, IPOS_PLANT_FMS_REJECTED = 2, IPOS_PLANT_FMS_ABORTED = 3 };

typedef struct ipos_plant_fms_answer {
  ipos_plant_fms_end end;
  uint32_t code; /* of an error: class, code and additional code */
  const uint8_t* data;
  size_t length;
  const char* text; /* in words */
} ipos_plant_fms_answer;

/* A service of FMS on a PROFIBUS line, with a master of the library's own, which joins the ring with the first one. The plant
 * runs until the answer is there, at most to `until`: then IPOS_PLANT_NOTHING.
 *   connection  2 to 8, 7 is an acyclic one with all services
 *   service     "read", "write", "ov", "identify", "status", "initiate", "abort"
 *   data        of write */
ipos_plant_status ipos_plant_fms(ipos_plant* plant, uint32_t bus, uint8_t address, uint8_t connection, const char* service,
                                 uint16_t index, const uint8_t* data, size_t length, int64_t until,
                                 ipos_plant_fms_answer* answer);

/* Plants faults of lines while the plant runs: the text of [[fault]] tables as in a plant file. Their times count from
 * now. IPOS_PLANT_BAD_VALUE (the message has line and column), IPOS_PLANT_REFUSED. */
ipos_plant_status ipos_plant_line_fault(ipos_plant* plant, const char* text);

/* ---- Parameters of real units, for what speaks MOVILINK itself ------------------------------------------- */

/* The index of a parameter of a unit type ("mdxb") by number or index: "P130". IPOS_PLANT_NO_STATION: no such type,
 * IPOS_PLANT_NO_SIGNAL. */
ipos_plant_status ipos_plant_parameter_index(const char* unit, const char* name, uint16_t* index);
/* A value as people read it, and back. `text` takes at most `size` bytes with the 0; of ipos_plant_parameter_value() it
 * says what would be accepted. IPOS_PLANT_BAD_VALUE, IPOS_PLANT_TOO_SMALL. */
ipos_plant_status ipos_plant_parameter_text(const char* unit, uint16_t index, int32_t value, char* text, size_t size);
ipos_plant_status ipos_plant_parameter_value(const char* unit, uint16_t index, const char* written, int32_t* value,
                                             char* text, size_t size);
/* What a return code (class, code, additional code: the four data bytes of a refusal) means; "" for one that no manual
 * lists. Stays. */
const char* ipos_plant_return_code(uint32_t code);
/* The unit types by number from 0, "mdxb" among them; null after the last. Stays. */
const char* ipos_plant_unit_name(size_t number);
/* How a unit at a port is recognised: it is of the type of the first row, by number from 0, all of whose indices it can
 * read.  unit: stays.  count  in: places of `indices`; out: of the row. IPOS_PLANT_NOTHING after the last row,
 * IPOS_PLANT_TOO_SMALL. */
ipos_plant_status ipos_plant_unit_signs(size_t number, const char** unit, uint16_t* indices, size_t* count);

/* ---- Journal, state, hash ------------------------------------------------------------------------------- */

typedef int32_t ipos_plant_weight;
enum { IPOS_PLANT_WHY = 0, IPOS_PLANT_WARNING = 1, IPOS_PLANT_FAULT = 2 };

typedef struct ipos_plant_entry {
  int64_t time; /* ns */
  ipos_plant_weight weight;
  const char* station; /* "": the plant */
  const char* text;
} ipos_plant_entry;

/* IPOS_PLANT_NOTHING after the last entry. The texts are good until time passes or the plant changes. In callbacks. */
ipos_plant_status ipos_plant_journal_at(ipos_plant* plant, size_t number, ipos_plant_entry* entry);

/* The whole state as bytes, the same on every build: what was done to the plant and when. Restoring does it again, from
 * time 0 to the time of the state, in a plant of the same contents (file, programs, sources' options), which may be
 * another object or process; that takes the time the run took. What comes of it is compared with what was saved.
 *   size  in: bytes of memory; out: bytes needed. `bytes` may be null with *size 0.
 * IPOS_PLANT_TOO_SMALL, IPOS_PLANT_NOT_RECORDED. */
ipos_plant_status ipos_plant_save(ipos_plant* plant, void* bytes, size_t* size);
/* The bytes may come from anywhere: what cannot have been saved is refused, and nothing has changed then. Frames and
 * telegrams that were not yet received stay as in the plant before. IPOS_PLANT_BAD_STATE, IPOS_PLANT_OTHER_PLANT,
 * IPOS_PLANT_NOT_RECORDED. */
ipos_plant_status ipos_plant_restore(ipos_plant* plant, const void* bytes, size_t size);

/* At time 0 again, as it was opened, without reading or compiling anything: open once, run many. What was done to the plant
 * is forgotten, also what ipos_plant_replay() would do again; signals keep their numbers. IPOS_PLANT_REFUSED: it writes memory
 * files (IPOS_PLANT_WRITE_MEMORY); then nothing has happened. */
ipos_plant_status ipos_plant_restart(ipos_plant* plant);

/* Does everything again that was done to the plant since time 0, and calls `look` at every full millisecond meanwhile: so
 * what nobody has watched can be watched afterwards. What `look` returns is ignored. The plant is then as it was before.
 * IPOS_PLANT_NOT_RECORDED, IPOS_PLANT_BAD_STATE (a memory file has changed; nothing has happened). */
ipos_plant_status ipos_plant_replay(ipos_plant* plant, ipos_plant_condition look, void* user);

/* One number over everything that has happened since time 0, as `ipos run --trace-hash` prints it in hexadecimal. The
 * run is repeated for it in the background, each part of it once. IPOS_PLANT_NOT_RECORDED. */
ipos_plant_status ipos_plant_trace_hash(ipos_plant* plant, uint64_t* hash);

#if defined __GNUC__ && !defined _WIN32
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif /* IPOS_PLANT_H */
