/* Runs the programs that ipos_firmware_runs has written through ipos.c and prints a hash of each one's states, a line each. On a
 * host: the file's name is the argument; on a board the file is linked in (firmware_runs.S) and text goes by semihosting. */
#include <ipos.h>
#include <string.h>

#include "tests/embed/orders.h"

enum { kHead = 16, kTail = 10 * 30 + 6 * 32 + 4 + 8 + 4 }; /* of a state: magic, checksum, ticks; telegrams, CRC-32 */

static uint64_t program_memory[IPOS_PROGRAM_BYTES / 8];
static uint64_t machine_memory[(IPOS_VM_BYTES + 7) / 8];
static uint8_t state[IPOS_VM_BYTES];
static ipos_program_info info;

static ipos_reply command(void* user, ipos_vm* vm, const ipos_command* command) {
  const bool can_call = command->opcode == IPOS_COMMAND_InputCall || command->opcode == IPOS_COMMAND_SystemCall;
  const host_answer answer = answer_of(user, can_call, info.variables);
  const ipos_reply reply = {answer.answer, answer.fault, ""};
  if (answer.writes) ipos_write(vm, answer.variable, answer.value);
  return reply;
}

static void obey(ipos_vm* vm, chance* random) {
  const order next = order_of(random, info.variables, info.tasks);
  switch (next.kind) {
    case ORDER_NONE: break;
    case ORDER_WRITE: ipos_write(vm, next.number, next.value); break;
    case ORDER_EVENT: ipos_raise_event(vm, (ipos_event)next.number); break;
    case ORDER_RESUME: ipos_resume(vm, (uint8_t)next.number); break;
    case ORDER_START: ipos_start_task(vm, (uint8_t)next.number, 0); break;
    case ORDER_STOP: ipos_stop_task(vm, (uint8_t)next.number); break;
    case ORDER_FAULT: ipos_raise_fault(vm, (uint8_t)next.number, "by chance"); break;
  }
}

static uint32_t add_state(const ipos_vm* vm, uint32_t hash) {
  const uint32_t size = (uint32_t)ipos_state_size(vm);
  if (ipos_save(vm, state, sizeof state) != IPOS_OK) return 0;
  return hash_of(hash, state + kHead, size - kHead - kTail);
}

/* 0: it did not load. */
static uint32_t run(const uint8_t* image, uint32_t size, uint32_t seed, uint32_t ticks) {
  chance random;
  ipos_program* program;
  ipos_vm* vm;
  ipos_host host;
  uint32_t rates[3], hash = 2166136261u, tick;
  ipos_fault fault;
  if (ipos_program_load(program_memory, sizeof program_memory, image, size, &program, NULL) != IPOS_OK) return 0;
  random.state = seed;
  memset(&host, 0, sizeof host);
  host.user = &random;
  host.command = command;
  ipos_program_info_of(program, &info);
  if (ipos_init(machine_memory, sizeof machine_memory, program, &host, &vm) != IPOS_OK || ipos_start(vm) != IPOS_OK) return 0;
  for (tick = 0; tick < 3; ++tick) rates[tick] = chance_below(&random, 48);
  ipos_set_rates(vm, rates);
  for (tick = 0; tick < ticks; ++tick) {
    if (ipos_run_ticks(vm, 1, NULL) == IPOS_FAULTED) break;
    obey(vm, &random);
    ipos_fault_of(vm, &fault);
    if (fault.number != 0) break;
    if (tick % ORDERS_HASH_EVERY == 0) hash = add_state(vm, hash);
  }
  return add_state(vm, hash);
}

static void run_all(const uint8_t* runs, void (*print)(const char* line)) {
  uint32_t head[3];
  for (memcpy(head, runs, sizeof head[0]); head[0] != 0; memcpy(head, runs, sizeof head[0])) {
    char line[10] = "00000000\n";
    uint32_t hash;
    int digit;
    memcpy(head, runs, sizeof head);
    hash = run(runs + sizeof head, head[0], head[1], head[2]);
    for (digit = 7; digit >= 0; --digit, hash >>= 4) line[digit] = "0123456789abcdef"[hash & 15];
    print(line);
    runs += sizeof head + (head[0] + 3) / 4 * 4;
  }
}

#ifdef FIRMWARE_BOARD
#include "examples/embedding/cortex-m/board.h"

extern const uint8_t firmware_runs[];

int scom_main(void) {
  run_all(firmware_runs, board_print);
  return 0;
}
#else
#include <stdio.h>

static uint32_t runs[4 * 1024 * 1024]; /* aligned, as flash is */

static void print(const char* line) { fputs(line, stdout); }

int main(int count, char** arguments) {
  FILE* const file = count == 2 ? fopen(arguments[1], "rb") : NULL;
  if (file == NULL || fread(runs, 1, sizeof runs, file) == 0) return 1;
  fclose(file);
  run_all((const uint8_t*)runs, print);
  return 0;
}
#endif
