/* SCOM1 of the manual (1053 1610 p. 57) in a firmware: the library runs the program, this file connects it to
 * a CAN controller. What it prints is the watch window of the manual's figure 36, and a hash over every
 * command executed and every frame, which is the same on every platform. */
#include <ipos.h>
#include <stddef.h>

#include "board.h"
#include "can_mock.h"

enum { kRunTime = 1000 }; /* ms */

extern const unsigned char scom_image[];
extern const size_t scom_image_size;

/* All memory the virtual machine needs. */
static uint64_t program_memory[IPOS_PROGRAM_BYTES / 8];
static uint64_t machine_memory[(IPOS_VM_BYTES + 7) / 8];

static uint32_t hash = 2166136261u; /* FNV-1a */

static void add(uint32_t value) {
  for (int n = 0; n < 4; ++n, value >>= 8) hash = (hash ^ (value & 0xFF)) * 16777619u;
}

static void trace(void* user, ipos_vm* vm, const ipos_step* step) {
  (void)user, (void)vm;
  add((uint32_t)step->tick);
  add(step->context);
  add(step->address);
  add(step->word);
}

static void add_frame(uint32_t id, uint32_t length, uint32_t low, uint32_t high) {
  add(id);
  add(length);
  add(low);
  add(high);
}

/* The driver: sending. */
static ipos_sending send(void* user, ipos_vm* vm, const ipos_frame* frame, uint32_t tag) {
  struct can_registers* can = user;
  (void)vm, (void)tag;
  if (can->tx_request) return IPOS_SENDING_FAILED; /* the mailbox is in use */
  can->tx_id = frame->id;
  can->tx_length = frame->length;
  for (unsigned n = 0; n < 2; ++n)
    can->tx_data[n] = (uint32_t)frame->data[4 * n] | (uint32_t)frame->data[4 * n + 1] << 8 |
                      (uint32_t)frame->data[4 * n + 2] << 16 | (uint32_t)frame->data[4 * n + 3] << 24;
  can->tx_request = 1;
  add_frame(frame->id, frame->length, can->tx_data[0], can->tx_data[1]);
  return IPOS_SENDING_DONE;
}

/* The driver: receiving. */
static void receive(struct can_registers* can, ipos_vm* vm) {
  ipos_frame frame = {(uint16_t)can->rx_id, (uint8_t)can->rx_length, {0}};
  for (unsigned n = 0; n < 8; ++n) frame.data[n] = (uint8_t)(can->rx_data[n / 4] >> (8 * (n % 4)));
  add_frame(can->rx_id, can->rx_length, can->rx_data[0], can->rx_data[1]);
  can->rx_full = 0;
  ipos_receive(vm, &frame);
}

static void print_hex(uint32_t value) {
  char text[9] = {0};
  for (int n = 7; n >= 0; --n, value >>= 4) text[n] = "0123456789abcdef"[value & 15];
  board_print(text);
}

static void print_line(const char* what, uint32_t value) {
  board_print(what);
  print_hex(value);
  board_print(" h\n");
}

/* Values after one second, 1053 1610 p. 59, figure 36. */
static const struct {
  const char* name;
  uint32_t value;
} kExpected[] = {
    {"TrCycl.ObjectNo", 1024},   {"TrCycl.CycleTime", 100},   {"TrCycl.Offset", 0},
    {"TrCycl.Format", 8},        {"TrCycl.DPointer", 426},    {"TrCycl.Result", 99},
    {"lTrDataLow", 0x11223344},  {"lTrDataHigh", 0x55667788}, {"Rec.ObjectNo", 1025},
    {"Rec.Format", 8},           {"Rec.DPointer", 431},       {"lReDataLow", 0x44332211},
    {"lReDataHigh", 0x88776655},
};

int scom_main(void) {
  ipos_program* program;
  ipos_vm* vm;
  ipos_host host = {0};
  host.user = board_can;
  host.send = send;
  host.trace = trace;

  ipos_status status =
      ipos_program_load(program_memory, sizeof program_memory, scom_image, scom_image_size, &program, NULL);
  if (status == IPOS_OK) status = ipos_init(machine_memory, sizeof machine_memory, program, &host, &vm);
  if (status == IPOS_OK) status = ipos_start(vm);

  uint32_t frames = 0;
  for (uint32_t tick = 0; tick < kRunTime && status == IPOS_OK; ++tick) {
    status = ipos_run_ticks(vm, 1, NULL);
    frames += (uint32_t)can_mock_tick(board_can, tick);
    if (board_can->rx_full) receive(board_can, vm);
  }
  if (status != IPOS_OK) {
    board_print(ipos_status_text(status));
    board_print("\n");
    return 1;
  }

  int wrong = 0;
  for (unsigned n = 0; n < sizeof kExpected / sizeof kExpected[0]; ++n) {
    int32_t value = 0;
    ipos_read_symbol(vm, kExpected[n].name, &value);
    wrong += (uint32_t)value != kExpected[n].value;
    board_print(kExpected[n].name);
    print_line(" ", (uint32_t)value);
  }
  print_line("frames ", frames);
  print_line("trace hash ", hash);
  board_print(wrong ? "NOT as the manual prints it\n" : "as the manual prints it\n");
  return wrong;
}
