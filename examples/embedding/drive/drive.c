/* Skeleton of a drive's firmware around the virtual machine: where motion, CAN and non-volatile memory are
 * attached. What is hardware in a drive is a few lines of arithmetic here, so that the file runs on a host:
 *
 *   drive POSITION.ipx
 *
 * The cyclic interrupt of the drive is drive_tick(); everything below "hardware" is to be replaced. */
#include <ipos.h>
#include <stdio.h>
#include <string.h>

/* ---- hardware
 * ---------------------------------------------------------------------------------------------- */

/* An axis that moves at most kSpeed increments a millisecond toward its target. */
enum { kSpeed = 40 };
static struct { int32_t position, target; } axis;

static void axis_tick(void) {
  const int64_t way = (int64_t)axis.target - axis.position;
  axis.position += (int32_t)(way > kSpeed ? kSpeed : way < -kSpeed ? -kSpeed : way);
}

/* Two banks of flash or an FRAM. Writing a bank while the other is valid survives a power cut. */
static uint8_t nv_memory[IPOS_NV_BYTES];

static bool can_send(const ipos_frame* frame) {
  printf("CAN %03X [%d]\n", (unsigned)frame->id, frame->length);
  return true;
}

/* ---- what the program asks of the drive
 * ---------------------------------------------------------------------- */

/* Contexts that wait for the axis: bit n is context n. */
static uint32_t waiting;

static ipos_reply done(void) {
  const ipos_reply reply = {IPOS_ANSWER_DONE, 0, NULL};
  return reply;
}

static ipos_reply go_to(int32_t target, const ipos_command* command) {
  ipos_reply reply = done();
  axis.target = target;
  if (command->operands[0] != 0) { /* GO_WAIT: this task goes on when the axis is there */
    waiting |= 1u << command->context;
    reply.answer = IPOS_ANSWER_WAIT;
  }
  return reply;
}

static ipos_reply on_command(void* user, ipos_vm* vm, const ipos_command* command) {
  const int32_t* operands = command->operands;
  (void)user;
  switch (command->opcode) {
    case IPOS_COMMAND_GoAbsK: return go_to(operands[1], command);
    case IPOS_COMMAND_GoAbsH: return go_to(ipos_variables(vm)[operands[1]], command);
    case IPOS_COMMAND_GoRelK: return go_to((int32_t)((uint32_t)axis.target + (uint32_t)operands[1]), command);
    case IPOS_COMMAND_AxisStop: axis.target = axis.position; return done();
    default: {
      /* What the drive cannot do it says, instead of going on as if it had been done. */
      const ipos_reply refused = {IPOS_ANSWER_FAULT, 10, "this drive does not have the command"};
      return refused;
    }
  }
}

static void on_cancel(void* user, ipos_vm* vm, uint8_t context) {
  (void)user, (void)vm;
  waiting &= ~(1u << context);
}

static ipos_sending on_send(void* user, ipos_vm* vm, const ipos_frame* frame, uint32_t tag) {
  (void)user, (void)vm, (void)tag;
  return can_send(frame) ? IPOS_SENDING_DONE : IPOS_SENDING_FAILED;
}

static bool on_nv_write(void* user, uint32_t offset, const void* bytes, uint32_t size) {
  (void)user;
  memcpy(nv_memory + offset, bytes, size);
  return true;
}

static bool on_nv_read(void* user, uint32_t offset, void* bytes, uint32_t size) {
  (void)user;
  memcpy(bytes, nv_memory + offset, size);
  return true;
}

static void on_fault(void* user, ipos_vm* vm, const ipos_fault* fault) {
  (void)user, (void)vm;
  axis.target = axis.position; /* a fault of the program stops the axis */
  printf("F%02d at word %u: %s\n", fault->number, (unsigned)fault->address, fault->reason);
}

/* ---- the drive
 * ------------------------------------------------------------------------------------------------ */

enum { kActualPosition = 511 }; /* H511 ActPos_Mot (IPOSplus p. 86) */

static uint64_t program_memory[IPOS_PROGRAM_BYTES / 8], machine_memory[(IPOS_VM_BYTES + 7) / 8];
static ipos_vm* vm;

/* After power-on. The image lies in the flash that holds the program. */
static ipos_status drive_start(const void* image, size_t size) {
  ipos_program* program;
  ipos_host host = {0};
  host.command = on_command;
  host.cancel = on_cancel;
  host.send = on_send;
  host.nv_write = on_nv_write;
  host.nv_read = on_nv_read;
  host.fault = on_fault;
  ipos_status status = ipos_program_load(program_memory, sizeof program_memory, image, size, &program, NULL);
  if (status == IPOS_OK) status = ipos_init(machine_memory, sizeof machine_memory, program, &host, &vm);
  if (status != IPOS_OK) return status;
  ipos_nv_load(vm); /* an empty memory leaves the variables at 0 */
  return ipos_start(vm);
}

/* Every millisecond: first the axis, then its image in the variables, then the program. */
static ipos_status drive_tick(void) {
  axis_tick();
  ipos_write(vm, kActualPosition, axis.position);
  if (axis.position == axis.target)
    for (uint8_t context = 1; waiting != 0 && context <= 10; ++context)
      if (waiting >> context & 1u) {
        waiting &= ~(1u << context);
        ipos_resume(vm, context);
      }
  return ipos_run_ticks(vm, 1, NULL);
}

int main(int argc, char** argv) {
  static uint64_t image[4096];
  FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
  if (file == NULL) return puts("drive PROGRAM.ipx"), 64;
  const size_t size = fread(image, 1, sizeof image, file);
  fclose(file);
  ipos_status status = drive_start(image, size);
  for (int tick = 0; tick < 1000 && status == IPOS_OK; ++tick) status = drive_tick();
  printf("%s; position %d, H0 %d\n", ipos_status_text(status), (int)axis.position,
         (int)ipos_variables(vm)[0]);
  return status == IPOS_ENDED ? 0 : 1;
}
