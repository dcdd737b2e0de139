/* From source text to a value in C: compile, load, run, read a variable. */
#include <ipos.h>
#include <ipos_compile.h>
#include <stdio.h>

static const char source[] =
    "long speed;\n"
    "main() {\n"
    "  speed = 100;\n"
    "  while (1) { _Wait(10); speed = speed + 5; }\n"
    "}\n";

/* All memory is ours, and lasts as long as we use the machine. */
static uint64_t image[512], program_memory[IPOS_PROGRAM_BYTES / 8], machine_memory[(IPOS_VM_BYTES + 7) / 8];
static char messages[1000];

static int check(ipos_status status) {
  if (status == IPOS_OK) return 1;
  printf("%s\n%s", ipos_status_text(status), messages);
  return 0;
}

int main(void) {
  ipos_compile_job job = {0};
  job.name = "ramp.IPC";
  job.source = source;
  job.image = image;
  job.image_capacity = sizeof image;
  job.messages = messages;
  job.messages_capacity = sizeof messages;
  if (!check(ipos_compile(&job))) return 1;

  ipos_program* program;
  ipos_vm* vm;
  if (!check(
          ipos_program_load(program_memory, sizeof program_memory, image, job.image_size, &program, NULL)) ||
      !check(ipos_init(machine_memory, sizeof machine_memory, program, NULL, &vm)) || !check(ipos_start(vm)))
    return 1;

  for (int n = 0; n < 3; ++n) {
    int32_t speed;
    if (!check(ipos_run_ticks(vm, 100, NULL)) || !check(ipos_read_symbol(vm, "speed", &speed))) return 1;
    printf("after %u ms: speed = %d\n", (unsigned)ipos_ticks(vm), (int)speed);
  }
  return 0;
}
