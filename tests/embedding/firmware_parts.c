/* A build of ipos.c with parts left out says so, and runs a program: SET H0 = 5, ADD H0 + 2, SETINT, SCOMON, END, with its CRC-32
 * computed here. The commands are those of docs/reference/isa.md. */
#include <ipos.h>
#include <string.h>

static uint32_t image[16];
static uint64_t program_memory[IPOS_PROGRAM_BYTES / 8];
static uint64_t machine_memory[(IPOS_VM_BYTES + 7) / 8];
static int asked;

static uint32_t crc32_of(const uint8_t* bytes, uint32_t size) {
  uint32_t crc = 0xFFFFFFFF;
  int bit;
  for (; size != 0; --size)
    for (crc ^= *bytes++, bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320 : 0);
  return ~crc;
}

static ipos_reply command(void* user, ipos_vm* vm, const ipos_command* command) {
  const ipos_reply done = {IPOS_ANSWER_DONE, 0, NULL};
  (void)user, (void)vm;
  asked += command->opcode == IPOS_COMMAND_ScomOn;
  return done;
}

static ipos_sending send(void* user, ipos_vm* vm, const ipos_frame* frame, uint32_t tag) {
  (void)user, (void)vm, (void)frame, (void)tag;
  return IPOS_SENDING_DONE;
}

int main(void) {
  /* md60a; one section, code, at byte 28, 8 words. SETINT's routine is the END at word 7. */
  static const uint32_t words[] = {0x31585049, 1, 1, 1, 1, 28, 32, 0x21, 5, 0x40, 2, 0x62, 0x6C | 1 << 8, 7, 0x02};
  const bool telegrams = (ipos_features() & IPOS_FEATURE_TELEGRAMS) != 0;
  const bool interrupts = (ipos_features() & IPOS_FEATURE_INTERRUPTS) != 0;
  const uint32_t rates[3] = {10, 0, 0};
  ipos_program* program;
  ipos_vm* vm;
  ipos_host host;
  ipos_fault fault;
  int32_t value = 0;
  memcpy(image, words, sizeof words);
  image[15] = crc32_of((const uint8_t*)image, sizeof words);
  memset(&host, 0, sizeof host);
  host.command = command;
  host.send = send;
  if (ipos_program_load(program_memory, sizeof program_memory, image, sizeof image, &program, NULL) != IPOS_OK) return 1;
  if (ipos_init(machine_memory, sizeof machine_memory, program, &host, &vm) != IPOS_OK || ipos_start(vm) != IPOS_OK) return 2;
  ipos_set_rates(vm, rates);
  ipos_run_ticks(vm, 1, NULL);
  if (ipos_read(vm, 0, &value) != IPOS_OK || value != 7) return 3;
  if ((asked == 1) == telegrams) return 4; /* without, the host is asked for SCOMON */
  ipos_fault_of(vm, &fault);
  if ((fault.number == 10) == interrupts) return 5;
  if ((ipos_raise_event(vm, IPOS_EVENT_ERROR) == IPOS_NOT_BUILT_IN) == interrupts) return 6;
  if ((ipos_set_sbus(vm, 500000, 1, 1, 0) == IPOS_NOT_BUILT_IN) == telegrams) return 7;
  if ((ipos_state_size(vm) != 0) != (telegrams && interrupts)) return 8;
  if ((ipos_status_text(IPOS_OK)[0] != 0) != ((ipos_features() & IPOS_FEATURE_TEXTS) != 0)) return 9;
  return (ipos_features() & IPOS_FEATURE_FAST) != 0 ? 10 : 0;
}
